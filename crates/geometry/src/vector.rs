//! Points and vectors of the plane and of space, over any scalar. Units: the machine file's length.

use crate::Scalar;
use std::ops::{Add, Mul, Neg, Sub};

/// A point or vector of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec2<S = f64> {
    pub x: S,
    pub y: S,
}

/// A point or vector of space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3<S = f64> {
    pub x: S,
    pub y: S,
    pub z: S,
}

impl<S: Scalar> Vec2<S> {
    pub const fn new(x: S, y: S) -> Self {
        Self { x, y }
    }

    pub fn dot(self, other: Self) -> S {
        self.x * other.x + self.y * other.y
    }

    /// The z component of the cross product: positive when `other` lies counterclockwise of `self`.
    pub fn cross(self, other: Self) -> S {
        self.x * other.y - self.y * other.x
    }

    /// A quarter turn counterclockwise.
    pub fn perp(self) -> Self {
        Self::new(-self.y, self.x)
    }

    pub fn norm(self) -> S {
        self.dot(self).sqrt()
    }

    /// The unit vector along `self`; not finite for the zero vector.
    pub fn unit(self) -> Self {
        self * self.norm().recip()
    }

    /// The value without derivatives.
    pub fn re(self) -> Vec2<f64> {
        Vec2 { x: self.x.re(), y: self.y.re() }
    }

    pub fn constant(v: Vec2<f64>) -> Self {
        Self::new(S::constant(v.x), S::constant(v.y))
    }
}

impl<S: Scalar> Vec3<S> {
    pub const fn new(x: S, y: S, z: S) -> Self {
        Self { x, y, z }
    }

    pub fn dot(self, other: Self) -> S {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub fn cross(self, o: Self) -> Self {
        Self::new(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }

    pub fn norm(self) -> S {
        self.dot(self).sqrt()
    }

    /// The unit vector along `self`; not finite for the zero vector.
    pub fn unit(self) -> Self {
        self * self.norm().recip()
    }

    /// The value without derivatives.
    pub fn re(self) -> Vec3<f64> {
        Vec3 { x: self.x.re(), y: self.y.re(), z: self.z.re() }
    }

    pub fn constant(v: Vec3<f64>) -> Self {
        Self::new(S::constant(v.x), S::constant(v.y), S::constant(v.z))
    }
}

impl<S: Scalar> Add for Vec2<S> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y)
    }
}

impl<S: Scalar> Sub for Vec2<S> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y)
    }
}

impl<S: Scalar> Mul<S> for Vec2<S> {
    type Output = Self;
    fn mul(self, k: S) -> Self {
        Self::new(self.x * k, self.y * k)
    }
}

impl<S: Scalar> Neg for Vec2<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl<S: Scalar> Mul<S> for Vec3<S> {
    type Output = Self;
    fn mul(self, k: S) -> Self {
        Self::new(self.x * k, self.y * k, self.z * k)
    }
}

impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
