//! The plane of the two coordinates: torus, cylinder, or window.

use std::f64::consts::TAU;

/// One coordinate's range, in scaled joint positions u = ratio · q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Where the range starts: radians or length.
    pub start: f64,
    /// How long it is; the period if it wraps.
    pub length: f64,
    /// Does its end join its start?
    pub wraps: bool,
    /// The joint turns: positions that differ by 2π are the same place.
    pub turns: bool,
}

impl Axis {
    pub fn end(&self) -> f64 {
        self.start + self.length
    }

    /// The position within the range that is the same place modulo whole turns; none if there is none (to
    /// `slack`).
    pub fn place(&self, u: f64, slack: f64) -> Option<f64> {
        let u = if self.turns { self.start + (u - self.start + slack).rem_euclid(TAU) - slack } else { u };
        let inside = u >= self.start - slack && u <= self.end() + slack;
        inside.then(|| u.clamp(self.start, self.end()))
    }

    /// The position within the range modulo the period, and the periods taken off; itself if it does not wrap.
    pub fn wrap(&self, u: f64) -> (f64, i64) {
        if !self.wraps {
            return (u, 0);
        }
        let periods = ((u - self.start) / self.length).floor();
        let inside = u - periods * self.length;
        if inside >= self.end() {
            (self.start, periods as i64 + 1)
        } else {
            (inside.max(self.start), periods as i64)
        }
    }

    /// A root of an equation moved by whole turns to lie nearest to `near`.
    pub fn nearest(&self, u: f64, near: f64) -> f64 {
        if self.turns { u + TAU * ((near - u) / TAU).round() } else { u }
    }
}
