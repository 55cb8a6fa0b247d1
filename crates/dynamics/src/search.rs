//! The first contact along a motion, by steps that cannot pass one.
//!
//! With gap g, rate ġ and |g̈| ≤ B over the stretch, no zero lies before the positive root Δ of
//! `g + ġ Δ − B Δ²/2 = 0`. Near a zero the steps converge like Newton's; far away they are as long as the bound
//! allows. Contacts whose features stay apart by their lever arms alone are not evaluated at all.

use crate::flight::{Bounds, State};
use crate::path::Path;
use crate::world::{Touch, World};
use mainspring_mechanism::{Candidate, ContactId, GapKind};

/// A gap this small, relative to the machine's size, is closed.
pub const CLOSED: f64 = 1e-13;
/// Contacts this near, relative to the machine's size, are resolved together.
pub const TOGETHER: f64 = 1e-10;
/// Contact points this near to the end of a feature, relative to the machine's size, count as at the end.
pub const BAND: f64 = 1e-9;
/// Most evaluations along one contact and stretch.
const MOST_STEPS: usize = 2000;

/// A contact found to close.
#[derive(Clone, Copy, Debug)]
pub struct Closing {
    pub t: f64,
    pub candidate: Candidate,
}

/// What the search treats apart: contacts that are closed, and contacts that were closed to rounding when the
/// stretch began. The latter are looked for only after a positive sample, and their gaps count from the gap at
/// their release (never positive), which integration leaves a little below zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Watch {
    Closed,
    Released { floor: f64 },
}

impl Watch {
    fn floor(self) -> Option<f64> {
        match self {
            Watch::Closed => None,
            Watch::Released { floor } => Some(floor),
        }
    }
}

/// The motion over a stretch: one path a coordinate.
pub struct Stretch<'p> {
    pub paths: &'p [Path],
    pub from: f64,
    pub to: f64,
}

impl Stretch<'_> {
    /// Fills positions and velocities at time `t`.
    pub fn state(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        for (i, path) in self.paths.iter().enumerate() {
            let State { q: qi, v: vi } = path.at(t);
            (q[i], v[i]) = (qi, vi);
        }
    }
}

/// Rates of motion of the two sides of an interaction over a stretch.
#[derive(Clone, Copy, Debug, Default)]
struct Pace {
    /// Greatest speed of any feature, first and second body.
    speed: [f64; 2],
    acceleration: [f64; 2],
    turning: [f64; 2],
    turning_acceleration: [f64; 2],
}

impl Pace {
    fn new(world: &World, interaction: usize, stretch: &Stretch, t: f64, until: f64) -> Self {
        let mut pace = Self::default();
        for arm in &world.arms[interaction] {
            let path = &stretch.paths[arm.coordinate];
            let Bounds { speed, acceleration } = path.bounds(path.at(t), until - t);
            let side = usize::from(arm.second);
            pace.speed[side] += arm.length * speed;
            pace.acceleration[side] += arm.length * acceleration;
            pace.turning[side] += arm.turn * speed;
            pace.turning_acceleration[side] += arm.turn * acceleration;
        }
        pace
    }

    fn total(&self) -> f64 {
        self.speed[0] + self.speed[1]
    }

    /// A bound of |ġ|, as for `curvature`.
    fn lipschitz(&self, away: f64) -> f64 {
        (self.total() + (self.turning[0] + self.turning[1]) * away).max(f64::MIN_POSITIVE)
    }

    /// A bound of |g̈| for a contact whose round feature stays within `away` of the other feature.
    fn curvature(&self, kind: GapKind, away: f64, touch: &Touch) -> f64 {
        let edge = match kind {
            GapKind::RoundEdge { swapped } => Some(usize::from(!swapped)),
            _ => None,
        };
        let Some(edge) = edge else {
            let own = |i: usize| self.acceleration[i] + self.turning[i] * self.speed[i];
            let centers = touch.state.distance_of_centers();
            return own(0) + own(1) + self.total() * self.total() / (0.5 * centers).max(f64::MIN_POSITIVE);
        };
        // The edge's line is carried past its ends: its lever grows by `away`.
        let speed = |i: usize| self.speed[i] + if i == edge { self.turning[i] * away } else { 0.0 };
        let own = |i: usize| {
            let extra = if i == edge { self.turning_acceleration[i] * away } else { 0.0 };
            self.acceleration[i] + extra + self.turning[i] * speed(i)
        };
        own(0) + own(1) + 2.0 * self.turning[edge] * (speed(0) + speed(1))
    }
}

/// What a search found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// The first contact to close.
    pub closing: Option<Closing>,
    /// Nothing else closes before this time: the end of the stretch, or where the bound on work was met.
    pub clear_until: f64,
}

