//! At one place contacts are alternatives: two convex corners overlap only if every separating line fails.
//!
//! Near a convex corner Q a round feature may touch either of Q's edges, and if it is a corner P, Q may touch
//! either of P's edges. Of those whose normals the corners allow the largest gap counts; among equal gaps the
//! largest rate. At different places, and at concave corners, contacts act together.

use crate::linear::Small;
use crate::near::{Near, rate_tolerance};
use crate::search::{BAND, OVERLAP, TOGETHER};
use crate::settle::Closed;
use crate::world::{Touch, World};
use mainspring_mechanism::{Candidate, ContactId, Feature, FeatureShape, GapKind};

/// Does a contact that touches stand for its place at velocities `v`? Those `closed` before are preferred among equals.
pub fn stands_for_its_place(
    world: &mut World,
    near: &Near,
    (q, v): (&[f64], &[f64]),
    closed: &[Closed],
) -> bool {
    if !is_eligible(world, &near.touch, q, v) {
        return false;
    }
    let others = alternatives(world, &near.touch);
    others.is_empty() || prevails(world, &near.touch, &others, (near.rate(v), near.still), (q, v), closed)
}

/// Is a contact about to close really one: on its features, not running off them, and standing for its place?
pub fn is_standing(world: &mut World, touch: &Touch, q: &[f64], v: &[f64], speeds: &[f64]) -> bool {
    if !is_eligible(world, touch, q, v) {
        return false;
    }
    let others = alternatives(world, touch);
    others.is_empty()
        || prevails(world, touch, &others, (touch.rate(v), rate_tolerance(&touch.row(), speeds)), (q, v), &[])
}

/// Is the contact point on both features, and not on its way off them?
pub fn is_eligible(world: &mut World, touch: &Touch, q: &[f64], v: &[f64]) -> bool {
    let size = world.system.size;
    let margin = touch.margin(size);
    if margin >= BAND * size {
        return true;
    }
    margin >= -BAND * size && !is_leaving(world, touch, q, v)
}

/// Does the contact point run towards the near end? By a difference along the velocity.
fn is_leaving(world: &mut World, touch: &Touch, q: &[f64], v: &[f64]) -> bool {
    let size = world.system.size;
    let arms = &world.arms[touch.candidate.id.interaction as usize];
    let speed: f64 = arms.iter().map(|arm| (arm.length + arm.turn * size) * v[arm.coordinate].abs()).sum();
    if speed == 0.0 {
        return false;
    }
    let dt = 1e-6 * size / speed;
    let ahead: Small<f64, 8> = q.iter().zip(v).map(|(q, v)| q + dt * v).collect();
    let (a, b) = world.place(&touch.candidate, &ahead);
    let later = world.touch(&touch.candidate, (&a, &b));
    later.margin(size) < touch.margin(size) - 1e-13 * size
}

/// Does this contact stand for its place against its alternatives? Rates that differ by less than `still` are equal.
fn prevails(
    world: &mut World,
    touch: &Touch,
    others: &[Candidate],
    (rate, still): (f64, f64),
    (q, v): (&[f64], &[f64]),
    closed: &[Closed],
) -> bool {
    let size = world.system.size;
    for other in others {
        let other = world.touch(other, touch.placed);
        if !is_eligible(world, &other, q, v) || other.state.gap < -OVERLAP * size {
            continue;
        }
        if other.state.gap > TOGETHER * size {
            return false;
        }
        let ahead = other.rate(v) - rate;
        let preferred = |id: ContactId| (!closed.iter().any(|c| c.candidate.id == id), id);
        let tie = preferred(other.candidate.id) < preferred(touch.candidate.id);
        if ahead > still || (ahead >= -still && tie) {
            return false;
        }
    }
    true
}

/// Contacts that are alternatives to this one: none unless it is at an edge's end that is a convex corner.
fn alternatives(world: &World, touch: &Touch) -> Small<Candidate> {
    let candidate = &touch.candidate;
    let GapKind::RoundEdge { swapped } = candidate.kind else { return Small::new() };
    if touch.state.edge_margin > BAND * world.system.size {
        return Small::new();
    }
    let bodies = world.bodies(candidate);
    let (first, second) = (candidate.id.first as usize, candidate.id.second as usize);
    let (round, edge, round_body, edge_body) =
        if swapped { (second, first, bodies.1, bodies.0) } else { (first, second, bodies.0, bodies.1) };
    let (rounds, edges) = (&world.system.features[round_body], &world.system.features[edge_body]);
    let Some(corner) = corner_at(edges, edge, touch.state.near_end) else { return Small::new() };
    let mut pairs: Small<(usize, usize)> =
        edges[corner].neighbours.iter().filter(|&&e| e != edge).map(|&e| (round, e)).collect();
    pairs.push((round, corner));
    if rounds[round].is_corner() {
        pairs.extend(rounds[round].neighbours.iter().map(|&f| (f, corner)));
    }
    pairs
        .iter()
        .filter_map(|&(r, e)| candidate_of(world, candidate, if swapped { (e, r) } else { (r, e) }))
        .collect()
}

/// The convex corner at one end of an edge.
fn corner_at(features: &[Feature], edge: usize, at_end: bool) -> Option<usize> {
    let FeatureShape::Edge { from, to, .. } = features[edge].shape else { return None };
    let end = if at_end { to } else { from };
    let other = if at_end { from } else { to };
    let near = |i: &usize| (features[*i].center - end).norm() < (features[*i].center - other).norm();
    features[edge].neighbours.iter().copied().find(near)
}

fn candidate_of(world: &World, like: &Candidate, ids: (usize, usize)) -> Option<Candidate> {
    let interaction = like.id.interaction;
    let pair = &world.system.interactions[interaction as usize];
    let features =
        (&world.system.features[pair.bodies.0][ids.0], &world.system.features[pair.bodies.1][ids.1]);
    let kind = pair.kind(ids, features)?;
    let id = ContactId { interaction, first: ids.0 as u32, second: ids.1 as u32 };
    Some(Candidate { id, kind, distance: 0.0 })
}
