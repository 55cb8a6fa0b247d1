//! Equations of motion `M(q) q̈ = f(q, q̇) + Gᵀ λ` of coordinates that hang together by masses on chains.
//!
//! A mass m with its centre at p, carried by joints of coordinates j:
//! ```text
//! J_j = ∂p/∂q_j                      r_j (p − o_j)^⊥ for a turn about o_j, r_j d_j for a slide along d_j
//! w_j                                turning of the body per unit of q_j: r_j for a turn, 0 for a slide
//! a₀  = Σ ∂²p/∂q_j∂q_k q̇_j q̇_k       acceleration of p without q̈: centrifugal and Coriolis
//! M_jk = I_j δ_jk + Σ (m J_j·J_k + I w_j w_k)
//! f_j  = f − k q_j − h q̇_j + Σ m J_j·(g − a₀)
//! ```
//! The first terms are the coordinate's own (constant inertia, springs, viscous friction), the sums go over its
//! masses; g is gravity. In the plane `w` is constant, so moments of inertia give no velocity terms. Written over
//! the scalar trait: dual numbers give the derivatives that an implicit solver needs. Dry friction, stops, contacts
//! and drives are not in f.

use crate::grouping::{Indices, join_sharing};
use crate::interaction::System;
use crate::placed::MAX_CHAIN;
use crate::system::{Body, Motion, Pose};
use mainspring_geometry::{Scalar, Vec2};
use num_dual::Dual64;

/// Coordinates that hang together by masses, or feel forces that are not linear: none of them flies in closed form.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coupled {
    /// In increasing order.
    pub coordinates: Indices,
    /// Indices into [`crate::Forces::masses`].
    pub masses: Indices,
    /// For each mass the places of its chain's coordinates in `coordinates`.
    places: Vec<[usize; MAX_CHAIN]>,
}

/// Mass matrix and forces of the coordinates of a [`Coupled`], in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Equations<S = f64> {
    /// M, row after row.
    pub mass: Vec<S>,
    /// f: springs, viscous friction, constant forces, gravity, velocity terms.
    pub force: Vec<S>,
}

impl<S> Default for Equations<S> {
    fn default() -> Self {
        Self { mass: vec![], force: vec![] }
    }
}

/// Derivatives of `f − M a` by positions and of f by velocities, at given accelerations a.
#[derive(Clone, Debug, Default)]
pub struct EquationsJacobian {
    /// `∂(f − M a)_i/∂q_k`, row after row.
    pub by_position: Vec<f64>,
    /// `∂f_i/∂q̇_k`, row after row.
    pub by_velocity: Vec<f64>,
    q: Vec<Dual64>,
    v: Vec<Dual64>,
    equations: Equations<Dual64>,
}

/// The motion of a mass: its centre, and what each joint of its chain does to it.
struct MassMotion<S> {
    count: usize,
    center: Vec2<S>,
    velocity: Vec2<S>,
    turning: S,
    /// J_j.
    columns: [Vec2<S>; MAX_CHAIN],
    /// w_j.
    spins: [f64; MAX_CHAIN],
    /// a₀.
    bias: Vec2<S>,
}

impl<S: Scalar> MassMotion<S> {
    /// `center` is where the body is modelled. Joints beyond [`MAX_CHAIN`] are not looked at.
    fn new(body: &Body, center: Vec2, q: &[S], v: &[S]) -> Self {
        let zero = Vec2::constant(Vec2::default());
        let (mut pose, mut at) = (Pose::<S>::identity(), [zero; MAX_CHAIN]);
        for (at, joint) in at.iter_mut().zip(&body.chain) {
            *at = match joint.motion {
                Motion::Turn { center } => pose.apply(Vec2::constant(center)),
                Motion::Slide { direction } => pose.rotate(Vec2::constant(direction)),
            };
            pose = pose.then_after(&joint.motion.pose(q[joint.coordinate] * joint.ratio));
        }
        let p = pose.apply(Vec2::constant(center));
        let (mut columns, mut spins) = ([zero; MAX_CHAIN], [0.0; MAX_CHAIN]);
        let mut velocity = zero;
        for (k, joint) in body.chain.iter().take(MAX_CHAIN).enumerate() {
            let turns = matches!(joint.motion, Motion::Turn { .. });
            let along = if turns { (p - at[k]).perp() } else { at[k] };
            (columns[k], spins[k]) =
                (along * S::constant(joint.ratio), if turns { joint.ratio } else { 0.0 });
            velocity = velocity + columns[k] * v[joint.coordinate];
        }
        // Each joint's column is carried by the joints before it: `linear + turning x^⊥` is their motion.
        let (mut linear, mut turning, mut bias) = (zero, S::constant(0.0), zero);
        for (joint, at) in body.chain.iter().zip(at) {
            let rate = v[joint.coordinate] * joint.ratio;
            if matches!(joint.motion, Motion::Turn { .. }) {
                bias = bias + (velocity - linear - at.perp() * turning).perp() * rate;
                linear = linear - at.perp() * rate;
                turning += rate;
            } else {
                bias = bias + at.perp() * (rate * turning);
                linear = linear + at * rate;
            }
        }
        let count = body.chain.len().min(MAX_CHAIN);
        Self { count, center: p, velocity, turning, columns, spins, bias }
    }
}

