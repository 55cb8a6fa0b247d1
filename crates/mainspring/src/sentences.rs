//! The answer in plain words, angles in degrees.

use crate::contacts::bodies;
use crate::prediction::PredictionResult;
use crate::words::{list, number};
use mainspring_behavior::{NoPattern, Outcome, Pattern};
use mainspring_dynamics::Closed;

/// One to three sentences.
pub fn sentences(p: &PredictionResult) -> Vec<String> {
    match &p.outcome {
        Outcome::Repeats { pattern, start, .. } => repeats(p, pattern, start.t),
        Outcome::ComesToRest { t, held, jammed } => rests(p, *t, held, *jammed),
        Outcome::NoPattern(reason) => vec![no_pattern(p, *reason)],
        Outcome::Stopped => vec!["Stopped before it was known what the machine does.".into()],
    }
}

/// A change that the matching itself could not tell from none counts as a return.
fn repeats(p: &PredictionResult, pattern: &Pattern, from: f64) -> Vec<String> {
    let mut advancing = Vec::new();
    let mut returning = Vec::new();
    let slides = p.slides();
    for (i, (name, q, _)) in p.changes(pattern).into_iter().enumerate() {
        let tiny = 1e-6 * if slides[i] { p.run().system().size } else { 1.0 };
        let blur = p.state_match() * travel(p, i, from, pattern.duration);
        if q.abs() <= tiny.max(blur) {
            returning.push(name);
        } else if slides[i] {
            advancing.push(format!("{name} moves by {}", signed(q, 4)));
        } else {
            advancing.push(format!("{name} turns by {}°", signed(q.to_degrees(), 4)));
        }
    }
    let duration = number(pattern.duration, 5);
    let mut first = format!("Repeats every {duration} s");
    if !advancing.is_empty() {
        first += &format!("; each time {}", list(&advancing));
    }
    let mut out = vec![first + "."];
    if !returning.is_empty() {
        let words =
            if returning.len() == 1 { "returns to where it began" } else { "return to where they began" };
        out.push(format!("{} {words}.", list(&returning)));
    }
    out
}

/// How far part `i` ranges within one instance of the pattern.
pub(crate) fn travel(p: &PredictionResult, i: usize, from: f64, duration: f64) -> f64 {
    let run = p.run();
    let samples = run.times().iter().filter(|t| (from..=from + duration).contains(*t)).copied();
    let ends = [from, from + 0.25 * duration, from + 0.5 * duration, from + 0.75 * duration, from + duration];
    let positions = samples.chain(ends).map(|t| run.at(t).0[i]);
    let (low, high) = positions.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
    high - low
}

fn signed(x: f64, digits: usize) -> String {
    let text = number(x, digits);
    if x > 0.0 { format!("+{text}") } else { text }
}

fn rests(p: &PredictionResult, t: f64, held: &[Closed], jammed: bool) -> Vec<String> {
    let mut out = vec![format!("Comes to rest after {} s.", number(t, 4))];
    let run = p.run();
    let system = run.system();
    let mut pairs: Vec<String> = held
        .iter()
        .map(|c| {
            let (a, b) = bodies(system, c.candidate.id);
            let (a, b) = (&system.bodies[a].name, &system.bodies[b].name);
            if c.candidate.id.stop().is_some() {
                format!("{a} on its stop against {b}")
            } else {
                format!("{a} against {b}")
            }
        })
        .collect();
    pairs.dedup();
    if !pairs.is_empty() {
        let why = if jammed { "Jammed: a spring still drives it, held by " } else { "Held by " };
        out.push(format!("{why}{}.", list(&pairs)));
    }
    out
}

fn no_pattern(p: &PredictionResult, reason: NoPattern) -> String {
    let t = number(p.run().run().t, 4);
    match reason {
        NoPattern::ConstantKineticEnergy => {
            "No pattern to find: the kinetic energy never changes, so the machine runs on as it is.".into()
        }
        NoPattern::TooManyMinima => {
            format!("No pattern found within the bound on kinetic-energy minima ({t} s): raise --max-minima.")
        }
        NoPattern::TooLong => format!("No pattern found within {t} s: raise --max-time."),
        NoPattern::Jammed => {
            format!("No pattern: after {t} s a drive runs against parts that cannot give way.")
        }
        NoPattern::TooDeep => format!(
            "No pattern: at {t} s parts overlap by more than compliant contact can stand for: raise its E."
        ),
        NoPattern::StepLimit => format!("No pattern found: the bound on steps was met at {t} s."),
    }
}
