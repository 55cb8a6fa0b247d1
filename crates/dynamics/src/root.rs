//! A sign change between two times, found to the grain of the clock.
//!
//! Inverse quadratic interpolation where three points show a function without a turn, else bisection (Chandrupatla,
//! Advances in Engineering Software 28, 1997).

/// A time and the function's value there.
pub type Point = (f64, f64);

/// Most evaluations: bisection alone takes fewer.
const MOST: usize = 120;

/// Narrows a bracket of a sign change to the grain of the clock. `a` and `b` have values of unlike signs (zero counts
/// as not negative); so have the points returned, in the same order, unless an exact zero was met: then it is both.
pub fn narrow(mut f: impl FnMut(f64) -> f64, a: Point, b: Point) -> (Point, Point) {
    let (mut last, mut other) = (b, a);
    let is_negative = |p: Point| p.1 < 0.0;
    // The first step is a secant.
    let mut share = last.1 / (last.1 - other.1);
    for _ in 0..MOST {
        let width = (other.0 - last.0).abs();
        let grain = 2.0 * f64::EPSILON * (1.0 + other.0.abs());
        if last.1 == 0.0 {
            return (last, last);
        }
        if width <= 2.0 * grain {
            break;
        }
        let least = grain / width;
        let t = last.0 + share.clamp(least, 1.0 - least) * (other.0 - last.0);
        let next = (t, f(t));
        let before =
            if is_negative(next) == is_negative(last) { last } else { std::mem::replace(&mut other, last) };
        last = next;
        share = interpolate(last, other, before);
    }
    if is_negative(last) == is_negative(a) { (last, other) } else { (other, last) }
}

/// Where the sign changes, as a share of the way from the last point to the one of other sign.
fn interpolate(last: Point, other: Point, before: Point) -> f64 {
    let place = (last.0 - other.0) / (before.0 - other.0);
    let value = (last.1 - other.1) / (before.1 - other.1);
    if value * value < place && (1.0 - value) * (1.0 - value) < 1.0 - place {
        let (f, g, h) = (last.1, other.1, before.1);
        let ahead = (before.0 - last.0) / (other.0 - last.0);
        f / (g - f) * h / (g - h) + ahead * f / (h - f) * g / (h - g)
    } else {
        0.5
    }
}

#[cfg(test)]
mod tests {
    use super::narrow;

    /// Smooth functions take few evaluations, and the bracket ends at the grain.
    #[test]
    fn smooth_sign_changes_are_cheap_and_exact() {
        type Case = (fn(f64) -> f64, f64, f64);
        let cases: [Case; 4] = [
            (|t| t.sin() - 0.3, 0.0, 1.5),
            (|t| (t - 0.7).powi(3), 0.0, 1.5),
            (|t| t.exp() - 1.0, -3.0, 1.0),
            (|t| if t < 0.4 { -1.0 } else { 1e-9 }, 0.0, 1.0),
        ];
        for (f, from, to) in cases {
            let mut count = 0;
            let counted = |t| {
                count += 1;
                f(t)
            };
            let (a, b) = narrow(counted, (from, f(from)), (to, f(to)));
            assert!(f(a.0) <= 0.0 && f(b.0) >= 0.0, "{a:?} {b:?}");
            assert!((b.0 - a.0).abs() <= 1e-15 * (1.0 + a.0.abs()));
            assert!(count < 70, "{count}");
        }
        let mut count = 0;
        narrow(
            |t| {
                count += 1;
                t.sin() - 0.3
            },
            (0.0, -0.3),
            (1.5, 1.5f64.sin() - 0.3),
        );
        assert!(count <= 10, "{count}");
    }
}