impl System {
    /// Mass matrix and forces of coupled coordinates. `q` and `v` hold all coordinates of the system.
    pub fn equations<S: Scalar>(&self, group: &Coupled, q: &[S], v: &[S], out: &mut Equations<S>) {
        let n = group.coordinates.len();
        out.mass.clear();
        out.mass.resize(n * n, S::constant(0.0));
        out.force.clear();
        for (k, &i) in group.coordinates.iter().enumerate() {
            let c = &self.coordinates[i];
            out.mass[k * n + k] = S::constant(c.inertia);
            out.force.push(-(q[i] * c.stiffness) - v[i] * c.damping + c.force);
        }
        for (&k, places) in group.masses.iter().zip(&group.places) {
            self.add_mass(k, places, q, v, n, out);
        }
    }

    fn add_mass<S: Scalar>(
        &self,
        k: usize,
        places: &[usize; MAX_CHAIN],
        q: &[S],
        v: &[S],
        n: usize,
        out: &mut Equations<S>,
    ) {
        let mass = &self.forces.masses[k];
        let motion = MassMotion::new(&self.bodies[mass.body], mass.center, q, v);
        let mut pull = Vec2::constant(self.forces.gravity);
        if mass.chained {
            pull = pull - motion.bias;
        }
        for i in 0..motion.count {
            out.force[places[i]] += motion.columns[i].dot(pull) * mass.mass;
            if mass.chained {
                for j in 0..motion.count {
                    let turning = mass.inertia * motion.spins[i] * motion.spins[j];
                    out.mass[places[i] * n + places[j]] +=
                        motion.columns[i].dot(motion.columns[j]) * mass.mass + turning;
                }
            }
        }
    }

    /// Derivatives of the equations of coupled coordinates at positions `q`, velocities `v` (of all coordinates) and
    /// accelerations `a` (of the group's, in its order): exact to rounding.
    pub fn equations_jacobian(
        &self,
        group: &Coupled,
        q: &[f64],
        v: &[f64],
        a: &[f64],
        out: &mut EquationsJacobian,
    ) {
        let n = group.coordinates.len();
        let EquationsJacobian { by_position, by_velocity, q: dual_q, v: dual_v, equations } = out;
        for list in [&mut *by_position, &mut *by_velocity] {
            list.clear();
            list.resize(n * n, 0.0);
        }
        for (dual, plain) in [(&mut *dual_q, q), (&mut *dual_v, v)] {
            dual.clear();
            dual.extend(plain.iter().map(|x| Dual64::from(*x)));
        }
        for (k, &c) in group.coordinates.iter().enumerate() {
            dual_q[c].eps = 1.0;
            self.equations(group, dual_q, dual_v, equations);
            dual_q[c].eps = 0.0;
            for i in 0..n {
                let inertial: f64 = (0..n).map(|j| equations.mass[i * n + j].eps * a[j]).sum();
                by_position[i * n + k] = equations.force[i].eps - inertial;
            }
            dual_v[c].eps = 1.0;
            self.equations(group, dual_q, dual_v, equations);
            dual_v[c].eps = 0.0;
            for i in 0..n {
                by_velocity[i * n + k] = equations.force[i].eps;
            }
        }
    }

    /// Kinetic energy of everything that moves.
    pub fn kinetic_energy<S: Scalar>(&self, q: &[S], v: &[S]) -> S {
        let own =
            self.coordinates.iter().zip(v).fold(S::constant(0.0), |sum, (c, v)| sum + *v * *v * c.inertia);
        let chained = self.forces.masses.iter().filter(|m| m.chained);
        let twice = chained.fold(own, |sum, mass| {
            let motion = MassMotion::new(&self.bodies[mass.body], mass.center, q, v);
            sum + motion.velocity.dot(motion.velocity) * mass.mass
                + motion.turning * motion.turning * mass.inertia
        });
        twice * 0.5
    }

    /// Potential energy of springs and gravity: springs relaxed and masses as modelled have none. What constant
    /// torques and forces do is work, not stored energy.
    pub fn potential_energy<S: Scalar>(&self, q: &[S]) -> S {
        let applied = |i: usize| self.forces.applied[i];
        let springs = self.coordinates.iter().enumerate().fold(S::constant(0.0), |sum, (i, c)| {
            sum + (q[i] * (0.5 * c.stiffness) - (c.force - applied(i))) * q[i] + c.energy_at_zero
        });
        let still = vec![S::constant(0.0); q.len()];
        self.forces.masses.iter().fold(springs, |sum, mass| {
            let motion = MassMotion::new(&self.bodies[mass.body], mass.center, q, &still);
            let fall = motion.center - Vec2::constant(mass.center);
            sum - fall.dot(Vec2::constant(self.forces.gravity)) * mass.mass
        })
    }
}

/// The coordinates that masses tie together, group by group in the order of their first coordinates.
pub(crate) fn coupled(system: &System) -> Vec<Coupled> {
    let chain = |k: usize| system.bodies[system.forces.masses[k].body].chain.iter().take(MAX_CHAIN);
    let sets = (0..system.forces.masses.len())
        .map(|k| (chain(k).map(|j| j.coordinate).collect(), Indices::from_slice(&[k])));
    let coupled = |(coordinates, masses)| Coupled { coordinates, masses, places: vec![] };
    let mut groups: Vec<Coupled> = join_sharing(sets).into_iter().map(coupled).collect();
    for group in &mut groups {
        let place = |c: usize| group.coordinates.partition_point(|i| *i < c);
        let places = |k: &usize| {
            let mut places = [0; MAX_CHAIN];
            places.iter_mut().zip(chain(*k)).for_each(|(p, j)| *p = place(j.coordinate));
            places
        };
        group.places = group.masses.iter().map(places).collect();
    }
    groups
}
