//! `attr` statements: the frame, gears, densities.

use crate::description::Density;
use crate::error::{Fault, Place, Read, quote};
use crate::expression::Expression;
use crate::names;
use crate::resolve::Resolved;
use crate::syntax::{Attribute, AttributeKey, Op};

/// A solid marked as a gear.
#[derive(Clone, Debug, Default)]
pub(crate) struct GearMark {
    /// The value of `gear` and its place.
    pub gear: Option<(bool, Place)>,
    pub teeth: Option<Expression>,
    pub depth: Option<Expression>,
}

/// All attributes, looked up.
pub(crate) struct Attributes {
    /// For each definition.
    pub gears: Vec<Option<Box<GearMark>>>,
    /// For each part.
    pub densities: Vec<Option<Density>>,
    pub frame: Option<usize>,
}

impl Attributes {
    /// `parts` are the definitions of the parts.
    pub fn new(resolved: &Resolved, parts: &[u32]) -> Read<Self> {
        let gears = vec![None; resolved.syntax.definitions.len()];
        let mut found = Self { gears, densities: vec![None; parts.len()], frame: None };
        let mut frames: Vec<Option<bool>> = vec![None; parts.len()];
        for attribute in &resolved.syntax.attributes {
            let solid = target(resolved, attribute)?;
            let part = || part_of(resolved, attribute, solid, parts);
            match attribute.key {
                AttributeKey::Frame => found.mark_frame(resolved, attribute, part()?, &mut frames)?,
                AttributeKey::Density => found.mark_density(resolved, attribute, part()?)?,
                _ => found.mark_gear(resolved, attribute, solid)?,
            }
        }
        found.check_gears(resolved)?;
        Ok(found)
    }

    fn mark_frame(
        &mut self,
        resolved: &Resolved,
        attribute: &Attribute,
        part: usize,
        frames: &mut [Option<bool>],
    ) -> Read<()> {
        let value = flag(attribute)?;
        if frames[part].replace(value).is_some() {
            return Err(twice(resolved, attribute));
        }
        if value && self.frame.replace(part).is_some() {
            return Err(Fault::new(attribute.place, "a second frame; expected one part marked `frame = 1`"));
        }
        Ok(())
    }

    fn mark_density(&mut self, resolved: &Resolved, attribute: &Attribute, part: usize) -> Read<()> {
        let value = resolved.expression(&attribute.value)?;
        let density = Density { value, place: attribute.value_place };
        if self.densities[part].replace(density).is_some() {
            return Err(twice(resolved, attribute));
        }
        Ok(())
    }

    fn mark_gear(&mut self, resolved: &Resolved, attribute: &Attribute, solid: u32) -> Read<()> {
        let mark = self.gears[solid as usize].get_or_insert_default();
        let repeated = match attribute.key {
            AttributeKey::Gear => mark.gear.replace((flag(attribute)?, attribute.place)).is_some(),
            AttributeKey::Teeth => mark.teeth.replace(resolved.expression(&attribute.value)?).is_some(),
            _ => mark.depth.replace(resolved.expression(&attribute.value)?).is_some(),
        };
        if repeated { Err(twice(resolved, attribute)) } else { Ok(()) }
    }

    /// Teeth and depth belong to gears.
    fn check_gears(&mut self, resolved: &Resolved) -> Read<()> {
        for attribute in &resolved.syntax.attributes {
            if !matches!(attribute.key, AttributeKey::Teeth | AttributeKey::Depth) {
                continue;
            }
            let mark = &self.gears[target(resolved, attribute)? as usize];
            if !mark.as_ref().is_some_and(|m| matches!(m.gear, Some((true, _)))) {
                let (name, key) = (resolved.name(attribute.name), attribute.key.name());
                let message =
                    format!("{name} has {key} and is no gear; expected `attr {name} : gear = 1` as well");
                return Err(Fault::new(attribute.place, message));
            }
        }
        for mark in &mut self.gears {
            mark.take_if(|m| !matches!(m.gear, Some((true, _))));
        }
        Ok(())
    }
}

/// The solid an attribute is about.
fn target(resolved: &Resolved, attribute: &Attribute) -> Read<u32> {
    resolved.solid(attribute.name, attribute.place).map_err(|mut fault| {
        let solids: Vec<&str> = resolved.solid_names().collect();
        let expected = names::one_of(&solids, resolved.name(attribute.name));
        let what = fault.message.split(';').next().unwrap_or("").to_string();
        fault.message = format!("{what}; expected a part or solid, {expected}");
        fault
    })
}

fn part_of(resolved: &Resolved, attribute: &Attribute, solid: u32, parts: &[u32]) -> Read<usize> {
    parts.iter().position(|p| *p == solid).ok_or_else(|| {
        let known: Vec<&str> = parts.iter().map(|p| resolved.name_of_definition(*p)).collect();
        let (what, key) = (quote(resolved.name(attribute.name)), attribute.key.name());
        let message =
            format!("{what} is not a part, and {key} is said of parts; expected {}", names::list(&known));
        Fault::new(attribute.place, message)
    })
}

fn flag(attribute: &Attribute) -> Read<bool> {
    match attribute.value[..] {
        [(Op::Number(1.0), _)] => Ok(true),
        [(Op::Number(0.0), _)] => Ok(false),
        _ => {
            let message = format!("the value of {} is neither 1 nor 0; expected 1", attribute.key.name());
            Err(Fault::new(attribute.value_place, message))
        }
    }
}

fn twice(resolved: &Resolved, attribute: &Attribute) -> Box<Fault> {
    let (name, key) = (resolved.name(attribute.name), attribute.key.name());
    Fault::new(attribute.place, format!("the {key} of {name} is given twice; expected it once"))
}
