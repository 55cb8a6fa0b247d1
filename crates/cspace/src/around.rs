//! Which features may touch somewhere in a box of configurations: what is certain to stay apart is left out.
//!
//! Compared at the box's centre: distances against how far points move within the box, normals against how far bodies
//! turn. If two arcs of radii r ≥ s touch anywhere in the box, their material points of contact are at most e apart at its
//! centre, e the sum of both features' motions, and their normals differ by at most θ, the sum of both turns. So their
//! centres are `(r ± s) n ± s (n' − n) + e` apart, in length within `e + rs θ²/|r ± s|` of |r ± s| and in direction within
//! `asin((s θ + e)/|r ± s|)` of n. The motion of the centres bounds both too, better where arcs are small.

use crate::moving::{Kind, Moving};
use crate::pairs::{Cell, Part};
use crate::reduce::relative;
use crate::shape::Shape;
use crate::tree::Node;
use mainspring_geometry::Vec2;
use mainspring_mechanism::Pose;

/// A box of configurations: how the bodies lie against each other at its centre, and how far they move within it.
pub(crate) struct Around {
    /// second_from_first and first_from_second at the centre.
    pub rel: [Pose; 2],
    half: [f64; 2],
    /// How far each body's points move: so much per unit of distance from its origin, and so much wherever they are.
    moves: [(f64, f64); 2],
    /// How far each body turns (radians).
    turn: [f64; 2],
    /// What counts as rounding (length).
    pub little: f64,
}

impl Around {
    /// For bodies that move like this in a machine of this size.
    pub fn new(moving: &[Moving; 2], cell: &Cell, size: f64) -> Self {
        let poses = [0, 1].map(|k| moving[k].place(cell.center[k]));
        let rel = [relative(&poses[0], &poses[1]), relative(&poses[1], &poses[0])];
        let turn = [0, 1].map(|k| if moving[k].turns() { cell.half[k] } else { 0.0 });
        let moves = [0, 1].map(|k| match moving[k].kind {
            Kind::Turn => (cell.half[k], 0.0),
            Kind::Slide => (0.0, cell.half[k]),
            Kind::Still => (0.0, 0.0),
        });
        Around { rel, half: cell.half, moves, turn, little: 1e-9 * size }
    }

    /// How far points of both bodies move against each other that lie at these distances from their origins.
    pub fn motion(&self, arms: [f64; 2]) -> f64 {
        let one = |k: usize| self.moves[k].0 * arms[k].max(0.0) + self.moves[k].1;
        one(0) + one(1)
    }

    /// From the second node's centre to the first's, in the second body's coordinates.
    pub fn apart(&self, m: &Node, n: &Node) -> Vec2 {
        self.rel[0].apply(m.center) - n.center
    }

    /// May features under two tree nodes touch? A disc moves as its centre does, whatever turns within it.
    pub fn near(&self, m: &Node, n: &Node) -> bool {
        let reach = m.radius + n.radius + self.motion([m.arm, n.arm]);
        let apart = self.apart(m, n);
        apart.dot(apart) <= reach * reach
    }

    /// May two features touch? Sharper than `near`: signed distance and normals.
    pub fn may_touch(&self, a: &Part, b: &Part) -> bool {
        match (&a.shape, &b.shape) {
            (Shape::Arc { .. }, Shape::Arc { .. }) => self.arcs(a, b),
            (Shape::Arc { .. }, Shape::Edge { .. }) => self.arc_and_edge(a, b, 0),
            (Shape::Edge { .. }, Shape::Arc { .. }) => self.arc_and_edge(b, a, 1),
            _ => false,
        }
    }

    /// How far features with these levers move against each other, the first of body `k`.
    fn levered(&self, first: f64, second: f64, k: usize) -> f64 {
        first * self.half[k] + second * self.half[1 - k]
    }

    /// The arc is of body `k`.
    fn arc_and_edge(&self, arc: &Part, edge: &Part, k: usize) -> bool {
        let (
            Shape::Arc { center, radius, directions, hollow },
            Shape::Edge { from, tangent, normal, length },
        ) = (&arc.shape, &edge.shape)
        else {
            return false;
        };
        if *hollow {
            return false;
        }
        let (e, turn) = (self.levered(arc.lever, edge.lever, k), self.turn[0] + self.turn[1]);
        let centers = self.levered(arc.center_lever, edge.lever, k) + self.turn[1 - k] * radius;
        let across = centers.min(e + 0.5 * radius * turn * turn) + self.little;
        let beyond = centers.min(e + radius * turn) + self.little;
        let offset = self.rel[k].apply(*center) - *from;
        let (along, gap) = (tangent.dot(offset), normal.dot(offset) - radius);
        if gap.abs() > across || along < -beyond || along > length + beyond {
            return false;
        }
        let turn = turn + 1e-9;
        turn >= 0.5 || directions.margin(self.rel[1 - k].rotate(-*normal)) >= -turn
    }

    fn arcs(&self, a: &Part, b: &Part) -> bool {
        let (
            Shape::Arc { center: p, radius: r, directions: da, hollow: ha },
            Shape::Arc { center: q, radius: s, directions: db, hollow: hb },
        ) = (&a.shape, &b.shape)
        else {
            return false;
        };
        let inside = *ha || *hb;
        let rho = if inside { (r - s).abs() } else { r + s };
        let (e, theta) = (self.levered(a.lever, b.lever, 0), self.turn[0] + self.turn[1]);
        let centers = self.levered(a.center_lever, b.center_lever, 0);
        let bend = (r * s * theta * theta / rho.max(f64::MIN_POSITIVE)).min((r * s).sqrt() * theta);
        let d: Vec2 = self.rel[0].apply(*p) - *q;
        let length = d.norm();
        if (length - rho).abs() > centers.min(e + bend) + self.little {
            return false;
        }
        // The direction of centres turns by at most asin(motion/ρ), and the bodies turn.
        let motion = centers.min(e + r.min(*s) * theta) + self.little;
        let turn = 1.6 * motion / rho.max(f64::MIN_POSITIVE) + 1e-9;
        if turn >= 0.4 || length == 0.0 {
            return true;
        }
        let d = d * (1.0 / length);
        let (out_a, out_b) = match (*ha, *hb) {
            (false, false) => (-d, d),
            (false, true) => (d, d),
            _ => (-d, -d),
        };
        let turn = turn + theta;
        turn >= 0.5 || (da.margin(self.rel[1].rotate(out_a)) >= -turn && db.margin(out_b) >= -turn)
    }
}
