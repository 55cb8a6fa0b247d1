//! Two predictions of one machine from the same state.

use super::NAMES;
use super::distance::Distance;
use super::runs::Runs;
use crate::contact_model::constants;
use crate::contacts::bodies;
use crate::prediction::PredictionResult;
use crate::sentences::travel;
use crate::simulation::SimulationResult;
use crate::words::{clean, number};
use mainspring_behavior::{Outcome, Pattern};
use mainspring_dynamics::Closed;
use serde_json::{Map, Value, json};

/// Durations that differ by more than this fraction are told as different: twice the paper's P_t_match, to which either
/// is known.
const LASTING: f64 = 0.02;
/// Places of rest further apart than this, in radians or sizes of the machine, are told as different.
const RESTING: f64 = 2e-3;

pub(super) struct Predictions<'p> {
    pub rigid: &'p PredictionResult,
    pub compliant: &'p PredictionResult,
}

impl Predictions<'_> {
    fn patterns(&self) -> Option<[&Pattern; 2]> {
        match (&self.rigid.outcome, &self.compliant.outcome) {
            (Outcome::Repeats { pattern: a, .. }, Outcome::Repeats { pattern: b, .. }) => Some([a, b]),
            _ => None,
        }
    }

    /// Part, change with either model, and the range of the part within the pattern.
    fn changes(&self, [a, b]: [&Pattern; 2]) -> Vec<(String, [f64; 2], f64)> {
        let start = match &self.rigid.outcome {
            Outcome::Repeats { start, .. } => start.t,
            _ => 0.0,
        };
        let range = |k: usize| travel(self.rigid, k, start, a.duration);
        let both = self.rigid.changes(a).into_iter().zip(self.compliant.changes(b)).enumerate();
        both.map(|(k, (a, b))| (a.0, [a.1, b.1], range(k))).collect()
    }

    pub fn same_outcome(&self) -> bool {
        let (a, b) = (self.rigid.status(), self.compliant.status());
        let Some(patterns) = self.patterns() else { return a == b && self.same_rest() };
        let ([m, n], relative) = in_common(patterns);
        let blur = 2.0 * self.rigid.state_match();
        let alike = |c: &(String, [f64; 2], f64)| (n * c.1[1] - m * c.1[0]).abs() <= blur * m * c.2;
        relative.abs() <= LASTING && self.changes(patterns).iter().all(alike)
    }

    /// Both at rest, held by the same parts, in the same place but for what compliant contacts give way.
    fn same_rest(&self) -> bool {
        let (
            Outcome::ComesToRest { jammed: a, held: h, .. },
            Outcome::ComesToRest { jammed: b, held: k, .. },
        ) = (&self.rigid.outcome, &self.compliant.outcome)
        else {
            return true;
        };
        let (first, second) = (self.rigid.run(), self.compliant.run());
        let runs = Runs::new(&first, &second);
        let size = first.system().size;
        let near = |d: &Distance| d.end.abs() <= RESTING * if d.slides { size } else { 1.0 };
        a == b && holders(&first, h) == holders(&second, k) && runs.distances.iter().all(near)
    }

    pub fn json(&self) -> Value {
        let word = |p: &PredictionResult| p.status().0;
        let rest = |p: &PredictionResult| match &p.outcome {
            Outcome::ComesToRest { t, .. } => Some(*t),
            _ => None,
        };
        let duration = self.patterns().map(
            |[a, b]| json!({"rigid": a.duration, "compliant": b.duration, "relative": in_common([a, b]).1}),
        );
        let change = self.patterns().map(|p| {
            let one = |(name, [a, b], _): (String, [f64; 2], f64)| (name, json!(clean(b - a)));
            self.changes(p).into_iter().map(one).collect::<Map<_, _>>()
        });
        json!({
            "same_outcome": self.same_outcome(),
            "statuses": {"rigid": word(self.rigid), "compliant": word(self.compliant)},
            "duration": duration,
            "change": change,
            "rest": {"rigid": rest(self.rigid), "compliant": rest(self.compliant)},
            "constants": constants(&self.compliant.run().run().contact),
        })
    }

    pub fn sentences(&self) -> Vec<String> {
        let Some([a, b]) = self.patterns() else { return vec![self.outcomes()] };
        let ([m, n], relative) = in_common([a, b]);
        let lasting = match (m, n) {
            (1.0, 1.0) => String::new(),
            (1.0, _) => format!("{n} of which last "),
            _ => format!("which lasts, beside {m} of the former, "),
        };
        let mut out = vec![format!(
            "Both repeat: every {} s with rigid contact, every {} s with compliant contact, {lasting}{}.",
            number(a.duration, 6),
            number(b.duration, 6),
            longer(100.0 * relative)
        )];
        if !self.same_outcome() {
            out.push(
                "The patterns are not the same: here the answer depends on how contact is modelled.".into(),
            );
        }
        out
    }

    fn outcomes(&self) -> String {
        let told = |p: &PredictionResult, name: &str| {
            let t = number(p.run().end(), 4);
            match &p.outcome {
                Outcome::Repeats { pattern, .. } => {
                    format!("with {name} contact it repeats every {} s", number(pattern.duration, 5))
                }
                Outcome::ComesToRest { .. } => format!("with {name} contact it comes to rest after {t} s"),
                Outcome::NoPattern(_) => format!("with {name} contact no pattern was found within {t} s"),
                Outcome::Stopped => format!("with {name} contact it was stopped at {t} s"),
            }
        };
        let (a, b) = (told(self.rigid, NAMES[0]), told(self.compliant, NAMES[1]));
        if self.same_outcome() {
            return format!("W{}, and {b}.", &a[1..]);
        }
        format!("W{}, but {b}: here the answer depends on how contact is modelled.", &a[1..])
    }
}

/// How many repetitions of either pattern last about as long as so many of the other, and by how much they do not:
/// one model may confirm a pattern that holds several of the other's.
fn in_common([a, b]: [&Pattern; 2]) -> ([f64; 2], f64) {
    let ratio = a.duration / b.duration;
    let times = if ratio >= 1.0 { [1.0, ratio.round()] } else { [(1.0 / ratio).round(), 1.0] };
    (times, times[1] * b.duration / (times[0] * a.duration) - 1.0)
}

/// Pairs of bodies that carry force.
fn holders(run: &SimulationResult, held: &[Closed]) -> Vec<(usize, usize)> {
    let mut pairs: Vec<_> = held.iter().map(|c| bodies(run.system(), c.candidate.id)).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// `0.05 % longer`, `2 % shorter`.
fn longer(percent: f64) -> String {
    if percent == 0.0 {
        return "the same to the last digit".into();
    }
    let word = if percent > 0.0 { "longer" } else { "shorter" };
    format!("{} % {word}", number(percent.abs(), 3))
}
