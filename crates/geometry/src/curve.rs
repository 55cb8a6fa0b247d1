//! Supporting curves of a planar section and their common points, over any scalar.
//!
//! A line is the set of points p with n·(p − a) = 0, n its unit normal pointing out of the primitive; its
//! direction is n turned a quarter counterclockwise, so the primitive lies to the left. A circle runs
//! counterclockwise. Common points are named by a [`Root`], so that they can be found again at other
//! parameter values and over dual numbers.

use crate::{Primitive, Rigid3, Scalar, Shape, Vec2, Vec3};

/// A supporting curve in the coordinates of the working plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve<S = f64> {
    /// Through `point`, with the unit `normal` pointing out of the primitive.
    Line {
        point: Vec2<S>,
        normal: Vec2<S>,
    },
    Circle {
        center: Vec2<S>,
        radius: S,
    },
}

/// Which of the common points of two curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Root {
    /// The one point of two lines.
    Only,
    /// Line and circle: the first along the line's direction. Two circles: right of the way from the
    /// first centre to the second.
    Minus,
    /// Line and circle: the second along the line's direction. Two circles: left of that way.
    Plus,
    /// The curves touch: the foot of the centre on the line, or the point on the line of centres.
    /// Evaluated by projection, so derivatives stay finite where the two roots fall together.
    Tangent,
    /// Of edges given by walls: where the first curve's wall starts. Such a corner is no common point of curves:
    /// it is known from the wall that starts there.
    Start,
    /// Of edges given by walls: where the first curve's wall ends.
    End,
}

impl<S: Scalar> Curve<S> {
    /// The trace of a lateral face (numbered as in [`crate::CurveId`]) in the working plane. `None` for a
    /// face that is not lateral here or a shape without planar section.
    pub fn of(primitive: &Primitive<S>, face: u8, plane_from_machine: &Rigid3<S>) -> Option<Self> {
        let pose = plane_from_machine.then_after(&primitive.machine_from_local);
        match primitive.shape {
            Shape::Block { x, y, z } if face < 6 => {
                let axis = usize::from(face / 2);
                let column = pose.columns[axis];
                let out = if face % 2 == 1 { [x, y, z][axis] } else { S::constant(0.0) };
                let normal = Vec2::new(column.x, column.y).unit();
                let normal = if face % 2 == 1 { normal } else { -normal };
                Some(Curve::Line { point: flat(pose.translation + column * out), normal })
            }
            Shape::Cylinder { radius, .. } if face == 0 => {
                Some(Curve::Circle { center: flat(pose.translation), radius })
            }
            _ => None,
        }
    }

    /// The named common point of two curves; not finite where it does not exist.
    pub fn meet(&self, other: &Self, root: Root) -> Vec2<S> {
        match (*self, *other) {
            (Curve::Line { point: p, normal: n }, Curve::Line { point: q, normal: m }) => {
                let along = n.perp();
                p + along * (m.dot(q - p) / m.dot(along))
            }
            (Curve::Line { point, normal }, Curve::Circle { center, radius })
            | (Curve::Circle { center, radius }, Curve::Line { point, normal }) => {
                line_circle(point, normal, center, radius, root)
            }
            (Curve::Circle { center: a, radius: r }, Curve::Circle { center: b, radius: s }) => {
                circle_circle(a, r, b, s, root)
            }
        }
    }
}

fn flat<S: Scalar>(v: Vec3<S>) -> Vec2<S> {
    Vec2::new(v.x, v.y)
}

fn signed<S: Scalar>(root: Root, value: S) -> S {
    if root == Root::Minus { -value } else { value }
}

fn line_circle<S: Scalar>(p: Vec2<S>, n: Vec2<S>, c: Vec2<S>, r: S, root: Root) -> Vec2<S> {
    let along = n.perp();
    let (h, foot) = (n.dot(c - p), p + along * along.dot(c - p));
    if root == Root::Tangent {
        return foot;
    }
    foot + along * signed(root, ((r - h) * (r + h)).sqrt())
}

