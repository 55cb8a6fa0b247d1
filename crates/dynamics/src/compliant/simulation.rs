//! A run with compliant contact: closed-form flights while nothing overlaps, a stiff solver for what does.

use super::changes::{Change, Search};
use super::group::Group;
use super::rosenbrock::{Accelerations, Jacobian, Rosenbrock, Start};
use super::stretch::Stretch;
use crate::energy::{Energy, friction_loss, kinetic, potential};
use crate::events::{Event, EventKind, moving_together};
use crate::flight::{Flight, State};
use crate::minima::MinimumFinder;
use crate::path::{Path, Piece, Trajectory};
use crate::place::is_standing;
use crate::ranges::Track;
use crate::search::{CLOSED, TOGETHER, Watch, first_closing};
use crate::settle::Closed;
use crate::simulation::{
    AT_REST, MOST_AT_ONCE, Mode, Options, Run, Stats, Status, natural_time, position_scales,
};
use crate::world::{Touch, World};
use mainspring_mechanism::{Candidate, ContactId, ContactLaw, ContactSource, Overlaps, System};

/// How far outside their cones, in radians, the normals of a second tip of the same piece may point.
const FLUSH: f64 = 0.05;

/// A run in progress.
pub struct Compliant<'a> {
    pub world: World<'a>,
    overlaps: Overlaps<'a>,
    group: Group<'a>,
    options: Options,
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    speeds: Vec<f64>,
    scales: Vec<f64>,
    paths: Vec<Path>,
    /// The same for the search for contacts.
    strict: Vec<Path>,
    since: Vec<f64>,
    /// Contacts that parted just now, not to be looked for before a positive gap was seen.
    released: Vec<(ContactId, f64)>,
    modes: Vec<Mode>,
    step: Rosenbrock,
    jacobian: Jacobian,
    stretch: Stretch,
    next_step: f64,
    pairs: Vec<(u32, u32)>,
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
    /// Steps tried and not taken.
    pub rejected: u64,
    pub status: Option<Status>,
}

/// What happens at the end of a stretch.
enum Next {
    Nothing,
    Close(Candidate),
    Change(Change),
}

impl<'a> Compliant<'a> {
    /// Starts from the system's positions and velocities.
    pub fn new(system: &'a System, source: &'a dyn ContactSource, law: ContactLaw, options: Options) -> Self {
        let (q, v): (Vec<f64>, Vec<f64>) =
            system.coordinates.iter().map(|c| (c.position, c.velocity)).unzip();
        let n = q.len();
        let world = World::new(system, source);
        let scales = position_scales(&world, &q);
        let initial = kinetic(system, &q, &v) + potential(system, &q);
        let mut run = Self {
            world,
            overlaps: Overlaps::new(system),
            group: Group::new(system, law),
            t: 0.0,
            speeds: v.iter().map(|v| v.abs()).collect(),
            scales,
            paths: q.iter().map(|&q| Path::Rest { q }).collect(),
            strict: vec![],
            since: vec![0.0; n],
            released: vec![],
            modes: vec![],
            step: Rosenbrock::default(),
            jacobian: Jacobian::default(),
            stretch: Stretch::default(),
            next_step: f64::INFINITY,
            pairs: vec![],
            longest_stretch: f64::INFINITY,
            at_once: 0,
            trajectory: Trajectory { pieces: vec![vec![]; n], times: vec![0.0] },
            events: vec![],
            energy: Energy { initial, last: initial, ..Energy::default() },
            minima: MinimumFinder::default(),
            track: None,
            stats: Stats::default(),
            rejected: 0,
            status: None,
            options,
            q,
            v,
        };
        run.energy.kinetic_max = kinetic(system, &run.q, &run.v);
        run.minima.top = run.energy.kinetic_max;
        run.touch_at_start();
        run.regroup();
        run
    }

