//! Face on face: where two plane faces meet.

use super::bounds::Bounds;
use super::patch::{Line, Meeting, Scene, Site, scan};
use super::region::{Carrier, Member, Region, within};
use super::surface::{Face, parallel};
use super::work::Work;
use mainspring_geometry::{Shape, Vec2, Vec3};

/// Lines laid over the rectangle where a tilted round primitive cuts it, besides the exact events.
const EXTRA_LINES: usize = 48;
/// With more walls than this in one plane, their crossings are not looked for: evenly spread lines must do.
const MAX_TRACES: usize = 200;

/// A piece of plane where two parts meet.
#[derive(Clone, Debug)]
pub(crate) struct PlanePatch {
    /// Unit normal out of the first part.
    pub normal: Vec3,
    /// Distance between the faces, from the first part to the second: 0, or up to the clearance.
    pub gap: f64,
    /// Corners of the cells, on the first part's face.
    pub corners: Vec<Vec3>,
    pub area: f64,
    pub faces: [Face; 2],
}

/// The patches of two faces in planes at distance `gap` (from `a` along its normal to `b`).
pub(crate) fn meet(scene: &Scene<'_>, sites: [&Site<'_>; 2], a: &Face, b: &Face) -> Vec<PlanePatch> {
    let n = a.normal;
    let gap = (b.middle - a.middle).dot(n);
    let [(u, _), (v, _)] = a.along;
    let origin = a.middle;
    let flat = |p: Vec3| Vec2::new((p - origin).dot(u), (p - origin).dot(v));
    let Some((low, high)) = common_rectangle(a, b, flat, scene.tolerance) else { return vec![] };
    let at = |s: f64, t: f64| origin + u * s + v * t;
    let near = Bounds::of_points(
        [at(low.x, low.y), at(high.x, low.y), at(low.x, high.y), at(high.x, high.y)]
            .into_iter()
            .flat_map(|p| [p, p + n * gap]),
    );
    if !scene.work.spend(scene.primitives_of(sites)) {
        return vec![];
    }
    let regions = sites.map(|site| scene.region(site, &near, Carrier::Plane));
    let members: usize = regions.iter().map(|r| r.members.len()).sum();
    if !scene.work.spend(4 * members) {
        return vec![];
    }
    let frame = Frame { origin, u, v, n, low: low.x, high: high.x };
    let mut breaks = vec![low.x, high.x];
    for (region, shift) in regions.iter().zip([0.0, gap]) {
        let frame = Frame { origin: origin + n * shift, ..frame };
        if !events(region, &frame, scene.tolerance, &scene.work, &mut breaks) {
            return vec![];
        }
    }
    breaks.retain(|s| *s >= low.x && *s <= high.x);
    let owners = [a, b].map(|f| scene.member(f.id.primitive, Carrier::Plane));
    let span = |line: &Line| {
        let [a, b] = [0, 1].map(|i| on_face(&owners[i], line, i, scene.tolerance));
        let ((a, b), (c, d)) = (a?, b?);
        let (from, to) = (a.max(c).max(low.y), b.min(d).min(high.y));
        (to - from > scene.tolerance).then_some((from, to))
    };
    let line = |s| Line { from: [at(s, 0.0), at(s, 0.0) + n * gap], along: v, normal: n };
    let tolerance = scene.tolerance;
    let meeting = scan([&regions[0], &regions[1]], breaks, span, tolerance, tolerance, &scene.work, line);
    patches(&meeting, gap, n, [*a, *b], at, scene.tolerance)
}

fn patches(
    meeting: &Meeting,
    gap: f64,
    n: Vec3,
    faces: [Face; 2],
    at: impl Fn(f64, f64) -> Vec3,
    tolerance: f64,
) -> Vec<PlanePatch> {
    let mut found = Vec::new();
    for solid in [true, false] {
        // With a gap between them only the outward one can face the other.
        if !solid && gap > tolerance {
            continue;
        }
        let cells = || meeting.cells.iter().filter(|c| c.first_is_solid == solid);
        let area: f64 = cells().map(|c| (c.s.1 - c.s.0) * (c.t.1 - c.t.0)).sum();
        if area > 0.0 {
            let corners = cells()
                .flat_map(|c| [(c.s.0, c.t.0), (c.s.0, c.t.1), (c.s.1, c.t.0), (c.s.1, c.t.1)])
                .map(|(s, t)| at(s, t))
                .collect();
            let normal = if solid { n } else { -n };
            found.push(PlanePatch { normal, gap: gap.max(0.0), corners, area, faces });
        }
    }
    found
}

