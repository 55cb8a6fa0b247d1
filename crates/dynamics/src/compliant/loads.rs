//! What acts on the coordinates of a group beside contacts: `M(q) q̈ = f(t, q, q̇) + Gᵀ l`.
//!
//! Coordinates alone have a constant inertia. Masses tie others into blocks, whose held coordinates h (driven, or stuck
//! by dry friction) have given accelerations:
//! ```text
//! M_ff q̈_f = f_f − M_fh q̈_h + (Gᵀ l)_f
//! d/dt of the right at given q̈ = Σ_h ∂(f − M q̈)_f/∂q_h q̇_h + ∂f_f/∂q̇_h q̈_h − M_fh q⃛_h
//! ```

use super::rosenbrock::Jacobian;
use crate::linear::{factorize, solve_factorized};
use mainspring_mechanism::{Coupled, Equations, EquationsJacobian, System};

/// Positions and velocities of the whole system, with accelerations of held coordinates and their rates.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'s> {
    pub q: &'s [f64],
    pub v: &'s [f64],
    pub given: &'s [f64],
    pub jerk: &'s [f64],
}

/// Inertia and forces of some coordinates.
#[derive(Clone, Debug)]
pub struct Loads<'a> {
    system: &'a System,
    /// Coordinates with an inertia of their own: place in the group, index.
    alone: Vec<(usize, usize)>,
    blocks: Vec<Block<'a>>,
    /// Force of dry friction on what slides, by coordinate of the system.
    dry: Vec<f64>,
}

/// Coordinates that masses tie together.
#[derive(Clone, Debug)]
struct Block<'a> {
    tied: &'a Coupled,
    /// Those that move freely: place in `tied`, place in the group.
    free: Vec<(usize, usize)>,
    /// Places in `tied` of those held.
    held: Vec<usize>,
    equations: Equations,
    jacobian: EquationsJacobian,
    /// Of M_ff.
    factor: Vec<f64>,
    scratch: Vec<f64>,
    accelerations: Vec<f64>,
}

impl<'a> Block<'a> {
    fn new(tied: &'a Coupled, places: &[usize]) -> Self {
        let all = tied.coordinates.iter().enumerate().map(|(k, &i)| (k, places[i]));
        let (free, held): (Vec<_>, Vec<_>) = all.partition(|p| p.1 != usize::MAX);
        Self {
            tied,
            free,
            held: held.into_iter().map(|p| p.0).collect(),
            equations: Equations::default(),
            jacobian: EquationsJacobian::default(),
            factor: vec![],
            scratch: vec![],
            accelerations: vec![],
        }
    }

    fn accelerate(&mut self, system: &System, at: &Moment, extra: impl Fn(usize) -> f64, a: &mut [f64]) {
        let n = self.tied.coordinates.len();
        system.equations(self.tied, at.q, at.v, &mut self.equations);
        let mass = &self.equations.mass;
        self.factor.clear();
        for &(i, _) in &self.free {
            self.factor.extend(self.free.iter().map(|&(j, _)| mass[i * n + j]));
        }
        if !factorize(&mut self.factor, self.free.len()) {
            // No mass moves along some direction: nothing can be said of it, and the step fails.
            self.factor.fill(f64::NAN);
        }
        self.scratch.clear();
        for &(i, _) in &self.free {
            let given = |&j: &usize| mass[i * n + j] * at.given[self.tied.coordinates[j]];
            let carried: f64 = self.held.iter().map(given).sum();
            self.scratch.push(self.equations.force[i] - carried + extra(self.tied.coordinates[i]));
        }
        solve_factorized(&self.factor, &mut self.scratch);
        for (&(_, place), x) in self.free.iter().zip(&self.scratch) {
            a[place] = *x;
        }
    }

    /// Accelerations in the order of `tied`, from those of the group.
    fn spread(&mut self, at: &Moment, a: &[f64]) {
        let given = |k: &usize| at.given[self.tied.coordinates[*k]];
        self.accelerations.clear();
        self.accelerations.resize(self.tied.coordinates.len(), 0.0);
        for &(k, place) in &self.free {
            self.accelerations[k] = a[place];
        }
        for k in &self.held {
            self.accelerations[*k] = given(k);
        }
    }

