//! Coordinates that move together, by closed contacts, by masses or by drives: their equations with the contacts as
//! constraints, integrated step by step.
//!
//! `M q̈ = f(q, q̇) + Gᵀ λ` with `G q̈ + γ = 0`, so `(G M⁻¹ Gᵀ) λ = −(G M⁻¹ f + γ)`. No coordinate is eliminated, so
//! dead points need no care; after each step positions and velocities are projected back onto g = 0, G q̇ = 0.
//! Coordinates held by dry friction take part with q̈ = 0 and what holds them, `M q̈ − f − Gᵀ λ`, is watched; driven
//! ones have their prescribed acceleration.

use crate::constraints::{AtState, Constraints};
use crate::few::{Few, FewAt, MOST};
use crate::flight::Bounds;
use crate::inertia::Inertia;
use crate::linear::Small;
use crate::opposed::are_opposed;
use crate::path::Path;
use crate::runge_kutta::{Equations, Polynomial, Step};
use crate::settle::Closed;
use crate::world::World;
use mainspring_mechanism::{Candidate, Indices};

/// Velocities below this fraction of what the greatest speeds make likely are no scale of their own.
const SLOWEST: f64 = 1e-6;

/// How far contacts may come off zero half way along a step, against the tolerance: all along it less than the tolerance.
const BETWEEN: f64 = 0.25;

/// Rounds of projection onto the contacts.
pub const PROJECTIONS: usize = 3;

/// Roundings of positions that may meet in a gap.
const GRAIN: f64 = 16.0;

/// A moving group of coordinates with the contacts it rests on (independent rows).
#[derive(Clone, Debug, Default)]
pub struct Component {
    /// Those that move freely.
    pub coordinates: Indices,
    /// Those that dry friction holds.
    pub stuck: Indices,
    /// Indices into `System::coupled`.
    blocks: Indices,
    pub contacts: Vec<Candidate>,
    /// For each contact one on the other side of what it touches, closed as well: the pair holds both ways.
    pub backs: Vec<Option<Candidate>>,
    pub constraints: Constraints,
    /// The same where it is cheaper.
    pub few: Option<Few>,
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
    /// Of the coordinates of a group, driven ones left out, with its contacts among all that are closed.
    pub fn new(world: &World, group: Indices, contacts: Vec<Candidate>, closed: &[Closed]) -> Self {
        let opposed = |c: &Candidate| {
            closed.iter().map(|other| other.candidate).find(|other| are_opposed(world, c, other))
        };
        let backs = contacts.iter().map(opposed).collect();
        let (stuck, coordinates): (Indices, Indices) = group.into_iter().partition(|&i| world.stuck[i]);
        let holds = |k: &usize| {
            let members = &world.system.coupled[*k].coordinates;
            members.iter().any(|i| coordinates.contains(i) || stuck.contains(i))
        };
        let blocks: Indices = (0..world.system.coupled.len()).filter(holds).collect();
        let tied = blocks.iter().flat_map(|&k| world.system.coupled[k].coordinates.iter().copied());
        let constraints = Constraints::new(world, &contacts, tied);
        let few = if blocks.is_empty() { Few::new(world, &coordinates, &contacts) } else { None };
        Self { coordinates, stuck, blocks, contacts, backs, constraints, few, step: Step::default() }
    }

    /// Forces of the contacts at time `t` and state `(q, v)`, kept in `at`, and the accelerations of all coordinates
    /// they touch. False if the contacts are not independent here.
    pub fn forces(
        &self,
        world: &mut World,
        t: f64,
        (q, v): (&[f64], &[f64]),
        acceleration: &mut [f64],
        at: &mut AtState,
    ) -> bool {
        self.constraints.evaluate(world, (q, v), at);
        let inertia = self.inertia(world, (q, v));
        self.accelerate(world, &inertia, t, (q, v), acceleration);
        if !self.constraints.weigh(&inertia, at) {
            at.lambda.fill(0.0);
            return false;
        }
        self.constraints.press(at, acceleration);
        true
    }

    /// The same where contacts are few, as `at` then tells: their forces.
    pub fn few_forces(
        &self,
        world: &mut World,
        (few, at): (&Few, &mut FewAt),
        t: f64,
        state: (&[f64], &[f64]),
        acceleration: &mut [f64],
    ) -> Option<[f64; MOST]> {
        world.prescribe(t, acceleration);
        few.go_to(world, state, at).then(|| few.accelerate(state, at, acceleration))
    }

