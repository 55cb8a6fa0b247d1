//! What touches at an instant, evaluated once, and what of it stands for its place at given velocities.

use crate::linear::Small;
use crate::place::stands_for_its_place;
use crate::search::{OVERLAP, TOGETHER};
use crate::settle::Instant;
use crate::world::{Touch, World, stop_candidate};
use mainspring_mechanism::{Placed, Relative, Row, gap_between};

/// Rates below this fraction of the speeds at hand count as zero.
const STILL: f64 = 1e-10;

/// A contact that touches, with what does not depend on velocities.
#[derive(Clone, Copy, Debug)]
pub struct Near<'p> {
    pub touch: Touch<'p>,
    /// ∂g/∂q.
    pub row: Row,
    /// Rates below this count as zero.
    pub still: f64,
}

/// Some of the contacts that touch.
pub type Chosen<'n, 'p> = Small<&'n Near<'p>, 8>;

impl<'p> Near<'p> {
    /// `speeds` are the greatest so far, for tolerances.
    pub fn new(touch: Touch<'p>, speeds: &[f64]) -> Self {
        let row = touch.row();
        Self { touch, row, still: rate_tolerance(&row, speeds) }
    }

    /// ġ at velocities `v`.
    pub fn rate(&self, v: &[f64]) -> f64 {
        self.row.dot(v)
    }
}

/// Below this a rate of closing counts as zero.
pub fn rate_tolerance(row: &Row, speeds: &[f64]) -> f64 {
    STILL * reach_of(row, speeds)
}

/// The greatest rate that the greatest speeds so far could give.
pub fn reach_of(row: &Row, speeds: &[f64]) -> f64 {
    row.entries().map(|(i, g)| g.abs() * speeds[i]).sum()
}

/// Every contact closed to `TOGETHER` at the instant, wherever along its features.
pub fn near_touches<'p>(world: &mut World, instant: &Instant, placed: &'p [Placed<'p>]) -> Vec<Near<'p>> {
    let (within, deep) = (TOGETHER * world.system.size, OVERLAP * world.system.size);
    let q = instant.q;
    let mut found = Vec::with_capacity(4);
    for interaction in 0..world.arms.len() {
        let (travelled, _) = world.refresh(interaction, q, 2.0 * deep);
        let (a, b) = world.system.interactions[interaction].bodies;
        let pose = Relative::pose(&placed[a].pose, &placed[b].pose);
        for k in 0..world.listed(interaction).len() {
            let candidate = world.listed(interaction)[k];
            if candidate.distance - travelled > 2.0 * deep {
                continue;
            }
            world.evaluations += 1;
            let gap = gap_between(candidate.kind, world.features(&candidate), &pose);
            if gap <= within && gap >= -deep {
                found.push(Near::new(world.touch_among(&candidate, q, placed), instant.speeds));
            }
        }
    }
    for k in world.stops() {
        let touch = world.touch_among(&stop_candidate(k), q, placed);
        if touch.state.gap <= within {
            found.push(Near::new(touch, instant.speeds));
        }
    }
    found
}

/// Of the contacts that touch those that stand for their place at velocities `v`; one that leaves is left out unless it
/// would overlap.
pub fn choose<'n, 'p>(
    world: &mut World,
    instant: &Instant,
    near: &'n [Near<'p>],
    v: &[f64],
) -> Chosen<'n, 'p> {
    let mut chosen = Chosen::new();
    for one in near {
        let leaves = Some(one.touch.candidate.id) == instant.leaving && one.rate(v) >= -one.still;
        if !leaves && stands_for_its_place(world, one, (instant.q, v), instant.closed) {
            chosen.push(one);
        }
    }
    chosen
}
