//! Minima of the kinetic energy, on the dense motion and at impacts (Gelsey 1995, Sec. 3.1, corrected: never at
//! step ends, since one closed-form step may span seconds).
//!
//! The kinetic energy here is that of what moves freely: the own inertia of driven coordinates is left out, whose motion is
//! prescribed.
//!
//! Zeros of `P = Σ I q̇ q̈ + Σ m ṗ·p̈ + I ω ω̇` (masses on chains in the second sum) are isolated by bisection: a stretch whose middle has `|P|` above the bound of `|Ṗ|` times
//! half its length has none.

use crate::chained::{ChainedMass, chained_masses};
use crate::flight::Bounds;
use crate::linear::Small;
use crate::path::Path;
use crate::root::narrow;
use mainspring_mechanism::{Coordinate, System};

/// A local minimum of the kinetic energy.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    pub t: f64,
    pub energy: f64,
    /// Greatest kinetic energy up to here.
    pub top: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    /// Greatest kinetic energy since the minimum before (or the start).
    pub peak_before: f64,
    /// Whether an impact made it.
    pub at_impact: bool,
}

/// Deepest bisection of one stretch.
const DEEPEST: u32 = 40;
/// Most samples inside one stretch: where strong damping leaves a power of rounding alone, no division ends by itself.
const MOST_SAMPLES: usize = 4000;

/// Kinetic energy below this part of the greatest so far is rounding, and so are its minima.
const FAINT: f64 = 1e-18;

/// Follows the kinetic energy along a run.
#[derive(Clone, Debug, Default)]
pub struct MinimumFinder {
    pub found: Vec<Minimum>,
    /// Greatest kinetic energy so far.
    pub top: f64,
    /// Greatest kinetic energy since the last minimum.
    pub peak: f64,
    /// Whether the energy was last seen falling, and where a flat stretch at the bottom began.
    falling: bool,
    flat_since: Option<f64>,
}

/// A stretch of motion with the system it belongs to.
struct Motion<'a> {
    system: &'a System,
    paths: &'a [Path],
    masses: Small<ChainedMass<'a>, 2>,
}

/// Energy and power (rate of kinetic energy) at one time.
#[derive(Clone, Copy)]
struct Sample {
    t: f64,
    energy: f64,
    power: f64,
}

type Samples = Small<Sample, 16>;

impl MinimumFinder {
    /// Follows one stretch without events inside.
    pub fn stretch(&mut self, system: &System, paths: &[Path], from: f64, to: f64) {
        if to <= from {
            return;
        }
        let motion = Motion { system, paths, masses: chained_masses(system) };
        let (first, last) = (motion.sample(from), motion.sample(to));
        let faint = FAINT * self.top;
        if first.energy < faint && motion.is_faint(from, to, faint) {
            if self.falling {
                self.flat_since.get_or_insert(from);
            }
            return;
        }
        let mut samples: Samples = smallvec::smallvec![first];
        motion.subdivide(first, last, 0, &mut samples);
        samples.push(last);
        for pair in samples.windows(2) {
            self.between(&motion, pair[0], pair[1]);
        }
    }

    /// An impact took kinetic energy at time `t`: the energy fell there.
    pub fn impact(&mut self, loss: f64, t: f64) {
        if loss > 0.0 {
            self.falling = true;
            self.flat_since = Some(t);
        }
    }

    /// The power changes sign at most once between two neighbouring samples.
    fn between(&mut self, motion: &Motion, a: Sample, b: Sample) {
        self.rise_to(a.energy.max(b.energy));
        if a.power < 0.0 && b.power > 0.0 {
            let t = motion.zero(a, b);
            self.record(motion, t, false);
            self.falling = false;
            return;
        }
        if a.power > 0.0 && b.power < 0.0 {
            self.rise_to(motion.sample(motion.zero(b, a)).energy);
        }
        if (a.power > 0.0 || b.power > 0.0) && self.falling && a.power >= 0.0 {
            let impact = self.flat_since.is_some();
            self.record(motion, self.flat_since.unwrap_or(a.t), impact);
            self.falling = false;
        }
        if b.power < 0.0 {
            self.falling = true;
            self.flat_since = None;
        } else if b.power > 0.0 {
            self.falling = false;
            self.flat_since = None;
        } else if self.falling && self.flat_since.is_none() {
            self.flat_since = Some(b.t);
        }
    }

    fn record(&mut self, motion: &Motion, t: f64, at_impact: bool) {
        if self.peak <= FAINT * self.top {
            return;
        }
        let state: Vec<_> = motion.paths.iter().map(|p| p.at(t)).collect();
        let (q, v) = (state.iter().map(|s| s.q).collect(), state.iter().map(|s| s.v).collect::<Vec<f64>>());
        let energy = motion.sample(t).energy;
        self.found.push(Minimum { t, energy, top: self.top, q, v, peak_before: self.peak, at_impact });
        self.peak = energy;
    }

    fn rise_to(&mut self, energy: f64) {
        self.top = self.top.max(energy);
        self.peak = self.peak.max(energy);
    }
}

