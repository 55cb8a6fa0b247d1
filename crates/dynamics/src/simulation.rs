//! A run: flights, rests and integrated stretches from event to event. Contact mode is explicit state.

mod ending;
mod modes;

use crate::chatter::Chatter;
use crate::component::{Component, Tolerance};
use crate::energy::kinetic;
use crate::halts::{Halts, halted};
use crate::inertia::Inertia;
use crate::linear::Small;
use crate::path::Path;
use crate::place::is_standing;
use crate::recorder::Recorder;
use crate::rest::longest_swing;
use crate::run::{Options, Stats, Status};
use crate::search::{CLOSED, Stretch, Watch, first_closing};
use crate::settle::Closed;
use crate::watch::{Change, first_change};
use crate::work::drive_work;
use crate::world::World;
use mainspring_mechanism::{ContactId, ContactSource, System};

/// Events allowed without any passage of time.
pub(crate) const MOST_AT_ONCE: u32 = 200;

/// Parts in contact are integrated at least this well: what a step leaves stays far below `OVERLAP`.
const LOOSEST: f64 = 1e-7;

/// Where drives act, steps are held to this share of the tolerance: what a drive and the springs hand to each other is
/// much more than what is lost, and the energy account is measured by what is lost.
const DRIVEN_SHARE: f64 = 0.1;

/// The part of a turn of the fastest drive after which what only drives move is looked at again.
const DRIVEN_LOOK: f64 = 0.02;

/// A run in progress.
pub struct Simulation<'a> {
    pub world: World<'a>,
    options: Options,
    pub record: Recorder,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    speeds: Vec<f64>,
    scales: Vec<f64>,
    pub closed: Vec<Closed>,
    /// Contacts not to look for before a positive gap was seen, with the gap they count from.
    released: Vec<(ContactId, f64)>,
    chatter: Chatter,
    components: Vec<(Component, f64)>,
    next_step: f64,
    /// Times in which springs, friction or weight act, by coordinate.
    natural_times: Vec<f64>,
    /// When the acceleration of a drive jumps next.
    next_knot: f64,
    /// Longest time between looks at the motion; infinite unless an observer wants to stop early.
    pub longest_stretch: f64,
    at_once: u32,
    /// A drive runs against what cannot give way.
    jammed: bool,
    pub stats: Stats,
    pub status: Option<Status>,
}

impl<'a> Simulation<'a> {
    /// Starts from the system's positions and velocities.
    pub fn new(system: &'a System, source: &'a dyn ContactSource, options: Options) -> Self {
        let (mut q, mut v): (Vec<f64>, Vec<f64>) =
            system.coordinates.iter().map(|c| (c.position, c.velocity)).unzip();
        let n = q.len();
        let world = World::new(system, source);
        for (i, drive) in &world.drives {
            let driven = drive.at(0.0);
            (q[*i], v[*i]) = (driven.q, driven.v);
        }
        let scales = position_scales(&world, &q);
        let natural_times: Vec<f64> = {
            let inertia = Inertia::whole(system, &world.moved, (&q, &v));
            (0..n).map(|i| inertia.natural_time(i)).collect()
        };
        let driven = world.drives.iter().map(|&(i, _)| own_kinetic(system, i, v[i])).sum();
        let mut run = Self {
            record: Recorder::new(system, (&q, &v), driven),
            world,
            speeds: v.iter().map(|v| v.abs()).collect(),
            scales,
            closed: vec![],
            released: vec![],
            chatter: Chatter::default(),
            components: vec![],
            next_step: 0.05 * natural_times.iter().copied().fold(options.until, f64::min),
            natural_times,
            next_knot: f64::INFINITY,
            longest_stretch: f64::INFINITY,
            at_once: 0,
            jammed: false,
            stats: Stats::default(),
            status: None,
            options,
            q,
            v,
        };
        run.resolve(None);
        run
    }

    /// Runs to the end; `progress` is told the time after each step and may answer false to stop.
    pub fn run(&mut self, progress: &mut dyn FnMut(f64) -> bool) -> Status {
        loop {
            if let Some(status) = self.advance() {
                return status;
            }
            if !progress(self.record.t) {
                return self.end(Status::Stopped);
            }
        }
    }

