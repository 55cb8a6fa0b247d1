//! Boundary cycles: the half-edges of free space, each followed by the next with free space on the left.
//!
//! A cell has a bottom and a top (pieces, or the domain's limits) and two sides, which are wall where no opening leads to
//! a neighbour. Along a bottom to the right, up the right side to the first opening, through it and down the left side of
//! the cell beyond, and so on: every step has one successor, so every bottom and top lies on exactly one cycle.

use crate::links::OPENING;
use crate::slabs::NONE;
use crate::space::ConfigurationSpace;

/// A directed stretch of the boundary of free space, which lies on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfEdge {
    /// The curve; none along a limit of the domain.
    pub curve: Option<u32>,
    /// Configurations (joint coordinates) at both ends, counted on along the cycle.
    pub from: [f64; 2],
    pub to: [f64; 2],
}

/// A closed chain of half-edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    pub edges: Vec<HalfEdge>,
    /// Periods of the domain gone along both coordinates; (0, 0) for a cycle that closes in the plane.
    pub winding: [i64; 2],
}

/// Lengths of wall below this are the same point.
const POINT: f64 = 0.25 * OPENING;

/// A walker on the boundary: where it is (scaled positions, counted on) and what it left behind.
struct Walker<'s> {
    space: &'s ConfigurationSpace,
    at: [f64; 2],
    edges: Vec<(Option<u32>, [f64; 2], [f64; 2])>,
    start: [f64; 2],
}

/// What comes next: up the right side or down the left side of a cell, from v in the cell's own count.
#[derive(Clone, Copy)]
enum Turn {
    Up(usize, f64),
    Down(usize, f64),
    /// A bottom or a top was passed: the walk can be closed here.
    Bottom(usize),
    Top(usize),
}

impl Walker<'_> {
    fn go(&mut self, curve: Option<u32>, step: [f64; 2]) {
        let to = [self.at[0] + step[0], self.at[1] + step[1]];
        match self.edges.last_mut() {
            Some(last) if last.0 == curve && curve.is_some() => last.2 = to,
            _ => self.edges.push((curve, self.at, to)),
        }
        self.at = to;
    }

    fn wall(&mut self, cell: usize, right: bool, from: f64, to: f64) {
        if (to - from).abs() > POINT {
            let s = self.space.slab_of(cell);
            let u = self.space.slabs.u[s + usize::from(right)];
            let curve = self.space.upright_at(u, 0.5 * (from + to));
            self.go(curve, [0.0, to - from]);
        }
    }

    fn bottom(&mut self, cell: usize) -> f64 {
        let ((a, b), between) = self.space.sides_of(cell);
        let (low, next) = (self.space.extent(cell, a).0, self.space.extent(cell, b).0);
        self.go((between.lower != NONE).then_some(between.lower), [b - a, next - low]);
        next
    }

    fn top(&mut self, cell: usize) -> f64 {
        let ((a, b), between) = self.space.sides_of(cell);
        let (high, next) = (self.space.extent(cell, b).1, self.space.extent(cell, a).1);
        self.go((between.upper != NONE).then_some(between.upper), [a - b, next - high]);
        next
    }

    fn step(&mut self, turn: Turn) -> Turn {
        match turn {
            Turn::Bottom(cell) => {
                let v = self.bottom(cell);
                Turn::Up(cell, v)
            }
            Turn::Top(cell) => {
                let v = self.top(cell);
                Turn::Down(cell, v)
            }
            Turn::Up(cell, v) => self.up(cell, v),
            Turn::Down(cell, v) => self.down(cell, v),
        }
    }

    fn up(&mut self, cell: usize, v: f64) -> Turn {
        let space = self.space;
        let period = space.atlas.frame.axes[1].length;
        let rounds = if space.goes_round(cell) { 2 } else { 1 };
        let openings = space.openings(cell, true);
        let next = (0..rounds)
            .flat_map(|k| openings.iter().map(move |o| (o.0 + f64::from(k) * period, o.2, o.0 - o.3)))
            .filter(|o| o.0 >= v - POINT)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match next {
            Some((low, to, there)) => {
                self.wall(cell, true, v, low);
                Turn::Down(to, there)
            }
            None => {
                let ((_, b), _) = space.sides_of(cell);
                self.wall(cell, true, v, space.extent(cell, b).1);
                Turn::Top(cell)
            }
        }
    }

    fn down(&mut self, cell: usize, v: f64) -> Turn {
        let space = self.space;
        let period = space.atlas.frame.axes[1].length;
        let rounds = if space.goes_round(cell) { 2 } else { 1 };
        let openings = space.openings(cell, false);
        let next = (0..rounds)
            .flat_map(|k| openings.iter().map(move |o| (o.1 - f64::from(k) * period, o.2, o.1 - o.3)))
            .filter(|o| o.0 <= v + POINT)
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match next {
            Some((high, to, there)) => {
                self.wall(cell, false, v, high);
                Turn::Up(to, there)
            }
            None => {
                let ((a, _), _) = space.sides_of(cell);
                self.wall(cell, false, v, space.extent(cell, a).0);
                Turn::Bottom(cell)
            }
        }
    }
}

impl ConfigurationSpace {
    pub(crate) fn slab_of(&self, cell: usize) -> usize {
        self.slabs.slab[cell] as usize
    }

    pub(crate) fn sides_of(&self, cell: usize) -> ((f64, f64), crate::slabs::Between) {
        let s = self.slab_of(cell);
        let between = self.slabs.between(s, cell - self.slabs.cells(s).0);
        ((self.slabs.u[s], self.slabs.u[s + 1]), between)
    }

