//! Along one contact in steps that cannot pass a zero of its gap.
//!
//! With gap g, rate ġ and |g̈| ≤ B over the stretch, no zero lies before the positive root Δ of
//! `g + ġ Δ − B Δ²/2 = 0`. Near a zero the steps converge like Newton's; far away they are as long as the bound allows.

use crate::flight::State;
use crate::pace::Pace;
use crate::search::{CLOSED, MOST_STEPS, Stretch};
use crate::world::{Touch, World};
use mainspring_mechanism::{Candidate, Placed};

/// Decides whether a contact that comes to zero is one: on its features, and standing for its place.
pub type Real<'r> = &'r mut dyn FnMut(&mut World, &Touch, &[f64], &[f64]) -> bool;

/// Positions and velocities at the time looked at; only those that move the two bodies are kept up to date.
pub struct Now<'n> {
    pub q: &'n mut [f64],
    pub v: &'n mut [f64],
}

/// A walk along one contact of an interaction.
pub struct March<'s, 'p, 'a> {
    pub stretch: &'s Stretch<'p>,
    pub t: f64,
    pub end: f64,
    pub pace: Pace,
    /// Bound of how far features move relative to the list of candidates.
    pub reach: f64,
    /// Set for a contact that was closed to rounding at the start: gaps count from here, and it closes only after it
    /// was seen open.
    pub floor: Option<f64>,
    /// The bodies at the start; those that rest stay so.
    pub placed: (Placed<'a>, Placed<'a>),
    pub moving: (bool, bool),
}

impl<'a> March<'_, '_, 'a> {
    fn touch(&self, world: &mut World<'a>, c: &Candidate, now: &mut Now) -> (Touch<'a>, f64) {
        for arm in &world.arms[c.id.interaction as usize] {
            let path = &self.stretch.paths[arm.coordinate];
            if !path.is_rest() {
                let State { q, v } = path.at(self.t);
                (now.q[arm.coordinate], now.v[arm.coordinate]) = (q, v);
            }
        }
        let (a, b) = world.bodies(c);
        let bodies = &world.system.bodies;
        let place =
            |moving, body: usize, still| if moving { Placed::new(&bodies[body], now.q) } else { still };
        let placed = (place(self.moving.0, a, self.placed.0), place(self.moving.1, b, self.placed.1));
        let touch = world.touch_placed(c, placed);
        let rate = touch.rate(now.v);
        (touch, rate)
    }

    fn gap(&self, touch: &Touch) -> f64 {
        touch.state.gap - self.floor.unwrap_or(0.0)
    }

    /// The time at which the contact closes, if it does before the end.
    pub fn run(&mut self, world: &mut World<'a>, c: &Candidate, real: Real, now: &mut Now) -> Option<f64> {
        let size = world.system.size;
        let (a, b) = world.features(c);
        let away = c.distance.max(0.0) + self.reach + 2.0 * a.radius.min(b.radius);
        let mut waiting = self.floor.is_some();
        let mut first = Some(world.touch_placed(c, self.placed));
        for _ in 0..MOST_STEPS {
            if self.t >= self.end {
                return None;
            }
            let (touch, rate) = match first.take() {
                Some(touch) => (touch, touch.rate(now.v)),
                None => self.touch(world, c, now),
            };
            let gap = self.gap(&touch);
            // Late in a run the clock's own grain moves the gap by more than `CLOSED`.
            let closed = CLOSED * size + 8.0 * f64::EPSILON * self.t.abs() * rate.abs();
            waiting &= gap.abs() <= closed;
            let touching = gap.abs() <= closed && rate < 0.0 && !waiting;
            if touching && real(world, &touch, now.q, now.v) {
                return Some(self.t);
            }

            let step = self.safe_step(&touch, gap, rate, closed, away, c);
            if gap.abs() <= closed && !touching && (rate < 0.0 || step < 1e-3 * (self.end - self.t)) {
                // Closed but not closing: it may open by less than can be told apart and close again.
                if !self.wait_for_gap(world, c, now) {
                    return (self.t < self.end).then_some(self.t);
                }
                continue;
            }
            self.t += step.max(2.0 * f64::EPSILON * self.t.abs());
        }
        // Bound met: hand the place to the resolver rather than step over it.
        Some(self.t.min(self.end))
    }