    /// Advances to the next event or step end. Returns the status once the run has ended.
    pub fn advance(&mut self) -> Option<Status> {
        if self.status.is_some() {
            return self.status;
        }
        if self.record.t >= self.options.until {
            return Some(self.end(Status::Complete));
        }
        if self.jammed {
            return Some(self.end(Status::Jammed));
        }
        if self.stats.steps >= self.options.max_steps || self.at_once > MOST_AT_ONCE {
            return Some(self.end(Status::StepLimit));
        }
        if self.is_at_rest() {
            return Some(self.end(Status::AtRest));
        }
        self.stats.steps += 1;
        let Some(to) = self.integrate() else { return Some(self.end(self.without_progress())) };
        let to = self.rest_time(to);
        let (at, change) = self.next_event(to);
        self.commit(at);
        if change.is_some() || self.record.t >= self.next_knot || self.slips() {
            self.resolve(change);
        } else {
            self.tend();
        }
        None
    }

    /// Does a coordinate move that contacts alone held at rest, so that nothing told in which direction?
    fn slips(&self) -> bool {
        let world = &self.world;
        let loose = |&i: &usize| {
            let rested =
                world.system.forces.coulomb[i] > 0.0 && world.sliding[i] == 0.0 && !world.free.is_held(i);
            rested && self.v[i].abs() > self.halted(i)
        };
        (0..self.v.len()).any(|i| loose(&i))
    }

    /// Why equations cannot be solved: parts that a drive locks, or else nobody knows.
    fn without_progress(&self) -> Status {
        if self.drives_move() { Status::Jammed } else { Status::StepLimit }
    }

    fn drives_move(&self) -> bool {
        self.world.drives.iter().any(|d| !self.record.paths[d.0].is_rest())
    }

    /// Gives every moving component a path beyond the present; returns the end of the common stretch.
    fn integrate(&mut self) -> Option<f64> {
        let end = self.options.until.min(self.next_knot);
        let mut to = end.min(self.record.t + self.longest_stretch);
        for k in 0..self.components.len() {
            if self.components[k].1 <= self.record.t {
                let tolerance = Tolerance {
                    relative: self.world.tolerance(self.options.rtol.min(LOOSEST), DRIVEN_SHARE),
                    positions: &self.scales,
                    speeds: &self.speeds,
                    shortest: 16.0 * f64::EPSILON * (1.0 + self.record.t.abs()),
                };
                let start = (self.record.t, self.q.as_slice(), self.v.as_slice());
                let longest = self.longest_step(k, end);
                let (component, until) = &mut self.components[k];
                let step = component.advance(&mut self.world, start, self.next_step, longest, &tolerance)?;
                *until = self.record.t + step.h;
                self.next_step = step.next;
                for (i, path) in step.paths {
                    self.record.set_path(i, path);
                }
            }
            to = to.min(self.components[k].1);
        }
        Some(to.min(self.record.t + longest_swing(&self.record.paths)))
    }

    /// What only drives move has no error to tell how long a step may be.
    fn longest_step(&self, k: usize, end: f64) -> f64 {
        let left = end - self.record.t;
        if !self.components[k].0.coordinates.is_empty() {
            return left;
        }
        let rate = |&(i, drive): &(usize, &mainspring_mechanism::Drive)| {
            drive.bounds(self.record.t, end).0 / self.scales[i]
        };
        let fastest = self.world.drives.iter().map(rate).fold(0.0, f64::max);
        left.min(DRIVEN_LOOK * std::f64::consts::TAU / fastest.max(f64::MIN_POSITIVE))
    }

    /// The first thing to happen until `to`: a contact that closes, or a change of the contacts that are closed.
    fn next_event(&mut self, to: f64) -> (f64, Option<Change>) {
        let watched: Small<(ContactId, Watch), 8> = self
            .closed
            .iter()
            .map(|c| (c.candidate.id, self.watch_closed(c)))
            .chain(self.released.iter().map(|&(id, floor)| (id, Watch::Released { floor })))
            .collect();
        let stretch = Stretch {
            paths: &self.record.paths,
            components: &self.components,
            from: self.record.t,
            to,
            outside: 0.0,
        };
        let speeds = &self.speeds;
        let mut real = |world: &mut World, touch: &crate::world::Touch, q: &[f64], v: &[f64]| {
            is_standing(world, touch, q, v, speeds)
        };
        let found = first_closing(&mut self.world, &stretch, &watched, &mut real);
        let mut to = found.clear_until;
        let mut first = found.closing.map(|c| (c.t, Change::Closing(c.candidate.id)));
        let (world, paths, until) = (&self.world, &self.record.paths, to);
        let mut halts = Halts { world, paths, from: self.record.t, to, first: None };
        halts.stops(&watched);
        halts.slides(|i| self.halted(i));
        to = halts.to;
        if to < until {
            first = None;
        }
        first = halts.first.map(|(t, halt)| (t, Change::of_halt(halt))).or(first);
        let stretch = Stretch {
            paths: &self.record.paths,
            components: &self.components,
            from: self.record.t,
            to,
            outside: 0.0,
        };
        for (component, _) in &self.components {
            let limit = first.map_or(to, |f| f.0);
            let found = first_change(&mut self.world, component, &Stretch { to: limit, ..stretch });
            if let Some((t, change)) = found
                && (t < limit || first.is_none())
            {
                first = Some((t, change));
            }
        }
        match first {
            Some((t, change)) => (t.clamp(self.record.t, to), Some(change)),
            None => (to, None),
        }
    }

