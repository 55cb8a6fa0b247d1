//! Behavioural hypotheses: "every M points the state changes by Δ in a time D" (Gelsey 1995, Algorithm 12).
//!
//! Corrected: changes match to within P_s_v_match of each variable's peak-to-peak over one instance of the candidate
//! pattern, with a floor of ten integration tolerances; times to within P_t_match of D. A hypothesis formed late is
//! credited with the instances already seen, so that no more than P_ignore + M (P_confirm + 1) points are needed.

use mainspring_dynamics::Ranges;

/// Parameters of Algorithm 12, with the paper's names and defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchOptions {
    /// P_confirm = 2: instances that must match beyond the first.
    pub confirm: u32,
    /// P_range_fraction = 1e-5: minima count below this fraction of the greatest kinetic energy so far.
    pub range_fraction: f64,
    /// P_ignore = 4: minima passed over at the start.
    pub ignore: u32,
    /// P_t_match = 0.01, relative to D.
    pub time_match: f64,
    /// P_s_v_match = 0.02, relative to each variable's peak-to-peak.
    pub state_match: f64,
}

impl Default for MatchOptions {
    fn default() -> Self {
        Self { confirm: 2, range_fraction: 1e-5, ignore: 4, time_match: 0.01, state_match: 0.02 }
    }
}

/// How a coordinate is called in reasons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    pub name: String,
    /// Told in degrees if it turns.
    pub turns: bool,
}

impl Label {
    fn says(&self, what: &str, found: f64, expected: f64) -> String {
        let name = &self.name;
        if self.turns {
            let (found, expected) = (found.to_degrees(), expected.to_degrees());
            return format!("{name} {what} {found:.4}°, expected {expected:.4}°");
        }
        format!("{name} {what} {found:.6}, expected {expected:.6}")
    }
}

/// A point of comparison: a state, and how far the state ranged since the point before.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub ranges: Ranges,
}

/// A hypothesis that was formed, for the record.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// M.
    pub minima: usize,
    /// When it was formed, and when it fell; None for one that stands.
    pub formed: f64,
    pub fell: Option<f64>,
    /// Why it fell, in words.
    pub why: Option<String>,
}

/// A confirmed pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// M: points in an instance.
    pub minima: usize,
    /// D.
    pub duration: f64,
    /// Δ of each coordinate's position and velocity.
    pub change: Vec<(f64, f64)>,
    /// Index of the point at which its last instance starts.
    pub start: usize,
    /// Time at which its first supporting instance starts.
    pub since: f64,
}

/// Changes smaller than these count as equal whatever the range: ten integration tolerances.
#[derive(Clone, Debug, PartialEq)]
pub struct Floors {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
}

impl Candidate {
    /// Matched by M · P_confirm instances beyond the first.
    fn is_confirmed(&self, options: &MatchOptions) -> bool {
        u64::from(self.belief) >= self.minima as u64 * u64::from(options.confirm)
    }
}

/// Searches one series of points.
#[derive(Clone, Debug, Default)]
pub struct Series {
    pub points: Vec<Point>,
    pub hypotheses: Vec<Hypothesis>,
    /// M of the present hypothesis, its D and Δ, and how many instances have matched.
    present: Option<Candidate>,
}

#[derive(Clone, Debug)]
struct Candidate {
    minima: usize,
    duration: f64,
    change: Vec<(f64, f64)>,
    belief: u32,
    matched_from: usize,
}

impl Series {
    /// Takes in the next point; the pattern once it is confirmed.
    pub fn add(
        &mut self,
        point: Point,
        names: &[Label],
        floors: &Floors,
        options: &MatchOptions,
    ) -> Option<Pattern> {
        self.points.push(point);
        let last = self.points.len() - 1;
        if last < options.ignore as usize || last == 0 {
            return None;
        }
        let ignore = (options.ignore as usize).saturating_sub(1);
        match self.present.take() {
            None => self.form(1, last, ignore, floors, options),
            Some(mut candidate) => match self.mismatch(&candidate, last, names, floors, options) {
                None => {
                    candidate.belief += 1;
                    self.present = Some(candidate);
                }
                Some(why) => {
                    let now = self.points[last].t;
                    if let Some(h) = self.hypotheses.last_mut() {
                        (h.fell, h.why) = (Some(now), Some(why));
                    }
                    self.form(candidate.minima + 1, last, ignore, floors, options);
                }
            },
        }
        self.confirmed(last, options).or_else(|| self.reconsidered(last, ignore, floors, options))
    }

    /// A shorter pattern that fell during a transient and has held since: formed again only when all the instances
    /// it needs are there already.
    fn reconsidered(
        &mut self,
        last: usize,
        ignore: usize,
        floors: &Floors,
        options: &MatchOptions,
    ) -> Option<Pattern> {
        let tried = self.present.as_ref().map_or(0, |c| c.minima);
        let candidate = (1..tried)
            .map(|minima| self.candidate(minima, last, ignore, floors, options))
            .find(|c| c.is_confirmed(options))?;
        let now = self.points[last].t;
        if let Some(h) = self.hypotheses.last_mut() {
            (h.fell, h.why) = (Some(now), Some("a shorter pattern holds".into()));
        }
        self.hypotheses.push(Hypothesis { minima: candidate.minima, formed: now, fell: None, why: None });
        self.present = Some(candidate);
        self.confirmed(last, options)
    }

