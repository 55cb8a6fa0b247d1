//! Do two outlines overlap? By brute force over all segments, with formulas of its own: parameters along segments
//! from angles, inside by the angle that the boundary is seen under.

use mainspring_geometry::{Loop, Segment, Vec2};
use mainspring_mechanism::{Body, Motion};
use std::f64::consts::{PI, TAU};

/// A segment placed in the plane: end points, and for an arc centre, radius, start angle, signed sweep.
#[derive(Clone, Copy)]
pub struct Placed {
    a: Vec2,
    b: Vec2,
    arc: Option<(Vec2, f64, f64, f64)>,
}

fn angle(v: Vec2) -> f64 {
    v.y.atan2(v.x)
}

fn place(segment: &Segment, map: &dyn Fn(Vec2) -> Vec2) -> Placed {
    match *segment {
        Segment::Line { from, to } => Placed { a: map(from), b: map(to), arc: None },
        Segment::Arc { from, to, center, radius, convex } => {
            let (a, b, c) = (map(from), map(to), map(center));
            let raw = angle(b - c) - angle(a - c);
            let sweep = if convex { raw.rem_euclid(TAU) } else { -(-raw).rem_euclid(TAU) };
            Placed { a, b, arc: Some((c, radius, angle(a - c), sweep)) }
        }
        Segment::Circle { center, radius, convex } => {
            let c = map(center);
            let a = map(center + Vec2::new(radius, 0.0));
            Placed { a, b: a, arc: Some((c, radius, angle(a - c), if convex { TAU } else { -TAU })) }
        }
    }
}

impl Placed {
    /// Is a point of the carrier on the segment?
    fn has(&self, p: Vec2) -> bool {
        match self.arc {
            None => {
                let d = self.b - self.a;
                let t = d.dot(p - self.a) / d.dot(d);
                (-1e-12..=1.0 + 1e-12).contains(&t)
            }
            Some((c, _, start, sweep)) => {
                let turn = (angle(p - c) - start) * sweep.signum();
                let turn = turn.rem_euclid(TAU);
                turn <= sweep.abs() + 1e-12 || turn >= TAU - 1e-12
            }
        }
    }

    fn meets(&self, other: &Placed) -> bool {
        carriers_meet(self, other).into_iter().flatten().any(|p| self.has(p) && other.has(p))
    }

    /// The angle under which the segment is seen from `p`, counterclockwise positive.
    fn seen(&self, p: Vec2) -> f64 {
        let (u, w) = (self.a - p, self.b - p);
        let chord = u.cross(w).atan2(u.dot(w));
        let Some((c, r, _, sweep)) = self.arc else { return chord };
        if self.a == self.b {
            return if (p - c).norm() < r { TAU * sweep.signum() } else { 0.0 };
        }
        // Between chord and arc the angle differs by a full turn.
        let side = (self.b - self.a).cross(p - self.a);
        let beyond = if sweep > 0.0 { side < 0.0 } else { side > 0.0 };
        let inside = (p - c).norm() < r;
        if beyond && inside { chord + TAU * sweep.signum() } else { chord }
    }
}

fn carriers_meet(s: &Placed, t: &Placed) -> [Option<Vec2>; 2] {
    match (s.arc, t.arc) {
        (None, None) => {
            let (d, e) = (s.b - s.a, t.b - t.a);
            let det = d.cross(e);
            if det == 0.0 {
                return [None, None];
            }
            [Some(s.a + d * ((t.a - s.a).cross(e) / det)), None]
        }
        (None, Some((c, r, ..))) => line_circle(s.a, s.b, c, r),
        (Some((c, r, ..)), None) => line_circle(t.a, t.b, c, r),
        (Some((c, r, ..)), Some((o, q, ..))) => {
            let d = (o - c).norm();
            if d == 0.0 || d > r + q || d < (r - q).abs() {
                return [None, None];
            }
            let cos = (r * r + d * d - q * q) / (2.0 * r * d);
            let half = cos.clamp(-1.0, 1.0).acos();
            let base = angle(o - c);
            [base + half, base - half].map(|a| Some(c + Vec2::new(a.cos(), a.sin()) * r))
        }
    }
}

