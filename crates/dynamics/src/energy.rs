//! The energy account of a run: what was there, what is left, what friction and impacts took, what drives and constant
//! torques gave.

use crate::path::Path;
use mainspring_mechanism::System;

/// Energies in the file's units; losses are positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic and potential energy at the start.
    pub initial: f64,
    /// Kinetic and potential energy at the end.
    pub last: f64,
    /// Done by drives and constant torques, by quadrature of their power and not by difference.
    pub work: f64,
    /// Lost to friction: ∫ Σ (h q̇² + T |q̇|) dt, by quadrature of the motion and not by difference.
    pub friction: f64,
    /// Lost at impacts: Σ ½ Δq̇ᵀ M Δq̇; with compliant contact what the contacts took.
    pub impacts: f64,
    /// Stored in overlaps at the end: Σ ½ E o² (compliant contact; 0 with rigid contact).
    pub contact_stored: f64,
    /// Greatest kinetic energy.
    pub kinetic_max: f64,
}

impl Energy {
    /// `(initial + work − last − contact_stored − friction − impacts) / max(friction + impacts, kinetic_max)`; 0 when
    /// nothing moved.
    pub fn residual(&self) -> f64 {
        let scale = (self.friction + self.impacts).max(self.kinetic_max);
        let left = self.last + self.contact_stored + self.friction + self.impacts;
        if scale > 0.0 { (self.initial + self.work - left) / scale } else { 0.0 }
    }
}

/// Kinetic energy at positions `q` and velocities `v`.
pub fn kinetic(system: &System, q: &[f64], v: &[f64]) -> f64 {
    if system.forces.masses.is_empty() {
        return system.coordinates.iter().zip(v).map(|(c, v)| 0.5 * c.inertia * v * v).sum();
    }
    system.kinetic_energy(q, v)
}

/// Potential energy of springs and gravity at positions `q`; constant torques store none.
pub fn potential(system: &System, q: &[f64]) -> f64 {
    system.potential_energy(q)
}

/// Friction loss of all coordinates over a stretch.
pub fn friction_loss(system: &System, paths: &[Path], from: f64, to: f64) -> f64 {
    let moving = system.coordinates.iter().zip(paths).enumerate().filter(|(_, (_, path))| !path.is_rest());
    moving
        .map(|(i, (c, path))| {
            let viscous = if c.damping > 0.0 { c.damping * squared_speed(path, from, to) } else { 0.0 };
            // No velocity changes sign inside a stretch where dry friction acts.
            let size = system.forces.coulomb[i];
            viscous + if size > 0.0 { size * (path.at(to).q - path.at(from).q).abs() } else { 0.0 }
        })
        .sum()
}

/// ∫ f dt by Gauss–Legendre quadrature of eight points.
pub fn quadrature(from: f64, to: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    NODES.iter().map(|(x, w)| w * (f(middle - half * x) + f(middle + half * x))).sum::<f64>() * half
}

/// Nodes and weights of Gauss–Legendre quadrature of eight points on [−1, 1]: exact for degree 15.
const NODES: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_27),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// ∫ v² dt. Panels are short against the flight's own times; for decaying flights they grow with the time passed.
fn squared_speed(path: &Path, from: f64, to: f64) -> f64 {
    let (first, growth) = match path {
        Path::Flight(flight) => flight.panel(),
        _ => (to - from, 1.0),
    };
    let (mut at, mut length, mut sum) = (from, first, 0.0);
    for _ in 0..10_000 {
        let end = to.min(at + length);
        sum += quadrature(at, end, |t| path.at(t).v.powi(2));
        if end >= to {
            break;
        }
        at = end;
        length *= growth;
    }
    sum
}
