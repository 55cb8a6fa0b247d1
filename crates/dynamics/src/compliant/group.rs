//! The coordinates that the stiff solver moves, and the tips at which contacts act on them.
//!
//! ```text
//! M q̈ = f + Σ l_k G_kᵀ        o_k = −g_k,  ȯ_k = −G_k q̇,  l_k = o_k (E + D M ȯ_k), or 0 where clamped
//! ∂l/∂q = −(E + D M ȯ) G − o D M H q̇        ∂l/∂q̇ = −o D M G        H = ∂²g/∂q²
//! ```
//! Which tips there are and which are clamped is explicit state; the law is carried on smoothly beyond o = 0 and
//! beyond the clamp, and the changes are located on the dense output. Driven coordinates take part by what they are
//! at the time: the derivative of l by time is `∂l/∂q q̇_d + ∂l/∂q̇ q̈_d` over them.

use super::loads::{Loads, Moment};
use super::rosenbrock::{Accelerations, Jacobian};
use super::tip::{Tip, TipState};
use crate::path::DrivenPath;
use crate::world::World;
use mainspring_mechanism::{Candidate, ContactLaw, GapState, Placed, Row, System, gap_state};

/// Coordinates and tips, with room to evaluate them.
#[derive(Clone, Debug)]
pub struct Group<'a> {
    pub system: &'a System,
    pub law: ContactLaw,
    /// Those that move freely: of the tips, and those that masses tie.
    pub coordinates: Vec<usize>,
    /// Those of tips and masses that dry friction holds.
    pub stuck: Vec<usize>,
    pub tips: Vec<Tip>,
    loads: Loads<'a>,
    /// Motions of driven coordinates, each up to where its acceleration jumps.
    pub drives: Vec<(usize, DrivenPath)>,
    /// Places of the system's coordinates in the group; `usize::MAX` for others.
    places: Vec<usize>,
    bodies: Vec<usize>,
    pub placed: Vec<Placed<'a>>,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    /// Accelerations of driven coordinates, and their rates.
    given: Vec<f64>,
    jerk: Vec<f64>,
    /// Gᵀ l.
    pressed: Vec<f64>,
    zeros: Vec<f64>,
    scratch: Vec<f64>,
    /// Gap evaluations so far.
    pub evaluations: u64,
}

impl<'a> Group<'a> {
    /// No contacts.
    pub fn new(world: &World<'a>, law: ContactLaw) -> Self {
        let system = world.system;
        let zeros = vec![0.0; system.coordinates.len()];
        Self {
            system,
            law,
            coordinates: vec![],
            stuck: vec![],
            tips: vec![],
            loads: Loads::new(system),
            drives: vec![],
            places: vec![usize::MAX; zeros.len()],
            bodies: vec![],
            placed: vec![],
            q: zeros.clone(),
            v: zeros.clone(),
            given: zeros.clone(),
            jerk: zeros.clone(),
            pressed: zeros.clone(),
            zeros,
            scratch: vec![],
            evaluations: 0,
        }
    }

    /// Finds the coordinates and bodies of the tips and of coupled masses, at the present state `(q, v)`. To be called
    /// when tips or what is stuck have changed.
    pub fn gather(&mut self, world: &World<'a>, (q, v): (&[f64], &[f64])) {
        self.q.copy_from_slice(q);
        self.v.copy_from_slice(v);
        self.bodies.clear();
        let mut involved: Vec<usize> = Vec::new();
        for k in 0..self.tips.len() {
            let candidate = self.tips[k].candidate;
            let (a, b) = world.bodies(&candidate);
            self.tips[k].sides = (self.place_of(a), self.place_of(b));
            involved.extend(world.coordinates_of(candidate.id));
        }
        involved.extend(self.system.coupled.iter().flat_map(|c| c.coordinates.iter().copied()));
        involved.sort_unstable();
        involved.dedup();
        self.stuck = involved.iter().copied().filter(|&i| world.stuck[i]).collect();
        involved.retain(|&i| !world.free.is_held(i));
        self.coordinates = involved;
        self.places.fill(usize::MAX);
        for (k, &i) in self.coordinates.iter().enumerate() {
            self.places[i] = k;
        }
        self.loads.gather(&self.coordinates, &self.places, |i| world.dry_force(i));
    }

