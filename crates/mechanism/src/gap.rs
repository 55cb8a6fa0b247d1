//! The gap: signed distance of two features, with its derivatives. Positive apart, negative overlapping.
//!
//! With centres a, b and radii r, R in the machine's plane and n the outward normal of an edge:
//! ```text
//! round r against edge       g = n·(a − foot) − r
//! round r against round R    g = |a − b| − r − R
//! round r inside hollow R    g = R − r − |a − b|          (R > r)
//! ```
//! `ġ = n·(v_A − v_B)` at the point of contact; `g̈ = G q̈ + γ` with γ the bias. The normal n points from the second
//! body to the first, so a force λ ≥ 0 at the contact acts as `+λ Gᵀ`.

use crate::feature::{Cone, Feature, FeatureShape};
use crate::placed::{Placed, Row};
use crate::system::{Body, Pose};
use mainspring_geometry::{Scalar, Vec2};

/// Which formula a pair of features uses; `swapped` when the round one is the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GapKind {
    RoundEdge { swapped: bool },
    RoundRound,
    RoundHollow { swapped: bool },
}

impl GapKind {
    /// The kind of contact two features can make, if any. Two corners make none: a vertex on a vertex is an end
    /// point of other contacts. A round fits a hollow only if it is smaller.
    pub fn of(a: &Feature, b: &Feature) -> Option<Self> {
        use FeatureShape::{Edge, Hollow, Round};
        match (&a.shape, &b.shape) {
            (Round { .. }, Edge { .. }) => Some(GapKind::RoundEdge { swapped: false }),
            (Edge { .. }, Round { .. }) => Some(GapKind::RoundEdge { swapped: true }),
            (Round { radius: r, .. }, Round { radius: s, .. }) => {
                (*r > 0.0 || *s > 0.0).then_some(GapKind::RoundRound)
            }
            (Round { radius: r, .. }, Hollow { radius: s, .. }) if r < s => {
                Some(GapKind::RoundHollow { swapped: false })
            }
            (Hollow { radius: s, .. }, Round { radius: r, .. }) if r < s => {
                Some(GapKind::RoundHollow { swapped: true })
            }
            _ => None,
        }
    }
}

/// The gap of two features over any scalar, at joint positions `q`. None if the features make no contact.
pub fn gap<S: Scalar>(bodies: (&Body, &Body), features: (&Feature, &Feature), q: &[S]) -> Option<S> {
    let poses = (bodies.0.pose(q), bodies.1.pose(q));
    match GapKind::of(features.0, features.1)? {
        GapKind::RoundEdge { swapped: false } => round_edge(&poses.0, features.0, &poses.1, features.1),
        GapKind::RoundEdge { swapped: true } => round_edge(&poses.1, features.1, &poses.0, features.0),
        kind => {
            let (a, b) = (center_radius(features.0)?, center_radius(features.1)?);
            let d = (poses.0.apply(Vec2::constant(a.0)) - poses.1.apply(Vec2::constant(b.0))).norm();
            Some(match kind {
                GapKind::RoundRound => d - (a.1 + b.1),
                _ => -d + (a.1 - b.1).abs(),
            })
        }
    }
}

fn center_radius(feature: &Feature) -> Option<(Vec2, f64)> {
    match feature.shape {
        FeatureShape::Round { center, radius, .. } | FeatureShape::Hollow { center, radius, .. } => {
            Some((center, radius))
        }
        FeatureShape::Edge { .. } => None,
    }
}

fn round_edge<S: Scalar>(
    round_pose: &Pose<S>,
    round: &Feature,
    edge_pose: &Pose<S>,
    edge: &Feature,
) -> Option<S> {
    let (center, radius) = center_radius(round)?;
    let FeatureShape::Edge { from, normal, .. } = edge.shape else { return None };
    let n = edge_pose.rotate(Vec2::constant(normal));
    let offset = round_pose.apply(Vec2::constant(center)) - edge_pose.apply(Vec2::constant(from));
    Some(n.dot(offset) - radius)
}