    /// Forms the hypothesis of M points from the last instance.
    fn form(&mut self, minima: usize, last: usize, ignore: usize, floors: &Floors, options: &MatchOptions) {
        if last < minima {
            return;
        }
        let formed = self.points[last].t;
        self.hypotheses.push(Hypothesis { minima, formed, fell: None, why: None });
        self.present = Some(self.candidate(minima, last, ignore, floors, options));
    }

    /// The candidate of M points by the last instance, credited with the instances before that match it, as far as
    /// its confirmation needs.
    fn candidate(
        &self,
        minima: usize,
        last: usize,
        ignore: usize,
        floors: &Floors,
        options: &MatchOptions,
    ) -> Candidate {
        let (a, b) = (&self.points[last - minima], &self.points[last]);
        let (duration, change) = (b.t - a.t, change(a, b));
        let mut candidate = Candidate { minima, duration, change, belief: 0, matched_from: last - minima };
        for end in (ignore + minima..last).rev() {
            if candidate.is_confirmed(options)
                || self.mismatch(&candidate, end, &[], floors, options).is_some()
            {
                break;
            }
            candidate.belief += 1;
            candidate.matched_from = end - minima;
        }
        candidate
    }

    fn confirmed(&self, last: usize, options: &MatchOptions) -> Option<Pattern> {
        let c = self.present.as_ref()?;
        if !c.is_confirmed(options) {
            return None;
        }
        let start = last - c.minima;
        let (a, b) = (&self.points[start], &self.points[last]);
        Some(Pattern {
            minima: c.minima,
            duration: b.t - a.t,
            change: change(a, b),
            start,
            since: self.points[c.matched_from].t,
        })
    }

    /// Why the instance that ends at a point contradicts the candidate; None if it matches.
    fn mismatch(
        &self,
        c: &Candidate,
        end: usize,
        names: &[Label],
        floors: &Floors,
        options: &MatchOptions,
    ) -> Option<String> {
        let (a, b) = (&self.points[end - c.minima], &self.points[end]);
        let duration = b.t - a.t;
        if (duration - c.duration).abs() > options.time_match * c.duration {
            return Some(format!("took {duration:.6}, expected {:.6}", c.duration));
        }
        let mut ranges = self.points[end].ranges.clone();
        (end + 1 - c.minima..end).for_each(|k| ranges.merge(&self.points[k].ranges));
        let text = |i: usize, what: &str, found: f64, expected: f64| match names.get(i) {
            Some(label) => label.says(what, found, expected),
            None => String::new(),
        };
        for (i, (found, expected)) in change(a, b).into_iter().zip(&c.change).enumerate() {
            let spans = (ranges.q[i].1 - ranges.q[i].0, ranges.v[i].1 - ranges.v[i].0);
            if (found.0 - expected.0).abs() > (options.state_match * spans.0).max(floors.q[i]) {
                return Some(text(i, "moved by", found.0, expected.0));
            }
            if (found.1 - expected.1).abs() > (options.state_match * spans.1).max(floors.v[i]) {
                return Some(text(i, "changed its velocity by", found.1, expected.1));
            }
        }
        None
    }
}

fn change(a: &Point, b: &Point) -> Vec<(f64, f64)> {
    let q = a.q.iter().zip(&b.q).map(|(x, y)| y - x);
    let v = a.v.iter().zip(&b.v).map(|(x, y)| y - x);
    q.zip(v).collect()
}

#[cfg(test)]
mod tests {
    use super::{Floors, Label, MatchOptions, Point, Series};
    use mainspring_dynamics::Ranges;

    /// A pattern of M points: gaps between points repeat with period M, the position climbs by 1 each pattern.
    fn point(k: usize, m: usize) -> Point {
        let gaps: Vec<f64> = (0..m).map(|i| 1.0 + 0.1 * i as f64).collect();
        let whole: f64 = gaps.iter().sum();
        let t = (k / m) as f64 * whole + gaps[..k % m].iter().sum::<f64>();
        let ranges = Ranges { q: vec![(0.0, 1.0)], v: vec![(-1.0, 1.0)] };
        Point { t, q: vec![(k / m) as f64 + 0.3 * (k % m) as f64], v: vec![0.0], ranges }
    }

    #[test]
    fn work_is_bounded_as_the_paper_says() {
        let floors = Floors { q: vec![0.0], v: vec![0.0] };
        for m in 1..12 {
            for ignore in 0..6 {
                let options = MatchOptions { ignore, ..MatchOptions::default() };
                let mut series = Series::default();
                let bound = ignore as usize + m * 3 + usize::from(ignore == 0);
                let found = (0..bound).find_map(|k| series.add(point(k, m), &[], &floors, &options));
                let pattern = found.unwrap_or_else(|| panic!("not found for M = {m}, ignoring {ignore}"));
                assert_eq!(pattern.minima, m);
                assert!((pattern.change[0].0 - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn hypotheses_are_formed_once_each_in_order() {
        let floors = Floors { q: vec![0.0], v: vec![0.0] };
        let mut series = Series::default();
        for k in 0..40 {
            series.add(
                point(k, 5),
                &[Label { name: "wheel".into(), turns: true }],
                &floors,
                &MatchOptions::default(),
            );
        }
        let formed: Vec<usize> = series.hypotheses.iter().map(|h| h.minima).collect();
        assert_eq!(formed, vec![1, 2, 3, 4, 5]);
        assert!(series.hypotheses[..4].iter().all(|h| h.fell.is_some() && h.why.is_some()));
        assert!(series.hypotheses[4].fell.is_none());
    }
}
