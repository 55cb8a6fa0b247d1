//! What a machine will do: patterns that repeat, rest, or neither (Gelsey 1995, Section 3.1).

mod hypothesis;
mod options;
mod passages;
mod predict;
mod terms;

pub use hypothesis::{Hypothesis, Pattern, Point, Series};
pub use options::PredictOptions;
pub use passages::whole_turns;
pub use predict::{Basis, NoPattern, Outcome, Prediction, predict};
pub use terms::{Floors, Label, MatchOptions, Terms};