    fn differentiate(&mut self, system: &System, at: &Moment, a: &[f64], n: usize, out: &mut Jacobian) {
        self.spread(at, a);
        system.equations_jacobian(self.tied, at.q, at.v, &self.accelerations, &mut self.jacobian);
        let (own, EquationsJacobian { by_position, by_velocity, .. }) =
            (self.tied.coordinates.len(), &self.jacobian);
        for &(i, row) in &self.free {
            for &(j, column) in &self.free {
                out.by_position[row * n + column] += by_position[i * own + j];
                out.by_velocity[row * n + column] += by_velocity[i * own + j];
            }
            for &h in &self.held {
                let c = self.tied.coordinates[h];
                out.by_time[row] += by_position[i * own + h] * at.v[c]
                    + by_velocity[i * own + h] * at.given[c]
                    - self.equations.mass[i * own + h] * at.jerk[c];
            }
        }
    }

    fn divide(&self, columns: &mut [f64], width: usize) {
        let mut x = Vec::with_capacity(self.free.len());
        for column in 0..width {
            x.clear();
            x.extend(self.free.iter().map(|&(_, place)| columns[place * width + column]));
            solve_factorized(&self.factor, &mut x);
            for (&(_, place), x) in self.free.iter().zip(&x) {
                columns[place * width + column] = *x;
            }
        }
    }
}

impl<'a> Loads<'a> {
    /// On no coordinates.
    pub fn new(system: &'a System) -> Self {
        Self { system, alone: vec![], blocks: vec![], dry: vec![0.0; system.coordinates.len()] }
    }

    /// Takes the coordinates of a group, in their order; `places` tells where each of the system's is, or
    /// `usize::MAX`, and `dry` the friction of what slides.
    pub fn gather(&mut self, coordinates: &[usize], places: &[usize], dry: impl Fn(usize) -> f64) {
        let tied = |i: usize| self.system.coupled.iter().any(|c| c.coordinates.contains(&i));
        let all = coordinates.iter().enumerate();
        self.alone = all.filter(|(_, i)| !tied(**i)).map(|(k, i)| (k, *i)).collect();
        self.blocks = self.system.coupled.iter().map(|c| Block::new(c, places)).collect();
        self.dry.iter_mut().enumerate().for_each(|(i, f)| *f = dry(i));
    }

    /// `a = M⁻¹ (f + Gᵀ l)`, by place in the group; `pressed` is Gᵀ l by coordinate of the system.
    pub fn accelerate(&mut self, at: &Moment, pressed: &[f64], a: &mut [f64]) {
        for &(k, i) in &self.alone {
            let c = &self.system.coordinates[i];
            let own = c.force - c.stiffness * at.q[i] - c.damping * at.v[i];
            a[k] = (own + self.dry[i] + pressed[i]) / c.inertia;
        }
        for block in &mut self.blocks {
            block.accelerate(self.system, at, |i| self.dry[i] + pressed[i], a);
        }
    }

    /// Adds the derivatives of `f − M a` at given accelerations, by place, to `out`. Follows `accelerate` at the same
    /// state.
    pub fn differentiate(&mut self, at: &Moment, a: &[f64], out: &mut Jacobian) {
        let n = a.len();
        for &(k, i) in &self.alone {
            let c = &self.system.coordinates[i];
            out.by_position[k * n + k] -= c.stiffness;
            out.by_velocity[k * n + k] -= c.damping;
        }
        for block in &mut self.blocks {
            block.differentiate(self.system, at, a, n, out);
        }
    }

    /// Replaces the columns of a matrix of `width` columns, row after row, by M⁻¹ times them. M is that of the last
    /// call of `accelerate`.
    pub fn divide(&self, columns: &mut [f64], width: usize) {
        for &(k, i) in &self.alone {
            let inertia = self.system.coordinates[i].inertia;
            columns[k * width..(k + 1) * width].iter_mut().for_each(|x| *x /= inertia);
        }
        self.blocks.iter().for_each(|block| block.divide(columns, width));
    }

    /// `(M q̈ − f)_i` of a held coordinate: the force it takes, dry friction and contacts not counted. Follows
    /// `accelerate` at the same state, which gave `a`.
    pub fn missing(&mut self, i: usize, at: &Moment, a: &[f64]) -> f64 {
        for block in &mut self.blocks {
            let Some(k) = block.tied.coordinates.iter().position(|c| *c == i) else { continue };
            block.spread(at, a);
            let n = block.tied.coordinates.len();
            let row = &block.equations.mass[k * n..(k + 1) * n];
            let inertial: f64 = row.iter().zip(&block.accelerations).map(|(m, a)| m * a).sum();
            return inertial - block.equations.force[k];
        }
        let c = &self.system.coordinates[i];
        c.inertia * at.given[i] - (c.force - c.stiffness * at.q[i] - c.damping * at.v[i])
    }
}
