//! The facade: load, compile, inspect, map, simulate, predict, as JSON with stable keys (docs/guide/json.md).

mod comparison;
mod contact_model;
mod contacts;
mod drawing;
mod inspect;
mod joints;
mod options;
mod prediction;
mod sentences;
mod simulation;
mod space;
mod space_json;
mod space_picture;
mod space_request;
mod space_tiles;
mod words;

pub use comparison::{compared_predictions, compared_runs};
pub use contact_model::{ContactChoice, ContactModel};
pub use drawing::drawing_json;
pub use inspect::{inspect_json, parameters_json};
pub use mainspring_behavior::{MatchOptions, Outcome, PredictOptions};
pub use mainspring_cspace::{End, Gap, Interval, Progress, Stage, Transmission};
pub use mainspring_dynamics::Status;
pub use mainspring_mechanism::{CompileOptions, ContactLaw, Mechanism};
pub use mainspring_model::{Error, Machine};
pub use prediction::{PredictionOptions, PredictionResult, predict};
pub use simulation::{ContactSearch, SimulationOptions, SimulationResult, simulate};
pub use space::{Space, SpaceAxis, SpaceMark, SpaceWay, configuration_space, watched_space};
pub use space_request::SpaceRequest;
