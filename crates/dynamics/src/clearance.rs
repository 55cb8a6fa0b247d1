//! How long a gap certainly stays away from zero.
//!
//! With gap g, rate ġ, acceleration g̈ and bounds B ≥ |g̈|, J ≥ |g⃛| over the time to come,
//! ```text
//! g(Δ) ≥ g + ġ Δ − B Δ²/2        g(Δ) ≥ p(Δ) = g + ġ Δ + g̈ Δ²/2 − J Δ³/6
//! ```
//! Neither has a zero before the gap has. Near a zero the second gives steps that converge faster than Newton's.

use crate::pace::GapPace;

/// A gap that is not negative, with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    pub gap: f64,
    pub rate: f64,
    pub acceleration: f64,
}

impl Gap {
    /// A time, at most `longest`, before which the gap has no zero.
    pub fn clearance(&self, pace: &GapPace, longest: f64) -> f64 {
        let quadratic = self.quadratic(pace.acceleration);
        if quadratic >= longest {
            return longest;
        }
        let cubic = if self.rate < 0.0 && self.acceleration > 0.0 {
            self.braking(pace.jerk, longest)
                .max(Self { acceleration: 0.0, ..*self }.concave(pace.jerk, longest))
        } else {
            self.concave(pace.jerk, longest)
        };
        quadratic.max(cubic)
    }

    /// Positive root of `g + ġ Δ − B Δ²/2`; infinite when nothing bends.
    fn quadratic(&self, bound: f64) -> f64 {
        let (g, s) = (self.gap, self.rate);
        let root = (s * s + 2.0 * bound * g).sqrt();
        if s < 0.0 {
            2.0 * g / (root - s)
        } else if bound > 0.0 {
            (s + root) / bound
        } else {
            f64::INFINITY
        }
    }

    /// Before the end of `longest`, for a gap that closes ever slower: there `p ≥ g + ġ Δ + (g̈ − J Δ_max/3) Δ²/2`.
    fn braking(&self, jerk: f64, longest: f64) -> f64 {
        let (g, s) = (self.gap, self.rate);
        let mut best: f64 = 0.0;
        for within in [longest, longest.min(-2.0 * g / s)] {
            let a = self.acceleration - jerk * within / 3.0;
            let square = s * s - 2.0 * g * a;
            if square < 0.0 {
                return best.max(within);
            }
            best = best.max(within.min(2.0 * g / (square.sqrt() - s)));
        }
        best
    }

    /// A lower bound of the only positive root of p, where p is concave as far as it falls.
    fn concave(&self, jerk: f64, longest: f64) -> f64 {
        let Self { gap: g, rate: s, acceleration: a } = *self;
        let (half, sixth) = (0.5 * a, jerk / 6.0);
        let p = |d: f64| g + d * (s + d * (half - sixth * d));
        if p(longest) > 0.0 {
            return longest;
        }
        // Sums of the roots of single terms are never less than the root; single ones never more.
        let inverse = 1.0 / jerk.max(f64::MIN_POSITIVE);
        let risen = 3.0 * a.max(0.0) * inverse;
        let most = risen + (6.0 * s.max(0.0) * inverse).sqrt() + cube_root_above(6.0 * g * inverse);
        let (mut left, mut right) = (risen.min(longest), longest.min(most));
        if s < 0.0 {
            right = right.min(-g / s);
        }
        // From the right Newton's steps stay beyond the root, from the left a chord's stay before it.
        for _ in 0..3 {
            let slope = s + right * (a - 3.0 * sixth * right);
            let next = right - p(right) / slope;
            if !(slope < 0.0 && next < right && next > left) {
                break;
            }
            right = next;
        }
        let below = p(right);
        for _ in 0..2 {
            let above = p(left);
            if below >= 0.0 || above <= 0.0 {
                break;
            }
            left += (right - left) * above / (above - below);
        }
        left
    }
}

/// A number above the cube root of `x ≥ 0`, by no more than 1 %: Newton's step from a third of the exponent.
fn cube_root_above(x: f64) -> f64 {
    let guess = f64::from_bits(x.to_bits() / 3 + 0x2A9F_7625_3119_D328);
    (2.0 * guess + x / (guess * guess)) / 3.0
}

#[cfg(test)]
mod tests {
    #[test]
    fn cube_roots_are_met_from_above() {
        for n in -2000..2000 {
            let x = 1.37f64.powi(n / 4) * (1.0 + 0.1 * f64::from(n % 7));
            let (found, exact) = (super::cube_root_above(x), x.cbrt());
            assert!(found >= exact * (1.0 - 1e-15) && found <= 1.01 * exact, "{x}: {found} {exact}");
        }
        assert!(super::cube_root_above(0.0) < 1e-90);
    }

    use super::Gap;
    use crate::pace::GapPace;

    /// Over random gaps the cubic with the greatest jerk has no zero before the clearance, and usually one soon after.
    #[test]
    fn no_zero_lies_before_the_clearance() {
        let mut seed = 5u64;
        let mut next = |low: f64, high: f64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            low + (high - low) * (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let (mut cases, mut tight) = (0, 0);
        for _ in 0..20_000 {
            let gap = 10f64.powf(next(-12.0, 1.0));
            let rate = next(-1.0, 1.0) * 10f64.powf(next(-8.0, 1.0));
            let acceleration = next(-1.0, 1.0) * 10f64.powf(next(-4.0, 2.0));
            let jerk = 10f64.powf(next(-3.0, 3.0));
            let longest = 10f64.powf(next(-4.0, 1.0));
            let pace = GapPace { speed: 0.0, acceleration: acceleration.abs() + jerk * longest, jerk };
            let step = Gap { gap, rate, acceleration }.clearance(&pace, longest);
            assert!(step >= 0.0 && step <= longest, "{step}");
            let p = |d: f64| gap + d * (rate + d * (0.5 * acceleration - jerk * d / 6.0));
            let noise = 1e-13 * (gap + rate.abs() * step + acceleration.abs() * step * step);
            for n in 0..=100 {
                let d = step * f64::from(n) / 100.0;
                assert!(p(d) >= -noise, "{gap} {rate} {acceleration} {jerk} {longest}: {step}");
            }
            cases += 1;
            tight += u32::from(step == longest || p(1.5 * step) < 0.0);
        }
        assert!(tight > cases * 8 / 10, "{tight} of {cases}");
    }
}
