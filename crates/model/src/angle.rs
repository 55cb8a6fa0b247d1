//! Degrees, and operations whose real part is the same to the last bit over numbers and dual numbers.

use mainspring_geometry::{Axis, Vec3};
use mainspring_geometry::{Rigid3, Scalar};
use std::f64::consts::PI;

/// Factor that brings numbers near the ends of the range of `f64` to where their squares and reciprocals are finite.
const SCALE: f64 = f64::from_bits((1023 + 500) << 52); // 2^500

/// `value` with its real part replaced by `real`; derivatives kept, unless `value` left the range of numbers.
/// A negative zero becomes zero, as the sum below makes it.
pub(crate) fn with_real<S: Scalar>(value: S, real: f64) -> S {
    let real = real + 0.0;
    if S::NDERIV == 0 || !value.re().is_finite() || !real.is_finite() {
        return S::constant(real);
    }
    value - value.re() + real
}

/// The power of two by which numbers of this size are multiplied before they are squared or inverted.
fn scale(size: f64) -> f64 {
    if size < 1.0 / SCALE {
        SCALE
    } else if size > SCALE {
        1.0 / SCALE
    } else {
        1.0
    }
}

/// Quotient; a dual number's own division multiplies by the reciprocal, which rounds differently and is infinite
/// for the least divisors.
pub(crate) fn quotient<S: Scalar>(a: S, b: S) -> S {
    let scale = scale(b.re().abs());
    with_real((a * scale) / (b * scale), a.re() / b.re())
}

/// Square root of a number that is not negative; at zero, where it has no derivative, that is taken as zero.
pub(crate) fn root<S: Scalar>(x: S) -> S {
    if x.re() == 0.0 {
        return S::constant(0.0);
    }
    let root = if x.re() < 1.0 / SCALE { (x * (SCALE * SCALE)).sqrt() * (1.0 / SCALE) } else { x.sqrt() };
    with_real(root, x.re().sqrt())
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90°; derivatives are per degree.
pub(crate) fn sin_cos_degrees<S: Scalar>(angle: S) -> (S, S) {
    let turn = angle.re() % 360.0;
    let quarter = (turn / 90.0).round();
    let (s, c) = (with_real(angle, turn - 90.0 * quarter) * (PI / 180.0)).sin_cos();
    // 0 − x rather than −x: no negative zeros in rotation matrices.
    let zero = S::constant(0.0);
    match (quarter as i64).rem_euclid(4) {
        0 => (s, c),
        1 => (c, zero - s),
        2 => (zero - s, zero - c),
        _ => (zero - c, s),
    }
}

/// The angle of the point (x, y) in degrees; 0 at the origin, with derivative 0.
pub(crate) fn atan2_degrees<S: Scalar>(y: S, x: S) -> S {
    if y.re() == 0.0 && x.re() == 0.0 {
        return S::constant(0.0);
    }
    let scale = scale(y.re().abs().max(x.re().abs()));
    let real = y.re().atan2(x.re()) * (180.0 / PI);
    with_real((y * scale).atan2(x * scale) * (180.0 / PI), real)
}

/// Right-handed rotation by `angle` degrees about an axis through the origin, exact at multiples of 90°.
pub(crate) fn rotation<S: Scalar>(axis: Axis, angle: S) -> Rigid3<S> {
    let (s, c) = sin_cos_degrees(angle);
    let (o, l) = (S::constant(0.0), S::constant(1.0));
    let columns = match axis {
        Axis::X => [Vec3::new(l, o, o), Vec3::new(o, c, s), Vec3::new(o, o - s, c)],
        Axis::Y => [Vec3::new(c, o, o - s), Vec3::new(o, l, o), Vec3::new(s, o, c)],
        Axis::Z => [Vec3::new(c, s, o), Vec3::new(o - s, c, o), Vec3::new(o, o, l)],
    };
    Rigid3 { columns, ..Rigid3::identity() }
}

/// Translation by `length` along an axis.
pub(crate) fn translation<S: Scalar>(axis: Axis, length: S) -> Rigid3<S> {
    let o = S::constant(0.0);
    Rigid3::translation(match axis {
        Axis::X => Vec3::new(length, o, o),
        Axis::Y => Vec3::new(o, length, o),
        Axis::Z => Vec3::new(o, o, length),
    })
}