/// A contact at one configuration: gap, normal, place, and how far inside its features it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapState {
    pub gap: f64,
    /// Unit vector from the second body to the first.
    pub normal: Vec2,
    /// The point whose relative motion gives the gap's rate: a centre of a round feature.
    pub carried: Vec2,
    /// The contact point on the first body's surface.
    pub point: Vec2,
    /// Distance of the contact point from the nearer end of an edge (length; infinite without an edge).
    pub edge_margin: f64,
    /// Which end of the edge is nearer: true for its end, false for its start.
    pub near_end: bool,
    /// How far inside the cones of normals (radians near the ends; 1 for whole circles).
    pub cone_margin: f64,
    /// Curvature term: 0 against an edge, ±1/distance of centres otherwise.
    curvature: f64,
    /// Whether the edge is on the first body (its rotation matters for the bias).
    edge_first: bool,
}

/// Evaluates a contact between placed bodies. The kind must be `GapKind::of(a, b)`.
pub fn gap_state(kind: GapKind, a: &Feature, b: &Feature, pose_a: &Pose, pose_b: &Pose) -> GapState {
    match kind {
        GapKind::RoundEdge { swapped: false } => edge_state(a, pose_a, b, pose_b, false),
        GapKind::RoundEdge { swapped: true } => edge_state(b, pose_b, a, pose_a, true),
        GapKind::RoundRound => centers_state(a, b, pose_a, pose_b, 1.0),
        GapKind::RoundHollow { .. } => centers_state(a, b, pose_a, pose_b, -1.0),
    }
}

/// Do the features stay so turned against each other that they cannot touch, while the first body turns by no more than
/// `turn` (radians) seen from the second? Told of contacts against edges; false where it is not known.
#[inline]
pub fn misses_cone(kind: GapKind, a: &Feature, b: &Feature, second_from_first: &Pose, turn: f64) -> bool {
    let GapKind::RoundEdge { swapped } = kind else { return false };
    let (round, edge) = if swapped { (b, a) } else { (a, b) };
    let (FeatureShape::Round { cone, .. }, FeatureShape::Edge { normal, .. }) = (&round.shape, &edge.shape)
    else {
        unreachable!("kind fits shapes")
    };
    let inward = -*normal;
    cone.misses(
        if swapped { second_from_first.rotate(inward) } else { second_from_first.rotate_back(inward) },
        turn,
    )
}

fn edge_state(
    round: &Feature,
    round_pose: &Pose,
    edge: &Feature,
    edge_pose: &Pose,
    swapped: bool,
) -> GapState {
    let FeatureShape::Round { center, radius, cone } = round.shape else { unreachable!("kind fits shapes") };
    let FeatureShape::Edge { from, tangent, normal, length, .. } = edge.shape else {
        unreachable!("kind fits shapes")
    };
    let c = round_pose.apply(center);
    let n = edge_pose.rotate(normal);
    let offset = c - edge_pose.apply(from);
    let along = edge_pose.rotate(tangent).dot(offset);
    let cone_margin = cone.margin(round_pose.rotate_back(-n));
    GapState {
        gap: n.dot(offset) - radius,
        normal: if swapped { -n } else { n },
        carried: c,
        point: c - n * radius,
        edge_margin: along.min(length - along),
        near_end: along > 0.5 * length,
        cone_margin,
        curvature: 0.0,
        edge_first: swapped,
    }
}

/// `side` is +1 for round against round, −1 for round inside hollow.
fn centers_state(a: &Feature, b: &Feature, pose_a: &Pose, pose_b: &Pose, side: f64) -> GapState {
    let ((center_a, radius_a, cone_a, round_a), (center_b, radius_b, cone_b, round_b)) = (parts(a), parts(b));
    let (ca, cb) = (pose_a.apply(center_a), pose_b.apply(center_b));
    let d = ca - cb;
    let distance = d.norm();
    // Concentric: no direction of contact; the gap is the difference of radii and has no slope to speak of.
    let u = if distance > 0.0 { d * (1.0 / distance) } else { Vec2::new(1.0, 0.0) };
    let sum = if side > 0.0 { radius_a + radius_b } else { (radius_a - radius_b).abs() };
    // Outward normal of a at the contact: −u between rounds; inside a hollow b also +u; of a hollow a, seen from a, −u.
    let (direction_a, direction_b) = match (round_a, round_b) {
        (true, true) => (-u, u),
        (true, false) => (u, u),
        _ => (-u, -u),
    };
    let margin =
        cone_a.margin(pose_a.rotate_back(direction_a)).min(cone_b.margin(pose_b.rotate_back(direction_b)));
    GapState {
        gap: side * (distance - sum),
        normal: u * side,
        carried: ca,
        point: ca + direction_a * radius_a,
        edge_margin: f64::INFINITY,
        near_end: false,
        cone_margin: margin,
        curvature: if distance > 0.0 { side / distance } else { 0.0 },
        edge_first: false,
    }
}

