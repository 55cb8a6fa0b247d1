//! The machine as a person edits it: parameters, solids, parts, supplement; and the text formats it is read from.
//!
//! A text becomes a [`Machine`]: numbers and shapes stay expressions. [`Machine::values`] evaluates the numbers,
//! [`Machine::primitives`] the shapes and their poses, over numbers or over dual numbers.

mod angle;
mod description;
mod error;
mod expression;
pub mod limits;
mod machine;
mod names;
mod placement;
mod shape_text;
mod values;

pub use description::{
    Density, Gear, GearMember, PairData, Parameter, PartModel, Spring, StateValue, Supplement,
    SymmetricUnion, SymmetryKind,
};
pub use error::{Error, Place, quote};
pub use expression::Expression;
pub use machine::Machine;
pub use values::{Overrides, Values};
