//! Ways through free space: from here to there, and how often they wind.

use crate::slabs::NONE;
use crate::space::ConfigurationSpace;
use std::collections::VecDeque;

/// A way from one configuration to another through free space.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Configurations along it, counted on from the start: the start, one in each opening passed, the end.
    pub points: Vec<[f64; 2]>,
    /// Periods of the domain between the end of the way and the end asked for. Others are possible: these plus any
    /// winding of the component.
    pub winding: [i64; 2],
}

impl ConfigurationSpace {
    /// A way with the fewest cells from `from` to `to`, where the end may be reached in any period. None if one is
    /// blocked or they lie in different components.
    pub fn way(&self, from: [f64; 2], to: [f64; 2]) -> Option<Way> {
        let (beginning, end) = (self.free_place(from)?, self.free_place(to)?);
        let (start, goal) = (beginning.0, end.0);
        if self.cells.of[start] == NONE || self.cells.of[start] != self.cells.of[goal] {
            return None;
        }
        let before = self.nearest_first(start, goal);
        let mut passed = Vec::new();
        let mut cell = goal;
        while cell != start {
            let (link, forward) = before[cell]?;
            passed.push((link, forward));
            let link = &self.links[link as usize];
            cell = (if forward { link.from } else { link.to }) as usize;
        }
        passed.reverse();
        Some(self.unroll(from, beginning, end, &passed))
    }

    /// Can the configuration `to`, in just that turn, be reached from `from`?
    pub fn reaches(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        let (Some(way), Some(component)) = (self.way(from, to), self.component_of(from)) else {
            return false;
        };
        let windings = &self.cells.windings[component as usize];
        let mut with = windings.clone();
        with.add(way.winding);
        with == *windings
    }

    /// Breadth first: the link by which each cell is reached.
    fn nearest_first(&self, start: usize, goal: usize) -> Vec<Option<(u32, bool)>> {
        let mut before = vec![None; self.slabs.free.len()];
        let mut pending = VecDeque::from([start]);
        let mut reached = vec![false; self.slabs.free.len()];
        reached[start] = true;
        while let Some(cell) = pending.pop_front() {
            if cell == goal {
                break;
            }
            for &(i, forward) in &self.cells.from[cell] {
                let link = &self.links[i as usize];
                let next = (if forward { link.to } else { link.from }) as usize;
                if !reached[next] {
                    reached[next] = true;
                    before[next] = Some((i, forward));
                    pending.push_back(next);
                }
            }
        }
        before
    }

    /// Counts on along the openings passed.
    fn unroll(
        &self,
        from: [f64; 2],
        (start, a, periods): (usize, [f64; 2], [i64; 2]),
        (goal, b, beyond): (usize, [f64; 2], [i64; 2]),
        passed: &[(u32, bool)],
    ) -> Way {
        let (axes, m) = (&self.atlas.frame.axes, &self.atlas.frame.moving);
        // Offset of a cell's own count from the way's, in periods.
        let own = |cell: usize, at: [f64; 2]| {
            let low = if self.goes_round(cell) { f64::NEG_INFINITY } else { self.extent(cell, at[0]).0 };
            i64::from(at[1] < low)
        };
        let mut offset = [periods[0], periods[1] - own(start, a)];
        let mut points = vec![from];
        for &(i, forward) in passed {
            let link = &self.links[i as usize];
            let s = self.slab_of(link.from as usize);
            let sense = if forward { 1 } else { -1 };
            let next = [offset[0] + sense * link.step[0], offset[1] + sense * link.step[1]];
            let base = if forward { offset } else { next };
            let at = [self.slabs.u[s + 1], 0.5 * (link.opening.0 + link.opening.1)];
            points.push([0, 1].map(|k| (at[k] + base[k] as f64 * axes[k].length) / m[k].ratio));
            offset = next;
        }
        let end = [offset[0], offset[1] + own(goal, b)];
        points.push([0, 1].map(|k| (b[k] + end[k] as f64 * axes[k].length) / m[k].ratio));
        Way { points, winding: [end[0] - beyond[0], end[1] - beyond[1]] }
    }
}
