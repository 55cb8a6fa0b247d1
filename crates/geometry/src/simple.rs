//! Are boundaries simple: does no segment touch another but where one goes on into the next?

use crate::{Curve, OutlineError, Segment, Vec2};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// Pairs of segments with boxes that meet, looked at for one question: some tenth of a microsecond each.
const PAIRS: usize = 4_000_000;

/// Neighbours may come near each other this many tolerances from their common point: there tangent curves run
/// together.
const JOINT: f64 = 1e3;

/// Two segments that touch or cross, each by its loop and its place there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    pub first: (usize, usize),
    pub second: (usize, usize),
    pub point: Vec2,
}

/// The first two segments of closed loops that touch or cross within `tolerance` (a length, 1e-9 of the size), other
/// than at the common point of neighbours.
///
/// # Errors
/// [`OutlineError::TooComplex`] if too many segments lie near each other.
pub fn crossing(loops: &[Vec<Segment>], tolerance: f64) -> Result<Option<Crossing>, OutlineError> {
    let named: Vec<((usize, usize), &Segment)> = loops
        .iter()
        .enumerate()
        .flat_map(|(i, l)| l.iter().enumerate().map(move |(k, s)| ((i, k), s)))
        .collect();
    let boxes: Vec<_> = named.iter().map(|(_, s)| boxed(s, tolerance)).collect();
    let entry = |(i, b): (usize, &AABB<[f64; 2]>)| GeomWithData::new(Rectangle::from_aabb(*b), i);
    let tree = RTree::bulk_load(boxes.iter().enumerate().map(entry).collect());
    let mut left = PAIRS;
    let mut best: Option<(usize, usize, Vec2)> = None;
    for (i, (id, segment)) in named.iter().enumerate() {
        for other in tree.locate_in_envelope_intersecting(boxes[i]) {
            let j = other.data;
            if j <= i || best.is_some_and(|b| (b.0, b.1) < (i, j)) {
                continue;
            }
            left = left.checked_sub(1).ok_or(OutlineError::TooComplex)?;
            let (id_j, segment_j) = named[j];
            let shared = joints((*id, segment), (id_j, segment_j), loops[id.0].len());
            best = common(segment, segment_j, &shared, tolerance).map(|p| (i, j, p)).or(best);
        }
        if best.is_some() {
            break;
        }
    }
    Ok(best.map(|(i, j, point)| Crossing { first: named[i].0, second: named[j].0, point }))
}

fn boxed(s: &Segment, margin: f64) -> AABB<[f64; 2]> {
    let (min, max) = s.bounds();
    AABB::from_corners([min.x - margin, min.y - margin], [max.x + margin, max.y + margin])
}

/// Points that two segments share as neighbours in their loop of `n`.
fn joints(a: ((usize, usize), &Segment), b: ((usize, usize), &Segment), n: usize) -> Vec<Vec2> {
    let mut shared = Vec::new();
    if a.0.0 == b.0.0 {
        if (a.0.1 + 1) % n == b.0.1 {
            shared.push(b.1.start());
        }
        if (b.0.1 + 1) % n == a.0.1 {
            shared.push(a.1.start());
        }
    }
    shared
}

/// A point that two segments share, none of `joints`.
fn common(a: &Segment, b: &Segment, joints: &[Vec2], tolerance: f64) -> Option<Vec2> {
    let meets = |p: &Vec2| {
        p.x.is_finite()
            && p.y.is_finite()
            && a.reaches(*p, tolerance)
            && b.reaches(*p, tolerance)
            && joints.iter().all(|j| (*p - *j).norm() > JOINT * tolerance)
    };
    let (c, d) = (Curve::along(a), Curve::along(b));
    let points = c.common_points(&d, tolerance, 1e-12).into_iter().flatten();
    let ends = [a.start(), a.end(), b.start(), b.end()];
    points.chain(ends).find(meets)
}

impl Curve<f64> {
    /// The curve that carries a segment.
    pub(crate) fn along(segment: &Segment) -> Self {
        match *segment {
            Segment::Line { from, to } => Curve::Line { point: from, normal: -(to - from).unit().perp() },
            Segment::Arc { center, radius, .. } | Segment::Circle { center, radius, .. } => {
                Curve::Circle { center, radius }
            }
        }
    }
}

impl Segment<f64> {
    /// Is a point within `tolerance` of the segment?
    pub fn reaches(&self, p: Vec2, tolerance: f64) -> bool {
        self.distance(p) <= tolerance
    }

    /// Distance of a point from the segment, its ends included.
    pub fn distance(&self, p: Vec2) -> f64 {
        let ends = (p - self.start()).norm().min((p - self.end()).norm());
        match *self {
            Segment::Line { from, to } => {
                let d = (to - from).unit();
                let along = d.dot(p - from);
                if along < 0.0 || along > (to - from).norm() { ends } else { d.cross(p - from).abs() }
            }
            Segment::Arc { center, radius, .. } | Segment::Circle { center, radius, .. } => {
                let around = ((p - center).norm() - radius).abs();
                if self.sweeps_over(p - center) { around } else { ends }
            }
        }
    }

    /// How far along the way the point nearest to `p` is: 0 at the start, 1 at the end.
    pub(crate) fn fraction(&self, p: Vec2) -> f64 {
        match *self {
            Segment::Line { from, to } => (to - from).dot(p - from) / (to - from).dot(to - from),
            Segment::Arc { center, convex, .. } | Segment::Circle { center, convex, .. } => {
                let (a, b) = (self.start() - center, p - center);
                let angle = a.cross(b).atan2(a.dot(b));
                (if convex { angle } else { -angle }).rem_euclid(std::f64::consts::TAU) / self.sweep()
            }
        }
    }
}
