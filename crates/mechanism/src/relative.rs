//! The motion of one body seen from another, and how two features approach in it.
//!
//! With `x_B = R x_A + s` the place of a point of A seen from B, its velocity there is `ẋ = u + ω x^⊥` and its
//! acceleration `ẍ = u̇ + ω̇ x^⊥ + ω ẋ^⊥`. For n the outward normal of an edge, c the centre of a round feature seen from
//! the edge, and d the vector between two centres:
//! ```text
//! against an edge     g = n·(c − from) − r      ġ = n·ċ              g̈ = n·c̈
//! two centres         g = ±(|d| − R)            ġ = ±d·ḋ / |d|       g̈ = ±(d·d̈ + |ḋ|² − ġ²) / |d|
//! ```

use crate::feature::{Feature, FeatureShape};
use crate::gap::GapKind;
use crate::placed::Placed;
use crate::system::Pose;
use mainspring_geometry::Vec2;

/// The first body of a pair seen from the second.
#[derive(Clone, Copy, Debug)]
pub struct Relative {
    /// second_from_first.
    pub pose: Pose,
    /// ω, radians per unit of time.
    pub turning: f64,
    /// u: velocity of the first body's point now at the second's origin as modelled.
    pub velocity: Vec2,
    /// ω̇.
    pub turning_rate: f64,
    /// u̇.
    pub velocity_rate: Vec2,
}

impl Relative {
    /// Of bodies `a` and `b` at velocities `v` and accelerations `dv` of the coordinates.
    pub fn new(a: &Placed, b: &Placed, v: &[f64], dv: &[f64]) -> Self {
        let shared = a.shared(b);
        if shared > 0 {
            return Self::against(a, b, v, dv, shared);
        }
        Self::between(a, b, v, dv)
    }

    /// Joints that carry both bodies have no part in it.
    #[cold]
    fn against(a: &Placed, b: &Placed, v: &[f64], dv: &[f64], shared: usize) -> Self {
        Self::between(&a.carried_by(shared), &b.carried_by(shared), v, dv)
    }

    #[inline]
    fn between(a: &Placed, b: &Placed, v: &[f64], dv: &[f64]) -> Self {
        let (a_field, b_field) = (a.field(v, dv), b.field(v, dv));
        let shift = b.pose.shift;
        let (turning, turning_rate) =
            (a_field.turning - b_field.turning, a_field.turning_rate - b_field.turning_rate);
        let velocity = a_field.linear - b_field.linear + shift.perp() * turning;
        let carried = b_field.linear + shift.perp() * b_field.turning;
        let rate = a_field.linear_rate - b_field.linear_rate
            + shift.perp() * turning_rate
            + carried.perp() * turning
            - velocity.perp() * b_field.turning;
        Self {
            pose: Self::pose(&a.pose, &b.pose),
            turning,
            velocity: b.pose.rotate_back(velocity),
            turning_rate,
            velocity_rate: b.pose.rotate_back(rate),
        }
    }

    /// second_from_first, for the poses of two bodies.
    pub fn pose(a: &Pose, b: &Pose) -> Pose {
        Pose {
            cos: b.cos * a.cos + b.sin * a.sin,
            sin: b.cos * a.sin - b.sin * a.cos,
            shift: b.rotate_back(a.shift - b.shift),
        }
    }

    /// Velocity and acceleration of the first body's point now at `x`, all seen from the second.
    fn motion_at(&self, x: Vec2) -> (Vec2, Vec2) {
        let velocity = self.velocity + x.perp() * self.turning;
        (velocity, self.velocity_rate + x.perp() * self.turning_rate + velocity.perp() * self.turning)
    }

    /// The point `x` of the second body, its velocity and acceleration, all seen from the first.
    fn back(&self, x: Vec2) -> (Vec2, Vec2, Vec2) {
        let velocity = self.velocity + x.perp() * self.turning;
        let rate = self.velocity_rate + x.perp() * self.turning_rate - velocity.perp() * self.turning;
        (self.pose.apply_back(x), self.pose.rotate_back(-velocity), self.pose.rotate_back(-rate))
    }
}

