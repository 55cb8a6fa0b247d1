//! Rigid motions of space, over any scalar. Named `a_from_b`: maps coordinates in b to coordinates in a.

use crate::{Scalar, Vec3};

/// A rotation followed by a translation: `p ↦ R p + t`. The columns of R are the images of the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid3<S = f64> {
    /// Images of the unit vectors x, y, z.
    pub columns: [Vec3<S>; 3],
    pub translation: Vec3<S>,
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    X,
    Y,
    Z,
}

impl<S: Scalar> Rigid3<S> {
    pub fn identity() -> Self {
        let (o, l) = (S::constant(0.0), S::constant(1.0));
        Self {
            columns: [Vec3::new(l, o, o), Vec3::new(o, l, o), Vec3::new(o, o, l)],
            translation: Vec3::new(o, o, o),
        }
    }

    pub fn translation(t: Vec3<S>) -> Self {
        Self { translation: t, ..Self::identity() }
    }

    /// Right-handed rotation by `angle` (radians) about an axis through the origin.
    pub fn rotation(axis: Axis, angle: S) -> Self {
        let (s, c) = angle.sin_cos();
        let mut m = Self::identity();
        let (i, j) = match axis {
            Axis::X => (1, 2),
            Axis::Y => (2, 0),
            Axis::Z => (0, 1),
        };
        let (u, v) = (m.columns[i], m.columns[j]);
        m.columns[i] = u * c + v * s;
        m.columns[j] = v * c - u * s;
        m
    }

    /// The image of a point.
    pub fn apply(&self, p: Vec3<S>) -> Vec3<S> {
        self.rotate(p) + self.translation
    }

    /// The image of a direction.
    pub fn rotate(&self, d: Vec3<S>) -> Vec3<S> {
        self.columns[0] * d.x + self.columns[1] * d.y + self.columns[2] * d.z
    }

    /// `self ∘ inner`: first `inner`, then `self`.
    pub fn then_after(&self, inner: &Self) -> Self {
        Self { columns: inner.columns.map(|c| self.rotate(c)), translation: self.apply(inner.translation) }
    }

    pub fn inverse(&self) -> Self {
        let c = &self.columns;
        let columns = [
            Vec3::new(c[0].x, c[1].x, c[2].x),
            Vec3::new(c[0].y, c[1].y, c[2].y),
            Vec3::new(c[0].z, c[1].z, c[2].z),
        ];
        let rotation = Self { columns, translation: self.translation };
        Self { columns, translation: -rotation.rotate(self.translation) }
    }

    /// The value without derivatives.
    pub fn re(&self) -> Rigid3<f64> {
        Rigid3 { columns: self.columns.map(Vec3::re), translation: self.translation.re() }
    }
}
