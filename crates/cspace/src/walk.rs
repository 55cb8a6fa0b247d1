//! The kinematic walk: one part is pushed, the other stays until it is touched, then yields along the contact curve.
//!
//! Within a cell of the partition the second coordinate is what a play between two walls makes of it: it keeps its value
//! until the lower or the upper curve pushes. At a border the walk goes on in the neighbour whose opening holds it; if none
//! does, it jams.

use crate::error::SpaceError;
use crate::slabs::NONE;
use crate::space::ConfigurationSpace;

/// A stage of a walk: motion with no contact, or along one curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// The curve in contact; none for free motion.
    pub curve: Option<u32>,
    pub from: [f64; 2],
    pub to: [f64; 2],
}

/// How a walk ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The pushed coordinate reached its goal.
    Arrived,
    /// It can go no further.
    Jammed,
    /// It reached the limit of a window.
    Limit,
}

/// A kinematic walk.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    /// Configurations counted on from the start.
    pub stages: Vec<Stage>,
    pub end: End,
}

impl Walk {
    pub fn last(&self) -> [f64; 2] {
        self.stages.last().map_or([f64::NAN; 2], |s| s.to)
    }
}

/// Where a walker is: a cell, and the offset of the cell's own count from the walk's in periods.
struct Walker<'s> {
    space: &'s ConfigurationSpace,
    cell: usize,
    offset: [i64; 2],
    /// Position in the cell's own count.
    at: [f64; 2],
    stages: Vec<Stage>,
}

impl ConfigurationSpace {
    /// Pushes the coordinate `pushed` (0 or 1) of a free configuration from where it is to `goal`; it may be in contact.
    /// None if the start is blocked or outside.
    ///
    /// # Errors
    /// Those of `transposed` (for the second coordinate).
    pub fn walk(&self, from: [f64; 2], pushed: usize, goal: f64) -> Result<Option<Walk>, SpaceError> {
        if pushed == 0 {
            return Ok(self.push(from, goal));
        }
        let turned = |q: [f64; 2]| [q[1], q[0]];
        let walk = self.transposed()?.push(turned(from), goal);
        Ok(walk.map(|w| {
            let stages = w.stages.iter().map(|s| Stage { from: turned(s.from), to: turned(s.to), ..*s });
            Walk { stages: stages.collect(), end: w.end }
        }))
    }

    fn push(&self, from: [f64; 2], goal: f64) -> Option<Walk> {
        let (cell, at, periods) = self.free_place(from)?;
        if !goal.is_finite() {
            return None;
        }
        let below = !self.goes_round(cell) && at[1] < self.extent(cell, at[0]).0;
        let v = at[1] + if below { self.atlas.frame.axes[1].length } else { 0.0 };
        let offset = [periods[0], periods[1] - i64::from(below)];
        let mut walker = Walker { space: self, cell, offset, at: [at[0], v], stages: vec![] };
        let forward = goal >= from[0];
        let goal = goal * self.atlas.frame.moving[0].ratio;
        let turns =
            ((goal - from[0] * self.atlas.frame.moving[0].ratio) / self.atlas.frame.axes[0].length).abs();
        // Each slab at most once in every period passed.
        let most = (self.slabs.count() as f64 * (turns + 2.0)).min(1e8) as usize + 2;
        let mut end = End::Jammed;
        for _ in 0..most {
            if let Some(last) = walker.advance(goal, forward) {
                end = last;
                break;
            }
        }
        Some(Walk { stages: walker.stages, end })
    }
}

impl Walker<'_> {
    fn joint(&self, at: [f64; 2]) -> [f64; 2] {
        let (axes, m) = (&self.space.atlas.frame.axes, &self.space.atlas.frame.moving);
        [0, 1].map(|k| (at[k] + self.offset[k] as f64 * axes[k].length) / m[k].ratio)
    }

    fn go(&mut self, curve: Option<u32>, to: [f64; 2]) {
        let (from, end) = (self.joint(self.at), self.joint(to));
        self.at = to;
        match self.stages.last_mut() {
            Some(last) if last.curve == curve => last.to = end,
            _ if from == end => {}
            _ => self.stages.push(Stage { curve, from, to: end }),
        }
    }

    /// To the border of the cell or the goal, then through an opening.
    fn advance(&mut self, goal: f64, forward: bool) -> Option<End> {
        let space = self.space;
        let ((a, b), _) = space.sides_of(self.cell);
        let border = if forward { b } else { a };
        let goal = goal - self.offset[0] as f64 * space.atlas.frame.axes[0].length;
        let arrives = if forward { goal <= border } else { goal >= border };
        self.follow(if arrives { goal } else { border });
        if arrives {
            return Some(End::Arrived);
        }
        let v = self.at[1];
        let openings = space.openings(self.cell, forward);
        let period = space.atlas.frame.axes[1].length;
        let off = |o: &(f64, f64, usize, f64), v: f64| (o.0 - v).max(v - o.1).max(0.0);
        // A cell that goes all round counts its openings once only.
        let rounds: &[f64] = if space.goes_round(self.cell) { &[0.0, -1.0, 1.0] } else { &[0.0] };
        let best = openings
            .iter()
            .flat_map(|o| rounds.iter().map(move |r| (*o, r * period)))
            .min_by(|x, y| off(&x.0, v + x.1).total_cmp(&off(&y.0, v + y.1)));
        let held = best.filter(|(o, r)| off(o, v + r) <= 1e-8);
        let Some((opening, round)) = held else {
            let axis = &space.atlas.frame.axes[0];
            let limit = !axis.wraps && (border == axis.start || border == axis.end());
            return Some(if limit { End::Limit } else { End::Jammed });
        };
        self.enter(opening.2, forward, v + round - opening.3, round + -opening.3);
        None
    }

    /// Moves into a neighbour: its own count is that of the last cell plus `change`.
    fn enter(&mut self, cell: usize, forward: bool, v: f64, change: f64) {
        let axes = &self.space.atlas.frame.axes;
        let ((a, b), _) = self.space.sides_of(cell);
        let was = self.at[0];
        self.cell = cell;
        self.at = [if forward { a } else { b }, v];
        self.offset[0] += ((was - self.at[0]) / axes[0].length).round() as i64;
        self.offset[1] -= (change / axes[1].length).round() as i64;
    }

    /// Within the cell to u: v stays until a wall pushes.
    fn follow(&mut self, u: f64) {
        let space = self.space;
        let (_, between) = space.sides_of(self.cell);
        if space.goes_round(self.cell) {
            self.go(None, [u, self.at[1]]);
            return;
        }
        let (low, high) = space.extent(self.cell, u);
        let v = self.at[1];
        let pushed = if v < low {
            Some((between.lower, low))
        } else if v > high {
            Some((between.upper, high))
        } else {
            None
        };
        let Some((piece, reached)) = pushed else {
            self.go(None, [u, v]);
            return;
        };
        let touch = self.touch(v, u, pushed.is_some_and(|p| p.1 == low && v < low));
        self.go(None, [touch, v]);
        self.go((piece != NONE).then_some(piece), [u, reached]);
    }

    /// Where between here and u the wall passes v (monotone): bisection.
    fn touch(&self, v: f64, u: f64, lower: bool) -> f64 {
        let wall = |x: f64| {
            let (low, high) = self.space.extent(self.cell, x);
            if lower { low - v } else { v - high }
        };
        let (mut free, mut hit) = (self.at[0], u);
        if wall(free) >= 0.0 {
            return free;
        }
        for _ in 0..60 {
            let x = 0.5 * (free + hit);
            if wall(x) > 0.0 { hit = x } else { free = x }
        }
        free
    }
}
