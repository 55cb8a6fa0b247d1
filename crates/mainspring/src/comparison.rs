//! Both models of contact on one machine: where and by how much they differ (docs/guide/json.md).

use crate::contact_model::constants;
use crate::contacts::bodies;
use crate::prediction::PredictionResult;
use crate::sentences::travel;
use crate::simulation::SimulationResult;
use crate::words::{clean, list, number};
use mainspring_behavior::{Outcome, Pattern};
use mainspring_dynamics::{Closed, Status};
use serde_json::{Map, Value, json};

/// Motions apart by more than this fraction of a part's range are told as different.
const APART: f64 = 0.01;
/// Durations that differ by more than this fraction are told as different: twice the paper's P_t_match, to which either
/// is known.
const LASTING: f64 = 0.02;
/// Places of rest further apart than this, in radians or sizes of the machine, are told as different.
const RESTING: f64 = 2e-3;
/// The last part of a run in which a machine is looked at for whether it still moves.
const LAST: f64 = 0.25;
/// Most instants at which motions are compared.
const MOST_INSTANTS: usize = 20_000;

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

/// The distance of one part, compliant less rigid.
#[derive(Clone, Debug, Default)]
struct Distance {
    name: String,
    slides: bool,
    /// Of greatest size, with its time.
    greatest: f64,
    at: f64,
    /// When the compared stretch ends.
    end: f64,
    /// Range over the whole stretch with both models, and over its last part with each.
    range: f64,
    last: [f64; 2],
    /// Times `APART` of the range: since when it is further apart than that for the first time.
    since: Option<f64>,
}

impl Distance {
    fn told(&self, x: f64) -> String {
        if self.slides { number(x, 3) } else { format!("{}°", number(x.to_degrees(), 3)) }
    }

    /// The model (0 rigid, 1 compliant) with which this part hardly moves at the end while it does with the other.
    fn stalls(&self) -> Option<usize> {
        let [rigid, compliant] = self.last;
        let (least, most) = (rigid.min(compliant), rigid.max(compliant));
        let real = most > APART * self.range && least < APART * most;
        real.then_some(usize::from(compliant < rigid))
    }
}

struct Runs<'r> {
    runs: [&'r SimulationResult; 2],
    until: f64,
    distances: Vec<Distance>,
}

const NAMES: [&str; 2] = ["rigid", "compliant"];

impl<'r> Runs<'r> {
    fn new(rigid: &'r SimulationResult, compliant: &'r SimulationResult) -> Self {
        let runs = [rigid, compliant];
        let until = until(runs);
        let instants = instants(runs, until);
        let samples: Vec<[Vec<f64>; 2]> = instants.iter().map(|&t| runs.map(|r| r.at(t).0)).collect();
        let distance = |k: usize, name: String| distance(&instants, &samples, k, name, rigid.slides(k));
        let distances = rigid.parts().into_iter().enumerate().map(|(k, n)| distance(k, n)).collect();
        Self { runs, until, distances }
    }

    fn ended(&self, k: usize) -> Status {
        self.runs[k].status()
    }

    fn stalls(&self) -> Vec<(&Distance, usize)> {
        self.distances.iter().filter_map(|d| Some((d, d.stalls()?))).collect()
    }

    fn same_outcome(&self) -> bool {
        self.ended(0) == self.ended(1) && self.stalls().is_empty()
    }

    /// Kinetic-energy minima told by both, in order: how many, and the greatest distance of their times.
    fn minima(&self) -> (usize, Option<f64>) {
        let [a, b] = self.runs.map(SimulationResult::low_minima);
        let apart = a.iter().zip(&b).map(|(a, b)| b - a);
        (a.len().min(b.len()), apart.max_by(|x, y| x.abs().total_cmp(&y.abs())))
    }

    fn json(&self) -> Value {
        let (compared, greatest) = self.minima();
        let part = |d: &Distance| {
            let value = json!({"greatest": clean(d.greatest), "at": d.at, "end": clean(d.end)});
            (d.name.clone(), value)
        };
        let stall = |(d, k): &(&Distance, usize)| json!({"part": d.name, "contact": NAMES[*k]});
        json!({
            "same_outcome": self.same_outcome(),
            "statuses": {"rigid": self.runs[0].status_word(), "compliant": self.runs[1].status_word()},
            "until": self.until,
            "positions": self.distances.iter().map(part).collect::<Map<_, _>>(),
            "apart_from": self.apart_from().map(|(_, t)| t),
            "minima": {"compared": compared, "greatest": greatest},
            "stalls": self.stalls().iter().map(stall).collect::<Vec<_>>(),
            "constants": constants(&self.runs[1].run().contact),
        })
    }