    /// A contact that carries no force may have to the next moment, between parts whose motion is exact: it then is as
    /// one released. (Along steps of the integrator gaps are not that exact, and steps are short.)
    fn watch_closed(&self, closed: &Closed) -> Watch {
        let id = closed.candidate.id;
        let stepped = |i: usize| matches!(self.record.paths[i], Path::Step { .. });
        if closed.active || self.world.coordinates_of(id).any(stepped) {
            return Watch::Closed;
        }
        Watch::Released { floor: closed.gap.min(0.0) }
    }

    /// Velocities of coordinate `i` up to this count as zero for dry friction.
    fn halted(&self, i: usize) -> f64 {
        halted(i, &self.scales, &self.speeds)
    }

    /// Moves the present to `t` along the paths.
    fn commit(&mut self, t: f64) {
        let (system, from) = (self.world.system, self.record.t);
        self.record.energy.work += drive_work(&mut self.world, &self.components, &self.record.paths, from, t);
        self.record.commit(system, t, (&mut self.q, &mut self.v));
        for (speed, v) in self.speeds.iter_mut().zip(&self.v) {
            *speed = speed.max(v.abs());
        }
        self.at_once = if t > from { 0 } else { self.at_once + 1 };
        for (component, _) in &self.components {
            component.project(&mut self.world, &mut self.q, &mut self.v);
        }
        if !self.world.drives.is_empty() {
            self.record.energy.kinetic_max =
                self.record.energy.kinetic_max.max(kinetic(system, &self.q, &self.v));
        }
    }

    /// After a step without event: contacts closed without force may have begun to move apart, and contacts
    /// released may have opened.
    fn tend(&mut self) {
        let open = 8.0 * CLOSED * self.world.system.size;
        let moving =
            |world: &World, id, paths: &[Path]| world.coordinates_of(id).any(|i| !paths[i].is_rest());
        let mut changed = false;
        for k in 0..self.closed.len() {
            let Closed { candidate, active, gap, .. } = self.closed[k];
            if !active && moving(&self.world, candidate.id, &self.record.paths) {
                let (a, b) = self.world.place(&candidate, &self.q);
                let touch = self.world.touch_at(&candidate, &self.q, (&a, &b));
                let off = touch.margin(self.world.system.size) < 0.0;
                changed |= (touch.state.gap - gap).abs() > open || off;
            }
        }
        if changed {
            self.resolve(None);
        }
        self.drop_opened(open);
    }

    /// Forgets released contacts whose gap is open by now, or that ran off their features.
    fn drop_opened(&mut self, open: f64) {
        let size = self.world.system.size;
        for (id, floor) in std::mem::take(&mut self.released) {
            let Some(candidate) = self.world.find(id) else { continue };
            let (a, b) = self.world.place(&candidate, &self.q);
            let touch = self.world.touch_at(&candidate, &self.q, (&a, &b));
            let off = touch.margin(size) <= 0.0 && (touch.state.gap - floor).abs() > open;
            if touch.state.gap <= open && !off {
                self.released.push((id, floor));
            }
        }
    }
}

/// Kinetic energy of a coordinate's own inertia.
fn own_kinetic(system: &System, i: usize, v: f64) -> f64 {
    0.5 * system.coordinates[i].inertia * v * v
}

/// Positions change gaps by lever arms: a tolerance on gaps relative to the size, seen by each coordinate.
pub(crate) fn position_scales(world: &World, q: &[f64]) -> Vec<f64> {
    let mut arms = vec![0.0f64; world.system.coordinates.len()];
    for list in &world.arms {
        for arm in list {
            let length = arm.reach(|k| q[list[k].coordinate].abs());
            arms[arm.coordinate] = arms[arm.coordinate].max(length);
        }
    }
    arms.iter().map(|&a| if a > 0.0 { world.system.size / a } else { 1.0 }).collect()
}
