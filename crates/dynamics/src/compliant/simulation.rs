//! A run with compliant contact: closed-form flights while nothing overlaps, a stiff solver for what does.

use super::changes::{Change, Search};
use super::ending::DEEPEST;
use super::group::Group;
use super::steps::{Scales, Stepper};
use super::tip::Tip;
use crate::halts::{Halt, Halts, halted};
use crate::inertia::Inertia;
use crate::path::Path;
use crate::place::is_standing;
use crate::recorder::Recorder;
use crate::rest::{longest_swing, rest_time};
use crate::run::{Options, Stats, Status};
use crate::search::{TOGETHER, Watch, first_closing};
use crate::simulation::{MOST_AT_ONCE, position_scales};
use crate::world::{Touch, World, stop_candidate};
use mainspring_mechanism::{Candidate, ContactId, ContactLaw, ContactSource, Drive, Overlaps, System};

/// How far outside their cones, in radians, the normals of a second tip of the same piece may point.
const FLUSH: f64 = 0.05;

/// Where drives act, steps are held to this share of the tolerance, as with rigid contact; stiff contacts pass on more.
const DRIVEN_SHARE: f64 = 0.01;

/// A run in progress.
pub struct Compliant<'a> {
    pub world: World<'a>,
    pub(super) overlaps: Overlaps<'a>,
    pub(super) group: Group<'a>,
    pub(super) options: Options,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub record: Recorder,
    pub(super) speeds: Vec<f64>,
    pub(super) scales: Vec<f64>,
    /// Paths for the search for contacts.
    pub(super) strict: Vec<Path>,
    /// Contacts that parted just now, not to be looked for before a positive gap was seen.
    pub(super) released: Vec<(ContactId, f64)>,
    pub(super) stepper: Stepper,
    pub(super) pairs: Vec<(u32, u32)>,
    /// Times in which springs, friction or weight act, by coordinate.
    pub(super) natural_times: Vec<f64>,
    /// When the acceleration of a drive jumps next.
    pub(super) next_knot: f64,
    /// Longest time between looks at the motion; infinite unless an observer wants to stop early.
    pub longest_stretch: f64,
    pub(super) at_once: u32,
    /// Greatest depth within the last step that nothing cut short.
    pub(super) deepest: f64,
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

    /// What only drives move has no error to tell how long a step may be: no further than what is too deep.
    fn longest_look(&self, end: f64) -> f64 {
        if !self.group.coordinates.is_empty() || !self.drives_press() {
            return f64::INFINITY;
        }
        let rate = |&(i, drive): &(usize, &Drive)| drive.bounds(self.record.t, end).0 / self.scales[i];
        let fastest = self.world.drives.iter().map(rate).fold(0.0, f64::max);
        self.record.t + DEEPEST / fastest.max(f64::MIN_POSITIVE)
    }

    /// The stretch of a flight without contacts: until something happens, or the end.
    fn fly(&mut self) -> (Next, f64, f64) {
        let (t, mut to) = (self.record.t, self.horizon());
        if !self.drives_act() {
            to = rest_time(&self.world, &self.record.paths, (t, to), self.record.minima.top);
        }
        let (to, next) = self.first_event(to);
        (next, 0.0, to)
    }

    /// One step of the stiff solver, cut at what happens in it. None if no step is short enough.
    fn push(&mut self) -> Option<(Next, f64, f64)> {
        let t = self.record.t;
        let longest = self.horizon() - t;
        let rtol = self.world.tolerance(self.options.rtol, DRIVEN_SHARE);
        let scales = Scales { rtol, positions: &self.scales, speeds: &self.speeds };
        self.stepper.advance(&mut self.group, (t, &self.q, &self.v), longest, &scales)?;
        for (k, &i) in self.group.coordinates.iter().enumerate() {
            self.record.set_path(i, self.stepper.stretch.path(k));
        }
        let h = self.stepper.stretch.h;
        let (found, loss, deepest) = self.search().run();
        let to = t + h * found.map_or(1.0, |f| f.x);
        let (clear, next) = self.first_event(to);
        if clear < to || !matches!(next, Next::Nothing) {
            let mut search = self.search();
            let at_start = search.loss_at(0.0);
            let loss = search.loss_until((clear - t) / h, at_start);
            self.deepest = 0.0;
            return Some((next, loss, clear));
        }
        self.deepest = if found.is_none() { deepest } else { 0.0 };
        Some((found.map_or(Next::Nothing, |f| Next::Change(f.change)), loss, to))
    }

    fn search(&mut self) -> Search<'_, 'a> {
        Search {
            group: &mut self.group,
            overlaps: &self.overlaps,
            stretch: &self.stepper.stretch,
            pairs: &mut self.pairs,
            at: None,
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
        let stretch =
            crate::search::Stretch { paths: &self.strict, components: &[], from: t, to, outside: FLUSH };
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
}
