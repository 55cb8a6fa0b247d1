//! Two runs of one machine from the same state.

use super::NAMES;
use super::distance::{Distance, LAST, distance};
use crate::contact_model::constants;
use crate::simulation::SimulationResult;
use crate::words::{clean, list, number};
use mainspring_dynamics::Status;
use serde_json::{Map, Value, json};

/// Most instants at which motions are compared.
const MOST_INSTANTS: usize = 20_000;

pub(super) struct Runs<'r> {
    runs: [&'r SimulationResult; 2],
    until: f64,
    pub distances: Vec<Distance>,
}

impl<'r> Runs<'r> {
    pub fn new(rigid: &'r SimulationResult, compliant: &'r SimulationResult) -> Self {
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

    pub fn same_outcome(&self) -> bool {
        self.ended(0) == self.ended(1) && self.stalls().is_empty()
    }

    /// Kinetic-energy minima told by both, in order: how many, and the greatest distance of their times.
    fn minima(&self) -> (usize, Option<f64>) {
        let [a, b] = self.runs.map(SimulationResult::low_minima);
        let apart = a.iter().zip(&b).map(|(a, b)| b - a);
        (a.len().min(b.len()), apart.max_by(|x, y| x.abs().total_cmp(&y.abs())))
    }

    pub fn json(&self) -> Value {
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

    pub fn sentences(&self) -> Vec<String> {
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