/// How near two features are, and how they approach.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// The gap of `gap_state`.
    pub gap: f64,
    /// ġ.
    pub rate: f64,
    /// g̈.
    pub acceleration: f64,
    /// A lower bound of the distance of the features; it says more than the gap beyond the ends of an edge.
    pub apart: f64,
    /// Distance of the centres of two round features; infinite against an edge.
    pub centers: f64,
}

/// The gap of `gap_state` for the pose second_from_first. The kind must be `GapKind::of(a, b)`.
#[inline]
pub fn gap_between(kind: GapKind, (a, b): (&Feature, &Feature), pose: &Pose) -> f64 {
    let (r, s) = (a.shape.radius(), b.shape.radius());
    let to_edge = |center: Vec2, edge: &Feature, radius: f64| match edge.shape {
        FeatureShape::Edge { from, normal, .. } => normal.dot(center - from) - radius,
        _ => unreachable!("kind fits shapes"),
    };
    match kind {
        GapKind::RoundEdge { swapped: false } => to_edge(pose.apply(a.shape.anchor()), b, r),
        GapKind::RoundEdge { swapped: true } => to_edge(pose.apply_back(b.shape.anchor()), a, s),
        GapKind::RoundRound => (pose.apply(a.shape.anchor()) - b.shape.anchor()).norm() - (r + s),
        GapKind::RoundHollow { .. } => {
            (r - s).abs() - (pose.apply(a.shape.anchor()) - b.shape.anchor()).norm()
        }
    }
}

/// Gap and rates of two features in a relative motion. The kind must be `GapKind::of(a, b)`.
#[inline]
pub fn approach(kind: GapKind, a: &Feature, b: &Feature, relative: &Relative) -> Approach {
    match kind {
        GapKind::RoundEdge { swapped: false } => {
            let c = relative.pose.apply(a.shape.anchor());
            let (velocity, acceleration) = relative.motion_at(c);
            to_edge((c, velocity, acceleration), &a.shape, &b.shape)
        }
        GapKind::RoundEdge { swapped: true } => to_edge(relative.back(b.shape.anchor()), &b.shape, &a.shape),
        GapKind::RoundRound => to_center(&a.shape, &b.shape, relative, 1.0),
        GapKind::RoundHollow { .. } => to_center(&a.shape, &b.shape, relative, -1.0),
    }
}

fn to_edge(center: (Vec2, Vec2, Vec2), round: &FeatureShape, edge: &FeatureShape) -> Approach {
    let FeatureShape::Edge { from, tangent, normal, length, .. } = *edge else {
        unreachable!("kind fits shapes")
    };
    let (c, velocity, acceleration) = center;
    let radius = round.radius();
    let (height, along) = (normal.dot(c - from), tangent.dot(c - from));
    let beyond = (-along).max(along - length).max(0.0);
    Approach {
        gap: height - radius,
        rate: normal.dot(velocity),
        acceleration: normal.dot(acceleration),
        apart: (height * height + beyond * beyond).sqrt() - radius,
        centers: f64::INFINITY,
    }
}

/// `side` is +1 for round against round, −1 for round inside hollow.
fn to_center(a: &FeatureShape, b: &FeatureShape, relative: &Relative, side: f64) -> Approach {
    let at = relative.pose.apply(a.anchor());
    let (velocity, acceleration) = relative.motion_at(at);
    let d = at - b.anchor();
    let centers = d.norm();
    let sum = if side > 0.0 { a.radius() + b.radius() } else { (a.radius() - b.radius()).abs() };
    let inverse = if centers > 0.0 { 1.0 / centers } else { 0.0 };
    let (gap, rate) = (side * (centers - sum), d.dot(velocity) * inverse);
    let bend = (d.dot(acceleration) + velocity.dot(velocity) - rate * rate) * inverse;
    Approach { gap, rate: side * rate, acceleration: side * bend, apart: gap.abs(), centers }
}
