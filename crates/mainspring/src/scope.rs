//! What the simulation with rigid contact does not move yet is refused by name, never left out.

use mainspring_mechanism::{Mechanism, System};
use mainspring_model::{Error, Place};

/// Refuses chains, drives, stops, dry friction, and torques that vary with the angle.
pub(crate) fn check_rigid(mechanism: &Mechanism, system: &System) -> Result<(), Error> {
    let forces = &system.forces;
    if let Some(mass) = forces.masses.first() {
        let part = &mechanism.parts[mass.body];
        let why = if mass.chained { "moves on a moving part" } else { "turns under gravity" };
        return refuse(mechanism, part.place, &part.name, why, "parts on the frame and no gravity on them");
    }
    if let Some(drive) = mechanism.machine.supplement().drives.first() {
        let name = &mechanism.parts[drive.part].name;
        return refuse(mechanism, drive.place, name, "has a prescribed motion", "no drive");
    }
    if let Some(stop) = mechanism.machine.supplement().stops.first() {
        return refuse(mechanism, stop.place, &mechanism.parts[stop.part].name, "has a stop", "none");
    }
    if let Some(dry) = mechanism.machine.supplement().coulomb.iter().find(|c| c.value > 0.0) {
        return refuse(
            mechanism,
            dry.place,
            &mechanism.parts[dry.part].name,
            "has dry friction",
            "viscous friction",
        );
    }
    match mechanism.machine.supplement().forces.iter().find(|f| f.value != 0.0) {
        Some(f) => refuse(
            mechanism,
            f.place,
            &mechanism.parts[f.part].name,
            "has a constant torque or force",
            "none",
        ),
        None => Ok(()),
    }
}

fn refuse(mechanism: &Mechanism, place: Place, name: &str, why: &str, expected: &str) -> Result<(), Error> {
    let message = format!("{name} {why}, which rigid contact does not simulate; expected {expected}");
    Err(mechanism.machine.error(place, message))
}
