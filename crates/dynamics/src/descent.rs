//! The first time at which a quantity comes down to zero: a velocity against dry friction, the gap of a stop.
//!
//! With `|ẍ| ≤ B` over the stretch, `x(t + Δ) ≥ x + ẋ Δ − B Δ²/2`: steps to the positive root pass no zero, and near one
//! they converge like Newton's.

use crate::root::narrow;

/// A quantity with its rate and a bound of |ẍ| from here to the end of the stretch.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    pub x: f64,
    pub rate: f64,
    pub bend: f64,
}

/// Most looks along one stretch.
const MOST: usize = 4000;
/// Least step, relative to the stretch, while the quantity is zero to rounding.
const CREEP: f64 = 1e-4;

/// What a search found: the first zero, and the time before which there is no other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descent {
    pub zero: Option<f64>,
    pub clear_until: f64,
}

/// The first zero from `from` to `to`. Values within ± `floor` are zero to rounding; a quantity that begins there comes
/// down only once it was above, or when it falls clearly below.
pub fn first_zero(look: impl Fn(f64) -> Look, (from, to): (f64, f64), floor: f64) -> Descent {
    let (mut t, mut before, mut seen) = (from, from, false);
    for _ in 0..MOST {
        let Look { x, rate, bend } = look(t);
        let found = |t: f64| Descent { zero: Some(t), clear_until: t };
        if seen && x <= floor && rate < 0.0 && x >= -floor {
            return found((t - x / rate).clamp(before, to));
        }
        if x < -floor {
            return found(crossing(&look, (before, t)));
        }
        seen |= x > floor;
        if t >= to {
            break;
        }
        let root = (rate * rate + 2.0 * bend * x.max(0.0)).sqrt();
        let step = if rate < 0.0 { 2.0 * x.max(0.0) / (root - rate) } else { (rate + root) / bend };
        let least = if x > floor { 2.0 * f64::EPSILON * (1.0 + t.abs()) } else { CREEP * (to - from) };
        // No bend and no fall: the step is unbounded, or 0/0.
        let step = if step.is_nan() { to - t } else { step.max(least) };
        before = t;
        t = to.min(t + step);
    }
    Descent { zero: None, clear_until: t }
}

/// Between a time at which the quantity is not below zero and one at which it is.
fn crossing(look: &impl Fn(f64) -> Look, (good, bad): (f64, f64)) -> f64 {
    let (start, end) = (look(good).x, look(bad).x);
    if start <= 0.0 || bad <= good {
        return good;
    }
    narrow(|t| look(t).x, (good, start), (bad, end)).0.0
}

#[cfg(test)]
mod tests {
    use super::{Look, first_zero};

    #[test]
    fn zeros_are_found_and_none_is_passed() {
        for (height, fall) in [(1.0f64, 1.0f64), (0.25, 3.0), (1e-3, 2.0)] {
            // x = h + t − f t²/2
            let look = |t: f64| Look { x: height + t - 0.5 * fall * t * t, rate: 1.0 - fall * t, bend: 10.0 };
            let exact = (1.0 + (1.0 + 2.0 * fall * height).sqrt()) / fall;
            let found = first_zero(look, (0.0, 9.0), 1e-13).zero.unwrap();
            assert!((found - exact).abs() < 1e-12, "{found} {exact}");
            assert_eq!(first_zero(look, (0.0, 0.9 * exact), 1e-13).zero, None);
        }
    }

    #[test]
    fn a_quantity_that_starts_at_zero_must_rise_first() {
        let rises = |t: f64| Look { x: t * (1.0 - t), rate: 1.0 - 2.0 * t, bend: 2.0 };
        assert!((first_zero(rises, (0.0, 3.0), 1e-12).zero.unwrap() - 1.0).abs() < 1e-11);
        let stays = |_: f64| Look { x: 0.0, rate: 0.0, bend: 0.0 };
        assert_eq!(first_zero(stays, (0.0, 3.0), 1e-12).zero, None);
        let falls = |t: f64| Look { x: -t, rate: -1.0, bend: 0.0 };
        assert_eq!(first_zero(falls, (0.0, 3.0), 1e-12).zero, Some(0.0));
    }
}
