//! Contacts at a configuration: evaluated, counted, and kept in lists of those near enough to matter.
//!
//! A list made at configuration q₀ with reach r names every contact whose features were nearer than r. Features
//! move no faster than their lever arms allow, so until the arms have travelled r no other contact can close.

use mainspring_mechanism::{
    Approach, Candidate, ContactSource, Feature, GapState, Placed, Relative, Row, System, approach, gap_state,
};

/// A coordinate that moves one side of an interaction.
#[derive(Clone, Copy, Debug)]
pub struct Arm {
    pub coordinate: usize,
    /// Greatest distance moved per unit of the coordinate (length per radian, or 1).
    pub length: f64,
    /// Turning per unit of the coordinate (|ratio| or 0).
    pub turn: f64,
    /// On the second body?
    pub second: bool,
}

#[derive(Clone, Debug, Default)]
struct NearList {
    /// Positions of the arms' coordinates when the list was made; empty before the first.
    made_at: Vec<f64>,
    candidates: Vec<Candidate>,
    /// Every contact not listed was at least this far apart.
    bound: f64,
}

/// The system with its source of candidates and the work done.
pub struct World<'a> {
    pub system: &'a System,
    source: &'a dyn ContactSource,
    pub arms: Vec<Vec<Arm>>,
    near: Vec<NearList>,
    /// Gap evaluations so far.
    pub evaluations: u64,
    /// Lists made so far.
    pub queries: u64,
}

/// Two bodies of an interaction, placed.
pub type Pair<'a> = (Placed<'a>, Placed<'a>);

/// A contact evaluated between placed bodies.
#[derive(Clone, Copy, Debug)]
pub struct Touch<'p> {
    pub candidate: Candidate,
    pub state: GapState,
    pub placed: (&'p Placed<'p>, &'p Placed<'p>),
}

impl Touch<'_> {
    /// ∂g/∂q.
    pub fn row(&self) -> Row {
        self.state.row(self.placed.0, self.placed.1)
    }

    /// ġ at velocities `v`.
    pub fn rate(&self, v: &[f64]) -> f64 {
        self.state.rate(self.placed.0, self.placed.1, v)
    }

    /// The part of g̈ that accelerations do not cause.
    pub fn bias(&self, v: &[f64]) -> f64 {
        self.state.bias(self.placed.0, self.placed.1, v)
    }

    /// The nearer of the margins to the ends of the features: length along edges, `size`·radians across cones.
    pub fn margin(&self, size: f64) -> f64 {
        self.state.edge_margin.min(self.state.cone_margin * size)
    }
}

impl<'a> World<'a> {
    pub fn new(system: &'a System, source: &'a dyn ContactSource) -> Self {
        let arms: Vec<Vec<Arm>> = (0..system.interactions.len()).map(|i| arms(system, i)).collect();
        let near = vec![NearList::default(); arms.len()];
        Self { system, source, arms, near, evaluations: 0, queries: 0 }
    }

    /// The features of a contact.
    pub fn features(&self, c: &Candidate) -> (&'a Feature, &'a Feature) {
        let bodies = self.bodies(c);
        let lists = (&self.system.features[bodies.0], &self.system.features[bodies.1]);
        (&lists.0[c.id.first as usize], &lists.1[c.id.second as usize])
    }

    /// The bodies of a contact.
    pub fn bodies(&self, c: &Candidate) -> (usize, usize) {
        self.system.interactions[c.id.interaction as usize].bodies
    }

