//! Where a contact curve can begin, end, turn back or run steep: critical positions u in closed form.
//!
//! - *folds*: two roots v fall together (K = |D|), or run away (a slide along an edge);
//! - *ends*: the contact reaches the end of an edge or of a cone of normals. All but one kind is a point of one body
//!   coinciding with a point of the other: the arc's centre against an end of the edge moved out by r, or one arc's
//!   centre moved by ρ along the end of its cone against the other's centre. The remaining kind is an edge flush with
//!   the end of a cone, which fixes the bodies' relative rotation and leaves one equation in u;
//! - *levels*: v reaches a limit of the domain;
//! - *extremes*: dv/du = 0, the folds of the transposed equation.

use crate::equation::Equation;
use crate::moving::{Carried, Fixed, Moving, Roots};
use crate::shape::Shape;
use mainspring_geometry::Vec2;
use std::f64::consts::PI;

/// Positions u at which the equation's roots v merge, or v runs away.
pub(crate) fn folds(eq: &Equation, moving: &[Moving; 2], out: &mut Vec<f64>) {
    let [m1, m2] = moving;
    let mut add = |roots: Roots| out.extend(roots.each());
    match (eq.carried[0], eq.carried[1], m2.turns()) {
        (Carried::Point(_), Carried::Point(b), true) => {
            let l = b.norm();
            for rho in [l + eq.rho, (l - eq.rho).abs()] {
                add(m1.solve(eq.carried[0], Fixed::Point { at: m2.center, rho }));
            }
        }
        (Carried::Point(_), Carried::Point(b), false) => {
            let normal = m2.direction.perp();
            for rho in [eq.rho, -eq.rho] {
                add(m1.solve(eq.carried[0], Fixed::Line { normal, offset: normal.dot(b) + rho }));
            }
        }
        (Carried::Point(_), Carried::Line { offset, .. }, true) => {
            let rho = (offset + eq.rho).abs();
            add(m1.solve(eq.carried[0], Fixed::Point { at: m2.center, rho }));
        }
        (Carried::Line { .. }, Carried::Point(b), true) => {
            for rho in [eq.rho + b.norm(), eq.rho - b.norm()] {
                add(m1.solve(eq.carried[0], Fixed::Point { at: m2.center, rho }));
            }
        }
        (Carried::Line { normal, .. }, Carried::Point(_), false) => {
            for d in [m2.direction.perp(), -m2.direction.perp()] {
                add(m1.aim(normal, d));
            }
        }
        _ => {}
    }
}

/// u at which the point `a` of the first body and `b` of the second can coincide.
fn coincide(moving: &[Moving; 2], a: Vec2, b: Vec2, out: &mut Vec<f64>) {
    let [m1, m2] = moving;
    let fixed = if m2.turns() {
        Fixed::Point { at: m2.center, rho: b.norm() }
    } else {
        let normal = m2.direction.perp();
        Fixed::Line { normal, offset: normal.dot(b) }
    };
    out.extend(m1.solve(Carried::Point(a), fixed).each());
}

/// Positions u at which the contact reaches the end of a feature.
pub(crate) fn ends(eq: &Equation, moving: &[Moving; 2], out: &mut Vec<f64>) {
    match (&eq.shapes[0], &eq.shapes[1]) {
        (
            Shape::Arc { center: a, directions: da, hollow: ha, .. },
            Shape::Arc { center: b, directions: db, hollow: hb, .. },
        ) => {
            // A centre moved by ρ towards the other centre.
            let step = |hollow: bool| if eq.side > 0.0 || hollow { eq.rho } else { -eq.rho };
            for e in da.ends.iter().flatten() {
                coincide(moving, *a + *e * step(*ha), *b, out);
            }
            for e in db.ends.iter().flatten() {
                coincide(moving, *a, *b + *e * step(*hb), out);
            }
        }
        (Shape::Arc { center, directions, .. }, Shape::Edge { from, tangent, normal, length }) => {
            for end in [*from, *from + *tangent * *length] {
                coincide(moving, *center, end + *normal * eq.rho, out);
            }
            for e in directions.ends.iter().flatten() {
                flush_point_line(eq, moving, *e, *center, *normal, out);
            }
        }
        (Shape::Edge { from, tangent, normal, length }, Shape::Arc { center, directions, .. }) => {
            for end in [*from, *from + *tangent * *length] {
                coincide(moving, end + *normal * eq.rho, *center, out);
            }
            for e in directions.ends.iter().flatten() {
                flush_line_point(eq, moving, *e, *center, *normal, out);
            }
        }
        _ => {}
    }
}

