//! Axis-parallel boxes around primitives, to leave out what is far away.

use mainspring_geometry::{Primitive, Shape, Vec3};

/// A box with sides along the machine's axes; empty when `low > high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub low: Vec3,
    pub high: Vec3,
}

impl Bounds {
    pub(crate) const EMPTY: Bounds = Bounds {
        low: Vec3 { x: f64::INFINITY, y: f64::INFINITY, z: f64::INFINITY },
        high: Vec3 { x: f64::NEG_INFINITY, y: f64::NEG_INFINITY, z: f64::NEG_INFINITY },
    };

    pub(crate) fn of_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.join(&Bounds { low: p, high: p }))
    }

    /// Around a primitive; exact for blocks, cylinders and spheres, else around its local box.
    pub(crate) fn of(primitive: &Primitive) -> Self {
        let pose = &primitive.machine_from_local;
        match primitive.shape {
            Shape::Cylinder { radius, height } => {
                let axis = pose.columns[2];
                let reach = |c: f64| radius * (1.0 - c * c).max(0.0).sqrt();
                let reach = Vec3::new(reach(axis.x), reach(axis.y), reach(axis.z));
                let ends = [pose.translation, pose.translation + axis * height];
                Self::of_points(ends.iter().flat_map(|&e| [e - reach, e + reach]))
            }
            Shape::Sphere { radius } => {
                let r = Vec3::new(radius, radius, radius);
                Bounds { low: pose.translation - r, high: pose.translation + r }
            }
            _ => {
                let (low, high) = local_box(&primitive.shape);
                let corner = |i: usize| {
                    let pick = |bit: usize, a: f64, b: f64| if i >> bit & 1 == 0 { a } else { b };
                    Vec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
                };
                Self::of_points((0..8).map(|i| pose.apply(corner(i))))
            }
        }
    }

    pub(crate) fn join(&self, o: &Self) -> Self {
        let least = |a: Vec3, b: Vec3| Vec3::new(a.x.min(b.x), a.y.min(b.y), a.z.min(b.z));
        Bounds { low: least(self.low, o.low), high: -least(-self.high, -o.high) }
    }

    /// What two boxes share; empty if they do not touch.
    pub(crate) fn common(&self, o: &Self) -> Self {
        let most = |a: Vec3, b: Vec3| Vec3::new(a.x.max(b.x), a.y.max(b.y), a.z.max(b.z));
        Bounds { low: most(self.low, o.low), high: -most(-self.high, -o.high) }
    }

    /// The same box with every face moved out by `margin`.
    pub(crate) fn grown(&self, margin: f64) -> Self {
        let m = Vec3::new(margin, margin, margin);
        Bounds { low: self.low - m, high: self.high + m }
    }

    /// Do they share a point (faces included)?
    pub(crate) fn touches(&self, o: &Self) -> bool {
        self.low.x <= o.high.x
            && o.low.x <= self.high.x
            && self.low.y <= o.high.y
            && o.low.y <= self.high.y
            && self.low.z <= o.high.z
            && o.low.z <= self.high.z
    }

    /// Is the point within `margin` of the box?
    pub(crate) fn holds(&self, p: Vec3, margin: f64) -> bool {
        p.x >= self.low.x - margin
            && p.x <= self.high.x + margin
            && p.y >= self.low.y - margin
            && p.y <= self.high.y + margin
            && p.z >= self.low.z - margin
            && p.z <= self.high.z + margin
    }

    /// Does the line `p + t w` come within `margin` of the box?
    pub(crate) fn meets_line(&self, p: Vec3, w: Vec3, margin: f64) -> bool {
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        let axes = [
            (p.x, w.x, self.low.x, self.high.x),
            (p.y, w.y, self.low.y, self.high.y),
            (p.z, w.z, self.low.z, self.high.z),
        ];
        for (p, w, low, high) in axes {
            let (low, high) = (low - margin - p, high + margin - p);
            if w.abs() < 1e-12 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let (a, b) = (low / w, high / w);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        from <= to
    }

    /// Length of the diagonal; 0 for the empty box.
    pub(crate) fn diagonal(&self) -> f64 {
        if self.low.x > self.high.x { 0.0 } else { (self.high - self.low).norm() }
    }

    pub(crate) fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, a: f64, b: f64| if i >> bit & 1 == 0 { a } else { b };
            Vec3::new(
                pick(0, self.low.x, self.high.x),
                pick(1, self.low.y, self.high.y),
                pick(2, self.low.z, self.high.z),
            )
        })
    }
}

/// Low and high corner of a shape in its own coordinates.
pub(crate) fn local_box(shape: &Shape) -> (Vec3, Vec3) {
    let (low, high) = match *shape {
        Shape::Block { x, y, z } | Shape::Wedge { x, y, z } => ([0.0; 3], [x, y, z]),
        Shape::Cylinder { radius: r, height } | Shape::Cone { radius: r, height } => {
            ([-r, -r, 0.0], [r, r, height])
        }
        Shape::Sphere { radius: r } => ([-r; 3], [r; 3]),
    };
    (Vec3::new(low[0], low[1], low[2]), Vec3::new(high[0], high[1], high[2]))
}
