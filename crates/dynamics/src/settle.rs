//! What contacts do at one instant: impacts first, then which contacts carry force.
//!
//! With all closed contacts in G, an impact gives the velocities q̇⁺ that minimise
//! `(q̇⁺ − q̇⁻)ᵀ M (q̇⁺ − q̇⁻)` subject to `G q̇⁺ ≥ 0` (perfectly inelastic); afterwards Gauss's principle gives the
//! accelerations in the same form. Contacts that close within `TOGETHER` of each other are one problem. Driven coordinates
//! keep their prescribed motion. Dry friction has no share in an impact; what rests it holds with a force within ± T that
//! joins the contact forces in Gauss's problem.

use crate::balance::hold;
use crate::impact::{Impulse, add_impulse, impact, quieten};
use crate::inertia::Inertia;
use crate::linear::Small;
use crate::near::{Near, choose, near_touches, reach_of};
use crate::world::World;
use mainspring_mechanism::{Candidate, ContactId, Row};

/// Rounds of impacts at one instant.
const MOST_ROUNDS: usize = 40;

/// A contact that is closed after an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closed {
    pub candidate: Candidate,
    /// Its gap when it was found closed: zero to rounding.
    pub gap: f64,
    /// Force along the normal; 0 for a contact that stays closed without force.
    pub force: f64,
    /// Whether the motion rests on it.
    pub active: bool,
}

/// The outcome of an instant.
#[derive(Clone, Debug, Default)]
pub struct Settled {
    pub impulses: Vec<Impulse>,
    /// Kinetic energy lost at impacts: ½ Δq̇ᵀ M Δq̇ summed over rounds.
    pub loss: f64,
    /// Work that drives do at impacts: their impulse times their speed.
    pub work: f64,
    pub closed: Vec<Closed>,
    /// ∂g/∂q of those closed, in the same order.
    pub rows: Vec<Row>,
    /// Contacts that touch to rounding and are not closed, with their gaps.
    pub opening: Vec<(ContactId, f64)>,
    /// Accelerations just after, and sizes of what meets in them, by coordinate.
    pub acceleration: Vec<f64>,
    pub weights: Small<f64, 8>,
    /// Coordinates that dry friction holds, and the direction in which it lets others slide (0 without).
    pub stuck: Vec<bool>,
    pub sliding: Vec<f64>,
    /// False if the conditions could not be met to the tolerance.
    pub solved: bool,
}

impl Settled {
    /// Counts what an earlier resolution of the same instant did at impacts as well.
    pub fn add_blow(&mut self, earlier: Settled) {
        let later = std::mem::replace(&mut self.impulses, earlier.impulses);
        later.into_iter().for_each(|i| add_impulse(&mut self.impulses, i));
        self.loss += earlier.loss;
        self.work += earlier.work;
        self.solved &= earlier.solved;
    }

    /// What touches along the same normal as a contact that lets go, and carries nothing, lets go with it.
    fn let_go_along(&mut self, row: &Row) {
        for k in (0..self.closed.len()).rev() {
            if !self.closed[k].active && self.rows[k].is_along(row) {
                self.closed.remove(k);
                self.rows.remove(k);
            }
        }
    }
}

/// The state that an instant starts from. `speeds` are the greatest speeds so far, for tolerances.
pub struct Instant<'a> {
    pub t: f64,
    pub q: &'a [f64],
    pub speeds: &'a [f64],
    /// Contacts closed before.
    pub closed: &'a [Closed],
    /// Contacts kept closed drift: a rate of theirs below this fraction of the speeds at hand is no blow.
    pub drift: f64,
    /// A contact to leave out unless the others would make it overlap: its force has come to zero, or it ran off
    /// its feature.
    pub leaving: Option<ContactId>,
    /// Set when a contact has come to chatter by less than can be told apart, or when events at one instant do not
    /// end: rates up to this end here.
    pub chattering: Option<f64>,
    /// A coordinate that dry friction no longer holds, and the direction in which it goes.
    pub giving: Option<(usize, f64)>,
}

/// Is a blow no more than the drift of a contact kept closed, there or at the next feature along the same normal?
fn is_drift(instant: &Instant, near: &[Near], blow: &Impulse) -> bool {
    let Some(hit) = near.iter().find(|n| n.touch.candidate.id == blow.candidate.id) else { return false };
    let is_kept = |n: &Near| instant.closed.iter().any(|c| c.candidate.id == n.touch.candidate.id);
    near.iter().any(|n| is_kept(n) && hit.row.is_nearly_along(&n.row, 100.0 * instant.drift))
        && blow.rate.abs() <= instant.drift * reach_of(&hit.row, instant.speeds)
}

/// Resolves an instant; `v` is changed by impacts.
pub fn settle(world: &mut World, instant: &Instant, v: &mut [f64]) -> Settled {
    let mut out = Settled { solved: true, ..Settled::default() };
    let placed = world.place_all(instant.q);
    let near = near_touches(world, instant, &placed);
    let (system, freedom) = (world.system, world.moved.clone());
    let inertia = Inertia::whole(system, &freedom, (instant.q, v));
    let before: Small<f64, 8> = Small::from_slice(v);
    let mut touches = choose(world, instant, &near, v);
    for _ in 0..MOST_ROUNDS {
        if !impact((world, &inertia), instant, &touches, (&before, v), &mut out) {
            break;
        }
        touches = choose(world, instant, &near, v);
    }
    if out.impulses.iter().all(|blow| is_drift(instant, &near, blow)) {
        out.impulses.clear();
    }
    if let Some(rate) = instant.chattering {
        // At rest all that touches counts: also a corner that was on its way off a face.
        touches = choose(world, instant, &near, &vec![0.0; v.len()]);
        quieten((world, &inertia), instant, rate, &touches, v, &mut out);
        touches = choose(world, instant, &near, v);
    }
    hold(world, instant, &touches, v, &mut out);
    if let Some(left) = near.iter().find(|t| Some(t.touch.candidate.id) == instant.leaving) {
        out.let_go_along(&left.row);
    }
    let is_closed = |id: ContactId| out.closed.iter().any(|c| c.candidate.id == id);
    let touching = near.iter().map(|t| (t.touch.candidate.id, t.touch.state.gap));
    out.opening = touching.filter(|t| !is_closed(t.0)).collect();
    out
}
