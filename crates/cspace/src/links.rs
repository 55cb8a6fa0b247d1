//! Which cells of neighbouring slabs join, and the components of free space.

use crate::lattice::Lattice;
use crate::slabs::{Atlas, NONE, Slabs};

/// Openings narrower than this join nothing (scaled position).
pub(crate) const OPENING: f64 = 1e-9;

/// A way from a cell to one of the next slab.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    pub from: u32,
    pub to: u32,
    /// Seam of u passed (0 or 1), and periods of v between the two cells' own counts.
    pub step: [i64; 2],
    /// The opening in the count of `from`.
    pub opening: (f64, f64),
}

/// A stretch of a cell's side within the domain: `v + shift·period` is the cell's own count.
#[derive(Clone, Copy)]
struct Side {
    low: f64,
    high: f64,
    cell: u32,
    shift: i64,
}

fn sides(slabs: &Slabs, atlas: &Atlas, s: usize, u: f64, out: &mut Vec<Side>) {
    out.clear();
    let axis = &atlas.frame.axes[1];
    let (first, count) = slabs.cells(s);
    for k in 0..count {
        let cell = (first + k) as u32;
        if !slabs.free[cell as usize] {
            continue;
        }
        let (low, high) = slabs.extent(atlas, slabs.between(s, k), u);
        if high > axis.end() + 1e-12 && slabs.wraps {
            out.push(Side { low, high: axis.end(), cell, shift: 0 });
            out.push(Side { low: axis.start, high: high - axis.length, cell, shift: 1 });
        } else {
            out.push(Side { low, high, cell, shift: 0 });
        }
    }
    out.sort_by(|a, b| a.low.total_cmp(&b.low).then(a.high.total_cmp(&b.high)));
}

/// All links, slab by slab; those of the last slab to the first at the end if u wraps.
pub(crate) fn links(slabs: &Slabs, atlas: &Atlas) -> Vec<Link> {
    let (mut left, mut right, mut found) = (vec![], vec![], vec![]);
    let n = slabs.count();
    let wraps = atlas.frame.axes[0].wraps;
    for s in 0..n {
        let next = if s + 1 < n {
            s + 1
        } else if wraps {
            0
        } else {
            break;
        };
        let around = i64::from(s + 1 == n);
        sides(slabs, atlas, s, slabs.u[s + 1], &mut left);
        sides(slabs, atlas, next, slabs.u[next], &mut right);
        let (mut i, mut j) = (0, 0);
        while i < left.len() && j < right.len() {
            let (a, b) = (left[i], right[j]);
            let (low, high) = (a.low.max(b.low), a.high.min(b.high));
            if high - low > OPENING {
                let shift = a.shift as f64 * atlas.frame.axes[1].length;
                found.push(Link {
                    from: a.cell,
                    to: b.cell,
                    step: [around, a.shift - b.shift],
                    opening: (low + shift, high + shift),
                });
            }
            if a.high <= b.high { i += 1 } else { j += 1 }
        }
    }
    found
}

/// Components as cells see them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    /// Component of each cell, `NONE` if blocked.
    pub of: Vec<u32>,
    /// Each cell's place in its component: periods of u and v.
    pub offset: Vec<[i64; 2]>,
    pub windings: Vec<Lattice>,
    /// Links from each cell: (link, forward).
    pub from: Vec<Vec<(u32, bool)>>,
}

pub(crate) fn parts(slabs: &Slabs, links: &[Link]) -> Parts {
    let n = slabs.free.len();
    let mut parts =
        Parts { of: vec![NONE; n], offset: vec![[0, 0]; n], windings: vec![], from: vec![vec![]; n] };
    for (i, link) in links.iter().enumerate() {
        parts.from[link.from as usize].push((i as u32, true));
        parts.from[link.to as usize].push((i as u32, false));
    }
    for cell in 0..n {
        if slabs.free[cell] && parts.of[cell] == NONE {
            flood(&mut parts, links, cell as u32);
        }
    }
    for s in 0..slabs.count() {
        let (first, _) = slabs.cells(s);
        if slabs.wraps && slabs.stack(s).is_empty() && slabs.free[first] {
            parts.windings[parts.of[first] as usize].add([0, 1]);
        }
    }
    parts
}

/// Collects a component; ways back to a cell already reached give its windings.
fn flood(parts: &mut Parts, links: &[Link], start: u32) {
    let id = parts.windings.len() as u32;
    let mut windings = Lattice::default();
    parts.of[start as usize] = id;
    let mut pending = vec![start];
    while let Some(cell) = pending.pop() {
        for k in 0..parts.from[cell as usize].len() {
            let (link, forward) = parts.from[cell as usize][k];
            let link = &links[link as usize];
            let (to, sense) = if forward { (link.to, 1) } else { (link.from, -1) };
            let at = parts.offset[cell as usize];
            let there = [at[0] + sense * link.step[0], at[1] + sense * link.step[1]];
            if parts.of[to as usize] == NONE {
                parts.of[to as usize] = id;
                parts.offset[to as usize] = there;
                pending.push(to);
            } else {
                let known = parts.offset[to as usize];
                windings.add([there[0] - known[0], there[1] - known[1]]);
            }
        }
    }
    parts.windings.push(windings);
}