/// The stretch of a line in a face of a primitive: faces are convex.
fn on_face(owner: &Member, line: &Line, which: usize, tolerance: f64) -> Option<(f64, f64)> {
    let (from, along) = (line.from[which], line.along);
    let mut cuts = Vec::with_capacity(6);
    owner.crossings(from, along, &mut cuts);
    cuts.sort_by(f64::total_cmp);
    let inside = |c: &&[f64]| owner.reaches(from + along * within(c[0], c[1]), 2.0 * tolerance);
    let mut stretches = cuts.windows(2).filter(|c| c[1] - c[0] > tolerance).filter(inside);
    let first = stretches.next()?;
    Some((first[0], stretches.next_back().unwrap_or(first)[1]))
}

fn common_rectangle(a: &Face, b: &Face, flat: impl Fn(Vec3) -> Vec2, tolerance: f64) -> Option<(Vec2, Vec2)> {
    let around = |face: &Face| {
        let p = face.corners().map(&flat);
        let least =
            |f: fn(f64, f64) -> f64, pick: fn(&Vec2) -> f64| p.iter().map(pick).reduce(f).unwrap_or(0.0);
        let low = Vec2::new(least(f64::min, |p| p.x), least(f64::min, |p| p.y));
        (low, Vec2::new(least(f64::max, |p| p.x), least(f64::max, |p| p.y)))
    };
    let ((l1, h1), (l2, h2)) = (around(a), around(b));
    let low = Vec2::new(l1.x.max(l2.x), l1.y.max(l2.y));
    let high = Vec2::new(h1.x.min(h2.x), h1.y.min(h2.y));
    (high.x - low.x > tolerance && high.y - low.y > tolerance).then_some((low, high))
}

#[derive(Clone, Copy)]
struct Frame {
    origin: Vec3,
    u: Vec3,
    v: Vec3,
    n: Vec3,
    low: f64,
    high: f64,
}

/// A curve in which a member's wall cuts the plane.
#[derive(Clone, Copy)]
enum Trace {
    /// Points p with `normal · p = offset`.
    Line {
        normal: Vec2,
        offset: f64,
    },
    Circle {
        center: Vec2,
        radius: f64,
    },
}

/// Positions of vertices: crossings of traces, and the leftmost and rightmost points of circles.
/// False if the work ran out.
fn events(region: &Region, frame: &Frame, tolerance: f64, work: &Work, breaks: &mut Vec<f64>) -> bool {
    let mut traces: Vec<(usize, Trace)> = Vec::new();
    let mut tilted = false;
    for (i, member) in region.members.iter().enumerate() {
        let before = traces.len();
        tilted |= member_traces(member, frame, tolerance, |trace| traces.push((i, trace)));
        for &(_, trace) in &traces[before..] {
            if let Trace::Circle { center, radius } = trace {
                breaks.extend([center.x - radius, center.x + radius]);
            }
        }
    }
    if tilted || traces.len() > MAX_TRACES {
        let step = (frame.high - frame.low) / EXTRA_LINES as f64;
        breaks.extend((1..EXTRA_LINES).map(|k| frame.low + k as f64 * step));
    }
    if traces.len() > MAX_TRACES {
        return true;
    }
    for (k, &(i, a)) in traces.iter().enumerate() {
        let around = region.members[i].bounds.grown(tolerance);
        let (mut other, mut near) = (usize::MAX, false);
        for &(j, b) in &traces[..k] {
            // The traces of a member are neighbours.
            if j != other {
                (other, near) = (j, around.touches(&region.members[j].bounds));
            }
            if !near {
                continue;
            }
            for p in crossings(a, b).into_iter().flatten() {
                if p.x < frame.low || p.x > frame.high {
                    continue;
                }
                let point = frame.origin + frame.u * p.x + frame.v * p.y;
                let slack = 1e3 * tolerance;
                if region.members[i].reaches(point, slack) && region.members[j].reaches(point, slack) {
                    breaks.push(p.x);
                }
            }
        }
        if !work.spend(k + 1) {
            return false;
        }
    }
    true
}

