//! Passages of one coordinate: points of comparison for machines whose kinetic energy has no minima to go by.

use mainspring_dynamics::Path;
use std::f64::consts::TAU;

/// Times within a stretch at which a turning coordinate completes whole turns from `origin`, in order; at most
/// `most` of them.
pub fn whole_turns(path: &Path, origin: f64, from: f64, to: f64, most: usize) -> Vec<f64> {
    let turns = |t: f64| (path.at(t).q - origin) / TAU;
    let (start, end) = (turns(from), turns(to));
    let step = if end > start { 1.0 } else { -1.0 };
    let first = if step > 0.0 { start.floor() + 1.0 } else { start.ceil() - 1.0 };
    let count = (((end - first) * step).floor() + 1.0).clamp(0.0, most as f64) as usize;
    let mut after = from;
    (0..count)
        .map(|k| {
            after = crossing(&turns, first + step * k as f64, step, after, to);
            after
        })
        .collect()
}

/// The time in [from, to] at which `turns` reaches `level`, by bisection.
fn crossing(turns: &impl Fn(f64) -> f64, level: f64, step: f64, from: f64, to: f64) -> f64 {
    let (mut a, mut b) = (from, to);
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        if (turns(middle) - level) * step < 0.0 {
            a = middle
        } else {
            b = middle
        }
        if b - a <= 4.0 * f64::EPSILON * (1.0 + b.abs()) {
            break;
        }
    }
    b
}
