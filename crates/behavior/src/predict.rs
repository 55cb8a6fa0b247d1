//! Runs a machine until it is known what it will do (Gelsey 1995, Sec. 3.1, Algorithm 12, corrected).
//!
//! Three series of points are followed at once: minima of the kinetic energy in the lowest fraction of its range; any
//! prominent minima; whole turns of a coordinate. A later series counts only if no point of an earlier one falls into
//! the instances that support its pattern. The kinetic energy is that of what moves freely: the motion of drives is
//! given. While a table still has points ahead nothing is concluded, for what comes is not in the state.

use crate::hypothesis::{Hypothesis, Pattern, Point, Series};
use crate::options::PredictOptions;
use crate::passages::whole_turns;
use crate::terms::{Floors, Label, Terms};
use mainspring_dynamics::{Closed, Engine, Minimum, Options, Ranges, Run, Status, Track, start};
use mainspring_mechanism::{ContactSource, Coordinate, Drive, Motion, System};
use std::f64::consts::TAU;

/// What kind of points a pattern was read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Minima in the lowest P_range_fraction of the kinetic energy.
    LowMinima,
    /// Minima by prominence: at least a hundredth of the greatest kinetic energy deep on both sides.
    ProminentMinima,
    /// Whole turns of a coordinate.
    Passages,
}

/// Why nothing was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPattern {
    ConstantKineticEnergy,
    TooManyMinima,
    TooLong,
    StepLimit,
    /// A drive runs against parts that cannot give way.
    Jammed,
    /// Parts overlap too deeply for compliant contact to mean anything.
    TooDeep,
}

/// What the machine will do.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    Repeats {
        pattern: Pattern,
        basis: Basis,
        start: Point,
    },
    /// `held` lists the contacts that carry force; `jammed` if a spring still drives a part that they hold.
    ComesToRest {
        t: f64,
        held: Vec<Closed>,
        jammed: bool,
    },
    NoPattern(NoPattern),
    Stopped,
}

/// A prediction with the run it is based on.
#[derive(Clone, Debug)]
pub struct Prediction {
    pub outcome: Outcome,
    pub hypotheses: Vec<Hypothesis>,
    pub run: Run,
}

/// Depth of a prominent minimum as a fraction of the greatest kinetic energy.
const PROMINENCE: f64 = 0.01;

/// How many floors a coordinate must range for changes to tell anything.
const CLEARLY: f64 = 10.0;

/// Predicts what the machine will do from its state at t = 0. `progress` is told the time and may answer false.
pub fn predict(
    system: &System,
    source: &dyn ContactSource,
    options: &PredictOptions,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Prediction {
    let limits = Options { until: options.max_time, rtol: options.rtol, max_steps: options.max_steps };
    let mut run = start(system, source, options.contact, limits);
    let looks = look_every(system);
    run.observe(looks);
    let mut follower = Follower::new(system, &*run, options);
    let outcome = loop {
        if let Some(status) = run.advance() {
            break follower.ended(&mut *run, status);
        }
        if let Some(outcome) = follower.follow(&mut *run, looks) {
            break outcome;
        }
        if !progress(run.now().0) {
            break Outcome::Stopped;
        }
    };
    let hypotheses = follower.hypotheses(&outcome, run.now().0);
    Prediction { outcome, hypotheses, run: run.finish() }
}

/// Why a hypothesis that nothing contradicted does not hold; None where one does.
fn fall(outcome: &Outcome) -> Option<&'static str> {
    match outcome {
        Outcome::Repeats { .. } => None,
        Outcome::ComesToRest { .. } => Some("the machine came to rest"),
        Outcome::NoPattern(NoPattern::ConstantKineticEnergy) => Some("the kinetic energy never changed"),
        Outcome::NoPattern(NoPattern::Jammed) => Some("the machine jammed"),
        Outcome::NoPattern(_) | Outcome::Stopped => Some("the search ended before it was confirmed"),
    }
}

/// How long to run between looks: twenty of the machine's longest own times.
fn look_every(system: &System) -> f64 {
    let own = |c: &Coordinate| {
        if c.stiffness > 0.0 {
            TAU * (c.inertia / c.stiffness).sqrt()
        } else if c.damping > 0.0 {
            c.inertia / c.damping
        } else if c.velocity != 0.0 {
            TAU / c.velocity.abs()
        } else {
            0.0
        }
    };
    let drives = system.forces.drives.iter().flatten().map(|drive| match drive {
        Drive::Speed { speed, .. } if *speed != 0.0 => TAU / speed.abs(),
        _ => 0.0,
    });
    let longest = system.coordinates.iter().map(own).chain(drives).fold(0.0, f64::max);
    if longest > 0.0 { 20.0 * longest } else { f64::INFINITY }
}

