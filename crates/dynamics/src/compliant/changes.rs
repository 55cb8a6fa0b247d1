//! What ends a step before its time: a tip that parts, the clamp that begins or ends, another pair that takes over, dry
//! friction that no longer holds.
//!
//! All are found on the dense output, at the nodes of a Lobatto rule, where the power lost is sampled as well.

use super::group::Group;
use super::stretch::Stretch;
use super::tip::TipState;
use crate::root::narrow;
use mainspring_mechanism::{Overlaps, Successor, is_on};

/// A change at one tip.
#[derive(Clone, Copy, Debug)]
pub enum Change {
    /// The overlap comes to zero.
    Part(usize),
    /// The clamp of the law begins or ends to hold.
    Clamp(usize),
    /// Another pair of features gives the depth.
    Hand(usize, Successor),
    /// The contact point ran off a feature that ends in a convex corner, and no other pair takes over.
    RanOff(usize),
    /// What dry friction has to hold passes its size; the coordinate goes in the direction ±1.
    Gives(usize, f64),
}

/// A change and when: as a fraction of the step, just past it.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub x: f64,
    pub change: Change,
}

/// Nodes of the Lobatto rule of four points on [0, 1] but for the first, and all weights: exact for degree 5.
pub const NODES: [f64; 3] = [0.276_393_202_250_021, 0.723_606_797_749_979, 1.0];
const WEIGHTS: [f64; 4] = [1.0 / 12.0, 5.0 / 12.0, 5.0 / 12.0, 1.0 / 12.0];

/// A contact point has run off once it is this far past the end of its feature, relative to the machine's size: on neither
/// side of the end by rounding.
const PAST_END: f64 = 1e-13;
/// Depths of features that follow each other smoothly agree to this fraction where one is just left.
const EQUAL: f64 = 1e-3;

/// Looks for changes over one step.
pub struct Search<'s, 'a> {
    pub group: &'s mut Group<'a>,
    pub overlaps: &'s Overlaps<'a>,
    pub stretch: &'s Stretch,
    pub pairs: &'s mut Vec<(u32, u32)>,
    /// Where along the step the group is; none before it was moved there.
    pub at: Option<f64>,
}

impl Search<'_, '_> {
    /// The first change, the energy lost at the tips until then (or over the whole step), and the greatest depth seen.
    pub fn run(&mut self) -> (Option<Found>, f64, f64) {
        let mut deepest = 0.0f64;
        let mut losses = [0.0; 4];
        losses[0] = self.loss_at(0.0);
        let mut before = 0.0;
        for (i, &x) in NODES.iter().enumerate() {
            let states = self.states(x);
            deepest = states.iter().map(|s| s.depth).fold(deepest, f64::max);
            losses[i + 1] = self.group.loss(&states);
            if let Some(found) = self.first_change(before, x, &states) {
                let loss = self.loss_until(found.x, losses[0]);
                return (Some(found), loss, deepest);
            }
            before = x;
        }
        let sum: f64 = losses.iter().zip(WEIGHTS).map(|(p, w)| p * w).sum();
        (None, sum * self.stretch.h, deepest)
    }

    /// Energy lost from the start of the step to `x`.
    pub fn loss_until(&mut self, x: f64, at_start: f64) -> f64 {
        let nodes: f64 = NODES.iter().zip(&WEIGHTS[1..]).map(|(node, w)| w * self.loss_at(node * x)).sum();
        (WEIGHTS[0] * at_start + nodes) * x * self.stretch.h
    }

    pub fn loss_at(&mut self, x: f64) -> f64 {
        let states = self.states(x);
        self.group.loss(&states)
    }

    fn go_to(&mut self, x: f64) {
        if self.at != Some(x) {
            self.stretch.move_to(self.group, x);
            self.at = Some(x);
        }
    }

    fn states(&mut self, x: f64) -> Vec<TipState> {
        self.go_to(x);
        (0..self.group.tips.len()).map(|k| self.group.state(k)).collect()
    }

    fn first_change(&mut self, before: f64, x: f64, states: &[TipState]) -> Option<Found> {
        let mut first: Option<Found> = None;
        for (k, state) in states.iter().enumerate() {
            let Some(found) = self.change_of(k, state, (before, x)) else { continue };
            if first.is_none_or(|f| found.x < f.x) {
                first = Some(found);
            }
        }
        if let Some(found) = self.first_to_give((before, x))
            && first.is_none_or(|f| found.x < f.x)
        {
            first = Some(found);
        }
        first
    }

    /// The first coordinate that dry friction cannot hold between two samples.
    fn first_to_give(&mut self, between: (f64, f64)) -> Option<Found> {
        let stuck = self.group.stuck.clone();
        if stuck.is_empty() {
            return None;
        }
        self.go_to(between.1);
        let needed = self.group.holding(&stuck);
        let sizes = &self.group.system.forces.coulomb;
        let over = stuck.iter().zip(needed).filter(|&(&i, force)| force.abs() > sizes[i]);
        let changes: Vec<Change> = over.map(|(&i, force)| Change::Gives(i, -force.signum())).collect();
        let found = changes.into_iter().map(|change| self.found(change, between));
        found.min_by(|a, b| a.x.total_cmp(&b.x))
    }

    /// The first change of tip `k` between two samples, at the second of which its state is given.
    fn change_of(&mut self, k: usize, state: &TipState, between: (f64, f64)) -> Option<Found> {
        let mut found = None;
        let mut earlier = |new: Found| {
            if found.is_none_or(|f: Found| new.x < f.x) {
                found = Some(new);
            }
        };
        if state.depth < 0.0 {
            earlier(self.found(Change::Part(k), between));
        }
        if self.clamp_value(k, state) < 0.0 {
            earlier(self.found(Change::Clamp(k), between));
        }
        if let Some(new) = self.hand_over(k, state, between) {
            earlier(new);
        }
        found
    }