    /// Lower and upper v of a cell at u.
    pub(crate) fn extent(&self, cell: usize, u: f64) -> (f64, f64) {
        let (_, between) = self.sides_of(cell);
        self.slabs.extent(&self.atlas, between, u)
    }

    pub(crate) fn goes_round(&self, cell: usize) -> bool {
        self.slabs.wraps && self.sides_of(cell).1.lower == NONE
    }

    /// Openings of a cell's side: (low, high) in its own count, the cell beyond, and own count less that cell's.
    pub(crate) fn openings(&self, cell: usize, right: bool) -> Vec<(f64, f64, usize, f64)> {
        let period = self.atlas.frame.axes[1].length;
        let of = |&(i, forward): &(u32, bool)| {
            let link = &self.links[i as usize];
            // to's count = from's count − shift.
            let shift = link.step[1] as f64 * period;
            let (low, high) = link.opening;
            if forward {
                (low, high, link.to as usize, shift)
            } else {
                (low - shift, high - shift, link.from as usize, -shift)
            }
        };
        self.cells.from[cell].iter().filter(|l| l.1 == right).map(of).collect()
    }

    /// The upright curve at u that passes v, if any.
    fn upright_at(&self, u: f64, v: f64) -> Option<u32> {
        let v = self.atlas.frame.axes[1].wrap(v).0;
        let near = 2e-10 * self.atlas.frame.axes[0].length.max(1.0);
        let hit = |p: &crate::pieces::Piece| {
            (p.u[1] - p.u[0]) <= near
                && (p.u[0] - u).abs() <= near
                && v >= p.v[0].min(p.v[1])
                && v <= p.v[0].max(p.v[1])
        };
        self.atlas.pieces.iter().position(hit).map(|i| i as u32)
    }

    /// The boundary cycles of each component.
    pub(crate) fn cycles(&self) -> Vec<Vec<Cycle>> {
        let n = self.slabs.free.len();
        let mut seen = [vec![false; n], vec![false; n]];
        let mut found: Vec<Vec<Cycle>> = vec![vec![]; self.cells.windings.len()];
        for cell in (0..n).filter(|&c| self.slabs.free[c]) {
            let component = self.cells.of[cell] as usize;
            if self.goes_round(cell) {
                found[component].extend(self.round_walls(cell));
                continue;
            }
            for top in [false, true] {
                if !seen[usize::from(top)][cell] {
                    found[component].push(self.trace(cell, top, &mut seen));
                }
            }
        }
        found
    }

    /// Sides of a cell that goes all round and has no opening there: limits of the domain or upright curves.
    fn round_walls(&self, cell: usize) -> Vec<Cycle> {
        let ((a, b), _) = self.sides_of(cell);
        let axis = &self.atlas.frame.axes[1];
        let side = |(right, u): (bool, f64)| {
            if !self.openings(cell, right).is_empty() {
                return None;
            }
            let sense = if right { 1.0 } else { -1.0 };
            let from = if right { axis.start } else { axis.end() };
            let curve = self.upright_at(u, axis.start + 0.5 * axis.length);
            let edge = self.half_edge(curve, [u, from], [u, from + sense * axis.length]);
            Some(Cycle { edges: vec![edge], winding: [0, sense as i64] })
        };
        [(true, b), (false, a)].into_iter().filter_map(side).collect()
    }

    fn half_edge(&self, curve: Option<u32>, from: [f64; 2], to: [f64; 2]) -> HalfEdge {
        let m = &self.atlas.frame.moving;
        let joint = |at: [f64; 2]| [at[0] / m[0].ratio, at[1] / m[1].ratio];
        HalfEdge { curve, from: joint(from), to: joint(to) }
    }

    fn trace(&self, cell: usize, top: bool, seen: &mut [Vec<bool>; 2]) -> Cycle {
        let ((a, b), _) = self.sides_of(cell);
        let start = if top { [b, self.extent(cell, b).1] } else { [a, self.extent(cell, a).0] };
        let mut walker = Walker { space: self, at: start, edges: vec![], start };
        let mut turn = if top { Turn::Top(cell) } else { Turn::Bottom(cell) };
        // Each bottom and top once, and at most all openings between.
        for _ in 0..4 * (self.slabs.free.len() + self.links.len() + 4) {
            let mark = match turn {
                Turn::Bottom(c) => Some((0, c)),
                Turn::Top(c) => Some((1, c)),
                _ => None,
            };
            if let Some((k, c)) = mark {
                if seen[k][c] {
                    break;
                }
                seen[k][c] = true;
            }
            turn = walker.step(turn);
        }
        walker.finish()
    }
}

impl Walker<'_> {
    fn finish(mut self) -> Cycle {
        let n = self.edges.len();
        if n > 1 && self.edges[0].0.is_some() && self.edges[0].0 == self.edges[n - 1].0 {
            let last = self.edges.pop().map_or(self.start, |e| e.1);
            let first = self.edges[0].1;
            let back = [self.at[0] - first[0], self.at[1] - first[1]];
            self.edges[0].1 = [last[0] - back[0], last[1] - back[1]];
        }
        let axes = &self.space.atlas.frame.axes;
        let winding = [0, 1].map(|k| ((self.at[k] - self.start[k]) / axes[k].length).round() as i64);
        let edges = self.edges.iter().map(|e| self.space.half_edge(e.0, e.1, e.2)).collect();
        Cycle { edges, winding }
    }
}
