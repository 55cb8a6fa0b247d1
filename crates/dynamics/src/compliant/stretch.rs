//! The dense motion of a group over one step.

use super::group::Group;
use super::rosenbrock::{Rosenbrock, Start};
use crate::flight::Bounds;
use crate::path::Path;
use crate::runge_kutta::Polynomial;

/// Positions and velocities of a group's coordinates over a step of length `h` from `t0`.
#[derive(Clone, Debug, Default)]
pub struct Stretch {
    pub t0: f64,
    pub h: f64,
    positions: Vec<Polynomial>,
    velocities: Vec<Polynomial>,
}

impl Stretch {
    /// Takes over an accepted step.
    pub fn set(&mut self, step: &Rosenbrock, start: &Start, h: f64) {
        (self.t0, self.h) = (start.t, h);
        let polynomial = |velocity: bool, i: usize, from: f64, to: f64| {
            let [k1, k2, k3] = step.dense(velocity, i);
            Polynomial::short(from, [to - from, k1, k2 + k3, -k3])
        };
        self.positions.clear();
        self.velocities.clear();
        for i in 0..start.q.len() {
            self.positions.push(polynomial(false, i, start.q[i], step.end_q[i]));
            self.velocities.push(polynomial(true, i, start.v[i], step.end_v[i]));
        }
    }

    /// Moves the group to a fraction of the step.
    pub fn move_to(&self, group: &mut Group, x: f64) {
        group.move_to(self.t0 + x * self.h, |k| (self.positions[k].at(x), self.velocities[k].at(x)));
    }

    /// The path of the group's coordinate `k`, with bounds over all of it.
    pub fn path(&self, k: usize) -> Path {
        self.path_with(self.positions[k], self.velocities[k], 1.0)
    }

    /// The same for the search for contacts: its velocities are the exact slopes of its positions, as gaps and their
    /// rates must fit each other to rounding.
    pub fn strict_path(&self, k: usize) -> Path {
        self.path_with(self.positions[k], self.positions[k].short_slope(), self.h)
    }

    fn path_with(&self, q: Polynomial, v: Polynomial, over: f64) -> Path {
        let (h, v) = (self.h, v.scaled(1.0 / over));
        let [speed, first, second] = v.bounds();
        let bounds = Bounds { speed, acceleration: first / h };
        Path::Step { t0: self.t0, h, q, v, bounds, jerk: second / (h * h) }
    }
}
