//! The one scalar trait: numbers, and dual numbers that carry exact derivatives.

use num_dual::{Dual2_64, Dual3_64, Dual64, DualNum};

/// A real number or a dual number over `f64`. Every recipe and every gap is written once over this trait;
/// evaluating it at a dual number gives derivatives exact to rounding.
pub trait Scalar: DualNum<Primitive = f64> + Copy {
    /// The constant `value`, with zero derivatives.
    fn constant(value: f64) -> Self {
        Self::from(value)
    }

    /// Sine and cosine.
    fn sine_and_cosine(self) -> (Self, Self) {
        self.sin_cos()
    }
}

/// Plain numbers have most of the work to do: `libm` takes half the time of the system's mathematics, and gives the same
/// digits on every system.
impl Scalar for f64 {
    #[inline]
    fn sine_and_cosine(self) -> (Self, Self) {
        libm::sincos(self)
    }
}

impl Scalar for Dual64 {}
impl Scalar for Dual2_64 {}
impl Scalar for Dual3_64 {}
