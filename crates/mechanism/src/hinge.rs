//! Closed contacts between bodies on one joint each, where all lengths are known beforehand: the same as `Constraint`
//! tells, from a few products.

use crate::constraint::{Constraint, Shapes};
use crate::system::{Body, Joint, Motion, Pose};
use mainspring_geometry::{Scalar, Vec2};

/// How a body on one joint or none moves.
#[derive(Clone, Copy, Debug)]
pub struct Hinge {
    /// The coordinate that moves it; of no meaning for a body that nothing moves.
    pub coordinate: usize,
    ratio: f64,
    turns: bool,
    /// Centre of a turn, else zero: points of the body count from here.
    center: Vec2,
    /// Direction of a slide, else zero.
    direction: Vec2,
}

/// Where it is, and how it moves there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hung {
    cos: f64,
    sin: f64,
    /// The place of the point from which others count.
    place: Vec2,
    turning: f64,
    sliding: Vec2,
    /// ∂(turn)/∂q and ∂(place)/∂q.
    slopes: (f64, Vec2),
}

impl Hinge {
    /// None for a chain of several joints.
    pub fn of(body: &Body) -> Option<Self> {
        let still = Hinge {
            coordinate: 0,
            ratio: 0.0,
            turns: false,
            center: Vec2::default(),
            direction: Vec2::default(),
        };
        let Joint { coordinate, ratio, motion } = match body.chain.as_slice() {
            [] => return Some(still),
            [joint] => *joint,
            _ => return None,
        };
        Some(match motion {
            Motion::Turn { center } => Hinge { coordinate, ratio, turns: true, center, ..still },
            Motion::Slide { direction } => Hinge { coordinate, ratio, direction, ..still },
        })
    }

    /// Does a coordinate move the body?
    pub fn moves(&self) -> bool {
        self.ratio != 0.0
    }

    /// The body's modelled point `p` as `Hung` counts it.
    fn local(&self, p: Vec2) -> Vec2 {
        p - self.center
    }

    /// At position `q` and velocity `v` of its coordinate.
    #[inline]
    pub fn at(&self, q: f64, v: f64) -> Hung {
        if self.turns {
            let (sin, cos) = (self.ratio * q).sine_and_cosine();
            let turning = self.ratio * v;
            let slopes = (self.ratio, Vec2::default());
            return Hung { cos, sin, place: self.center, turning, sliding: Vec2::default(), slopes };
        }
        let slope = self.direction * self.ratio;
        Hung { cos: 1.0, sin: 0.0, place: slope * q, turning: 0.0, sliding: slope * v, slopes: (0.0, slope) }
    }

    /// Its pose where it hangs like this.
    pub fn pose(&self, hung: &Hung) -> Pose {
        Pose { cos: hung.cos, sin: hung.sin, shift: hung.place - hung.rotate(self.center) }
    }
}

impl Hung {
    #[inline]
    fn rotate(&self, p: Vec2) -> Vec2 {
        Vec2::new(self.cos * p.x - self.sin * p.y, self.sin * p.x + self.cos * p.y)
    }

    /// Velocity of the body's point at `arm` from its place, and its acceleration without one of the coordinate.
    #[inline]
    fn motion(&self, arm: Vec2) -> (Vec2, Vec2) {
        (self.sliding + arm.perp() * self.turning, arm * (-self.turning * self.turning))
    }

    /// `n · ∂p/∂q` of the same point.
    #[inline]
    fn slope(&self, n: Vec2, arm: Vec2) -> f64 {
        self.slopes.0 * n.dot(arm.perp()) + n.dot(self.slopes.1)
    }
}

/// The same contact between bodies on one joint each.
#[derive(Clone, Copy, Debug)]
pub struct HingeConstraint {
    /// Of an edge, the radius that counts is the distance of the round one's centre from the parallel through the edge's
    /// own place.
    shapes: Shapes,
}

/// It at one state: `g`, `ġ`, γ, and ∂g/∂q by the first and by the second body's coordinate.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hinged {
    pub gap: f64,
    pub rate: f64,
    pub bias: f64,
    pub slopes: [f64; 2],
}

impl HingeConstraint {
    /// Of a constraint whose bodies hang like this.
    pub fn new(constraint: &Constraint, (a, b): (&Hinge, &Hinge)) -> Self {
        let shapes = match constraint.shapes {
            Shapes::RoundEdge { center, radius, from, normal, edge_first } => {
                let (round, edge) = if edge_first { (b, a) } else { (a, b) };
                let (center, from) = (round.local(center), edge.local(from));
                Shapes::RoundEdge { center, radius: radius + normal.dot(from), from, normal, edge_first }
            }
            Shapes::Centers { first, second, touching, side } => {
                Shapes::Centers { first: a.local(first), second: b.local(second), touching, side }
            }
        };
        Self { shapes }
    }

    /// Between its bodies where they are.
    #[inline]
    pub fn at(&self, a: &Hung, b: &Hung) -> Hinged {
        match self.shapes {
            Shapes::RoundEdge { center, radius, normal, edge_first, .. } => {
                let (round, edge) = if edge_first { (b, a) } else { (a, b) };
                let arm = round.rotate(center);
                let n = edge.rotate(normal);
                let across = round.place - edge.place + arm;
                let gap = n.dot(across) - radius;
                let ((u, du), (w, dw)) = (round.motion(arm), edge.motion(across));
                let velocity = u - w;
                let bias = n.dot(du - dw) - 2.0 * edge.turning * n.dot(velocity.perp());
                let slopes = [round.slope(n, arm), -edge.slope(n, across)];
                let slopes = if edge_first { [slopes[1], slopes[0]] } else { slopes };
                Hinged { gap, rate: n.dot(velocity), bias, slopes }
            }
            Shapes::Centers { first, second, touching, side } => {
                let arms = (a.rotate(first), b.rotate(second));
                let d = a.place - b.place + arms.0 - arms.1;
                let distance = d.norm();
                let inverse = if distance > 0.0 { side / distance } else { 0.0 };
                let n = if distance > 0.0 { d * inverse } else { Vec2::new(side, 0.0) };
                let ((u, du), (w, dw)) = (a.motion(arms.0), b.motion(arms.1));
                let velocity = u - w;
                let across = n.cross(velocity);
                let bias = n.dot(du - dw) + across * across * inverse;
                let slopes = [a.slope(n, arms.0), -b.slope(n, arms.1)];
                Hinged { gap: side * (distance - touching), rate: n.dot(velocity), bias, slopes }
            }
        }
    }
}
