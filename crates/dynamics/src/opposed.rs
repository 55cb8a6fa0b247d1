//! The two faces of a groove: contacts whose gaps have a constant sum.
//!
//! A round feature between two parallel edges of one body that face each other, or between a hollow and a round about one
//! centre, is as far from the one as it is near to the other: g + g′ = c, however the bodies move. The same holds of any
//! two round features between such edges if the bodies do not turn against each other. While one of the two is closed,
//! the gap of the other is c.

use crate::inertia::Inertia;
use crate::linear::Cholesky;
use crate::settle::Closed;
use crate::world::World;
use mainspring_geometry::Vec2;
use mainspring_mechanism::{Candidate, Feature, FeatureShape, GapKind, Row};

/// Directions and places that agree to this (radians; shares of the machine's size) are the same.
const SAME: f64 = 1e-14;

/// Have the gaps of two contacts a constant sum?
pub fn are_opposed(world: &World, one: &Candidate, other: &Candidate) -> bool {
    use GapKind::{RoundEdge, RoundHollow, RoundRound};
    if one.id.interaction != other.id.interaction || one.id.stop().or(other.id.stop()).is_some() {
        return false;
    }
    let (a, b) = (world.features(one), world.features(other));
    let near = |a: &Feature, b: &Feature| same_center(a, b, SAME * world.system.size);
    match (one.kind, other.kind) {
        (RoundEdge { swapped: s }, RoundEdge { swapped: t }) => {
            let (round, edge) = if s { (a.1, a.0) } else { (a.0, a.1) };
            let (other_round, other_edge) = if t { (b.1, b.0) } else { (b.0, b.1) };
            let apart = |n: Vec2, m: Vec2| (n + m).norm() <= SAME;
            let facing = match (normal(edge), normal(other_edge)) {
                (Some(n), Some(m)) => apart(n, if s == t { m } else { -m }),
                _ => false,
            };
            facing && (s == t && near(round, other_round) || !turns(world, one))
        }
        (RoundHollow { .. }, RoundRound) | (RoundRound, RoundHollow { .. }) => {
            near(a.0, b.0) && near(a.1, b.1)
        }
        _ => false,
    }
}

/// What two faces of a groove hold between them stays so even at an instant at which neither carries force: one of them
/// becomes active, if that leaves the active rows independent. `rows` are those of the closed contacts.
pub fn hold_between(world: &World, rows: &[Row], state: (&[f64], &[f64]), closed: &mut [Closed]) {
    let opposed = |i: usize, all: &[Closed]| {
        all.iter().any(|other| are_opposed(world, &all[i].candidate, &other.candidate))
    };
    if !(0..closed.len()).any(|i| !closed[i].active && opposed(i, closed)) {
        return;
    }
    let inertia = Inertia::whole(world.system, &world.free, state);
    let mut held: Vec<Row> = closed.iter().zip(rows).filter(|(c, _)| c.active).map(|(_, row)| *row).collect();
    for i in 0..closed.len() {
        if closed[i].active || !opposed(i, closed) {
            continue;
        }
        held.push(rows[i]);
        closed[i].active = Cholesky::new(inertia.inverse(&held), held.len()).is_some();
        if !closed[i].active {
            held.pop();
        }
    }
}

/// Do the bodies of a contact turn against each other?
fn turns(world: &World, c: &Candidate) -> bool {
    world.arms[c.id.interaction as usize].iter().any(|arm| arm.turn > 0.0)
}

fn normal(edge: &Feature) -> Option<Vec2> {
    match edge.shape {
        FeatureShape::Edge { normal, .. } => Some(normal),
        _ => None,
    }
}

fn same_center(a: &Feature, b: &Feature, within: f64) -> bool {
    let center = |f: &Feature| -> Option<Vec2> {
        match f.shape {
            FeatureShape::Round { center, .. } | FeatureShape::Hollow { center, .. } => Some(center),
            FeatureShape::Edge { .. } => None,
        }
    };
    center(a).zip(center(b)).is_some_and(|(a, b)| (a - b).norm() <= within)
}