impl Motion<'_> {
    fn sample(&self, t: f64) -> Sample {
        let (mut energy, mut power) = (0.0, 0.0);
        for (c, path) in self.own().filter(|(_, path)| !path.is_rest()) {
            let (state, acceleration) = path.with_acceleration(t);
            energy += 0.5 * c.inertia * state.v * state.v;
            power += c.inertia * state.v * acceleration;
        }
        for mass in &self.masses {
            let (e, p) = mass.energy_and_power(self.system, self.paths, t);
            energy += e;
            power += p;
        }
        Sample { t, energy, power }
    }

    /// Does the energy stay below a bound? False where masses on chains have a share.
    fn is_faint(&self, from: f64, to: f64, bound: f64) -> bool {
        let most = |(c, path): (&Coordinate, &Path)| {
            let speed = path.bounds(path.at(from), to - from).speed;
            0.5 * c.inertia * speed * speed
        };
        self.masses.is_empty() && self.own().map(most).sum::<f64>() <= bound
    }

    /// Coordinates with inertias of their own that are not driven.
    fn own(&self) -> impl Iterator<Item = (&Coordinate, &Path)> {
        let own = self.system.coordinates.iter().zip(self.paths);
        own.filter(|(_, path)| !matches!(path, Path::Driven(_)))
    }

    /// A bound of |Ṗ| = |Σ I (q̈² + q̇ q⃛)| from `t` for a time `dt`, with the same of masses on chains.
    fn bend(&self, t: f64, dt: f64) -> f64 {
        let one = |(c, path): (&Coordinate, &Path)| {
            let bounds: Bounds = path.bounds(path.at(t), dt);
            c.inertia * (bounds.acceleration * bounds.acceleration + bounds.speed * path.jerk(bounds))
        };
        let chained = self.masses.iter().map(|mass| mass.bend(self.paths, t, dt));
        self.own().map(one).sum::<f64>() + chained.sum::<f64>()
    }

    /// Adds samples between two others until the power changes sign at most once between neighbours.
    fn subdivide(&self, from: Sample, to: Sample, depth: u32, samples: &mut Samples) {
        let middle = self.sample(0.5 * (from.t + to.t));
        let half = 0.5 * (to.t - from.t);
        let bend = self.bend(from.t, to.t - from.t);
        let certain = middle.power.abs() > bend * half;
        let enough = depth >= DEEPEST || samples.len() >= MOST_SAMPLES;
        if certain || enough || half <= 1e-12 * (1.0 + to.t.abs()) {
            samples.push(middle);
            return;
        }
        // Few samples tell the shape of what is smooth.
        let smooth = self.paths.iter().all(|p| p.is_smooth(to.t - from.t));
        let short = (smooth || depth >= 3) && self.is_monotone([from, middle, to], bend);
        if !short {
            self.subdivide(from, middle, depth + 1, samples);
        }
        samples.push(middle);
        if !short {
            self.subdivide(middle, to, depth + 1, samples);
        }
    }

    /// Whether the power changes too little over the stretch for a second sign change to matter: its rate keeps
    /// one sign at five places, three of which are sampled already. `bend` bounds that rate.
    fn is_monotone(&self, [from, middle, to]: [Sample; 3], bend: f64) -> bool {
        let between = |a: Sample, b: Sample| self.sample(0.5 * (a.t + b.t));
        let powers = [from, between(from, middle), middle, between(middle, to), to].map(|s| s.power);
        // Where powers cancel (a frictionless contact) only rounding is left, and it has no shape.
        let noise = 1e-13 * (2.0 * from.energy * bend).sqrt();
        powers.windows(2).all(|p| p[1] >= p[0] - noise) || powers.windows(2).all(|p| p[1] <= p[0] + noise)
    }

    /// The zero of the power between two samples of unlike signs.
    fn zero(&self, from: Sample, to: Sample) -> f64 {
        let (a, b) = narrow(|t| self.sample(t).power, (from.t, from.power), (to.t, to.power));
        if a.1.abs() <= b.1.abs() { a.0 } else { b.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::{DEEPEST, MOST_SAMPLES, Motion, Samples};
    use crate::flight::{Flight, State};
    use crate::path::Path;
    use mainspring_mechanism::{Coordinate, System};

    #[test]
    fn strong_damping_takes_a_bounded_number_of_samples() {
        for damping in [1e3, 1e6, 1e9, 1e12, 1e15] {
            let coordinate = Coordinate {
                name: "part".into(),
                inertia: 1.0,
                damping,
                stiffness: 1e4,
                force: -2.0,
                energy_at_zero: 0.0,
                position: 0.0,
                velocity: 1.0,
            };
            let system = System::new(vec![coordinate], vec![], &[], 1.0);
            let start = State { q: 0.0, v: 1.0 };
            let paths = [Path::Flight(Flight::new(0.0, start, 1.0, damping, 1e4, -2.0))];
            let motion = Motion { system: &system, paths: &paths, masses: super::chained_masses(&system) };
            let mut samples = Samples::new();
            motion.subdivide(motion.sample(0.0), motion.sample(10.0), 0, &mut samples);
            assert!(
                samples.len() <= MOST_SAMPLES + 2 * DEEPEST as usize,
                "damping {damping}: {} samples",
                samples.len()
            );
        }
    }
}
