//! Both models of contact on one machine: where and by how much they differ (docs/guide/json.md).

mod distance;
mod predictions;
mod runs;

use crate::prediction::PredictionResult;
use crate::simulation::SimulationResult;
use predictions::Predictions;
use runs::Runs;
use serde_json::{Value, json};

/// The models, in the order in which they are compared.
const NAMES: [&str; 2] = ["rigid", "compliant"];

/// Two runs of one machine from the same state, as `simulate --contact both --json` prints them.
pub fn compared_runs(rigid: &SimulationResult, compliant: &SimulationResult, timing: bool) -> Value {
    let differences = Runs::new(rigid, compliant);
    let same = differences.same_outcome();
    json!({
        "status": verdict(same),
        "rigid": rigid.json(timing),
        "compliant": compliant.json(timing),
        "differences": differences.json(),
        "sentences": differences.sentences(),
    })
}

/// Two predictions of one machine from the same state, as `predict --contact both --json` prints them.
pub fn compared_predictions(rigid: &PredictionResult, compliant: &PredictionResult) -> Value {
    let differences = Predictions { rigid, compliant };
    json!({
        "status": verdict(differences.same_outcome()),
        "rigid": rigid.json(),
        "compliant": compliant.json(),
        "differences": differences.json(),
        "sentences": differences.sentences(),
    })
}

fn verdict(same: bool) -> &'static str {
    if same { "agree" } else { "differ" }
}