/// The time of a drive's last point; 0 for a constant speed.
fn last_point(drive: &Drive) -> f64 {
    match drive {
        Drive::Speed { .. } => 0.0,
        Drive::Table(table) => table.points().last().map_or(0.0, |p| p.0),
    }
}

struct Follower<'o> {
    options: &'o PredictOptions,
    system: &'o System,
    names: Vec<Label>,
    /// Of each coordinate the changes after which its shapes look the same.
    periods: Vec<Vec<f64>>,
    /// One for each basis, in its order.
    series: [Series; 3],
    /// Ranges since the last point of each series.
    ranges: [Ranges; 3],
    /// Minima taken in so far, and the last one that may turn out prominent.
    seen: usize,
    waiting: Option<Minimum>,
    /// Coordinates that may complete whole turns, and where they started.
    turning: Vec<usize>,
    /// Positions at the start.
    origins: Vec<f64>,
    least_energy: f64,
    /// Last point of any table.
    tables_end: f64,
}

impl<'o> Follower<'o> {
    fn new(system: &'o System, run: &dyn Engine, options: &'o PredictOptions) -> Self {
        let n = system.coordinates.len();
        let turns = |i: &usize| {
            let joints = system.bodies.iter().flat_map(|b| &b.chain);
            joints.filter(|j| j.coordinate == *i).any(|j| matches!(j.motion, Motion::Turn { .. }))
        };
        Self {
            options,
            system,
            names: (0..n)
                .map(|i| Label { name: system.coordinates[i].name.clone(), turns: turns(&i) })
                .collect(),
            periods: system.shape_periods(),
            series: std::array::from_fn(|_| Series::default()),
            ranges: std::array::from_fn(|_| Ranges::empty(n)),
            seen: 0,
            waiting: None,
            turning: (0..n).filter(turns).collect(),
            origins: run.now().1.to_vec(),
            least_energy: run.energy().kinetic_max,
            tables_end: system.forces.drives.iter().flatten().map(last_point).fold(0.0, f64::max),
        }
    }

    /// Takes in the last stretch; an outcome once there is one.
    fn follow(&mut self, run: &mut dyn Engine, looks: f64) -> Option<Outcome> {
        let track = run.track().take()?;
        self.ranges.iter_mut().for_each(|r| r.merge(&track.ranges));
        let outcome = self.take_minima(run).or_else(|| self.take_turns(run, &track));
        let (t, q, v) = run.now();
        let energy = mainspring_dynamics::kinetic(self.system, q, v);
        self.least_energy = self.least_energy.min(energy);
        *run.track() = Some(Track { ranges: Ranges::empty(self.names.len()), ..track });
        // Tested before any fallback: energy that never changes gives nothing to go by.
        let quiet = self.series[0].points.is_empty() && self.series[1].points.is_empty();
        if outcome.is_none() && quiet && t >= self.tables_end && t >= 2.0 * looks && self.is_constant(run) {
            return Some(Outcome::NoPattern(NoPattern::ConstantKineticEnergy));
        }
        let most = self.options.max_minima;
        let full = self.series.iter().any(|s| s.points.len() >= most);
        outcome.or_else(|| full.then_some(Outcome::NoPattern(NoPattern::TooManyMinima)))
    }

    fn take_minima(&mut self, run: &dyn Engine) -> Option<Outcome> {
        while self.seen < run.minima().found.len() {
            let minimum = run.minima().found[self.seen].clone();
            self.seen += 1;
            if minimum.energy < self.options.matching.range_fraction * minimum.top {
                let found = self.add(Basis::LowMinima, minimum.t, minimum.q.clone(), minimum.v.clone(), run);
                if found.is_some() {
                    return found;
                }
            }
            if let Some(prominent) = self.prominent(minimum) {
                let found = self.add(Basis::ProminentMinima, prominent.t, prominent.q, prominent.v, run);
                if found.is_some() {
                    return found;
                }
            }
        }
        None
    }

    /// Passes on the minimum before once the energy has risen enough after it; of minima with a low pass between
    /// them only the lowest stays.
    fn prominent(&mut self, next: Minimum) -> Option<Minimum> {
        let depth = PROMINENCE * next.top;
        let Some(before) = self.waiting.take() else {
            if next.peak_before - next.energy >= depth {
                self.waiting = Some(next);
            }
            return None;
        };
        if next.peak_before - before.energy >= depth {
            if next.peak_before - next.energy >= depth {
                self.waiting = Some(next);
            }
            return Some(before);
        }
        self.waiting = Some(if next.energy < before.energy { next } else { before });
        None
    }

