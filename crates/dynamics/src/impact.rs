//! Impacts: the velocities just after, nearest in the metric of inertia to those before.

use crate::complementarity::solve;
use crate::energy::kinetic;
use crate::inertia::{Freedom, Inertia};
use crate::linear::{Cholesky, Small};
use crate::near::{Near, reach_of};
use crate::settle::{Instant, Settled};
use crate::ties::{Tie, groups};
use crate::world::World;
use mainspring_mechanism::{Candidate, Row};

/// Rates above this fraction of the speeds at hand are no chatter that has come to its end.
const CHATTERING: f64 = 1e-5;

/// An impulse at one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse {
    pub candidate: Candidate,
    pub impulse: f64,
    /// Its rate before the instant's first blow.
    pub rate: f64,
}

/// Adds to the impulse at the same contact, if there was one.
pub fn add_impulse(impulses: &mut Vec<Impulse>, new: Impulse) {
    match impulses.iter_mut().find(|i| i.candidate.id == new.candidate.id) {
        Some(before) => before.impulse += new.impulse,
        None => impulses.push(new),
    }
}

/// One round of impact over the chosen contacts at velocities `v`, which were `before` at first; false when nothing was
/// closing.
pub fn impact(
    (world, inertia): (&World, &Inertia),
    instant: &Instant,
    touches: &[&Near],
    (before, v): (&[f64], &mut [f64]),
    out: &mut Settled,
) -> bool {
    let rates: Small<f64, 8> = touches.iter().map(|t| t.rate(v)).collect();
    if rates.iter().zip(touches).all(|(rate, t)| *rate >= -t.still) {
        return false;
    }
    let rows: Small<Row> = touches.iter().map(|t| t.row).collect();
    let tolerance: Small<f64, 8> = touches.iter().map(|t| t.still).collect();
    let solution = solve(&inertia.inverse(&rows), &rates, &tolerance);
    out.solved &= solution.solved;
    let mut change: Small<f64, 8> = smallvec::smallvec![0.0; v.len()];
    inertia.add_forces(&rows, &solution.lambda, &mut change);
    account((world, inertia), instant, (&rows, &solution.lambda), (v, &change), out);
    for i in (0..v.len()).filter(|&i| !world.moved.is_held(i)) {
        v[i] += change[i];
        if v[i].abs() <= 1e-13 * instant.speeds[i] {
            v[i] = 0.0;
        }
    }
    stop_locked(&world.moved, &rows, &solution.active, v);
    for (near, &impulse) in touches.iter().zip(&solution.lambda).filter(|(_, l)| **l > 0.0) {
        let (candidate, rate) = (near.touch.candidate, near.rate(before));
        add_impulse(&mut out.impulses, Impulse { candidate, impulse, rate });
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
pub fn quieten(
    (world, inertia): (&World, &Inertia),
    instant: &Instant,
    rate: f64,
    touches: &[&Near],
    v: &mut [f64],
    out: &mut Settled,
) {
    let bound = |t: &Near| rate.min(CHATTERING * reach_of(&t.row, instant.speeds));
    let slow = touches.iter().filter(|t| t.rate(v).abs() <= bound(t));
    let mut rows: Vec<Row> = Vec::new();
    for touch in slow {
        rows.push(touch.row);
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
    let free = |k: usize| rows[k].entries().filter(|&(i, _)| !freedom.is_held(i)).count();
    if active.iter().all(|&k| free(k) > active.len()) {
        return;
    }
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
