//! How a run ends, and what is left of it.

use super::Simulation;
use crate::component::Component;
use crate::contact::Contact;
use crate::energy::kinetic;
use crate::recorder::Recorder;
use crate::rest::{AT_REST, free_energy, rest_time};
use crate::run::{Run, Status};

impl Simulation<'_> {
    /// Everything rests, or moves with next to no energy left above its equilibrium.
    pub(super) fn is_at_rest(&mut self) -> bool {
        let level = AT_REST * self.record.minima.top;
        if self.next_knot < f64::INFINITY || self.drives_move() {
            return false;
        }
        if kinetic(self.world.system, &self.q, &self.v) > level
            || free_energy(&self.world, &self.record.paths, self.record.t) > level
        {
            return false;
        }
        let mut components = std::mem::take(&mut self.components);
        let quiet = components.iter().all(|(component, _)| self.is_quiet(component, level));
        if !quiet {
            std::mem::swap(&mut self.components, &mut components);
        }
        quiet
    }

    /// Would the accelerations of a component, over the times of its springs, give it no more energy than `level`?
    fn is_quiet(&mut self, component: &Component, level: f64) -> bool {
        let mut a = vec![0.0; self.q.len()];
        let mut at = component.constraints.state();
        if !component.forces(&mut self.world, self.record.t, (&self.q, &self.v), &mut a, &mut at) {
            return false;
        }
        let times = component.coordinates.iter().map(|&i| self.natural_times[i]);
        let longest = times.fold(0.0, f64::max);
        let gained: Vec<f64> = a.iter().map(|a| a * longest).collect();
        kinetic(self.world.system, &self.q, &gained) <= level
    }

    /// Shortens a stretch of flights only to the time at which they come to rest.
    pub(super) fn rest_time(&self, to: f64) -> f64 {
        if !self.components.is_empty() || self.drives_move() || self.next_knot < f64::INFINITY {
            return to;
        }
        rest_time(&self.world, &self.record.paths, (self.record.t, to), self.record.minima.top)
    }

    /// Scales of position and velocity that tolerances are relative to, by coordinate.
    pub fn scales(&self) -> (&[f64], &[f64]) {
        (&self.scales, &self.speeds)
    }

    /// What is left when the run is over.
    pub fn into_run(mut self) -> Run {
        let status = self.status.unwrap_or_else(|| self.end(Status::Stopped));
        let Recorder { t, trajectory, events, modes, energy, minima, .. } = self.record;
        Run {
            contact: Contact::Rigid,
            status,
            t,
            q: self.q,
            v: self.v,
            closed: self.closed,
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
        self.stats.gap_evaluations = self.world.evaluations;
        self.status = Some(status);
        status
    }
}
