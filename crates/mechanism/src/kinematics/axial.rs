//! The 2½-dimensional rule: freedoms that shape allows and nothing uses.
//!
//! Read strictly, a wheel may slide along its shaft. A cylindrical pair with its axis along the normal of the
//! working plane loses its sliding, one with its axis in the plane its turning, if no spring, force, initial
//! velocity, other pair or possible contact normal has a component along that freedom. Springs, friction and
//! initial velocities of the supplement act on the freedom that stays. Other pairs are asked by their equations:
//! the motions of all other freedoms must stay the same. Contact normals lie in the working plane where parts are
//! prisms along its normal; surfaces that are not must be out of reach.

use super::mobility::Loops;
use super::pair::{Freedom, Pair, PairKind};
use super::reach::Parts;
use super::surface::{parallel, perpendicular};

/// What the rule decides: freedoms to leave out, and pairs that keep two with the reason.
#[derive(Debug, Default)]
pub(crate) struct Idle {
    pub left_out: Vec<(usize, Freedom)>,
    pub kept: Vec<(usize, String)>,
}

pub(crate) fn idle(parts: &Parts<'_>, loops: &[Loops], label: &dyn Fn(u32) -> String) -> Idle {
    let normal = parts.normal;
    let tilted: Vec<Vec<usize>> = (0..parts.placed.leaves.len()).map(|p| parts.tilted(p)).collect();
    let mut result = Idle::default();
    let mut wanted: Vec<(usize, Freedom)> = Vec::new();
    for (index, pair) in parts.pairs.iter().enumerate().filter(|(_, p)| p.kind == PairKind::Cylindrical) {
        let d = pair.axis.direction;
        if perpendicular(d, normal) {
            wanted.push((index, Freedom::Turning));
        } else if parallel(d, normal) {
            match axial_contact(parts, pair, &tilted) {
                None => wanted.push((index, Freedom::Sliding)),
                Some(i) => result.kept.push((index, format!("{} may be touched along the axis", label(i)))),
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

/// A primitive that may be touched along the axis of the pair.
fn axial_contact(parts: &Parts<'_>, pair: &Pair, tilted: &[Vec<usize>]) -> Option<u32> {
    let (a, b) = pair.parts;
    let moving = |p: usize| parts.holds[p].is_some();
    for m in [a, b].into_iter().filter(|p| moving(*p)) {
        for c in (0..tilted.len()).filter(|c| *c != m) {
            let near = |p: usize, other: usize| {
                let k = tilted[p].iter().find(|&&k| parts.can_meet((p, k), other))?;
                Some(parts.placed.leaves[p][*k])
            };
            if let Some(i) = near(m, c).or_else(|| near(c, m)) {
                return Some(i);
            }
        }
    }
    None
}
