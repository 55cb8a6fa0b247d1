//! Dry friction at an instant: what it holds, and in which direction other coordinates slide.
//!
//! A coordinate at rest is held by a force μ within ± T. With `a = a₀ + M⁻¹ μ`, a₀ the accelerations without it, μ is
//! that of Gauss's principle: `a_i = 0` inside the bounds, `a_i ≥ 0` at −T, `a_i ≤ 0` at T (see `complementarity`). Forces
//! of compliant contacts are known from the state and are part of a₀.

use crate::complementarity::solve_bounded;
use crate::inertia::Inertia;
use crate::world::World;
use mainspring_mechanism::Row;

/// Accelerations below this fraction of those that meet count as zero.
const BALANCED: f64 = 1e-10;

/// Which coordinates dry friction holds, and the direction (±1) in which others slide.
pub struct Dry {
    pub stuck: Vec<bool>,
    pub sliding: Vec<f64>,
}

/// Resolves dry friction at time `t` and state `(q, v)`, velocities that count as zero being zero. `pressed` is Gᵀ l of
/// the contacts, `giving` a coordinate that has just been let go and where it goes.
pub fn resolve(
    world: &mut World,
    t: f64,
    (q, v): (&[f64], &[f64]),
    pressed: &[f64],
    giving: Option<(usize, f64)>,
) -> Dry {
    let n = q.len();
    let sizes = &world.system.forces.coulomb;
    let slides = |i: usize| match giving {
        _ if sizes[i] == 0.0 || world.moved.is_held(i) => 0.0,
        _ if v[i] != 0.0 => v[i].signum(),
        Some((k, direction)) if k == i => direction,
        _ => 0.0,
    };
    let mut sliding: Vec<f64> = (0..n).map(slides).collect();
    let rests = |&i: &usize| sizes[i] > 0.0 && sliding[i] == 0.0 && !world.moved.is_held(i);
    let resting: Vec<usize> = (0..n).filter(rests).collect();
    world.set_dry(&vec![false; n], &sliding);
    let inertia = Inertia::whole(world.system, &world.moved, (q, v));
    let mut acceleration = vec![0.0; n];
    world.prescribe(t, &mut acceleration);
    for i in (0..n).filter(|&i| world.moved.is_alone(i)) {
        acceleration[i] = world.acceleration_alone(i, q[i], v[i]);
    }
    inertia.accelerate(|i| world.dry_force(i), &mut acceleration);
    let all: Vec<Row> = (0..n).map(|i| Row::single(i, 1.0)).collect();
    inertia.add_forces(&all, pressed, &mut acceleration);
    let weights = inertia.weights((q, v), &acceleration);
    let rows: Vec<Row> = resting.iter().map(|&i| all[i]).collect();
    let b: Vec<f64> = resting.iter().map(|&i| acceleration[i]).collect();
    let tolerance: Vec<f64> =
        resting.iter().map(|&i| BALANCED * (weights[i] + acceleration[i].abs())).collect();
    let limits: Vec<f64> = resting.iter().map(|&i| sizes[i]).collect();
    let solution = solve_bounded(&inertia.inverse(&rows), &b, &tolerance, &limits);
    let mut stuck = vec![false; n];
    for (k, &i) in resting.iter().enumerate() {
        stuck[i] = solution.w[k].abs() <= tolerance[k];
        if !stuck[i] {
            sliding[i] = -solution.lambda[k].signum();
        }
    }
    Dry { stuck, sliding }
}
