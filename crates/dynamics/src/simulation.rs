//! A run: flights, rests and integrated stretches from event to event. Contact mode is explicit state.

use crate::chatter::Chatter;
use crate::component::{Component, Tolerance};
use crate::contact::Contact;
use crate::energy::{Energy, friction_loss, kinetic, potential};
use crate::events::{Event, entries};
use crate::flight::{Flight, State};
use crate::halts::{Halts, halted};
use crate::inertia::Inertia;
use crate::minima::{Minimum, MinimumFinder};
use crate::path::{Path, Piece, Trajectory};
use crate::place::is_standing;
use crate::ranges::Track;
use crate::rest::{AT_REST, free_energy, longest_swing, rest_time};
use crate::search::{CLOSED, Stretch, Watch, first_closing};
use crate::settle::{Closed, Group, Instant, Settled, Tie, groups, settle};
use crate::watch::{Change, first_change};
use crate::work::{applied_work, drive_work};
use crate::world::World;
use mainspring_mechanism::{ContactId, ContactSource, Row, System};

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

/// Events allowed without any passage of time.
pub(crate) const MOST_AT_ONCE: u32 = 200;

/// Parts in contact are integrated at least this well: what a step leaves stays far below `OVERLAP`.
const LOOSEST: f64 = 1e-7;