    /// The bodies of a contact at positions `q`.
    pub fn place(&self, c: &Candidate, q: &[f64]) -> Pair<'a> {
        let (a, b) = self.bodies(c);
        let bodies = &self.system.bodies;
        (Placed::new(&bodies[a], q), Placed::new(&bodies[b], q))
    }

    /// Every body at positions `q`.
    pub fn place_all(&self, q: &[f64]) -> Vec<Placed<'a>> {
        self.system.bodies.iter().map(|body| Placed::new(body, q)).collect()
    }

    /// Evaluates a contact between its bodies.
    pub fn touch<'p>(&mut self, c: &Candidate, placed: (&'p Placed<'p>, &'p Placed<'p>)) -> Touch<'p> {
        self.evaluations += 1;
        let (fa, fb) = self.features(c);
        let state = gap_state(c.kind, fa, fb, &placed.0.pose, &placed.1.pose);
        Touch { candidate: *c, state, placed }
    }

    /// Evaluates a contact among all bodies placed.
    pub fn touch_among<'p>(&mut self, c: &Candidate, placed: &'p [Placed<'p>]) -> Touch<'p> {
        let (a, b) = self.bodies(c);
        self.touch(c, (&placed[a], &placed[b]))
    }

    /// Gap and rate of a contact in the relative motion of its bodies.
    pub fn approach(&mut self, c: &Candidate, relative: &Relative) -> Approach {
        self.evaluations += 1;
        let (fa, fb) = self.features(c);
        approach(c.kind, fa, fb, relative)
    }

    /// How far the arms of either side of an interaction have moved since its list was made.
    pub fn travelled(&self, interaction: usize, q: &[f64]) -> [f64; 2] {
        let made_at = &self.near[interaction].made_at;
        if made_at.is_empty() {
            return [f64::INFINITY; 2];
        }
        let mut sides = [0.0; 2];
        for (arm, at) in self.arms[interaction].iter().zip(made_at) {
            sides[usize::from(arm.second)] += arm.length * (q[arm.coordinate] - at).abs();
        }
        sides
    }

    /// Lever arms of a contact's features as shares of the greatest.
    pub fn shares(&self, c: &Candidate) -> [f64; 2] {
        let shares = &self.system.interactions[c.id.interaction as usize].shares;
        [shares.0[c.id.first as usize], shares.1[c.id.second as usize]]
    }

    /// Makes sure that the list of an interaction names every contact nearer than `within` at `q`. Returns how far
    /// the arms have moved since the list was made, and how much further they may move before an unlisted contact
    /// can be nearer than `within`.
    pub fn refresh(&mut self, interaction: usize, q: &[f64], within: f64) -> (f64, f64) {
        let travelled: f64 = self.travelled(interaction, q).iter().sum();
        let room = self.near[interaction].bound - within - travelled;
        // A list about to run out is made again: stretches between lists must not become ever shorter.
        if room > 0.01 * self.system.size {
            return (travelled, room);
        }
        let bodies = self.system.interactions[interaction].bodies;
        let pose = |body: usize| self.system.bodies[body].pose(q);
        let (a, b) = (pose(bodies.0), pose(bodies.1));
        let list = &mut self.near[interaction];
        list.made_at = self.arms[interaction].iter().map(|arm| q[arm.coordinate]).collect();
        // Wider until something is found: a far pair then needs no look for a long time.
        let mut reach = (0.04 * self.system.size).max(2.0 * within);
        for _ in 0..12 {
            list.candidates.clear();
            self.queries += 1;
            self.source.candidates(interaction, &a, &b, reach, &mut list.candidates);
            list.bound = reach;
            if !list.candidates.is_empty() {
                break;
            }
            reach *= 2.0;
        }
        (0.0, list.bound - within)
    }

    /// The contacts listed for an interaction, with a lower bound of the distance of their features when listed.
    pub fn listed(&self, interaction: usize) -> &[Candidate] {
        &self.near[interaction].candidates
    }
}

fn arms(system: &System, interaction: usize) -> Vec<Arm> {
    let it = &system.interactions[interaction];
    let side = |body: usize, levers: &[f64], second: bool| -> Vec<Arm> {
        let chain = &system.bodies[body].chain;
        chain
            .iter()
            .zip(levers)
            .map(|(joint, lever)| {
                let turns = matches!(joint.motion, mainspring_mechanism::Motion::Turn { .. });
                let ratio = joint.ratio.abs();
                let turn = if turns { ratio } else { 0.0 };
                Arm { coordinate: joint.coordinate, length: lever * ratio, turn, second }
            })
            .collect()
    };
    let mut arms = side(it.bodies.0, &it.levers.0, false);
    arms.extend(side(it.bodies.1, &it.levers.1, true));
    arms
}
