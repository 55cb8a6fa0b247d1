//! `simulate`: a run to a given time, with its dense motion.

use crate::contact_model::{ContactChoice, constants};
use crate::contacts::contacts_json;
use crate::options::check_simulation;
use crate::words::{by_part, clean};
use mainspring_cspace::MapSource;
use mainspring_dynamics::{
    Contact, Event, EventKind, Mode, Options, Run, Status, compliant_forces_at, forces_at, kinetic, start,
};
use mainspring_mechanism::{ContactSource, Mechanism, System};
use mainspring_model::Error;
use serde_json::{Map, Value, json};
use std::sync::Arc;
use std::time::Instant;

/// Where a simulation gets the contacts that may close next. The motion is the same to the last bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactSearch {
    /// Through trees of features, whenever asked.
    #[default]
    Direct,
    /// From maps over the coordinates of each pair of bodies.
    Map,
}

impl ContactSearch {
    /// By its name, `direct` or `map`.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "direct" => Some(Self::Direct),
            "map" => Some(Self::Map),
            _ => None,
        }
    }

    pub(crate) fn source<'a>(self, system: &'a System) -> Box<dyn ContactSource + 'a> {
        match self {
            Self::Direct => Box::new(system.direct_search()),
            Self::Map => Box::new(MapSource::new(system)),
        }
    }
}

/// What `simulate` is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulationOptions {
    /// In the file's unit of time.
    pub until: f64,
    pub contact: ContactChoice,
    pub max_steps: u64,
    /// Report contact forces after each event.
    pub forces: bool,
    /// P_range_fraction of Algorithm 12: which kinetic-energy minima are listed.
    pub range_fraction: f64,
    pub search: ContactSearch,
}

impl Default for SimulationOptions {
    fn default() -> Self {
        Self {
            until: 1.0,
            contact: ContactChoice::default(),
            max_steps: 10_000_000,
            forces: false,
            range_fraction: 1e-5,
            search: ContactSearch::default(),
        }
    }
}

/// A part that moves: its coordinate and its velocity over that of the coordinate.
#[derive(Clone, Debug, PartialEq)]
struct Mover {
    name: String,
    coordinate: usize,
    ratio: f64,
    slides: bool,
}

/// A finished run with all that can be asked about it.
#[derive(Clone, Debug)]
pub struct SimulationResult {
    system: Arc<System>,
    movers: Vec<Mover>,
    run: Run,
    options: SimulationOptions,
    wall_seconds: f64,
}