    fn place_of(&mut self, body: usize) -> usize {
        let found = self.bodies.iter().position(|&b| b == body);
        found.unwrap_or_else(|| {
            self.bodies.push(body);
            self.bodies.len() - 1
        })
    }

    /// Moves to time `t` and to positions and velocities of the group's coordinates, given one by one.
    pub fn move_to(&mut self, t: f64, state: impl Fn(usize) -> (f64, f64)) {
        for (i, drive) in &self.drives {
            let (state, acceleration) = drive.state(t);
            (self.q[*i], self.v[*i], self.given[*i]) = (state.q, state.v, acceleration);
        }
        for (k, &i) in self.coordinates.iter().enumerate() {
            (self.q[i], self.v[i]) = state(k);
        }
        self.placed.clear();
        self.placed.extend(self.bodies.iter().map(|&b| Placed::new(&self.system.bodies[b], &self.q)));
    }

    /// The bodies of a tip, where `move_to` put them.
    pub fn sides(&self, tip: &Tip) -> (&Placed<'a>, &Placed<'a>) {
        (&self.placed[tip.sides.0], &self.placed[tip.sides.1])
    }

    /// Evaluates a pair of features of a tip's bodies.
    pub fn gap(&mut self, tip: &Tip, candidate: &Candidate) -> GapState {
        self.evaluations += 1;
        let (a, b) = self.system.interactions[candidate.id.interaction as usize].bodies;
        let first = &self.system.features[a][candidate.id.first as usize];
        let second = &self.system.features[b][candidate.id.second as usize];
        let (pa, pb) = self.sides(tip);
        gap_state(candidate.kind, first, second, &pa.pose, &pb.pose)
    }

    /// Evaluates tip `k` where `move_to` went.
    pub fn state(&mut self, k: usize) -> TipState {
        let tip = self.tips[k];
        let (gap, row) = if let Some(stop) = tip.stop() {
            let stop = &self.system.forces.stops[stop];
            (GapState::of_stop(stop.gap(self.q[stop.coordinate])), Row::single(stop.coordinate, stop.slope()))
        } else {
            let gap = self.gap(&tip, &tip.candidate);
            let (a, b) = self.sides(&tip);
            (gap, gap.row(a, b))
        };
        TipState { gap, row, depth: -gap.gap, rate: -row.dot(&self.v) }
    }

    fn slope(&self, k: usize, rate: f64) -> f64 {
        if self.tips[k].clamped { 0.0 } else { self.law.slope(rate) }
    }

    /// The force of a tip in a state.
    pub fn force_of(&self, k: usize, state: &TipState) -> f64 {
        state.depth * self.slope(k, state.rate)
    }

    /// Energy stored in all tips where `move_to` went.
    pub fn stored(&mut self) -> f64 {
        let law = self.law;
        (0..self.tips.len()).map(|k| law.stored(self.state(k).depth)).sum()
    }

    /// Power lost in all tips where `move_to` went.
    pub fn loss(&self, states: &[TipState]) -> f64 {
        let one = |(tip, s): (&Tip, &TipState)| self.law.loss(s.depth, s.rate, tip.clamped);
        self.tips.iter().zip(states).map(one).sum()
    }