/// Hands out a member's traces; true if it has walls whose trace is neither a line nor a circle.
fn member_traces(
    member: &super::region::Member,
    frame: &Frame,
    tolerance: f64,
    mut push: impl FnMut(Trace),
) -> bool {
    for (normal, point) in member.planes() {
        let flat = Vec2::new(normal.dot(frame.u), normal.dot(frame.v));
        if flat.norm() > 1e-9 {
            push(Trace::Line { normal: flat, offset: normal.dot(point - frame.origin) });
        }
    }
    let pose = &member.machine_from_local;
    let offset = pose.translation - frame.origin;
    let center = Vec2::new(offset.dot(frame.u), offset.dot(frame.v));
    let upright = parallel(pose.columns[2], frame.n);
    match member.shape {
        Shape::Block { .. } | Shape::Wedge { .. } => false,
        Shape::Cylinder { radius, .. } if upright => {
            push(Trace::Circle { center, radius });
            false
        }
        Shape::Cylinder { radius, .. } if pose.columns[2].dot(frame.n).abs() < 1e-9 => {
            // An axis in parallel to the plane: two straight lines, if it reaches the plane.
            let height = offset.dot(frame.n);
            let half = (radius * radius - height * height).max(0.0).sqrt();
            let axis = pose.columns[2];
            let d = Vec2::new(axis.dot(frame.u), axis.dot(frame.v));
            for side in [-half, half] {
                push(Trace::Line { normal: d.perp(), offset: d.perp().dot(center) + side });
            }
            false
        }
        Shape::Sphere { radius } => {
            let height = offset.dot(frame.n);
            if radius - height.abs() > tolerance {
                push(Trace::Circle { center, radius: (radius * radius - height * height).sqrt() });
            }
            false
        }
        Shape::Cone { radius, height } if upright => {
            let up = pose.columns[2].dot(-offset);
            push(Trace::Circle { center, radius: (radius * (1.0 - up / height)).abs() });
            false
        }
        _ => true,
    }
}

fn crossings(a: Trace, b: Trace) -> [Option<Vec2>; 2] {
    match (a, b) {
        (Trace::Line { normal: m, offset: c }, Trace::Line { normal: n, offset: d }) => {
            let det = m.cross(n);
            let point = Vec2::new(c * n.y - d * m.y, d * m.x - c * n.x) * (1.0 / det);
            [(det.abs() > 1e-9).then_some(point), None]
        }
        (Trace::Line { normal, offset }, Trace::Circle { center, radius })
        | (Trace::Circle { center, radius }, Trace::Line { normal, offset }) => {
            let length = normal.norm();
            on_circle(center, radius, normal * (1.0 / length), offset / length)
        }
        (Trace::Circle { center: p, radius: r }, Trace::Circle { center: q, radius: s }) => {
            let (apart, d) = (q - p, (q - p).norm());
            if d == 0.0 {
                return [None, None];
            }
            // The common chord lies at distance (r² − s² + d²)/2d from p.
            let along = apart * (1.0 / d);
            on_circle(p, r, along, along.dot(p) + 0.5 * (r * r - s * s + d * d) / d)
        }
    }
}

/// Points of a circle on the line `n · p = offset`, n a unit vector.
fn on_circle(center: Vec2, radius: f64, n: Vec2, offset: f64) -> [Option<Vec2>; 2] {
    let h = offset - n.dot(center);
    let rest = radius * radius - h * h;
    if rest < -1e-6 * radius * radius {
        return [None, None];
    }
    // A line that only touches counts: rounding must not hide the point.
    let (foot, w) = (center + n * h, n.perp() * rest.max(0.0).sqrt());
    [Some(foot + w), Some(foot - w)]
}
