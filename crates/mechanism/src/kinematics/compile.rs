//! From a machine and parameter values to a mechanism.

use super::analysis::{Found, Shapes, analyse};
use super::bounds::Bounds;
use super::fits::Solid;
use super::gears::{GearData, Member, is_internal};
use super::joint_forces::JointForces;
use super::lower::{RELATIVE_TOLERANCE, solid};
use super::masses::PartMass;
use super::mechanism::{CompileOptions, Mechanism, Part, Warning};
use super::near_miss::{Miss, NearMiss};
use super::patch::Scene;
use super::plane::WorkingPlane;
use super::reach::Parts;
use super::region::without_leaves;
use super::stated::find_surfaces;
use super::subsystems::{holds, join, subsystems};
use super::supplement::{given, reflected};
use super::surface::lateral;
use super::symmetry::symmetries;
use super::words;
use super::work::Work;
use crate::forces::ContactLaw;
use mainspring_geometry::{
    Csg, Outline, OutlineBudget, OutlineError, OutlineRecipe, Primitive, Rigid3, Vec3, WallLayer,
};
use mainspring_model::{Error, Machine, Values};
use std::sync::{Arc, OnceLock};

impl Mechanism {
    /// Finds the pairs, subsystems and outlines of a machine with some parameters overridden.
    ///
    /// # Errors
    /// Wrong parameters or sizes, no frame, values of the supplement that contradict each other, parts that overlap
    /// at the start. Parts held by nothing, closed chains and pairs with two freedoms are no errors here.
    pub fn compile(
        machine: Arc<Machine>,
        set: &[(String, f64)],
        options: &CompileOptions,
    ) -> Result<Mechanism, Error> {
        let values = machine.values(set)?;
        let machine = if machine.is_toml() { Arc::new(machine.at(&values)?) } else { machine };
        let primitives = machine.primitives(&values)?;
        let frame = machine.frame().ok_or_else(|| no_frame(&machine))?;
        let mut mechanism = assemble(machine, &values, primitives, frame, options)?;
        given(&mut mechanism, &values)?;
        reflected(&mut mechanism);
        let unchecked = mechanism.check_start()?;
        mechanism.warnings.extend(unchecked);
        Ok(mechanism)
    }
}

/// Bound on the search for pairs.
const MAX_WORK: u64 = 8_000_000;
/// Bound on the work for one gear, of that for all.
const MAX_GEAR_WORK: u64 = 4_000_000;

fn no_frame(machine: &Machine) -> Error {
    let place = machine.parts().first().map_or(Default::default(), |p| p.place);
    machine.error(place, "no part is marked as the frame; expected a line like: attr frame : frame = 1")
}

