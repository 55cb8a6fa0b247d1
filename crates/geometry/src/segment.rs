//! Lengths, areas and points of segments; over `f64`.

use crate::{Segment, Vec2};
use std::f64::consts::TAU;

/// An arc that ends this little (radians) before its start is an arc of no length, and not a full turn.
const ROUNDING: f64 = 1e-13;

impl Segment<f64> {
    /// The angle an arc or circle sweeps (radians, positive whichever way it runs, at most a full turn; an
    /// arc that ends where it starts is a full turn); 0 for a line.
    pub fn sweep(&self) -> f64 {
        match *self {
            Segment::Line { .. } => 0.0,
            Segment::Circle { .. } => TAU,
            Segment::Arc { from, to, center, convex, .. } => {
                let (a, b) = (from - center, to - center);
                let angle = a.cross(b).atan2(a.dot(b));
                let angle = if convex { angle } else { -angle };
                match angle {
                    _ if from == to => TAU,
                    a if a < -ROUNDING => a + TAU,
                    a => a.max(0.0),
                }
            }
        }
    }

    /// End point; for a whole circle its start.
    pub fn end(&self) -> Vec2 {
        match *self {
            Segment::Line { to, .. } | Segment::Arc { to, .. } => to,
            Segment::Circle { .. } => self.start(),
        }
    }

    /// The point at a fraction of the way, 0 at the start and 1 at the end.
    pub fn at(&self, fraction: f64) -> Vec2 {
        match *self {
            Segment::Line { from, to } => from + (to - from) * fraction,
            Segment::Arc { center, convex, .. } | Segment::Circle { center, convex, .. } => {
                let turn = if convex { self.sweep() } else { -self.sweep() } * fraction;
                let (s, c) = turn.sin_cos();
                let r = self.start() - center;
                center + r * c + r.perp() * s
            }
        }
    }

    /// The unit tangent at a fraction of the way.
    pub fn tangent(&self, fraction: f64) -> Vec2 {
        match *self {
            Segment::Line { from, to } => (to - from).unit(),
            Segment::Arc { center, convex, .. } | Segment::Circle { center, convex, .. } => {
                let t = (self.at(fraction) - center).perp().unit();
                if convex { t } else { -t }
            }
        }
    }

    pub fn length(&self) -> f64 {
        match *self {
            Segment::Line { from, to } => (to - from).norm(),
            Segment::Arc { radius, .. } | Segment::Circle { radius, .. } => radius * self.sweep(),
        }
    }

    /// The signed area swept by the way from `origin` to the moving point: summed over a boundary it is the
    /// area inside, whatever the origin (Green's theorem).
    pub fn area_about(&self, origin: Vec2) -> f64 {
        let (a, b) = (self.start() - origin, self.end() - origin);
        match *self {
            Segment::Line { .. } => 0.5 * a.cross(b),
            Segment::Arc { center, radius, convex, .. } | Segment::Circle { center, radius, convex } => {
                let sector = 0.5 * radius * radius * self.sweep();
                let c = center - origin;
                0.5 * c.cross(b - a) + if convex { sector } else { -sector }
            }
        }
    }

    /// The smallest box with sides along the axes: its least and its greatest corner.
    pub fn bounds(&self) -> (Vec2, Vec2) {
        let (a, b) = (self.start(), self.end());
        let mut min = Vec2::new(a.x.min(b.x), a.y.min(b.y));
        let mut max = Vec2::new(a.x.max(b.x), a.y.max(b.y));
        if let Segment::Arc { center, radius, .. } | Segment::Circle { center, radius, .. } = *self {
            for d in [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, -1.0)] {
                let p = center + d * radius;
                if self.sweeps_over(d) {
                    min = Vec2::new(min.x.min(p.x), min.y.min(p.y));
                    max = Vec2::new(max.x.max(p.x), max.y.max(p.y));
                }
            }
        }
        (min, max)
    }

    /// Does the arc or circle pass the direction `d` from its centre? False for a line.
    pub fn sweeps_over(&self, d: Vec2) -> bool {
        match *self {
            Segment::Line { .. } => false,
            Segment::Circle { .. } => true,
            Segment::Arc { from, center, convex, .. } => {
                let a = from - center;
                let angle = a.cross(d).atan2(a.dot(d));
                let angle = if convex { angle } else { -angle };
                angle.rem_euclid(TAU) <= self.sweep()
            }
        }
    }
}
