//! What acts on the coordinates of a group beside contacts: `M(q) q̈ = f(t, q, q̇) + contact forces`.

use super::rosenbrock::Jacobian;
use mainspring_mechanism::System;

/// Inertia and forces of some coordinates. Positions and velocities are of the whole system; forces, accelerations
/// and matrices of the chosen coordinates, in their order.
pub trait Loads {
    /// `a = M⁻¹ (f + force)`.
    fn accelerate(&mut self, t: f64, q: &[f64], v: &[f64], force: &[f64], a: &mut [f64]);

    /// Adds the derivatives of `f − M a` at given accelerations to `out`.
    fn differentiate(&mut self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut Jacobian);

    /// Replaces the columns of a matrix of `width` columns, row after row, by M⁻¹ times them. M is that of the last
    /// call of `accelerate`.
    fn divide(&self, columns: &mut [f64], width: usize);
}

/// Springs, viscous friction and constant forces on coordinates of constant inertia.
#[derive(Clone, Debug)]
pub struct LinearLoads<'a> {
    pub system: &'a System,
    pub coordinates: Vec<usize>,
}

impl Loads for LinearLoads<'_> {
    fn accelerate(&mut self, _t: f64, q: &[f64], v: &[f64], force: &[f64], a: &mut [f64]) {
        for (k, &i) in self.coordinates.iter().enumerate() {
            let c = &self.system.coordinates[i];
            a[k] = (c.force - c.stiffness * q[i] - c.damping * v[i] + force[k]) / c.inertia;
        }
    }

    fn differentiate(&mut self, _t: f64, _q: &[f64], _v: &[f64], _a: &[f64], out: &mut Jacobian) {
        let n = self.coordinates.len();
        for (k, &i) in self.coordinates.iter().enumerate() {
            let c = &self.system.coordinates[i];
            out.by_position[k * n + k] -= c.stiffness;
            out.by_velocity[k * n + k] -= c.damping;
        }
    }

    fn divide(&self, columns: &mut [f64], width: usize) {
        for (k, &i) in self.coordinates.iter().enumerate() {
            let inertia = self.system.coordinates[i].inertia;
            columns[k * width..(k + 1) * width].iter_mut().for_each(|x| *x /= inertia);
        }
    }
}
