//! What the supplement tells, in the units of the joints: radians where a part turns.

use super::mechanism::{JointSpring, Mechanism, Warning};
use super::pair::Pair;
use super::{joint_forces, masses};
use crate::forces::ContactLaw;
use mainspring_geometry::Vec3;
use mainspring_model::{Error, PairData, PartNumber, Place, Values};

/// Joint positions of one subsystem may contradict each other by this much (radians, or parts of the machine).
const SAME_POSITION: f64 = 1e-9;

/// Puts inertias, forces, drives, stops and the initial state into the parts.
pub(crate) fn given(mechanism: &mut Mechanism, values: &Values<f64>) -> Result<(), Error> {
    let machine = mechanism.machine.clone();
    let supplement = machine.supplement();
    for data in &supplement.pairs {
        pair_data(mechanism, data)?;
    }
    masses::given(mechanism, values)?;
    let positions = spread(mechanism, &supplement.positions, "position")?;
    let velocities = spread(mechanism, &supplement.velocities, "velocity")?;
    for (part, (x, v)) in mechanism.parts.iter_mut().zip(positions.into_iter().zip(velocities)) {
        (part.position, part.velocity) = (x, v);
    }
    joint_forces::given(mechanism)?;
    mechanism.start_drives();
    mechanism.check_stops()?;
    if let Some(gravity) = &supplement.gravity {
        let [x, y, z] = gravity.field;
        mechanism.gravity = Vec3::new(x, y, z);
        mechanism.warnings.extend(across(mechanism, gravity.place));
    }
    if let Some(c) = &supplement.contact {
        mechanism.contact = ContactLaw { e: c.e, d: c.d, m: c.m };
    }
    Ok(())
}

/// Gravity along the normal does nothing where all motion is planar.
fn across(mechanism: &Mechanism, place: Place) -> Option<Warning> {
    let along = mechanism.gravity.dot(mechanism.plane.normal);
    let lost = along.abs() > 1e-12 * mechanism.gravity.norm();
    let message = format!(
        "{} of gravity is along the normal of the working plane and moves nothing",
        super::near_miss::number(along.abs())
    );
    lost.then_some(Warning { place: Some(place), parts: vec![], message })
}

/// The line of a pair belongs to the joint by which its first part hangs on its second.
fn pair_data(mechanism: &mut Mechanism, data: &PairData) -> Result<(), Error> {
    mechanism.parts[data.part].place = data.place;
    let part = &mechanism.parts[data.part];
    let hangs = |c: usize| mechanism.mover(c) == mechanism.mover(data.other);
    let here = data.other == data.part || part.carrier.is_none_or(|c| c == data.other);
    if let Some(carrier) = part.carrier.filter(|c| !here && !hangs(*c)) {
        let (name, other) = (&part.name, &mechanism.parts[data.other].name);
        let is_pair =
            |p: &Pair| p.is_lower() && [(data.part, data.other), (data.other, data.part)].contains(&p.parts);
        if mechanism.parts[data.other].carrier == Some(data.part) {
            let message = format!(
                "{name} carries {other} and not the other way round; expected `< {other} : {name} >`"
            );
            return Err(mechanism.machine.error(data.place, message));
        }
        if !mechanism.pairs.iter().any(is_pair) {
            let carrier = &mechanism.parts[carrier].name;
            let message =
                format!("{name} and {other} form no pair; expected `< {name} : {carrier} >`, which do");
            return Err(mechanism.machine.error(data.place, message));
        }
        let message =
            format!("{name} and {other} close a chain of pairs: the values of this line are left out");
        mechanism.warnings.push(Warning { place: Some(data.place), parts: vec![data.part], message });
        return Ok(());
    }
    if !here {
        let message = format!(
            "{} is carried by another part than this line says: its values act on that joint",
            part.name
        );
        mechanism.warnings.push(Warning { place: Some(data.place), parts: vec![data.part], message });
    }
    let unit = mechanism.unit(data.part);
    let part = &mut mechanism.parts[data.part];
    part.inertia = data.inertia;
    part.friction = data.friction;
    part.spring = data.spring.map(|s| JointSpring { relaxed: s.relaxed * unit, constant: s.constant });
    Ok(())
}

/// Values given for some parts, brought to all parts of their subsystems.
fn spread(mechanism: &Mechanism, given: &[PartNumber], what: &str) -> Result<Vec<f64>, Error> {
    let mut of_part = vec![0.0; mechanism.parts.len()];
    let mut roots: Vec<Option<(f64, Place)>> = vec![None; mechanism.subsystems.len()];
    for state in given {
        let value = state.value * mechanism.unit(state.part);
        let Some((s, ratio)) = mechanism.subsystem_of(state.part) else {
            let name = &mechanism.parts[state.part].name;
            let message =
                format!("{name} has no joint to take a {what}; expected a part that turns or slides");
            return Err(mechanism.machine.error(state.place, message));
        };
        if mechanism.subsystems[s].closed && value != 0.0 {
            let name = &mechanism.parts[state.part].name;
            let message = format!("{name} is in a closed chain of pairs; expected no {what} for its parts");
            return Err(mechanism.machine.error(state.place, message));
        }
        let at_root = value / ratio;
        match roots[s] {
            Some((known, _)) if (known - at_root).abs() > SAME_POSITION * (1.0 + known.abs()) => {
                let name = &mechanism.parts[state.part].name;
                let message = format!(
                    "the {what} of {name} contradicts that of a gear in mesh with it; expected values that agree"
                );
                return Err(mechanism.machine.error(state.place, message));
            }
            _ => roots[s] = Some((at_root, state.place)),
        }
    }
    for (subsystem, root) in mechanism.subsystems.iter().zip(roots) {
        for (part, ratio) in &subsystem.parts {
            of_part[*part] = root.map_or(0.0, |(x, _)| x * ratio);
        }
    }
    Ok(of_part)
}

/// Inertias seen at the roots.
pub(crate) fn reflected(mechanism: &mut Mechanism) {
    for subsystem in &mut mechanism.subsystems {
        let seen = |(part, ratio): &(usize, f64)| Some(mechanism.parts[*part].inertia? * ratio * ratio);
        // In a closed chain it depends on the position, and parts do not simply turn or slide.
        let known = if subsystem.closed { None } else { subsystem.parts.iter().map(seen).sum() };
        subsystem.inertia = known;
    }
}
