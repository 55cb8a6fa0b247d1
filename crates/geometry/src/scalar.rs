//! The one scalar trait: numbers, and dual numbers that carry exact derivatives.

use num_dual::DualNum;

/// A real number or a dual number over `f64`. Every recipe and every gap is written once over this trait;
/// evaluating it at a dual number gives derivatives exact to rounding.
pub trait Scalar: DualNum<Primitive = f64> + Copy {
    /// The constant `value`, with zero derivatives.
    fn constant(value: f64) -> Self {
        Self::from(value)
    }
}

impl<T: DualNum<Primitive = f64> + Copy> Scalar for T {}
