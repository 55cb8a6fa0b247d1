//! Along one contact in steps that cannot pass a zero of its gap.
//!
//! A look gives a time before which the gap has no zero (`clearance`), nor can the features have travelled the
//! distance between them. Near a zero the looks converge; far away they are as far apart as the bounds allow.

use crate::clearance::Gap;
use crate::pace::{GapPace, Pace};
use crate::root::narrow;
use crate::search::{BAND, CLOSED, INEXACT, MOST_STEPS};
use crate::sight::Sight;
use crate::world::{Touch, World};
use mainspring_mechanism::{Approach, Candidate, Feature, Relative, approach, gap_between};

/// Decides whether a contact that comes to zero is one: on its features, and standing for its place.
pub type Real<'r> = &'r mut dyn FnMut(&mut World, &Touch, &[f64], &[f64]) -> bool;

/// The march along one contact of an interaction, from look to look.
pub struct March<'a> {
    pub candidate: Candidate,
    features: (&'a Feature, &'a Feature),
    pace: Pace,
    /// Bounds for the gap: of the whole stretch against an edge, of the next step between centres.
    bounds: Option<GapPace>,
    /// Set for a contact that was closed to rounding at the start: gaps count from here, and it closes only after it
    /// was seen open.
    floor: Option<f64>,
    waiting: bool,
    /// The contact does not close before this time.
    pub clear: f64,
    looks: usize,
    /// The last look at which the gap was open, and the gap there.
    open: Option<(f64, f64)>,
}

impl<'a> March<'a> {
    /// From time `t`, with bounds of motion until the end of the stretch.
    pub fn new(
        features: (&'a Feature, &'a Feature),
        candidate: &Candidate,
        pace: Pace,
        floor: Option<f64>,
        t: f64,
    ) -> Self {
        Self {
            candidate: *candidate,
            features,
            pace,
            bounds: None,
            floor,
            waiting: floor.is_some(),
            clear: t,
            looks: 0,
            open: None,
        }
    }

    /// Looks at the contact at the time in sight and moves `clear` on. Returns the time at which the contact closes,
    /// if that is found.
    pub fn look(
        &mut self,
        world: &mut World<'a>,
        sight: &mut Sight<'_, '_, 'a>,
        relative: &Relative,
        end: f64,
        real: Real,
    ) -> Option<f64> {
        let t = sight.t;
        self.looks += 1;
        if self.looks > MOST_STEPS {
            // Bound met: hand the place to the resolver rather than step over it.
            return Some(t);
        }
        let mut seen = self.approach(world, relative);
        if seen.gap.abs() <= INEXACT * world.system.size && sight.hold(world) {
            seen = self.approach(world, &sight.relative());
        }
        let gap = seen.gap - self.floor.unwrap_or(0.0);
        // Late in a run the clock's own grain moves the gap by more than `CLOSED`.
        let closed = CLOSED * world.system.size + 8.0 * f64::EPSILON * t.abs() * seen.rate.abs();
        self.waiting &= gap.abs() <= closed;
        let touching = gap.abs() <= closed && seen.rate < 0.0 && !self.waiting;
        if touching && self.is_real(world, sight, real) {
            return Some(t);
        }
        if gap < -closed
            && let Some(at) = self.passed(world, sight, gap, real)
        {
            return Some(at);
        }
        self.open = (gap > closed).then_some((t, gap));
        let (a, b) = self.features;
        let radius = a.shape.radius().max(b.shape.radius());
        let step = self.safe_step(&seen, gap, closed, (end - t, radius), world.system.size);
        if gap.abs() <= closed && !touching && (seen.rate < 0.0 || step < 1e-3 * (end - t)) {
            // Closed but not closing: it may open by less than can be told apart and close again.
            let (opens, at) = self.wait_for_gap(world, sight, end);
            self.clear = at;
            sight.move_to(world, t);
            return (!opens && at < end).then_some(at);
        }
        self.clear = t + step.max(2.0 * f64::EPSILON * t.abs());
        None
    }

    /// Along a step of the integrator rates are the slopes of gaps only to its tolerance, and a look can come to lie
    /// just past a zero: the time of the zero, if the contact is real there.
    fn passed(
        &self,
        world: &mut World<'a>,
        sight: &mut Sight<'_, '_, 'a>,
        gap: f64,
        real: Real,
    ) -> Option<f64> {
        let (t, open) = (sight.t, self.open?);
        let zero = narrow(|t| self.gap_at(t, world, sight), open, (t, gap)).1.0;
        sight.move_to(world, zero);
        let closes = self.is_real(world, sight, real);
        sight.move_to(world, t);
        closes.then_some(zero)
    }

    fn approach(&self, world: &mut World, relative: &Relative) -> Approach {
        world.evaluations += 1;
        approach(self.candidate.kind, self.features.0, self.features.1, relative)
    }

