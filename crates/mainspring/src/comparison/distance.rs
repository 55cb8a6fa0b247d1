//! How far apart one part is with either model.

use crate::words::number;

/// Motions apart by more than this fraction of a part's range are told as different.
const APART: f64 = 0.01;
/// The last part of a run in which a machine is looked at for whether it still moves.
pub(super) const LAST: f64 = 0.25;

/// The distance of one part, compliant less rigid.
#[derive(Clone, Debug, Default)]
pub(super) struct Distance {
    pub name: String,
    pub slides: bool,
    /// Of greatest size, with its time.
    pub greatest: f64,
    pub at: f64,
    /// When the compared stretch ends.
    pub end: f64,
    /// Range over the whole stretch with both models, and over its last part with each.
    pub range: f64,
    pub last: [f64; 2],
    /// Times `APART` of the range: since when it is further apart than that for the first time.
    pub since: Option<f64>,
}

impl Distance {
    pub fn told(&self, x: f64) -> String {
        if self.slides { number(x, 3) } else { format!("{}°", number(x.to_degrees(), 3)) }
    }

    /// The model (0 rigid, 1 compliant) with which this part hardly moves at the end while it does with the other.
    pub fn stalls(&self) -> Option<usize> {
        let [rigid, compliant] = self.last;
        let (least, most) = (rigid.min(compliant), rigid.max(compliant));
        let real = most > APART * self.range && least < APART * most;
        real.then_some(usize::from(compliant < rigid))
    }
}

/// The distance of part `k` over samples of both motions at times `t`.
pub(super) fn distance(
    t: &[f64],
    samples: &[[Vec<f64>; 2]],
    k: usize,
    name: String,
    slides: bool,
) -> Distance {
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
