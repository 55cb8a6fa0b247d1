//! Boundaries that cross: where they do so throughout a box of configurations, the whole box is blocked.
//!
//! Two spans that cross an odd number of times go on crossing for as long as no end of one meets the other: the number's
//! parity cannot change otherwise. Each then passes from one side of the other to its other side, so material of both
//! bodies overlaps. It is enough that at the box's centre every end is farther from the other span than both move.

use crate::moving::Moving;
use crate::reduce::relative;
use crate::region::{Ignored, Regions};
use crate::section::Section;
use mainspring_mechanism::Pose;

/// Pairs of tree nodes looked at for one box at most.
const EFFORT: usize = 1500;
/// Pairs of leaves remembered.
const REMEMBERED: usize = 8;

/// Leaves whose spans crossed throughout boxes lately, by pair of sections: likely to do so in the next one too.
#[derive(Debug, Default)]
pub(crate) struct Crossed {
    leaves: [Option<(usize, u32, u32)>; REMEMBERED],
    next: usize,
}

/// Is every configuration within half widths `half` of these poses surely blocked? False, after looking at `effort` pairs
/// of tree nodes or all, means nothing.
pub(crate) fn cross_throughout(
    regions: &Regions,
    moving: &[Moving; 2],
    poses: &[Pose; 2],
    half: [f64; 2],
    crossed: &mut Crossed,
    effort: usize,
) -> bool {
    let (rel, rounding) = (relative(&poses[0], &poses[1]), 1e3 * regions.rounding);
    let two = |f: usize| {
        let (i, j, _) = &regions.facing[f];
        Two { a: &regions.sections[0][*i], b: &regions.sections[1][*j], moving, rel, half, rounding }
    };
    if crossed.leaves.iter().flatten().any(|&(f, i, j)| two(f).cross(i, j)) {
        return true;
    }
    for (f, (.., ignored)) in regions.facing.iter().enumerate() {
        if let Some((i, j)) = two(f).find(ignored, effort) {
            crossed.leaves[crossed.next % REMEMBERED] = Some((f, i, j));
            crossed.next += 1;
            return true;
        }
    }
    false
}

/// Two sections about a configuration.
struct Two<'a> {
    a: &'a Section,
    b: &'a Section,
    moving: &'a [Moving; 2],
    /// b_from_a
    rel: Pose,
    half: [f64; 2],
    rounding: f64,
}

impl Two<'_> {
    /// Leaves whose spans cross throughout, if they are found soon.
    fn find(&self, ignored: &Ignored, effort: usize) -> Option<(u32, u32)> {
        let (ta, tb) = (&self.a.tree, &self.b.tree);
        let mut pending =
            if ta.nodes.is_empty() || tb.nodes.is_empty() { vec![] } else { vec![(0u32, 0u32)] };
        for _ in 0..effort.min(EFFORT) {
            let (i, j) = pending.pop()?;
            let (m, n) = (&ta.nodes[i as usize], &tb.nodes[j as usize]);
            if !self.may_cross(i, j) {
                continue;
            }
            if m.leaf && n.leaf {
                if !ignored.contains(&(m.link, n.link)) && self.cross(i, j) {
                    return Some((i, j));
                }
            } else if !m.leaf && (n.leaf || m.radius >= n.radius) {
                pending.extend(ta.children(i).map(|k| (k, j)));
            } else {
                pending.extend(tb.children(j).map(|k| (i, k)));
            }
        }
        None
    }

    /// May spans under two nodes cross, and are they long enough to do so throughout?
    fn may_cross(&self, i: u32, j: u32) -> bool {
        let (m, n) = (&self.a.tree.nodes[i as usize], &self.b.tree.nodes[j as usize]);
        let reach = m.radius + n.radius;
        let shorter = self.a.greatest[i as usize].min(self.b.greatest[j as usize]);
        let apart = self.rel.apply(m.center) - n.center;
        self.motion([-m.radius, -n.radius], [m.arm, n.arm]) < 2.0 * shorter
            && apart.dot(apart) <= reach * reach
    }

    /// How far points at these distances from the origins, give or take a radius, move against each other.
    fn motion(&self, radii: [f64; 2], arms: [f64; 2]) -> f64 {
        (0..2).map(|k| self.half[k] * self.moving[k].lever_of(arms[k], radii[k])).sum()
    }

    fn cross(&self, i: u32, j: u32) -> bool {
        let (m, n) = (&self.a.tree.nodes[i as usize], &self.b.tree.nodes[j as usize]);
        let (s, t) = (m.link as usize, n.link as usize);
        if self.a.features[s] == usize::MAX || self.b.features[t] == usize::MAX {
            return false;
        }
        let (first, second) = (self.a.spans[s].placed(&self.rel), self.b.spans[t]);
        let motion = self.motion([m.radius, n.radius], [m.arm, n.arm]) + self.rounding;
        second.ends().iter().all(|p| first.distance_to_point(*p) > motion)
            && first.ends().iter().all(|p| second.distance_to_point(*p) > motion)
            && first.crossings(&second) % 2 == 1
    }
}
