//! Motion along a contact curve: transmission ratio with its derivatives, pressure angle.
//!
//! With v(u) defined by F(u, v) = 0, a path u = u₀ + t, v = v₀ + c₁t + c₂t²/2 + c₃t³/6 has F's derivatives by t zero; each is
//! linear in the newest coefficient with factor F_v, so `c_k = −F⁽ᵏ⁾(c_k = 0) / F_v`. The derivatives of F come from dual
//! numbers of third order.

use crate::curve::Curve;
use crate::equation::Equation;
use crate::moving::{Carried, Kind, Moving};
use mainspring_geometry::{Scalar, Vec2};
use mainspring_mechanism::Pose;
use num_dual::Dual3_64;

/// The motion that a contact transmits at one configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transmission {
    /// The configuration.
    pub at: [f64; 2],
    /// dq₂/dq₁; infinite at a dead point of the first coordinate.
    pub ratio: f64,
    /// d²q₂/dq₁² and d³q₂/dq₁³.
    pub derivatives: [f64; 2],
    /// Angle between the common normal and the direction in which the contact point of the body that either
    /// coordinate moves would go: radians in [0, π/2]; π/2 for a body that does not move there.
    pub pressure_angles: [f64; 2],
    /// Contact point in the plane of the machine (for two bodies carried by a third: in its frame).
    pub point: Vec2,
    /// Unit normal there, towards the body that the first coordinate moves.
    pub normal: Vec2,
}

fn place<S: Scalar>(m: &Moving, u: S) -> Pose<S> {
    match m.kind {
        Kind::Turn => {
            let (sin, cos) = u.sin_cos();
            Pose { cos, sin: sin * m.sign, shift: Vec2::constant(m.center) }
        }
        Kind::Slide => Pose { shift: Vec2::<S>::constant(m.direction) * u, ..Pose::identity() },
        Kind::Still => Pose::identity(),
    }
}

/// F over any scalar.
fn equation<S: Scalar>(eq: &Equation, moving: &[Moving; 2], u: S, v: S) -> S {
    let poses = [place(&moving[0], u), place(&moving[1], v)];
    let offset = |p: Vec2, at: &Pose<S>, (normal, offset): (Vec2, f64), edge: &Pose<S>| {
        let n = edge.rotate(Vec2::constant(normal));
        n.dot(at.apply(Vec2::constant(p)) - edge.shift) - (offset + eq.rho)
    };
    match (eq.carried[0], eq.carried[1]) {
        (Carried::Point(a), Carried::Point(b)) => {
            let d = poses[0].apply(Vec2::constant(a)) - poses[1].apply(Vec2::constant(b));
            (d.dot(d) - eq.rho * eq.rho) * (0.5 * eq.side / eq.rho)
        }
        (Carried::Point(a), Carried::Line { normal, offset: c }) => {
            offset(a, &poses[0], (normal, c), &poses[1])
        }
        (Carried::Line { normal, offset: c }, Carried::Point(b)) => {
            offset(b, &poses[1], (normal, c), &poses[0])
        }
        (Carried::Line { .. }, Carried::Line { .. }) => S::constant(f64::NAN),
    }
}

impl Curve<'_> {
    /// The motion transmitted at a fraction of the way along the curve (see [`Curve::at`]).
    pub fn transmission(&self, fraction: f64) -> Transmission {
        let space = self.space();
        let moving = &space.atlas.frame.moving;
        let at = self.at(fraction);
        let (u, v) = (at[0] * moving[0].ratio, at[1] * moving[1].ratio);
        let eq = space.atlas.equation(self.id);
        let slope = eq.value(moving, u, v).fv;
        let mut c = [0.0; 3];
        for k in 0..3 {
            let path = Dual3_64::new(v, c[0], c[1], c[2]);
            let f = equation(eq, moving, Dual3_64::new(u, 1.0, 0.0, 0.0), path);
            c[k] = -[f.v1, f.v2, f.v3][k] / slope;
        }
        let (r, s) = (moving[0].ratio, moving[1].ratio);
        let poses = [moving[0].place(u), moving[1].place(v)];
        let touch = eq.touch(&poses);
        let angle = |m: &Moving| {
            let d = m.velocity(touch.point);
            touch.normal.cross(d).abs().atan2(touch.normal.dot(d).abs())
        };
        let pressure = |m: &Moving| {
            if m.velocity(touch.point).norm() > 0.0 { angle(m) } else { std::f64::consts::FRAC_PI_2 }
        };
        Transmission {
            at,
            ratio: c[0] * r / s,
            derivatives: [c[1] * r * r / s, c[2] * r * r * r / s],
            pressure_angles: [pressure(&moving[0]), pressure(&moving[1])],
            point: touch.point,
            normal: touch.normal,
        }
    }

    /// Least and greatest dq₂/dq₁ along the curve, by 17 samples that leave out the ends' last thousandth; upright
    /// curves have infinite slope.
    pub fn slopes(&self) -> (f64, f64) {
        if self.is_upright() {
            return (f64::INFINITY, f64::INFINITY);
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..17 {
            let ratio = self.transmission(1e-3 + 0.998 * f64::from(k) / 16.0).ratio;
            low = low.min(ratio);
            high = high.max(ratio);
        }
        (low, high)
    }
}