/// The first contact to close over the stretch, by time and then by identity.
pub fn first_closing(
    world: &mut World,
    stretch: &Stretch,
    watched: &[(ContactId, Watch)],
    real: &mut dyn FnMut(&mut World, &Touch, &[f64], &[f64]) -> bool,
) -> Found {
    let mut found = Found { closing: None, clear_until: stretch.to };
    let n = stretch.paths.len();
    let (mut q, mut v) = (vec![0.0; n], vec![0.0; n]);
    for interaction in 0..world.arms.len() {
        if world.arms[interaction].iter().all(|arm| stretch.paths[arm.coordinate].is_rest()) {
            continue;
        }
        let mut t = stretch.from;
        for _ in 0..MOST_STEPS {
            let until = found.clear_until;
            if t >= until {
                break;
            }
            for arm in &world.arms[interaction] {
                q[arm.coordinate] = stretch.paths[arm.coordinate].at(t).q;
            }
            let (travelled, room) = world.refresh(interaction, &q, 0.0);
            let (end, pace) = horizon(world, interaction, stretch, (travelled, room), t, until);
            let reach = travelled + pace.total() * (end - t);
            for k in 0..world.listed(interaction).len() {
                let candidate = world.listed(interaction)[k];
                if candidate.distance > reach || is_closed(watched, &candidate) {
                    continue;
                }
                let floor = watched.iter().find_map(|w| w.1.floor().filter(|_| w.0 == candidate.id));
                let end = end.min(found.clear_until);
                let mut march = March { stretch, t, end, pace, reach, floor: floor.unwrap_or(0.0) };
                if let Some(t) = march.run(world, &candidate, floor.is_some(), real, (&mut q, &mut v)) {
                    found = Found { closing: Some(Closing { t, candidate }), clear_until: t };
                }
            }
            t = end;
        }
        if t < found.clear_until {
            found = Found { closing: None, clear_until: t };
        }
    }
    found
}

fn is_closed(watched: &[(ContactId, Watch)], candidate: &Candidate) -> bool {
    watched.contains(&(candidate.id, Watch::Closed))
}

/// How far to look with this list, and the rates of motion until then: no unlisted contact can close before, and the
/// listed ones that can are few.
fn horizon(
    world: &World,
    interaction: usize,
    stretch: &Stretch,
    (travelled, room): (f64, f64),
    t: f64,
    until: f64,
) -> (f64, Pace) {
    let pace = Pace::new(world, interaction, stretch, t, until);
    let nearest = world.listed(interaction).iter().map(|c| c.distance).fold(f64::INFINITY, f64::min);
    let allowed = room.min((nearest - travelled).max(0.0) + 0.04 * world.system.size);
    if pace.total() * (until - t) <= allowed {
        return (until, pace);
    }
    // Bounds of speed shrink with the stretch: lengthen it from the safe side.
    let mut best = (t + allowed / pace.total(), pace);
    for _ in 0..6 {
        let pace = Pace::new(world, interaction, stretch, t, best.0);
        let longer = until.min(t + 0.5 * (best.0 - t + allowed / pace.total()));
        let there = Pace::new(world, interaction, stretch, t, longer);
        if there.total() * (longer - t) > allowed || longer <= 1.1 * (best.0 - t) + t {
            best.1 = pace;
            break;
        }
        best = (longer, there);
    }
    (best.0.max(t + 1e-15 * (1.0 + t.abs())), best.1)
}

struct March<'s, 'p> {
    stretch: &'s Stretch<'p>,
    t: f64,
    end: f64,
    pace: Pace,
    /// Bound of how far features move relative to the list.
    reach: f64,
    /// Gaps count from here.
    floor: f64,
}

type Real<'r> = &'r mut dyn FnMut(&mut World, &Touch, &[f64], &[f64]) -> bool;

