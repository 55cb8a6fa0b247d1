//! `predict`: what the machine will do, and the stretch of motion it was read from.

use crate::contact_model::{ContactChoice, constants};
use crate::options::check_prediction;
use crate::sentences::sentences;
use crate::simulation::{ContactSearch, SimulationOptions, SimulationResult};
use crate::words::clean;
use mainspring_behavior::{Basis, Hypothesis, NoPattern, Outcome, Pattern, PredictOptions};
use mainspring_mechanism::Mechanism;
use mainspring_model::Error;
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// What `predict` is asked to do.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PredictionOptions {
    pub contact: ContactChoice,
    /// The search; its model of contact and its tolerance are taken from `contact`.
    pub search: PredictOptions,
    /// Where contacts come from.
    pub source: ContactSearch,
}

/// A prediction with the run it is based on.
#[derive(Clone, Debug)]
pub struct PredictionResult {
    pub outcome: Outcome,
    hypotheses: Vec<Hypothesis>,
    run: Arc<SimulationResult>,
    slides: Vec<bool>,
    state_match: f64,
}

/// Runs a mechanism from its initial state until it is known what it will do.
///
/// # Errors
/// As `simulate`.
pub fn predict(
    mechanism: &Mechanism,
    options: &PredictionOptions,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<PredictionResult, Error> {
    check_prediction(&options.search)?;
    let system = mechanism.kept_system()?;
    let source = options.source.source(&system);
    let (contact, rtol) = options.contact.resolve(&system)?;
    let options = PredictOptions { contact, rtol, ..options.search.clone() };
    let found = mainspring_behavior::predict(&system, &*source, &options, progress);
    let simulation = SimulationOptions {
        until: found.run.t,
        range_fraction: options.matching.range_fraction,
        ..SimulationOptions::default()
    };
    let run = Arc::new(SimulationResult::new(mechanism, system.clone(), found.run, simulation, 0.0));
    let moves = |i: &usize| mechanism.subsystem_of(*i).is_some();
    let slides = (0..mechanism.parts.len()).filter(moves).map(|i| mechanism.slides(i)).collect();
    let state_match = options.matching.state_match;
    Ok(PredictionResult { outcome: found.outcome, hypotheses: found.hypotheses, run, slides, state_match })
}

impl PredictionResult {
    /// The simulated stretch.
    pub fn run(&self) -> Arc<SimulationResult> {
        self.run.clone()
    }

    /// Whether each moving part slides (and does not turn), in the order of the run's parts.
    pub(crate) fn slides(&self) -> &[bool] {
        &self.slides
    }

    /// P_s_v_match: changes are told apart to this fraction of a part's range within one pattern.
    pub(crate) fn state_match(&self) -> f64 {
        self.state_match
    }

    /// The object that `predict --json` prints.
    pub fn json(&self) -> Value {
        let (status, reason) = self.status();
        let mut object = json!({
            "status": status,
            "reason": reason,
            "pattern": self.pattern(),
            "starts": self.starts(),
            "rest": self.rest(),
            "simulated_seconds": self.known_at(),
            "hypotheses": self.hypotheses.iter().map(hypothesis).collect::<Vec<_>>(),
            "sentences": sentences(self),
        });
        if let Some(constants) = constants(&self.run.run().contact) {
            object["contact"] = constants;
        }
        object["stats"] = self.run.stats(false);
        object
    }

    /// The word for the outcome, and the reason where there is no pattern.
    pub fn status(&self) -> (&'static str, Option<&'static str>) {
        match &self.outcome {
            Outcome::Repeats { .. } => ("repeats", None),
            Outcome::ComesToRest { .. } => ("comes_to_rest", None),
            Outcome::Stopped => ("stopped", None),
            Outcome::NoPattern(reason) => ("no_pattern", Some(reason_word(*reason))),
        }
    }

    /// Change of each moving part over one pattern: position and velocity.
    pub(crate) fn changes(&self, pattern: &Pattern) -> Vec<(String, f64, f64)> {
        let part = |k: usize| {
            let pick: Vec<f64> = pattern.change.iter().map(|c| if k == 0 { c.0 } else { c.1 }).collect();
            self.run.of_parts(&pick)
        };
        let (q, v) = (part(0), part(1));
        let value = |map: &Value, name: &str| map[name].as_f64().unwrap_or(0.0);
        self.run.parts().into_iter().map(|n| (n.clone(), value(&q, &n), value(&v, &n))).collect()
    }

    /// When it was known: the confirming point, or the end of the run.
    fn known_at(&self) -> f64 {
        match &self.outcome {
            Outcome::Repeats { pattern, start, .. } => start.t + pattern.duration,
            _ => self.run.run().t,
        }
    }

    fn pattern(&self) -> Value {
        let Outcome::Repeats { pattern, basis, .. } = &self.outcome else { return Value::Null };
        let change: Map<String, Value> = self
            .changes(pattern)
            .into_iter()
            .map(|(name, q, v)| (name, json!({"position": clean(q), "velocity": clean(v)})))
            .collect();
        json!({
            "minima": pattern.minima,
            "duration": pattern.duration,
            "change": change,
            "basis": basis_word(*basis),
        })
    }

    /// State at the start of the pattern's last instance, or at rest.
    fn starts(&self) -> Value {
        match &self.outcome {
            Outcome::Repeats { start, .. } => json!({
                "t": start.t,
                "positions": self.run.of_parts(&start.q),
                "velocities": self.run.of_parts(&start.v),
            }),
            Outcome::ComesToRest { t, .. } => json!({
                "t": t,
                "positions": self.run.of_parts(&self.run.run().q),
                "velocities": self.run.of_parts(&self.run.run().v),
            }),
            _ => Value::Null,
        }
    }

    /// Where and when it rests, and what holds it.
    fn rest(&self) -> Value {
        let Outcome::ComesToRest { t, held, jammed } = &self.outcome else { return Value::Null };
        let contacts = crate::contacts::contacts_json(self.run.system(), held, &self.run.run().q);
        json!({"t": t, "jammed": jammed, "held_by": contacts})
    }
}

fn hypothesis(h: &Hypothesis) -> Value {
    json!({"minima": h.minima, "formed": h.formed, "fell": h.fell, "why": h.why})
}

fn basis_word(basis: Basis) -> &'static str {
    match basis {
        Basis::LowMinima => "kinetic_energy_minima",
        Basis::ProminentMinima => "prominent_minima",
        Basis::Passages => "whole_turns",
    }
}

fn reason_word(reason: NoPattern) -> &'static str {
    match reason {
        NoPattern::ConstantKineticEnergy => "constant_kinetic_energy",
        NoPattern::TooManyMinima => "max_minima",
        NoPattern::TooLong => "max_time",
        NoPattern::StepLimit => "step_limit",
        NoPattern::Jammed => "jammed",
        NoPattern::TooDeep => "too_deep",
    }
}