/// The part of a turn of the fastest drive after which what only drives move is looked at again.
const DRIVEN_LOOK: f64 = 0.02;

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
    /// Times in which springs, friction or weight act, by coordinate.
    natural_times: Vec<f64>,
    /// When the acceleration of a drive jumps next.
    next_knot: f64,
    /// Longest time between looks at the motion; infinite unless an observer wants to stop early.
    pub longest_stretch: f64,
    at_once: u32,
    /// A drive runs against what cannot give way.
    jammed: bool,
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
        let initial = kinetic(system, &q, &v) + potential(system, &q);
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
            next_step: 0.05 * natural_times.iter().copied().fold(options.until, f64::min),
            natural_times,
            next_knot: f64::INFINITY,
            longest_stretch: f64::INFINITY,
            at_once: 0,
            jammed: false,
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
        run.energy.kinetic_max = kinetic(system, &run.q, &run.v);
        let driven: f64 = run.world.drives.iter().map(|&(i, _)| own_kinetic(system, i, run.v[i])).sum();
        run.minima.top = (run.energy.kinetic_max - driven).max(0.0);
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
        if change.is_some() || self.t >= self.next_knot || self.slips() {
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
        self.world.drives.iter().any(|d| !self.paths[d.0].is_rest())
    }

    /// Gives every moving component a path beyond the present; returns the end of the common stretch.
    fn integrate(&mut self) -> Option<f64> {
        let end = self.options.until.min(self.next_knot);
        let mut to = end.min(self.t + self.longest_stretch);
        for k in 0..self.components.len() {
            if self.components[k].1 <= self.t {
                let tolerance = Tolerance {
                    relative: self.options.rtol.min(LOOSEST),
                    positions: &self.scales,
                    speeds: &self.speeds,
                    shortest: 16.0 * f64::EPSILON * (1.0 + self.t.abs()),
                };
                let start = (self.t, self.q.as_slice(), self.v.as_slice());
                let longest = self.longest_step(k, end);
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
        Some(to.min(self.t + longest_swing(&self.paths)))
    }

    /// What only drives move has no error to tell how long a step may be.
    fn longest_step(&self, k: usize, end: f64) -> f64 {
        let left = end - self.t;
        if !self.components[k].0.coordinates.is_empty() {
            return left;
        }
        let rate = |&(i, drive): &(usize, &mainspring_mechanism::Drive)| {
            drive.bounds(self.t, end).0 / self.scales[i]
        };
        let fastest = self.world.drives.iter().map(rate).fold(0.0, f64::max);
        left.min(DRIVEN_LOOK * std::f64::consts::TAU / fastest.max(f64::MIN_POSITIVE))
    }

    /// The first thing to happen until `to`: a contact that closes, or a change of the contacts that are closed.
    fn next_event(&mut self, to: f64) -> (f64, Option<Change>) {
        let watched: Vec<(ContactId, Watch)> = self
            .closed
            .iter()
            .map(|c| (c.candidate.id, self.watch_closed(c)))
            .chain(self.released.iter().map(|&(id, floor)| (id, Watch::Released { floor })))
            .collect();
        let stretch = Stretch { paths: &self.paths, components: &self.components, from: self.t, to };
        let speeds = &self.speeds;
        let mut real = |world: &mut World, touch: &crate::world::Touch, q: &[f64], v: &[f64]| {
            is_standing(world, touch, q, v, speeds)
        };
        let found = first_closing(&mut self.world, &stretch, &watched, &mut real);
        let mut to = found.clear_until;
        let mut first = found.closing.map(|c| (c.t, Change::Closing(c.candidate.id)));
        let (world, paths, until) = (&self.world, &self.paths, to);
        let mut halts = Halts { world, paths, from: self.t, to, first: None };
        halts.stops(&watched);
        halts.slides(|i| self.halted(i));
        to = halts.to;
        if to < until {
            first = None;
        }
        first = halts.first.map(|(t, halt)| (t, Change::of_halt(halt))).or(first);
        let stretch = Stretch { paths: &self.paths, components: &self.components, from: self.t, to };
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

    /// A contact that carries no force may have to the next moment, between parts whose motion is exact: it then is as
    /// one released. (Along steps of the integrator gaps are not that exact, and steps are short.)
    fn watch_closed(&self, closed: &Closed) -> Watch {
        let id = closed.candidate.id;
        let stepped = |i: usize| matches!(self.paths[i], Path::Step { .. });
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
        let system = self.world.system;
        self.minima.stretch(system, &self.paths, self.t, t);
        self.energy.friction += friction_loss(system, &self.paths, self.t, t);
        self.energy.work += applied_work(system, &self.paths, self.t, t)
            + drive_work(&mut self.world, &self.components, &self.paths, self.t, t);
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
        if !self.world.drives.is_empty() {
            self.energy.kinetic_max = self.energy.kinetic_max.max(kinetic(system, &self.q, &self.v));
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
            if !active && moving(&self.world, candidate.id, &self.paths) {
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

    /// Resolves impacts, contact forces and dry friction now, logs what changed, and gives every coordinate its path.
    fn resolve(&mut self, change: Option<Change>) {
        self.halt(change);
        let before = self.v.clone();
        let mut v = self.v.clone();
        let mut instant = Instant {
            t: self.t,
            q: &self.q,
            speeds: &self.speeds,
            closed: &self.closed,
            leaving: change.and_then(Change::leaving),
            chattering: (self.at_once > MOST_AT_ONCE / 2).then_some(f64::INFINITY),
            giving: change.and_then(Change::giving),
        };
        let sliding = self.world.sliding.clone();
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
        self.energy.work += settled.work;
        self.energy.impacts += settled.loss;
        if !settled.impulses.is_empty() {
            self.stats.impacts += 1;
            self.minima.impact(settled.loss, self.t);
        }
        if !settled.solved {
            self.at_once = MOST_AT_ONCE + 1;
            self.jammed = !self.world.drives.is_empty();
        }
        for (speed, v) in self.speeds.iter_mut().zip(&self.v) {
            *speed = speed.max(v.abs());
        }
        self.world.set_dry(&settled.stuck, &settled.sliding);
        self.set_drives();
        self.set_modes((&before, &sliding), &settled);
        self.released = settled.opening.iter().map(|&(id, gap)| (id, gap.min(0.0))).collect();
        self.closed = settled.closed;
        let Settled { stuck, sliding, .. } = settled;
        self.modes.push(Mode { from: self.t, closed: self.closed.clone(), stuck, sliding });
    }

    /// Velocities that are zero for dry friction become so.
    fn halt(&mut self, change: Option<Change>) {
        for i in 0..self.v.len() {
            let dry = self.world.system.forces.coulomb[i] > 0.0 && !self.world.moved.is_held(i);
            if dry && (change == Some(Change::Halts(i)) || self.v[i].abs() <= self.halted(i)) {
                self.v[i] = 0.0;
            }
        }
    }

    /// Paths of driven coordinates from now on, and when to look again.
    fn set_drives(&mut self) {
        self.next_knot = self.world.follow_drives(self.t);
        for k in 0..self.world.drives.len() {
            let ((i, _), path) = (self.world.drives[k], self.world.driven[k]);
            let rests = path.is_rest();
            self.set_path(i, if rests { Path::Rest { q: path.at(self.t).q } } else { Path::Driven(path) });
        }
    }

    /// Rest, flight or component for every coordinate that is not driven.
    fn set_modes(&mut self, (before, sliding): (&[f64], &[f64]), settled: &Settled) {
        let active: Vec<&Closed> = settled.closed.iter().filter(|c| c.active).collect();
        let placed = self.world.place_all(&self.q);
        let row = |c: &&Closed| self.world.touch_among(&c.candidate, &self.q, &placed).row();
        let rows: Vec<Row> = active.iter().map(row).collect();
        let mut in_group = vec![false; self.q.len()];
        self.components.clear();
        for group in groups(self.ties(&rows)) {
            group.coordinates.iter().for_each(|&i| in_group[i] = true);
            if self.group_rests(&group, &rows, settled) {
                for &i in &group.coordinates {
                    self.v[i] = 0.0;
                    self.set_path(i, Path::Rest { q: self.q[i] });
                }
                continue;
            }
            let contacts = group.contacts.iter().map(|&k| active[k].candidate).collect();
            for &i in group.coordinates.iter().filter(|&&i| settled.stuck[i]) {
                self.set_path(i, Path::Rest { q: self.q[i] });
            }
            let component = Component::new(&self.world, group.coordinates, contacts, &settled.closed);
            self.components.push((component, self.t));
        }
        let moved = self.world.moved.clone();
        for i in (0..self.q.len()).filter(|&i| !in_group[i] && !moved.is_held(i)) {
            self.set_free(i, before[i], sliding[i], settled);
        }
    }

    /// What ties coordinates that are not driven: contacts that carry force, and masses.
    fn ties(&self, rows: &[Row]) -> Vec<Tie> {
        let moved = &self.world.moved;
        let mut ties: Vec<Tie> = rows.iter().enumerate().map(|(k, row)| Tie::of_row(moved, row, k)).collect();
        for group in &self.world.system.coupled {
            let coordinates = group.coordinates.iter().copied().filter(|&i| !moved.is_held(i)).collect();
            ties.push(Tie { coordinates, contact: None });
        }
        ties
    }

    /// Does a group stay where it is: as many contacts as coordinates that move freely, or no force to move it, and no
    /// drive that moves a part of it? A drive whose lever arm is zero at this instant, as at a dead point, moves it soon.
    fn group_rests(&self, group: &Group, rows: &[Row], settled: &Settled) -> bool {
        let free = group.coordinates.iter().filter(|&&i| !settled.stuck[i]).count();
        let touched = |i: usize| !self.paths[i].is_rest() && self.world.moved.is_held(i);
        let by_contact = group.contacts.iter().any(|&k| rows[k].entries().any(|(i, _)| touched(i)));
        let tied = self.world.system.coupled.iter().map(|c| &c.coordinates);
        let mut tied = tied.filter(|c| c.iter().any(|i| group.coordinates.contains(i)));
        if by_contact || tied.any(|c| c.iter().any(|&i| touched(i))) {
            return false;
        }
        let movable = |k: &&usize| rows[**k].entries().any(|(i, _)| !self.world.free.is_held(i));
        let full = group.contacts.iter().filter(movable).count() >= free;
        full || group.coordinates.iter().all(|&i| self.is_still(i, settled))
    }

    /// Nothing ties coordinate `i`: it flies, or stays where nothing moves it.
    fn set_free(&mut self, i: usize, v_before: f64, sliding_before: f64, settled: &Settled) {
        if settled.stuck[i] || self.is_still(i, settled) {
            self.v[i] = 0.0;
            self.set_path(i, Path::Rest { q: self.q[i] });
            return;
        }
        let flies_on = matches!(self.paths[i], Path::Flight(_))
            && v_before == self.v[i]
            && sliding_before == settled.sliding[i];
        if !flies_on {
            let c = &self.world.system.coordinates[i];
            let state = State { q: self.q[i], v: self.v[i] };
            let force = c.force + self.world.dry_force(i);
            let flight = Flight::new(self.t, state, c.inertia, c.damping, c.stiffness, force);
            self.set_path(i, Path::Flight(flight));
        }
    }

    /// Neither moving nor about to, to rounding.
    fn is_still(&self, i: usize, settled: &Settled) -> bool {
        let acceleration = settled.acceleration[i].abs();
        let limit = if self.world.moved.is_alone(i) {
            let c = &self.world.system.coordinates[i];
            let force = c.force.abs() + (c.stiffness * self.q[i]).abs() + self.world.system.forces.coulomb[i];
            force / c.inertia
        } else {
            settled.weights[i]
        };
        self.v[i].abs() <= 1e-13 * self.speeds[i] && acceleration <= 1e-13 * limit
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
        if self.next_knot < f64::INFINITY || self.drives_move() {
            return false;
        }
        if kinetic(self.world.system, &self.q, &self.v) > level
            || free_energy(&self.world, &self.paths, self.t) > level
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
        if component.forces(&mut self.world, self.t, (&self.q, &self.v), &mut a, |_| {}).is_none() {
            return false;
        }
        let times = component.coordinates.iter().map(|&i| self.natural_times[i]);
        let longest = times.fold(0.0, f64::max);
        let gained: Vec<f64> = a.iter().map(|a| a * longest).collect();
        kinetic(self.world.system, &self.q, &gained) <= level
    }

    /// Shortens a stretch of flights only to the time at which they come to rest.
    fn rest_time(&self, to: f64) -> f64 {
        if !self.components.is_empty() || self.drives_move() || self.next_knot < f64::INFINITY {
            return to;
        }
        rest_time(&self.world, &self.paths, (self.t, to), self.minima.top)
    }

    /// Scales of position and velocity that tolerances are relative to, by coordinate.
    pub fn scales(&self) -> (&[f64], &[f64]) {
        (&self.scales, &self.speeds)
    }

    /// What is left when the run is over.
    pub fn into_run(mut self) -> Run {
        let status = self.status.unwrap_or_else(|| self.end(Status::Stopped));
        Run {
            contact: Contact::Rigid,
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
        self.energy.last =
            kinetic(self.world.system, &self.q, &self.v) + potential(self.world.system, &self.q);
        self.stats.gap_evaluations = self.world.evaluations;
        self.status = Some(status);
        status
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
