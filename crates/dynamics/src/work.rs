//! What drives and constant torques do: ∫ τ q̇ dt.
//!
//! A constant torque T does T Δq. The torque of a drive is what its prescribed motion takes, `τ = (M q̈ − f − Gᵀ λ) +
//! T sign(q̇)` with dry friction T; its power is smooth between events and integrated by quadrature.

use crate::component::Component;
use crate::energy::quadrature;
use crate::inertia::Inertia;
use crate::linear::Small;
use crate::path::Path;
use crate::world::World;
use mainspring_mechanism::System;

/// Work of constant torques and forces from time `from` to `to`.
pub fn applied_work(system: &System, paths: &[Path], from: f64, to: f64) -> f64 {
    let applied = system.forces.applied.iter().zip(paths).filter(|(f, path)| **f != 0.0 && !path.is_rest());
    applied.map(|(f, path)| f * (path.at(to).q - path.at(from).q)).sum()
}

/// Work of the drives over a stretch of one mode.
pub fn drive_work(
    world: &mut World,
    components: &[(Component, f64)],
    paths: &[Path],
    from: f64,
    to: f64,
) -> f64 {
    let moving: Vec<usize> = world.drives.iter().map(|d| d.0).filter(|&i| !paths[i].is_rest()).collect();
    if moving.is_empty() || to <= from {
        return 0.0;
    }
    let smooth = quadrature(from, to, |t| power(world, components, paths, &moving, t));
    let dry = |&i: &usize| world.system.forces.coulomb[i] * (paths[i].at(to).q - paths[i].at(from).q).abs();
    smooth + moving.iter().map(dry).sum::<f64>()
}

/// Power of the moving drives but for dry friction.
fn power(
    world: &mut World,
    components: &[(Component, f64)],
    paths: &[Path],
    moving: &[usize],
    t: f64,
) -> f64 {
    let states: Small<_, 8> = paths.iter().map(|p| p.with_acceleration(t)).collect();
    let q: Small<f64, 8> = states.iter().map(|s| s.0.q).collect();
    let v: Small<f64, 8> = states.iter().map(|s| s.0.v).collect();
    let mut a: Small<f64, 8> = states.iter().map(|s| s.1).collect();
    let mut torque: Small<f64, 8> = smallvec::smallvec![0.0; q.len()];
    for (component, _) in components {
        let mut at = component.constraints.state();
        if component.forces(world, t, (&q, &v), &mut a, &mut at) {
            moving.iter().for_each(|&i| torque[i] -= component.constraints.pressed(&at, i));
        }
    }
    let freedom = world.free.clone();
    let inertia = Inertia::whole(world.system, &freedom, (&q, &v));
    moving.iter().map(|&i| (torque[i] + inertia.missing(i, (&q, &v), &a)) * v[i]).sum()
}