    fn take_turns(&mut self, run: &dyn Engine, track: &Track) -> Option<Outcome> {
        // The coordinate that has turned furthest is the one to go by.
        let travel = |i: &usize| (run.now().1[*i] - self.origins[*i]).abs();
        let i = self.turning.iter().copied().max_by(|a, b| travel(a).total_cmp(&travel(b)).then(b.cmp(a)))?;
        let most = self.options.max_minima;
        for t in whole_turns(&track.paths[i], self.origins[i], track.from, track.to, most) {
            let (q, v) = track.paths.iter().map(|p| p.at(t)).map(|s| (s.q, s.v)).unzip();
            let found = self.add(Basis::Passages, t, q, v, run);
            if found.is_some() {
                return found;
            }
        }
        None
    }

    fn add(&mut self, basis: Basis, t: f64, q: Vec<f64>, v: Vec<f64>, run: &dyn Engine) -> Option<Outcome> {
        if t < self.tables_end {
            return None;
        }
        let k = basis as usize;
        let ranges = std::mem::replace(&mut self.ranges[k], Ranges::empty(self.names.len()));
        let floors = self.floors(run);
        let point = Point { t, q, v, ranges };
        let options = &self.options.matching;
        let terms = Terms { options, labels: &self.names, floors: &floors, periods: &self.periods };
        let pattern = self.series[k].add(point, &terms)?;
        if !self.moves(k, &pattern, &floors) {
            return None;
        }
        // A series counts only where those before it have nothing to say.
        let earlier = self.series[..k].iter().flat_map(|s| &s.points);
        if earlier.filter(|p| p.t >= pattern.since).count() > 0 {
            return None;
        }
        let constant = self.is_constant(run);
        if basis == Basis::Passages && constant {
            return Some(Outcome::NoPattern(NoPattern::ConstantKineticEnergy));
        }
        let start = self.series[k].points[pattern.start].clone();
        Some(Outcome::Repeats { pattern, basis, start })
    }

    /// Does a coordinate range by clearly more than its floor within the pattern? Below that all changes match, and what
    /// is seen is parts that come to rest, compliant contacts that ring.
    fn moves(&self, k: usize, pattern: &Pattern, floors: &Floors) -> bool {
        let points = &self.series[k].points[pattern.start + 1..];
        let mut ranges = Ranges::empty(self.names.len());
        points.iter().for_each(|p| ranges.merge(&p.ranges));
        ranges.q.iter().zip(&floors.q).any(|(range, floor)| range.1 - range.0 > CLEARLY * floor)
    }

    /// Ten integration tolerances.
    fn floors(&self, run: &dyn Engine) -> Floors {
        let (positions, speeds) = run.scales();
        let ten = |x: &f64| 10.0 * self.options.rtol * x;
        Floors { q: positions.iter().map(ten).collect(), v: speeds.iter().map(ten).collect() }
    }

    /// The kinetic energy has stayed the same since the start, and is not zero.
    fn is_constant(&self, run: &dyn Engine) -> bool {
        let top = run.minima().top.max(run.energy().kinetic_max);
        top > 0.0 && top - self.least_energy <= 1e-12 * top
    }

    fn ended(&self, run: &mut dyn Engine, status: Status) -> Outcome {
        match status {
            Status::AtRest => self.at_rest(run),
            Status::Complete if self.is_constant(run) => Outcome::NoPattern(NoPattern::ConstantKineticEnergy),
            Status::Complete => Outcome::NoPattern(NoPattern::TooLong),
            Status::StepLimit => Outcome::NoPattern(NoPattern::StepLimit),
            Status::Jammed => Outcome::NoPattern(NoPattern::Jammed),
            Status::TooDeep => Outcome::NoPattern(NoPattern::TooDeep),
            Status::Stopped => Outcome::Stopped,
        }
    }

    fn at_rest(&self, run: &mut dyn Engine) -> Outcome {
        let held: Vec<Closed> = run.closed().into_iter().filter(|c| c.active).collect();
        let (t, q, _) = run.now();
        let driven = self.system.coordinates.iter().zip(q).any(|(c, q)| {
            let size = c.force.abs() + (c.stiffness * q).abs();
            (c.force - c.stiffness * q).abs() > 1e-6 * size && size > 0.0
        });
        Outcome::ComesToRest { t, jammed: driven && !held.is_empty(), held }
    }

    /// Hypotheses of the series that decided, or of the first that formed any. One that still stood when it turned out
    /// otherwise falls with that.
    fn hypotheses(&self, outcome: &Outcome, end: f64) -> Vec<Hypothesis> {
        if *outcome == Outcome::NoPattern(NoPattern::ConstantKineticEnergy) {
            return vec![];
        }
        let chosen = match outcome {
            Outcome::Repeats { basis, .. } => *basis as usize,
            _ => self.series.iter().position(|s| !s.hypotheses.is_empty()).unwrap_or(0),
        };
        let mut found = self.series[chosen].hypotheses.clone();
        if let Some(why) = fall(outcome) {
            for h in found.iter_mut().filter(|h| h.fell.is_none()) {
                (h.fell, h.why) = (Some(end), Some(why.into()));
            }
        }
        found
    }
}
