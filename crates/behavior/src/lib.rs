//! What a machine will do: patterns that repeat, rest, or neither (Gelsey 1995, Section 3.1).

mod hypothesis;
mod options;
mod passages;
mod predict;

pub use hypothesis::{Floors, Hypothesis, Label, MatchOptions, Pattern, Point, Series};
pub use options::PredictOptions;
pub use passages::whole_turns;
pub use predict::{Basis, NoPattern, Outcome, Prediction, predict};
