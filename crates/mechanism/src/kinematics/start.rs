//! Parts must not overlap at the start; they may touch, and meshing gear envelopes may overlap.

use super::bounds::Bounds;
use super::region::{Carrier, Region, with_leaves, within};
use super::work::Work;
use mainspring_geometry::{
    Csg, CsgOp, OutlineBudget, OutlineError, Part, Primitive, Rigid3, Vec2, Vec3, overlap_within,
};
use std::cell::Cell;

/// A point inside two parts at once, in machine coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clash {
    pub point: Vec3,
}

/// The parts as they stand at the start.
pub(crate) struct Start<'a> {
    pub primitives: &'a [Primitive],
    pub boxes: &'a [Bounds],
    pub plane_from_machine: Rigid3,
    pub tolerance: f64,
    /// Of the scans, and of the planar booleans.
    pub work: Work,
    pub budget: Cell<OutlineBudget>,
}

/// One part as it stands.
pub(crate) struct Extent<'a> {
    pub csg: &'a Csg,
    /// About all its primitives.
    pub bounds: Bounds,
    /// Of the finished part: tolerances are relative to it.
    pub size: f64,
}

impl<'a> Extent<'a> {
    pub(crate) fn of(csg: &'a Csg, primitives: &[Primitive], boxes: &[Bounds], plane: &Rigid3) -> Self {
        let bounds = csg.leaves().fold(Bounds::EMPTY, |b, i| b.join(&boxes[i as usize]));
        Extent { csg, bounds, size: Part { primitives, csg }.size(plane) }
    }
}

/// A mesh, by the primitives that are its envelopes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Envelopes {
    External([u32; 2]),
    Internal { pinion: u32 },
}

impl Start<'_> {
    /// Where two parts overlap, their meshes left out. If the work runs out, nothing is found.
    pub(crate) fn clash(&self, parts: [&Extent<'_>; 2], meshes: &[Envelopes]) -> Option<Clash> {
        self.work.open(PAIR_WORK);
        let bounds = parts.map(|p| &p.bounds);
        if !bounds[0].touches(bounds[1]) {
            return None;
        }
        let zone = bounds[0].common(bounds[1]).grown(4.0 * self.tolerance);
        let near = |csg: &Csg| with_leaves(csg, |i| self.boxes[i as usize].touches(&zone));
        let (a, b) = (near(&without_meshes(parts[0].csg, meshes)), near(parts[1].csg));
        let (primitives, plane) = (self.primitives, &self.plane_from_machine);
        let size = parts[0].size.max(parts[1].size);
        let parts = [&a, &b].map(|csg| Part { primitives, csg });
        let mut budget = self.budget.get();
        let found = budget.half(|left| overlap_within(parts[0], parts[1], plane, size, left));
        self.budget.set(budget);
        match found {
            Ok(found) => found.map(|o| Clash { point: self.lift(o.point, o.height) }),
            Err(OutlineError::Malformed { .. }) => None,
            Err(_) => self.scan([&a, &b], bounds),
        }
    }

    fn lift(&self, p: Vec2, height: f64) -> Vec3 {
        self.plane_from_machine.inverse().apply(Vec3::new(p.x, p.y, height))
    }

    /// Looks along lines through the common box in its three directions; every piece of a line between walls is
    /// judged at its middle. Overlaps narrower than the spacing of the lines can be missed.
    fn scan(&self, csgs: [&Csg; 2], bounds: [&Bounds; 2]) -> Option<Clash> {
        let zone = bounds[0].common(bounds[1]);
        let Bounds { low, high } = zone;
        let regions = csgs
            .map(|csg| Region::new(self.primitives, csg, self.boxes, &zone, Carrier::Space, self.tolerance));
        let work: usize = csgs.iter().map(|c| c.ops.len()).sum::<usize>()
            * regions.iter().map(|r| r.members.len()).sum::<usize>();
        let lines = LINES.min((MAX_WORK / work.max(1)).isqrt()).max(3);
        let size = high - low;
        let axes = [Vec3::new(size.x, 0., 0.), Vec3::new(0., size.y, 0.), Vec3::new(0., 0., size.z)];
        (0..3).find_map(|k| {
            let (w, u, v) = (axes[k], axes[(k + 1) % 3], axes[(k + 2) % 3]);
            (0..lines * lines).find_map(|i| {
                let spot = |i: usize, shift: f64| (i as f64 + shift) / lines as f64;
                let from = low + u * spot(i / lines, 0.4719) + v * spot(i % lines, 0.5283);
                along(&regions, from, w, self.tolerance, &self.work)
            })
        })
    }
}

/// Lines laid across the common box in each of two directions.
const LINES: usize = 40;
/// Bound on lines squared times set operations times primitives.
const MAX_WORK: usize = 20_000_000;

/// Bound on the work for two parts.
const PAIR_WORK: u64 = 4_000_000;

fn along(regions: &[Region; 2], from: Vec3, w: Vec3, tolerance: f64, work: &Work) -> Option<Clash> {
    let length = w.norm();
    if length <= tolerance || !work.spend(regions.iter().map(|r| r.members.len()).sum()) {
        return None;
    }
    let d = w * (1.0 / length);
    let mut cuts = vec![0.0, length];
    let threads = [0, 1].map(|i| regions[i].along(from, d));
    threads.iter().for_each(|t| t.crossings(from, d, &mut cuts));
    cuts.retain(|t| (0.0..=length).contains(t));
    cuts.sort_by(f64::total_cmp);
    let cost: usize = threads.iter().map(|t| t.cost()).sum();
    if !work.spend(cuts.len() * (cost + 1)) {
        return None;
    }
    let mut stack = Vec::new();
    cuts.windows(2).find_map(|c| {
        let point = from + d * within(c[0], c[1]);
        let thick = c[1] - c[0] > 1e3 * tolerance;
        (thick && threads.iter().all(|t| t.inside(point, d, &mut stack))).then_some(Clash { point })
    })
}

/// The part less the region of each mesh: what both envelopes share, or for an internal mesh all of the pinion
/// (its envelope reaches into the ring's material).
fn without_meshes(part: &Csg, meshes: &[Envelopes]) -> Csg {
    let mut ops = part.ops.clone();
    for mesh in meshes {
        match *mesh {
            Envelopes::External([a, b]) => ops.extend([CsgOp::Leaf(a), CsgOp::Leaf(b), CsgOp::Intersection]),
            Envelopes::Internal { pinion } => ops.push(CsgOp::Leaf(pinion)),
        }
        ops.push(CsgOp::Difference);
    }
    Csg { ops }
}