    fn found(&mut self, change: Change, between: (f64, f64)) -> Found {
        Found { x: self.locate(change, between), change }
    }

    /// Whether another pair takes over. Where the contact point leaves its features a pair has to: it is looked for
    /// there, since later it may have parted.
    fn hand_over(&mut self, k: usize, state: &TipState, between: (f64, f64)) -> Option<Found> {
        if self.group.tips[k].stop().is_some() {
            return None;
        }
        if is_on(&state.gap) || self.margin(k, between.0) < 0.0 {
            self.go_to(between.1);
            return self
                .handed(k, state, between)
                .or_else(|| self.followed(k, state, between.1, f64::INFINITY));
        }
        let off = self.locate(Change::RanOff(k), between);
        self.go_to(off);
        let state = self.group.state(k);
        let found = self.handed(k, &state, (between.0, off)).or_else(|| self.followed(k, &state, off, EQUAL));
        let tip = self.group.tips[k];
        let sharp = state.gap.edge_margin < 0.0 && self.overlaps.ends_sharply(&tip.candidate, &state.gap);
        found.or_else(|| sharp.then_some(Found { x: off, change: Change::RanOff(k) }))
    }

    /// Whether another pair has taken over in a state, where the group is.
    fn handed(&mut self, k: usize, state: &TipState, between: (f64, f64)) -> Option<Found> {
        let next = self.successor(k, state)?;
        if !next.less {
            return Some(Found { x: between.1, change: Change::Hand(k, next) });
        }
        let x = self.locate(Change::Hand(k, next), between);
        self.go_to(x);
        let state = self.group.state(k);
        let next = self.successor(k, &state).unwrap_or(next);
        Some(Found { x, change: Change::Hand(k, next) })
    }

    /// The contact point has left its features: what follows along the boundary takes over, if its depth differs by no
    /// more than a fraction `apart`.
    fn followed(&mut self, k: usize, state: &TipState, x: f64, apart: f64) -> Option<Found> {
        if is_on(&state.gap) {
            return None;
        }
        let depth = state.depth;
        let tip = self.group.tips[k];
        let (a, b) = self.group.sides(&tip);
        let poses = (&a.pose, &b.pose);
        let (candidate, state) = self.overlaps.follower(&tip.candidate, &state.gap, poses, self.pairs)?;
        if (state.gap + depth).abs() > apart * depth {
            return None;
        }
        let next = Successor { candidate, state, less: false };
        let change = if state.gap < 0.0 { Change::Hand(k, next) } else { Change::RanOff(k) };
        Some(Found { x, change })
    }

    fn margin(&mut self, k: usize, x: f64) -> f64 {
        self.value(&Change::RanOff(k), x)
    }

    fn clamp_value(&self, k: usize, state: &TipState) -> f64 {
        let slope = self.group.law.slope(state.rate);
        if self.group.tips[k].clamped { -slope } else { slope }
    }

    fn successor(&mut self, k: usize, state: &TipState) -> Option<Successor> {
        let tip = self.group.tips[k];
        let (a, b) = self.group.sides(&tip);
        self.overlaps.successor(&tip.candidate, &state.gap, (&a.pose, &b.pose), self.pairs)
    }

    /// What is positive before a change and negative after it.
    fn value(&mut self, change: &Change, x: f64) -> f64 {
        self.go_to(x);
        match *change {
            Change::Part(k) => self.group.state(k).depth,
            Change::Clamp(k) => {
                let state = self.group.state(k);
                self.clamp_value(k, &state)
            }
            Change::Hand(k, next) if next.less => {
                let tip = self.group.tips[k];
                let other = self.group.gap(&tip, &next.candidate);
                let own = self.group.state(k).gap;
                // Where the other pair is off its features it gives no depth.
                if is_on(&other) { own.gap - other.gap } else { own.gap.abs() }
            }
            Change::Hand(..) => unreachable!("found where the pair runs off"),
            Change::Gives(i, direction) => {
                let needed = self.group.holding(&[i])[0];
                self.group.system.forces.coulomb[i] + direction * needed
            }
            Change::RanOff(k) => {
                let gap = self.group.state(k).gap;
                let size = self.group.system.size;
                gap.edge_margin.min(gap.cone_margin * size) + PAST_END * size
            }
        }
    }

    /// The first `x` found past the change, which happens after `before` and is seen at `seen`.
    fn locate(&mut self, change: Change, (before, seen): (f64, f64)) -> f64 {
        let Stretch { t0, h, .. } = *self.stretch;
        let at = |s: &mut Self, x: f64| (t0 + x * h, s.value(&change, x));
        let mut good = at(self, before);
        // A tip just made begins at no depth: from there it first has to be seen open.
        if good.1 <= 0.0 && !matches!(change, Change::Gives(..)) {
            let Some((x, value)) = self.positive_between(&change, before, seen) else { return before };
            good = (t0 + x * h, value);
        }
        let bad = at(self, seen);
        if bad.1 >= 0.0 {
            return seen;
        }
        let (_, past) = narrow(|t| self.value(&change, (t - t0) / h), good, bad);
        (past.0 - t0) / h
    }

    /// Some place between where the value is positive: halving towards the start.
    fn positive_between(&mut self, change: &Change, before: f64, seen: f64) -> Option<(f64, f64)> {
        let mut dx = seen - before;
        for _ in 0..40 {
            dx *= 0.5;
            let value = self.value(change, before + dx);
            if value > 0.0 {
                return Some((before + dx, value));
            }
        }
        None
    }
}
