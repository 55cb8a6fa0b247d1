//! A run: flights, rests and integrated stretches from event to event. Contact mode is explicit state.

use crate::chatter::Chatter;
use crate::component::{Component, Tolerance};
use crate::energy::{Energy, friction_loss, kinetic, potential};
use crate::events::{Event, entries};
use crate::flight::{Flight, State};
use crate::minima::{Minimum, MinimumFinder};
use crate::path::{Path, Piece, Trajectory};
use crate::place::is_standing;
use crate::ranges::Track;
use crate::search::{CLOSED, Stretch, Watch, first_closing};
use crate::settle::{Closed, Instant, Settled, groups, settle};
use crate::watch::{Change, first_change};
use crate::world::World;
use mainspring_mechanism::{ContactId, ContactSource, Coordinate, Row, System};

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

/// Remaining energy, relative to the greatest kinetic energy, at which flights count as at rest.
pub(crate) const AT_REST: f64 = 1e-13;
/// Events allowed without any passage of time.
pub(crate) const MOST_AT_ONCE: u32 = 200;

/// Parts in contact are integrated at least this well: what a step leaves stays far below `OVERLAP`.
const LOOSEST: f64 = 1e-7;

/// The contacts closed from a time on, until the next mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    pub from: f64,
    pub closed: Vec<Closed>,
}

/// A finished run: how it ended, where, and everything on the way.
#[derive(Clone, Debug)]
pub struct Run {
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

/// A run in progress.
pub struct Simulation<'a> {
    pub world: World<'a>,
    options: Options,
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    speeds: Vec<f64>,
    scales: Vec<f64>,
    paths: Vec<Path>,
    since: Vec<f64>,
    pub closed: Vec<Closed>,
    modes: Vec<Mode>,
    /// Contacts not to look for before a positive gap was seen, with the gap they count from.
    released: Vec<(ContactId, f64)>,
    chatter: Chatter,
    components: Vec<(Component, f64)>,
    next_step: f64,
    /// Longest time between looks at the motion; infinite unless an observer wants to stop early.
    pub longest_stretch: f64,
    at_once: u32,
    pub trajectory: Trajectory,
    pub events: Vec<Event>,
    pub energy: Energy,
    pub minima: MinimumFinder,
    /// The last stretch of motion and the ranges since they were last taken; kept only when asked for.
    pub track: Option<Track>,
    pub stats: Stats,
    pub status: Option<Status>,
}

impl<'a> Simulation<'a> {
    /// Starts from the system's positions and velocities.
    pub fn new(system: &'a System, source: &'a dyn ContactSource, options: Options) -> Self {
        let (q, v): (Vec<f64>, Vec<f64>) =
            system.coordinates.iter().map(|c| (c.position, c.velocity)).unzip();
        let n = q.len();
        let world = World::new(system, source);
        let scales = position_scales(&world);
        let initial = kinetic(system, &v) + potential(system, &q);
        let mut run = Self {
            world,
            t: 0.0,
            speeds: v.iter().map(|v| v.abs()).collect(),
            scales,
            paths: q.iter().map(|&q| Path::Rest { q }).collect(),
            since: vec![0.0; n],
            closed: vec![],
            modes: vec![],
            released: vec![],
            chatter: Chatter::default(),
            components: vec![],
            next_step: 0.05 * system.coordinates.iter().map(natural_time).fold(options.until, f64::min),
            longest_stretch: f64::INFINITY,
            at_once: 0,
            trajectory: Trajectory { pieces: vec![vec![]; n], times: vec![0.0] },
            events: vec![],
            energy: Energy { initial, last: initial, ..Energy::default() },
            minima: MinimumFinder::default(),
            track: None,
            stats: Stats::default(),
            status: None,
            options,
            q,
            v,
        };
        run.energy.kinetic_max = kinetic(system, &run.v);
        run.minima.top = run.energy.kinetic_max;
        run.resolve(None);
        run
    }

    /// Runs to the end; `progress` is told the time after each step and may answer false to stop.
    pub fn run(&mut self, progress: &mut dyn FnMut(f64) -> bool) -> Status {
        loop {
            if let Some(status) = self.advance() {
                return status;
            }
            if !progress(self.t) {
                return self.end(Status::Stopped);
            }
        }
    }

    /// Advances to the next event or step end. Returns the status once the run has ended.
    pub fn advance(&mut self) -> Option<Status> {
        if self.status.is_some() {
            return self.status;
        }
        if self.t >= self.options.until {
            return Some(self.end(Status::Complete));
        }
        if self.stats.steps >= self.options.max_steps || self.at_once > MOST_AT_ONCE {
            return Some(self.end(Status::StepLimit));
        }
        if self.is_at_rest() {
            return Some(self.end(Status::AtRest));
        }
        self.stats.steps += 1;
        let Some(to) = self.integrate() else { return Some(self.end(Status::StepLimit)) };
        let to = self.rest_time(to);
        let (at, change) = self.next_event(to);
        self.commit(at);
        if let Some(change) = change {
            self.resolve(change.leaving());
        } else {
            self.tend();
        }
        None
    }

