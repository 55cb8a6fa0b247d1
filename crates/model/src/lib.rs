//! The machine as a person edits it: parameters, solids, parts, supplement; and the text formats it is read from.
//!
//! A text becomes a [`Machine`]: numbers and shapes stay expressions. [`Machine::values`] evaluates the numbers,
//! [`Machine::primitives`] the shapes and their poses, over numbers or over dual numbers.

mod angle;
mod attributes;
mod build;
mod description;
mod error;
mod evaluate;
mod expand;
mod expression;
mod lexer;
pub mod limits;
mod load;
mod machine;
mod names;
mod native;
mod parse_file;
mod parse_forces;
mod parse_number;
mod parse_solid;
mod parse_supplement;
mod parser;
mod placement;
mod profile;
mod resolve;
mod shape_text;
mod solids;
mod source;
mod supplement;
mod syntax;
mod units;
mod values;

pub use description::{Density, Gear, GearMember, Parameter, PartModel, SymmetricUnion, SymmetryKind};
pub use error::{Error, Place, quote};
pub use expression::Expression;
pub use machine::Machine;
pub use native::MotionOver;
pub use supplement::{
    ContactData, DriveData, DriveKind, ForceData, GearPairData, GravityData, Mark, MassData, MotionData,
    MotionKind, PairData, PartNumber, Spring, StopData, Supplement,
};
pub use units::Units;
pub use values::{Overrides, Values, parse_setting};
