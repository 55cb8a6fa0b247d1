//! Rounded corners: the arc of radius f that is tangent to both edges at a corner.
//!
//! Its centre is a common point of the two edges' curves moved by f to the side to which the boundary turns, the one
//! nearest to the corner: a line moves along its normal, a circle grows or shrinks.

use super::draw::real;
use super::ring::RawEdge;
use crate::angle::{quotient, root};
use mainspring_geometry::{Curve, Root, Scalar, Segment, Vec2};

/// The arc that rounds a corner, from `start` to `end`.
pub(super) struct Corner<S> {
    pub start: Vec2<S>,
    pub end: Vec2<S>,
    center: Vec2<S>,
    radius: S,
    left: bool,
}

impl<S: Scalar> Corner<S> {
    pub fn segment(&self) -> Segment<S> {
        let Self { start, end, center, radius, left } = *self;
        Segment::Arc { from: start, to: end, center, radius, convex: left }
    }
}

/// Edges that meet at less than this (radians) are no corner.
const STRAIGHT: f64 = 1e-9;

/// `None` where there is no corner or the arc does not fit.
pub(super) fn fillet<S: Scalar>(before: &RawEdge<S>, after: &RawEdge<S>, radius: S) -> Option<Corner<S>> {
    let (d, e) = (real(&before.segment()).tangent(1.0), real(&after.segment()).tangent(0.0));
    let bend = d.cross(e);
    if bend.is_nan() || bend.abs() <= STRAIGHT {
        return None;
    }
    let left = bend > 0.0;
    let (a, b) = (offset(before, radius, left)?, offset(after, radius, left)?);
    let corner = after.from.re();
    let roots = match (&a, &b) {
        (Curve::Line { .. }, Curve::Line { .. }) => &[Root::Only][..],
        _ => &[Root::Minus, Root::Plus],
    };
    let away = |p: &Vec2<S>| (p.re() - corner).norm();
    let points = roots.iter().map(|r| a.meet(&b, *r)).filter(|p| away(p).is_finite());
    let center = points.min_by(|p, q| away(p).total_cmp(&away(q)))?;
    let (start, end) = (foot(before, center)?, foot(after, center)?);
    Some(Corner { start, end, center, radius, left })
}

/// The curve of an edge, moved to the left or right of its way.
fn offset<S: Scalar>(edge: &RawEdge<S>, by: S, left: bool) -> Option<Curve<S>> {
    match edge.arc {
        None => {
            let d = unit(edge.to - edge.from)?;
            let shift = d.perp() * if left { by } else { -by };
            Some(Curve::Line { point: edge.from + shift, normal: -d.perp() })
        }
        Some((center, radius, turns_left)) => {
            let radius = if turns_left == left { radius - by } else { radius + by };
            (radius.re() > 0.0).then_some(Curve::Circle { center, radius })
        }
    }
}

/// The point of the edge's curve nearest to the fillet's centre.
fn foot<S: Scalar>(edge: &RawEdge<S>, p: Vec2<S>) -> Option<Vec2<S>> {
    match edge.arc {
        None => {
            let d = unit(edge.to - edge.from)?;
            Some(edge.from + d * d.dot(p - edge.from))
        }
        Some((center, radius, _)) => Some(center + unit(p - center)? * radius),
    }
}

/// The unit vector, unless the vector has no length.
pub(super) fn unit<S: Scalar>(v: Vec2<S>) -> Option<Vec2<S>> {
    let length = root(v.dot(v));
    let usable = length.re() > 0.0 && length.re().is_finite();
    usable.then(|| Vec2::new(quotient(v.x, length), quotient(v.y, length)))
}

/// Is an edge with its ends cut off by fillets still a piece of the edge as written?
pub(super) fn within<S: Scalar>(written: &RawEdge<S>, cut: &RawEdge<S>) -> bool {
    let whole = real(&written.segment());
    let [a, b] = [cut.from.re(), cut.to.re()].map(|p| along(&whole, p));
    let slack = 1e-9;
    let length = real(&cut.segment()).length();
    a >= -slack && b <= 1.0 + slack && b - a > slack && length > 0.0
}

/// How far along a segment a point of its curve is; for arcs positions a little before the start are negative.
fn along(segment: &Segment, p: Vec2) -> f64 {
    match *segment {
        Segment::Line { from, to } => (to - from).dot(p - from) / (to - from).dot(to - from),
        Segment::Arc { from, center, convex, .. } => {
            let (a, b) = (from - center, p - center);
            let angle = a.cross(b).atan2(a.dot(b));
            let angle = if convex { angle } else { -angle };
            let turn = std::f64::consts::TAU;
            let sweep = segment.sweep();
            // Beyond the middle of what the arc leaves out counts as before its start.
            let angle = angle.rem_euclid(turn);
            (if angle > 0.5 * (sweep + turn) { angle - turn } else { angle }) / sweep
        }
        Segment::Circle { .. } => 0.0,
    }
}