    /// Contacts that touch at the start and are not opening.
    fn touch_at_start(&mut self) {
        let within = TOGETHER * self.world.system.size;
        for interaction in 0..self.world.arms.len() {
            self.world.refresh(interaction, &self.q, 2.0 * within);
            for k in 0..self.world.listed(interaction).len() {
                let candidate = self.world.listed(interaction)[k];
                let (a, b) = self.world.place(&candidate, &self.q);
                let touch = self.world.touch(&candidate, (&a, &b));
                if touch.state.gap.abs() <= within
                    && touch.rate(&self.v) <= 0.0
                    && is_standing(&mut self.world, &touch, &self.q, &self.v, &self.speeds)
                {
                    self.group.add(candidate);
                }
            }
        }
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
        let (next, loss, to) = if self.group.tips.is_empty() {
            self.fly()
        } else {
            let Some(found) = self.push() else { return Some(self.end(Status::StepLimit)) };
            found
        };
        self.energy.impacts += loss;
        self.commit(to);
        match next {
            Next::Nothing => {}
            Next::Close(candidate) => self.close(candidate),
            Next::Change(change) => self.change(change),
        }
        self.drop_opened();
        None
    }

    /// The stretch of a flight without contacts: until something closes, or the end.
    fn fly(&mut self) -> (Next, f64, f64) {
        let to = self.options.until.min(self.t + self.longest_stretch).min(self.t + self.longest_swing());
        let to = self.rest_time(to);
        let (to, closing) = self.first_closing(to);
        (closing.map_or(Next::Nothing, Next::Close), 0.0, to)
    }

    /// One step of the stiff solver, cut at what happens in it. None if no step is short enough.
    fn push(&mut self) -> Option<(Next, f64, f64)> {
        self.try_steps()?;
        for (k, &i) in self.group.coordinates.clone().iter().enumerate() {
            self.set_path(i, self.stretch.path(k));
        }
        let mut search = Search {
            group: &mut self.group,
            overlaps: &self.overlaps,
            stretch: &self.stretch,
            pairs: &mut self.pairs,
        };
        let (found, loss) = search.run();
        let to = self.t + self.stretch.h * found.map_or(1.0, |f| f.x);
        let (clear, closing) = self.first_closing(to);
        if closing.is_some() || clear < to {
            let x = (clear - self.t) / self.stretch.h;
            let mut search = Search {
                group: &mut self.group,
                overlaps: &self.overlaps,
                stretch: &self.stretch,
                pairs: &mut self.pairs,
            };
            let at_start = search.loss_at(0.0);
            let loss = search.loss_until(x, at_start);
            return Some((closing.map_or(Next::Nothing, Next::Close), loss, clear));
        }
        Some((found.map_or(Next::Nothing, |f| Next::Change(f.change)), loss, to))
    }

    /// Finds a step that fits the tolerance and takes it into `stretch`. None if none does.
    fn try_steps(&mut self) -> Option<()> {
        let own =
            |list: &[f64], group: &Group| group.coordinates.iter().map(|&i| list[i]).collect::<Vec<_>>();
        let (q, v) = (own(&self.q, &self.group), own(&self.v, &self.group));
        let mut a = vec![0.0; q.len()];
        self.step.resize(q.len());
        self.group.accelerations(self.t, &q, &v, &mut a);
        self.group.jacobian(self.t, &a, &mut self.jacobian);
        let start = Start { t: self.t, q: &q, v: &v, a: &a };
        let shortest = 16.0 * f64::EPSILON * (1.0 + self.t.abs());
        let mut h = self.next_step.min(self.longest_stretch).min(self.options.until - self.t);
        if !h.is_finite() || self.next_step == f64::INFINITY {
            h = h.min(0.1 / self.stiffness());
        }
        loop {
            if h < shortest && h < self.options.until - self.t {
                return None;
            }
            let solved = self.step.attempt(&mut self.group, &start, &self.jacobian, h);
            let error = if solved { self.error(&a, h) } else { f64::INFINITY };
            let factor = if error.is_finite() { (0.9 * error.powf(-0.2)).clamp(0.2, 4.0) } else { 0.1 };
            if error <= 1.0 {
                self.next_step = h * factor;
                self.stretch.set(&self.step, &start, h);
                return Some(());
            }
            self.rejected += 1;
            h *= factor.min(0.7);
        }
    }

    /// Greatest rate of the group's own motion: √ of the stiffest diagonal entry.
    fn stiffness(&self) -> f64 {
        let n = self.group.coordinates.len();
        let greatest = (0..n).map(|k| self.jacobian.by_position[k * n + k].abs()).fold(0.0, f64::max);
        greatest.sqrt().max(f64::MIN_POSITIVE)
    }