fn circle_circle<S: Scalar>(a: Vec2<S>, r: S, b: Vec2<S>, s: S, root: Root) -> Vec2<S> {
    let e = b - a;
    let dd = e.dot(e);
    if root == Root::Tangent {
        let d = dd.sqrt();
        let inner = d.re() < r.re().max(s.re()) && r.re() < s.re();
        return a + e * ((if inner { -r } else { r }) / d);
    }
    let (sum, difference) = (r + s, r - s);
    let along = (dd + sum * difference) / (dd * 2.0);
    let sixteenth = (sum * sum - dd) * (dd - difference * difference);
    a + e * along + e.perp() * signed(root, sixteenth.sqrt() / (dd * 2.0))
}

impl Curve<f64> {
    pub(crate) fn is_circle(&self) -> bool {
        matches!(self, Curve::Circle { .. })
    }

    /// Do the curves touch within `tolerance` (a length) rather than cross?
    pub(crate) fn touches(&self, other: &Self, tolerance: f64) -> bool {
        match (*self, *other) {
            (Curve::Line { .. }, Curve::Line { .. }) => false,
            (Curve::Line { .. }, Curve::Circle { center, radius }) => {
                (self.distance(center) - radius).abs() <= tolerance
            }
            (Curve::Circle { .. }, Curve::Line { .. }) => other.touches(self, tolerance),
            (Curve::Circle { center: a, radius: r }, Curve::Circle { center: b, radius: s }) => {
                let d = (b - a).norm();
                (d - (r + s)).abs() <= tolerance || (d - (r - s).abs()).abs() <= tolerance
            }
        }
    }

    /// All common points. `tolerance` is a length; lines whose directions differ by at most `angle`
    /// (radians) count as parallel.
    pub(crate) fn common_points(&self, other: &Self, tolerance: f64, angle: f64) -> [Option<Vec2>; 2] {
        if let (Curve::Line { normal: n, .. }, Curve::Line { normal: m, .. }) = (self, other) {
            let parallel = n.cross(*m).abs() <= angle;
            return [(!parallel).then(|| self.meet(other, Root::Only)), None];
        }
        if self.touches(other, tolerance) {
            return [Some(self.meet(other, Root::Tangent)), None];
        }
        [Root::Minus, Root::Plus].map(|root| {
            let p = self.meet(other, root);
            (p.x.is_finite() && p.y.is_finite()).then_some(p)
        })
    }

    /// The root that names `point` among the common points of two curves, the nearest one; `touching` if
    /// they touch there, or if they no longer cross.
    pub(crate) fn root_at(&self, other: &Self, point: Vec2, touching: bool) -> Root {
        if let (Curve::Line { .. }, Curve::Line { .. }) = (self, other) {
            return Root::Only;
        }
        let [minus, plus] = [Root::Minus, Root::Plus].map(|r| (self.meet(other, r) - point).norm());
        if touching || !minus.is_finite() || !plus.is_finite() {
            Root::Tangent
        } else if minus < plus {
            Root::Minus
        } else {
            Root::Plus
        }
    }

    /// Unsigned distance of a point.
    pub(crate) fn distance(&self, p: Vec2) -> f64 {
        match *self {
            Curve::Line { point, normal } => normal.dot(p - point).abs(),
            Curve::Circle { center, radius } => ((p - center).norm() - radius).abs(),
        }
    }

    /// The parameter of the nearest point: length along a line, angle (radians) on a circle.
    pub(crate) fn parameter(&self, p: Vec2) -> f64 {
        match *self {
            Curve::Line { point, normal } => normal.perp().dot(p - point),
            Curve::Circle { center, .. } => (p.y - center.y).atan2(p.x - center.x),
        }
    }

    /// The point at a parameter.
    pub(crate) fn point(&self, t: f64) -> Vec2 {
        match *self {
            Curve::Line { point, normal } => point + normal.perp() * t,
            Curve::Circle { center, radius } => center + Vec2::new(t.cos(), t.sin()) * radius,
        }
    }

    /// The unit tangent at a point of the curve, in the curve's own direction.
    pub(crate) fn tangent(&self, p: Vec2) -> Vec2 {
        match *self {
            Curve::Line { normal, .. } => normal.perp(),
            Curve::Circle { center, .. } => (p - center).perp().unit(),
        }
    }
}
