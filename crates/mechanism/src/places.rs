//! Where two features touch as one joint moves and all else rests.
//!
//! The joint turns the first body about o by θ, seen from the second, or slides it by x along d. With r = c − o for the centre
//! c of a round feature
//! ```text
//! against an edge     g(θ) = n·(o − f) − ρ + n·R(θ) r
//! two centres         |o + R(θ) r − b|² = |r|² + |e|² + 2 e·R(θ) r,   e = o − b
//! ```
//! so gaps are zero where `cos(θ − φ) = w`, at `θ = φ ± acos w`; along a slide where a linear or quadratic equation holds.

use crate::feature::{Feature, FeatureShape};
use crate::gap::GapKind;
use crate::system::Pose;
use mainspring_geometry::Vec2;

/// Cosines as far beyond ±1 as this count as ±1: there features graze.
const GRAZING: f64 = 1e-9;

/// How one joint moves the first of two bodies, seen from the second, both as they are placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sway {
    /// Counterclockwise by the angle, about a point.
    Turn { center: Vec2 },
    /// Along a unit vector.
    Slide { direction: Vec2 },
}

/// A place along the motion where a gap is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// From the present position: an angle within ±π, or a length.
    pub offset: f64,
    /// The direction of motion in which the gap falls there, +1 or −1; 0 where it does in neither or in both.
    pub closes: i8,
    /// Nearest distance to the end of the edge (length; infinite without an edge).
    pub edge_margin: f64,
    /// How far inside the cones of normals (radians near the ends).
    pub cone_margin: f64,
}

/// The places, two at most, at which two features have gap zero, wherever along their curves. The kind must be
/// `GapKind::of(a, b)`. Accurate to rounding, and to its root where features graze.
pub fn places(
    kind: GapKind,
    (a, b): (&Feature, &Feature),
    (pose_a, pose_b): (&Pose, &Pose),
    sway: &Sway,
) -> [Option<Place>; 2] {
    match kind {
        GapKind::RoundEdge { swapped: false } => against_edge((a, pose_a), (b, pose_b), sway),
        // The round feature is on the body at rest: seen from the other it moves the opposite way.
        GapKind::RoundEdge { swapped: true } => {
            against_edge((b, pose_b), (a, pose_a), sway).map(|p| p.map(Place::reversed))
        }
        GapKind::RoundRound => centers((a, pose_a), (b, pose_b), sway, 1),
        GapKind::RoundHollow { .. } => centers((a, pose_a), (b, pose_b), sway, -1),
    }
}

impl Place {
    /// The same where the second body moves, or is the one seen to move.
    pub fn reversed(self) -> Self {
        Self { offset: -self.offset, closes: -self.closes, ..self }
    }
}

type Posed<'f> = (&'f Feature, &'f Pose);

fn against_edge((round, pose): Posed, (edge, edge_pose): Posed, sway: &Sway) -> [Option<Place>; 2] {
    let FeatureShape::Round { center, radius, .. } = round.shape else { unreachable!("kind fits shapes") };
    let FeatureShape::Edge { from, tangent, normal, length, .. } = edge.shape else {
        unreachable!("kind fits shapes")
    };
    let (c, from) = (pose.apply(center), edge_pose.apply(from));
    let (n, t) = (edge_pose.rotate(normal), edge_pose.rotate(tangent));
    let place = |(offset, turn): (f64, Vec2), at: Vec2, closes: i8| {
        let along = t.dot(at - from);
        let cone_margin = cone_margin((round, pose), turn, -n);
        Some(Place { offset, closes, edge_margin: along.min(length - along), cone_margin })
    };
    match *sway {
        Sway::Turn { center } => {
            let Some(turn) = Turn::new(c - center) else { return [None; 2] };
            let level = (radius - n.dot(center - from)) / turn.arm;
            let at = |side: i8| turn.to(n, level, side).map(|m| (turn.from(m), center + m * turn.arm, side));
            [1, -1].map(|side| at(side).and_then(|(to, at, side)| place(to, at, graze(level, side))))
        }
        Sway::Slide { direction } => {
            let slope = n.dot(direction);
            if slope == 0.0 {
                return [None; 2];
            }
            let offset = (radius - n.dot(c - from)) / slope;
            let closes = if slope < 0.0 { 1 } else { -1 };
            [place((offset, Vec2::new(1.0, 0.0)), c + direction * offset, closes), None]
        }
    }
}

