//! The partition: slabs of u between the ends of boundary pieces, in each the pieces in the order of v.
//!
//! No piece ends or crosses another within a slab, so between two neighbours lies one cell, free or blocked throughout.
//! Ends nearer than rounding make one slab border. Every cell's label follows from the sides of its pieces and is checked
//! once per pair of neighbours by the overlap test in its middle; a contradiction is an error, never a wrong map.

use crate::element::{Element, Frame};
use crate::equation::Equation;
use crate::error::SpaceError;
use crate::pieces::{Judge, Piece};
use std::collections::HashMap;

/// Ends nearer than this part of the domain's length are one border.
const BORDER: f64 = 1e-10;
/// Neighbours nearer than this are the same curve twice (scaled position).
const TWIN: f64 = 3e-10;
/// Where in a cell it is tested, in parts of its width and height: at no place that symmetry singles out, for parts that only
/// touch are not told from parts that overlap.
const PROBES: [[f64; 2]; 3] = [[0.4713, 0.4387], [0.2371, 0.7193], [0.7639, 0.2617]];
/// No piece.
pub(crate) const NONE: u32 = u32::MAX;

/// A stack of pieces over [u[s], u[s+1]].
#[derive(Clone, Debug, Default)]
pub(crate) struct Slabs {
    /// Borders, first and last those of the domain.
    pub u: Vec<f64>,
    /// Where each slab's pieces start in `stack`.
    pub start: Vec<u32>,
    /// Pieces from below, slab after slab.
    pub stack: Vec<u32>,
    /// Where each slab's cells start in `free`.
    pub cells: Vec<u32>,
    /// The slab of each cell.
    pub slab: Vec<u32>,
    /// For each cell from below whether it is free. Without wrapping there is one cell more than pieces; with it
    /// as many (the last joins what lies below the first), but one if there is no piece.
    pub free: Vec<bool>,
    pub wraps: bool,
}

/// A cell with its bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Between {
    /// Piece below and above, `NONE` at the domain's limits or if the cell goes all round.
    pub lower: u32,
    pub upper: u32,
}

/// The geometry of pieces.
#[derive(Clone, Debug)]
pub(crate) struct Atlas {
    pub frame: Frame,
    pub pieces: Vec<Piece>,
    pub elements: Vec<Element>,
    pub equations: Vec<Equation>,
}

impl Atlas {
    /// v of a piece at u within its range.
    pub fn v_at(&self, piece: u32, u: f64) -> f64 {
        let p = &self.pieces[piece as usize];
        if u <= p.u[0] {
            return p.v[0];
        }
        if u >= p.u[1] {
            return p.v[1];
        }
        let element = &self.elements[p.element as usize];
        let v = element.v_at(&self.equations[element.pair as usize], &self.frame, u);
        v.clamp(p.v[0].min(p.v[1]), p.v[0].max(p.v[1]))
    }

    pub fn equation(&self, piece: u32) -> &Equation {
        let element = &self.elements[self.pieces[piece as usize].element as usize];
        &self.equations[element.pair as usize]
    }
}

impl Slabs {
    pub fn count(&self) -> usize {
        self.start.len() - 1
    }

    pub fn stack(&self, slab: usize) -> &[u32] {
        &self.stack[self.start[slab] as usize..self.start[slab + 1] as usize]
    }

    /// First cell of a slab and the number of its cells.
    pub fn cells(&self, slab: usize) -> (usize, usize) {
        (self.cells[slab] as usize, (self.cells[slab + 1] - self.cells[slab]) as usize)
    }

    /// Bounds of the k-th cell of a slab.
    pub fn between(&self, slab: usize, k: usize) -> Between {
        let stack = self.stack(slab);
        let n = stack.len();
        if n == 0 {
            return Between { lower: NONE, upper: NONE };
        }
        if self.wraps {
            return Between { lower: stack[k], upper: stack[(k + 1) % n] };
        }
        let at = |i: Option<usize>| i.and_then(|i| stack.get(i)).copied().unwrap_or(NONE);
        Between { lower: at(k.checked_sub(1)), upper: at(Some(k)) }
    }

    /// Lower and upper v of a cell at u; above `lower` by at most a period.
    pub fn extent(&self, atlas: &Atlas, between: Between, u: f64) -> (f64, f64) {
        let axis = &atlas.frame.axes[1];
        let low = if between.lower == NONE { axis.start } else { atlas.v_at(between.lower, u) };
        let high = if between.upper == NONE { axis.end() } else { atlas.v_at(between.upper, u) };
        if self.wraps && between.lower != NONE && self.is_last(atlas, between, u, low, high) {
            return (low, high + axis.length);
        }
        (low, high)
    }

    /// Does the cell pass the seam?
    fn is_last(&self, atlas: &Atlas, between: Between, u: f64, low: f64, high: f64) -> bool {
        if between.lower == between.upper {
            return true;
        }
        // Neighbours may meet at u: their order is told where they are apart.
        if (low - high).abs() > 1e-9 {
            return low > high;
        }
        let (p, q) = (&atlas.pieces[between.lower as usize], &atlas.pieces[between.upper as usize]);
        let (a, b) = (p.u[0].max(q.u[0]), p.u[1].min(q.u[1]));
        let inner = if u - a > b - u { u - 0.5 * (u - a) } else { u + 0.5 * (b - u) };
        atlas.v_at(between.lower, inner) > atlas.v_at(between.upper, inner)
    }
}

