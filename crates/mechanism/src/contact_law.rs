//! The force of compliant contact (Gelsey 1995, Eq. 4, corrected: `Mo` is a product).
//!
//! ```text
//! l = o (E + D M ȯ)      where o > 0 and E + D M ȯ > 0, else 0
//! ```
//! o the depth of overlap, ȯ its rate. Of the power `l ȯ` put in, `E o ȯ` is stored as `½ E o²` and `D M o ȯ²` is lost;
//! where the clamp holds the force at zero, the stored energy is lost as the overlap falls (`−E o ȯ`).

use crate::forces::ContactLaw;

impl ContactLaw {
    /// D M.
    pub fn viscosity(&self) -> f64 {
        self.d * self.m
    }

    /// `E + D M ȯ`: the force per depth; the clamp holds where it is negative.
    pub fn slope(&self, rate: f64) -> f64 {
        self.e + self.viscosity() * rate
    }

    /// ½ E o².
    pub fn stored(&self, depth: f64) -> f64 {
        0.5 * self.e * depth * depth
    }

    /// Power lost: `l ȯ − E o ȯ`.
    pub fn loss(&self, depth: f64, rate: f64, clamped: bool) -> f64 {
        let slope = if clamped { 0.0 } else { self.slope(rate) };
        depth * rate * (slope - self.e)
    }
}