    fn inertia<'m>(&self, world: &'m World, state: (&[f64], &[f64])) -> Inertia<'m> {
        Inertia::new(world.system, &world.free, self.blocks.iter().copied(), state)
    }

    /// Accelerations without contacts.
    fn accelerate(
        &self,
        world: &World,
        inertia: &Inertia,
        t: f64,
        (q, v): (&[f64], &[f64]),
        acceleration: &mut [f64],
    ) {
        world.prescribe(t, acceleration);
        for &i in self.coordinates.iter().filter(|&&i| world.free.is_alone(i)) {
            acceleration[i] = world.acceleration_alone(i, q[i], v[i]);
        }
        inertia.accelerate(|i| world.dry_force(i), acceleration);
    }

    /// What holds coordinate `i` of the component in its given motion, `(M q̈ − f − Gᵀ λ)_i`, for accelerations and
    /// forces λ that belong to the state.
    pub fn holding(
        &self,
        world: &World,
        i: usize,
        (q, v): (&[f64], &[f64]),
        acceleration: &[f64],
        at: &AtState,
    ) -> f64 {
        self.inertia(world, (q, v)).missing(i, (q, v), acceleration) - self.constraints.pressed(at, i)
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
        let size = equations.world.system.size;
        // Gaps are no finer than the positions that make them.
        let grain = |(q, scale): (&f64, &f64)| GRAIN * f64::EPSILON * (q / scale).abs();
        let coarsest = q.iter().zip(tolerance.positions).map(grain).fold(0.0, f64::max);
        let within = size * (BETWEEN * tolerance.relative).max(coarsest);
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
                let between = equations.strays(&dense, (t, h), within) / within;
                let next = h * factor.min((0.9 * between.powf(-0.125)).clamp(0.2, 3.0));
                if between <= 1.0 {
                    let paths = self.paths(&dense, t, h);
                    break Some(Advance { h, next, paths });
                }
                h = next;
                continue;
            }
            // Points at which contacts depend on each other are no matter of a little less.
            h *= factor.min(if equations.singular { 0.5 } else { 0.9 });
        };
        self.step = step;
        result
    }

    fn scale(&self, acceleration: &[f64], h: f64, tolerance: &Tolerance) -> Small<f64, 16> {
        let positions = self.coordinates.iter().map(|&i| tolerance.relative * tolerance.positions[i]);
        // A coordinate that only begins to move is told by what moves with it.
        let relative = tolerance.speeds.iter().zip(tolerance.positions).map(|(v, scale)| v / scale);
        let least = (SLOWEST * relative.fold(0.0, f64::max)).max(f64::MIN_POSITIVE);
        let speeds = self.coordinates.iter().zip(acceleration).map(|(&i, a)| {
            tolerance.relative * tolerance.speeds[i].max(a.abs() * h).max(least * tolerance.positions[i])
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
        if self.contacts.is_empty() {
            return;
        }
        let exact = 0.1 * crate::search::CLOSED * world.system.size;
        if let Some(few) = &self.few {
            return few.project(world, exact, q, v);
        }
        let mut at = self.constraints.state();
        for _ in 0..PROJECTIONS {
            self.constraints.evaluate(world, (q, v), &mut at);
            if !self.constraints.weigh(&self.inertia(world, (q, v)), &mut at) {
                return;
            }
            self.constraints.take_away(&mut at, |line| line.rate, v);
            if at.contacts.iter().all(|line| line.gap.abs() <= exact) {
                return;
            }
            self.constraints.take_away(&mut at, |line| line.gap, q);
        }
    }
}

struct ComponentEquations<'c, 'w> {
    component: &'c Component,
    world: &'c mut World<'w>,
    q: Small<f64, 8>,
    v: Small<f64, 8>,
    acceleration: Small<f64, 8>,
    at: AtState,
    few_at: FewAt,
    singular: bool,
}

impl<'c, 'w> ComponentEquations<'c, 'w> {
    /// How far gaps come off zero half way along a step, or off those they had at its start.
    fn strays(&mut self, dense: &[Polynomial], (t, h): (f64, f64), within: f64) -> f64 {
        let middle = self.gaps(dense, (t, h), 0.5);
        let off = middle.iter().fold(0.0, |most: f64, gap| most.max(gap.abs()));
        if off <= within {
            return off;
        }
        let start = self.gaps(dense, (t, h), 0.0);
        middle.iter().zip(&start).fold(0.0, |most, (gap, start)| most.max((gap - start).abs()))
    }

    /// The contacts' gaps at the share `x` of a step.
    fn gaps(&mut self, dense: &[Polynomial], (t, h): (f64, f64), x: f64) -> Small<f64> {
        self.follow_drives(t + x * h);
        for (&i, q) in self.component.coordinates.iter().zip(dense) {
            self.q[i] = q.at(x);
        }
        if let Some(few) = &self.component.few {
            few.go_to(self.world, (&self.q, &self.v), &mut self.few_at);
            return few.gaps(&self.few_at);
        }
        self.component.constraints.evaluate(self.world, (&self.q, &self.v), &mut self.at);
        self.at.contacts.iter().map(|line| line.gap).collect()
    }

    fn follow_drives(&mut self, t: f64) {
        for ((i, _), piece) in self.world.drives.iter().zip(&self.world.driven) {
            let driven = piece.at(t);
            (self.q[*i], self.v[*i]) = (driven.q, driven.v);
        }
    }

    fn new(component: &'c Component, world: &'c mut World<'w>, q: &[f64], v: &[f64]) -> Self {
        Self {
            component,
            world,
            q: q.into(),
            v: v.into(),
            acceleration: smallvec::smallvec![0.0; q.len()],
            at: component.constraints.state(),
            few_at: FewAt::default(),
            singular: false,
        }
    }
}

impl Equations for ComponentEquations<'_, '_> {
    fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) {
        self.follow_drives(t);
        let (component, world) = (self.component, &mut *self.world);
        let coordinates = component.coordinates.as_slice();
        let (q, v, acceleration) = (&mut self.q[..], &mut self.v[..], &mut self.acceleration[..]);
        let (positions, velocities) = y.split_at(coordinates.len());
        for ((&i, position), velocity) in coordinates.iter().zip(positions).zip(velocities) {
            (q[i], v[i]) = (*position, *velocity);
        }
        let solved = match &component.few {
            Some(few) => {
                component.few_forces(world, (few, &mut self.few_at), t, (q, v), acceleration).is_some()
            }
            None => component.forces(world, t, (q, v), acceleration, &mut self.at),
        };
        self.singular |= !solved;
        let (rates, changes) = dy.split_at_mut(coordinates.len());
        for ((&i, rate), change) in coordinates.iter().zip(rates).zip(changes) {
            (*rate, *change) = (v[i], acceleration[i]);
        }
    }
}