    /// The part that is the first to be apart, and since when.
    fn apart_from(&self) -> Option<(&Distance, f64)> {
        let found = self.distances.iter().filter_map(|d| Some((d, d.since?)));
        found.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn sentences(&self) -> Vec<String> {
        let mut out = vec![self.ends()];
        let stalls = self.stalls();
        for (k, name) in NAMES.iter().enumerate() {
            let parts: Vec<String> = stalls.iter().filter(|s| s.1 == k).map(|s| s.0.name.clone()).collect();
            if !parts.is_empty() {
                let from = number((1.0 - LAST) * self.until, 4);
                let (verb, other) = (if parts.len() == 1 { "stands" } else { "stand" }, NAMES[1 - k]);
                out.push(format!(
                    "After {from} s {} {verb} still with {name} contact and still moves with {other}: here the answer \
                     depends on how contact is modelled.",
                    list(&parts)
                ));
            }
        }
        if let (n @ 1.., Some(apart)) = self.minima() {
            let word = if n == 1 { "minimum" } else { "minima" };
            out.push(format!(
                "Of {n} common {word} of kinetic energy none is further apart than {} s.",
                number(apart.abs(), 3)
            ));
        }
        out.push(self.where_apart());
        out
    }

    fn ends(&self) -> String {
        let told = |k: usize| {
            let (t, name) = (number(self.runs[k].end(), 5), NAMES[k]);
            match self.ended(k) {
                Status::AtRest => format!("with {name} contact it comes to rest after {t} s"),
                Status::Complete => format!("with {name} contact it still runs at {t} s"),
                Status::Jammed => format!("with {name} contact it is jammed at {t} s"),
                _ => format!("with {name} contact the run ended early at {t} s"),
            }
        };
        let same = self.ended(0) == self.ended(1);
        if same && self.ended(0) == Status::Complete {
            return format!("With either model of contact it still runs at {} s.", number(self.until, 5));
        }
        let (a, b) = (told(0), told(1));
        let join = if same { ", and" } else { ", but" };
        format!("W{}{join} {b}.", &a[1..])
    }

    fn where_apart(&self) -> String {
        let worst = self.distances.iter().max_by(|a, b| {
            let share = |d: &Distance| if d.range > 0.0 { d.greatest.abs() / d.range } else { 0.0 };
            share(a).total_cmp(&share(b))
        });
        let (Some(worst), Some((first, t))) = (worst, self.apart_from()) else {
            return format!(
                "Up to {} s no part is apart by a hundredth of its range.",
                number(self.until, 5)
            );
        };
        format!(
            "They first part by a hundredth of a part's range at {} s ({}), and furthest at {} s, where {} differs by {}.",
            number(t, 4),
            first.name,
            number(worst.at, 4),
            worst.name,
            worst.told(worst.greatest)
        )
    }
}

/// The time up to which both motions are known; where one has come to rest it stays there.
fn until(runs: [&SimulationResult; 2]) -> f64 {
    let [a, b] = runs.map(SimulationResult::end);
    let rests = runs.map(|r| r.status() == Status::AtRest);
    match rests {
        [true, true] => a.max(b),
        [true, false] => b,
        [false, true] => a,
        [false, false] => a.min(b),
    }
}

/// Steps of both runs up to a time, thinned out where they are many.
fn instants(runs: [&SimulationResult; 2], until: f64) -> Vec<f64> {
    let steps = runs.iter().flat_map(|r| r.times().iter().copied()).filter(|t| *t <= until);
    let even = (0..=400).map(|k| until * f64::from(k) / 400.0);
    let mut all: Vec<f64> = steps.chain(even).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    let stride = all.len().div_ceil(MOST_INSTANTS).max(1);
    let last = all.last().copied();
    let mut kept: Vec<f64> = all.into_iter().step_by(stride).collect();
    if kept.last().copied() != last {
        kept.extend(last);
    }
    kept
}

fn distance(t: &[f64], samples: &[[Vec<f64>; 2]], k: usize, name: String, slides: bool) -> Distance {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        (high - low).max(0.0)
    };
    let end = t.last().copied().unwrap_or(0.0);
    let late = t.partition_point(|t| *t < (1.0 - LAST) * end);
    let mut d = Distance { name, slides, ..Distance::default() };
    d.range = range(&mut samples.iter().flat_map(|s| [s[0][k], s[1][k]]));
    d.last = [0, 1].map(|m| range(&mut samples[late..].iter().map(|s| s[m][k])));
    for (&t, s) in t.iter().zip(samples) {
        let apart = s[1][k] - s[0][k];
        d.end = apart;
        if apart.abs() > d.greatest.abs() {
            (d.greatest, d.at) = (apart, t);
        }
        if d.since.is_none() && apart.abs() > APART * d.range {
            d.since = Some(t);
        }
    }
    d
}

struct Predictions<'p> {
    rigid: &'p PredictionResult,
    compliant: &'p PredictionResult,
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

    fn same_outcome(&self) -> bool {
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

    fn json(&self) -> Value {
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

    fn sentences(&self) -> Vec<String> {
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
