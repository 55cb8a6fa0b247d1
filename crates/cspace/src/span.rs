//! Boundary segments as point sets: how far apart two of them are, and which side of them a point is on.

use mainspring_geometry::{Segment, Vec2};
use mainspring_mechanism::Pose;

/// A straight or round stretch of boundary.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Span {
    Line { from: Vec2, to: Vec2 },
    Arc { center: Vec2, radius: f64, sector: Sector },
}

/// Directions from an arc's centre, counterclockwise from `start` to `end` (unit vectors).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sector {
    pub start: Vec2,
    pub end: Vec2,
    /// Radians.
    pub sweep: f64,
}

impl Sector {
    pub fn has(&self, d: Vec2) -> bool {
        if self.sweep >= std::f64::consts::TAU {
            return true;
        }
        let (after, before) = (self.start.cross(d) >= 0.0, d.cross(self.end) >= 0.0);
        if self.sweep <= std::f64::consts::PI {
            after && before && (self.start + self.end).dot(d) >= -1e-12
        } else {
            after || before
        }
    }

    fn turned(&self, pose: &Pose) -> Self {
        Sector { start: pose.rotate(self.start), end: pose.rotate(self.end), sweep: self.sweep }
    }
}

impl Span {
    pub fn new(segment: &Segment, local: &Pose) -> Self {
        match *segment {
            Segment::Line { from, to } => Span::Line { from: local.apply(from), to: local.apply(to) },
            Segment::Circle { center, radius, .. } => {
                let x = Vec2::new(1.0, 0.0);
                let sector = Sector { start: x, end: x, sweep: std::f64::consts::TAU };
                Span::Arc { center: local.apply(center), radius, sector }
            }
            Segment::Arc { from, to, center, radius, convex } => {
                let (a, b) = if convex { (from, to) } else { (to, from) };
                let unit = |p: Vec2| local.rotate((p - center).unit());
                let sector = Sector { start: unit(a), end: unit(b), sweep: segment.sweep() };
                Span::Arc { center: local.apply(center), radius, sector }
            }
        }
    }

    pub fn placed(&self, pose: &Pose) -> Self {
        match *self {
            Span::Line { from, to } => Span::Line { from: pose.apply(from), to: pose.apply(to) },
            Span::Arc { center, radius, sector } => {
                Span::Arc { center: pose.apply(center), radius, sector: sector.turned(pose) }
            }
        }
    }

    pub fn ends(&self) -> [Vec2; 2] {
        match *self {
            Span::Line { from, to } => [from, to],
            Span::Arc { center, radius, sector } => {
                [center + sector.start * radius, center + sector.end * radius]
            }
        }
    }

    /// A disc around it.
    pub fn disc(&self) -> (Vec2, f64) {
        match *self {
            Span::Line { from, to } => ((from + to) * 0.5, 0.5 * (to - from).norm()),
            Span::Arc { center, radius, sector } if sector.sweep < std::f64::consts::PI => {
                let (s, c) = (0.5 * sector.sweep).sin_cos();
                let middle = sector.start * c + sector.start.perp() * s;
                (center + middle * (radius * c), radius * s.max(1.0 - c))
            }
            Span::Arc { center, radius, .. } => (center, radius),
        }
    }

    pub fn nearest_to(&self, p: Vec2) -> Vec2 {
        match *self {
            Span::Line { from, to } => {
                let d = to - from;
                from + d * (d.dot(p - from) / d.dot(d)).clamp(0.0, 1.0)
            }
            Span::Arc { center, radius, sector } => {
                let d = p - center;
                if d.norm() > 0.0 && sector.has(d) {
                    return center + d.unit() * radius;
                }
                let [a, b] = self.ends();
                if (a - p).norm() <= (b - p).norm() { a } else { b }
            }
        }
    }

    pub fn distance_to_point(&self, p: Vec2) -> f64 {
        (self.nearest_to(p) - p).norm()
    }

    /// Points `count` to the unit of the span, with unit vectors to the left of its way, into the material.
    pub fn samples(&self, count: usize, convex: bool) -> Vec<(Vec2, Vec2)> {
        let part = |k: usize| (k as f64 + 0.5) / count as f64;
        (0..count)
            .map(|k| match *self {
                Span::Line { from, to } => (from + (to - from) * part(k), (to - from).unit().perp()),
                Span::Arc { center, radius, sector } => {
                    let (s, c) = (sector.sweep * part(k)).sin_cos();
                    let d = sector.start * c + sector.start.perp() * s;
                    (center + d * radius, if convex { -d } else { d })
                }
            })
            .collect()
    }

