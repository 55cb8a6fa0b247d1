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
        let (fa, fb) = (&self.features[pair.bodies.0], &self.features[pair.bodies.1]);
        let start = found.len();
        // Poses relative to the second body: its own nodes then need no motion.
        let relative = Relative::pose(a, b);
        let mut pending = vec![(0usize, 0usize)];
        if pair.trees.0.nodes.is_empty() || pair.trees.1.nodes.is_empty() {
            pending.clear();
        }
        while let Some((i, j)) = pending.pop() {
            let (m, n) = (&pair.trees.0.nodes[i], &pair.trees.1.nodes[j]);
            if (relative.apply(m.center) - n.center).norm() - m.radius - n.radius >= reach {
                continue;
            }
            match (m.leaf, n.leaf) {
                (true, true) => {
                    let ids = (m.link, n.link);
                    let Some(kind) = pair.kind(ids, (&fa[ids.0], &fb[ids.1])) else { continue };
                    let distance = feature_distance(kind, &fa[ids.0], &fb[ids.1], &relative);
                    if distance < reach {
                        let (first, second) = (ids.0 as u32, ids.1 as u32);
                        let id = ContactId { interaction: interaction as u32, first, second };
                        found.push(Candidate { id, kind, distance });
                    }
                }
                (false, true) => pending.extend([(m.link, j), (i + 1, j)]),
                (true, false) => pending.extend([(i, n.link), (i, j + 1)]),
                _ if m.radius >= n.radius => pending.extend([(m.link, j), (i + 1, j)]),
                _ => pending.extend([(i, n.link), (i, j + 1)]),
            }
        }
        found[start..].sort_by_key(|c| c.id);
    }
}

/// A lower bound of the distance between two features, the first body seen from the second at `relative`: exact between
/// a round feature and an edge.
pub fn feature_distance(kind: GapKind, a: &Feature, b: &Feature, relative: &Pose) -> f64 {
    let discs = (relative.apply(a.center) - b.center).norm() - a.radius - b.radius;
    let (ra, rb) = (a.shape.radius(), b.shape.radius());
    let (ca, cb) = (relative.apply(a.shape.anchor()), b.shape.anchor());
    let own = match kind {
        GapKind::RoundEdge { swapped: false } => segment_distance(ca, b, &Pose::identity()) - ra,
        GapKind::RoundEdge { swapped: true } => segment_distance(cb, a, relative) - rb,
        GapKind::RoundRound => (ca - cb).norm() - ra - rb,
        GapKind::RoundHollow { .. } => ((ca - cb).norm() - ra.max(rb)).abs() - ra.min(rb),
    };
    own.max(discs)
}

fn segment_distance(p: Vec2, edge: &Feature, pose: &Pose) -> f64 {
    let FeatureShape::Edge { from, tangent, length, .. } = edge.shape else { return 0.0 };
    let (start, along) = (pose.apply(from), pose.rotate(tangent));
    let s = along.dot(p - start).clamp(0.0, length);
    (start + along * s - p).norm()
}
