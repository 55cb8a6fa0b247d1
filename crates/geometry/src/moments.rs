//! Volume integrals of 1, p and p pᵀ, of plane regions by Green's theorem and of solids.

use crate::{Rigid3, Segment, Vec2, Vec3};

/// ∫1, ∫p and ∫p pᵀ over a plane region or a solid; of a plane region the third coordinate is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moments {
    pub zeroth: f64,
    pub first: [f64; 3],
    /// Rows of the symmetric matrix.
    pub second: [[f64; 3]; 3],
}

impl Moments {
    pub fn add(&mut self, o: &Self) {
        self.zeroth += o.zeroth;
        for i in 0..3 {
            self.first[i] += o.first[i];
            for j in 0..3 {
                self.second[i][j] += o.second[i][j];
            }
        }
    }

    /// The same region moved by `t`.
    pub fn moved(&self, t: [f64; 3]) -> Self {
        let (m, f) = (self.zeroth, self.first);
        let entry = |i: usize, j: usize| self.second[i][j] + t[i] * f[j] + f[i] * t[j] + m * t[i] * t[j];
        Self {
            zeroth: m,
            first: [0, 1, 2].map(|i| f[i] + m * t[i]),
            second: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
        }
    }

    /// The same region turned by the rotation of `turn` (its translation is left out).
    pub fn rotated(&self, turn: &Rigid3) -> Self {
        let r = turn.columns.map(|c| [c.x, c.y, c.z]);
        let f = turn.rotate(Vec3::new(self.first[0], self.first[1], self.first[2]));
        let entry = |i: usize, j: usize| {
            let pairs = (0..3).flat_map(|k| (0..3).map(move |l| (k, l)));
            pairs.map(|(k, l)| r[k][i] * self.second[k][l] * r[l][j]).sum()
        };
        Self {
            zeroth: self.zeroth,
            first: [f.x, f.y, f.z],
            second: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
        }
    }

    /// A plane region's prism over heights from `bottom` to `top`.
    pub fn extruded(&self, bottom: f64, top: f64) -> Self {
        let rise = |k: i32| (top.powi(k) - bottom.powi(k)) / f64::from(k);
        let mut m = *self;
        m.zeroth *= rise(1);
        m.first = [self.first[0] * rise(1), self.first[1] * rise(1), self.zeroth * rise(2)];
        for i in 0..2 {
            for j in 0..2 {
                m.second[i][j] *= rise(1);
            }
            m.second[i][2] = self.first[i] * rise(2);
            m.second[2][i] = m.second[i][2];
        }
        m.second[2][2] = self.zeroth * rise(3);
        m
    }

    /// The signed region swept by the way from the origin to a point that runs along the segment; summed
    /// over a boundary it is the region inside.
    pub fn swept(segment: &Segment) -> Self {
        let (a, b) = (segment.start(), segment.end());
        match *segment {
            Segment::Line { .. } => Self::triangle(a, b),
            Segment::Arc { center, .. } | Segment::Circle { center, .. } => {
                let mut m = Self::sector(segment, a - center, b - center).moved([center.x, center.y, 0.0]);
                m.add(&Self::triangle(a, center));
                m.add(&Self::triangle(center, b));
                m
            }
        }
    }

    /// The triangle from the origin to `a` to `b`.
    fn triangle(a: Vec2, b: Vec2) -> Self {
        let area = 0.5 * a.cross(b);
        let (u, v, s) = ([a.x, a.y, 0.0], [b.x, b.y, 0.0], [a.x + b.x, a.y + b.y, 0.0]);
        let entry = |i: usize, j: usize| area / 12.0 * (u[i] * u[j] + v[i] * v[j] + s[i] * s[j]);
        Self {
            zeroth: area,
            first: s.map(|k| k * area / 3.0),
            second: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
        }
    }

    /// The sector of an arc about its centre; `a` and `b` are its ends seen from there.
    fn sector(segment: &Segment, a: Vec2, b: Vec2) -> Self {
        let (r, convex) = match *segment {
            Segment::Arc { radius, convex, .. } | Segment::Circle { radius, convex, .. } => (radius, convex),
            Segment::Line { .. } => return Self::default(),
        };
        let sweep = if convex { segment.sweep() } else { -segment.sweep() };
        let (area, quarter) = (0.5 * r * r * sweep, 0.25 * r * r);
        let first = -(b - a).perp() * (r * r / 3.0);
        let (even, odd) = (0.5 * area * r * r, quarter * (b.x * b.y - a.x * a.y));
        let xy = quarter * (b.y * b.y - a.y * a.y);
        Self {
            zeroth: area,
            first: [first.x, first.y, 0.0],
            second: [[0.5 * (even + odd), xy * 0.5, 0.0], [xy * 0.5, 0.5 * (even - odd), 0.0], [0.0; 3]],
        }
    }
}