fn line_circle(a: Vec2, b: Vec2, c: Vec2, r: f64) -> [Option<Vec2>; 2] {
    let (d, f) = (b - a, a - c);
    let (qa, qb, qc) = (d.dot(d), 2.0 * f.dot(d), f.dot(f) - r * r);
    let disc = qb * qb - 4.0 * qa * qc;
    if disc < 0.0 {
        return [None, None];
    }
    [disc.sqrt(), -disc.sqrt()].map(|s| Some(a + d * ((s - qb) / (2.0 * qa))))
}

/// Heights of a layer and its loops.
pub type PlacedLayer = ((f64, f64), Vec<Vec<Placed>>);

/// All segments of a body at joint positions `q`, layer by layer with heights.
pub fn placed(body: &Body, q: &[f64]) -> Vec<PlacedLayer> {
    let map = |mut p: Vec2| {
        for joint in body.chain.iter().rev() {
            let x = q[joint.coordinate] * joint.ratio;
            p = match joint.motion {
                Motion::Turn { center } => {
                    let d = p - center;
                    center + Vec2::new(x.cos() * d.x - x.sin() * d.y, x.sin() * d.x + x.cos() * d.y)
                }
                Motion::Slide { direction } => p + direction * x,
            };
        }
        p
    };
    let of = |l: &Loop| l.edges.iter().map(|e| place(&e.segment, &map)).collect();
    body.outline.layers.iter().map(|l| ((l.bottom, l.top), l.loops.iter().map(of).collect())).collect()
}

fn inside(loops: &[Vec<Placed>], p: Vec2) -> bool {
    let total: f64 = loops.iter().flatten().map(|s| s.seen(p)).sum();
    total > PI
}

/// Do two bodies overlap at joint positions `q`?
pub fn overlap(a: &Body, b: &Body, q: &[f64]) -> bool {
    let (pa, pb) = (placed(a, q), placed(b, q));
    pa.iter().any(|(h, la)| {
        pb.iter().any(|(k, lb)| {
            if h.1.min(k.1) - h.0.max(k.0) <= 1e-9 {
                return false;
            }
            la.iter().flatten().any(|s| lb.iter().flatten().any(|t| s.meets(t)))
                || la.iter().any(|l| inside(lb, l[0].a))
                || lb.iter().any(|l| inside(la, l[0].a))
        })
    })
}

/// Does a loop not cross or touch itself?
pub fn is_simple(boundary: &Loop) -> bool {
    let all: Vec<Placed> = boundary.edges.iter().map(|e| place(&e.segment, &|p| p)).collect();
    let n = all.len();
    for i in 0..n {
        for j in i + 1..n {
            let adjacent = j == i + 1 || (i == 0 && j == n - 1);
            let shared = |p: Vec2| adjacent && [all[i].a, all[i].b].iter().any(|e| (*e - p).norm() < 1e-6);
            let crossing = carriers_meet(&all[i], &all[j])
                .into_iter()
                .flatten()
                .any(|p| !shared(p) && all[i].has(p) && all[j].has(p));
            if crossing {
                return false;
            }
        }
    }
    true
}

/// Do no two loops cross or touch?
pub fn are_apart(loops: &[Loop]) -> bool {
    let all: Vec<Vec<Placed>> =
        loops.iter().map(|l| l.edges.iter().map(|e| place(&e.segment, &|p| p)).collect()).collect();
    let meet = |a: &[Placed], b: &[Placed]| a.iter().any(|s| b.iter().any(|t| s.meets(t)));
    (0..all.len()).all(|i| (0..i).all(|j| !meet(&all[i], &all[j])))
}