/// Borders of slabs from the ends of pieces.
fn borders(atlas: &Atlas) -> Vec<f64> {
    let axis = &atlas.frame.axes[0];
    let mut ends: Vec<f64> = atlas.pieces.iter().flat_map(|p| p.u).collect();
    ends.sort_by(f64::total_cmp);
    let near = BORDER * axis.length.max(1.0);
    let mut u = vec![axis.start];
    for e in ends {
        if e - u[u.len() - 1] > near && axis.end() - e > near {
            u.push(e);
        }
    }
    u.push(axis.end());
    u
}

/// Builds the partition.
pub(crate) fn build(
    atlas: &Atlas,
    judge: &Judge,
    order: impl Fn([f64; 2]) -> [f64; 2],
) -> Result<Slabs, SpaceError> {
    let u = borders(atlas);
    let near = 2.0 * BORDER * atlas.frame.axes[0].length.max(1.0);
    let index = |x: f64| {
        let k = u.partition_point(|&b| b <= x + 1e-300).max(1) - 1;
        if k + 1 < u.len() && u[k + 1] - x <= near && u[k + 1] - x < x - u[k] { k + 1 } else { k }
    };
    let mut starts: Vec<Vec<u32>> = vec![vec![]; u.len()];
    let mut last = vec![0usize; atlas.pieces.len()];
    for (i, p) in atlas.pieces.iter().enumerate() {
        let (a, b) = (index(p.u[0]), index(p.u[1]));
        last[i] = b;
        if a < b {
            starts[a].push(i as u32);
        }
    }
    let mut slabs = Slabs { u, wraps: atlas.frame.axes[1].wraps, ..Slabs::default() };
    slabs.start.push(0);
    slabs.cells.push(0);
    let mut checked: HashMap<(u32, u32), bool> = HashMap::new();
    let mut active: Vec<u32> = Vec::new();
    let mut keyed: Vec<(f64, u32)> = Vec::new();
    for (s, begin) in starts.iter().enumerate().take(slabs.u.len() - 1) {
        active.retain(|&p| last[p as usize] > s);
        active.extend(begin);
        let middle = 0.5 * (slabs.u[s] + slabs.u[s + 1]);
        keyed.clear();
        keyed.extend(active.iter().map(|&p| (atlas.v_at(p, middle), p)));
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        drop_twins(atlas, &mut keyed, (slabs.u[s], slabs.u[s + 1]));
        slabs.stack.extend(keyed.iter().map(|k| k.1));
        slabs.start.push(slabs.stack.len() as u32);
        label(atlas, judge, &mut slabs, s, &mut checked, &order)?;
        slabs.cells.push(slabs.free.len() as u32);
        slabs.slab.resize(slabs.free.len(), s as u32);
    }
    Ok(slabs)
}

/// Of pieces that coincide all along the slab the first is kept.
fn drop_twins(atlas: &Atlas, keyed: &mut Vec<(f64, u32)>, (a, b): (f64, f64)) {
    let quarter = 0.25 * (b - a);
    let same_at = |p: u32, q: u32, u: f64| (atlas.v_at(p, u) - atlas.v_at(q, u)).abs() <= TWIN;
    keyed.dedup_by(|next, kept| {
        let side = |p: u32| atlas.pieces[p as usize].free_above;
        (next.0 - kept.0).abs() <= TWIN
            && side(next.1) == side(kept.1)
            && same_at(next.1, kept.1, a + quarter)
            && same_at(next.1, kept.1, b - quarter)
    });
}

/// Labels the cells of the slab whose stack was just added.
fn label(
    atlas: &Atlas,
    judge: &Judge,
    slabs: &mut Slabs,
    s: usize,
    checked: &mut HashMap<(u32, u32), bool>,
    order: &impl Fn([f64; 2]) -> [f64; 2],
) -> Result<(), SpaceError> {
    let n = slabs.stack(s).len();
    let count = if slabs.wraps { n.max(1) } else { n + 1 };
    let (a, b) = (slabs.u[s], slabs.u[s + 1]);
    let middle = 0.5 * (a + b);
    for k in 0..count {
        let between = slabs.between(s, k);
        let side = |p: u32, above: bool| (p != NONE).then(|| atlas.pieces[p as usize].free_above == above);
        let sides = (side(between.lower, true), side(between.upper, false));
        let (low, high) = slabs.extent(atlas, between, middle);
        let probe = |[x, y]: [f64; 2]| {
            let u = a + x * (b - a);
            let (low, high) = slabs.extent(atlas, between, u);
            [u, low + y * (high - low)]
        };
        let blocked = |at: [f64; 2]| judge.blocked(at[0], at[1]);
        let at = probe(PROBES[0]);
        let thick = (high - low) * judge.levers[1] > 1e-6 * atlas.frame.size;
        let wide = (b - a) * judge.levers[0] > 1e-6 * atlas.frame.size;
        let consistent = match sides {
            (Some(x), Some(y)) => (x == y).then_some(x),
            (Some(x), None) | (None, Some(x)) => Some(x),
            (None, None) => None,
        };
        let key = (between.lower, between.upper);
        let free = match consistent {
            Some(free) if !(thick && wide) || checked.get(&key) == Some(&free) => free,
            None if !(thick && wide) && sides.0.is_some() => false,
            Some(free) => {
                if blocked(at) == free {
                    return Err(SpaceError::Degenerate { at: order(at) });
                }
                checked.insert(key, free);
                free
            }
            None if sides.0.is_some() => return Err(SpaceError::Degenerate { at: order(at) }),
            None => {
                let found = PROBES.map(|p| blocked(probe(p)));
                if found[0] != found[1] || found[0] != found[2] {
                    return Err(SpaceError::Degenerate { at: order(at) });
                }
                !found[0]
            }
        };
        slabs.free.push(free);
    }
    Ok(())
}