    /// Estimated error of the last step relative to the tolerance: velocities against the greatest speeds, positions
    /// against what these speeds cover in the time of the contact's own oscillation.
    fn error(&self, a: &[f64], h: f64) -> f64 {
        let (e_q, e_v) = self.step.error();
        let n = self.group.coordinates.len();
        let mut sum = 0.0;
        for (k, &i) in self.group.coordinates.iter().enumerate() {
            let rate = self.jacobian.by_position[k * n + k].abs().sqrt();
            let speed = self.speeds[i].max(self.step.end_v[k].abs()).max(a[k].abs() * h);
            let speed = speed.max(f64::MIN_POSITIVE);
            let reach = (speed / rate.max(f64::MIN_POSITIVE)).min(self.scales[i]);
            let (x, y) = (e_q[k] / reach, e_v[k] / speed);
            sum += x * x + y * y;
        }
        (sum / (2 * n) as f64).sqrt() / self.options.rtol
    }

    /// The first contact to close until `to`, and until when nothing else does.
    fn first_closing(&mut self, to: f64) -> (f64, Option<Candidate>) {
        let watched: Vec<(ContactId, Watch)> = self
            .group
            .tips
            .iter()
            .map(|tip| (tip.candidate.id, Watch::Closed))
            .chain(self.released.iter().map(|&(id, floor)| (id, Watch::Released { floor })))
            .collect();
        self.strict.clone_from(&self.paths);
        if !self.group.tips.is_empty() {
            for (k, &i) in self.group.coordinates.iter().enumerate() {
                self.strict[i] = self.stretch.strict_path(k);
            }
        }
        let stretch = crate::search::Stretch { paths: &self.strict, components: &[], from: self.t, to };
        let (speeds, overlaps, tips) = (&self.speeds, &self.overlaps, &self.group.tips);
        let mut real = |world: &mut World, touch: &Touch, q: &[f64], v: &[f64]| {
            let state = &touch.state;
            if state.cone_margin >= 0.0 {
                return is_standing(world, touch, q, v, speeds);
            }
            let id = touch.candidate.id;
            let second = || tips.iter().any(|tip| overlaps.adjoin(&tip.candidate.id, &id));
            state.edge_margin >= 0.0 && state.cone_margin >= -FLUSH && second()
        };
        let found = first_closing(&mut self.world, &stretch, &watched, &mut real);
        (found.clear_until.max(self.t), found.closing.map(|c| c.candidate))
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
    }

    fn close(&mut self, candidate: Candidate) {
        self.group.add(candidate);
        self.regroup();
        self.log(EventKind::Close, candidate);
        // A new contact acts at once: begin with a small part of its own time.
        self.next_step = f64::INFINITY;
    }

    fn change(&mut self, change: Change) {
        match change {
            Change::Clamp(k) => self.group.tips[k].clamped ^= true,
            Change::Hand(k, next) => self.group.tips[k].candidate = next.candidate,
            Change::Part(k) | Change::RanOff(k) => {
                let candidate = self.group.tips[k].candidate;
                if matches!(change, Change::RanOff(_)) {
                    self.lose(k);
                }
                self.group.remove(k);
                self.released.push((candidate.id, 0.0));
                self.log(EventKind::Release, candidate);
            }
        }
        self.regroup();
    }

    /// What a tip stores is lost when it runs off.
    fn lose(&mut self, k: usize) {
        let (q, v) = (&self.q, &self.v);
        let own = self.group.coordinates.clone();
        self.group.move_to(|i| (q[own[i]], v[own[i]]));
        let depth = self.group.state(k).depth;
        self.energy.impacts += self.group.law.stored(depth);
    }

    fn log(&mut self, kind: EventKind, candidate: Candidate) {
        let closed = self.closed();
        let moving_together = moving_together(&self.world, &closed);
        let bodies = self.world.bodies(&candidate);
        self.events.push(Event {
            t: self.t,
            kind,
            contact: candidate.id,
            bodies,
            impulse: 0.0,
            moving_together,
        });
    }

