//! Over which positions a map reaches: a window, a whole turn or one period of it, or as far as a sliding part can touch.

use crate::domain::Axis;
use crate::error::SpaceError;
use crate::moving::{Kind, Moving};
use crate::pairs::Part;
use crate::reduce::Reduced;
use std::f64::consts::TAU;

/// The range of one coordinate in scaled positions.
pub(crate) fn axis(
    k: usize,
    reduced: &Reduced,
    parts: &[Vec<Part>; 2],
    window: Option<(f64, f64)>,
    repeats: u32,
    name: &str,
) -> Result<Axis, SpaceError> {
    let moving = &reduced.moving[k];
    let refuse = |reason| SpaceError::Window { coordinate: name.to_string(), reason };
    let turns = moving.turns();
    if let Some((low, high)) = window {
        let (low, high) = (low * moving.ratio, high * moving.ratio);
        if !(low.is_finite() && high.is_finite() && high - low > 1e-9) {
            return Err(refuse("its end must lie above its start"));
        }
        if turns && high - low > TAU * (1.0 + 1e-12) {
            return Err(refuse("wider than one turn; leave it out for the whole circle"));
        }
        return Ok(Axis { start: low, length: high - low, wraps: false, turns });
    }
    if turns {
        let length = TAU / f64::from(repeats);
        return Ok(Axis { start: -0.5 * length, length, wraps: true, turns });
    }
    let other = &reduced.moving[1 - k];
    if moving.kind == Kind::Still || other.kind == Kind::Slide {
        return Err(refuse("a window is needed: nothing else bounds the translation"));
    }
    let (low, high) = reach(moving, &parts[k], other, &parts[1 - k]);
    Ok(Axis { start: low, length: high - low, wraps: false, turns })
}

/// Positions of a sliding body beyond which it cannot touch the other, and a little more.
fn reach(moving: &Moving, own: &[Part], other: &Moving, others: &[Part]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for p in own {
        let along = moving.direction.dot(other.center - p.disc.0);
        for q in others {
            let reach = q.disc.0.norm() + q.disc.1 + p.disc.1;
            low = low.min(along - reach);
            high = high.max(along + reach);
        }
    }
    if low > high {
        return (-1.0, 1.0);
    }
    let more = 0.03 * (high - low);
    (low - more, high + more)
}
