//! A map of which contacts are near where, over the two coordinates of two bodies: made once, box by box as motion comes by.
//!
//! The plane of two joint positions (x, y) is cut into boxes of one size. A box names every pair of features that come
//! nearer than a reach r₀ anywhere in it, in the order of their identities, with a lower bound of their distance:
//! ```text
//! d(x, y) ≥ d(x₀, y₀) − λ_a |x − x₀| − λ_b |y − y₀|      x₀, y₀ the box's middle
//! ```
//! λ are the features' lever arms. A question is answered from the box by the distance of those pairs alone that can be near
//! enough: no tree is descended, nothing is sorted. What is answered is what direct search answers, bit by bit: candidates
//! decide how far a simulator steps, so a shorter list (only the contacts that bound free space, say) would give motions that
//! differ by rounding.

use mainspring_mechanism::{
    Candidate, ContactSource, DirectSearch, Feature, Joint, Motion, Pose, Relative, System, feature_distance,
};
use std::cell::RefCell;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Reach of the boxes' lists, relative to the machine's size; questions that reach further go to direct search.
const REACH: f64 = 0.085;
/// Greatest motion of a feature within half a box, relative to the machine's size.
const HALF: f64 = 0.02;
/// Most boxes kept for a pair of bodies; beyond, direct search.
const MOST_BOXES: usize = 200_000;

/// Candidates from maps for pairs of bodies that move by at most one joint each; from direct search for all others and far
/// away.
#[derive(Debug)]
pub struct MapSource<'a> {
    system: &'a System,
    direct: DirectSearch<'a>,
    maps: Vec<Option<PairMap>>,
}

/// The boxes of one pair of bodies.
#[derive(Debug)]
struct PairMap {
    sides: [Side; 2],
    boxes: RefCell<HashMap<[i64; 2], Box<[Entry]>>>,
}

/// How a body moves, and the widths of boxes along its joint position.
#[derive(Clone, Copy, Debug)]
struct Side {
    motion: Option<Motion>,
    width: f64,
    /// Greatest lever arm of its features.
    lever: f64,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    candidate: Candidate,
    /// Lower bound of the features' distance anywhere in the box.
    least: f64,
}

impl Side {
    fn new(joint: Option<&Joint>, features: &[Feature], size: f64) -> Self {
        let motion = joint.map(|j| j.motion);
        let mut side = Side { motion, width: f64::INFINITY, lever: 0.0 };
        side.lever = features.iter().map(|f| side.lever(f)).fold(0.0, f64::max);
        side.width = match motion {
            None => 1.0,
            Some(Motion::Slide { .. }) => 2.0 * HALF * size,
            Some(Motion::Turn { .. }) => TAU / (TAU * side.lever / (2.0 * HALF * size)).ceil().max(8.0),
        };
        side
    }

    /// How far a feature moves at most per unit of the joint's position: its disc and the centre of its circle.
    fn lever(&self, feature: &Feature) -> f64 {
        match self.motion {
            None => 0.0,
            Some(Motion::Slide { .. }) => 1.0,
            Some(Motion::Turn { center }) => {
                let disc = (feature.center - center).norm() + feature.radius;
                disc.max((feature.shape.anchor() - center).norm())
            }
        }
    }

    /// The box of a body's pose.
    #[inline]
    fn index(&self, pose: &Pose) -> i64 {
        let x = match self.motion {
            None => return 0,
            // The pose of a slide along d is a shift by x d.
            Some(Motion::Slide { direction }) => pose.shift.dot(direction) / direction.dot(direction),
            Some(Motion::Turn { .. }) => pose.sin.atan2(pose.cos),
        };
        (x / self.width).round() as i64
    }

    /// The pose in the middle of a box.
    fn middle(&self, index: i64) -> Pose {
        self.motion.map_or(Pose::identity(), |m| m.pose(index as f64 * self.width))
    }
}

impl<'a> MapSource<'a> {
    /// Maps for all pairs of bodies of a system that move by one joint each; empty until asked.
    pub fn new(system: &'a System) -> Self {
        let maps = system.interactions.iter().map(|i| PairMap::new(system, i.bodies)).collect();
        MapSource { system, direct: system.direct_search(), maps }
    }

    /// Boxes made so far.
    pub fn boxes(&self) -> usize {
        self.maps.iter().flatten().map(|m| m.boxes.borrow().len()).sum()
    }

    /// Pairs of bodies that have a map, and all pairs.
    pub fn mapped(&self) -> (usize, usize) {
        (self.maps.iter().flatten().count(), self.maps.len())
    }

    /// The contacts of a box, from direct search in its middle.
    fn fill(&self, interaction: usize, map: &PairMap, at: [i64; 2]) -> Box<[Entry]> {
        let [a, b] = [0, 1].map(|k| map.sides[k].middle(at[k]));
        let half = map.sides.map(|s| if s.motion.is_some() { 0.5 * s.width } else { 0.0 });
        let reach = REACH * self.system.size;
        let slack = 1e-9 * self.system.size;
        let most = map.sides[0].lever * half[0] + map.sides[1].lever * half[1] + slack;
        let mut found = Vec::new();
        self.direct.candidates(interaction, &a, &b, reach + most, &mut found);
        let bodies = self.system.interactions[interaction].bodies;
        let entry = |candidate: Candidate| {
            let first = &self.system.features[bodies.0][candidate.id.first as usize];
            let second = &self.system.features[bodies.1][candidate.id.second as usize];
            let motion = map.sides[0].lever(first) * half[0] + map.sides[1].lever(second) * half[1] + slack;
            Entry { candidate, least: candidate.distance - motion }
        };
        found.into_iter().map(entry).filter(|e| e.least < reach).collect()
    }
}

impl PairMap {
    fn new(system: &System, bodies: (usize, usize)) -> Option<Self> {
        let [a, b] = [bodies.0, bodies.1].map(|b| system.bodies[b].chain.as_slice());
        if a.len() > 1 || b.len() > 1 {
            return None;
        }
        let side =
            |chain: &[Joint], body: usize| Side::new(chain.first(), &system.features[body], system.size);
        Some(PairMap { sides: [side(a, bodies.0), side(b, bodies.1)], boxes: RefCell::default() })
    }
}

impl ContactSource for MapSource<'_> {
    fn candidates(&self, interaction: usize, a: &Pose, b: &Pose, reach: f64, found: &mut Vec<Candidate>) {
        let near = reach <= REACH * self.system.size;
        let Some(map) = self.maps[interaction].as_ref().filter(|_| near) else {
            return self.direct.candidates(interaction, a, b, reach, found);
        };
        let at = [map.sides[0].index(a), map.sides[1].index(b)];
        let mut boxes = map.boxes.borrow_mut();
        if boxes.len() >= MOST_BOXES && !boxes.contains_key(&at) {
            return self.direct.candidates(interaction, a, b, reach, found);
        }
        let entries = boxes.entry(at).or_insert_with(|| self.fill(interaction, map, at));
        let bodies = self.system.interactions[interaction].bodies;
        let (fa, fb) = (&self.system.features[bodies.0], &self.system.features[bodies.1]);
        let relative = Relative::pose(a, b);
        for entry in entries.iter().filter(|e| e.least < reach) {
            let Candidate { id, kind, .. } = entry.candidate;
            let distance = feature_distance(kind, &fa[id.first as usize], &fb[id.second as usize], &relative);
            if distance < reach {
                found.push(Candidate { id, kind, distance });
            }
        }
    }
}