    /// Contact modes so far.
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// The contacts that overlap now, with their forces.
    pub fn closed(&mut self) -> Vec<Closed> {
        let (q, v) = (&self.q, &self.v);
        let own = self.group.coordinates.clone();
        self.group.move_to(|i| (q[own[i]], v[own[i]]));
        (0..self.group.tips.len())
            .map(|k| {
                let state = self.group.state(k);
                let tip = self.group.tips[k];
                let force = self.group.force_of(k, &state).max(0.0);
                Closed { candidate: tip.candidate, gap: -state.depth, force, active: !tip.clamped }
            })
            .collect()
    }

    /// After contacts changed: what they no longer hold flies or rests, and the mode is noted.
    fn regroup(&mut self) {
        for i in 0..self.q.len() {
            if !self.group.coordinates.contains(&i) {
                self.set_free(i);
            }
        }
        let closed = self.closed();
        let n = self.q.len();
        self.modes.push(Mode { from: self.t, closed, stuck: vec![false; n], sliding: vec![0.0; n] });
    }

    /// No contact acts on coordinate `i`: it flies, or stays where nothing moves it.
    fn set_free(&mut self, i: usize) {
        let c = &self.world.system.coordinates[i];
        let force = c.force.abs() + (c.stiffness * self.q[i]).abs();
        let acceleration = c.free_acceleration(self.q[i], self.v[i]);
        let still =
            self.v[i].abs() <= 1e-13 * self.speeds[i] && acceleration.abs() <= 1e-13 * force / c.inertia;
        if still {
            self.v[i] = 0.0;
            self.set_path(i, Path::Rest { q: self.q[i] });
        } else if !matches!(self.paths[i], Path::Flight(_)) {
            let state = State { q: self.q[i], v: self.v[i] };
            let flight = Flight::new(self.t, state, c.inertia, c.damping, c.stiffness, c.force);
            self.set_path(i, Path::Flight(flight));
        }
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

    /// Forgets contacts that parted and are open by now.
    fn drop_opened(&mut self) {
        let open = 8.0 * CLOSED * self.world.system.size;
        for (id, floor) in std::mem::take(&mut self.released) {
            let listed = self.world.listed(id.interaction as usize);
            let Some(candidate) = listed.iter().copied().find(|c| c.id == id) else { continue };
            let (a, b) = self.world.place(&candidate, &self.q);
            if self.world.touch(&candidate, (&a, &b)).state.gap <= open {
                self.released.push((id, floor));
            }
        }
    }

    /// Everything rests, or moves with next to no energy left above its equilibrium.
    fn is_at_rest(&mut self) -> bool {
        let level = AT_REST * self.minima.top;
        if kinetic(self.world.system, &self.q, &self.v) > level || self.free_energy(self.t) > level {
            return false;
        }
        if self.group.tips.is_empty() {
            return true;
        }
        let own = self.group.coordinates.clone();
        let (q, v): (Vec<f64>, Vec<f64>) = own.iter().map(|&i| (self.q[i], self.v[i])).unzip();
        let mut a = vec![0.0; own.len()];
        self.group.accelerations(self.t, &q, &v, &mut a);
        let of = |i: &usize| &self.world.system.coordinates[*i];
        let square = own.iter().map(|i| natural_time(of(i)).powi(2)).fold(0.0, f64::max);
        own.iter().zip(&a).map(|(i, a)| 0.5 * of(i).inertia * a * a * square).sum::<f64>() <= level
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

    /// Shortens a stretch of flights to the time at which they come to rest.
    fn rest_time(&self, to: f64) -> f64 {
        let top = self.minima.top.max(self.energy.kinetic_max);
        let level = AT_REST * if top > 0.0 { top } else { self.free_energy(self.t) };
        if level <= 0.0 || !level.is_finite() || self.free_energy(to) > level {
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

    /// What is left when the run is over.
    pub fn into_run(mut self) -> Run {
        let status = self.status.unwrap_or_else(|| self.end(Status::Stopped));
        let closed = self.closed();
        Run {
            status,
            t: self.t,
            q: self.q,
            v: self.v,
            closed,
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
        self.closed();
        self.energy.contact_stored = self.group.stored();
        self.stats.gap_evaluations = self.world.evaluations + self.group.evaluations;
        self.status = Some(status);
        status
    }
}
