//! A closed contact as a constraint on motion: its gap, rate, `∂g/∂q` and bias alone, from what its features are made of,
//! looked up once. `GapState` tells more of any contact, with the same formulas.

use crate::feature::{Feature, FeatureShape};
use crate::gap::GapKind;
use crate::placed::{Field, MAX_CHAIN, place};
use crate::system::{Body, Joint, Motion, Pose};
use mainspring_geometry::Vec2;

/// What two features that touch are made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shapes {
    /// Centre and radius of the round one; start and normal of the edge, which may be the first body's.
    RoundEdge { center: Vec2, radius: f64, from: Vec2, normal: Vec2, edge_first: bool },
    /// Centres, their distance when touching, and +1 outside each other, −1 one inside the other.
    Centers { first: Vec2, second: Vec2, touching: f64, side: f64 },
}

/// A contact between two bodies, ready to be evaluated at many places.
#[derive(Clone, Copy, Debug)]
pub struct Constraint {
    pub(crate) shapes: Shapes,
    /// How many joints both chains begin with: nothing between the bodies depends on them.
    pub shared: usize,
}

/// A body at positions and velocities of the coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    pub pose: Pose,
    /// Velocities of its points, and how these change without accelerations of the coordinates.
    pub field: Field,
    /// For each joint the centre of a turn or the direction of a slide, in the machine.
    at: [Vec2; MAX_CHAIN],
}

impl Default for Moving {
    fn default() -> Self {
        Self { pose: Pose::identity(), field: Field::default(), at: [Vec2::default(); MAX_CHAIN] }
    }
}

impl Moving {
    /// Goes to positions `q` and velocities `v` of the coordinates that the body's chain names.
    #[inline]
    pub fn go_to(&mut self, chain: &[Joint], q: &[f64], v: &[f64]) {
        self.pose = place(chain, q, &mut self.at);
        self.field = Field::drift(chain, &self.at, v);
    }

    /// The same where only the joints of `chain` from `first` on move.
    pub fn carried_by(&self, chain: &[Joint], first: usize, v: &[f64]) -> Self {
        let field = Field::drift(&chain[first..], &self.at[first..], v);
        Self { field, ..*self }
    }

    /// Tells of each joint from `first` on its place in the chain and `n · ∂p/∂x`, for the body's point now at `p` and x
    /// the coordinate that moves the joint.
    #[inline]
    pub fn slopes(&self, chain: &[Joint], first: usize, n: Vec2, p: Vec2, mut each: impl FnMut(usize, f64)) {
        for (k, (j, &at)) in chain.iter().zip(&self.at).enumerate().skip(first) {
            let turns = matches!(j.motion, Motion::Turn { .. });
            let along = if turns { n.dot((p - at).perp()) } else { n.dot(at) };
            each(k, j.ratio * along);
        }
    }
}

/// A constraint at one state. `ġ = G q̇` and `g̈ = G q̈ + γ`.
#[derive(Clone, Copy, Debug)]
pub struct Constrained {
    pub gap: f64,
    /// ġ.
    pub rate: f64,
    /// γ: the part of g̈ that accelerations of coordinates do not cause.
    pub bias: f64,
    /// Unit vector from the second body to the first.
    pub normal: Vec2,
    /// The point of either body whose relative motion gives the rate.
    pub points: (Vec2, Vec2),
}

impl Constraint {
    /// Of features of two bodies. The kind must be `GapKind::of(a, b)`.
    pub fn new(kind: GapKind, (a, b): (&Feature, &Feature), bodies: (&Body, &Body)) -> Self {
        let shapes = match kind {
            GapKind::RoundEdge { swapped } => {
                let (round, edge) = if swapped { (b, a) } else { (a, b) };
                let FeatureShape::Edge { from, normal, .. } = edge.shape else {
                    unreachable!("kind fits shapes")
                };
                let (center, radius) = (round.shape.anchor(), round.shape.radius());
                Shapes::RoundEdge { center, radius, from, normal, edge_first: swapped }
            }
            GapKind::RoundRound | GapKind::RoundHollow { .. } => {
                let (r, s) = (a.shape.radius(), b.shape.radius());
                let outside = kind == GapKind::RoundRound;
                let (touching, side) = if outside { (r + s, 1.0) } else { ((r - s).abs(), -1.0) };
                Shapes::Centers { first: a.shape.anchor(), second: b.shape.anchor(), touching, side }
            }
        };
        let shared = bodies.0.chain.iter().zip(&bodies.1.chain).take_while(|(j, k)| j == k).count();
        Self { shapes, shared }
    }

    /// Between its bodies; joints that carry both are left out if the fields leave them out.
    #[inline]
    pub fn at(&self, a: &Moving, b: &Moving) -> Constrained {
        match self.shapes {
            Shapes::RoundEdge { center, radius, from, normal, edge_first } => {
                let (round, edge) = if edge_first { (b, a) } else { (a, b) };
                let c = round.pose.apply(center);
                let n = edge.pose.rotate(normal);
                let gap = n.dot(c - edge.pose.apply(from)) - radius;
                let normal = if edge_first { -n } else { n };
                let (velocity, bias) = relative_motion((a, b), (c, c));
                // The second derivative is taken in the edge's turning frame: −2 ω × v appears.
                let bias = normal.dot(bias) - 2.0 * edge.field.turning * normal.dot(velocity.perp());
                Constrained { gap, rate: normal.dot(velocity), bias, normal, points: (c, c) }
            }
            Shapes::Centers { first, second, touching, side } => {
                let points = (a.pose.apply(first), b.pose.apply(second));
                let d = points.0 - points.1;
                let distance = d.norm();
                // Concentric: no direction of contact, and no slope to speak of.
                let inverse = if distance > 0.0 { side / distance } else { 0.0 };
                let normal = if distance > 0.0 { d * inverse } else { Vec2::new(side, 0.0) };
                let points = if distance > 0.0 { points } else { (points.0, points.0) };
                let (velocity, bias) = relative_motion((a, b), points);
                let across = normal.cross(velocity);
                let bias = normal.dot(bias) + across * across * inverse;
                let gap = side * (distance - touching);
                Constrained { gap, rate: normal.dot(velocity), bias, normal, points }
            }
        }
    }
}

/// Velocity and bias acceleration of a point of the first body against one of the second.
#[inline]
fn relative_motion((a, b): (&Moving, &Moving), points: (Vec2, Vec2)) -> (Vec2, Vec2) {
    let (u, w) = (a.field.motion(points.0), b.field.motion(points.1));
    (u.velocity - w.velocity, u.bias - w.bias)
}
