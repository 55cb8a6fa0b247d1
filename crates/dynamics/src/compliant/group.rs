//! The coordinates that contacts hold together, and the tips at which they do.
//!
//! ```text
//! M q̈ = f + Σ l_k G_kᵀ        o_k = −g_k,  ȯ_k = −G_k q̇,  l_k = o_k (E + D M ȯ_k), or 0 where clamped
//! ∂l/∂q = −(E + D M ȯ) G − o D M H q̇        ∂l/∂q̇ = −o D M G        H = ∂²g/∂q²
//! ```
//! Which tips there are and which are clamped is explicit state; the law is carried on smoothly beyond o = 0 and
//! beyond the clamp, and the changes are located on the dense output.

use super::loads::{LinearLoads, Loads};
use super::rosenbrock::{Accelerations, Jacobian};
use mainspring_mechanism::{Candidate, ContactLaw, GapState, Placed, Row, System, gap_state};

/// A place where two parts overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// The pair of features that gives the depth.
    pub candidate: Candidate,
    /// Whether the clamp of the law holds its force at zero.
    pub clamped: bool,
    /// Places of its bodies in the group's list.
    sides: (usize, usize),
}

/// A tip at one state.
#[derive(Clone, Copy, Debug)]
pub struct TipState {
    pub gap: GapState,
    pub row: Row,
    pub depth: f64,
    pub rate: f64,
}

/// Coordinates and tips, with room to evaluate them.
#[derive(Clone, Debug)]
pub struct Group<'a> {
    pub system: &'a System,
    pub law: ContactLaw,
    pub coordinates: Vec<usize>,
    pub tips: Vec<Tip>,
    loads: LinearLoads<'a>,
    /// Places of the system's coordinates in the group; `usize::MAX` for others.
    places: Vec<usize>,
    bodies: Vec<usize>,
    pub placed: Vec<Placed<'a>>,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    force: Vec<f64>,
    zeros: Vec<f64>,
    /// Gap evaluations so far.
    pub evaluations: u64,
}

impl<'a> Group<'a> {
    /// No contacts.
    pub fn new(system: &'a System, law: ContactLaw) -> Self {
        let n = system.coordinates.len();
        Self {
            system,
            law,
            coordinates: vec![],
            tips: vec![],
            loads: LinearLoads { system, coordinates: vec![] },
            places: vec![usize::MAX; n],
            bodies: vec![],
            placed: vec![],
            q: vec![0.0; n],
            v: vec![0.0; n],
            force: vec![],
            zeros: vec![0.0; n],
            evaluations: 0,
        }
    }

    /// Adds a tip.
    pub fn add(&mut self, candidate: Candidate) {
        self.tips.push(Tip { candidate, clamped: false, sides: (0, 0) });
        self.gather();
    }

    /// Removes a tip.
    pub fn remove(&mut self, k: usize) -> Candidate {
        let tip = self.tips.remove(k);
        self.gather();
        tip.candidate
    }

    /// Finds the coordinates and bodies of the tips.
    fn gather(&mut self) {
        self.bodies.clear();
        for k in 0..self.tips.len() {
            let (a, b) = self.system.interactions[self.tips[k].candidate.id.interaction as usize].bodies;
            self.tips[k].sides = (self.place_of(a), self.place_of(b));
        }
        let chains = self.bodies.iter().flat_map(|&b| &self.system.bodies[b].chain);
        self.coordinates = chains.map(|joint| joint.coordinate).collect();
        self.coordinates.sort_unstable();
        self.coordinates.dedup();
        self.places.fill(usize::MAX);
        for (k, &i) in self.coordinates.iter().enumerate() {
            self.places[i] = k;
        }
        self.loads.coordinates.clone_from(&self.coordinates);
        self.force.resize(self.coordinates.len(), 0.0);
    }

    fn place_of(&mut self, body: usize) -> usize {
        let found = self.bodies.iter().position(|&b| b == body);
        found.unwrap_or_else(|| {
            self.bodies.push(body);
            self.bodies.len() - 1
        })
    }

    /// Moves to positions and velocities of the group's coordinates, given one by one.
    pub fn move_to(&mut self, state: impl Fn(usize) -> (f64, f64)) {
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
        let gap = self.gap(&tip, &tip.candidate);
        let (a, b) = self.sides(&tip);
        let row = gap.row(a, b);
        let rate = -row.dot(&self.v);
        TipState { gap, row, depth: -gap.gap, rate }
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

    /// Derivatives of the accelerations `a` at time `t` where `move_to` went.
    pub fn jacobian(&mut self, t: f64, a: &[f64], out: &mut Jacobian) {
        let n = self.coordinates.len();
        out.clear(n);
        self.loads.differentiate(t, &self.q, &self.v, a, out);
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
        let (a, b) = self.sides(&tip);
        let hessian = gap.hessian(a, b, &row, &mut zeros).entries;
        self.zeros = zeros;
        let (slope, viscous) = (self.law.slope(rate), depth * self.law.viscosity());
        let force = depth * slope;
        let place = |i: usize| self.places[row.coordinate[i]];
        for (j, line) in hessian.iter().enumerate().take(row.count) {
            let turning: f64 =
                row.coordinate.iter().zip(line).take(row.count).map(|(&i, h)| h * self.v[i]).sum();
            let by_position = -slope * row.value[j] - viscous * turning;
            let by_velocity = -viscous * row.value[j];
            for (i, bend) in line.iter().enumerate().take(row.count) {
                let at = place(i) * n + place(j);
                out.by_position[at] += row.value[i] * by_position + force * bend;
                out.by_velocity[at] += row.value[i] * by_velocity;
            }
        }
    }
}

impl Accelerations for Group<'_> {
    fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) {
        self.move_to(|k| (q[k], v[k]));
        self.force.fill(0.0);
        for k in 0..self.tips.len() {
            if self.tips[k].clamped {
                continue;
            }
            let state = self.state(k);
            let force = self.force_of(k, &state);
            for (i, g) in state.row.entries() {
                self.force[self.places[i]] += force * g;
            }
        }
        self.loads.accelerate(t, &self.q, &self.v, &self.force, a);
    }
}
