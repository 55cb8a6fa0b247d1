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
use super::work::Work;
use mainspring_geometry::{Csg, CurveId, Primitive, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// The shapes of all parts where they stand.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub primitives: &'a [Primitive],
    pub boxes: &'a [Bounds],
    pub csgs: &'a [&'a Csg],
    /// Primitives of each part, ascending.
    pub leaves: &'a [Vec<u32>],
    pub tolerance: f64,
}

/// All parts with what holds them, and where everything can get to.
pub(crate) struct Parts<'a> {
    pub placed: Placed<'a>,
    pub holds: &'a [Option<Hold>],
    pub pairs: &'a [Pair],
    pub normal: Vec3,
    /// Of each part, and of each of its primitives.
    whole: Vec<Reach>,
    single: Vec<Vec<Reach>>,
    /// A ring about the rings of all primitives.
    around: Vec<Reach>,
    /// Surfaces of the lower pairs, by their parts.
    fitted: BTreeMap<(usize, usize), Vec<CurveId>>,
    /// Primitives whose curved surface makes a lower pair.
    serving: BTreeSet<u32>,
    work: Work,
}

/// Bound on the regions compared; beyond it everything counts as near.
const MAX_COMPARED: u64 = 100_000_000;

/// Where something can get to: within a ring about an axis along the normal, or anywhere.
#[derive(Clone, Copy)]
struct Reach {
    /// A point of the axis, and the greatest distance from it.
    ring: Option<(Vec3, f64)>,
    /// Along the normal.
    heights: (f64, f64),
}

impl<'a> Parts<'a> {
    pub(crate) fn new(
        placed: Placed<'a>,
        holds: &'a [Option<Hold>],
        pairs: &'a [Pair],
        normal: Vec3,
    ) -> Self {
        let mut fitted: BTreeMap<(usize, usize), Vec<CurveId>> = BTreeMap::new();
        for pair in pairs.iter().filter(|p| p.is_lower()) {
            fitted.entry(pair.parts).or_default().extend(pair.surfaces.iter().flatten());
        }
        let round = fitted.values().flatten().filter(|c| c.face == 0);
        let serving = round.map(|c| c.primitive).collect();
        let (whole, single, around) = (vec![], vec![], vec![]);
        let work = Work::new(MAX_COMPARED);
        let mut parts = Parts { placed, holds, pairs, normal, whole, single, around, fitted, serving, work };
        for (part, leaves) in placed.leaves.iter().enumerate() {
            let single: Vec<Reach> = leaves.iter().map(|i| parts.reach(part, &[*i])).collect();
            let whole = parts.reach(part, leaves);
            parts.around.push(whole.around(&single, normal));
            parts.whole.push(whole);
            parts.single.push(single);
        }
        parts
    }

    fn is_flat(&self, i: u32) -> bool {
        is_prism(&self.placed.primitives[i as usize], self.normal)
    }

    /// Primitives of a part that are no prisms along the normal and do not serve a lower pair, as positions in the
    /// part's list.
    pub(crate) fn tilted(&self, part: usize) -> Vec<usize> {
        let leaves = &self.placed.leaves[part];
        let serves = |i: u32| self.serving.contains(&i);
        (0..leaves.len()).filter(|k| !self.is_flat(leaves[*k]) && !serves(leaves[*k])).collect()
    }

    /// Primitives of a part that are no prisms along the normal and that no other part can come near.
    pub(crate) fn unreached(&self, part: usize) -> Vec<u32> {
        let leaves = &self.placed.leaves[part];
        let near = |k: usize| (0..self.whole.len()).any(|c| c != part && self.can_meet((part, k), c));
        let tilted = (0..leaves.len()).filter(|k| !self.is_flat(leaves[*k]));
        tilted.filter(|k| !near(*k)).map(|k| leaves[k]).collect()
    }

    /// Can a primitive of a part (by its position in the part's list) touch another part? Shaft and hole of the two
    /// parts' own pair are not counted; an unmoved part is asked primitive by primitive.
    pub(crate) fn can_meet(&self, (part, position): (usize, usize), other: usize) -> bool {
        if !self.work.spend(1) {
            return true;
        }
        let reach = &self.single[part][position];
        if self.holds[other].is_some() {
            return reach.near(&self.whole[other], self.normal);
        }
        if !reach.near(&self.around[other], self.normal) {
            return false;
        }
        if !self.work.spend(self.single[other].len()) {
            return true;
        }
        let fitted = self.fitted.get(&(part.min(other), part.max(other)));
        let serves = |i: u32| fitted.is_some_and(|f| f.iter().any(|c| c.primitive == i));
        let mut others = self.single[other].iter().zip(&self.placed.leaves[other]);
        others.any(|(r, i)| reach.near(r, self.normal) && !serves(*i))
    }