    fn is_real(&self, world: &mut World, sight: &Sight, real: Real) -> bool {
        let touch = world.touch(&self.candidate, (&sight.placed.0, &sight.placed.1));
        real(world, &touch, &sight.q, &sight.v)
    }

    /// A step of at most `left` that passes no zero, except out of the band of closed gaps.
    fn safe_step(
        &mut self,
        seen: &Approach,
        gap: f64,
        closed: f64,
        (left, radius): (f64, f64),
        size: f64,
    ) -> f64 {
        let (bounds, left) = self.bounds(seen, left, radius);
        let inside = gap.abs() <= closed;
        let Approach { rate, acceleration, .. } = *seen;
        if inside && rate >= 0.0 {
            return Gap { gap: 0.0, rate, acceleration }.clearance(&bounds, left);
        }
        let side = if gap > 0.0 && !inside { 1.0 } else { -1.0 };
        // Past a zero that is no contact, the step must clear the band of closed gaps.
        let clear = gap.abs() + if inside { 3.0 * closed } else { 0.0 };
        Gap { gap: clear, rate: side * rate, acceleration: side * acceleration }
            .clearance(&bounds, left)
            .max(0.99 * gap.abs() / bounds.speed.max(f64::MIN_POSITIVE))
            .max((seen.apart - 2.0 * BAND * size) / self.pace.total().max(f64::MIN_POSITIVE))
    }

    /// Bounds for the gap, and the time for which they hold; `radius` is that of the round feature against an edge.
    fn bounds(&mut self, seen: &Approach, left: f64, radius: f64) -> (GapPace, f64) {
        let (kind, speed) = (self.candidate.kind, self.pace.total());
        if seen.centers.is_finite() {
            return (self.pace.of_gap(kind, 0.0, 0.5 * seen.centers), left.min(0.5 * seen.centers / speed));
        }
        // At the first look the whole stretch lies ahead.
        let whole = || self.pace.of_gap(kind, seen.apart + radius + speed * left, 0.0);
        (*self.bounds.get_or_insert_with(whole), left)
    }

    /// After a release the gap, its rate and its acceleration are all near zero: goes on to the first sample with
    /// a positive gap. False if the gap closes again first (then at the time told) or never opens before the end.
    fn wait_for_gap(&self, world: &mut World<'a>, sight: &mut Sight<'_, '_, 'a>, end: f64) -> (bool, f64) {
        let (size, start) = (world.system.size, sight.t);
        let open = 8.0 * CLOSED * size;
        // Samples from the end backwards: in the usual case all are open and the first interval is short.
        let mut first_open = None;
        let mut dt = end - start;
        for _ in 0..60 {
            let t = start + dt;
            let gap = self.gap_at(t, world, sight);
            if gap.abs() <= open {
                break;
            }
            // Behind an edge's line but past its end is free as well.
            first_open = (gap > 0.0 || self.margin(world, sight) < -BAND * size).then_some(t);
            dt *= 0.25;
        }
        if let Some(t) = first_open {
            return (true, t);
        }
        let closes = dt < end - start;
        (false, if closes { self.closes_between(world, sight, start, dt) } else { end })
    }

    /// The time at which the gap falls to zero for good after a release at `start`: `dt` later it is closed to
    /// rounding, four times that later negative.
    fn closes_between(
        &self,
        world: &mut World<'a>,
        sight: &mut Sight<'_, '_, 'a>,
        start: f64,
        dt: f64,
    ) -> f64 {
        let (mut above, mut below) = (start + dt, start + 4.0 * dt);
        // The gap may have opened and closed again by less than can be told apart: look for a time when it was open.
        for _ in 0..40 {
            if self.gap_at(above, world, sight) > 0.0 {
                break;
            }
            above = start + 0.5 * (above - start);
        }
        for _ in 0..60 {
            let middle = 0.5 * (above + below);
            if self.gap_at(middle, world, sight) > 0.0 {
                above = middle
            } else {
                below = middle
            }
            if below - above <= 1e-12 * (below - sight.stretch.from) {
                break;
            }
        }
        below
    }

    fn gap_at(&self, t: f64, world: &mut World<'a>, sight: &mut Sight<'_, '_, 'a>) -> f64 {
        sight.move_to(world, t);
        let mut gap = self.gap_in_sight(world, sight);
        if gap.abs() <= INEXACT * world.system.size && sight.hold(world) {
            gap = self.gap_in_sight(world, sight);
        }
        gap - self.floor.unwrap_or(0.0)
    }

    fn gap_in_sight(&self, world: &mut World, sight: &Sight) -> f64 {
        world.evaluations += 1;
        let pose = Relative::pose(&sight.placed.0.pose, &sight.placed.1.pose);
        gap_between(self.candidate.kind, self.features, &pose)
    }

    fn margin(&self, world: &mut World, sight: &Sight) -> f64 {
        let size = world.system.size;
        world.touch(&self.candidate, (&sight.placed.0, &sight.placed.1)).margin(size)
    }
}
