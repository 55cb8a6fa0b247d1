//! Shaft in hole: where the curved surfaces of two coaxial cylinders meet (Gelsey 1995, Algorithm 3).

use super::bounds::Bounds;
use super::patch::{Line, Meeting, Scene, Site, scan};
use super::region::{Carrier, Member, Region};
use super::surface::{Lateral, across, parallel};
use mainspring_geometry::{Shape, Vec3};
use std::f64::consts::TAU;

/// Lines laid around the circle where a tilted primitive cuts it, besides the exact events.
const EXTRA_LINES: usize = 48;

/// Scans the common stretch of two coaxial cylinders `a` and `b`. Scan parameter: the angle about the axis, from
/// the first direction of [`across`]; lines run along the axis, measured from `a`'s middle.
pub(crate) fn meet(scene: &Scene<'_>, sites: [&Site<'_>; 2], a: &Lateral, b: &Lateral) -> Meeting {
    let d = a.direction;
    let Some(span) = common_span(a, b, scene.tolerance) else { return Meeting::default() };
    let (u, v) = across(d);
    let near = around(a.middle, d, span, a.radius.max(b.radius));
    let radii = [a.radius, b.radius];
    if !scene.work.spend(scene.primitives_of(sites)) {
        return Meeting::default();
    }
    let regions = [0, 1].map(|i| {
        let carrier = Carrier::Cylinder { point: a.middle, direction: d, radius: radii[i] };
        scene.region(sites[i], &near, carrier)
    });
    let members: usize = regions.iter().map(|r| r.members.len()).sum();
    if !scene.work.spend(8 * members) {
        return Meeting::default();
    }
    let mut breaks = vec![0.0, TAU];
    for (region, radius) in regions.iter().zip(radii) {
        let circle = Circle { center: a.middle, d, u, v, radius };
        events(region, &circle, scene.tolerance, &mut breaks);
    }
    let least = scene.tolerance / a.radius.min(b.radius);
    scan(
        [&regions[0], &regions[1]],
        breaks,
        |_| Some(span),
        least,
        scene.tolerance,
        &scene.work,
        |angle| {
            let (sin, cos) = angle.sin_cos();
            let normal = u * cos + v * sin;
            Line { from: radii.map(|r| a.middle + normal * r), along: d, normal }
        },
    )
}

/// The stretch of the axis both have, from `a`'s middle; none below the tolerance.
pub(crate) fn common_span(a: &Lateral, b: &Lateral, tolerance: f64) -> Option<(f64, f64)> {
    let offset = (b.middle - a.middle).dot(a.direction);
    let low = (-0.5 * a.height).max(offset - 0.5 * b.height);
    let high = (0.5 * a.height).min(offset + 0.5 * b.height);
    (high - low > tolerance).then_some((low, high))
}

fn around(middle: Vec3, d: Vec3, span: (f64, f64), radius: f64) -> Bounds {
    let r = Vec3::new(radius, radius, radius);
    let ends = [middle + d * span.0, middle + d * span.1];
    Bounds::of_points(ends.iter().flat_map(|&e| [e - r, e + r]))
}

struct Circle {
    center: Vec3,
    d: Vec3,
    u: Vec3,
    v: Vec3,
    radius: f64,
}

/// Angles at which a wall parallel to the axis crosses the surface; evenly spread ones for tilted walls.
fn events(region: &Region, circle: &Circle, tolerance: f64, breaks: &mut Vec<f64>) {
    let mut tilted = false;
    for member in &region.members {
        match member.shape {
            Shape::Block { .. } | Shape::Wedge { .. } => tilted |= flat_events(member, circle, breaks),
            Shape::Cylinder { radius, .. } | Shape::Cone { radius, .. } => {
                let axis = member.machine_from_local.columns[2];
                let is_cone = matches!(member.shape, Shape::Cone { .. });
                let offset = member.machine_from_local.translation - circle.center;
                let apart = offset.cross(circle.d).norm();
                if !parallel(axis, circle.d) || (is_cone && apart > tolerance) {
                    tilted = true;
                } else if apart > tolerance {
                    round_events(offset, radius, circle, breaks);
                }
            }
            Shape::Sphere { .. } => {
                let offset = member.machine_from_local.translation - circle.center;
                tilted |= offset.cross(circle.d).norm() > tolerance;
            }
        }
    }
    if tilted {
        breaks.extend((1..EXTRA_LINES).map(|k| k as f64 * TAU / EXTRA_LINES as f64));
    }
}

/// Events of plane walls; true if one is tilted against the axis.
fn flat_events(member: &Member, circle: &Circle, breaks: &mut Vec<f64>) -> bool {
    let mut tilted = false;
    for (normal, point) in member.planes() {
        let (a, b) = (normal.dot(circle.u) * circle.radius, normal.dot(circle.v) * circle.radius);
        let along = normal.dot(circle.d).abs();
        if along < 1e-9 {
            circle_roots(a, b, normal.dot(point - circle.center), breaks);
        } else if along < 1.0 - 1e-12 {
            tilted = true;
            breaks.push(b.atan2(a).rem_euclid(TAU));
        }
    }
    tilted
}

/// Where the circle of radius r meets that of radius ρ at offset c: `r² + c² − 2 r c·w = ρ²`.
fn round_events(offset: Vec3, radius: f64, circle: &Circle, breaks: &mut Vec<f64>) {
    let (x, y) = (offset.dot(circle.u), offset.dot(circle.v));
    let r = circle.radius;
    let d = 0.5 * (r * r + x * x + y * y - radius * radius);
    circle_roots(r * x, r * y, d, breaks);
}

/// Angles in [0, 2π) with `a cos θ + b sin θ = d`, by half angles.
fn circle_roots(a: f64, b: f64, d: f64, breaks: &mut Vec<f64>) {
    let k = a.hypot(b);
    if k * (1.0 + 1e-6) <= d.abs() || k == 0.0 {
        return;
    }
    // A wall that only touches counts: rounding must not hide the angle.
    let half = 2.0 * ((k - d).max(0.0) / (k + d).max(f64::MIN_POSITIVE)).sqrt().atan();
    let middle = b.atan2(a);
    breaks.extend([middle - half, middle + half].map(|t| t.rem_euclid(TAU)));
}