/// The first body's arc touches the second's edge with the end `e` of its cone.
fn flush_point_line(eq: &Equation, moving: &[Moving; 2], e: Vec2, a: Vec2, n: Vec2, out: &mut Vec<f64>) {
    let [m1, m2] = moving;
    let Carried::Line { offset, .. } = eq.carried[1] else { return };
    match (m1.turns(), m2.turns()) {
        (true, true) => {
            let line = Carried::Line { normal: e, offset: e.dot(a) };
            out.extend(m1.solve(line, Fixed::Point { at: m2.center, rho: offset + eq.rho }).each());
        }
        (true, false) => out.extend(m1.aim(e, -n).each()),
        (false, true) => {
            let fixed = Fixed::Line { normal: -e, offset: offset + eq.rho - e.dot(m2.center) };
            out.extend(m1.solve(Carried::Point(a), fixed).each());
        }
        (false, false) => {}
    }
}

/// The second body's arc touches the first's edge with the end `e` of its cone.
fn flush_line_point(eq: &Equation, moving: &[Moving; 2], e: Vec2, b: Vec2, n: Vec2, out: &mut Vec<f64>) {
    let [m1, m2] = moving;
    match (m1.turns(), m2.turns()) {
        (true, true) => {
            let rho = eq.rho + e.dot(b);
            out.extend(m1.solve(eq.carried[0], Fixed::Point { at: m2.center, rho }).each());
        }
        (true, false) => out.extend(m1.aim(n, -e).each()),
        (false, true) => {
            for v in m2.aim(e, -n).each() {
                let at = m2.place(v).apply(b);
                out.extend(m1.solve(eq.carried[0], Fixed::Point { at, rho: eq.rho }).each());
            }
        }
        (false, false) => {}
    }
}

/// Positions u at which the features touch with the second body at v.
pub(crate) fn level(eq: &Equation, moving: &[Moving; 2], v: f64, out: &mut Vec<f64>) {
    let swapped = [moving[1], moving[0]];
    out.extend(eq.swapped().solve_v(&swapped, v).each());
}

/// Positions u of extremes of v.
pub(crate) fn extremes(eq: &Equation, moving: &[Moving; 2], out: &mut Vec<f64>) {
    let (eq, swapped) = (eq.swapped(), [moving[1], moving[0]]);
    let mut steep = Vec::new();
    folds(&eq, &swapped, &mut steep);
    for v in steep {
        let roots = eq.solve_v(&swapped, v);
        // Rounding may put the two roots that have met just out of reach: a critical position too many does no harm.
        out.extend([roots.base].into_iter().filter(|u| u.is_finite()));
        if moving[0].turns() {
            out.push(roots.base + PI);
        }
    }
}

/// For an equation that does not depend on v, at position u: positions v at which the contact reaches the end of a
/// feature.
pub(crate) fn upright_ends(eq: &Equation, moving: &[Moving; 2], u: f64, out: &mut Vec<f64>) {
    let [m1, m2] = moving;
    let pose = m1.place(u);
    match (&eq.shapes[0], &eq.shapes[1]) {
        (Shape::Edge { normal, .. }, Shape::Arc { directions, .. }) if m2.turns() => {
            for e in directions.ends.iter().flatten() {
                out.extend(m2.aim(*e, -pose.rotate(*normal)).each());
            }
        }
        (Shape::Edge { from, tangent, length, .. }, Shape::Arc { center, .. }) => {
            slide_ends(m2, pose.rotate(*tangent), pose.apply(*from) - *center, *length, out);
        }
        (Shape::Arc { center, .. }, Shape::Arc { center: b, directions, .. }) if m2.turns() => {
            let d = pose.apply(*center) - m2.place(0.0).apply(*b);
            for e in directions.ends.iter().flatten() {
                out.extend(m2.aim(*e, d).each());
                out.extend(m2.aim(*e, -d).each());
            }
        }
        (Shape::Arc { center, .. }, Shape::Edge { from, tangent, length, .. }) => {
            // The edge slides along itself: its ends pass the foot of the centre.
            slide_ends(m2, -*tangent, pose.apply(*center) - *from, *length, out);
        }
        _ => {}
    }
}

/// v at which `t·(v d)` equals `t·start` and that plus the length.
fn slide_ends(m2: &Moving, t: Vec2, start: Vec2, length: f64, out: &mut Vec<f64>) {
    let rate = t.dot(m2.direction);
    if rate.abs() > 1e-12 {
        out.extend([t.dot(start) / rate, (t.dot(start) + length) / rate]);
    }
}
