//! Pairs of drawn parts, read from their boundaries in the plane.
//!
//! A round edge of one part on an equal round edge of the other, material on opposite sides, over more than half a
//! turn: the parts turn about its centre. Straight edges on each other on opposite sides of a part: they slide along
//! them. Both, or straight edges in two directions: they are fixed.

use super::pair::{AxisLine, Evidence, EvidenceKind, Pair, PairKind};
use super::surface::canonical;
use mainspring_geometry::{CurveId, Edge, Layer, Outline, Segment, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// Edges compared for two parts at most.
const MAX_EDGES: usize = 4_000_000;

/// What two boundaries have on each other.
#[derive(Default)]
struct Meetings {
    rounds: Vec<Round>,
    lines: Vec<Straight>,
}

struct Round {
    center: Vec2,
    radius: f64,
    angle: f64,
    curves: [CurveId; 2],
    gap: f64,
    /// Which part has the material inside.
    solid: usize,
    heights: (f64, f64),
}

struct Straight {
    /// Out of the first part.
    normal: Vec2,
    curves: [CurveId; 2],
    gap: f64,
    area: f64,
}

/// The pair that two outlines in the plane z = 0 make; `clearance` is a difference of radii, or a gap, that counts as
/// a fit.
pub(crate) fn find(
    outlines: [&Outline; 2],
    parts: (usize, usize),
    clearance: f64,
    tolerance: f64,
) -> Option<Pair> {
    let count = |o: &Outline| o.layers.iter().flat_map(|l| &l.loops).map(|l| l.edges.len()).sum::<usize>();
    if count(outlines[0]).saturating_mul(count(outlines[1])) > MAX_EDGES {
        return None;
    }
    let play = clearance + 4.0 * tolerance;
    let mut met = Meetings::default();
    for a in &outlines[0].layers {
        for b in &outlines[1].layers {
            let heights = (a.bottom.max(b.bottom), a.top.min(b.top));
            if heights.1 - heights.0 > tolerance {
                met.compare(a, b, heights, play);
            }
        }
    }
    met.pair(parts, play, tolerance)
}

impl Meetings {
    fn compare(&mut self, a: &Layer, b: &Layer, heights: (f64, f64), play: f64) {
        for x in a.loops.iter().flat_map(|l| &l.edges) {
            for y in b.loops.iter().flat_map(|l| &l.edges) {
                self.rounds.extend(round(x, y, heights, play));
                self.lines.extend(straight(x, y, heights, play));
            }
        }
    }

    fn pair(&self, parts: (usize, usize), play: f64, tolerance: f64) -> Option<Pair> {
        let bearing = self.rounds.iter().find(|r| self.around(r, play) > PI + 1e-6);
        let guides: Vec<&Straight> = self.lines.iter().filter(|s| self.is_faced(s)).collect();
        let crossed = guides.iter().any(|s| s.normal.cross(guides[0].normal).abs() > 1e-9);
        let (kind, axis) = match (bearing, guides.first()) {
            (Some(r), None) => (PairKind::Revolute, turning(r.center)),
            (Some(r), Some(_)) => (PairKind::Fixed, turning(r.center)),
            (None, Some(s)) if crossed => (PairKind::Fixed, turning(s.normal * 0.0)),
            (None, Some(s)) => (PairKind::Prismatic, sliding(s.normal.perp())),
            (None, None) => return None,
        };
        let rounds = self.rounds.iter().filter(|r| bearing.is_some_and(|b| b.same(r, play)));
        let mut evidence: Vec<Evidence> = rounds.clone().map(Round::evidence).collect();
        evidence.extend(guides.iter().map(|s| s.evidence()));
        let curves = rounds.clone().map(|r| r.curves).chain(guides.iter().map(|s| s.curves));
        let mut surfaces = [vec![], vec![]];
        for [a, b] in curves {
            surfaces[0].push(a);
            surfaces[1].push(b);
        }
        surfaces.iter_mut().for_each(|s| {
            s.sort_unstable();
            s.dedup();
        });
        let gaps = rounds.map(|r| r.gap).chain(guides.iter().map(|s| s.gap));
        let clearance = gaps.fold(0.0, f64::max);
        Some(Pair {
            kind,
            shape_kind: kind,
            parts,
            axis,
            ratio: None,
            clearance: if clearance <= 4.0 * tolerance { 0.0 } else { clearance },
            evidence,
            dropped: vec![],
            surfaces,
        })
    }

    /// The angle over which two parts meet on the circle of `r`.
    fn around(&self, r: &Round, play: f64) -> f64 {
        let same = self.rounds.iter().filter(|o| r.same(o, play) && o.heights == r.heights);
        same.map(|o| o.angle).sum()
    }

    /// Is there an edge on the opposite side?
    fn is_faced(&self, s: &Straight) -> bool {
        self.lines.iter().any(|o| o.normal.dot(s.normal) < -1.0 + 1e-9)
    }
}

fn turning(center: Vec2) -> AxisLine {
    AxisLine { point: Vec3::new(center.x, center.y, 0.0), direction: Vec3::new(0.0, 0.0, 1.0) }
}

fn sliding(d: Vec2) -> AxisLine {
    AxisLine { point: Vec3::default(), direction: canonical(Vec3::new(d.x, d.y, 0.0)) }
}

impl Round {
    fn same(&self, o: &Round, play: f64) -> bool {
        (self.center - o.center).norm() <= play
            && (self.radius - o.radius).abs() <= play
            && self.solid == o.solid
    }

    fn evidence(&self) -> Evidence {
        let (from, to) = self.heights;
        let what = EvidenceKind::ShaftInHole {
            solid: self.solid,
            radius: self.radius,
            clearance: self.gap,
            from,
            to,
            angle: self.angle,
        };
        Evidence { what, primitives: self.curves.map(|c| c.primitive), text: String::new() }
    }
}

impl Straight {
    fn evidence(&self) -> Evidence {
        let normal = Vec3::new(self.normal.x, self.normal.y, 0.0);
        let what = EvidenceKind::SideFaces { normal, clearance: self.gap, area: self.area };
        Evidence { what, primitives: self.curves.map(|c| c.primitive), text: String::new() }
    }
}

fn circle(s: &Segment) -> Option<(Vec2, f64, bool)> {
    match *s {
        Segment::Arc { center, radius, convex, .. } | Segment::Circle { center, radius, convex } => {
            Some((center, radius, convex))
        }
        Segment::Line { .. } => None,
    }
}

fn round(a: &Edge, b: &Edge, heights: (f64, f64), play: f64) -> Option<Round> {
    let ((c, r, out), (d, s, inward)) = (circle(&a.segment)?, circle(&b.segment)?);
    let (solid, hole) = if out { (r, s) } else { (s, r) };
    let gap = hole - solid;
    if out == inward || (c - d).norm() > play || gap.abs() > play {
        return None;
    }
    let angle = common_angle(&a.segment, &b.segment);
    (angle > 1e-6).then_some(Round {
        center: c,
        radius: solid,
        angle,
        curves: [a.curve, b.curve],
        gap: gap.max(0.0),
        solid: usize::from(!out),
        heights,
    })
}

/// Start and sweep of an arc, counterclockwise.
fn span(s: &Segment) -> (f64, f64) {
    let Segment::Arc { from, to, center, convex, .. } = *s else { return (0.0, TAU) };
    let first = if convex { from } else { to } - center;
    (first.y.atan2(first.x), s.sweep())
}

fn common_angle(a: &Segment, b: &Segment) -> f64 {
    let ((start, sweep), (other, length)) = (span(a), span(b));
    let begin = (other - start).rem_euclid(TAU);
    let overlap = |from: f64| (sweep.min(from + length) - from.max(0.0)).max(0.0);
    (overlap(begin) + overlap(begin - TAU)).min(TAU)
}

fn straight(a: &Edge, b: &Edge, heights: (f64, f64), play: f64) -> Option<Straight> {
    let (Segment::Line { from, to }, Segment::Line { from: p, to: q }) = (a.segment, b.segment) else {
        return None;
    };
    let (d, length) = ((to - from).unit(), (to - from).norm());
    let normal = -d.perp();
    if d.dot((q - p).unit()) > -1.0 + 1e-12 {
        return None;
    }
    let gap = normal.dot(p - from).max(normal.dot(q - from));
    let far = [p, q].iter().any(|e| normal.dot(*e - from).abs() > play);
    let (low, high) = (d.dot(q - from).max(0.0), d.dot(p - from).min(length));
    (!far && high - low > play).then_some(Straight {
        normal,
        curves: [a.curve, b.curve],
        gap: gap.max(0.0),
        area: (high - low) * (heights.1 - heights.0),
    })
}
