//! From the bytes of a TOML file to a machine.

use super::Native;
use super::acting::Names;
use super::fields::Fields;
use super::lowering::Lowering;
use super::parts::{PartTable, contents, gears, tables};
use super::source::Source;
use super::syntax::{ParameterNote, definitions};
use crate::build;
use crate::description::Density;
use crate::error::{Fault, Read};
use crate::machine::Machine;
use crate::resolve::Resolved;
use crate::syntax::Syntax;
use crate::units::Units;
use std::sync::Arc;

const KEYS: [&str; 6] = ["machine", "parameters", "solids", "parts", "gears", "world"];

pub(crate) fn read(text: &str, files: [String; 2]) -> Read<Machine> {
    let source = Source::new(text);
    let document = source.document()?;
    let root = Fields::root(&source, document.as_table());
    root.allow("the file", &KEYS)?;
    let (name, units) = head(&root)?;
    let tables = tables(&root)?;
    let mut found = definitions(&root)?;
    for part in &tables {
        found.part(part.name, part.place, part.fields.get("solid"))?;
    }
    if !tables.iter().any(|p| p.is_frame) {
        // A part may be called frame without being marked: then another name stands for what does not move.
        let free = ["frame", "ground", "the_frame"].into_iter().find(|n| !found.is_known(n));
        found.implicit_part(free.unwrap_or("the frame"), root.place);
    }
    let (syntax, notes) = found.finish(&name);
    let mut machine = build::build(&syntax, files)?;
    finish(&mut machine, &syntax, &tables, &root)?;
    machine.units = units;
    annotate(&mut machine, &notes)?;
    if let Some(native) = machine.native.as_mut().and_then(Arc::get_mut) {
        native.source = text.to_string();
    }
    // Where the values as written make no shape, compiling tells so.
    let expanded = machine.values(&[]).ok().and_then(|v| machine.at(&v).ok());
    Ok(expanded.unwrap_or(machine))
}

fn head(root: &Fields<'_>) -> Read<(String, Units)> {
    let mut units = Units::default();
    let Some(node) = root.get("machine") else { return Ok(("machine".to_string(), units)) };
    let fields = node.table("machine")?;
    fields.allow("machine", &["name", "length", "time", "mass", "angle"])?;
    let word = |key: &str, most| fields.get(key).map(|n| n.words(key, most)).transpose();
    (units.length, units.time, units.mass) = (word("length", 20)?, word("time", 20)?, word("mass", 20)?);
    if let Some(n) = fields.get("angle")
        && n.words("angle", 20)? != "deg"
    {
        return Err(n.fault("angles in a file are in degrees; expected \"deg\""));
    }
    Ok((word("name", 100)?.unwrap_or("machine".to_string()), units))
}

fn annotate(machine: &mut Machine, notes: &[ParameterNote]) -> Read<()> {
    // Parameters stand in the order of their definitions, and only they are numbers.
    for (parameter, note) in machine.parameters.iter_mut().zip(notes) {
        if let Some((written, stated)) = note.unit.as_deref().and_then(|u| machine.units.clash(u)) {
            let told = format!(
                "parameter {} is in `{written}`, in a machine that counts in `{stated}`; expected `{stated}`, for \
                 nothing is converted",
                parameter.name
            );
            return Err(Fault::new(parameter.place, told));
        }
        parameter.whole = note.whole;
        (parameter.unit, parameter.meaning) = (note.unit.clone(), note.meaning.clone());
    }
    machine.find_defaults();
    Ok(())
}

/// What stands beside the solids: frame, densities, drawings, what acts.
fn finish(machine: &mut Machine, syntax: &Syntax, tables: &[PartTable<'_>], root: &Fields<'_>) -> Read<()> {
    let resolved = Resolved::new(syntax)?;
    let lower = Lowering::new(&resolved);
    let parts: Vec<String> = machine.parts.iter().map(|p| p.name.clone()).collect();
    let frame = tables.iter().position(|p| p.is_frame).unwrap_or(tables.len());
    let names = Names { parts: parts.iter().map(String::as_str).collect(), frame };
    machine.parts[frame].is_frame = true;
    for (i, table) in tables.iter().enumerate() {
        machine.parts[i].place = table.place;
        if let Some(n) = table.fields.get("density") {
            let value = lower.expression(&n, "density")?;
            machine.parts[i].density = Some(Density { value, place: n.place });
        }
    }
    let (profiles, acting) = contents(tables, &names, &lower)?;
    let gears = root.get("gears").map_or(Ok(vec![]), |n| gears(&n, &names, &lower))?;
    let mut native = Native { source: String::new(), profiles, acting, gears, gravity: None, contact: None };
    world(&mut native, root, &lower)?;
    machine.native = Some(Arc::new(native));
    Ok(())
}

fn world(native: &mut Native, root: &Fields<'_>, lower: &Lowering<'_>) -> Read<()> {
    let Some(node) = root.get("world") else { return Ok(()) };
    let fields = node.table("world")?;
    fields.allow("world", &["gravity", "contact"])?;
    if let Some(n) = fields.get("gravity") {
        let mut field = lower.several(&n, "gravity", 2, 3)?.into_iter();
        native.gravity = Some((std::array::from_fn(|_| field.next()), n.place));
    }
    if let Some(n) = fields.get("contact") {
        let table = n.table("contact")?;
        table.allow("contact", &["E", "D", "M"])?;
        let one = |key: &str| lower.expression(&table.need(key, "contact")?, key);
        native.contact = Some(([one("E")?, one("D")?, one("M")?], n.place));
    }
    Ok(())
}
