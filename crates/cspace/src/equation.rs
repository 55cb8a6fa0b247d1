//! The contact of two features as one equation in the two joint positions (u, v).
//!
//! ```text
//! arc, arc    F = s (|c₁−c₂|² − ρ²) / (2ρ)     ρ = r₁+r₂, s = 1 outside; ρ = R−r, s = −1 inside
//! arc, edge   F = N·(c − f) − r
//! ```
//! F has the sign, the zeros and (at zero) the first derivatives of the gap; unlike |c₁−c₂| it stays smooth where two
//! centres coincide. Positions are in the plane of the machine; u and v are scaled joint positions of `Moving`.

use crate::moving::{Carried, Fixed, Kind, Moving, Roots};
use crate::shape::{Shape, unrotate};
use mainspring_geometry::Vec2;
use mainspring_mechanism::Pose;

/// Two features that can touch. `first` belongs to the body that u moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Equation {
    pub shapes: [Shape; 2],
    pub carried: [Carried; 2],
    /// ρ of two arcs, r of an arc against an edge.
    pub rho: f64,
    /// +1 outside, −1 inside (two arcs).
    pub side: f64,
}

/// F with its gradient.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Value {
    pub f: f64,
    pub fu: f64,
    pub fv: f64,
}

/// A contact point with its normal from the second body to the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub point: Vec2,
    pub normal: Vec2,
}

fn carrier(shape: &Shape) -> (Carried, f64, bool) {
    match *shape {
        Shape::Edge { from, normal, .. } => (Carried::Line { normal, offset: normal.dot(from) }, 0.0, false),
        Shape::Arc { center, radius, hollow, .. } => (Carried::Point(center), radius, hollow),
    }
}

impl Equation {
    /// The shapes must be able to touch (`GapKind::of`).
    pub fn new(shapes: [Shape; 2]) -> Self {
        let [(a, r, hollow_a), (b, s, hollow_b)] = shapes.map(|s| carrier(&s));
        let inside = hollow_a || hollow_b;
        let rho = if inside { (r - s).abs() } else { r + s };
        Equation { shapes, carried: [a, b], rho, side: if inside { -1.0 } else { 1.0 } }
    }

    pub fn swapped(&self) -> Self {
        let [a, b] = self.shapes;
        let [c, d] = self.carried;
        Equation { shapes: [b, a], carried: [d, c], ..*self }
    }

    /// What the second body meets with the first placed at `pose`.
    fn fixed(&self, pose: &Pose) -> Fixed {
        match self.carried[0] {
            Carried::Point(p) => Fixed::Point { at: pose.apply(p), rho: self.rho },
            Carried::Line { normal, offset } => {
                let n = pose.rotate(normal);
                Fixed::Line { normal: n, offset: offset + n.dot(pose.shift) + self.rho }
            }
        }
    }

    /// Positions v of the second body at which the features touch with the first at u.
    pub fn solve_v(&self, moving: &[Moving; 2], u: f64) -> Roots {
        moving[1].solve(self.carried[1], self.fixed(&moving[0].place(u)))
    }

    /// One of them, with the first body at `pose`, but for whole turns.
    pub fn root_v(&self, moving: &[Moving; 2], pose: &Pose, branch: f64) -> f64 {
        moving[1].root(self.carried[1], self.fixed(pose), branch)
    }

    /// F and its gradient.
    pub fn value(&self, moving: &[Moving; 2], u: f64, v: f64) -> Value {
        let poses = [moving[0].place(u), moving[1].place(v)];
        self.value_at(moving, &poses)
    }

    pub fn value_at(&self, moving: &[Moving; 2], poses: &[Pose; 2]) -> Value {
        match (self.carried[0], self.carried[1]) {
            (Carried::Point(a), Carried::Point(b)) => {
                let (a, b) = (poses[0].apply(a), poses[1].apply(b));
                let d = a - b;
                let k = self.side / self.rho;
                let f = 0.5 * k * (d.dot(d) - self.rho * self.rho);
                let fu = k * d.dot(moving[0].velocity(a));
                Value { f, fu, fv: -k * d.dot(moving[1].velocity(b)) }
            }
            (Carried::Point(a), Carried::Line { normal, offset }) => {
                let (f, fp, fl) = line((&moving[0], &poses[0], a), (&moving[1], &poses[1], normal, offset));
                Value { f: f - self.rho, fu: fp, fv: fl }
            }
            (Carried::Line { normal, offset }, Carried::Point(b)) => {
                let (f, fp, fl) = line((&moving[1], &poses[1], b), (&moving[0], &poses[0], normal, offset));
                Value { f: f - self.rho, fu: fl, fv: fp }
            }
            (Carried::Line { .. }, Carried::Line { .. }) => Value { f: f64::NAN, fu: 0.0, fv: 0.0 },
        }
    }