fn parts(feature: &Feature) -> (Vec2, f64, &Cone, bool) {
    match &feature.shape {
        FeatureShape::Round { center, radius, cone } => (*center, *radius, cone, true),
        FeatureShape::Hollow { center, radius, cone } => (*center, *radius, cone, false),
        FeatureShape::Edge { .. } => unreachable!("kind fits shapes"),
    }
}

impl GapState {
    /// The centre carried by the second body, or the same point as the first's against an edge.
    fn partner(&self) -> Vec2 {
        if self.curvature == 0.0 {
            return self.carried;
        }
        self.carried - self.normal * (1.0 / self.curvature)
    }

    /// The state of a stop, which has no place and no features to run off: its gap alone.
    pub fn of_stop(gap: f64) -> Self {
        Self {
            gap,
            normal: Vec2::default(),
            carried: Vec2::default(),
            point: Vec2::default(),
            edge_margin: f64::INFINITY,
            near_end: false,
            cone_margin: f64::INFINITY,
            curvature: 0.0,
            edge_first: false,
        }
    }

    /// `G = ∂g/∂q`. Joints that carry both bodies have no part in it, exactly.
    #[inline]
    pub fn row(&self, a: &Placed, b: &Placed) -> Row {
        let shared = a.shared(b);
        if shared > 0 {
            return self.row_against(a, b, shared);
        }
        self.row_between(a, b)
    }

    #[cold]
    fn row_against(&self, a: &Placed, b: &Placed, shared: usize) -> Row {
        self.row_between(&a.carried_by(shared), &b.carried_by(shared))
    }

    #[inline]
    fn row_between(&self, a: &Placed, b: &Placed) -> Row {
        let mut row = Row::default();
        a.add_to_row(&mut row, self.normal, self.carried, 1.0);
        b.add_to_row(&mut row, self.normal, self.partner(), -1.0);
        row
    }

    /// ġ at velocities `v`.
    pub fn rate(&self, a: &Placed, b: &Placed, v: &[f64]) -> f64 {
        let shared = a.shared(b);
        if shared > 0 {
            return self.rate_against(a, b, v, shared);
        }
        self.rate_between(a, b, v)
    }

    #[cold]
    fn rate_against(&self, a: &Placed, b: &Placed, v: &[f64], shared: usize) -> f64 {
        self.rate_between(&a.carried_by(shared), &b.carried_by(shared), v)
    }

    #[inline]
    fn rate_between(&self, a: &Placed, b: &Placed, v: &[f64]) -> f64 {
        self.normal.dot(a.velocity(self.carried, v) - b.velocity(self.partner(), v))
    }

    /// γ = q̇ᵀ (∂²g/∂q²) q̇: the part of g̈ that joint accelerations do not cause.
    pub fn bias(&self, a: &Placed, b: &Placed, v: &[f64]) -> f64 {
        let shared = a.shared(b);
        if shared > 0 {
            return self.bias_against(a, b, v, shared);
        }
        self.bias_between(a, b, v)
    }

    #[cold]
    fn bias_against(&self, a: &Placed, b: &Placed, v: &[f64], shared: usize) -> f64 {
        self.bias_between(&a.carried_by(shared), &b.carried_by(shared), v)
    }

    #[inline]
    fn bias_between(&self, a: &Placed, b: &Placed, v: &[f64]) -> f64 {
        let (ma, mb) = (a.motion(self.carried, v), b.motion(self.partner(), v));
        let (velocity, bias) = (ma.velocity - mb.velocity, ma.bias - mb.bias);
        if self.curvature != 0.0 {
            let tangential = self.normal.cross(velocity);
            return self.normal.dot(bias) + tangential * tangential * self.curvature;
        }
        // Against an edge the second derivative is taken in the edge's turning frame: −2 ω × v appears.
        let turning = if self.edge_first { a.turning(v) } else { b.turning(v) };
        self.normal.dot(bias) - 2.0 * turning * self.normal.dot(velocity.perp())
    }
}
