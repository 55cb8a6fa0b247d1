//! What the supplement tells, in the units of the joints: radians where a part turns.

use super::mechanism::{JointSpring, Mechanism, Warning};
use super::pair::PairKind;
use mainspring_geometry::{MASS_WORK, OutlineBudget, mass_properties_within};
use mainspring_model::{Error, PairData, Place, StateValue, Values};

/// Joint positions of one subsystem may contradict each other by this much (radians, or parts of the machine).
const SAME_POSITION: f64 = 1e-9;

/// Puts inertias, frictions, springs and the initial state into the parts.
pub(crate) fn given(mechanism: &mut Mechanism, values: &Values<f64>) -> Result<(), Error> {
    let machine = mechanism.machine.clone();
    let supplement = machine.supplement();
    for data in &supplement.pairs {
        pair_data(mechanism, data);
    }
    densities(mechanism, values)?;
    let positions = spread(mechanism, &supplement.positions, "position")?;
    let velocities = spread(mechanism, &supplement.velocities, "velocity")?;
    for (part, (x, v)) in mechanism.parts.iter_mut().zip(positions.into_iter().zip(velocities)) {
        (part.position, part.velocity) = (x, v);
    }
    Ok(())
}

fn pair_data(mechanism: &mut Mechanism, data: &PairData) {
    let slides = slides(mechanism, data.part);
    let part = &mut mechanism.parts[data.part];
    part.inertia = data.inertia;
    part.friction = data.friction;
    part.place = data.place;
    part.spring = data.spring.map(|s| JointSpring {
        relaxed: if slides { s.relaxed } else { s.relaxed.to_radians() },
        constant: s.constant,
    });
    if part.carrier.is_some_and(|c| c != data.other) {
        let name = part.name.clone();
        mechanism.warnings.push(Warning {
            place: Some(data.place),
            parts: vec![data.part],
            message: format!(
                "{name} is carried by another part than this line says: its values act on that joint"
            ),
        });
    }
}

/// Does the part's joint slide (and not turn)?
fn slides(mechanism: &Mechanism, part: usize) -> bool {
    let kind = mechanism.parts[part].joint.map(|j| mechanism.pairs[j].kind);
    kind == Some(PairKind::Prismatic)
}

/// Inertias that were not given, from densities: about the joint's axis, or the mass where the part slides. Parts
/// that are planar in no direction share the work of integration; what it did not suffice for is told.
fn densities(mechanism: &mut Mechanism, values: &Values<f64>) -> Result<(), Error> {
    let machine = mechanism.machine.clone();
    let mut wanted = Vec::new();
    for (i, model) in machine.parts().iter().enumerate() {
        let density = machine.density(model, values)?;
        if let (Some(density), None, Some(joint)) =
            (density, mechanism.parts[i].inertia, mechanism.parts[i].joint)
        {
            wanted.push((i, density, joint));
        }
    }
    let work = (MAX_MASS_WORK / wanted.len().max(1)).min(MASS_WORK);
    let (mut rough, mut budget) = (Vec::new(), OutlineBudget::default());
    for (i, density, joint) in wanted {
        let (model, axis) = (&machine.parts()[i], mechanism.pairs[joint].axis);
        let properties = budget
            .half(|b| mass_properties_within(&mechanism.primitives, &model.csg, work, b))
            .map_err(|e| {
                machine
                    .error(model.place, format!("no inertia of {}: {e}, expected finite sizes", model.name))
            })?;
        let per_density = if slides(mechanism, i) {
            properties.volume
        } else {
            properties.moment_about(axis.point, axis.direction)
        };
        rough.extend((properties.error > ROUGH).then_some((i, properties.error)));
        let part = &mut mechanism.parts[i];
        (part.inertia, part.inertia_from_density) = (Some(density * per_density), true);
    }
    mechanism.warnings.extend(roughly_known(mechanism, &rough));
    Ok(())
}

/// Bound on the work of all integrations, in primitives met by columns.
const MAX_MASS_WORK: usize = 12_000_000;
/// An inertia known less well than to this part is told.
const ROUGH: f64 = 1e-3;

fn roughly_known(mechanism: &Mechanism, rough: &[(usize, f64)]) -> Option<Warning> {
    let &(first, error) = rough.first()?;
    let others = match rough.len() - 1 {
        0 => String::new(),
        n => format!(", nor are those of {n} other parts"),
    };
    let name = &mechanism.parts[first].name;
    let message = format!(
        "the inertia of {name}, from its density, is not known better than to {}%{others}",
        super::near_miss::number((error * 100.0).min(100.0))
    );
    Some(Warning { place: None, parts: rough.iter().map(|r| r.0).collect(), message })
}

/// Values given for some parts, brought to all parts of their subsystems.
fn spread(mechanism: &Mechanism, given: &[StateValue], what: &str) -> Result<Vec<f64>, Error> {
    let mut of_part = vec![0.0; mechanism.parts.len()];
    let mut roots: Vec<Option<(f64, Place)>> = vec![None; mechanism.subsystems.len()];
    for state in given {
        let value = if slides(mechanism, state.part) { state.value } else { state.value.to_radians() };
        let Some((s, ratio)) = mechanism.subsystem_of(state.part) else {
            let name = &mechanism.parts[state.part].name;
            let message =
                format!("{name} has no joint to take a {what}, expected a part that turns or slides");
            return Err(mechanism.machine.error(state.place, message));
        };
        if mechanism.subsystems[s].closed && value != 0.0 {
            let name = &mechanism.parts[state.part].name;
            let message = format!("{name} is in a closed chain of pairs, expected no {what} for its parts");
            return Err(mechanism.machine.error(state.place, message));
        }
        let at_root = value / ratio;
        match roots[s] {
            Some((known, _)) if (known - at_root).abs() > SAME_POSITION * (1.0 + known.abs()) => {
                let name = &mechanism.parts[state.part].name;
                let message = format!(
                    "the {what} of {name} contradicts that of a gear in mesh with it, expected values in the gears' ratio"
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