    /// Gives every moving component a path beyond the present; returns the end of the common stretch.
    fn integrate(&mut self) -> Option<f64> {
        let mut to = self.options.until.min(self.t + self.longest_stretch);
        for k in 0..self.components.len() {
            if self.components[k].1 <= self.t {
                let tolerance = Tolerance {
                    relative: self.options.rtol.min(LOOSEST),
                    positions: &self.scales,
                    speeds: &self.speeds,
                    shortest: 16.0 * f64::EPSILON * (1.0 + self.t.abs()),
                };
                let start = (self.t, self.q.as_slice(), self.v.as_slice());
                let longest = self.options.until - self.t;
                let (component, until) = &mut self.components[k];
                let step = component.advance(&mut self.world, start, self.next_step, longest, &tolerance)?;
                *until = self.t + step.h;
                self.next_step = step.next;
                for (i, path) in step.paths {
                    self.set_path(i, path);
                }
            }
            to = to.min(self.components[k].1);
        }
        Some(to.min(self.t + self.longest_swing()))
    }

    /// Stretches stay short against swings, so that no minimum or extreme inside is overlooked; unbounded if nothing
    /// swings.
    fn longest_swing(&self) -> f64 {
        let swing = |path: &Path| match path {
            Path::Flight(flight) if flight.panel().1 == 1.0 => 4.0 * flight.panel().0,
            _ => f64::INFINITY,
        };
        self.paths.iter().map(swing).fold(f64::INFINITY, f64::min)
    }

