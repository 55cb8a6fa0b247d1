//! The 2½-dimensional rule: freedoms that shape allows and nothing uses.
//!
//! Read strictly, a wheel may slide along its shaft. A cylindrical pair with its axis along the normal of the
//! working plane loses its sliding, one with its axis in the plane its turning, if no spring, force, initial
//! velocity, other pair or possible contact normal has a component along that freedom. Springs, friction and
//! initial velocities of the supplement act on the freedom that stays. Other pairs are asked by their equations:
//! the motions of all other freedoms must stay the same. Contact normals lie in the working plane where parts are
//! prisms along its normal; surfaces that are not must be out of reach.

use super::bounds::Bounds;
use super::mobility::Loops;
use super::pair::{Freedom, Pair, PairKind};
use super::plane::is_prism;
use super::subsystems::Hold;
use super::surface::{parallel, perpendicular};
use mainspring_geometry::{CurveId, Primitive, Vec3};

/// What the rule decides: freedoms to leave out, and pairs that keep two with the reason.
#[derive(Debug, Default)]
pub(crate) struct Idle {
    pub left_out: Vec<(usize, Freedom)>,
    pub kept: Vec<(usize, String)>,
}

/// The parts as the rule sees them.
pub(crate) struct Parts<'a> {
    pub primitives: &'a [Primitive],
    pub boxes: &'a [Bounds],
    /// Primitives of each part.
    pub leaves: &'a [Vec<u32>],
    pub holds: &'a [Option<Hold>],
    pub pairs: &'a [Pair],
    pub label: &'a dyn Fn(u32) -> String,
}

pub(crate) fn idle(parts: &Parts<'_>, normal: Vec3, loops: &[Loops]) -> Idle {
    let mut result = Idle::default();
    let mut wanted: Vec<(usize, Freedom)> = Vec::new();
    for (index, pair) in parts.pairs.iter().enumerate().filter(|(_, p)| p.kind == PairKind::Cylindrical) {
        let d = pair.axis.direction;
        if perpendicular(d, normal) {
            wanted.push((index, Freedom::Turning));
        } else if parallel(d, normal) {
            match axial_contact(parts, pair, normal) {
                None => wanted.push((index, Freedom::Sliding)),
                Some(label) => result.kept.push((index, format!("{label} may be touched along the axis"))),
            }
        } else {
            result
                .kept
                .push((index, "its axis is neither along nor across the working plane's normal".into()));
        }
    }
    let alone = |w: &&(usize, Freedom)| !loops.iter().any(|l| l.has(w.0));
    result.left_out.extend(wanted.iter().filter(alone));
    for l in loops {
        let here: Vec<_> = wanted.iter().copied().filter(|w| l.has(w.0)).collect();
        let chosen = if l.idle(&here) { here.clone() } else { one_by_one(l, &here) };
        for w in here.iter().filter(|w| !chosen.contains(w)) {
            result.kept.push((w.0, "other pairs use both its freedoms".into()));
        }
        result.left_out.extend(chosen);
    }
    result
}

fn one_by_one(l: &Loops, wanted: &[(usize, Freedom)]) -> Vec<(usize, Freedom)> {
    let mut chosen = Vec::new();
    for w in wanted {
        chosen.push(*w);
        if !l.idle(&chosen) {
            chosen.pop();
        }
    }
    chosen
}

/// A surface that may be touched along the axis of the pair: the name of its primitive.
fn axial_contact(parts: &Parts<'_>, pair: &Pair, normal: Vec3) -> Option<String> {
    let (a, b) = pair.parts;
    let moving = |p: usize| parts.holds[p].is_some();
    for m in [a, b].into_iter().filter(|p| moving(*p)) {
        for c in (0..parts.leaves.len()).filter(|c| *c != m) {
            let tilted = |p: usize, other: usize| {
                parts.tilted(p, normal).find(|&i| parts.can_meet((p, i), other, normal))
            };
            if let Some(i) = tilted(m, c).or_else(|| tilted(c, m)) {
                return Some((parts.label)(i));
            }
        }
    }
    None
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
    fn tilted(&self, part: usize, normal: Vec3) -> impl Iterator<Item = u32> + '_ {
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

    /// Can a primitive of a part touch another part? Shaft and hole of the two parts' own pair are not counted; an
    /// unmoved part is asked primitive by primitive.
    fn can_meet(&self, (part, primitive): (usize, u32), other: usize, normal: Vec3) -> bool {
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
