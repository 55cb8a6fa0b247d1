//! Which contacts may come within reach: candidates, never numbers.

use crate::feature::{Feature, FeatureShape};
use crate::gap::GapKind;
use crate::interaction::Interaction;
use crate::relative::Relative;
use crate::system::Pose;
use mainspring_geometry::Vec2;

/// Identity of a contact: interaction (pair of bodies) and the features of its first and second body. Features
/// know their layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContactId {
    pub interaction: u32,
    pub first: u32,
    pub second: u32,
}

/// In place of the interaction of a contact: a stop of a joint, which `first` tells by its index.
const STOP: u32 = u32::MAX;

impl ContactId {
    /// The identity of a stop, an index into [`crate::Forces::stops`].
    pub fn of_stop(index: usize) -> Self {
        Self { interaction: STOP, first: index as u32, second: 0 }
    }

    /// The index of the stop that this is; None for a contact of two bodies.
    pub fn stop(self) -> Option<usize> {
        (self.interaction == STOP).then_some(self.first as usize)
    }
}

/// A contact that may come within reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    pub id: ContactId,
    pub kind: GapKind,
    /// A lower bound of the distance between the two features at the poses asked about.
    pub distance: f64,
}

/// Where candidates come from: direct search, or a map made once. Sources give identities and bounds; gaps come
/// only from `gap`, so trajectories do not depend on the source.
pub trait ContactSource {
    /// Appends, in a fixed order, every contact of `interaction` whose features are nearer than `reach` with the
    /// first body at pose `a` and the second at `b`. Returns a lower bound (≤ `reach`) of the distance between
    /// the features of every other contact.
    fn candidates(&self, interaction: usize, a: &Pose, b: &Pose, reach: f64, found: &mut Vec<Candidate>);
}

/// Direct search through two trees of discs.
#[derive(Clone, Copy, Debug)]
pub struct DirectSearch<'a> {
    pub interactions: &'a [Interaction],
    pub features: &'a [Vec<Feature>],
}

impl ContactSource for DirectSearch<'_> {
    fn candidates(&self, interaction: usize, a: &Pose, b: &Pose, reach: f64, found: &mut Vec<Candidate>) {
        let pair = &self.interactions[interaction];
        let (Some(m), Some(n)) = (pair.trees.0.nodes.first(), pair.trees.1.nodes.first()) else { return };
        let features = (&self.features[pair.bodies.0][..], &self.features[pair.bodies.1][..]);
        let start = found.len();
        // Poses relative to the second body: its own nodes then need no motion.
        let relative = Relative::pose(a, b);
        let at = relative.apply(m.center);
        if !beyond(at - n.center, reach + m.radius + n.radius) {
            let interaction = interaction as u32;
            Descent { pair, features, interaction, relative, reach, found }.descend(0, at, 0);
        }
        found[start..].sort_unstable_by_key(|c| (u64::from(c.id.first) << 32) | u64::from(c.id.second));
    }
}

/// Squares of distances are compared with this much to spare, so that rounding hides no contact.
const SPARE: f64 = 1.0 + 1e-9;

/// Is the vector certainly longer than `length`? Without a square root.
#[inline]
fn beyond(d: Vec2, length: f64) -> bool {
    d.dot(d) > SPARE * (length * length)
}

/// A question on its way down both trees.
struct Descent<'a> {
    pair: &'a Interaction,
    features: (&'a [Feature], &'a [Feature]),
    interaction: u32,
    /// The first body seen from the second.
    relative: Pose,
    reach: f64,
    found: &'a mut Vec<Candidate>,
}

impl Descent<'_> {
    /// Goes on below two nodes within reach, the first one's centre now at `at`: as deep as both trees, which are balanced.
    fn descend(&mut self, i: usize, at: Vec2, j: usize) {
        let (first, second) = (&self.pair.trees.0.nodes, &self.pair.trees.1.nodes);
        let (m, n) = (&first[i], &second[j]);
        if m.leaf && n.leaf {
            self.examine((m.link, n.link), at);
        } else if n.leaf || (!m.leaf && m.radius >= n.radius) {
            for child in [i + 1, m.link] {
                let node = &first[child];
                let at = self.relative.apply(node.center);
                if node.can_meet(n) && !beyond(at - n.center, self.reach + node.radius + n.radius) {
                    self.descend(child, at, j);
                }
            }
        } else {
            for child in [j + 1, n.link] {
                let node = &second[child];
                if m.can_meet(node) && !beyond(at - node.center, self.reach + m.radius + node.radius) {
                    self.descend(i, at, child);
                }
            }
        }
    }

    /// Lists two features if they can make contact and are within reach; the first one's disc is about `at`.
    fn examine(&mut self, ids: (usize, usize), at: Vec2) {
        let (a, b) = (&self.features.0[ids.0], &self.features.1[ids.1]);
        let Some(kind) = GapKind::of(a, b) else { return };
        let apart = apart(kind, a, b, &self.relative);
        let sum = a.shape.radius() + b.shape.radius();
        if beyond(apart, self.reach + sum) || self.pair.kind(ids, (a, b)).is_none() {
            return;
        }
        let distance = distance(kind, (a, b), apart, at);
        if distance < self.reach {
            let id = ContactId { interaction: self.interaction, first: ids.0 as u32, second: ids.1 as u32 };
            self.found.push(Candidate { id, kind, distance });
        }
    }
}

/// A lower bound of the distance between two features, the first body seen from the second at `relative`: exact between
/// a round feature and an edge.
pub fn feature_distance(kind: GapKind, a: &Feature, b: &Feature, relative: &Pose) -> f64 {
    distance(kind, (a, b), apart(kind, a, b, relative), relative.apply(a.center))
}

/// The same where the centres or centre and edge are `apart` and the first one's disc is about `at`.
fn distance(kind: GapKind, (a, b): (&Feature, &Feature), apart: Vec2, at: Vec2) -> f64 {
    let discs = (at - b.center).norm() - a.radius - b.radius;
    let (ra, rb) = (a.shape.radius(), b.shape.radius());
    let own = match kind {
        GapKind::RoundHollow { .. } => (apart.norm() - ra.max(rb)).abs() - ra.min(rb),
        _ => apart.norm() - ra - rb,
    };
    own.max(discs)
}

/// From the second feature's centre to the first one's, or from a centre to the nearest point of an edge.
fn apart(kind: GapKind, a: &Feature, b: &Feature, relative: &Pose) -> Vec2 {
    match (kind, &a.shape, &b.shape) {
        (GapKind::RoundEdge { swapped: false }, round, FeatureShape::Edge { from, tangent, length, .. }) => {
            to_segment(relative.apply(round.anchor()), *from, *tangent, *length)
        }
        (GapKind::RoundEdge { swapped: true }, FeatureShape::Edge { from, tangent, length, .. }, round) => {
            to_segment(round.anchor(), relative.apply(*from), relative.rotate(*tangent), *length)
        }
        (_, a, b) => relative.apply(a.anchor()) - b.anchor(),
    }
}

fn to_segment(p: Vec2, start: Vec2, along: Vec2, length: f64) -> Vec2 {
    let s = along.dot(p - start).clamp(0.0, length);
    start + along * s - p
}
