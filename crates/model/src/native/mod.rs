//! The native machine file, TOML: what it says beyond parameters and solids, and how it is read and written back.
//!
//! Expressions and solids in it are those of PADL, read by the same parser; `syntax` reads parameters and solids,
//! `lowering` every further expression, the other files one kind of table each.

mod acting;
mod evaluate;
mod fields;
mod loops;
mod lowering;
mod parts;
mod read;
mod source;
mod syntax;
mod write;

pub use evaluate::MotionOver;
pub(crate) use read::read;
pub(crate) use write::with_values;

use crate::error::Place;
use crate::expression::Expression;
use crate::profile::{Point, Profile};

/// What only the TOML file says.
#[derive(Clone, Debug)]
pub(crate) struct Native {
    /// The whole text.
    pub source: String,
    /// For each part.
    pub profiles: Vec<Option<Profile>>,
    pub acting: Vec<Acting>,
    pub gears: Vec<GearText>,
    pub gravity: Option<([Option<Expression>; 3], Place)>,
    pub contact: Option<([Expression; 3], Place)>,
}

/// What a part's table says beside its shape.
#[derive(Clone, Debug, Default)]
pub(crate) struct Acting {
    /// Of the part's table.
    pub place: Place,
    pub motion: Option<MotionText>,
    pub inertia: Option<Expression>,
    pub friction: Option<Expression>,
    /// Relaxed position and constant.
    pub spring: Option<[Expression; 2]>,
    pub torque: Option<Expression>,
    pub force: Option<Expression>,
    pub dry_friction: Option<Expression>,
    pub drive: Option<(DriveText, Place)>,
    pub limits: Option<([Option<Expression>; 2], Place)>,
    pub mass: Option<MassText>,
    pub position: Option<Expression>,
    pub velocity: Option<Expression>,
    pub marks: Vec<(String, Expression)>,
}

#[derive(Clone, Debug)]
pub(crate) struct MotionText {
    pub carrier: usize,
    pub kind: MotionKindText,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub(crate) enum MotionKindText {
    Turns(Point),
    Slides(Point),
    Fixed,
}

#[derive(Clone, Debug)]
pub(crate) enum DriveText {
    Speed(Expression),
    /// Times and positions.
    Table(Vec<Point>),
}

#[derive(Clone, Debug)]
pub(crate) struct MassText {
    pub mass: Expression,
    /// Two or three coordinates.
    pub center: Vec<Expression>,
    pub inertia: Option<Expression>,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub(crate) struct GearText {
    pub parts: [usize; 2],
    pub teeth: [Expression; 2],
    pub internal: bool,
    pub place: Place,
}
