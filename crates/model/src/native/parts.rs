//! The tables of all parts.

use super::acting::{ACTING, Names, acting};
use super::fields::{Fields, Node};
use super::loops::{DRAWING, profile};
use super::lowering::Lowering;
use super::{Acting, GearText};
use crate::error::{Fault, Place, Read, quote};
use crate::profile::Profile;

/// A part's table, and which part it is.
pub(crate) struct PartTable<'a> {
    pub name: &'a str,
    pub place: Place,
    pub fields: Fields<'a>,
    pub is_frame: bool,
}

const OWN: [&str; 3] = ["frame", "solid", "density"];

pub(crate) fn tables<'a>(root: &Fields<'a>) -> Read<Vec<PartTable<'a>>> {
    let parts = root.need("parts", "the machine")?.table("parts")?;
    let known: Vec<&str> = OWN.into_iter().chain(DRAWING).chain(ACTING).collect();
    let mut found: Vec<PartTable<'a>> = Vec::new();
    for (name, place) in parts.keys() {
        let fields = parts.need(name, "parts")?.table(&format!("part {}", quote(name)))?;
        fields.allow(&format!("part {name}"), &known)?;
        let is_frame = fields.get("frame").map(|n| n.flag("frame")).transpose()?.unwrap_or(false);
        if is_frame && found.iter().any(|p| p.is_frame) {
            return Err(Fault::new(place, "a second frame; expected one part with `frame = true`"));
        }
        found.push(PartTable { name, place, fields, is_frame });
    }
    Ok(found)
}

/// What the tables say, part by part; a frame that has no table comes last.
pub(crate) fn contents(
    tables: &[PartTable<'_>],
    names: &Names<'_>,
    lower: &Lowering<'_>,
) -> Read<(Vec<Option<Profile>>, Vec<Acting>)> {
    let (mut profiles, mut actings) = (Vec::new(), Vec::new());
    for (i, table) in tables.iter().enumerate() {
        profiles.push(profile(table.name, &table.fields, lower)?);
        actings.push(acting(i, &table.fields, names, lower)?);
    }
    profiles.resize_with(names.parts.len(), || None);
    actings.resize_with(names.parts.len(), Acting::default);
    check_carriers(&actings, names)?;
    Ok((profiles, actings))
}

/// Stated carriers must lead to the frame.
fn check_carriers(actings: &[Acting], names: &Names<'_>) -> Read<()> {
    for (part, own) in actings.iter().enumerate() {
        let (mut at, mut steps) = (part, 0);
        while let Some(motion) = &actings[at].motion {
            (at, steps) = (motion.carrier, steps + 1);
            if steps > actings.len() {
                let place = own.motion.as_ref().map_or(own.place, |m| m.place);
                let message = format!(
                    "{} is carried by itself, round a ring of parts; expected carriers that lead to the frame",
                    names.parts[part]
                );
                return Err(Fault::new(place, message));
            }
        }
    }
    Ok(())
}

pub(crate) fn gears(node: &Node<'_>, names: &Names<'_>, lower: &Lowering<'_>) -> Read<Vec<GearText>> {
    node.list("gears")?.iter().map(|n| gear(n, names, lower)).collect()
}

fn gear(node: &Node<'_>, names: &Names<'_>, lower: &Lowering<'_>) -> Read<GearText> {
    let fields = node.table("gears")?;
    fields.allow("gears", &["parts", "teeth", "internal"])?;
    let list = fields.need("parts", "gears")?.list("parts")?;
    let [a, b] = &list[..] else {
        return Err(node.fault(format!("{} parts in mesh; expected two", list.len())));
    };
    let parts = [names.find(a, "a gear")?, names.find(b, "a gear")?];
    if parts[0] == parts[1] || parts.contains(&names.frame) {
        return Err(b.fault("a part in mesh with itself or the frame; expected two moving parts"));
    }
    let teeth = lower.pair(&fields.need("teeth", "gears")?, "teeth")?;
    let internal = fields.get("internal").map(|n| n.flag("internal")).transpose()?.unwrap_or(false);
    Ok(GearText { parts, teeth, internal, place: node.place })
}
