//! Which parts can come near each other, by regions that hold all they can reach (after Gelsey 1995, Sec. 2.1.4).
//!
//! Used where surfaces are no prisms along the working plane's normal, so that planar contact cannot tell. Doubt
//! counts as touching.

use super::bounds::Bounds;
use super::pair::{Pair, PairKind};
use super::plane::is_prism;
use super::region::{Carrier, Region};
use super::subsystems::Hold;
use super::surface::{across, parallel};
use mainspring_geometry::{Csg, CurveId, Primitive, Vec3};

/// All parts with what holds them.
pub(crate) struct Parts<'a> {
    pub primitives: &'a [Primitive],
    pub boxes: &'a [Bounds],
    pub csgs: &'a [&'a Csg],
    /// Primitives of each part.
    pub leaves: &'a [Vec<u32>],
    pub holds: &'a [Option<Hold>],
    pub pairs: &'a [Pair],
    pub tolerance: f64,
}

/// Where something can get to: within a ring about an axis along the normal, or anywhere.
struct Reach {
    /// A point of the axis, and the greatest distance from it.
    ring: Option<(Vec3, f64)>,
    /// Along the normal.
    heights: (f64, f64),
    normal: Vec3,
}

impl Parts<'_> {
    /// Primitives of a part that are no prisms along the normal and do not serve a lower pair of the part.
    pub(crate) fn tilted(&self, part: usize, normal: Vec3) -> impl Iterator<Item = u32> + '_ {
        let serves = move |i: u32| {
            let of = |p: &Pair| -> Option<bool> {
                let side = if p.parts.0 == part {
                    0
                } else if p.parts.1 == part {
                    1
                } else {
                    return None;
                };
                Some(p.surfaces[side].contains(&CurveId { primitive: i, face: 0 }))
            };
            self.pairs.iter().filter(|p| p.is_lower()).any(|p| of(p) == Some(true))
        };
        let flat = move |i: &u32| is_prism(&self.primitives[*i as usize], normal) || serves(*i);
        self.leaves[part].iter().copied().filter(move |i| !flat(i))
    }

    /// Primitives of a part that are no prisms along the normal and that no other part can come near.
    pub(crate) fn unreached(&self, part: usize, normal: Vec3) -> Vec<u32> {
        let tilted =
            self.leaves[part].iter().copied().filter(|i| !is_prism(&self.primitives[*i as usize], normal));
        let near = |i: u32| (0..self.leaves.len()).any(|c| c != part && self.can_meet((part, i), c, normal));
        tilted.filter(|i| !near(*i)).collect()
    }

    /// Can a primitive of a part touch another part? Shaft and hole of the two parts' own pair are not counted; an
    /// unmoved part is asked primitive by primitive.
    pub(crate) fn can_meet(&self, (part, primitive): (usize, u32), other: usize, normal: Vec3) -> bool {
        let reach = self.reach(part, Some(primitive), normal);
        if self.holds[other].is_some() {
            return reach.near(&self.reach(other, None, normal));
        }
        let own = self
            .pairs
            .iter()
            .filter(|p| p.is_lower() && (p.parts == (part, other) || p.parts == (other, part)));
        let fitted: Vec<u32> = own.flat_map(|p| p.surfaces.iter().flatten()).map(|c| c.primitive).collect();
        let others = self.leaves[other].iter().filter(|i| !fitted.contains(i));
        others.into_iter().any(|&i| reach.near(&self.reach(other, Some(i), normal)))
    }

    /// Where a part (or one of its primitives) can get to.
    fn reach(&self, part: usize, only: Option<u32>, normal: Vec3) -> Reach {
        let all = || only.map_or_else(|| self.leaves[part].clone(), |i| vec![i]);
        let corners = || all().into_iter().flat_map(|i| self.boxes[i as usize].corners());
        let heights = corners()
            .map(|p| p.dot(normal))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        let unmoved = Reach { ring: None, heights, normal };
        let Some(hold) = self.holds[part] else {
            let box_ = all().into_iter().fold(Bounds::EMPTY, |b, i| b.join(&self.boxes[i as usize]));
            let middle = (box_.low + box_.high) * 0.5;
            return Reach { ring: Some((middle, 0.5 * box_.diagonal())), ..unmoved };
        };
        let pair = &self.pairs[hold.pair];
        let about_frame = self.holds[hold.carrier].is_none() && pair.kind.turns();
        if !about_frame || !parallel(pair.axis.direction, normal) {
            return unmoved;
        }
        let point = pair.axis.point;
        let outer = corners().map(|p| (p - point).cross(normal).norm()).fold(0.0, f64::max);
        Reach { ring: Some((point, outer)), ..unmoved }
    }
}

impl Reach {
    fn near(&self, other: &Reach) -> bool {
        if self.heights.0 > other.heights.1 || other.heights.0 > self.heights.1 {
            return false;
        }
        match (self.ring, other.ring) {
            (Some((p, r)), Some((q, s))) => (p - q).cross(self.normal).norm() <= r + s,
            _ => true,
        }
    }
}

/// Lines laid across a sliding part in each of two directions.
const LINES: usize = 40;
/// Bound on lines squared times set operations.
const MAX_WORK: usize = 20_000_000;

impl Parts<'_> {
    /// May two parts touch elsewhere than in the surfaces of their own pair?
    pub(crate) fn may_touch(&self, a: usize, b: usize, normal: Vec3) -> bool {
        let own = self.pairs.iter().find(|p| p.is_lower() && (p.parts == (a, b) || p.parts == (b, a)));
        if let Some(pair) = own.filter(|p| p.kind == PairKind::Prismatic) {
            return self.meet_sliding(a, b, pair.axis.direction);
        }
        let (moving, other) = if self.holds[a].is_some() { (a, b) } else { (b, a) };
        self.leaves[moving].iter().any(|&i| self.can_meet((moving, i), other, normal))
    }

    /// Is there a line along `d` through material of both? Only then can sliding bring them together.
    fn meet_sliding(&self, a: usize, b: usize, d: Vec3) -> bool {
        let around =
            |p: usize| self.leaves[p].iter().fold(Bounds::EMPTY, |x, i| x.join(&self.boxes[*i as usize]));
        let (zone, both) = (around(a), around(a).join(&around(b)));
        let regions = [a, b].map(|p| {
            Region::new(self.primitives, self.csgs[p], self.boxes, &both, Carrier::Space, self.tolerance)
        });
        let work: usize = regions.iter().map(|r| r.members.len()).sum::<usize>().pow(2);
        let lines = LINES.min((MAX_WORK / work.max(1)).isqrt()).max(3);
        let (u, v) = across(d);
        let range = |of: &Bounds, w: Vec3| {
            let at = of.corners().map(|p| p.dot(w));
            at.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)))
        };
        let (us, vs, span) = (range(&zone, u), range(&zone, v), range(&both, d));
        let spot = |(l, h): (f64, f64), i: usize, shift: f64| l + (h - l) * (i as f64 + shift) / lines as f64;
        (0..lines * lines).any(|k| {
            let from = u * spot(us, k / lines, 0.4719) + v * spot(vs, k % lines, 0.5283) + d * span.0;
            regions.iter().all(|r| r.crosses_material(from, d, span.1 - span.0))
        })
    }
}
