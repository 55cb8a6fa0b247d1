//! What contacts do at one instant: impacts first, then which contacts carry force.
//!
//! With all closed contacts in G, an impact gives the velocities q̇⁺ that minimise
//! `(q̇⁺ − q̇⁻)ᵀ M (q̇⁺ − q̇⁻)` subject to `G q̇⁺ ≥ 0` (perfectly inelastic); afterwards Gauss's principle gives the
//! accelerations in the same form. Contacts that close within `TOGETHER` of each other are one problem. Driven coordinates
//! keep their prescribed motion. Dry friction has no share in an impact; what rests it holds with a force within ± T that
//! joins the contact forces in Gauss's problem.

use crate::complementarity::{Solution, solve, solve_bounded};
use crate::energy::kinetic;
use crate::inertia::{Freedom, Inertia};
use crate::linear::{Cholesky, Small};
use crate::opposed::hold_between;
use crate::place::representatives;
use crate::run::Mode;
use crate::search::{OVERLAP, TOGETHER};
use crate::world::{Touch, World, stop_candidate};
use mainspring_mechanism::{
    Candidate, ContactId, ContactSource, Placed, Relative, Row, System, join_sharing,
};

/// Rates below this fraction of the speeds at hand count as zero.
const STILL: f64 = 1e-10;
/// Relative accelerations below this fraction of those at hand count as zero.
const BALANCED: f64 = 1e-10;
/// Rates above this fraction of the speeds at hand are no chatter that has come to its end.
const CHATTERING: f64 = 1e-5;
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

/// An impulse at one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse {
    pub candidate: Candidate,
    pub impulse: f64,
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
}

fn add_impulse(impulses: &mut Vec<Impulse>, new: Impulse) {
    match impulses.iter_mut().find(|i| i.candidate.id == new.candidate.id) {
        Some(before) => before.impulse += new.impulse,
        None => impulses.push(new),
    }
}

/// The state that an instant starts from. `speeds` are the greatest speeds so far, for tolerances.
pub struct Instant<'a> {
    pub t: f64,
    pub q: &'a [f64],
    pub speeds: &'a [f64],
    /// Contacts closed before.
    pub closed: &'a [Closed],
    /// A contact to leave out unless the others would make it overlap: its force has come to zero, or it ran off
    /// its feature.
    pub leaving: Option<ContactId>,
    /// Set when a contact has come to chatter by less than can be told apart, or when events at one instant do not
    /// end: rates up to this end here.
    pub chattering: Option<f64>,
    /// A coordinate that dry friction no longer holds, and the direction in which it goes.
    pub giving: Option<(usize, f64)>,
}

/// Resolves an instant; `v` is changed by impacts.
pub fn settle(world: &mut World, instant: &Instant, v: &mut [f64]) -> Settled {
    let mut out = Settled { solved: true, ..Settled::default() };
    let placed = world.place_all(instant.q);
    let near = near_touches(world, instant.q, &placed);
    let (system, freedom) = (world.system, world.moved.clone());
    let inertia = Inertia::whole(system, &freedom, (instant.q, v));
    for _ in 0..MOST_ROUNDS {
        let touches = choose(world, instant, &near, v);
        if !impact((world, &inertia), instant, &touches, v, &mut out) {
            break;
        }
    }
    if let Some(rate) = instant.chattering {
        // At rest all that touches counts: also a corner that was on its way off a face.
        let touches = choose(world, instant, &near, &vec![0.0; v.len()]);
        quieten((world, &inertia), instant, rate, &touches, v, &mut out);
    }
    let touches = choose(world, instant, &near, v);
    hold(world, instant, &touches, v, &mut out);
    // What touches along the same normal as a contact that lets go, and carries nothing, lets go with it.
    if let Some(left) = near.iter().find(|t| Some(t.candidate.id) == instant.leaving) {
        let lets_go = |c: &Closed| {
            !c.active
                && touches.iter().any(|t| t.candidate.id == c.candidate.id && t.row().is_along(&left.row()))
        };
        out.closed.retain(|c| !lets_go(c));
    }
    let is_closed = |t: &&Touch| out.closed.iter().any(|c| c.candidate.id == t.candidate.id);
    out.opening = near.iter().filter(|t| !is_closed(t)).map(|t| (t.candidate.id, t.state.gap)).collect();
    out
}

