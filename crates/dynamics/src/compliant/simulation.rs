//! A run with compliant contact: closed-form flights while nothing overlaps, a stiff solver for what does.

use super::changes::{Change, Search};
use super::dry;
use super::group::Group;
use super::steps::{Scales, Stepper};
use super::tip::Tip;
use crate::contact::Contact;
use crate::energy::{kinetic, quadrature};
use crate::events::{Event, EventKind, moving_together};
use crate::flight::{Flight, State};
use crate::halts::{Halt, Halts, halted};
use crate::inertia::Inertia;
use crate::path::{DrivenPath, Path};
use crate::place::is_standing;
use crate::recorder::Recorder;
use crate::rest::{AT_REST, free_energy, longest_swing, rest_time};
use crate::search::{CLOSED, TOGETHER, Watch, first_closing};
use crate::settle::Closed;
use crate::simulation::{DRIVEN_LOOK, MOST_AT_ONCE, Mode, Options, Run, Stats, Status, position_scales};
use crate::world::{Touch, World, stop_candidate};
use mainspring_mechanism::{Candidate, ContactId, ContactLaw, ContactSource, Drive, Overlaps, System};

/// How far outside their cones, in radians, the normals of a second tip of the same piece may point.
const FLUSH: f64 = 0.05;
/// Overlaps deeper than this, relative to the machine's size, are no contact any more: the shapes have lost their
/// meaning.
const DEEPEST: f64 = 0.01;

/// A run in progress.
pub struct Compliant<'a> {
    pub world: World<'a>,
    overlaps: Overlaps<'a>,
    group: Group<'a>,
    options: Options,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub record: Recorder,
    speeds: Vec<f64>,
    scales: Vec<f64>,
    /// Paths for the search for contacts.
    strict: Vec<Path>,
    /// Contacts that parted just now, not to be looked for before a positive gap was seen.
    released: Vec<(ContactId, f64)>,
    stepper: Stepper,
    pairs: Vec<(u32, u32)>,
    /// Times in which springs, friction or weight act, by coordinate.
    natural_times: Vec<f64>,
    /// When the acceleration of a drive jumps next.
    next_knot: f64,
    /// Longest time between looks at the motion; infinite unless an observer wants to stop early.
    pub longest_stretch: f64,
    at_once: u32,
    /// Greatest depth within the last step.
    deepest: f64,
    pub stats: Stats,
    pub status: Option<Status>,
}

/// What happens at the end of a stretch.
#[derive(Clone, Copy)]
enum Next {
    Nothing,
    Close(Candidate),
    Change(Change),
    /// A sliding coordinate halts.
    Halt(usize),
}

