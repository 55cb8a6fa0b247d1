//! Coordinates that move together: their equations with closed contacts as constraints, integrated step by step.
//!
//! `M q̈ = f(q, q̇) + Gᵀ λ` with `G q̈ + γ = 0`, so `(G M⁻¹ Gᵀ) λ = −(G M⁻¹ f + γ)`. No coordinate is eliminated, so
//! dead points need no care; after each step positions and velocities are projected back onto g = 0, G q̇ = 0.

use crate::flight::Bounds;
use crate::linear::{Small, factorize, solve_factorized};
use crate::path::Path;
use crate::runge_kutta::{Equations, Polynomial, Step};
use crate::settle::{add_forces, inverse_inertia};
use crate::world::{Touch, World};
use mainspring_mechanism::{Candidate, Placed, Row};

/// A moving group of coordinates with the contacts it rests on (independent rows).
#[derive(Clone, Debug, Default)]
pub struct Component {
    pub coordinates: Vec<usize>,
    pub contacts: Vec<Candidate>,
    /// Bodies its contacts involve, and for each contact their places in that list.
    bodies: Vec<usize>,
    sides: Vec<(usize, usize)>,
    step: Step,
}

/// The outcome of a step.
pub struct Advance {
    pub h: f64,
    /// Proposed length of the next step.
    pub next: f64,
    pub paths: Vec<(usize, Path)>,
}

/// Tolerances of integration: scales of position and velocity by coordinate, times the relative tolerance.
pub struct Tolerance<'a> {
    pub relative: f64,
    pub positions: &'a [f64],
    pub speeds: &'a [f64],
    pub shortest: f64,
}

impl Component {
    pub fn new(world: &World, coordinates: Vec<usize>, contacts: Vec<Candidate>) -> Self {
        let mut bodies = Vec::new();
        let mut place = |body: usize| match bodies.iter().position(|&b| b == body) {
            Some(i) => i,
            None => {
                bodies.push(body);
                bodies.len() - 1
            }
        };
        let sides = contacts
            .iter()
            .map(|c| {
                let (a, b) = world.bodies(c);
                (place(a), place(b))
            })
            .collect();
        Self { coordinates, contacts, bodies, sides, step: Step::default() }
    }

    /// Evaluates each contact at `q` in turn.
    fn each_touch(&self, world: &mut World, q: &[f64], mut each: impl FnMut(&Touch)) {
        let system = world.system;
        let placed: Small<Placed> = self.bodies.iter().map(|&b| Placed::new(&system.bodies[b], q)).collect();
        for (contact, &(a, b)) in self.contacts.iter().zip(&self.sides) {
            let touch = world.touch(contact, (&placed[a], &placed[b]));
            each(&touch);
        }
    }

    /// Forces of the contacts at `(q, v)`, and the accelerations of all coordinates they touch; `each` is told every
    /// contact. None if the contacts are not independent here.
    pub fn forces(
        &self,
        world: &mut World,
        (q, v): (&[f64], &[f64]),
        acceleration: &mut [f64],
        mut each: impl FnMut(&Touch),
    ) -> Option<Small<f64>> {
        let system = world.system;
        for &i in &self.coordinates {
            acceleration[i] = system.coordinates[i].free_acceleration(q[i], v[i]);
        }
        let (mut rows, mut lambda) = (Small::<Row>::new(), Small::<f64>::new());
        self.each_touch(world, q, |touch| {
            rows.push(touch.row());
            lambda.push(-(rows[rows.len() - 1].dot(acceleration) + touch.bias(v)));
            each(touch);
        });
        let mut matrix = inverse_inertia(system, &rows);
        if !factorize(&mut matrix, rows.len()) {
            return None;
        }
        solve_factorized(&matrix, &mut lambda);
        add_forces(system, &rows, &lambda, acceleration);
        Some(lambda)
    }

