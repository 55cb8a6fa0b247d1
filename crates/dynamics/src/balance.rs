//! What holds after impacts: accelerations, contact forces and what dry friction holds, by Gauss's principle.

use crate::complementarity::{Solution, solve_bounded};
use crate::inertia::Inertia;
use crate::linear::{Cholesky, Small};
use crate::near::{Chosen, Near};
use crate::opposed::hold_between;
use crate::run::Mode;
use crate::settle::{Closed, Instant, Settled};
use crate::world::World;
use mainspring_mechanism::{ContactSource, Row, System};

/// Relative accelerations below this fraction of those at hand count as zero.
const BALANCED: f64 = 1e-10;

/// Forces of the contacts known to be closed in a mode, at time `t` and state `(q, v)` within it (Gelsey 1995,
/// Sec. 2.2.2), in their order.
pub fn forces_at(
    system: &System,
    source: &dyn ContactSource,
    mode: &Mode,
    t: f64,
    (q, v): (&[f64], &[f64]),
) -> Vec<Closed> {
    let mut world = World::new(system, source);
    world.set_dry(&mode.stuck, &mode.sliding);
    world.follow_drives(t);
    let placed = world.place_all(q);
    let near: Vec<Near> =
        mode.closed.iter().map(|c| Near::new(world.touch_among(&c.candidate, q, &placed), v)).collect();
    let stuck: Vec<usize> = (0..q.len()).filter(|&i| mode.stuck[i]).collect();
    let problem = Balance::new(&world, near.iter().collect(), &stuck, t, (q, v));
    let forces = problem.solution.lambda;
    mode.closed.iter().zip(forces).map(|(c, force)| Closed { force, active: force > 0.0, ..*c }).collect()
}

/// Which touching contacts stay closed, with what forces, and what dry friction holds (Gauss's principle).
pub fn hold(world: &mut World, instant: &Instant, touches: &[&Near], v: &[f64], out: &mut Settled) {
    let still = touches.iter().filter(|t| t.rate(v).abs() <= t.still).copied().collect();
    let sliding = slides(world, instant, v);
    let none: Small<bool, 8> = smallvec::smallvec![false; v.len()];
    world.set_dry(&none, &sliding);
    let rests =
        |&i: &usize| world.system.forces.coulomb[i] > 0.0 && sliding[i] == 0.0 && !world.moved.is_held(i);
    let resting: Small<usize, 8> = (0..v.len()).filter(rests).collect();
    let problem = Balance::new(world, still, &resting, instant.t, (instant.q, v));
    (out.stuck, out.sliding) = problem.dry(&resting, sliding);
    let Balance { touches, tolerance, solution, acceleration, weights, .. } = problem;
    out.solved &= solution.solved;
    (out.acceleration, out.weights) = (acceleration, weights);
    for (k, near) in touches.iter().enumerate() {
        let (force, candidate) = (solution.lambda[k], near.touch.candidate);
        if force > 0.0 || solution.w[k] <= tolerance[k] {
            out.closed.push(Closed { candidate, gap: near.touch.state.gap, force, active: force > 0.0 });
            out.rows.push(near.row);
        }
    }
    hold_between(world, &out.rows, (instant.q, v), &mut out.closed);
}

/// Directions in which free coordinates with dry friction slide: by their velocities, or as they have just let go.
fn slides(world: &World, instant: &Instant, v: &[f64]) -> Vec<f64> {
    let sign = |i: usize| match instant.giving {
        Some((k, direction)) if k == i && v[i] == 0.0 => direction,
        _ if world.system.forces.coulomb[i] > 0.0 && v[i] != 0.0 => v[i].signum(),
        _ => 0.0,
    };
    (0..v.len()).map(|i| if world.moved.is_held(i) { 0.0 } else { sign(i) }).collect()
}

/// Accelerations, contact forces and what dry friction holds, over contacts with gap and rate zero and coordinates at
/// rest.
struct Balance<'n, 'p> {
    touches: Chosen<'n, 'p>,
    /// Relative accelerations below these count as zero, by row: contacts, then coordinates at rest.
    tolerance: Small<f64, 8>,
    solution: Solution,
    /// Of every coordinate.
    acceleration: Vec<f64>,
    weights: Small<f64, 8>,
    /// Sizes of dry friction of the coordinates at rest.
    sizes: Small<f64>,
    matrix: Small<f64, 16>,
}

impl<'n, 'p> Balance<'n, 'p> {
    fn new(
        world: &World,
        touches: Chosen<'n, 'p>,
        resting: &[usize],
        t: f64,
        (q, v): (&[f64], &[f64]),
    ) -> Self {
        let inertia = Inertia::whole(world.system, &world.moved, (q, v));
        let mut acceleration = vec![0.0; q.len()];
        world.prescribe_onset(t, &mut acceleration);
        for i in (0..q.len()).filter(|&i| world.moved.is_alone(i)) {
            acceleration[i] = world.acceleration_alone(i, q[i], v[i]);
        }
        inertia.accelerate(|i| world.dry_force(i), &mut acceleration);
        let weights = inertia.weights((q, v), &acceleration);
        let (mut rows, mut b) = (Small::<Row>::new(), Small::<f64, 8>::new());
        let mut tolerance = Small::<f64, 8>::new();
        let contacts = touches.iter().map(|near| (near.row, near.touch.bias(v)));
        for (row, bias) in contacts.chain(resting.iter().map(|&i| (Row::single(i, 1.0), 0.0))) {
            let weight: f64 = row.entries().map(|(i, g)| g.abs() * weights[i]).sum();
            b.push(row.dot(&acceleration) + bias);
            tolerance.push(BALANCED * (weight + bias.abs()));
            rows.push(row);
        }
        let sizes: Small<f64> = resting.iter().map(|&i| world.system.forces.coulomb[i]).collect();
        let matrix = inertia.inverse(&rows);
        let solution = solve_bounded(&matrix, &b, &tolerance, &sizes);
        inertia.add_forces(&rows, &solution.lambda, &mut acceleration);
        Self { touches, tolerance, solution, acceleration, weights, sizes, matrix }
    }

    /// Which of the coordinates at rest are stuck; those at the limit of friction slide. One that contacts hold as
    /// well is stuck only if it needs to be: what holds must stay independent.
    fn dry(&self, resting: &[usize], mut sliding: Vec<f64>) -> (Vec<bool>, Vec<f64>) {
        let contacts = self.touches.len();
        let n = contacts + self.sizes.len();
        let mut stuck = vec![false; sliding.len()];
        if resting.is_empty() {
            return (stuck, sliding);
        }
        let mut holding = self.solution.active.clone();
        for (k, (&i, size)) in resting.iter().zip(&self.sizes).enumerate() {
            let (row, force) = (contacts + k, self.solution.lambda[contacts + k]);
            if self.solution.active.contains(&row) {
                stuck[i] = true;
            } else if force.abs() >= *size {
                sliding[i] = -force.signum();
            } else {
                holding.push(row);
                let entries =
                    holding.iter().flat_map(|&r| holding.iter().map(move |&s| self.matrix[r * n + s]));
                stuck[i] = Cholesky::new(entries.collect(), holding.len()).is_some();
                if !stuck[i] {
                    holding.pop();
                }
            }
        }
        (stuck, sliding)
    }
}