/// Forces of the contacts known to be closed in a mode, at time `t` and state `(q, v)` within it (Gelsey 1995,
/// Sec. 2.2.2), in their order.
pub fn forces_at(
    system: &System,
    source: &dyn ContactSource,
    mode: &Mode,
    t: f64,
    (q, v): (&[f64], &[f64]),
) -> Vec<Closed> {
    let mut world = World::new(system, source);
    world.set_dry(&mode.stuck, &mode.sliding);
    world.follow_drives(t);
    let placed = world.place_all(q);
    let touches: Vec<Touch> =
        mode.closed.iter().map(|c| world.touch_among(&c.candidate, q, &placed)).collect();
    let stuck: Vec<usize> = (0..q.len()).filter(|&i| mode.stuck[i]).collect();
    let problem = Balance::new(&world, touches.iter().collect(), &stuck, t, (q, v));
    let forces = problem.solution.lambda;
    mode.closed.iter().zip(forces).map(|(c, force)| Closed { force, active: force > 0.0, ..*c }).collect()
}

/// Every contact closed to `TOGETHER` at `q`, wherever along its features.
fn near_touches<'p>(world: &mut World, q: &[f64], placed: &'p [Placed<'p>]) -> Vec<Touch<'p>> {
    let (within, deep) = (TOGETHER * world.system.size, OVERLAP * world.system.size);
    let still: Small<f64, 8> = smallvec::smallvec![0.0; q.len()];
    let mut found = Vec::new();
    for interaction in 0..world.arms.len() {
        let (travelled, _) = world.refresh(interaction, q, 2.0 * deep);
        let (a, b) = world.system.interactions[interaction].bodies;
        let relative = Relative::new(&placed[a], &placed[b], &still, &still);
        for k in 0..world.listed(interaction).len() {
            let candidate = world.listed(interaction)[k];
            if candidate.distance - travelled > 2.0 * deep {
                continue;
            }
            let gap = world.approach(&candidate, &relative).gap;
            if gap <= within && gap >= -deep {
                found.push(world.touch_among(&candidate, q, placed));
            }
        }
    }
    for k in world.stops() {
        let touch = world.touch_among(&stop_candidate(k), q, placed);
        if touch.state.gap <= within {
            found.push(touch);
        }
    }
    found
}

fn choose<'p>(world: &mut World, instant: &Instant, near: &[Touch<'p>], v: &[f64]) -> Vec<Touch<'p>> {
    let kept: Vec<ContactId> = instant.closed.iter().map(|c| c.candidate.id).collect();
    let tolerances = |row: &Row| rate_tolerance(row, instant.speeds);
    let mut chosen = representatives(world, instant.q, v, near, &kept, &tolerances);
    chosen.retain(|t| Some(t.candidate.id) != instant.leaving || t.rate(v) < -tolerances(&t.row()));
    chosen
}

/// Below this a rate of closing counts as zero.
pub fn rate_tolerance(row: &Row, speeds: &[f64]) -> f64 {
    STILL * reach_of(row, speeds)
}

/// The greatest rate that the greatest speeds so far could give.
fn reach_of(row: &Row, speeds: &[f64]) -> f64 {
    row.entries().map(|(i, g)| g.abs() * speeds[i]).sum()
}

/// One round of impact over the chosen contacts; false when nothing was closing.
fn impact(
    (world, inertia): (&World, &Inertia),
    instant: &Instant,
    touches: &[Touch],
    v: &mut [f64],
    out: &mut Settled,
) -> bool {
    let rows: Vec<Row> = touches.iter().map(Touch::row).collect();
    let rates: Vec<f64> = touches.iter().map(|t| t.rate(v)).collect();
    let tolerance: Vec<f64> = rows.iter().map(|r| rate_tolerance(r, instant.speeds)).collect();
    if rates.iter().zip(&tolerance).all(|(rate, tol)| *rate >= -tol) {
        return false;
    }
    let solution = solve(&inertia.inverse(&rows), &rates, &tolerance);
    out.solved &= solution.solved;
    let mut change = vec![0.0; v.len()];
    inertia.add_forces(&rows, &solution.lambda, &mut change);
    account((world, inertia), instant, (&rows, &solution.lambda), (v, &change), out);
    for i in (0..v.len()).filter(|&i| !world.moved.is_held(i)) {
        v[i] += change[i];
        if v[i].abs() <= 1e-13 * instant.speeds[i] {
            v[i] = 0.0;
        }
    }
    stop_locked(&world.moved, &rows, &solution.active, v);
    for (touch, &impulse) in touches.iter().zip(&solution.lambda).filter(|(_, l)| **l > 0.0) {
        add_impulse(&mut out.impulses, Impulse { candidate: touch.candidate, impulse });
    }
    true
}

