//! When all is at rest: the energy that flights still hold.

use crate::flight::State;
use crate::path::Path;
use crate::world::World;

/// Remaining energy, relative to the greatest kinetic energy, at which flights count as at rest.
pub const AT_REST: f64 = 1e-13;

/// Energy that flights hold above their equilibria, at time `t` along the paths. Infinite when one has no equilibrium.
pub fn free_energy(world: &World, paths: &[Path], t: f64) -> f64 {
    let coordinates = &world.system.coordinates;
    coordinates
        .iter()
        .zip(paths)
        .enumerate()
        .filter(|(_, (_, path))| matches!(path, Path::Flight(_)))
        .map(|(i, (c, path))| {
            let State { q, v } = path.at(t);
            let force = c.force + world.dry_force(i);
            let away = if c.stiffness > 0.0 {
                0.5 * c.stiffness * (q - force / c.stiffness).powi(2)
            } else if force != 0.0 {
                f64::INFINITY
            } else {
                0.0
            };
            0.5 * c.inertia * v * v + away
        })
        .sum()
}

/// Shortens a stretch of flights only, in which nothing else moves, to the time at which they come to rest: `top` is
/// the greatest kinetic energy so far.
pub fn rest_time(world: &World, paths: &[Path], (from, to): (f64, f64), top: f64) -> f64 {
    // Before anything has moved, what can still be set free stands for the greatest kinetic energy.
    let level = AT_REST * if top > 0.0 { top } else { free_energy(world, paths, from) };
    if level <= 0.0 || !level.is_finite() || free_energy(world, paths, to) > level {
        return to;
    }
    let (mut moving, mut resting) = (from, to);
    for _ in 0..100 {
        let middle = 0.5 * (moving + resting);
        if free_energy(world, paths, middle) > level {
            moving = middle;
        } else {
            resting = middle;
        }
    }
    resting
}

/// Stretches stay short against swings, so that no minimum or extreme inside is overlooked; unbounded if nothing
/// swings.
pub fn longest_swing(paths: &[Path]) -> f64 {
    let swing = |path: &Path| match path {
        Path::Flight(flight) if flight.panel().1 == 1.0 => 4.0 * flight.panel().0,
        _ => f64::INFINITY,
    };
    paths.iter().map(swing).fold(f64::INFINITY, f64::min)
}
