//! From a syntax to a machine: lowering of expressions, parts, attributes, expansion.

use crate::attributes::Attributes;
use crate::description::{Parameter, PartModel};
use crate::error::{Fault, Place, Read, quote};
use crate::expand::Expansion;
use crate::expression::Expression;
use crate::machine::Machine;
use crate::placement::{Copies, Motion, Placement};
use crate::resolve::Resolved;
use crate::shape_text::ShapeText;
use crate::solids::Solids;
use crate::supplement::Supplement;
use crate::syntax::{RawCopies, RawMotion, RawShape, Syntax};
use crate::units::Units;

/// The machine of a model's text, without its supplement.
pub(crate) fn build(syntax: &Syntax, files: [String; 2]) -> Read<Machine> {
    let resolved = Resolved::new(syntax)?;
    let (parameters, definitions) = parameters(&resolved)?;
    let shapes = syntax.shapes.iter().map(|s| shape(&resolved, s)).collect::<Read<Vec<_>>>()?;
    let placements = syntax.placements.iter().map(|p| placement(&resolved, p)).collect::<Read<Vec<_>>>()?;
    let copies = syntax.copies.iter().map(|c| copies_of(&resolved, c)).collect::<Read<Vec<_>>>()?;
    let solids = Solids::new(&resolved)?;
    let part_definitions = part_definitions(&resolved)?;
    check_total(&resolved, &solids, &part_definitions)?;
    let attributes = Attributes::new(&resolved, &part_definitions)?;
    let mut expansion = Expansion::new(&resolved, &solids, &attributes, &copies);
    let mut parts = Vec::with_capacity(part_definitions.len());
    for (i, &d) in part_definitions.iter().enumerate() {
        let csg = expansion.part(i, d)?;
        let name = resolved.name_of_definition(d).to_string();
        let place = syntax.definitions[d as usize].place;
        let (is_frame, density) = (attributes.frame == Some(i), attributes.densities[i].clone());
        parts.push(PartModel { name, csg, is_frame, density, walls: None, place });
    }
    let Expansion { poses, leaves, gears, unions, .. } = expansion;
    let order = parameter_order(&resolved);
    let name = syntax.generic.clone();
    let supplement = Supplement::default();
    let mut machine = Machine {
        files,
        name,
        parameters,
        definitions,
        order,
        shapes,
        placements,
        copies,
        poses,
        leaves,
        parts,
        gears,
        unions,
        supplement,
        units: Units::default(),
        native: None,
        wall_texts: Vec::new(),
    };
    machine.find_defaults();
    Ok(machine)
}

fn parameters(resolved: &Resolved) -> Read<(Vec<Parameter>, Vec<Option<Expression>>)> {
    let mut parameters = Vec::with_capacity(resolved.parameters.len());
    let mut expressions = Vec::with_capacity(resolved.parameters.len());
    for (name, definition) in &resolved.parameters {
        let text = definition.map(|d| &resolved.syntax.definitions[d as usize]);
        let formal = resolved.syntax.names[*name as usize].formal;
        let place = text.map(|d| d.place).or(formal).unwrap_or_default();
        let range = text.and_then(|d| d.range);
        parameters.push(Parameter {
            name: resolved.name(*name).to_string(),
            default: None,
            range,
            whole: false,
            unit: None,
            meaning: None,
            place,
        });
        expressions.push(text.map(|d| resolved.expression(&d.ops)).transpose()?);
    }
    Ok((parameters, expressions))
}

/// Parameters, each after those it uses.
fn parameter_order(resolved: &Resolved) -> Vec<u32> {
    let mut of_definition = vec![None; resolved.syntax.definitions.len()];
    let mut order = Vec::with_capacity(resolved.parameters.len());
    for (i, (_, definition)) in resolved.parameters.iter().enumerate() {
        match definition {
            Some(d) => of_definition[*d as usize] = Some(i as u32),
            None => order.push(i as u32),
        }
    }
    order.extend(resolved.order.iter().filter_map(|d| of_definition[*d as usize]));
    order
}

fn shape(resolved: &Resolved, raw: &RawShape) -> Read<ShapeText> {
    let mut sizes = [None, None, None];
    for (size, ops) in sizes.iter_mut().zip(&raw.sizes) {
        *size = ops.as_ref().map(|ops| resolved.expression(ops)).transpose()?;
    }
    let label = format!("{} ({})", resolved.name(raw.solid), raw.kind.name());
    Ok(ShapeText { kind: raw.kind, sizes, place: raw.place, label })
}

fn placement(resolved: &Resolved, raw: &[RawMotion]) -> Read<Placement> {
    let motion = |m: &RawMotion| {
        let amount = resolved.expression(&m.amount)?;
        Ok(Motion { turns: m.turns, axis: m.axis, amount })
    };
    raw.iter().map(motion).collect()
}

fn copies_of(resolved: &Resolved, raw: &RawCopies) -> Read<Copies> {
    let range = resolved.expression(&raw.range)?;
    Ok(Copies { kind: raw.kind, axis: raw.axis, count: raw.count, range })
}

/// The definitions of the parts, in the order of the result.
fn part_definitions(resolved: &Resolved) -> Read<Vec<u32>> {
    let syntax = resolved.syntax;
    let Some(parts) = &syntax.parts else {
        let (name, place) = (quote(resolved.name(syntax.result.0)), syntax.result.1);
        return Err(Fault::new(
            place,
            format!("the result {name} is not defined; expected its parts, joined by `asb`"),
        ));
    };
    let mut used = vec![false; syntax.definitions.len()];
    let mut definitions = Vec::with_capacity(parts.len());
    for (name, place) in parts {
        let definition = resolved.solid(*name, *place)?;
        if std::mem::replace(&mut used[definition as usize], true) {
            let message = format!("part {} is listed twice; expected it once", quote(resolved.name(*name)));
            return Err(Fault::new(*place, message));
        }
        definitions.push(definition);
    }
    Ok(definitions)
}

fn check_total(resolved: &Resolved, solids: &Solids, parts: &[u32]) -> Read<()> {
    let place: Place = resolved.syntax.result.1;
    match solids.total(parts.iter().copied()).excess() {
        Some(excess) => Err(Fault::new(place, format!("the parts together have {excess}"))),
        None => Ok(()),
    }
}
