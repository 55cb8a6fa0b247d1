//! How far positions and velocities range over a stretch of time.

use crate::path::Path;

/// Least and greatest position and velocity of each coordinate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ranges {
    pub q: Vec<(f64, f64)>,
    pub v: Vec<(f64, f64)>,
}

/// What an observer of a run sees after each advance.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// Since the ranges were last taken.
    pub ranges: Ranges,
    /// The last stretch: its paths, one a coordinate, and its times.
    pub paths: Vec<Path>,
    pub from: f64,
    pub to: f64,
}

impl Track {
    /// Nothing seen yet, for `n` coordinates.
    pub fn empty(n: usize) -> Self {
        Self { ranges: Ranges::empty(n), paths: vec![], from: 0.0, to: 0.0 }
    }
}

/// Samples of one stretch: extremes inside are seen to about 1 % of the range.
const SAMPLES: u32 = 16;

impl Ranges {
    /// Nothing seen yet, for `n` coordinates.
    pub fn empty(n: usize) -> Self {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        Self { q: vec![none; n], v: vec![none; n] }
    }

    /// Takes in the motion from one time to another.
    pub fn extend(&mut self, paths: &[Path], from: f64, to: f64) {
        for (i, path) in paths.iter().enumerate() {
            let samples = if path.is_rest() { 0 } else { SAMPLES };
            for k in 0..=samples {
                let t = from + (to - from) * f64::from(k) / f64::from(samples.max(1));
                let state = path.at(t);
                include(&mut self.q[i], state.q);
                include(&mut self.v[i], state.v);
            }
        }
    }

    /// The union of two ranges.
    pub fn merge(&mut self, other: &Self) {
        let pairs = self.q.iter_mut().zip(&other.q).chain(self.v.iter_mut().zip(&other.v));
        for (mine, theirs) in pairs {
            *mine = (mine.0.min(theirs.0), mine.1.max(theirs.1));
        }
    }
}

fn include(range: &mut (f64, f64), x: f64) {
    *range = (range.0.min(x), range.1.max(x));
}
