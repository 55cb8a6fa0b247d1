//! Slices: one coordinate fixed, the free intervals of the other.

use crate::error::SpaceError;
use crate::slabs::NONE;
use crate::space::ConfigurationSpace;

/// A free interval of a slice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Joint coordinates; `high` may lie beyond the domain's end where the interval passes the seam.
    pub low: f64,
    pub high: f64,
    /// Curves that bound it; none at a limit of the domain, or if it goes all round.
    pub curves: [Option<u32>; 2],
    pub component: u32,
}

impl ConfigurationSpace {
    /// Free intervals of the second coordinate with the first at `q`, within one stored period; empty outside a
    /// window. Their ends lie on contact curves to about 1e-12 of the size.
    pub fn slice_first(&self, q: f64) -> Vec<Interval> {
        let (axis, m) = (&self.atlas.frame.axes[0], &self.atlas.frame.moving);
        let u = axis.wrap(q * m[0].ratio).0;
        if !(u >= axis.start && u <= axis.end()) {
            return vec![];
        }
        let (first, count) = self.slabs.cells(self.locator.slab(&self.slabs, u));
        let ratio = m[1].ratio;
        let of = |cell: usize| {
            let (_, between) = self.sides_of(cell);
            let (low, high) = self.extent(cell, u);
            let curve = |p: u32| (p != NONE).then_some(p);
            Interval {
                low: low / ratio,
                high: high / ratio,
                curves: [curve(between.lower), curve(between.upper)],
                component: self.cells.of[cell],
            }
        };
        let free = |c: &usize| self.slabs.free[*c];
        (first..first + count).filter(free).map(of).filter(|i| i.high > i.low).collect()
    }

    /// Free intervals of the first coordinate with the second at `q`; components are numbered as in `transposed`.
    ///
    /// # Errors
    /// Those of `transposed`.
    pub fn slice_second(&self, q: f64) -> Result<Vec<Interval>, SpaceError> {
        Ok(self.transposed()?.slice_first(q))
    }

    /// How far each coordinate can move from a free configuration with the other held: lowest and highest values, for
    /// the first and the second coordinate; infinite if it can turn for ever. None if it is blocked.
    ///
    /// # Errors
    /// Those of `transposed`.
    pub fn play(&self, q: [f64; 2]) -> Result<Option<[(f64, f64); 2]>, SpaceError> {
        let across = self.transposed()?;
        let first = across.around([q[1], q[0]]);
        let second = self.around(q);
        Ok(first.zip(second).map(|(a, b)| [a, b]))
    }

    /// Range of the second coordinate around a free configuration.
    fn around(&self, q: [f64; 2]) -> Option<(f64, f64)> {
        let (at, periods) = self.scaled(q);
        let cell = self.cell_at(at)?;
        if !self.slabs.free[cell] {
            return None;
        }
        if self.goes_round(cell) {
            return Some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let (axis, ratio) = (&self.atlas.frame.axes[1], self.atlas.frame.moving[1].ratio);
        let (low, high) = self.extent(cell, at[0]);
        let below = if at[1] < low { 1.0 } else { 0.0 };
        let shift = (periods[1] as f64 - below) * axis.length;
        Some(((low + shift) / ratio, (high + shift) / ratio))
    }
}
