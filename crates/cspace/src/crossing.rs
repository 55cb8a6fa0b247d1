//! Boundaries that cross: where they do so throughout a box of configurations, the whole box is blocked.
//!
//! Two spans that cross an odd number of times go on crossing for as long as no end of one meets the other: the number's
//! parity cannot change otherwise. Each then passes from one side of the other to its other side, so material of both
//! bodies overlaps. It is enough that at the box's centre every end is farther from the other span than both move.

use crate::around::Around;
use crate::recent::Recent;
use crate::region::{Ignored, Regions};
use crate::section::Section;
use crate::tree::{Discs, PENDING};

/// Pairs of tree nodes looked at for one box at most.
const EFFORT: usize = 1500;
/// Leaves whose spans crossed throughout boxes lately, by pair of sections: likely to do so in the next one too.
#[derive(Debug, Default)]
pub(crate) struct Crossed(Recent<(usize, (u32, u32))>);

impl Crossed {
    /// Is every configuration of the box surely blocked? False, after looking at `effort` pairs of tree nodes or all, means
    /// nothing.
    pub fn throughout(&mut self, regions: &Regions, around: &Around, effort: usize) -> bool {
        let facing = |f: usize| {
            let (i, j, ignored) = &regions.facing[f];
            ([&regions.sections[0][*i], &regions.sections[1][*j]], ignored)
        };
        if self.0.iter().any(|&(f, leaves)| cross(facing(f).0, around, leaves)) {
            return true;
        }
        for f in 0..regions.facing.len() {
            let (sections, ignored) = facing(f);
            if let Some(leaves) = find(sections, ignored, around, effort.min(EFFORT)) {
                self.0.remember((f, leaves));
                return true;
            }
        }
        false
    }
}

/// Leaves whose spans cross throughout, if they are found soon.
fn find(sections: [&Section; 2], ignored: &Ignored, around: &Around, effort: usize) -> Option<(u32, u32)> {
    let trees = sections.map(|s| &s.close().tree);
    let mut pending = Vec::with_capacity(PENDING);
    pending.extend(trees.iter().all(|t| !t.nodes.is_empty()).then_some((0, 0)));
    for _ in 0..effort {
        let (i, j) = pending.pop()?;
        if !may_cross(sections, around, (i, j)) {
            continue;
        }
        let (m, n) = (&trees[0].nodes[i as usize], &trees[1].nodes[j as usize]);
        if !(m.leaf && n.leaf) {
            pending.extend(Discs::halved(trees, (i, j)));
        } else if !ignored.contains(&(m.link, n.link)) && cross(sections, around, (i, j)) {
            return Some((i, j));
        }
    }
    None
}

/// May spans under two nodes cross, and are they long enough to do so throughout?
fn may_cross(sections: [&Section; 2], around: &Around, (i, j): (u32, u32)) -> bool {
    let [a, b] = sections.map(Section::close);
    let (m, n) = (&a.tree.nodes[i as usize], &b.tree.nodes[j as usize]);
    let (reach, apart) = (m.radius + n.radius, around.apart(m, n));
    let shorter = a.greatest[i as usize].min(b.greatest[j as usize]);
    around.motion([m.arm - m.radius, n.arm - n.radius]) < 2.0 * shorter && apart.dot(apart) <= reach * reach
}

/// Do the spans of two leaves cross throughout the box?
fn cross([a, b]: [&Section; 2], around: &Around, (i, j): (u32, u32)) -> bool {
    let (m, n) = (&a.close().tree.nodes[i as usize], &b.close().tree.nodes[j as usize]);
    let (s, t) = (m.link as usize, n.link as usize);
    if a.features[s] == usize::MAX || b.features[t] == usize::MAX {
        return false;
    }
    let (first, second) = (a.spans[s].placed(&around.rel[0]), b.spans[t]);
    let motion = around.motion([m.arm + m.radius, n.arm + n.radius]) + around.little;
    second.ends().iter().all(|p| first.distance_to_point(*p) > motion)
        && first.ends().iter().all(|p| second.distance_to_point(*p) > motion)
        && first.crossings(&second) % 2 == 1
}