    /// The first thing to happen until `to`: a contact that closes, or a change of the contacts that are closed.
    fn next_event(&mut self, to: f64) -> (f64, Option<Change>) {
        let watched: Vec<(ContactId, Watch)> = self
            .closed
            .iter()
            .map(|c| (c.candidate.id, Watch::Closed))
            .chain(self.released.iter().map(|&(id, floor)| (id, Watch::Released { floor })))
            .collect();
        let stretch = Stretch { paths: &self.paths, from: self.t, to };
        let speeds = &self.speeds;
        let mut real = |world: &mut World, touch: &crate::world::Touch, q: &[f64], v: &[f64]| {
            is_standing(world, touch, q, v, speeds)
        };
        let found = first_closing(&mut self.world, &stretch, &watched, &mut real);
        let to = found.clear_until;
        let stretch = Stretch { paths: &self.paths, from: self.t, to };
        let mut first = found.closing.map(|c| (c.t, Change::Closing(c.candidate.id)));
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
            Some((t, change)) => (t.clamp(self.t, to), Some(change)),
            None => (to, None),
        }
    }

    /// Moves the present to `t` along the paths.
    fn commit(&mut self, t: f64) {
        let system = self.world.system;
        self.minima.stretch(system, &self.paths, self.t, t);
        self.energy.friction += friction_loss(system, &self.paths, self.t, t);
        if let Some(track) = &mut self.track {
            track.ranges.extend(&self.paths, self.t, t);
            (track.from, track.to) = (self.t, t);
            track.paths.clone_from(&self.paths);
        }
        for (i, path) in self.paths.iter().enumerate() {
            let State { q, v } = path.at(t);
            (self.q[i], self.v[i]) = (q, v);
            self.speeds[i] = self.speeds[i].max(v.abs());
        }
        self.at_once = if t > self.t { 0 } else { self.at_once + 1 };
        self.t = t;
        if self.trajectory.end() < t {
            self.trajectory.times.push(t);
        }
        for (component, _) in &self.components {
            component.project(&mut self.world, &mut self.q, &mut self.v);
        }
    }

    /// After a step without event: contacts closed without force may have begun to move apart, and contacts
    /// released may have opened.
    fn tend(&mut self) {
        let open = 8.0 * CLOSED * self.world.system.size;
        let moving = |world: &World, id: u32, paths: &[Path]| {
            world.arms[id as usize].iter().any(|arm| !paths[arm.coordinate].is_rest())
        };
        let mut changed = false;
        for k in 0..self.closed.len() {
            let Closed { candidate, active, .. } = self.closed[k];
            if !active && moving(&self.world, candidate.id.interaction, &self.paths) {
                let (a, b) = self.world.place(&candidate, &self.q);
                let touch = self.world.touch(&candidate, (&a, &b));
                let off = touch.margin(self.world.system.size) < 0.0;
                changed |= touch.state.gap.abs() > open || off;
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
            let Some(candidate) = find_candidate(&self.world, id) else { continue };
            let (a, b) = self.world.place(&candidate, &self.q);
            let touch = self.world.touch(&candidate, (&a, &b));
            let off = touch.margin(size) <= 0.0 && (touch.state.gap - floor).abs() > open;
            if touch.state.gap <= open && !off {
                self.released.push((id, floor));
            }
        }
    }

    /// Resolves impacts and contact forces now, logs what changed, and gives every coordinate its path.
    fn resolve(&mut self, leaving: Option<ContactId>) {
        let before = self.v.clone();
        let mut v = self.v.clone();
        let mut instant = Instant {
            q: &self.q,
            speeds: &self.speeds,
            closed: &self.closed,
            leaving,
            chattering: (self.at_once > MOST_AT_ONCE / 2).then_some(f64::INFINITY),
        };
        let mut settled = settle(&mut self.world, &instant, &mut v);
        instant.chattering =
            self.chatter.ends(&mut self.world, self.t, (&self.q, &self.v), &settled.impulses);
        if instant.chattering.is_some() {
            let blow = settled;
            settled = settle(&mut self.world, &instant, &mut v);
            settled.add_blow(blow);
        }
        self.v = v;
        self.events.extend(entries(&self.world, self.t, &self.closed, &settled));
        if !settled.impulses.is_empty() {
            self.stats.impacts += 1;
            self.energy.impacts += settled.loss;
            self.minima.impact(settled.loss, self.t);
        }
        if !settled.solved {
            self.at_once = MOST_AT_ONCE + 1;
        }
        for (speed, v) in self.speeds.iter_mut().zip(&self.v) {
            *speed = speed.max(v.abs());
        }
        self.set_modes(&before, &settled);
        self.released = settled.opening.iter().map(|&(id, gap)| (id, gap.min(0.0))).collect();
        self.closed = settled.closed;
        self.modes.push(Mode { from: self.t, closed: self.closed.clone() });
    }

    /// Rest, flight or component for every coordinate.
    fn set_modes(&mut self, before: &[f64], settled: &Settled) {
        let active: Vec<&Closed> = settled.closed.iter().filter(|c| c.active).collect();
        let placed = self.world.place_all(&self.q);
        let row = |c: &&Closed| self.world.touch_among(&c.candidate, &placed).row();
        let rows: Vec<Row> = active.iter().map(row).collect();
        let all: Vec<usize> = (0..rows.len()).collect();
        let mut in_group = vec![false; self.q.len()];
        self.components.clear();
        for group in groups(&rows, &all) {
            group.coordinates.iter().for_each(|&i| in_group[i] = true);
            let full = group.contacts.len() >= group.coordinates.len();
            let still = group.coordinates.iter().all(|&i| self.is_still(i, settled.acceleration[i]));
            if full || still {
                for &i in &group.coordinates {
                    self.v[i] = 0.0;
                    self.set_path(i, Path::Rest { q: self.q[i] });
                }
                continue;
            }
            let contacts = group.contacts.iter().map(|&k| active[k].candidate).collect();
            let component = Component::new(&self.world, group.coordinates, contacts);
            self.components.push((component, self.t));
        }
        for i in (0..self.q.len()).filter(|&i| !in_group[i]) {
            self.set_free(i, before[i], settled.acceleration[i]);
        }
    }

    /// No contact carries force on coordinate `i`: it flies, or stays where nothing moves it.
    fn set_free(&mut self, i: usize, v_before: f64, acceleration: f64) {
        if self.is_still(i, acceleration) {
            self.v[i] = 0.0;
            self.set_path(i, Path::Rest { q: self.q[i] });
            return;
        }
        let flies_on = matches!(self.paths[i], Path::Flight(_)) && v_before == self.v[i];
        if !flies_on {
            let c = &self.world.system.coordinates[i];
            let state = State { q: self.q[i], v: self.v[i] };
            let flight = Flight::new(self.t, state, c.inertia, c.damping, c.stiffness, c.force);
            self.set_path(i, Path::Flight(flight));
        }
    }

    /// Neither moving nor about to, to rounding.
    fn is_still(&self, i: usize, acceleration: f64) -> bool {
        let c = &self.world.system.coordinates[i];
        let force = c.force.abs() + (c.stiffness * self.q[i]).abs();
        self.v[i].abs() <= 1e-13 * self.speeds[i] && acceleration.abs() <= 1e-13 * force / c.inertia
    }

    fn set_path(&mut self, i: usize, path: Path) {
        if self.paths[i] == path {
            return;
        }
        if self.t > self.since[i] {
            let piece = Piece { from: self.since[i], to: self.t, path: self.paths[i] };
            self.trajectory.pieces[i].push(piece);
        }
        (self.paths[i], self.since[i]) = (path, self.t);
    }

    /// Everything rests, or moves with next to no energy left above its equilibrium.
    fn is_at_rest(&mut self) -> bool {
        let level = AT_REST * self.minima.top;
        if kinetic(self.world.system, &self.v) > level || self.free_energy(self.t) > level {
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
        if component.forces(&mut self.world, (&self.q, &self.v), &mut a, |_| {}).is_none() {
            return false;
        }
        let system = self.world.system;
        let own = || component.coordinates.iter().map(|&i| (&system.coordinates[i], a[i]));
        let square = own().map(|(c, _)| natural_time(c).powi(2)).fold(0.0, f64::max);
        own().map(|(c, a)| 0.5 * c.inertia * a * a * square).sum::<f64>() <= level
    }

    /// Energy that flights still hold above their equilibria, at time `t` along the present paths. Infinite when
    /// one has no equilibrium.
    fn free_energy(&self, t: f64) -> f64 {
        let coordinates = &self.world.system.coordinates;
        coordinates
            .iter()
            .zip(&self.paths)
            .filter(|(_, path)| matches!(path, Path::Flight(_)))
            .map(|(c, path)| {
                let State { q, v } = path.at(t);
                let away = if c.stiffness > 0.0 {
                    0.5 * c.stiffness * (q - c.force / c.stiffness).powi(2)
                } else if c.force != 0.0 {
                    f64::INFINITY
                } else {
                    0.0
                };
                0.5 * c.inertia * v * v + away
            })
            .sum()
    }

    /// Shortens a stretch of flights only to the time at which they come to rest.
    fn rest_time(&self, to: f64) -> f64 {
        let top = self.minima.top.max(self.energy.kinetic_max);
        // Before anything has moved, what can still be set free stands for the greatest kinetic energy.
        let level = AT_REST * if top > 0.0 { top } else { self.free_energy(self.t) };
        if !self.components.is_empty() || level <= 0.0 || !level.is_finite() || self.free_energy(to) > level {
            return to;
        }
        let (mut moving, mut resting) = (self.t, to);
        for _ in 0..100 {
            let middle = 0.5 * (moving + resting);
            if self.free_energy(middle) > level {
                moving = middle;
            } else {
                resting = middle;
            }
        }
        resting
    }

    /// Scales of position and velocity that tolerances are relative to, by coordinate.
    pub fn scales(&self) -> (&[f64], &[f64]) {
        (&self.scales, &self.speeds)
    }

    /// What is left when the run is over.
    pub fn into_run(mut self) -> Run {
        let status = self.status.unwrap_or_else(|| self.end(Status::Stopped));
        Run {
            status,
            t: self.t,
            q: self.q,
            v: self.v,
            closed: self.closed,
            modes: self.modes,
            trajectory: self.trajectory,
            events: self.events,
            energy: self.energy,
            minima: self.minima.found,
            stats: self.stats,
        }
    }

    fn end(&mut self, status: Status) -> Status {
        for i in 0..self.paths.len() {
            let piece = Piece { from: self.since[i], to: self.t, path: self.paths[i] };
            self.trajectory.pieces[i].push(piece);
        }
        self.energy.kinetic_max = self.energy.kinetic_max.max(self.minima.top);
        self.energy.last = kinetic(self.world.system, &self.v) + potential(self.world.system, &self.q);
        self.stats.gap_evaluations = self.world.evaluations;
        self.status = Some(status);
        status
    }
}

/// The time in which a coordinate's springs or friction act: √(I/k), or I/h, or 1.
pub(crate) fn natural_time(c: &Coordinate) -> f64 {
    if c.stiffness > 0.0 {
        (c.inertia / c.stiffness).sqrt()
    } else if c.damping > 0.0 {
        c.inertia / c.damping
    } else {
        1.0
    }
}

/// Positions change gaps by lever arms: a tolerance on gaps relative to the size, seen by each coordinate.
pub(crate) fn position_scales(world: &World) -> Vec<f64> {
    let mut arms = vec![0.0f64; world.system.coordinates.len()];
    for arm in world.arms.iter().flatten() {
        arms[arm.coordinate] = arms[arm.coordinate].max(arm.length);
    }
    arms.iter().map(|&a| if a > 0.0 { world.system.size / a } else { 1.0 }).collect()
}

fn find_candidate(world: &World, id: ContactId) -> Option<mainspring_mechanism::Candidate> {
    world.listed(id.interaction as usize).iter().copied().find(|c| c.id == id)
}