impl March<'_, '_> {
    fn touch<'a>(
        &self,
        world: &mut World<'a>,
        c: &Candidate,
        at: (&mut [f64], &mut [f64]),
    ) -> (Touch<'a>, f64) {
        // Only the coordinates that move these two bodies matter.
        for arm in &world.arms[c.id.interaction as usize] {
            let State { q, v } = self.stretch.paths[arm.coordinate].at(self.t);
            (at.0[arm.coordinate], at.1[arm.coordinate]) = (q, v);
        }
        let touch = world.touch(c, at.0);
        (touch, touch.rate(at.1))
    }

    fn gap(&self, touch: &Touch) -> f64 {
        touch.state.gap - self.floor
    }

    /// The time at which the contact closes, if it does before the end.
    fn run(
        &mut self,
        world: &mut World,
        c: &Candidate,
        released: bool,
        real: Real,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Option<f64> {
        let size = world.system.size;
        let away = c.distance.max(0.0) + self.reach + 2.0 * self.radius(world, c);
        if released && !self.wait_for_gap(world, c, (&mut *q, &mut *v)) {
            return (self.t < self.end).then_some(self.t);
        }
        for _ in 0..MOST_STEPS {
            if self.t >= self.end {
                return None;
            }
            let (touch, rate) = self.touch(world, c, (&mut *q, &mut *v));
            let gap = self.gap(&touch);
            // Late in a run the clock's own grain moves the gap by more than `CLOSED`.
            let closed = CLOSED * size + 8.0 * f64::EPSILON * self.t.abs() * rate.abs();
            let touching = gap.abs() <= closed && rate < 0.0;
            if touching && real(world, &touch, q, v) {
                return Some(self.t);
            }
            if gap.abs() <= closed && !touching {
                // Closed but not closing: it may open by less than can be told apart and close again.
                if !self.wait_for_gap(world, c, (&mut *q, &mut *v)) {
                    return (self.t < self.end).then_some(self.t);
                }
                continue;
            }
            let bound = self.pace.curvature(c.kind, away, &touch);
            let side = if gap > 0.0 && !touching { 1.0 } else { -1.0 };
            // Past a zero that is no contact, the step must clear the band of closed gaps.
            let clear = gap.abs().max(0.0) + if gap.abs() <= closed { 3.0 * closed } else { 0.0 };
            let centers = touch.state.distance_of_centers();
            let limit = if centers.is_finite() { 0.5 * centers / self.pace.total() } else { f64::INFINITY };
            let step = safe_step(clear, side * rate, bound)
                .min(limit)
                .max(0.99 * gap.abs() / self.pace.lipschitz(away));
            self.t += step.max(2.0 * f64::EPSILON * self.t.abs());
        }
        // Bound met: hand the place to the resolver rather than step over it.
        Some(self.t.min(self.end))
    }

    /// The time at which the gap falls to zero for good, after a release at the first of the times `above`, between
    /// the second, at which it is closed to rounding, and one at which it is negative.
    fn closes_between(
        &mut self,
        world: &mut World,
        c: &Candidate,
        above: (f64, f64),
        below: f64,
        at: (&mut [f64], &mut [f64]),
    ) -> f64 {
        let (start, mut above) = (above.0, above.1);
        // The gap may have opened and closed again by less than can be told apart: look for a time when it was open.
        for _ in 0..40 {
            self.t = above;
            let (touch, _) = self.touch(world, c, (&mut *at.0, &mut *at.1));
            if self.gap(&touch) > 0.0 {
                break;
            }
            above = start + 0.5 * (above - start);
        }
        let (mut a, mut b) = (above, below);
        for _ in 0..60 {
            self.t = 0.5 * (a + b);
            let (touch, _) = self.touch(world, c, (&mut *at.0, &mut *at.1));
            if self.gap(&touch) > 0.0 {
                a = self.t
            } else {
                b = self.t
            }
            if b - a <= 1e-12 * (b - self.stretch.from) {
                break;
            }
        }
        b
    }

    fn radius(&self, world: &World, c: &Candidate) -> f64 {
        let (a, b) = world.features(c);
        a.radius.min(b.radius)
    }

    /// After a release the gap, its rate and its acceleration are all near zero: goes on to the first sample with
    /// a positive gap. False if the gap closes again first (then `t` says when) or never opens before the end.
    fn wait_for_gap(&mut self, world: &mut World, c: &Candidate, at: (&mut [f64], &mut [f64])) -> bool {
        let (start, open) = (self.t, 8.0 * CLOSED * world.system.size);
        let (q, v) = at;
        // Behind an edge's line but past its end is free as well.
        let size = world.system.size;
        let floor = self.floor;
        let is_free = |touch: &Touch| touch.state.gap > floor || touch.margin(size) <= 0.0;
        let (touch, _) = self.touch(world, c, (&mut *q, &mut *v));
        if self.gap(&touch).abs() > open && is_free(&touch) {
            return true;
        }
        // Samples from the end backwards: in the usual case all are open and the first interval is short.
        let mut first_open = None;
        let mut dt = self.end - start;
        for _ in 0..60 {
            self.t = start + dt;
            let (touch, _) = self.touch(world, c, (&mut *q, &mut *v));
            if self.gap(&touch).abs() <= open {
                break;
            }
            first_open = is_free(&touch).then_some(self.t);
            dt *= 0.25;
        }
        match first_open {
            Some(t) => {
                self.t = t;
                true
            }
            None if dt < self.end - start => {
                self.t = self.closes_between(world, c, (start, start + dt), start + 4.0 * dt, (q, v));
                false
            }
            None => {
                self.t = self.end;
                false
            }
        }
    }
}

/// Positive root of `g + s Δ − B Δ²/2`: no zero of the gap lies before it. `g ≥ 0`; infinite when nothing bends.
fn safe_step(g: f64, s: f64, bound: f64) -> f64 {
    let root = (s * s + 2.0 * bound * g).sqrt();
    if s >= 0.0 { if bound > 0.0 { (s + root) / bound } else { f64::INFINITY } } else { 2.0 * g / (root - s) }
}
