//! Inertia, mass and centre of mass of the parts: given, or from the density.
//!
//! A part that turns about o has J = I + m |c − o|², I about its centre of mass c. Of J, I, m and c the supplement may
//! give some; a density gives what is left.

use super::mechanism::{Mechanism, Part, Warning};
use super::near_miss::number;
use super::pair::PairKind;
use super::surface::off_line;
use mainspring_geometry::{
    MASS_WORK, OutlineBudget, Vec3, mass_properties_of_outline, mass_properties_within,
};
use mainspring_model::{Error, MassData, PartModel, Values};

/// Mass, centre of mass and moment of inertia about it, as far as they are known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartMass {
    pub mass: Option<f64>,
    /// Where the part is modelled, in machine coordinates.
    pub center: Option<Vec3>,
    /// About the centre, along the normal of the working plane.
    pub inertia: Option<f64>,
}

/// Two values given for one thing may differ by this part of the larger.
const SAME: f64 = 1e-6;
/// Bound on the work of all integrations, in primitives met by columns.
const MAX_MASS_WORK: usize = 12_000_000;
/// An inertia known less well than to this part is told.
const ROUGH: f64 = 1e-3;

/// Puts inertias and masses into the parts.
pub(crate) fn given(mechanism: &mut Mechanism, values: &Values<f64>) -> Result<(), Error> {
    let machine = mechanism.machine.clone();
    let moving = || machine.parts().iter().enumerate().filter(|(_, m)| !m.is_frame);
    let wanted = moving().filter(|(i, m)| m.density.is_some() && needs_shape(mechanism, *i)).count();
    let work = (MAX_MASS_WORK / wanted.max(1)).min(MASS_WORK);
    let (mut rough, mut budget) = (Vec::new(), OutlineBudget::default());
    for (i, model) in moving() {
        let shape = shape(mechanism, i, model, values, (work, &mut budget))?;
        rough.extend(shape.as_ref().filter(|s| s.error > ROUGH).map(|s| (i, s.error)));
        let line = machine.supplement().masses.iter().find(|m| m.part == i);
        let place = line.map_or(mechanism.parts[i].place, |l| l.place);
        let told = Told::new(mechanism, i, shape, line).map_err(|message| machine.error(place, message))?;
        let part = &mut mechanism.parts[i];
        part.inertia_from_density = told.from_shape && told.inertia.is_some();
        (part.inertia, part.mass) = (told.inertia, told.mass);
    }
    mechanism.warnings.extend(roughly_known(mechanism, &rough));
    Ok(())
}

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

/// What a part of uniform density has.
struct ShapeMass {
    mass: f64,
    center: Vec3,
    /// About the centre, along the normal.
    central: f64,
    /// About the joint's axis.
    joint: f64,
    /// Relative error of what was integrated.
    error: f64,
}

/// Is the shape asked for an inertia that is not given, a part on a moving one, or gravity?
fn needs_shape(mechanism: &Mechanism, i: usize) -> bool {
    let part = &mechanism.parts[i];
    let carried = part.carrier.is_some_and(|c| c != mechanism.frame);
    let gravity = mechanism.machine.supplement().gravity.is_some();
    part.joint.is_some() && (part.inertia.is_none() || carried || gravity)
}

/// From the density, where it is needed. Parts that are planar in no direction share the `work` of integration; what
/// it did not suffice for is told.
fn shape(
    mechanism: &Mechanism,
    i: usize,
    model: &PartModel,
    values: &Values<f64>,
    (work, budget): (usize, &mut OutlineBudget),
) -> Result<Option<ShapeMass>, Error> {
    let machine = &mechanism.machine;
    let Some(density) = machine.density(model, values)? else { return Ok(None) };
    let Some(joint) = mechanism.parts[i].joint.filter(|_| needs_shape(mechanism, i)) else { return Ok(None) };
    let solid = |budget: &mut OutlineBudget| {
        budget.half(|b| mass_properties_within(&mechanism.primitives, &model.csg, work, b))
    };
    let found = match &mechanism.parts[i].recipe {
        Some(recipe) if model.walls.is_some() => {
            let plane = &mechanism.plane.plane_from_machine;
            mass_properties_of_outline(recipe, &mechanism.primitives, plane)
        }
        _ => solid(budget).map_err(|e| {
            machine.error(model.place, format!("no inertia of {}: {e}; expected a solid", model.name))
        })?,
    };
    let axis = mechanism.pairs[joint].axis;
    Ok(Some(ShapeMass {
        mass: density * found.volume,
        center: found.center,
        central: density * found.moment_about(found.center, mechanism.plane.normal),
        joint: density * found.moment_about(axis.point, axis.direction),
        error: found.error,
    }))
}

