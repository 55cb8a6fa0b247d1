//! Boxes that hold solids. Units: the machine file's length.

use crate::{Primitive, Rigid3, Shape, Vec3};

/// A box with sides along the axes; empty when a minimum exceeds its maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    pub min: [f64; 3],
    pub max: [f64; 3],
}

impl Bounds3 {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    /// The smallest box about a primitive, in the coordinates of the working plane.
    pub fn of(primitive: &Primitive, plane_from_machine: &Rigid3) -> Self {
        let pose = plane_from_machine.then_after(&primitive.machine_from_local);
        match primitive.shape {
            Shape::Block { x, y, z } | Shape::Wedge { x, y, z } => Self::of_block(&pose, [x, y, z]),
            Shape::Cylinder { radius, height } => {
                Self::of_disc(&pose, radius, 0.0).hull(&Self::of_disc(&pose, radius, height))
            }
            Shape::Cone { radius, height } => {
                Self::of_disc(&pose, radius, 0.0).hull(&Self::of_disc(&pose, 0.0, height))
            }
            Shape::Sphere { radius } => Self::about(pose.translation, [radius; 3]),
        }
    }

    fn about(c: Vec3, half: [f64; 3]) -> Self {
        let c = [c.x, c.y, c.z];
        Self { min: [0, 1, 2].map(|i| c[i] - half[i]), max: [0, 1, 2].map(|i| c[i] + half[i]) }
    }

    fn of_block(pose: &Rigid3, sizes: [f64; 3]) -> Self {
        (0..8u8).fold(Self::EMPTY, |b, i| {
            let pick = |k: usize| if i >> k & 1 == 1 { sizes[k] } else { 0.0 };
            b.hull(&Self::about(pose.apply(Vec3::new(pick(0), pick(1), pick(2))), [0.0; 3]))
        })
    }

    /// A disc normal to the local z axis.
    fn of_disc(pose: &Rigid3, radius: f64, height: f64) -> Self {
        let a = pose.columns[2];
        let half = [a.x, a.y, a.z].map(|k| radius * (1.0 - k * k).max(0.0).sqrt());
        Self::about(pose.apply(Vec3::new(0.0, 0.0, height)), half)
    }

    /// The smallest box about both.
    pub fn hull(&self, o: &Self) -> Self {
        Self {
            min: [0, 1, 2].map(|i| self.min[i].min(o.min[i])),
            max: [0, 1, 2].map(|i| self.max[i].max(o.max[i])),
        }
    }

    /// The common part, [`Bounds3::EMPTY`] if there is none.
    pub fn common(&self, o: &Self) -> Self {
        let both = Self {
            min: [0, 1, 2].map(|i| self.min[i].max(o.min[i])),
            max: [0, 1, 2].map(|i| self.max[i].min(o.max[i])),
        };
        if both.is_empty() { Self::EMPTY } else { both }
    }

    pub fn is_empty(&self) -> bool {
        (0..3).any(|i| self.min[i] > self.max[i] || self.min[i].is_nan() || self.max[i].is_nan())
    }

    /// The smallest of the three sides; negative infinity for the empty box.
    pub fn thickness(&self) -> f64 {
        (0..3).map(|i| self.max[i] - self.min[i]).fold(f64::INFINITY, f64::min)
    }

    /// The length of the diagonal; 0 for the empty box.
    pub fn diagonal(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        (0..3).map(|i| (self.max[i] - self.min[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// The greatest absolute coordinate, which limits how finely positions are known.
    pub fn reach(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        (0..3).map(|i| self.min[i].abs().max(self.max[i].abs())).fold(0.0, f64::max)
    }
}
