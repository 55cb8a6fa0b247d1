//! After which changes of a coordinate a machine looks the same to all that can touch.
//!
//! A motion seen a few times goes on for ever only if the shapes that meet are the same each time. A wheel that turns on by
//! a tooth looks the same if every tooth does; one with a tooth missing only after a whole turn, a rack never again.

use crate::interaction::{Interaction, System};
use crate::repeats::{Mark, order};
use crate::system::{Body, Motion};
use mainspring_geometry::{Segment, Vec2};
use std::f64::consts::TAU;

/// Boundaries this near (relative to the size) are the same.
const SAME: f64 = 1e-9;

impl System {
    /// For each coordinate the changes (radians or the file's length) to a multiple of each of which its shapes are bound: any
    /// other change shows. Infinite where every change shows: a slide, a turn between stops. None for what nothing can touch.
    /// Only outlines are compared, never what springs and gravity do.
    pub fn shape_periods(&self) -> Vec<Vec<f64>> {
        let mut periods = vec![vec![]; self.coordinates.len()];
        for stop in &self.forces.stops {
            periods[stop.coordinate].push(f64::INFINITY);
        }
        for interaction in &self.interactions {
            self.add_periods(interaction, &mut periods);
        }
        for list in &mut periods {
            list.sort_by(f64::total_cmp);
            list.dedup();
        }
        periods
    }

    fn add_periods(&self, interaction: &Interaction, periods: &mut [Vec<f64>]) {
        let (a, b) = (&self.bodies[interaction.bodies.0], &self.bodies[interaction.bodies.1]);
        let shared = a.chain.iter().zip(&b.chain).take_while(|(j, k)| j == k).count();
        for (body, other) in [(a, b), (b, a)] {
            for (k, joint) in body.chain.iter().enumerate().skip(shared) {
                let Motion::Turn { center } = joint.motion else {
                    periods[joint.coordinate].push(f64::INFINITY);
                    continue;
                };
                // It is enough that one of the two looks the same, if that one is where it was modelled about the axis.
                let still = k == shared && other.chain.len() == shared;
                let own = (k + 1 == body.chain.len()).then(|| self.order(body, other, center, still));
                let others = still.then(|| self.order(other, body, center, false));
                let orders = || own.iter().chain(&others);
                if orders().any(Option::is_none) {
                    continue;
                }
                let most = orders().flatten().copied().max().unwrap_or(1);
                periods[joint.coordinate].push(TAU / (f64::from(most) * joint.ratio.abs()));
            }
        }
    }

    /// The order of a body's symmetry about an axis, as far as the other body can reach; None if all turns look alike.
    /// `still`: the other one stays where it is modelled.
    fn order(&self, body: &Body, other: &Body, axis: Vec2, still: bool) -> Option<u32> {
        let nearest = least_distance(other, axis, still);
        let heights = |b: &Body| b.outline.layers.iter().map(|l| (l.bottom, l.top)).collect::<Vec<_>>();
        let (faced, little) = (heights(other), SAME * self.size);
        let common = |l: (f64, f64)| faced.iter().any(|o| l.1.min(o.1) - l.0.max(o.0) > little);
        let layers = body.outline.layers.iter().filter(|l| common((l.bottom, l.top)));
        let marks = |layer: &mainspring_geometry::Layer| {
            let edges = layer.loops.iter().flat_map(|l| &l.edges);
            let near = edges.filter(|e| reach(&e.segment, axis).1 >= nearest - little);
            near.map(|e| mark(&e.segment, axis)).collect()
        };
        order(&layers.map(marks).collect::<Vec<_>>(), little)
    }
}

fn mark(segment: &Segment, axis: Vec2) -> Mark {
    let (middle, radius) = match *segment {
        Segment::Line { .. } => (segment.at(0.5), 0.0),
        Segment::Arc { radius, .. } => (segment.at(0.5), radius),
        Segment::Circle { center, radius, .. } => (center, radius),
    };
    Mark { middle: middle - axis, ends: [segment.start() - axis, segment.end() - axis], radius, counts: true }
}

/// Bounds of the distances of a segment's points from an axis.
fn reach(segment: &Segment, axis: Vec2) -> (f64, f64) {
    let middle = segment.at(0.5);
    let (distance, half) = ((middle - axis).norm(), 0.5 * segment.length());
    ((distance - half).max(0.0), distance + half)
}

/// No point of a body ever comes nearer to an axis than this. Told of bodies that stay or turn about one axis; else 0.
fn least_distance(body: &Body, axis: Vec2, still: bool) -> f64 {
    let segments =
        || body.outline.layers.iter().flat_map(|l| &l.loops).flat_map(|l| &l.edges).map(|e| &e.segment);
    if still {
        return segments().map(|s| reach(s, axis).0).fold(f64::INFINITY, f64::min);
    }
    let [joint] = body.chain.as_slice() else { return 0.0 };
    let Motion::Turn { center } = joint.motion else { return 0.0 };
    let farthest = segments().map(|s| reach(s, center).1).fold(0.0, f64::max);
    ((center - axis).norm() - farthest).max(0.0)
}