    /// Where some primitives of a part can get to.
    fn reach(&self, part: usize, primitives: &[u32]) -> Reach {
        let boxes = || primitives.iter().map(|i| &self.placed.boxes[*i as usize]);
        let corners = || boxes().flat_map(Bounds::corners);
        let heights = corners()
            .map(|p| p.dot(self.normal))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        let unmoved = Reach { ring: None, heights };
        let Some(hold) = self.holds[part] else {
            let all = boxes().fold(Bounds::EMPTY, |b, i| b.join(i));
            return Reach { ring: Some(((all.low + all.high) * 0.5, 0.5 * all.diagonal())), ..unmoved };
        };
        let pair = &self.pairs[hold.pair];
        let about_frame = self.holds[hold.carrier].is_none() && pair.kind.turns();
        if !about_frame || !parallel(pair.axis.direction, self.normal) {
            return unmoved;
        }
        let point = pair.axis.point;
        let outer = corners().map(|p| (p - point).cross(self.normal).norm()).fold(0.0, f64::max);
        Reach { ring: Some((point, outer)), ..unmoved }
    }
}

impl Reach {
    fn near(&self, other: &Reach, normal: Vec3) -> bool {
        if self.heights.0 > other.heights.1 || other.heights.0 > self.heights.1 {
            return false;
        }
        match (self.ring, other.ring) {
            (Some((p, r)), Some((q, s))) => (p - q).cross(normal).norm() <= r + s,
            _ => true,
        }
    }

    /// The same heights, and a ring about the rings of some others; a hair wider, so that rounding hides nothing.
    fn around(self, others: &[Reach], normal: Vec3) -> Reach {
        let Some((point, radius)) = self.ring else { return self };
        let to = |r: &Reach| r.ring.map_or(f64::INFINITY, |(p, s)| (p - point).cross(normal).norm() + s);
        let widest = others.iter().map(to).fold(radius, f64::max);
        Reach { ring: Some((point, widest * (1.0 + 1e-9))), ..self }
    }
}

/// Lines laid across a sliding part in each of two directions.
const LINES: usize = 40;
/// What following a line past one primitive costs, in regions compared.
const LINE: usize = 8;
/// Bound on lines squared times set operations.
const MAX_WORK: usize = 20_000_000;

impl Parts<'_> {
    /// May two parts touch elsewhere than in the surfaces of their own pair?
    pub(crate) fn may_touch(&self, a: usize, b: usize) -> bool {
        if !self.around[a].near(&self.around[b], self.normal) {
            return false;
        }
        if self.fitted.contains_key(&(a.min(b), a.max(b))) {
            let own = self.pairs.iter().find(|p| p.is_lower() && (p.parts == (a, b) || p.parts == (b, a)));
            if let Some(pair) = own.filter(|p| p.kind == PairKind::Prismatic) {
                return self.meet_sliding(a, b, pair.axis.direction);
            }
        }
        let (moving, other) = if self.holds[a].is_some() { (a, b) } else { (b, a) };
        (0..self.single[moving].len()).any(|k| self.can_meet((moving, k), other))
    }

    /// Is there a line along `d` through material of both? Only then can sliding bring them together.
    fn meet_sliding(&self, a: usize, b: usize, d: Vec3) -> bool {
        let Placed { primitives, boxes, csgs, leaves, tolerance } = self.placed;
        let around = |p: usize| leaves[p].iter().fold(Bounds::EMPTY, |x, i| x.join(&boxes[*i as usize]));
        let (zone, both) = (around(a), around(a).join(&around(b)));
        let regions =
            [a, b].map(|p| Region::new(primitives, csgs[p], boxes, &both, Carrier::Space, tolerance));
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
            !self.work.spend(LINE * regions.iter().map(|r| r.members.len()).sum::<usize>())
                || regions.iter().all(|r| r.crosses_material(from, d, span.1 - span.0))
        })
    }
}
