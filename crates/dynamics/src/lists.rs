//! Lists of the contacts that are near, made again as the parts move.
//!
//! A list made at configuration q₀ with reach r names every contact whose features were nearer than r. Features move no
//! faster than their lever arms allow, so until the arms have travelled r no other contact can close.

use crate::world::Arm;
use mainspring_mechanism::{Candidate, ContactSource, System};

/// Reach of a list, relative to the machine's size.
const REACH: f64 = 0.04;
/// A list is made again when there is no more room in it than this, relative to the machine's size: stretches between lists
/// must not become ever shorter.
const LITTLE: f64 = 0.01;

/// The contacts near at one configuration.
#[derive(Clone, Debug, Default)]
struct List {
    /// Positions of the arms' coordinates when the list was made; empty before the first.
    made_at: Vec<f64>,
    candidates: Vec<Candidate>,
    /// Every contact not listed was at least this far apart.
    bound: f64,
}

impl List {
    /// How far the arms of either side have moved since the list was made.
    fn travelled(&self, arms: &[Arm], q: &[f64]) -> [f64; 2] {
        if self.made_at.is_empty() {
            return [f64::INFINITY; 2];
        }
        let mut sides = [0.0; 2];
        for (arm, at) in arms.iter().zip(&self.made_at) {
            let length = arm.reach(|k| q[arms[k].coordinate].abs().max(self.made_at[k].abs()));
            sides[usize::from(arm.second)] += length * (q[arm.coordinate] - at).abs();
        }
        sides
    }

    /// Empties the list for one of this reach at `q`.
    fn begin(&mut self, arms: &[Arm], q: &[f64], reach: f64) {
        self.made_at.clear();
        self.made_at.extend(arms.iter().map(|arm| q[arm.coordinate]));
        self.candidates.clear();
        self.bound = reach;
    }
}

/// The lists of every interaction, and where they come from.
pub struct Lists<'a> {
    system: &'a System,
    source: &'a dyn ContactSource,
    near: Vec<List>,
    /// How often the source was asked.
    pub queries: u64,
}

impl<'a> Lists<'a> {
    pub fn new(system: &'a System, source: &'a dyn ContactSource) -> Self {
        Self { system, source, near: vec![List::default(); system.interactions.len()], queries: 0 }
    }

    /// The contacts listed for an interaction, with a lower bound of the distance of their features when listed.
    pub fn of(&self, interaction: usize) -> &[Candidate] {
        &self.near[interaction].candidates
    }

    /// How far the arms of either side of an interaction have moved since its list was made.
    pub fn travelled(&self, interaction: usize, arms: &[Arm], q: &[f64]) -> [f64; 2] {
        self.near[interaction].travelled(arms, q)
    }

    /// Makes sure that the list of an interaction names every contact nearer than `within` at `q`. Returns how far
    /// the arms have moved since the list was made, and how much further they may move before an unlisted contact
    /// can be nearer than `within`.
    pub fn refresh(&mut self, interaction: usize, arms: &[Arm], q: &[f64], within: f64) -> (f64, f64) {
        let list = &mut self.near[interaction];
        let travelled: f64 = list.travelled(arms, q).iter().sum();
        let room = list.bound - within - travelled;
        if room > LITTLE * self.system.size {
            return (travelled, room);
        }
        let (a, b) = self.system.interactions[interaction].bodies;
        let poses = (self.system.bodies[a].pose(q), self.system.bodies[b].pose(q));
        // Wider until something is found: a far pair then needs no look for a long time.
        let mut reach = (REACH * self.system.size).max(2.0 * within);
        for _ in 0..12 {
            list.begin(arms, q, reach);
            self.queries += 1;
            self.source.candidates(interaction, &poses.0, &poses.1, reach, &mut list.candidates);
            if !list.candidates.is_empty() {
                break;
            }
            reach *= 2.0;
        }
        (0.0, list.bound - within)
    }
}
