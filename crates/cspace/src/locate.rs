//! Which cell a configuration is in: fast, and exact near curves.
//!
//! A table over u gives the slab; within the slab a binary search over its pieces. Each piece of a slab is bounded by
//! its chord and the greatest deviation from it; only a configuration within that band asks the curve itself.

use crate::slabs::{Atlas, Slabs};
use crate::space::ConfigurationSpace;

/// Fractions of a slab at which a piece's deviation from its chord is sampled. A fold (v² ∝ u) deviates most at 1/4.
const SAMPLES: [f64; 7] = [0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.98];
/// The bound on the deviation, over the greatest sampled.
const SAFETY: f64 = 2.0;
/// How far, in periods, a configuration in contact may lie on the wrong side of its curve by rounding.
const TOUCHES: [f64; 2] = [1e-13, 1e-10];

/// A piece within a slab: `v = at + slope·u ± band`.
#[derive(Clone, Copy, Debug)]
struct Chord {
    at: f64,
    slope: f64,
    band: f64,
    piece: u32,
}

/// The structure for point location.
#[derive(Clone, Debug, Default)]
pub(crate) struct Locator {
    /// For each bucket of u the first slab that reaches into it.
    buckets: Vec<u32>,
    /// Buckets per scaled position.
    density: f64,
    start: f64,
    chords: Vec<Chord>,
}

impl Locator {
    pub fn new(atlas: &Atlas, slabs: &Slabs) -> Self {
        let axis = &atlas.frame.axes[0];
        let count = (2 * slabs.count()).clamp(16, 1 << 20);
        let density = count as f64 / axis.length;
        let mut buckets = Vec::with_capacity(count + 1);
        let mut s = 0;
        for k in 0..=count {
            let u = axis.start + k as f64 / density;
            while s + 1 < slabs.count() && slabs.u[s + 1] <= u {
                s += 1;
            }
            // One back, so that rounding never skips a slab.
            buckets.push((s as u32).saturating_sub(1));
        }
        let chords = (0..slabs.count())
            .flat_map(|s| slabs.stack(s).iter().map(move |&p| (s, p)))
            .map(|(s, p)| chord(atlas, p, slabs.u[s], slabs.u[s + 1]))
            .collect();
        Locator { buckets, density, start: axis.start, chords }
    }

    /// The slab of u.
    #[inline]
    pub fn slab(&self, slabs: &Slabs, u: f64) -> usize {
        let k = ((u - self.start) * self.density).max(0.0) as usize;
        let mut s = self.buckets[k.min(self.buckets.len() - 1)] as usize;
        while s + 1 < slabs.count() && slabs.u[s + 1] <= u {
            s += 1;
        }
        s
    }

    /// The cell of a configuration within the domain: slab, and the number of the cell in it.
    #[inline]
    pub fn cell(&self, atlas: &Atlas, slabs: &Slabs, u: f64, v: f64) -> (usize, usize) {
        let s = self.slab(slabs, u);
        let chords = &self.chords[slabs.start[s] as usize..slabs.start[s + 1] as usize];
        let below = |c: &Chord| {
            let d = v - (c.at + c.slope * u);
            if d.abs() > c.band { d > 0.0 } else { v > atlas.v_at(c.piece, u) }
        };
        let n = chords.len();
        let k = if n <= 8 {
            chords.iter().take_while(|c| below(c)).count()
        } else {
            chords.partition_point(below)
        };
        if !slabs.wraps {
            (s, k)
        } else if n == 0 {
            (s, 0)
        } else {
            (s, if k == 0 { n - 1 } else { k - 1 })
        }
    }
}

fn chord(atlas: &Atlas, piece: u32, a: f64, b: f64) -> Chord {
    let (va, vb) = (atlas.v_at(piece, a), atlas.v_at(piece, b));
    let slope = (vb - va) / (b - a);
    let at = va - slope * a;
    let off = |f: &f64| {
        let u = a + f * (b - a);
        (atlas.v_at(piece, u) - (at + slope * u)).abs()
    };
    let band = SAFETY * SAMPLES.iter().map(off).fold(0.0, f64::max) + 1e-12 * (1.0 + va.abs() + slope.abs());
    Chord { at, slope, band, piece }
}

impl ConfigurationSpace {
    /// Index of the cell of a configuration; none outside a window.
    #[inline]
    pub(crate) fn cell_at(&self, at: [f64; 2]) -> Option<usize> {
        let inside = |k: usize| {
            let a = &self.atlas.frame.axes[k];
            at[k] >= a.start && at[k] <= a.end()
        };
        if !(inside(0) && inside(1)) {
            return None;
        }
        let (s, k) = self.locator.cell(&self.atlas, &self.slabs, at[0], at[1]);
        Some(self.slabs.cells(s).0 + k)
    }

    /// The cell of a free configuration, its scaled position there and the periods taken off. One in contact counts as
    /// free, whichever side of its curve rounding left it on: it is moved off by as much. None if it is blocked or outside.
    pub(crate) fn free_place(&self, q: [f64; 2]) -> Option<(usize, [f64; 2], [i64; 2])> {
        let held = |(at, periods)| self.cell_at(at).filter(|&c| self.slabs.free[c]).map(|c| (c, at, periods));
        let frame = &self.atlas.frame;
        let beside = |k: usize, by: f64| {
            let mut moved = q;
            moved[k] += by * frame.axes[k].length / frame.moving[k].ratio;
            held(self.scaled(moved))
        };
        let moves = TOUCHES.iter().flat_map(|by| [(1, *by), (1, -by), (0, *by), (0, -by)]);
        held(self.scaled(q)).or_else(|| moves.into_iter().find_map(|(k, by)| beside(k, by)))
    }

    /// Is a configuration free? Any turns of a turning coordinate; false outside a window and for NaN. A configuration
    /// in contact (to rounding) may count as either.
    #[inline]
    pub fn is_free(&self, q: [f64; 2]) -> bool {
        let (at, _) = self.scaled(q);
        self.cell_at(at).is_some_and(|c| self.slabs.free[c])
    }

    /// `is_free` for many configurations.
    pub fn are_free(&self, q: &[[f64; 2]]) -> Vec<bool> {
        q.iter().map(|&q| self.is_free(q)).collect()
    }
}