/// Runs a mechanism from its initial state. `progress` is told the time and may answer false.
///
/// # Errors
/// Options out of their range, and what keeps a machine from being simulated: see `Mechanism::coordinates`.
pub fn simulate(
    mechanism: &Mechanism,
    options: &SimulationOptions,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<SimulationResult, Error> {
    check_simulation(options)?;
    let system = mechanism.kept_system()?;
    let source = options.search.source(&system);
    let (contact, rtol) = options.contact.resolve(&system)?;
    let limits = Options { until: options.until, rtol, max_steps: options.max_steps };
    let clock = Instant::now();
    let mut engine = start(&system, source.as_ref(), contact, limits);
    while engine.advance().is_none() && progress(engine.now().0) {}
    let wall_seconds = clock.elapsed().as_secs_f64();
    let run = engine.finish();
    Ok(SimulationResult::new(mechanism, system.clone(), run, options.clone(), wall_seconds))
}

impl SimulationResult {
    pub(crate) fn new(
        mechanism: &Mechanism,
        system: Arc<System>,
        run: Run,
        options: SimulationOptions,
        wall_seconds: f64,
    ) -> Self {
        let mover = |i: usize| {
            let (coordinate, ratio) = mechanism.subsystem_of(i)?;
            let slides = mechanism.slides(i);
            Some(Mover { name: mechanism.parts[i].name.clone(), coordinate, ratio, slides })
        };
        let movers = (0..mechanism.parts.len()).filter_map(mover).collect();
        Self { system, movers, run, options, wall_seconds }
    }

    /// Names of the moving parts, in the order of the model.
    pub fn parts(&self) -> Vec<String> {
        self.movers.iter().map(|m| m.name.clone()).collect()
    }

    /// Whether moving part `k` slides (and does not turn).
    pub(crate) fn slides(&self, k: usize) -> bool {
        self.movers[k].slides
    }

    /// The word for how it ended.
    pub(crate) fn status_word(&self) -> &'static str {
        status_word(self.run.status)
    }

    /// How it ended.
    pub fn status(&self) -> Status {
        self.run.status
    }

    /// Times of steps and events.
    pub fn times(&self) -> &[f64] {
        &self.run.trajectory.times
    }

    /// Is the motion known at time `t`? Within the run, and for ever after where it ended at rest.
    pub fn knows(&self, t: f64) -> bool {
        t >= 0.0 && (t <= self.run.t || (self.run.status == Status::AtRest && t.is_finite()))
    }

    /// Where the run ended.
    pub fn end(&self) -> f64 {
        self.run.t
    }

    /// Positions and velocities of the moving parts at time `t`, dense (just after an event at exactly `t`).
    pub fn at(&self, t: f64) -> (Vec<f64>, Vec<f64>) {
        self.movers
            .iter()
            .map(|m| {
                let state = self.run.trajectory.state(m.coordinate, t);
                (state.q * m.ratio, state.v * m.ratio)
            })
            .unzip()
    }

    /// Kinetic energy of everything that moves at time `t`.
    pub fn kinetic_energy(&self, t: f64) -> f64 {
        let states = (0..self.system.coordinates.len()).map(|i| self.run.trajectory.state(i, t));
        let (q, v): (Vec<f64>, Vec<f64>) = states.map(|s| (s.q, s.v)).unzip();
        kinetic(&self.system, &q, &v)
    }

    /// Values of parts from values of coordinates.
    pub(crate) fn of_parts(&self, coordinates: &[f64]) -> Value {
        by_part(&self.parts(), self.movers.iter().map(|m| coordinates[m.coordinate] * m.ratio))
    }

    /// Contacts closed at time `t`, with their forces there.
    pub fn contacts_at(&self, t: f64) -> Value {
        let n = self.system.coordinates.len();
        let states: Vec<_> = (0..n).map(|i| self.run.trajectory.state(i, t)).collect();
        let (q, v): (Vec<f64>, Vec<f64>) = states.iter().map(|s| (s.q, s.v)).unzip();
        let modes = &self.run.modes;
        let mode = modes.partition_point(|m| m.from <= t).checked_sub(1).map(|k| &modes[k]);
        let source = self.system.direct_search();
        let forces = |m: &Mode| match &self.run.contact {
            Contact::Rigid => forces_at(&self.system, &source, m, t, (&q, &v)),
            Contact::Compliant(law) => compliant_forces_at(&self.system, &source, law, m, (&q, &v)),
        };
        let closed = mode.map_or(vec![], forces);
        Value::Array(contacts_json(&self.system, &closed, &q))
    }

    /// The object that `simulate --json` prints.
    pub fn json(&self, timing: bool) -> Value {
        self.object(timing, true)
    }

    /// The same without its long lists, events and forces.
    pub fn brief_json(&self) -> Value {
        self.object(false, false)
    }

    fn object(&self, timing: bool, lists: bool) -> Value {
        let run = &self.run;
        let mut object = json!({
            "status": status_word(run.status),
            "advice": advice(run.status),
            "t": run.t,
            "positions": self.of_parts(&run.q),
            "velocities": self.of_parts(&run.v),
            "kinetic_energy_minima": self.low_minima(),
        });
        let entries = object.as_object_mut().expect("built as an object");
        if lists {
            entries.insert("events".into(), run.events.iter().map(|e| self.event(e)).collect());
        }
        entries.insert("energy".into(), self.energy());
        if lists && self.options.forces {
            entries.insert("forces".into(), self.forces());
        }
        if let Some(constants) = constants(&run.contact) {
            entries.insert("contact".into(), constants);
        }
        entries.insert("stats".into(), self.stats(timing));
        object
    }

    /// Times of the minima that Algorithm 12 would count.
    pub(crate) fn low_minima(&self) -> Vec<f64> {
        let low =
            self.run.minima.iter().filter(|m| m.energy < self.options.range_fraction * m.top && m.t > 0.0);
        low.map(|m| m.t).collect()
    }

    /// Counts of work.
    pub fn stats(&self, timing: bool) -> Value {
        let stats = &self.run.stats;
        let mut counts = Map::new();
        counts.insert("steps".into(), json!(stats.steps));
        counts.insert("gap_evaluations".into(), json!(stats.gap_evaluations));
        counts.insert("impacts".into(), json!(stats.impacts));
        if timing {
            counts.insert("wall_seconds".into(), json!(self.wall_seconds));
        }
        Value::Object(counts)
    }

    fn energy(&self) -> Value {
        let e = &self.run.energy;
        let mut account = json!({
            "initial": e.initial,
            "final": e.last,
            "work": e.work,
            "friction": e.friction,
            "impacts": e.impacts,
        });
        if self.run.contact != Contact::Rigid {
            account["contact_stored"] = json!(e.contact_stored);
        }
        account["kinetic_max"] = json!(e.kinetic_max);
        account["residual"] = json!(e.residual());
        account
    }

    fn event(&self, e: &Event) -> Value {
        let name = |i: usize| self.system.bodies[i].name.clone();
        let kind = match e.kind {
            EventKind::Impact => "impact",
            EventKind::Close => "close",
            EventKind::Release => "release",
        };
        let together: Vec<Vec<String>> =
            e.moving_together.iter().map(|g| g.iter().map(|&i| name(i)).collect()).collect();
        let mut event = json!({
            "t": e.t,
            "kind": kind,
            "parts": [name(e.bodies.0), name(e.bodies.1)],
            "impulse": clean(e.impulse),
            "moving_together": together,
        });
        if let Some(stop) = e.contact.stop().map(|k| &self.system.forces.stops[k]) {
            event["stop"] = json!(if stop.upper { "upper" } else { "lower" });
        }
        event
    }

    /// Contacts with their forces just after each instant at which something changed, and at the end.
    fn forces(&self) -> Value {
        let mut times: Vec<f64> = self.run.events.iter().map(|e| e.t).chain([0.0, self.run.t]).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let at = |t: &f64| json!({"t": t, "contacts": self.contacts_at(*t)});
        Value::Array(times.iter().map(at).collect())
    }

    pub(crate) fn run(&self) -> &Run {
        &self.run
    }

    pub(crate) fn system(&self) -> &System {
        &self.system
    }
}

fn status_word(status: Status) -> &'static str {
    match status {
        Status::Complete => "complete",
        Status::AtRest => "at_rest",
        Status::StepLimit => "step_limit",
        Status::Jammed => "jammed",
        Status::TooDeep => "too_deep",
        Status::Stopped => "stopped",
    }
}

fn advice(status: Status) -> Option<&'static str> {
    match status {
        Status::Complete | Status::AtRest | Status::Stopped => None,
        Status::Jammed => Some(
            "a drive runs against parts that cannot give way: change its motion, or what stands in its way",
        ),
        Status::TooDeep => {
            Some("parts overlap by more than compliant contact can stand for: raise its constant E")
        }
        Status::StepLimit => {
            Some("the bound on steps was met: ask for a shorter time, a looser tolerance, or more steps")
        }
    }
}