    /// How far inside both features the contact lies: lengths along an edge (over its length unit `size`), radians
    /// in cones; negative outside.
    pub fn margin(&self, poses: &[Pose; 2], size: f64) -> f64 {
        match (&self.shapes[0], &self.shapes[1]) {
            (Shape::Arc { .. }, Shape::Arc { .. }) => self.arcs_margin(poses),
            (Shape::Arc { .. }, Shape::Edge { .. }) => {
                edge_margin((&self.shapes[0], &poses[0]), (&self.shapes[1], &poses[1]), size)
            }
            (Shape::Edge { .. }, Shape::Arc { .. }) => {
                edge_margin((&self.shapes[1], &poses[1]), (&self.shapes[0], &poses[0]), size)
            }
            (Shape::Edge { .. }, Shape::Edge { .. }) => f64::NEG_INFINITY,
        }
    }

    /// Directions in which the contact lies from the two centres.
    fn outward(&self, d: Vec2) -> [Vec2; 2] {
        let hollow = self.shapes.map(|s| matches!(s, Shape::Arc { hollow: true, .. }));
        match hollow {
            [false, false] => [-d, d],
            [false, true] => [d, d],
            _ => [-d, -d],
        }
    }

    fn arcs_margin(&self, poses: &[Pose; 2]) -> f64 {
        let (Shape::Arc { center: a, directions: da, .. }, Shape::Arc { center: b, directions: db, .. }) =
            (&self.shapes[0], &self.shapes[1])
        else {
            return f64::NEG_INFINITY;
        };
        let d = poses[0].apply(*a) - poses[1].apply(*b);
        let length = d.norm();
        if length == 0.0 {
            return f64::NEG_INFINITY;
        }
        let [out_a, out_b] = self.outward(d * (1.0 / length));
        da.margin(unrotate(&poses[0], out_a)).min(db.margin(unrotate(&poses[1], out_b)))
    }

    /// Contact point and normal, for a configuration on the curve.
    pub fn touch(&self, poses: &[Pose; 2]) -> Touch {
        let edge = |arc: (&Shape, &Pose), line: (&Shape, &Pose), sense: f64| match (arc.0, line.0) {
            (Shape::Arc { center, radius, .. }, Shape::Edge { normal, .. }) => {
                let n = line.1.rotate(*normal);
                Touch { point: arc.1.apply(*center) - n * *radius, normal: n * sense }
            }
            _ => Touch { point: Vec2::default(), normal: Vec2::default() },
        };
        match (&self.shapes[0], &self.shapes[1]) {
            (Shape::Arc { center: a, radius, .. }, Shape::Arc { center: b, .. }) => {
                let d = poses[0].apply(*a) - poses[1].apply(*b);
                let u = d * (1.0 / d.norm());
                Touch { point: poses[0].apply(*a) + self.outward(u)[0] * *radius, normal: u * self.side }
            }
            (Shape::Arc { .. }, _) => edge((&self.shapes[0], &poses[0]), (&self.shapes[1], &poses[1]), 1.0),
            _ => edge((&self.shapes[1], &poses[1]), (&self.shapes[0], &poses[0]), -1.0),
        }
    }

    /// Does the equation not depend on v (to `tolerance`, a length)?
    pub fn is_upright(&self, moving: &[Moving; 2], tolerance: f64) -> bool {
        let second = &moving[1];
        match (second.kind, self.carried[1]) {
            (Kind::Still, _) => true,
            (Kind::Turn, Carried::Point(b)) => b.norm() <= tolerance,
            (Kind::Turn, Carried::Line { .. }) => false,
            (Kind::Slide, Carried::Line { normal, .. }) => normal.dot(second.direction).abs() <= 1e-10,
            (Kind::Slide, Carried::Point(_)) => match self.carried[0] {
                Carried::Line { normal, .. } => {
                    !moving[0].turns() && normal.dot(second.direction).abs() <= 1e-10
                }
                Carried::Point(_) => false,
            },
        }
    }
}

/// Offset of a carried point from a carried line, and its rates by the point's and by the line's position.
fn line(point: (&Moving, &Pose, Vec2), line: (&Moving, &Pose, Vec2, f64)) -> (f64, f64, f64) {
    let p = point.1.apply(point.2);
    let n = line.1.rotate(line.2);
    let offset = n.dot(p - line.1.shift) - line.3;
    let by_line = -n.dot(line.0.velocity(p));
    (offset, n.dot(point.0.velocity(p)), by_line)
}

fn edge_margin(arc: (&Shape, &Pose), edge: (&Shape, &Pose), size: f64) -> f64 {
    let (Shape::Arc { center, directions, .. }, Shape::Edge { from, tangent, normal, length }) =
        (arc.0, edge.0)
    else {
        return f64::NEG_INFINITY;
    };
    let offset = unrotate(edge.1, arc.1.apply(*center) - edge.1.shift) - *from;
    let along = tangent.dot(offset);
    let cone = directions.margin(unrotate(arc.1, -edge.1.rotate(*normal)));
    (along.min(length - along) / size).min(cone)
}