    /// Takes one step of at most `longest` from (t, q, v), trying `h` first and halving until the error fits.
    /// None if even the shortest step does not.
    pub fn advance(
        &mut self,
        world: &mut World,
        (t, q, v): (f64, &[f64], &[f64]),
        h: f64,
        longest: f64,
        tolerance: &Tolerance,
    ) -> Option<Advance> {
        let n = self.coordinates.len();
        let y: Small<f64, 16> =
            self.coordinates.iter().map(|&i| q[i]).chain(self.coordinates.iter().map(|&i| v[i])).collect();
        let mut step = std::mem::take(&mut self.step);
        step.resize(2 * n);
        let mut h = h.min(longest);
        let mut equations = ComponentEquations::new(self, world, q, v);
        let start: Small<f64, 8> = step.begin(&mut equations, t, &y)[n..].into();
        let singular = equations.singular;
        let result = loop {
            if h < tolerance.shortest {
                break None;
            }
            equations.singular = singular;
            let scale = self.scale(&start, h, tolerance);
            let error = step.attempt(&mut equations, t, &y, h, &scale);
            let factor = if error.is_finite() { (0.9 * error.powf(-0.125)).clamp(0.2, 3.0) } else { 0.1 };
            if error.is_finite() && error <= 1.0 && !equations.singular {
                let dense = step.dense(&mut equations, t, &y, h);
                let paths = self.paths(&dense, t, h);
                break Some(Advance { h, next: h * factor, paths });
            }
            h *= factor.min(0.5);
        };
        self.step = step;
        result
    }

    fn scale(&self, acceleration: &[f64], h: f64, tolerance: &Tolerance) -> Small<f64, 16> {
        let positions = self.coordinates.iter().map(|&i| tolerance.relative * tolerance.positions[i]);
        let speeds =
            self.coordinates.iter().zip(acceleration).map(|(&i, a)| {
                tolerance.relative * tolerance.speeds[i].max(a.abs() * h).max(f64::MIN_POSITIVE)
            });
        positions.chain(speeds).collect()
    }

    /// The paths of a step, with bounds over all of it.
    fn paths(&self, dense: &[Polynomial], t: f64, h: f64) -> Vec<(usize, Path)> {
        let n = self.coordinates.len();
        let path = |k: usize| {
            let [speed, first, second] = dense[n + k].bounds();
            // The slope of positions is the velocity only to the tolerance.
            let bounds = Bounds { speed: 1.02 * speed, acceleration: 1.02 * first / h };
            Path::Step { t0: t, h, q: dense[k], v: dense[n + k], bounds, jerk: 1.02 * second / (h * h) }
        };
        (0..n).map(|k| (self.coordinates[k], path(k))).collect()
    }

    /// Moves `q` onto g = 0 and `v` onto G q̇ = 0 along M⁻¹ Gᵀ: the nearest state in the metric of inertia.
    pub fn project(&self, world: &mut World, q: &mut [f64], v: &mut [f64]) {
        let system = world.system;
        for _ in 0..3 {
            let (mut rows, mut gaps, mut rates) =
                (Small::<Row>::new(), Small::<f64>::new(), Small::<f64>::new());
            self.each_touch(world, q, |touch| {
                rows.push(touch.row());
                gaps.push(-touch.state.gap);
                rates.push(-touch.rate(v));
            });
            let mut matrix = inverse_inertia(system, &rows);
            if !factorize(&mut matrix, rows.len()) {
                return;
            }
            solve_factorized(&matrix, &mut rates);
            add_forces(system, &rows, &rates, v);
            if gaps.iter().all(|g| g.abs() <= 0.1 * crate::search::CLOSED * system.size) {
                return;
            }
            solve_factorized(&matrix, &mut gaps);
            add_forces(system, &rows, &gaps, q);
        }
    }
}

struct ComponentEquations<'c, 'w> {
    component: &'c Component,
    world: &'c mut World<'w>,
    q: Small<f64, 8>,
    v: Small<f64, 8>,
    acceleration: Small<f64, 8>,
    singular: bool,
}

impl<'c, 'w> ComponentEquations<'c, 'w> {
    fn new(component: &'c Component, world: &'c mut World<'w>, q: &[f64], v: &[f64]) -> Self {
        Self {
            component,
            world,
            q: q.into(),
            v: v.into(),
            acceleration: smallvec::smallvec![0.0; q.len()],
            singular: false,
        }
    }
}

impl Equations for ComponentEquations<'_, '_> {
    fn derivative(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) {
        let n = self.component.coordinates.len();
        for (k, &i) in self.component.coordinates.iter().enumerate() {
            (self.q[i], self.v[i]) = (y[k], y[n + k]);
        }
        let state = (self.q.as_slice(), self.v.as_slice());
        let forces = self.component.forces(self.world, state, &mut self.acceleration, |_| {});
        self.singular |= forces.is_none();
        for (k, &i) in self.component.coordinates.iter().enumerate() {
            dy[k] = self.v[i];
            dy[n + k] = self.acceleration[i];
        }
    }
}
