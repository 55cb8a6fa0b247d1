//! How a run ends, what is left of it, and forces asked for afterwards.

use super::simulation::Compliant;
use crate::contact::Contact;
use crate::energy::kinetic;
use crate::recorder::Recorder;
use crate::rest::{AT_REST, free_energy};
use crate::run::{Mode, Run, Status};
use crate::settle::Closed;
use crate::world::World;
use mainspring_mechanism::{ContactLaw, ContactSource, System};

/// Overlaps deeper than this, relative to the machine's size, are no contact any more: the shapes have lost their
/// meaning.
pub(super) const DEEPEST: f64 = 0.01;

impl Compliant<'_> {
    /// Overlaps that are no contact any more: a drive runs against what cannot give way, or the law is too soft.
    pub(super) fn too_deep(&self) -> Option<Status> {
        let deep = self.deepest > DEEPEST * self.world.system.size && !self.group.tips.is_empty();
        deep.then_some(if self.drives_act() { Status::Jammed } else { Status::TooDeep })
    }

    /// Everything rests, or moves with next to no energy left above its equilibrium: of what the solver moves, no more
    /// than its own error.
    pub(super) fn is_at_rest(&mut self) -> bool {
        let (system, top) = (self.world.system, self.record.minima.top);
        if self.drives_act() || free_energy(&self.world, &self.record.paths, self.record.t) > AT_REST * top {
            return false;
        }
        let level = self.options.rtol.powi(2).max(AT_REST) * top;
        let own = &self.group.coordinates;
        let mut moving = vec![0.0; self.q.len()];
        own.iter().for_each(|&i| moving[i] = self.v[i]);
        if kinetic(system, &self.q, &moving) > level {
            return false;
        }
        // Would the accelerations, over the times of the springs, give it no more energy?
        let longest = own.iter().map(|&i| self.natural_times[i]).fold(0.0, f64::max);
        self.place_group();
        let accelerations = self.group.present_accelerations();
        for (&i, a) in self.group.coordinates.iter().zip(accelerations) {
            moving[i] = a * longest;
        }
        kinetic(system, &self.q, &moving) <= level
    }

    /// Scales of position and velocity that tolerances are relative to, by coordinate.
    pub fn scales(&self) -> (&[f64], &[f64]) {
        (&self.scales, &self.speeds)
    }

    /// Steps of the solver tried and not taken.
    pub fn rejected(&self) -> u64 {
        self.stepper.rejected
    }

    /// What is left when the run is over.
    pub fn into_run(mut self) -> Run {
        let status = self.status.unwrap_or_else(|| self.end(Status::Stopped));
        let closed = self.closed();
        let Recorder { t, trajectory, events, modes, energy, minima, .. } = self.record;
        Run {
            contact: Contact::Compliant(self.group.law),
            status,
            t,
            q: self.q,
            v: self.v,
            closed,
            modes,
            trajectory,
            events,
            energy,
            minima: minima.found,
            stats: self.stats,
        }
    }

    pub(super) fn end(&mut self, status: Status) -> Status {
        self.record.finish(self.world.system, (&self.q, &self.v));
        self.place_group();
        self.record.energy.contact_stored = self.group.stored();
        self.stats.gap_evaluations = self.world.evaluations + self.group.evaluations;
        self.status = Some(status);
        status
    }
}

/// Forces of the contacts that overlap in a mode, at a state `(q, v)` within it, in their order.
pub fn compliant_forces_at(
    system: &System,
    source: &dyn ContactSource,
    law: &ContactLaw,
    mode: &Mode,
    (q, v): (&[f64], &[f64]),
) -> Vec<Closed> {
    let mut world = World::new(system, source);
    let placed = world.place_all(q);
    let one = |c: &Closed| {
        let touch = world.touch_among(&c.candidate, q, &placed);
        let (depth, rate) = (-touch.state.gap, -touch.rate(v));
        let force = if c.active { (depth * law.slope(rate)).max(0.0) } else { 0.0 };
        Closed { gap: touch.state.gap, force, active: force > 0.0, ..*c }
    };
    mode.closed.iter().map(one).collect()
}
