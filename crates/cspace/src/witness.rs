//! Discs inside bodies: two of them that overlap by more than a cell's motion prove the whole cell blocked.

use crate::around::Around;
use crate::recent::Recent;
use crate::region::Regions;
use crate::section::Section;
use crate::span::Span;
use crate::tree::{Discs, Node, PENDING};
use crate::within::Within;
use mainspring_geometry::Vec2;
use mainspring_mechanism::Pose;
use std::f64::consts::TAU;

/// Discs sampled per section, besides one for each span.
const SAMPLES: f64 = 120.0;
/// Pairs of tree nodes looked at for one configuration.
pub(crate) const EFFORT: usize = 1000;
/// A straight side with less material behind it than this (relative to the size) belongs to a body too thin to map.
const THIN: f64 = 1e-9;
/// Nearer than this (relative to the size, or in radians) two places count as one.
const NEARLY: f64 = 1e-9;

/// Discs inside one section.
#[derive(Debug)]
struct Inside {
    /// In local coordinates. Of a node: no disc reaches farther from its centre than `radius`, and no disc's centre is nearer
    /// to the origin than `arm`.
    tree: Discs,
    /// Is there hardly any material behind a straight side?
    thin: bool,
}

/// Discs inside all sections of both bodies.
#[derive(Debug)]
pub(crate) struct Witnesses {
    inside: [Vec<Inside>; 2],
    facing: Vec<(usize, usize)>,
}

impl Inside {
    /// Of a section that turned by a `repeats`-th of a turn is the same: one sector's discs stand for all. Only those within
    /// the other body's reach are kept.
    fn new(section: &Section, repeats: u32, size: f64, reach: impl Fn((Vec2, f64)) -> bool) -> Self {
        let total: f64 = section.spans.iter().map(|s| s.length()).sum();
        let turns: Vec<Pose> =
            (0..repeats).map(|k| Pose::turn(f64::from(k) * TAU / f64::from(repeats))).collect();
        let (mut discs, mut thin) = (Vec::new(), false);
        for (span, convex) in section.spans.iter().zip(&section.convex) {
            let at = span.disc().0;
            if !in_first_sector(at, repeats) {
                continue;
            }
            let count = 1 + (SAMPLES * span.length() / total).min(SAMPLES) as usize;
            let grown =
                span.samples(count, *convex).into_iter().filter_map(|(p, n)| grow(section, p, n, size));
            let copies = if at.norm() > NEARLY * size { &turns[..] } else { &turns[..1] };
            discs.extend(
                grown.flat_map(|(c, r)| copies.iter().map(move |t| (t.apply(c), r))).filter(|d| reach(*d)),
            );
            let middle = span.samples(1, *convex)[0];
            let side = matches!(span, Span::Line { .. }) && span.length() > 1e-6 * size;
            thin |= side && !section.contains(middle.0 + middle.1 * (THIN * size));
        }
        let centers: Vec<_> = discs.iter().map(|d| (d.0, 0.0)).collect();
        let mut tree = Discs::new(&centers);
        let greatest = tree.greatest(|k| discs[k as usize].1);
        for (node, radius) in tree.nodes.iter_mut().zip(greatest) {
            node.arm = (node.arm - node.radius).max(0.0);
            node.radius += radius;
        }
        Inside { tree, thin }
    }
}

/// Is a point in the first of `repeats` equal sectors about the origin, or on its edges?
fn in_first_sector(p: Vec2, repeats: u32) -> bool {
    let sector = TAU / f64::from(repeats);
    let angle = p.y.atan2(p.x).rem_euclid(TAU);
    repeats == 1 || angle <= sector + NEARLY || angle >= TAU - NEARLY
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
    /// For bodies that repeat so often in a turn.
    pub fn new(regions: &Regions, repeats: [u32; 2], within: &Within, size: f64) -> Self {
        let inside = |k: usize, s: &Section| Inside::new(s, repeats[k], size, |disc| within.reach(k, disc));
        let all = |k: usize| regions.sections[k].iter().map(|s| inside(k, s)).collect();
        let facing = regions.facing.iter().map(|f| (f.0, f.1)).collect();
        Witnesses { inside: [all(0), all(1)], facing }
    }

    /// The body (0 or 1) that is too thin to map, if any.
    pub fn thin(&self) -> Option<usize> {
        (0..2).find(|&k| self.inside[k].iter().any(|i| i.thin))
    }

    /// Is every configuration of the box surely blocked, by more than `depth` (a length)? A disc's centre moves by at most its
    /// lever times the half width. False, after looking at `effort` pairs of tree nodes or all, means nothing.
    pub fn blocked(&self, around: &Around, depth: f64, effort: usize) -> bool {
        (0..self.facing.len()).any(|f| overlap(self.trees(f), around, depth, effort).is_some())
    }

    /// The same; discs that overlapped in other boxes are tried first.
    pub fn blocked_again(&self, around: &Around, effort: usize, overlapped: &mut Overlapped) -> bool {
        let apart = |&(f, (i, j)): &(usize, (u32, u32))| {
            let [a, b] = self.trees(f);
            least_apart(around, &a.nodes[i as usize], &b.nodes[j as usize])
        };
        if overlapped.iter().any(|discs| apart(discs) < 0.0) {
            return true;
        }
        for f in 0..self.facing.len() {
            if let Some(discs) = overlap(self.trees(f), around, 0.0, effort) {
                overlapped.remember((f, discs));
                return true;
            }
        }
        false
    }

    fn trees(&self, facing: usize) -> [&Discs; 2] {
        let (i, j) = self.facing[facing];
        [&self.inside[0][i].tree, &self.inside[1][j].tree]
    }
}

/// Discs that overlapped throughout boxes lately, by pair of sections: likely to do so in the next one too.
pub(crate) type Overlapped = Recent<(usize, (u32, u32))>;

/// A pair of discs that overlap throughout the box, if one is found. Most promising nodes first.
fn overlap(trees: [&Discs; 2], around: &Around, depth: f64, effort: usize) -> Option<(u32, u32)> {
    if trees.iter().any(|t| t.nodes.is_empty()) {
        return None;
    }
    let least = |(i, j): (u32, u32)| {
        least_apart(around, &trees[0].nodes[i as usize], &trees[1].nodes[j as usize]) + depth
    };
    let mut pending = Vec::with_capacity(PENDING);
    pending.push((least((0, 0)), (0, 0)));
    for _ in 0..effort {
        let (apart, (i, j)) = pending.pop()?;
        if apart >= 0.0 {
            continue;
        }
        if trees[0].nodes[i as usize].leaf && trees[1].nodes[j as usize].leaf {
            return Some((i, j));
        }
        let mut next = Discs::halved(trees, (i, j)).map(|pair| (least(pair), pair));
        if next[0].0 < next[1].0 {
            next.swap(0, 1);
        }
        pending.extend(next);
    }
    None
}

/// The least that discs under two nodes can be apart, in the worst configuration of the box.
fn least_apart(around: &Around, m: &Node, n: &Node) -> f64 {
    around.apart(m, n).norm() - m.radius - n.radius + around.motion([m.arm, n.arm])
}
