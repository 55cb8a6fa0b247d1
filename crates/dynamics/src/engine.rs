//! What predictions and users need of a run, whichever way contact is modelled.

use crate::compliant::Compliant;
use crate::contact::Contact;
use crate::energy::Energy;
use crate::minima::MinimumFinder;
use crate::ranges::Track;
use crate::run::{Options, Run, Status};
use crate::settle::Closed;
use crate::simulation::Simulation;
use mainspring_mechanism::{ContactSource, System};

/// A run in progress.
pub trait Engine {
    /// Advances to the next event or step end. Returns the status once the run has ended.
    fn advance(&mut self) -> Option<Status>;
    /// Time, positions and velocities now.
    fn now(&self) -> (f64, &[f64], &[f64]);
    /// Minima of the kinetic energy so far.
    fn minima(&self) -> &MinimumFinder;
    fn energy(&self) -> &Energy;
    /// Contacts closed now, with their forces.
    fn closed(&mut self) -> Vec<Closed>;
    /// Scales of position and velocity that tolerances are relative to, by coordinate.
    fn scales(&self) -> (&[f64], &[f64]);
    /// Keeps a track from now on, with looks no further apart than `longest`.
    fn observe(&mut self, longest: f64);
    /// The track, if one is kept.
    fn track(&mut self) -> &mut Option<Track>;
    /// What is left when the run is over; stopped, if it has not ended.
    fn finish(self: Box<Self>) -> Run;
}

/// Starts a run from the system's positions and velocities.
pub fn start<'a>(
    system: &'a System,
    source: &'a dyn ContactSource,
    contact: Contact,
    options: Options,
) -> Box<dyn Engine + 'a> {
    match contact {
        Contact::Rigid => Box::new(Simulation::new(system, source, options)),
        Contact::Compliant(law) => Box::new(Compliant::new(system, source, law, options)),
    }
}

impl Engine for Simulation<'_> {
    fn advance(&mut self) -> Option<Status> {
        Simulation::advance(self)
    }

    fn now(&self) -> (f64, &[f64], &[f64]) {
        (self.record.t, &self.q, &self.v)
    }

    fn minima(&self) -> &MinimumFinder {
        &self.record.minima
    }

    fn energy(&self) -> &Energy {
        &self.record.energy
    }

    fn closed(&mut self) -> Vec<Closed> {
        self.closed.clone()
    }

    fn scales(&self) -> (&[f64], &[f64]) {
        Simulation::scales(self)
    }

    fn observe(&mut self, longest: f64) {
        self.record.track = Some(Track::empty(self.q.len()));
        self.longest_stretch = longest;
    }

    fn track(&mut self) -> &mut Option<Track> {
        &mut self.record.track
    }

    fn finish(self: Box<Self>) -> Run {
        self.into_run()
    }
}

impl Engine for Compliant<'_> {
    fn advance(&mut self) -> Option<Status> {
        Compliant::advance(self)
    }

    fn now(&self) -> (f64, &[f64], &[f64]) {
        (self.record.t, &self.q, &self.v)
    }

    fn minima(&self) -> &MinimumFinder {
        &self.record.minima
    }

    fn energy(&self) -> &Energy {
        &self.record.energy
    }

    fn closed(&mut self) -> Vec<Closed> {
        Compliant::closed(self)
    }

    fn scales(&self) -> (&[f64], &[f64]) {
        Compliant::scales(self)
    }

    fn observe(&mut self, longest: f64) {
        self.record.track = Some(Track::empty(self.q.len()));
        self.longest_stretch = longest;
    }

    fn track(&mut self) -> &mut Option<Track> {
        &mut self.record.track
    }

    fn finish(self: Box<Self>) -> Run {
        self.into_run()
    }
}