fn assemble(
    machine: Arc<Machine>,
    values: &Values<f64>,
    primitives: Vec<Primitive>,
    frame: usize,
    options: &CompileOptions,
) -> Result<Mechanism, Error> {
    let boxes: Vec<Bounds> = primitives.iter().map(Bounds::of).collect();
    let models = machine.parts();
    let mut solids: Vec<Solid<'_>> = models.iter().map(|p| solid(&primitives, &boxes, &p.csg)).collect();
    // Drawn parts have boundaries and no solids: their pairs are stated, or found in the plane.
    for (solid, model) in solids.iter_mut().zip(models) {
        let Some(walls) = &model.walls else { continue };
        solid.laterals.clear();
        solid.faces.clear();
        solid.bounds = drawn_bounds(&primitives, walls).unwrap_or(solid.bounds);
    }
    let size = solids.iter().fold(Bounds::EMPTY, |b, s| b.join(&s.bounds)).diagonal();
    if !size.is_finite() {
        let message = "the machine's size overflows; expected lengths below 1e150".to_string();
        return Err(machine.error(models[frame].place, message));
    }
    let tolerance = RELATIVE_TOLERANCE * size;
    let work = Work::new(MAX_WORK);
    let scene = Scene { primitives: &primitives, boxes: &boxes, tolerance, work };
    let csgs: Vec<&Csg> = models.iter().map(|p| &p.csg).collect();
    let leaves: Vec<Vec<u32>> = csgs.iter().map(|c| leaves(c)).collect();
    let label = |i: u32| machine.label_of_primitive(i);

    let gears = gear_data(&machine, values, &scene, &solids)?;
    let shapes = Shapes {
        scene: &scene,
        solids: &solids,
        csgs: &csgs,
        leaves: &leaves,
        label: &label,
        models,
        stated: machine.supplement(),
    };
    let Found { mut pairs, misses, plane, closed_chains, mobility, warnings, rates } =
        analyse(&shapes, &gears, frame, size, options);
    let name = |i: usize| models[i].name.clone();
    words::tell(&mut pairs, name, label);

    let holds = holds(models.len(), frame, &pairs);
    let mut subsystems = subsystems(&holds, &pairs);
    rates.iter().for_each(|r| join(&mut subsystems, r, &holds, &pairs));
    let mut budget = OutlineBudget::default();
    let around = shapes.parts(&holds, &pairs, plane.normal);
    let parts: Vec<Part> = (0..models.len())
        .map(|i| {
            let Section { outline, recipe, note, tilted } = match &models[i].walls {
                Some(walls) => drawn_section(&primitives, walls, &plane),
                None => section(&around, i, &plane, &label, &mut budget),
            };
            Part {
                name: name(i),
                is_frame: i == frame,
                csg: csgs[i].clone(),
                bounds: solids[i].bounds,
                size: solids[i].bounds.diagonal(),
                symmetries: match models[i].walls {
                    Some(_) => vec![],
                    None => symmetries(&primitives, &leaves[i], scene.tolerance),
                },
                joint: holds[i].map(|h| h.pair),
                carrier: holds[i].map(|h| h.carrier),
                inertia: None,
                inertia_from_density: false,
                mass: PartMass::default(),
                friction: 0.0,
                spring: None,
                forces: JointForces::default(),
                position: 0.0,
                velocity: 0.0,
                outline,
                recipe,
                note,
                tilted,
                place: models[i].place,
            }
        })
        .collect();
    let mut warnings = warnings;
    for w in warnings.iter_mut().filter(|w| w.parts.len() == 2) {
        w.message = format!("{} and {}: {}", name(w.parts[0]), name(w.parts[1]), w.message);
    }
    warnings.extend(parts.iter().enumerate().filter_map(left_out));
    find_surfaces(&mut pairs, &parts, scene.tolerance);
    let near_misses = misses.iter().map(|m| near_miss(m, &name)).collect();
    let numbers = values.as_slice();
    let parameters = machine.parameters().iter().zip(numbers).map(|(p, v)| (p.name.clone(), *v)).collect();
    let tolerance = scene.tolerance;
    Ok(Mechanism {
        machine: machine.clone(),
        parameters,
        options: *options,
        parts,
        frame,
        pairs,
        near_misses,
        subsystems,
        closed_chains,
        mobility,
        plane,
        gravity: Vec3::default(),
        contact: ContactLaw::default(),
        warnings,
        size,
        primitives,
        tolerance,
        shapes: OnceLock::new(),
        whole: OnceLock::new(),
    })
}

pub(crate) fn leaves(csg: &Csg) -> Vec<u32> {
    let mut leaves: Vec<u32> = csg.leaves().collect();
    leaves.sort_unstable();
    leaves.dedup();
    leaves
}

