//! Pairs built by hand, and a generator of random parts.
#![allow(dead_code)]

pub mod check;
pub mod oracle;
pub mod pairs;
pub mod polygon;

use mainspring_geometry::{CurveId, Edge, Layer, Loop, Outline, Segment, Turn, Vec2};
use mainspring_mechanism::{Body, Coordinate, Joint, Motion, System};

pub fn p(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

/// A corner of a loop with the bulge of the segment that starts there: tan(sweep/4), positive to the right of the way.
pub type Corner = (f64, f64, f64);

/// A segment from `a` to `b` with a bulge.
fn segment(a: Vec2, b: Vec2, bulge: f64) -> Segment {
    if bulge.abs() < 1e-6 {
        return Segment::Line { from: a, to: b };
    }
    let chord = b - a;
    let (l, m) = (chord.norm(), (a + b) * 0.5);
    let radius = l * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
    // The centre lies left of the way for a bulge to the right of up to a half turn.
    let off = l * (1.0 - bulge * bulge) / (4.0 * bulge);
    let center = m + chord.perp() * (off / l);
    Segment::Arc { from: a, to: b, center, radius, convex: bulge > 0.0 }
}

fn turn_between(before: &Segment, after: &Segment) -> Turn {
    let (a, b) = (before.tangent(1.0), after.tangent(0.0));
    let (cross, dot) = (a.cross(b), a.dot(b));
    if cross.abs() < 1e-9 && dot > 0.0 {
        Turn::Smooth
    } else if cross > 0.0 {
        Turn::Convex
    } else {
        Turn::Concave
    }
}

/// A closed loop, material on its left.
pub fn path(corners: &[Corner], first: u32) -> Loop {
    let n = corners.len();
    let at = |i: usize| p(corners[i % n].0, corners[i % n].1);
    let segments: Vec<Segment> = (0..n).map(|i| segment(at(i), at(i + 1), corners[i].2)).collect();
    let edges = (0..n)
        .map(|i| Edge {
            segment: segments[i],
            curve: CurveId { primitive: first + i as u32, face: 0 },
            aliases: vec![],
            turn_at_start: turn_between(&segments[(i + n - 1) % n], &segments[i]),
        })
        .collect();
    Loop { edges }
}

/// A whole circle, around material or around a hole.
pub fn circle(x: f64, y: f64, radius: f64, convex: bool, id: u32) -> Loop {
    let segment = Segment::Circle { center: p(x, y), radius, convex };
    let curve = CurveId { primitive: id, face: 0 };
    Loop { edges: vec![Edge { segment, curve, aliases: vec![], turn_at_start: Turn::Smooth }] }
}

pub fn polygon(points: &[(f64, f64)]) -> Loop {
    path(&points.iter().map(|&(x, y)| (x, y, 0.0)).collect::<Vec<_>>(), 0)
}

/// A hole is a loop run the other way.
pub fn reversed(corners: &[Corner]) -> Vec<Corner> {
    let n = corners.len();
    (0..n)
        .map(|i| {
            let here = corners[(n - i) % n];
            let before = corners[(2 * n - i - 1) % n];
            (here.0, here.1, -before.2)
        })
        .collect()
}

pub fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> Loop {
    polygon(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
}

pub fn outline(loops: Vec<Loop>) -> Outline {
    Outline { layers: vec![Layer { bottom: 0.0, top: 1.0, loops }] }
}

pub fn turn(coordinate: usize, x: f64, y: f64) -> Joint {
    Joint { coordinate, ratio: 1.0, motion: Motion::Turn { center: p(x, y) } }
}

pub fn slide(coordinate: usize, x: f64, y: f64) -> Joint {
    Joint { coordinate, ratio: 1.0, motion: Motion::Slide { direction: p(x, y) } }
}

pub fn body(name: &str, chain: Vec<Joint>, loops: Vec<Loop>) -> Body {
    Body { name: name.into(), chain, outline: outline(loops) }
}

pub fn system(bodies: Vec<Body>, size: f64) -> System {
    let coordinate = |i: usize| Coordinate::free(format!("q{i}"), 1.0);
    let count = bodies.iter().flat_map(|b| &b.chain).map(|j| j.coordinate + 1).max().unwrap_or(0).max(2);
    System::new((0..count).map(coordinate).collect(), bodies, &[], size)
}

/// A generator of numbers in [low, high) that is the same everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next(0.0, n as f64) as usize).min(n - 1)
    }
}

/// A part shaped like a star about (x, y): corners in the order of their angles, arcs of any sweep where they fit.
pub fn star(random: &mut Random, center: (f64, f64), inner: f64, outer: f64, n: usize) -> Vec<Corner> {
    let mut corners: Vec<Corner> = (0..n)
        .map(|i| {
            let angle = (i as f64 + random.next(-0.35, 0.35)) * std::f64::consts::TAU / n as f64;
            let r = random.next(inner, outer);
            (center.0 + r * angle.cos(), center.1 + r * angle.sin(), 0.0)
        })
        .collect();
    for i in 0..n {
        if random.next(0.0, 1.0) < 0.5 {
            let bulge = random.next(-0.9, 1.3);
            let old = corners[i].2;
            corners[i].2 = bulge;
            let boundary = path(&corners, 0);
            let area: f64 = boundary.edges.iter().map(|e| e.segment.area_about(p(0.0, 0.0))).sum();
            if area < 0.05 || !oracle::is_simple(&boundary) {
                corners[i].2 = old;
            }
        }
    }
    corners
}

pub fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is {:e} off {b}, allowed {tolerance:e}", (a - b).abs());
}
