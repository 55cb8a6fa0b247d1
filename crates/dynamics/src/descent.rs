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

/// Most halvings of a time in which a quantity that falls from zero may have risen before.
const HALVINGS: u32 = 50;

/// What a search found: the first zero, and the time before which there is no other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descent {
    pub zero: Option<f64>,
    pub clear_until: f64,
}

/// The first time from `from` to `to` at which the quantity falls through zero, to below `−floor`: what comes no further
/// is zero to rounding. One that begins within ± `floor` has to rise first, or else falls at once.
pub fn first_zero(look: impl Fn(f64) -> Look, (from, to): (f64, f64), floor: f64) -> Descent {
    let (mut t, mut above) = (from, None);
    for _ in 0..MOST {
        let Look { x, rate, bend } = look(t);
        if x < -floor {
            let zero = match above {
                Some(above) => narrow(|t| look(t).x, above, (t, x)).0.0,
                None => crossing(&look, (from, t)),
            };
            return Descent { zero: Some(zero), clear_until: zero };
        }
        if x > 0.0 {
            above = Some((t, x));
        }
        if t >= to {
            break;
        }
        let root = (rate * rate + 2.0 * bend * x.max(0.0)).sqrt();
        let safe = if rate < 0.0 { 2.0 * x.max(0.0) / (root - rate) } else { (rate + root) / bend };
        // Near zero the next look is where the quantity would be as far below as it may be above.
        let through = if rate < 0.0 { 2.0 * floor / -rate } else { f64::INFINITY };
        let near = through.min(CREEP * (to - from));
        let least = 2.0 * f64::EPSILON * (1.0 + t.abs());
        // No bend and no fall: the step is unbounded, or 0/0.
        let step = if safe.is_nan() { to - t } else { safe.max(if x > floor { least } else { near }) };
        t = to.min(t + step.max(least));
    }
    Descent { zero: None, clear_until: t }
}

/// Between a time at which the quantity is not below zero and one at which it is. One that begins at zero may rise by
/// little before it falls: the time looked for is that of the fall.
fn crossing(look: &impl Fn(f64) -> Look, (good, bad): (f64, f64)) -> f64 {
    let (mut share, mut above) = (0.5, (good, look(good).x));
    for _ in 0..HALVINGS {
        if above.1 > 0.0 {
            return narrow(|t| look(t).x, above, (bad, look(bad).x)).0.0;
        }
        let t = good + share * (bad - good);
        (share, above) = (0.5 * share, (t, look(t).x));
    }
    good
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
        let hops = |t: f64| Look { x: t * (1e-3 - t), rate: 0.0, bend: 1e-9 };
        assert!((first_zero(hops, (0.0, 1.0), 1e-9).zero.unwrap() - 1e-3).abs() < 1e-11);
        let falls = |t: f64| Look { x: -t, rate: -1.0, bend: 0.0 };
        assert_eq!(first_zero(falls, (0.0, 3.0), 1e-12).zero, Some(0.0));
    }
}