    fn moment(&self) -> Moment<'_> {
        Moment { q: &self.q, v: &self.v, given: &self.given, jerk: &self.jerk }
    }

    /// Accelerations where `move_to` went, by place.
    fn accelerate(&mut self, a: &mut [f64]) {
        self.pressed.fill(0.0);
        for k in 0..self.tips.len() {
            if self.tips[k].clamped {
                continue;
            }
            let state = self.state(k);
            let force = self.force_of(k, &state);
            for (i, g) in state.row.entries() {
                self.pressed[i] += force * g;
            }
        }
        let at = Moment { q: &self.q, v: &self.v, given: &self.given, jerk: &self.jerk };
        self.loads.accelerate(&at, &self.pressed, a);
    }

    /// What each of `held` takes to be held or driven where `move_to` went: `(M q̈ − f − Gᵀ l)_i`.
    pub fn holding(&mut self, held: &[usize]) -> Vec<f64> {
        let mut a = std::mem::take(&mut self.scratch);
        a.resize(self.coordinates.len(), 0.0);
        self.accelerate(&mut a);
        let at = Moment { q: &self.q, v: &self.v, given: &self.given, jerk: &self.jerk };
        let taken = held.iter().map(|&i| self.loads.missing(i, &at, &a) - self.pressed[i]).collect();
        self.scratch = a;
        taken
    }

    /// Accelerations where `move_to` went, by place.
    pub fn present_accelerations(&mut self) -> Vec<f64> {
        let mut a = vec![0.0; self.coordinates.len()];
        self.accelerate(&mut a);
        a
    }

    /// Gᵀ l where `move_to` went, by coordinate of the system.
    pub fn pressed(&mut self) -> &[f64] {
        self.holding(&[]);
        &self.pressed
    }

    /// Power of the drives where `move_to` went but for dry friction.
    pub fn drive_power(&mut self, moving: &[usize]) -> f64 {
        let torque = self.holding(moving);
        moving.iter().zip(torque).map(|(&i, torque)| torque * self.v[i]).sum()
    }

    /// Derivatives of the accelerations `a`, where `accelerations` was called last.
    pub fn jacobian(&mut self, a: &[f64], out: &mut Jacobian) {
        let n = self.coordinates.len();
        for (i, drive) in &self.drives {
            self.jerk[*i] = drive.jerk();
        }
        out.clear(n);
        let at = Moment { q: &self.q, v: &self.v, given: &self.given, jerk: &self.jerk };
        self.loads.differentiate(&at, a, out);
        for k in 0..self.tips.len() {
            self.add_contact(k, n, out);
        }
        self.loads.divide(&mut out.by_position, n);
        self.loads.divide(&mut out.by_velocity, n);
        self.loads.divide(&mut out.by_time, 1);
    }

    fn add_contact(&mut self, k: usize, n: usize, out: &mut Jacobian) {
        if self.tips[k].clamped {
            return;
        }
        let TipState { gap, row, depth, rate } = self.state(k);
        let tip = self.tips[k];
        let mut zeros = std::mem::take(&mut self.zeros);
        let hessian = match tip.stop() {
            Some(_) => mainspring_mechanism::Hessian::default(),
            None => {
                let (a, b) = self.sides(&tip);
                gap.hessian(a, b, &row, &mut zeros)
            }
        };
        self.zeros = zeros;
        let (slope, viscous) = (self.law.slope(rate), depth * self.law.viscosity());
        let force = depth * slope;
        let Moment { v, given, .. } = self.moment();
        for (j, line) in hessian.entries.iter().enumerate().take(row.count) {
            let turning: f64 = row.coordinate.iter().zip(line).take(row.count).map(|(&i, h)| h * v[i]).sum();
            let by_position = -slope * row.value[j] - viscous * turning;
            let by_velocity = -viscous * row.value[j];
            let (c, column) = (row.coordinate[j], self.places[row.coordinate[j]]);
            for (i, bend) in line.iter().enumerate().take(row.count) {
                let place = self.places[row.coordinate[i]];
                if place == usize::MAX {
                    continue;
                }
                let (p, w) = (row.value[i] * by_position + force * bend, row.value[i] * by_velocity);
                if column == usize::MAX {
                    out.by_time[place] += p * v[c] + w * given[c];
                } else {
                    out.by_position[place * n + column] += p;
                    out.by_velocity[place * n + column] += w;
                }
            }
        }
    }
}

impl Accelerations for Group<'_> {
    fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) {
        self.move_to(t, |k| (q[k], v[k]));
        self.accelerate(a);
    }
}