/// `side` is +1 for round against round, −1 for round inside hollow.
fn centers(a: Posed, b: Posed, sway: &Sway, side: i8) -> [Option<Place>; 2] {
    let (ca, cb) = (a.1.apply(a.0.shape.anchor()), b.1.apply(b.0.shape.anchor()));
    let (ra, rb) = (a.0.shape.radius(), b.0.shape.radius());
    let sum = if side > 0 { ra + rb } else { (ra - rb).abs() };
    let place = |(offset, turn): (f64, Vec2), d: Vec2, closes: i8| {
        let u = d * (1.0 / sum);
        let (outward_a, outward_b) = match (&a.0.shape, &b.0.shape) {
            (FeatureShape::Round { .. }, FeatureShape::Round { .. }) => (-u, u),
            (FeatureShape::Round { .. }, _) => (u, u),
            _ => (-u, -u),
        };
        let still = Vec2::new(1.0, 0.0);
        let cone_margin = cone_margin(a, turn, outward_a).min(cone_margin(b, still, outward_b));
        Some(Place { offset, closes: side * closes, edge_margin: f64::INFINITY, cone_margin })
    };
    match *sway {
        Sway::Turn { center } => {
            let (Some(turn), Some(away)) = (Turn::new(ca - center), Turn::new(center - cb)) else {
                return [None; 2];
            };
            let level = (sum * sum - turn.arm * turn.arm - away.arm * away.arm) / (2.0 * turn.arm * away.arm);
            let at = |side: i8| {
                turn.to(away.along, level, side).map(|m| (turn.from(m), m * turn.arm + (center - cb)))
            };
            [1, -1].map(|side| at(side).and_then(|(to, d)| place(to, d, graze(level, side))))
        }
        Sway::Slide { direction } => {
            let (d, still) = (ca - cb, Vec2::new(1.0, 0.0));
            let (along, height) = (d.dot(direction), d.cross(direction));
            let level = height / sum;
            if level.abs() > 1.0 + GRAZING {
                return [None; 2];
            }
            let root = (sum * sum - height * height).max(0.0).sqrt();
            let at = |closes: i8| -along - f64::from(closes) * root;
            [1, -1].map(|closes| place((at(closes), still), d + direction * at(closes), graze(level, closes)))
        }
    }
}

/// Features that graze close in neither direction or in both.
fn graze(level: f64, closes: i8) -> i8 {
    if level.abs() >= 1.0 - GRAZING { 0 } else { closes }
}

/// The margin of an outward normal `d` of a feature whose body has turned by `turn` (its cosine and sine) from its pose.
fn cone_margin((feature, pose): Posed, turn: Vec2, d: Vec2) -> f64 {
    let (FeatureShape::Round { cone, .. } | FeatureShape::Hollow { cone, .. }) = &feature.shape else {
        return 1.0;
    };
    cone.margin(pose.rotate_back(Vec2::new(turn.dot(d), turn.cross(d))))
}

/// An arm that turns: its length and direction.
#[derive(Clone, Copy)]
struct Turn {
    arm: f64,
    along: Vec2,
}

impl Turn {
    fn new(r: Vec2) -> Option<Self> {
        let arm = r.norm();
        (arm > 0.0).then(|| Self { arm, along: r * (1.0 / arm) })
    }

    /// The direction at the angle acos(`level`) from the unit vector n, counterclockwise for `side` +1.
    fn to(self, n: Vec2, level: f64, side: i8) -> Option<Vec2> {
        let w = level.clamp(-1.0, 1.0);
        let near = level.abs() <= 1.0 + GRAZING;
        near.then(|| n * w + n.perp() * (f64::from(side) * ((1.0 - w) * (1.0 + w)).sqrt()))
    }

    /// The turn from here to the direction `m`: the angle, and its cosine and sine.
    fn from(self, m: Vec2) -> (f64, Vec2) {
        let turn = Vec2::new(self.along.dot(m), self.along.cross(m));
        (turn.y.atan2(turn.x), turn)
    }
}