/// What a change of velocities by impulses takes, ½ Δq̇ᵀ M Δq̇, and what drives do in it.
fn account(
    (world, inertia): (&World, &Inertia),
    instant: &Instant,
    (rows, impulses): (&[Row], &[f64]),
    (v, change): (&[f64], &[f64]),
    out: &mut Settled,
) {
    out.loss += kinetic(world.system, instant.q, change);
    for &(i, _) in &world.drives {
        let pressed: f64 = rows.iter().zip(impulses).map(|(row, l)| row.at(i) * l).sum();
        out.work += v[i] * (inertia.momentum(i, change) - pressed);
    }
}

/// Ends a chatter: velocities that keep every touching contact with a small rate closed, nearest in the metric of
/// inertia. The energy this takes is next to nothing.
fn quieten(
    (world, inertia): (&World, &Inertia),
    instant: &Instant,
    rate: f64,
    touches: &[Touch],
    v: &mut [f64],
    out: &mut Settled,
) {
    let bound = |t: &Touch| rate.min(CHATTERING * reach_of(&t.row(), instant.speeds));
    let slow = touches.iter().filter(|t| t.rate(v).abs() <= bound(t));
    let mut rows: Vec<Row> = Vec::new();
    for touch in slow {
        rows.push(touch.row());
        if Cholesky::new(inertia.inverse(&rows), rows.len()).is_none() {
            rows.pop();
        }
    }
    let Some(factor) = Cholesky::new(inertia.inverse(&rows), rows.len()) else { return };
    let rates: Vec<f64> = rows.iter().map(|r| -r.dot(v)).collect();
    let impulses = factor.solve(&rates);
    let mut change = vec![0.0; v.len()];
    inertia.add_forces(&rows, &impulses, &mut change);
    account((world, inertia), instant, (&rows, &impulses), (v, &change), out);
    v.iter_mut().zip(&change).for_each(|(v, change)| *v += change);
    let all: Vec<usize> = (0..rows.len()).collect();
    stop_locked(&world.moved, &rows, &all, v);
}

/// As many independent active contacts as coordinates they touch: nothing there can move, unless a drive moves it.
fn stop_locked(freedom: &Freedom, rows: &[Row], active: &[usize], v: &mut [f64]) {
    let ties: Vec<Tie> = active.iter().map(|&k| Tie::of_row(freedom, &rows[k], k)).collect();
    for group in groups(ties) {
        let contacts = group.contacts.iter();
        let driven = |k: &usize| rows[*k].entries().any(|(i, g)| freedom.is_held(i) && g * v[i] != 0.0);
        if group.contacts.len() >= group.coordinates.len() && !contacts.clone().any(driven) {
            for &i in &group.coordinates {
                v[i] = 0.0;
            }
        }
    }
}

/// Coordinates that something ties together: a contact (an index into the rows) or masses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tie {
    pub coordinates: Vec<usize>,
    pub contact: Option<usize>,
}

impl Tie {
    /// The coordinates of a contact's row, those left out that are held.
    pub fn of_row(freedom: &Freedom, row: &Row, k: usize) -> Self {
        let coordinates = row.entries().map(|e| e.0).filter(|&i| !freedom.is_held(i)).collect();
        Self { coordinates, contact: Some(k) }
    }
}

/// Coordinates tied together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// In increasing order.
    pub coordinates: Vec<usize>,
    /// Indices into the rows.
    pub contacts: Vec<usize>,
}

/// Sorts ties into groups that share coordinates, in a fixed order. Ties without coordinates are left out.
pub fn groups(ties: Vec<Tie>) -> Vec<Group> {
    let sets = ties.into_iter().map(|tie| (tie.coordinates, tie.contact.into_iter().collect()));
    let group = |(coordinates, contacts)| Group { coordinates, contacts };
    join_sharing(sets).into_iter().map(group).collect()
}

/// Which touching contacts stay closed, with what forces, and what dry friction holds (Gauss's principle).
fn hold(world: &mut World, instant: &Instant, touches: &[Touch], v: &[f64], out: &mut Settled) {
    let still =
        touches.iter().filter(|t| t.rate(v).abs() <= rate_tolerance(&t.row(), instant.speeds)).collect();
    let sliding = slides(world, instant, v);
    world.set_dry(&vec![false; v.len()], &sliding);
    let rests =
        |&i: &usize| world.system.forces.coulomb[i] > 0.0 && sliding[i] == 0.0 && !world.moved.is_held(i);
    let resting: Vec<usize> = (0..v.len()).filter(rests).collect();
    let problem = Balance::new(world, still, &resting, instant.t, (instant.q, v));
    (out.stuck, out.sliding) = problem.dry(&resting, sliding);
    let Balance { touches, tolerance, solution, acceleration, weights, .. } = problem;
    out.solved &= solution.solved;
    (out.acceleration, out.weights) = (acceleration, weights);
    for (k, touch) in touches.iter().enumerate() {
        let (force, candidate) = (solution.lambda[k], touch.candidate);
        if force > 0.0 || solution.w[k] <= tolerance[k] {
            out.closed.push(Closed { candidate, gap: touch.state.gap, force, active: force > 0.0 });
        }
    }
    hold_between(world, &touches, (instant.q, v), &mut out.closed);
}