impl<'a> Compliant<'a> {
    /// Starts from the system's positions and velocities.
    pub fn new(system: &'a System, source: &'a dyn ContactSource, law: ContactLaw, options: Options) -> Self {
        let (mut q, mut v): (Vec<f64>, Vec<f64>) =
            system.coordinates.iter().map(|c| (c.position, c.velocity)).unzip();
        let world = World::new(system, source);
        for (i, drive) in &world.drives {
            let driven = drive.at(0.0);
            (q[*i], v[*i]) = (driven.q, driven.v);
        }
        let scales = position_scales(&world, &q);
        let natural_times = {
            let inertia = Inertia::whole(system, &world.moved, (&q, &v));
            (0..q.len()).map(|i| inertia.natural_time(i)).collect()
        };
        let own = |i: usize| 0.5 * system.coordinates[i].inertia * v[i] * v[i];
        let driven = world.drives.iter().map(|d| own(d.0)).sum();
        let mut run = Self {
            overlaps: Overlaps::new(system),
            group: Group::new(&world, law),
            record: Recorder::new(system, (&q, &v), driven),
            world,
            speeds: v.iter().map(|v| v.abs()).collect(),
            scales,
            strict: vec![],
            released: vec![],
            stepper: Stepper::default(),
            pairs: vec![],
            natural_times,
            next_knot: f64::INFINITY,
            longest_stretch: f64::INFINITY,
            at_once: 0,
            deepest: 0.0,
            stats: Stats::default(),
            status: None,
            options,
            q,
            v,
        };
        run.touch_at_start();
        run.settle(None);
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
                    self.group.tips.push(Tip::new(candidate));
                }
            }
        }
        for k in self.world.stops() {
            let stop = &self.world.system.forces.stops[k];
            let i = stop.coordinate;
            if stop.gap(self.q[i]) <= within && stop.slope() * self.v[i] <= 0.0 {
                self.group.tips.push(Tip::new(stop_candidate(k)));
            }
        }
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
        if self.stats.steps >= self.options.max_steps || self.at_once > MOST_AT_ONCE {
            return Some(self.end(Status::StepLimit));
        }
        if self.is_at_rest() {
            return Some(self.end(Status::AtRest));
        }
        self.stats.steps += 1;
        let (next, loss, to) = if self.group.coordinates.is_empty() && !self.drives_press() {
            self.fly()
        } else {
            let Some(found) = self.push() else { return Some(self.end(Status::StepLimit)) };
            found
        };
        self.record.energy.impacts += loss;
        self.commit(to);
        self.follow(next);
        if let Some(status) = self.too_deep() {
            return Some(self.end(status));
        }
        self.drop_opened();
        None
    }

    fn follow(&mut self, next: Next) {
        match next {
            Next::Nothing if self.record.t >= self.next_knot => self.settle(None),
            Next::Nothing => {}
            Next::Close(candidate) => self.close(candidate),
            Next::Change(change) => self.change(change),
            Next::Halt(i) => {
                self.v[i] = 0.0;
                self.settle(None);
            }
        }
    }

    /// Do drives alone move what contacts or dry friction hold?
    fn drives_press(&self) -> bool {
        let moves = |d: &(usize, _)| !self.record.paths[d.0].is_rest();
        let held = !self.group.tips.is_empty() || !self.group.stuck.is_empty();
        held && self.world.drives.iter().any(moves)
    }

    /// The longest stretch that may be looked at from now.
    fn horizon(&self) -> f64 {
        let t = self.record.t;
        let end = self.options.until.min(self.next_knot);
        end.min(t + self.longest_stretch)
            .min(t + longest_swing(&self.record.paths))
            .min(self.longest_look(end))
    }

    /// What only drives move has no error to tell how long a step may be.
    fn longest_look(&self, end: f64) -> f64 {
        if !self.group.coordinates.is_empty() || !self.drives_press() {
            return f64::INFINITY;
        }
        let rate = |&(i, drive): &(usize, &Drive)| drive.bounds(self.record.t, end).0 / self.scales[i];
        let fastest = self.world.drives.iter().map(rate).fold(0.0, f64::max);
        self.record.t + DRIVEN_LOOK * std::f64::consts::TAU / fastest.max(f64::MIN_POSITIVE)
    }

    /// The stretch of a flight without contacts: until something happens, or the end.
    fn fly(&mut self) -> (Next, f64, f64) {
        let (t, mut to) = (self.record.t, self.horizon());
        if !self.drives_act() {
            let top = self.record.minima.top.max(self.record.energy.kinetic_max);
            to = rest_time(&self.world, &self.record.paths, (t, to), top);
        }
        let (to, next) = self.first_event(to);
        (next, 0.0, to)
    }

    /// One step of the stiff solver, cut at what happens in it. None if no step is short enough.
    fn push(&mut self) -> Option<(Next, f64, f64)> {
        let t = self.record.t;
        let longest = self.horizon() - t;
        let scales = Scales { rtol: self.options.rtol, positions: &self.scales, speeds: &self.speeds };
        self.stepper.advance(&mut self.group, (t, &self.q, &self.v), longest, &scales)?;
        for (k, &i) in self.group.coordinates.iter().enumerate() {
            self.record.set_path(i, self.stepper.stretch.path(k));
        }
        let h = self.stepper.stretch.h;
        let (found, loss, deepest) = self.search().run();
        self.deepest = deepest;
        let to = t + h * found.map_or(1.0, |f| f.x);
        let (clear, next) = self.first_event(to);
        if clear < to || !matches!(next, Next::Nothing) {
            let mut search = self.search();
            let at_start = search.loss_at(0.0);
            let loss = search.loss_until((clear - t) / h, at_start);
            return Some((next, loss, clear));
        }
        Some((found.map_or(Next::Nothing, |f| Next::Change(f.change)), loss, to))
    }

    fn search(&mut self) -> Search<'_, 'a> {
        Search {
            group: &mut self.group,
            overlaps: &self.overlaps,
            stretch: &self.stepper.stretch,
            pairs: &mut self.pairs,
        }
    }

    /// The first contact or stop to close or slide to halt until `to`, and until when nothing else does.
    fn first_event(&mut self, to: f64) -> (f64, Next) {
        let tips = &self.group.tips;
        let watched: Vec<(ContactId, Watch)> = tips
            .iter()
            .map(|tip| (tip.candidate.id, Watch::Closed))
            .chain(self.released.iter().map(|&(id, floor)| (id, Watch::Released { floor })))
            .collect();
        self.strict.clone_from(&self.record.paths);
        for (k, &i) in self.group.coordinates.iter().enumerate() {
            self.strict[i] = self.stepper.stretch.strict_path(k);
        }
        let t = self.record.t;
        let stretch = crate::search::Stretch { paths: &self.strict, from: t, to };
        let (speeds, overlaps) = (&self.speeds, &self.overlaps);
        let mut real = |world: &mut World, touch: &Touch, q: &[f64], v: &[f64]| {
            let state = &touch.state;
            if state.cone_margin >= 0.0 {
                return is_standing(world, touch, q, v, speeds);
            }
            let id = touch.candidate.id;
            let adjoins = tips.iter().any(|tip| overlaps.adjoin(&tip.candidate.id, &id));
            let follows = || tips.iter().any(|tip| overlaps.follow(&tip.candidate.id, &id));
            state.edge_margin >= 0.0 && state.cone_margin >= -FLUSH && adjoins && !follows()
        };
        let found = first_closing(&mut self.world, &stretch, &watched, &mut real);
        let mut next = found.closing.map_or(Next::Nothing, |c| Next::Close(c.candidate));
        let until = found.clear_until.max(t);
        let (paths, world) = (&self.record.paths, &self.world);
        let mut halts = Halts { world, paths, from: t, to: until, first: None };
        halts.stops(&watched);
        halts.slides(|i| halted(i, &self.scales, speeds));
        if halts.to < until {
            next = Next::Nothing;
        }
        match halts.first {
            Some((_, Halt::Stop(k))) => next = Next::Close(stop_candidate(k)),
            Some((_, Halt::Slide(i))) => next = Next::Halt(i),
            None => {}
        }
        (halts.to.max(t), next)
    }

    /// Moves the present to `t` along the paths.
    fn commit(&mut self, t: f64) {
        let from = self.record.t;
        let work = self.drive_work(from, t);
        self.record.energy.work += work;
        self.record.commit(self.world.system, t, (&mut self.q, &mut self.v));
        for (speed, v) in self.speeds.iter_mut().zip(&self.v) {
            *speed = speed.max(v.abs());
        }
        self.at_once = if t > from { 0 } else { self.at_once + 1 };
        if !self.world.drives.is_empty() {
            let energy = kinetic(self.world.system, &self.q, &self.v);
            self.record.energy.kinetic_max = self.record.energy.kinetic_max.max(energy);
        }
    }

    /// Work of the drives along the paths, by quadrature of their power.
    fn drive_work(&mut self, from: f64, to: f64) -> f64 {
        let paths = &self.record.paths;
        let moving: Vec<usize> =
            self.world.drives.iter().map(|d| d.0).filter(|&i| !paths[i].is_rest()).collect();
        if moving.is_empty() || to <= from {
            return 0.0;
        }
        let (group, system) = (&mut self.group, self.world.system);
        let own = group.coordinates.clone();
        let smooth = quadrature(from, to, |t| {
            group.move_to(t, |k| {
                let State { q, v } = paths[own[k]].at(t);
                (q, v)
            });
            group.drive_power(&moving)
        });
        let dry = |&i: &usize| system.forces.coulomb[i] * (paths[i].at(to).q - paths[i].at(from).q).abs();
        smooth + moving.iter().map(dry).sum::<f64>()
    }

    fn close(&mut self, candidate: Candidate) {
        self.group.tips.push(Tip::new(candidate));
        self.settle(None);
        self.log(EventKind::Close, candidate);
        // A new contact acts at once: begin with a small part of its own time.
        self.stepper.next = f64::INFINITY;
    }

    fn change(&mut self, change: Change) {
        let mut giving = None;
        match change {
            Change::Clamp(k) => self.group.tips[k].clamped ^= true,
            Change::Hand(k, next) => self.hand(k, next.candidate),
            Change::Gives(i, direction) => giving = Some((i, direction)),
            Change::Part(k) | Change::RanOff(k) => {
                let candidate = self.group.tips[k].candidate;
                if matches!(change, Change::RanOff(_)) {
                    self.lose(k);
                }
                self.group.tips.remove(k);
                self.released.push((candidate.id, 0.0));
                self.settle(None);
                return self.log(EventKind::Release, candidate);
            }
        }
        self.settle(giving);
    }

    /// Another pair of features takes over at tip `k`; where it is a tip already the two become one. What they store
    /// less is lost.
    fn hand(&mut self, k: usize, next: Candidate) {
        self.place_group();
        let before = self.group.stored();
        if self.group.tips.iter().any(|tip| tip.candidate.id == next.id) {
            self.group.tips.remove(k);
        } else {
            self.group.tips[k].candidate = next;
        }
        self.record.energy.impacts += before - self.group.stored();
    }

    /// What a tip stores is lost when it runs off.
    fn lose(&mut self, k: usize) {
        self.place_group();
        let depth = self.group.state(k).depth;
        self.record.energy.impacts += self.group.law.stored(depth);
    }

    /// Moves the group to the present.
    fn place_group(&mut self) {
        let (q, v) = (&self.q, &self.v);
        let own = self.group.coordinates.clone();
        self.group.move_to(self.record.t, |i| (q[own[i]], v[own[i]]));
    }

    fn log(&mut self, kind: EventKind, candidate: Candidate) {
        let closed = self.closed();
        let moving_together = moving_together(&self.world, &closed);
        let bodies = self.world.bodies(&candidate);
        let t = self.record.t;
        let event = Event { t, kind, contact: candidate.id, bodies, impulse: 0.0, moving_together };
        self.record.events.push(event);
    }

    /// The contacts that overlap now, with their forces.
    pub fn closed(&mut self) -> Vec<Closed> {
        self.place_group();
        (0..self.group.tips.len())
            .map(|k| {
                let state = self.group.state(k);
                let tip = self.group.tips[k];
                let force = self.group.force_of(k, &state).max(0.0);
                Closed { candidate: tip.candidate, gap: -state.depth, force, active: !tip.clamped }
            })
            .collect()
    }

    /// After something changed: what dry friction holds, paths of what the solver does not move, and the new mode.
    fn settle(&mut self, giving: Option<(usize, f64)>) {
        self.set_drives();
        self.group.gather(&self.world, (&self.q, &self.v));
        if self.world.system.forces.coulomb.iter().any(|size| *size > 0.0) {
            self.settle_dry(giving);
            self.group.gather(&self.world, (&self.q, &self.v));
        }
        for i in 0..self.q.len() {
            if self.world.stuck[i] {
                self.record.set_path(i, Path::Rest { q: self.q[i] });
            } else if !self.world.moved.is_held(i) && !self.group.coordinates.contains(&i) {
                self.set_free(i);
            }
        }
        let closed = self.closed();
        let (stuck, sliding) = (self.world.stuck.clone(), self.world.sliding.clone());
        self.record.modes.push(Mode { from: self.record.t, closed, stuck, sliding });
    }

    fn settle_dry(&mut self, giving: Option<(usize, f64)>) {
        for i in 0..self.q.len() {
            let dry = self.world.system.forces.coulomb[i] > 0.0 && !self.world.moved.is_held(i);
            if dry && self.v[i].abs() <= halted(i, &self.scales, &self.speeds) {
                self.v[i] = 0.0;
            }
        }
        self.place_group();
        let pressed = self.group.pressed().to_vec();
        let now = dry::resolve(&mut self.world, self.record.t, (&self.q, &self.v), &pressed, giving);
        self.world.set_dry(&now.stuck, &now.sliding);
    }

    /// Paths of driven coordinates from now on, and when to look again.
    fn set_drives(&mut self) {
        self.next_knot = f64::INFINITY;
        self.group.drives.clear();
        for k in 0..self.world.drives.len() {
            let (i, drive) = self.world.drives[k];
            let (path, until) = DrivenPath::new(drive, self.record.t);
            let rests = path.is_rest();
            let q = path.at(self.record.t).q;
            self.record.set_path(i, if rests { Path::Rest { q } } else { Path::Driven(path) });
            self.next_knot = self.next_knot.min(until);
            self.group.drives.push((i, path));
        }
    }

    /// Drives move something, or will.
    fn drives_act(&self) -> bool {
        let moves = |d: &(usize, _)| !self.record.paths[d.0].is_rest();
        self.next_knot < f64::INFINITY || self.world.drives.iter().any(moves)
    }

    /// No contact acts on coordinate `i`: it flies, or stays where nothing moves it.
    fn set_free(&mut self, i: usize) {
        let c = &self.world.system.coordinates[i];
        let dry = self.world.system.forces.coulomb[i];
        let force = c.force.abs() + (c.stiffness * self.q[i]).abs() + dry;
        let acceleration = self.world.acceleration_alone(i, self.q[i], self.v[i]);
        let still =
            self.v[i].abs() <= 1e-13 * self.speeds[i] && acceleration.abs() <= 1e-13 * force / c.inertia;
        if still {
            self.v[i] = 0.0;
            self.record.set_path(i, Path::Rest { q: self.q[i] });
            return;
        }
        let slides = self.world.system.forces.coulomb[i] > 0.0;
        if slides || !matches!(self.record.paths[i], Path::Flight(_)) {
            let state = State { q: self.q[i], v: self.v[i] };
            let force = c.force + self.world.dry_force(i);
            let flight = Flight::new(self.record.t, state, c.inertia, c.damping, c.stiffness, force);
            self.record.set_path(i, Path::Flight(flight));
        }
    }

    /// Forgets contacts that parted and are open by now.
    fn drop_opened(&mut self) {
        let open = 8.0 * CLOSED * self.world.system.size;
        for (id, floor) in std::mem::take(&mut self.released) {
            let Some(candidate) = self.world.find(id) else { continue };
            let (a, b) = self.world.place(&candidate, &self.q);
            if self.world.touch_at(&candidate, &self.q, (&a, &b)).state.gap <= open {
                self.released.push((id, floor));
            }
        }
    }

    /// Overlaps that are no contact any more: a drive runs against what cannot give way, or the law is too soft.
    fn too_deep(&self) -> Option<Status> {
        let deep = self.deepest > DEEPEST * self.world.system.size && !self.group.tips.is_empty();
        deep.then_some(if self.drives_act() { Status::Jammed } else { Status::TooDeep })
    }

    /// Everything rests, or moves with next to no energy left above its equilibrium.
    fn is_at_rest(&mut self) -> bool {
        // Motion below the solver's own error is no motion.
        let level = self.options.rtol.powi(2).max(AT_REST) * self.record.minima.top;
        if self.drives_act()
            || kinetic(self.world.system, &self.q, &self.v) > level
            || free_energy(&self.world, &self.record.paths, self.record.t) > level
        {
            return false;
        }
        // Would the accelerations, over the times of the springs, give it no more energy?
        self.place_group();
        let accelerations = self.group.present_accelerations();
        let mut gained = vec![0.0; self.q.len()];
        let times = self.group.coordinates.iter().map(|&i| self.natural_times[i]);
        let longest = times.fold(0.0, f64::max);
        for (&i, a) in self.group.coordinates.iter().zip(accelerations) {
            gained[i] = a * longest;
        }
        kinetic(self.world.system, &self.q, &gained) <= level
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

    fn end(&mut self, status: Status) -> Status {
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
