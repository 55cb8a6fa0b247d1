//! Discs inside bodies: two of them that overlap by more than a cell's motion prove the whole cell blocked.

use crate::moving::Moving;
use crate::region::{Regions, Section};
use crate::span::Span;
use crate::tree::Discs;
use mainspring_geometry::Vec2;
use mainspring_mechanism::Pose;

/// Discs sampled per section, besides one for each span.
const SAMPLES: f64 = 120.0;
/// Pairs of tree nodes looked at for one cell.
const EFFORT: usize = 200;

/// Discs inside one section: centres and radii in local coordinates, and a tree over the centres.
#[derive(Clone, Debug)]
struct Inside {
    discs: Vec<(Vec2, f64)>,
    tree: Discs,
    /// Greatest radius under each node.
    greatest: Vec<f64>,
    /// Is there hardly any material behind a straight side?
    thin: bool,
}

/// A straight side with less material behind it than this (relative to the size) belongs to a body too thin to map.
const THIN: f64 = 1e-9;

/// Discs inside all sections of both bodies.
#[derive(Clone, Debug)]
pub(crate) struct Witnesses {
    inside: [Vec<Inside>; 2],
    facing: Vec<(usize, usize)>,
}

impl Inside {
    fn new(section: &Section, size: f64) -> Self {
        let total: f64 = section.spans.iter().map(|s| s.length()).sum();
        let (mut discs, mut thin) = (Vec::new(), false);
        for (span, convex) in section.spans.iter().zip(section.convex()) {
            let count = 1 + (SAMPLES * span.length() / total).min(SAMPLES) as usize;
            let grown = span.samples(count, *convex).into_iter().map(|(p, n)| grow(section, p, n, size));
            discs.extend(grown.flatten());
            let middle = span.samples(1, *convex)[0];
            let side = matches!(span, Span::Line { .. }) && span.length() > 1e-6 * size;
            thin |= side && !section.contains(middle.0 + middle.1 * (THIN * size));
        }
        let centers: Vec<_> = discs.iter().map(|d| (d.0, 0.0)).collect();
        let tree = Discs::new(&centers);
        let mut greatest = vec![0.0; tree.nodes.len()];
        for i in (0..tree.nodes.len()).rev() {
            let node = &tree.nodes[i];
            greatest[i] = if node.leaf {
                discs[node.link as usize].1
            } else {
                let [a, b] = tree.children(i as u32).map(|k| greatest[k as usize]);
                f64::max(a, b)
            };
        }
        Inside { discs, tree, greatest, thin }
    }
}

/// The greatest disc inside that touches the boundary at `p` with inward normal `n`, a little smaller.
fn grow(section: &Section, p: Vec2, n: Vec2, size: f64) -> Option<(Vec2, f64)> {
    let mut radius = size;
    for _ in 0..12 {
        let center = p + n * radius;
        let (q, distance) = section.nearest_to(center);
        if distance >= radius * (1.0 - 1e-3) {
            let radius = 0.995 * distance;
            return section.contains(center).then_some((center, radius));
        }
        let d = q - p;
        let rise = 2.0 * n.dot(d);
        radius = if rise > 0.0 { (d.dot(d) / rise).min(0.9 * radius) } else { 0.5 * radius };
    }
    None
}

impl Witnesses {
    pub fn new(regions: &Regions, size: f64) -> Self {
        let all = |k: usize| regions.sections[k].iter().map(|s| Inside::new(s, size)).collect();
        let facing = regions.facing.iter().map(|f| (f.0, f.1)).collect();
        Witnesses { inside: [all(0), all(1)], facing }
    }

    /// The body (0 or 1) that is too thin to map, if any.
    pub fn thin(&self) -> Option<usize> {
        (0..2).find(|&k| self.inside[k].iter().any(|i| i.thin))
    }

    /// Is every configuration within half widths `half` of these poses surely blocked? A disc's centre moves by at most
    /// its lever times the half width. False means nothing.
    pub fn blocked(&self, moving: &[Moving; 2], poses: &[Pose; 2], half: [f64; 2]) -> bool {
        self.facing
            .iter()
            .any(|&(i, j)| self.pair_blocked(&self.inside[0][i], &self.inside[1][j], moving, poses, half))
    }

    fn pair_blocked(
        &self,
        a: &Inside,
        b: &Inside,
        moving: &[Moving; 2],
        poses: &[Pose; 2],
        half: [f64; 2],
    ) -> bool {
        if a.discs.is_empty() || b.discs.is_empty() {
            return false;
        }
        let [m1, m2] = moving;
        let bound = |i: u32, j: u32| {
            let (m, n) = (&a.tree.nodes[i as usize], &b.tree.nodes[j as usize]);
            let apart = (poses[0].apply(m.center) - poses[1].apply(n.center)).norm();
            let motion = half[0] * m1.lever(m.center, -m.radius).max(0.0)
                + half[1] * m2.lever(n.center, -n.radius).max(0.0);
            apart - m.radius - n.radius - a.greatest[i as usize] - b.greatest[j as usize] + motion
        };
        let mut pending = vec![(bound(0, 0), 0u32, 0u32)];
        for _ in 0..EFFORT {
            let Some((least, i, j)) = pending.pop() else { return false };
            if least >= 0.0 {
                continue;
            }
            let (m, n) = (&a.tree.nodes[i as usize], &b.tree.nodes[j as usize]);
            if m.leaf && n.leaf {
                return true;
            }
            let first = !m.leaf && (n.leaf || m.radius >= n.radius);
            let mut next = if first {
                a.tree.children(i).map(|k| (bound(k, j), k, j))
            } else {
                b.tree.children(j).map(|k| (bound(i, k), i, k))
            };
            if next[0].0 < next[1].0 {
                next.swap(0, 1);
            }
            pending.extend(next);
        }
        false
    }
}

impl Witnesses {
    /// With the bodies exchanged.
    pub fn transposed(&self) -> Self {
        let [a, b] = self.inside.clone();
        Witnesses { inside: [b, a], facing: self.facing.iter().map(|&(i, j)| (j, i)).collect() }
    }
}