    /// A step that passes no zero, except out of the band of closed gaps.
    fn safe_step(&self, touch: &Touch, gap: f64, rate: f64, closed: f64, away: f64, c: &Candidate) -> f64 {
        let bound = self.pace.curvature(c.kind, away, touch);
        if gap.abs() <= closed && rate >= 0.0 {
            return safe_step(0.0, rate, bound);
        }
        let inside = gap.abs() <= closed;
        let side = if gap > 0.0 && !inside { 1.0 } else { -1.0 };
        // Past a zero that is no contact, the step must clear the band of closed gaps.
        let clear = gap.abs() + if inside { 3.0 * closed } else { 0.0 };
        let centers = touch.state.distance_of_centers();
        let limit = if centers.is_finite() { 0.5 * centers / self.pace.total() } else { f64::INFINITY };
        safe_step(clear, side * rate, bound).min(limit).max(0.99 * gap.abs() / self.pace.lipschitz(away))
    }

    /// After a release the gap, its rate and its acceleration are all near zero: goes on to the first sample with
    /// a positive gap. False if the gap closes again first (then `t` says when) or never opens before the end.
    fn wait_for_gap(&mut self, world: &mut World<'a>, c: &Candidate, now: &mut Now) -> bool {
        let (size, start) = (world.system.size, self.t);
        let open = 8.0 * CLOSED * size;
        // Samples from the end backwards: in the usual case all are open and the first interval is short.
        let mut first_open = None;
        let mut dt = self.end - start;
        for _ in 0..60 {
            self.t = start + dt;
            let (touch, _) = self.touch(world, c, now);
            let gap = self.gap(&touch);
            if gap.abs() <= open {
                break;
            }
            // Behind an edge's line but past its end is free as well.
            first_open = (gap > 0.0 || touch.margin(size) <= 0.0).then_some(self.t);
            dt *= 0.25;
        }
        if let Some(t) = first_open {
            self.t = t;
            return true;
        }
        let closes = dt < self.end - start;
        self.t = if closes { self.closes_between(world, c, (start, dt), now) } else { self.end };
        false
    }

    /// The time at which the gap falls to zero for good after a release at `start`: `dt` later it is closed to
    /// rounding, four times that later negative.
    fn closes_between(
        &mut self,
        world: &mut World<'a>,
        c: &Candidate,
        (start, dt): (f64, f64),
        now: &mut Now,
    ) -> f64 {
        let (mut above, mut below) = (start + dt, start + 4.0 * dt);
        // The gap may have opened and closed again by less than can be told apart: look for a time when it was open.
        for _ in 0..40 {
            if self.is_open_at(above, world, c, now) {
                break;
            }
            above = start + 0.5 * (above - start);
        }
        for _ in 0..60 {
            let middle = 0.5 * (above + below);
            if self.is_open_at(middle, world, c, now) {
                above = middle
            } else {
                below = middle
            }
            if below - above <= 1e-12 * (below - self.stretch.from) {
                break;
            }
        }
        below
    }

    fn is_open_at(&mut self, t: f64, world: &mut World<'a>, c: &Candidate, now: &mut Now) -> bool {
        self.t = t;
        let (touch, _) = self.touch(world, c, now);
        self.gap(&touch) > 0.0
    }
}

/// Positive root of `g + s Δ − B Δ²/2`: no zero of the gap lies before it. `g ≥ 0`; infinite when nothing bends.
fn safe_step(g: f64, s: f64, bound: f64) -> f64 {
    let root = (s * s + 2.0 * bound * g).sqrt();
    if s >= 0.0 { if bound > 0.0 { (s + root) / bound } else { f64::INFINITY } } else { 2.0 * g / (root - s) }
}
