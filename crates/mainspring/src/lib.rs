//! The facade: load, compile, inspect, simulate, predict, as JSON with stable keys (docs/guide/json.md).

mod contacts;
mod drawing;
mod inspect;
mod joints;
mod options;
mod prediction;
mod sentences;
mod simulation;
mod words;

pub use drawing::drawing_json;
pub use inspect::{inspect_json, parameters_json};
pub use mainspring_behavior::{MatchOptions, Outcome, PredictOptions};
pub use mainspring_dynamics::Status;
pub use mainspring_mechanism::{CompileOptions, Mechanism};
pub use mainspring_model::{Error, Machine};
pub use prediction::{PredictionResult, predict};
pub use simulation::{ContactSearch, SimulationOptions, SimulationResult, simulate};