/// Directions in which free coordinates with dry friction slide: by their velocities, or as they have just let go.
fn slides(world: &World, instant: &Instant, v: &[f64]) -> Vec<f64> {
    let sign = |i: usize| match instant.giving {
        Some((k, direction)) if k == i && v[i] == 0.0 => direction,
        _ if world.system.forces.coulomb[i] > 0.0 && v[i] != 0.0 => v[i].signum(),
        _ => 0.0,
    };
    (0..v.len()).map(|i| if world.moved.is_held(i) { 0.0 } else { sign(i) }).collect()
}

/// Accelerations, contact forces and what dry friction holds, by Gauss's principle over contacts with gap and rate zero
/// and coordinates at rest.
struct Balance<'t, 'a> {
    touches: Vec<&'t Touch<'a>>,
    /// Relative accelerations below these count as zero, by row: contacts, then coordinates at rest.
    tolerance: Vec<f64>,
    solution: Solution,
    /// Of every coordinate.
    acceleration: Vec<f64>,
    weights: Small<f64, 8>,
    /// Sizes of dry friction of the coordinates at rest.
    sizes: Vec<f64>,
    matrix: Small<f64, 16>,
}

impl<'t, 'a> Balance<'t, 'a> {
    fn new(
        world: &World,
        touches: Vec<&'t Touch<'a>>,
        resting: &[usize],
        t: f64,
        (q, v): (&[f64], &[f64]),
    ) -> Self {
        let inertia = Inertia::whole(world.system, &world.moved, (q, v));
        let mut acceleration = vec![0.0; q.len()];
        world.prescribe_onset(t, &mut acceleration);
        for i in (0..q.len()).filter(|&i| world.moved.is_alone(i)) {
            acceleration[i] = world.acceleration_alone(i, q[i], v[i]);
        }
        inertia.accelerate(|i| world.dry_force(i), &mut acceleration);
        let weights = inertia.weights((q, v), &acceleration);
        let contacts = touches.iter().map(|t| (t.row(), t.bias(v)));
        let (rows, bias): (Vec<Row>, Vec<f64>) =
            contacts.chain(resting.iter().map(|&i| (Row::single(i, 1.0), 0.0))).unzip();
        let b: Vec<f64> = rows.iter().zip(&bias).map(|(row, bias)| row.dot(&acceleration) + bias).collect();
        let weigh = |row: &Row| row.entries().map(|(i, g)| g.abs() * weights[i]).sum::<f64>();
        let tolerance: Vec<f64> =
            rows.iter().zip(&bias).map(|(row, bias)| BALANCED * (weigh(row) + bias.abs())).collect();
        let sizes: Vec<f64> = resting.iter().map(|&i| world.system.forces.coulomb[i]).collect();
        let matrix = inertia.inverse(&rows);
        let solution = solve_bounded(&matrix, &b, &tolerance, &sizes);
        inertia.add_forces(&rows, &solution.lambda, &mut acceleration);
        Self { touches, tolerance, solution, acceleration, weights, sizes, matrix }
    }

    /// Which of the coordinates at rest are stuck; those at the limit of friction slide. One that contacts hold as
    /// well is stuck only if it needs to be: what holds must stay independent.
    fn dry(&self, resting: &[usize], mut sliding: Vec<f64>) -> (Vec<bool>, Vec<f64>) {
        let contacts = self.touches.len();
        let n = contacts + self.sizes.len();
        let mut stuck = vec![false; sliding.len()];
        let mut holding = self.solution.active.clone();
        for (k, (&i, size)) in resting.iter().zip(&self.sizes).enumerate() {
            let (row, force) = (contacts + k, self.solution.lambda[contacts + k]);
            if self.solution.active.contains(&row) {
                stuck[i] = true;
            } else if force.abs() >= *size {
                sliding[i] = -force.signum();
            } else {
                holding.push(row);
                let entries =
                    holding.iter().flat_map(|&r| holding.iter().map(move |&s| self.matrix[r * n + s]));
                stuck[i] = Cholesky::new(entries.collect(), holding.len()).is_some();
                if !stuck[i] {
                    holding.pop();
                }
            }
        }
        (stuck, sliding)
    }
}