fn gear_data(
    machine: &Machine,
    values: &Values<f64>,
    scene: &Scene<'_>,
    solids: &[Solid<'_>],
) -> Result<Vec<GearData>, Error> {
    let mut gears = Vec::new();
    for gear in machine.gears() {
        scene.work.open(MAX_GEAR_WORK);
        let of = |m: &mainspring_model::GearMember| {
            let lateral = lateral(m.primitive, &scene.primitives[m.primitive as usize])?;
            Some(Member { lateral, internal: is_internal(scene, &solids[gear.part], &lateral, m.adds) })
        };
        let members = gear.members.iter().filter_map(of).collect();
        if scene.work.ran_out() {
            let message = format!(
                "{} has too many primitives to tell on which side its teeth are; expected fewer",
                gear.name
            );
            return Err(machine.error(gear.place, message));
        }
        gears.push(GearData {
            part: gear.part,
            members,
            teeth: machine.teeth(gear, values)?,
            depth: machine.tooth_depth(gear, values)?,
            name: gear.name.clone(),
        });
    }
    Ok(gears)
}

/// A part's section in the working plane, or why there is none.
#[derive(Default)]
struct Section {
    outline: Option<Outline>,
    recipe: Option<OutlineRecipe>,
    note: Option<String>,
    tilted: Option<u32>,
}

/// The box around a drawn part: arcs only as far as they go.
fn drawn_bounds(primitives: &[Primitive], walls: &[WallLayer]) -> Option<Bounds> {
    let plane = Rigid3::identity();
    let outline = OutlineRecipe::of_walls(primitives, walls, &plane).ok()?.evaluate(primitives, &plane);
    let (min, max) = outline.bounds()?;
    let (first, last) = (outline.layers.first()?, outline.layers.last()?);
    let low = Vec3::new(min.x, min.y, first.bottom);
    Some(Bounds { low, high: Vec3::new(max.x, max.y, last.top) })
}

/// The section of a drawn part.
fn drawn_section(primitives: &[Primitive], walls: &[WallLayer], plane: &WorkingPlane) -> Section {
    let pose = &plane.plane_from_machine;
    match OutlineRecipe::of_walls(primitives, walls, pose) {
        Ok(recipe) => {
            let outline = Some(recipe.evaluate(primitives, pose));
            Section { outline, recipe: Some(recipe), ..Section::default() }
        }
        Err(_) => {
            let note = "its boundary is drawn in another plane than the one the machine works in";
            Section { note: Some(note.to_string()), ..Section::default() }
        }
    }
}

/// Primitives that are no prisms along the normal and out of everybody's reach are left out of the section.
fn section(
    parts: &Parts<'_>,
    part: usize,
    plane: &WorkingPlane,
    label: &impl Fn(u32) -> String,
    budget: &mut OutlineBudget,
) -> Section {
    let pose = &plane.plane_from_machine;
    let mut find =
        |csg: &Csg| budget.half(|b| OutlineRecipe::find_within(parts.placed.primitives, csg, pose, b));
    let mut found = find(parts.placed.csgs[part]);
    let mut note = None;
    if matches!(found, Err(OutlineError::NotPrismatic { .. })) {
        let unreached = parts.unreached(part);
        if let Some(first) = unreached.first() {
            found = find(&without_leaves(parts.placed.csgs[part], &unreached));
            note = Some(format!("{} is left out of the section: nothing can reach it", label(*first)));
        }
    }
    match found {
        Ok(recipe) => {
            let outline = Some(recipe.evaluate(parts.placed.primitives, pose));
            Section { outline, recipe: Some(recipe), note, tilted: None }
        }
        Err(OutlineError::NotPrismatic { primitive, .. }) => {
            let text = format!("{} is no prism along the normal of the working plane", label(primitive));
            Section { note: Some(text), tilted: Some(primitive), ..Section::default() }
        }
        Err(error) => Section { note: Some(error.to_string()), ..Section::default() },
    }
}

/// A section that leaves something out is told.
fn left_out((i, part): (usize, &Part)) -> Option<Warning> {
    let message = part.note.clone().filter(|_| part.outline.is_some())?;
    Some(Warning { place: None, parts: vec![i], message: format!("{}: {message}", part.name) })
}

fn near_miss(miss: &Miss, name: &impl Fn(usize) -> String) -> NearMiss {
    let of = |i: usize| name(if i == 0 { miss.parts.0 } else { miss.parts.1 });
    NearMiss { parts: miss.parts, primitives: miss.primitives, reason: miss.reason(of) }
}