    pub fn length(&self) -> f64 {
        match *self {
            Span::Line { from, to } => (to - from).norm(),
            Span::Arc { radius, sector, .. } => radius * sector.sweep,
        }
    }

    /// Distance of two spans; 0 if they meet.
    pub fn distance(&self, other: &Self) -> f64 {
        if self.meets(other) {
            return 0.0;
        }
        let mut least = f64::INFINITY;
        for p in other.ends() {
            least = least.min(self.distance_to_point(p));
        }
        for p in self.ends() {
            least = least.min(other.distance_to_point(p));
        }
        match (self, other) {
            (Span::Arc { center, radius, sector }, _) | (_, Span::Arc { center, radius, sector })
                if !matches!((self, other), (Span::Arc { .. }, Span::Arc { .. })) =>
            {
                let line = if matches!(self, Span::Line { .. }) { self } else { other };
                least.min(foot(*center, *radius, sector, line))
            }
            (
                Span::Arc { center: a, radius: r, sector: sa },
                Span::Arc { center: b, radius: s, sector: sb },
            ) => least.min(along_centers((*a, *r, sa), (*b, *s, sb))),
            _ => least,
        }
    }

    fn meets(&self, other: &Self) -> bool {
        self.crossings(other) > 0
    }

    /// How often two spans cross.
    pub fn crossings(&self, other: &Self) -> usize {
        match (self, other) {
            (Span::Line { from: a, to: b }, Span::Line { from: c, to: d }) => {
                let (s, t) = (*b - *a, *d - *c);
                let (p, q) = (s.cross(*c - *a), s.cross(*d - *a));
                let (m, n) = (t.cross(*a - *c), t.cross(*b - *c));
                usize::from((p > 0.0) != (q > 0.0) && (m > 0.0) != (n > 0.0) && s.cross(t) != 0.0)
            }
            (Span::Line { from, to }, Span::Arc { center, radius, sector })
            | (Span::Arc { center, radius, sector }, Span::Line { from, to }) => {
                let d = *to - *from;
                let length = d.norm();
                let t = d * (1.0 / length);
                let (along, h) = (t.dot(*center - *from), t.cross(*center - *from));
                let square = (radius - h) * (radius + h);
                if square < 0.0 {
                    return 0;
                }
                let half = square.sqrt();
                let on = |s: f64| s >= 0.0 && s <= length && sector.has(*from + t * s - *center);
                [along - half, along + half].into_iter().filter(|s| on(*s)).count()
            }
            (
                Span::Arc { center: a, radius: r, sector: sa },
                Span::Arc { center: b, radius: s, sector: sb },
            ) => {
                let e = *b - *a;
                let dd = e.dot(e);
                let (sum, difference) = (r + s, r - s);
                let square = (sum * sum - dd) * (dd - difference * difference);
                if square < 0.0 || dd == 0.0 {
                    return 0;
                }
                let along = (dd + sum * difference) / (2.0 * dd);
                let across = square.sqrt() / (2.0 * dd);
                let on = |p: Vec2| sa.has(p) && sb.has(p - e);
                [-1.0, 1.0].into_iter().filter(|side| on(e * along + e.perp() * (side * across))).count()
            }
        }
    }
}

/// Distance of an arc from a line along the normal through the arc's centre.
fn foot(center: Vec2, radius: f64, sector: &Sector, line: &Span) -> f64 {
    let Span::Line { from, to } = *line else { return f64::INFINITY };
    let d = to - from;
    let t = d.dot(center - from) / d.dot(d);
    let e = from + d * t - center;
    if !(0.0..=1.0).contains(&t) {
        return f64::INFINITY;
    }
    // Within the circle the far side of the arc may be nearest.
    let h = e.norm();
    let near = if sector.has(e) { (h - radius).abs() } else { f64::INFINITY };
    near.min(if sector.has(-e) { h + radius } else { f64::INFINITY })
}

/// Least distance of two arcs along the line of their centres.
fn along_centers(a: (Vec2, f64, &Sector), b: (Vec2, f64, &Sector)) -> f64 {
    let e = b.0 - a.0;
    let d = e.norm();
    if d == 0.0 {
        // Concentric arcs: nearest wherever both pass, else at their ends.
        let shared = [a.2.start, a.2.end].iter().any(|x| b.2.has(*x))
            || [b.2.start, b.2.end].iter().any(|x| a.2.has(*x));
        return if shared { (a.1 - b.1).abs() } else { f64::INFINITY };
    }
    let mut least = f64::INFINITY;
    for (s, t) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        if a.2.has(e * s) && b.2.has(e * t) {
            least = least.min((d + t * b.1 - s * a.1).abs());
        }
    }
    least
}