/// What follows from all that is given.
struct Told {
    inertia: Option<f64>,
    mass: PartMass,
    from_shape: bool,
}

impl Told {
    fn new(
        mechanism: &Mechanism,
        i: usize,
        shape: Option<ShapeMass>,
        line: Option<&MassData>,
    ) -> Result<Self, String> {
        let part = &mechanism.parts[i];
        let center = line.map(|l| Vec3::new(l.center[0], l.center[1], l.center[2]));
        let center = center.or(shape.as_ref().map(|s| s.center));
        if mechanism.slides(i) {
            Self::sliding(part, center, shape, line)
        } else {
            Self::turning(mechanism, part, center, shape, line)
        }
    }

    /// The inertia of a sliding part is its mass; another mass than the shape's scales the shape's moment.
    fn sliding(
        part: &Part,
        center: Option<Vec3>,
        shape: Option<ShapeMass>,
        line: Option<&MassData>,
    ) -> Result<Self, String> {
        if let (Some(l), Some(given)) = (line, part.inertia) {
            agree(&part.name, "mass", l.mass, given)?;
        }
        let mass = part.inertia.or(line.map(|l| l.mass)).or(shape.as_ref().map(|s| s.mass));
        let scaled = || Some(shape.as_ref()?.central * mass? / shape.as_ref()?.mass);
        let inertia = line.and_then(|l| l.inertia).or_else(scaled);
        let from_shape = part.inertia.is_none() && line.is_none();
        Ok(Self { inertia: mass, mass: PartMass { mass, center, inertia }, from_shape })
    }

    fn turning(
        mechanism: &Mechanism,
        part: &Part,
        center: Option<Vec3>,
        shape: Option<ShapeMass>,
        line: Option<&MassData>,
    ) -> Result<Self, String> {
        let mass = line.map(|l| l.mass).or(shape.as_ref().map(|s| s.mass));
        let own = part.joint.filter(|j| mechanism.pairs[*j].kind != PairKind::Fixed);
        let Some(joint) = own else {
            let inertia = line.map_or(shape.as_ref().map(|s| s.central), |l| l.inertia);
            return Ok(Self {
                inertia: part.inertia,
                mass: PartMass { mass, center, inertia },
                from_shape: false,
            });
        };
        let axis = mechanism.pairs[joint].axis;
        let arm = center.map(|c| off_line(c, axis.point, axis.direction));
        let away = mass.zip(arm).map(|(m, d)| m * d * d);
        let about = line.and_then(|l| l.inertia).zip(away).map(|(i, away)| i + away);
        if let (Some(about), Some(given)) = (about, part.inertia) {
            agree(&part.name, "moment of inertia about its joint", about, given)?;
        }
        let from_shape = part.inertia.is_none() && about.is_none();
        let inertia = part.inertia.or(about).or(shape.as_ref().map(|s| s.joint));
        let left = inertia.zip(away).map(|(j, away)| (j, j - away));
        let central = line.and_then(|l| l.inertia).or(left.map(|l| l.1.max(0.0)));
        match left {
            Some((j, left)) if left < -SAME * j => Err(format!(
                "the moment of inertia of {} about its joint is {}, less than its mass at the distance of its centre alone has, {}; expected at least that",
                part.name,
                number(j),
                number(j - left)
            )),
            _ => Ok(Self { inertia, mass: PartMass { mass, center, inertia: central }, from_shape }),
        }
    }
}

/// The MASS line and the pair's line must say the same.
fn agree(name: &str, what: &str, by_mass: f64, by_pair: f64) -> Result<(), String> {
    if (by_mass - by_pair).abs() <= SAME * by_mass.max(by_pair) {
        return Ok(());
    }
    Err(format!(
        "the {what} of {name} is {} by MASS and {} by the line of its pair; expected values that agree",
        number(by_mass),
        number(by_pair)
    ))
}
