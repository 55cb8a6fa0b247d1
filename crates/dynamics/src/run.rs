//! What a run is asked to do, and what is left of it.

use crate::contact::Contact;
use crate::energy::Energy;
use crate::events::Event;
use crate::minima::Minimum;
use crate::path::Trajectory;
use crate::settle::Closed;

/// What a run is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Time to stop at.
    pub until: f64,
    /// Relative tolerance of a step, against the machine's size and the greatest speeds.
    pub rtol: f64,
    /// Most steps.
    pub max_steps: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { until: 1.0, rtol: 1e-8, max_steps: 10_000_000 }
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Reached the time asked for.
    Complete,
    /// Came to rest before.
    AtRest,
    /// Met the bound on steps, or an instant without progress.
    StepLimit,
    /// A drive runs against parts that cannot give way.
    Jammed,
    /// Parts overlap too deeply for compliant contact to mean anything.
    TooDeep,
    /// Stopped from outside.
    Stopped,
}

/// Counts of work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Stretches of motion between which the state was advanced.
    pub steps: u64,
    pub gap_evaluations: u64,
    /// Instants with an impact.
    pub impacts: u64,
}

/// The contacts closed from a time on, until the next mode, and what dry friction does.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    pub from: f64,
    pub closed: Vec<Closed>,
    /// Coordinates that dry friction holds.
    pub stuck: Vec<bool>,
    /// Directions (±1) in which coordinates slide against dry friction; 0 for all others.
    pub sliding: Vec<f64>,
}

/// A finished run: how it ended, where, and everything on the way.
#[derive(Clone, Debug)]
pub struct Run {
    /// How contact was modelled.
    pub contact: Contact,
    pub status: Status,
    /// Time reached.
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    /// Contacts closed at the end, with their forces.
    pub closed: Vec<Closed>,
    /// Contact modes in the order of time; several may begin at one instant, the last of them counts.
    pub modes: Vec<Mode>,
    pub trajectory: Trajectory,
    pub events: Vec<Event>,
    pub energy: Energy,
    /// Every local minimum of the kinetic energy.
    pub minima: Vec<Minimum>,
    pub stats: Stats,
}
