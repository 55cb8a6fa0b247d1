//! The machine: what a text says, before any number is put in.

use crate::description::{Gear, Parameter, PartModel, SymmetricUnion};
use crate::error::{Error, Place, Read, SETTING_FILE, file_name};
use crate::expression::Expression;
use crate::native::Native;
use crate::placement::{Copies, Placement, PoseStep};
use crate::profile::WallText;
use crate::shape_text::ShapeText;
use crate::supplement::Supplement;
use crate::units::Units;
use std::sync::Arc;

/// A machine as a person edits it: parameters, parts and supplement.
#[derive(Clone, Debug)]
pub struct Machine {
    pub(crate) files: [String; 2],
    pub(crate) name: String,
    pub(crate) parameters: Vec<Parameter>,
    /// The text of each parameter; none where the generic's list names one without a definition.
    pub(crate) definitions: Vec<Option<Expression>>,
    /// Parameters in an order in which each comes after those it uses.
    pub(crate) order: Vec<u32>,
    pub(crate) shapes: Vec<ShapeText>,
    pub(crate) placements: Vec<Placement>,
    pub(crate) copies: Vec<Copies>,
    pub(crate) poses: Vec<PoseStep>,
    pub(crate) leaves: Vec<Leaf>,
    pub(crate) parts: Vec<PartModel>,
    pub(crate) gears: Vec<Gear>,
    pub(crate) unions: Vec<SymmetricUnion>,
    pub(crate) supplement: Supplement,
    pub(crate) units: Units,
    /// What only a TOML file says; none for a machine in PADL.
    pub(crate) native: Option<Arc<Native>>,
    /// Of the primitives after those of the solids: the walls of drawn parts.
    pub(crate) wall_texts: Vec<WallText>,
}

/// A primitive after expansion: a shape of the text at a pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub shape: u32,
    pub pose: u32,
}

impl Machine {
    /// The generic's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The parts in the order of the result's `asb`.
    pub fn parts(&self) -> &[PartModel] {
        &self.parts
    }

    /// Index of the part marked as the frame.
    pub fn frame(&self) -> Option<usize> {
        self.parts.iter().position(|p| p.is_frame)
    }

    /// Index of a part by its name, in any letter case.
    pub fn part_index(&self, name: &str) -> Option<usize> {
        self.parts.iter().position(|p| p.name.eq_ignore_ascii_case(name))
    }

    /// The numeric definitions in the order of the text.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Index of a parameter by its name, in any letter case.
    pub fn parameter_index(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name.eq_ignore_ascii_case(name))
    }

    /// Inertias, forces, drives, stops and the initial state; empty if no supplement was given.
    pub fn supplement(&self) -> &Supplement {
        &self.supplement
    }

    /// Every instance of a solid marked as a gear, part by part.
    pub fn gears(&self) -> &[Gear] {
        &self.gears
    }

    /// Every instance of a symmetric union, part by part; nested ones before those that contain them.
    pub fn symmetric_unions(&self) -> &[SymmetricUnion] {
        &self.unions
    }

    /// Was it read from a TOML file?
    pub fn is_toml(&self) -> bool {
        self.native.is_some()
    }

    /// The units the file states.
    pub fn units(&self) -> &Units {
        &self.units
    }

    /// Number of primitives in all parts, walls of drawn parts at the values last put in included.
    pub fn primitive_count(&self) -> usize {
        self.leaves.len() + self.wall_texts.len()
    }

    /// Where a primitive is written; the default place if there is no such primitive.
    pub fn place_of_primitive(&self, primitive: u32) -> Place {
        let wall = self.wall_of(primitive).map_or(Place::default(), |w| w.place);
        self.shape_of(primitive).map_or(wall, |s| s.place)
    }

    /// A primitive in words, for example `tooth (blo)`: the solid whose definition it stands in, and its kind.
    pub fn label_of_primitive(&self, primitive: u32) -> String {
        let wall = self.wall_of(primitive).map_or(String::new(), |w| w.label.clone());
        self.shape_of(primitive).map_or(wall, |s| s.label.clone())
    }

    fn wall_of(&self, primitive: u32) -> Option<&WallText> {
        self.wall_texts.get((primitive as usize).checked_sub(self.leaves.len())?)
    }

    fn shape_of(&self, primitive: u32) -> Option<&ShapeText> {
        self.leaves.get(primitive as usize).map(|l| &self.shapes[l.shape as usize])
    }

    /// An error at a place, with the file's name put in.
    pub fn error(&self, place: Place, message: impl Into<String>) -> Error {
        let file = match place.file {
            0 | 1 => file_name(&self.files[place.file as usize]),
            _ => SETTING_FILE.to_string(),
        };
        Error { file, line: place.line, column: place.column, message: message.into() }
    }

    pub(crate) fn named<T>(&self, result: Read<T>) -> Result<T, Error> {
        result.map_err(|fault| self.error(fault.place, fault.message))
    }
}
