//! What contacts do at one instant: impacts first, then which contacts carry force.
//!
//! With all closed contacts in G, an impact gives the velocities q̇⁺ that minimise
//! `(q̇⁺ − q̇⁻)ᵀ M (q̇⁺ − q̇⁻)` subject to `G q̇⁺ ≥ 0` (perfectly inelastic); afterwards Gauss's principle gives the
//! accelerations in the same form. Contacts that close within `TOGETHER` of each other are one problem.

use crate::complementarity::{Solution, solve};
use crate::linear::{Cholesky, Small};
use crate::place::representatives;
use crate::search::{OVERLAP, TOGETHER};
use crate::world::{Touch, World};
use mainspring_mechanism::{Candidate, ContactId, ContactSource, Placed, Relative, Row, System};

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
    pub closed: Vec<Closed>,
    /// Contacts that touch to rounding and are not closed, with their gaps.
    pub opening: Vec<(ContactId, f64)>,
    /// Accelerations just after.
    pub acceleration: Vec<f64>,
    /// False if the conditions could not be met to the tolerance.
    pub solved: bool,
}

impl Settled {
    /// Counts what an earlier resolution of the same instant did at impacts as well.
    pub fn add_blow(&mut self, earlier: Settled) {
        let later = std::mem::replace(&mut self.impulses, earlier.impulses);
        later.into_iter().for_each(|i| add_impulse(&mut self.impulses, i));
        self.loss += earlier.loss;
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
}

/// Resolves an instant; `v` is changed by impacts.
pub fn settle(world: &mut World, instant: &Instant, v: &mut [f64]) -> Settled {
    let mut out = Settled { solved: true, ..Settled::default() };
    let placed = world.place_all(instant.q);
    let near = near_touches(world, instant.q, &placed);
    for _ in 0..MOST_ROUNDS {
        let touches = choose(world, instant, &near, v);
        if !impact(world.system, instant, &touches, v, &mut out) {
            break;
        }
    }
    if let Some(rate) = instant.chattering {
        // At rest all that touches counts: also a corner that was on its way off a face.
        let touches = choose(world, instant, &near, &vec![0.0; v.len()]);
        quieten(world.system, instant, rate, &touches, v);
    }
    let touches = choose(world, instant, &near, v);
    hold(world.system, instant, &touches, v, &mut out);
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

/// Forces at a state of the contacts known to be closed there (Gelsey 1995, Sec. 2.2.2), in their order.
pub fn forces_at(
    system: &System,
    source: &dyn ContactSource,
    closed: &[Closed],
    q: &[f64],
    v: &[f64],
) -> Vec<Closed> {
    let mut world = World::new(system, source);
    let placed = world.place_all(q);
    let touches: Vec<Touch> = closed.iter().map(|c| world.touch_among(&c.candidate, &placed)).collect();
    let problem = Balance::new(system, touches.iter().collect(), q, v);
    let forces = problem.solution.lambda;
    closed.iter().zip(forces).map(|(c, force)| Closed { force, active: force > 0.0, ..*c }).collect()
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
                found.push(world.touch_among(&candidate, placed));
            }
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
fn impact(system: &System, instant: &Instant, touches: &[Touch], v: &mut [f64], out: &mut Settled) -> bool {
    let rows: Vec<Row> = touches.iter().map(Touch::row).collect();
    let rates: Vec<f64> = touches.iter().map(|t| t.rate(v)).collect();
    let tolerance: Vec<f64> = rows.iter().map(|r| rate_tolerance(r, instant.speeds)).collect();
    if rates.iter().zip(&tolerance).all(|(rate, tol)| *rate >= -tol) {
        return false;
    }
    let solution = solve(&inverse_inertia(system, &rows), &rates, &tolerance);
    out.solved &= solution.solved;
    let mut change = vec![0.0; v.len()];
    add_forces(system, &rows, &solution.lambda, &mut change);
    for (i, c) in system.coordinates.iter().enumerate() {
        out.loss += 0.5 * c.inertia * change[i] * change[i];
        v[i] += change[i];
        if v[i].abs() <= 1e-13 * instant.speeds[i] {
            v[i] = 0.0;
        }
    }
    stop_locked(&rows, &solution.active, v);
    for (touch, &impulse) in touches.iter().zip(&solution.lambda).filter(|(_, l)| **l > 0.0) {
        add_impulse(&mut out.impulses, Impulse { candidate: touch.candidate, impulse });
    }
    true
}

/// Ends a chatter: velocities that keep every touching contact with a small rate closed, nearest in the metric of
/// inertia. The energy this takes is below what can be told apart.
fn quieten(system: &System, instant: &Instant, rate: f64, touches: &[Touch], v: &mut [f64]) {
    let bound = |t: &Touch| rate.min(CHATTERING * reach_of(&t.row(), instant.speeds));
    let slow = touches.iter().filter(|t| t.rate(v).abs() <= bound(t));
    let mut rows: Vec<Row> = Vec::new();
    for touch in slow {
        rows.push(touch.row());
        if Cholesky::new(inverse_inertia(system, &rows), rows.len()).is_none() {
            rows.pop();
        }
    }
    let Some(factor) = Cholesky::new(inverse_inertia(system, &rows), rows.len()) else { return };
    let rates: Vec<f64> = rows.iter().map(|r| -r.dot(v)).collect();
    add_forces(system, &rows, &factor.solve(&rates), v);
    let all: Vec<usize> = (0..rows.len()).collect();
    stop_locked(&rows, &all, v);
}

/// As many independent active contacts as coordinates they touch: nothing there can move.
fn stop_locked(rows: &[Row], active: &[usize], v: &mut [f64]) {
    let groups = groups(rows, active);
    for group in groups.iter().filter(|g| g.contacts.len() >= g.coordinates.len()) {
        for &i in &group.coordinates {
            v[i] = 0.0;
        }
    }
}

/// Coordinates tied together by contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// In increasing order.
    pub coordinates: Vec<usize>,
    /// Indices into the rows.
    pub contacts: Vec<usize>,
}

/// Sorts contacts into groups that share coordinates, in a fixed order.
pub fn groups(rows: &[Row], active: &[usize]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for &k in active {
        let mut merged =
            Group { coordinates: rows[k].entries().map(|(i, _)| i).collect(), contacts: vec![k] };
        let (joined, others): (Vec<Group>, Vec<Group>) =
            groups.into_iter().partition(|g| g.coordinates.iter().any(|i| merged.coordinates.contains(i)));
        for g in joined {
            merged.coordinates.extend(g.coordinates);
            merged.contacts.extend(g.contacts);
        }
        merged.coordinates.sort_unstable();
        merged.coordinates.dedup();
        merged.contacts.sort_unstable();
        groups = others;
        groups.push(merged);
    }
    groups.sort_by(|a, b| a.coordinates.cmp(&b.coordinates));
    groups
}

/// Which touching contacts stay closed, with what forces (Gauss's principle).
fn hold(system: &System, instant: &Instant, touches: &[Touch], v: &[f64], out: &mut Settled) {
    let still =
        touches.iter().filter(|t| t.rate(v).abs() <= rate_tolerance(&t.row(), instant.speeds)).collect();
    let Balance { touches, tolerance, solution, acceleration } = Balance::new(system, still, instant.q, v);
    out.solved &= solution.solved;
    out.acceleration = acceleration;
    for (k, touch) in touches.iter().enumerate() {
        let (force, candidate) = (solution.lambda[k], touch.candidate);
        if force > 0.0 || solution.w[k] <= tolerance[k] {
            out.closed.push(Closed { candidate, force, active: force > 0.0 });
        }
    }
}

/// Accelerations and contact forces by Gauss's principle over contacts with gap and rate zero.
struct Balance<'t, 'a> {
    touches: Vec<&'t Touch<'a>>,
    /// Relative accelerations below these count as zero, by contact.
    tolerance: Vec<f64>,
    solution: Solution,
    /// Of every coordinate.
    acceleration: Vec<f64>,
}

impl<'t, 'a> Balance<'t, 'a> {
    fn new(system: &System, touches: Vec<&'t Touch<'a>>, q: &[f64], v: &[f64]) -> Self {
        let rows: Vec<Row> = touches.iter().map(|t| t.row()).collect();
        let free = system.coordinates.iter().enumerate().map(|(i, c)| c.free_acceleration(q[i], v[i]));
        let mut acceleration: Vec<f64> = free.collect();
        let bias: Vec<f64> = touches.iter().map(|t| t.bias(v)).collect();
        let b: Vec<f64> = rows.iter().zip(&bias).map(|(row, bias)| row.dot(&acceleration) + bias).collect();
        let tolerance: Vec<f64> = rows
            .iter()
            .zip(&bias)
            .map(|(row, bias)| BALANCED * (weigh(system, row, q, v) + bias.abs()))
            .collect();
        let solution = solve(&inverse_inertia(system, &rows), &b, &tolerance);
        add_forces(system, &rows, &solution.lambda, &mut acceleration);
        Self { touches, tolerance, solution, acceleration }
    }
}

/// Size of the accelerations that meet at a contact, before they cancel.
fn weigh(system: &System, row: &Row, q: &[f64], v: &[f64]) -> f64 {
    row.entries()
        .map(|(i, g)| {
            let c = &system.coordinates[i];
            let force = (c.force - c.stiffness * q[i]).abs() + (c.damping * v[i]).abs();
            g.abs() * force / c.inertia
        })
        .sum()
}

/// `G M⁻¹ Gᵀ` in row order.
pub fn inverse_inertia(system: &System, rows: &[Row]) -> Small<f64, 16> {
    let n = rows.len();
    let mut a: Small<f64, 16> = smallvec::smallvec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let product = rows[i].product(&rows[j], |k| system.coordinates[k].inertia);
            (a[i * n + j], a[j * n + i]) = (product, product);
        }
    }
    a
}

/// Adds `M⁻¹ Gᵀ λ`.
pub fn add_forces(system: &System, rows: &[Row], lambda: &[f64], change: &mut [f64]) {
    for (row, l) in rows.iter().zip(lambda) {
        for (i, g) in row.entries() {
            change[i] += g * l / system.coordinates[i].inertia;
        }
    }
}
