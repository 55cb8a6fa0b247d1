//! Kinetic energy of a mass on a chain of joints along the motion, with its rate and a bound of how fast that changes.

use crate::flight::Bounds;
use crate::linear::Small;
use crate::pace::Side;
use crate::path::Path;
use mainspring_geometry::Vec2;
use mainspring_mechanism::{Body, Mass, Motion, Placed, System};

/// A mass on a chain of two joints or more.
#[derive(Clone, Copy, Debug)]
pub struct ChainedMass<'a> {
    mass: &'a Mass,
    body: &'a Body,
}

/// All of a system.
pub fn chained_masses(system: &System) -> Small<ChainedMass<'_>, 2> {
    let chained = system.forces.masses.iter().filter(|m| m.chained);
    chained.map(|mass| ChainedMass { mass, body: &system.bodies[mass.body] }).collect()
}

impl ChainedMass<'_> {
    /// ½ m |ṗ|² + ½ I ω² and m ṗ·p̈ + I ω ω̇ at time `t`.
    pub fn energy_and_power(&self, system: &System, paths: &[Path], t: f64) -> (f64, f64) {
        let n = system.coordinates.len();
        let mut state: [Small<f64, 8>; 3] = std::array::from_fn(|_| smallvec::smallvec![0.0; n]);
        for joint in &self.body.chain {
            let i = joint.coordinate;
            let (s, a) = paths[i].with_acceleration(t);
            (state[0][i], state[1][i], state[2][i]) = (s.q, s.v, a);
        }
        let placed = Placed::new(self.body, &state[0]);
        let field = placed.field(&state[1], &state[2]);
        let p = placed.pose.apply(self.mass.center);
        let velocity = field.linear + p.perp() * field.turning;
        let acceleration =
            field.linear_rate + p.perp() * field.turning_rate + velocity.perp() * field.turning;
        let Mass { mass, inertia, .. } = *self.mass;
        let energy = 0.5 * (mass * velocity.dot(velocity) + inertia * field.turning * field.turning);
        (energy, mass * velocity.dot(acceleration) + inertia * field.turning * field.turning_rate)
    }

    /// A bound of how fast the power changes from `t` for a time `dt`: `m (A² + S J) + I (α² + ω j)`.
    pub fn bend(&self, paths: &[Path], t: f64, dt: f64) -> f64 {
        let mut side = Side::default();
        let mut reach = 0.0;
        let mut outer: Option<Vec2> = None;
        for joint in self.body.chain.iter().rev() {
            let path = &paths[joint.coordinate];
            let state = path.at(t);
            let bounds: Bounds = path.bounds(state, dt);
            let ratio = joint.ratio.abs();
            match joint.motion {
                Motion::Turn { center } => {
                    reach += (outer.unwrap_or(self.mass.center) - center).norm();
                    outer = Some(center);
                    side.add_joint((ratio * reach, ratio), bounds, path.jerk(bounds));
                }
                Motion::Slide { .. } => {
                    side.add_joint((ratio, 0.0), bounds, path.jerk(bounds));
                    reach += ratio * (state.q.abs() + bounds.speed * dt);
                }
            }
        }
        let Mass { mass, inertia, .. } = *self.mass;
        mass * side.point_bend() + inertia * side.turning_bend()
    }
}
