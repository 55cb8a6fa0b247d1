//! Behavioural hypotheses: "every M points the state changes by Δ in a time D" (Gelsey 1995, Algorithm 12).
//!
//! Corrected: changes match to within P_s_v_match of each variable's peak-to-peak over one instance of the candidate
//! pattern, with a floor of ten integration tolerances; times to within P_t_match of D. A hypothesis formed late is
//! credited with the instances already seen, so that no more than P_ignore + M (P_confirm + 1) points are needed.

use crate::terms::{Fall, MatchOptions, Terms};
use mainspring_dynamics::Ranges;

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

/// A coordinate moves on by at least this share of how far it ranges from point to point; less is a motion that dies out.
const GETS_ON: f64 = 0.1;

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

impl Candidate {
    /// Matched by M · P_confirm instances beyond the first.
    fn is_confirmed(&self, options: &MatchOptions) -> bool {
        u64::from(self.belief) >= self.minima as u64 * u64::from(options.confirm)
    }
}

impl Series {
    /// Takes in the next point; the pattern once it is confirmed.
    pub fn add(&mut self, point: Point, terms: &Terms) -> Option<Pattern> {
        self.points.push(point);
        let last = self.points.len() - 1;
        if last < terms.options.ignore as usize || last == 0 {
            return None;
        }
        match self.present.take() {
            None => self.form(1, last, terms),
            Some(mut candidate) => match self.mismatch(&candidate, last, terms) {
                None => {
                    candidate.belief += 1;
                    self.present = Some(candidate);
                }
                Some(fall) => self.replace(&candidate, last, &fall, terms),
            },
        }
        self.drop_unlike(last, terms);
        self.confirmed(last, terms).or_else(|| self.reconsidered(last, terms))
    }

    /// A hypothesis falls at the last point; the next longer one is formed.
    fn replace(&mut self, fallen: &Candidate, last: usize, fall: &Fall, terms: &Terms) {
        if let Some(h) = self.hypotheses.last_mut() {
            (h.fell, h.why) = (Some(self.points[last].t), Some(fall.says(terms.labels)));
        }
        self.form(fallen.minima + 1, last, terms);
    }

    /// What was seen often enough does not go on where the shapes that meet are not the same each time.
    fn drop_unlike(&mut self, last: usize, terms: &Terms) {
        while let Some(candidate) = self.present.take_if(|c| c.is_confirmed(terms.options)) {
            let Some(fall) = self.unlike(&candidate, last, terms) else {
                self.present = Some(candidate);
                return;
            };
            self.replace(&candidate, last, &fall, terms);
        }
    }

    /// A shorter pattern that fell during a transient and has held since: formed again only when all the instances
    /// it needs are there already.
    fn reconsidered(&mut self, last: usize, terms: &Terms) -> Option<Pattern> {
        let tried = self.present.as_ref().map_or(0, |c| c.minima);
        let candidate = (1..tried)
            .map(|minima| self.candidate(minima, last, terms))
            .find(|c| c.is_confirmed(terms.options) && self.unlike(c, last, terms).is_none())?;
        let now = self.points[last].t;
        if let Some(h) = self.hypotheses.last_mut() {
            (h.fell, h.why) = (Some(now), Some("a shorter pattern holds".into()));
        }
        self.hypotheses.push(Hypothesis { minima: candidate.minima, formed: now, fell: None, why: None });
        self.present = Some(candidate);
        self.confirmed(last, terms)
    }

    /// Forms the hypothesis of M points from the last instance.
    fn form(&mut self, minima: usize, last: usize, terms: &Terms) {
        if last < minima {
            return;
        }
        let formed = self.points[last].t;
        self.hypotheses.push(Hypothesis { minima, formed, fell: None, why: None });
        self.present = Some(self.candidate(minima, last, terms));
    }

    /// The candidate of M points by the last instance, credited with the instances before that match it, as far as
    /// its confirmation needs.
    fn candidate(&self, minima: usize, last: usize, terms: &Terms) -> Candidate {
        let (a, b) = (&self.points[last - minima], &self.points[last]);
        let (duration, change) = (b.t - a.t, change(a, b));
        let mut candidate = Candidate { minima, duration, change, belief: 0, matched_from: last - minima };
        let ignored = (terms.options.ignore as usize).saturating_sub(1);
        for end in (ignored + minima..last).rev() {
            if candidate.is_confirmed(terms.options) || self.mismatch(&candidate, end, terms).is_some() {
                break;
            }
            candidate.belief += 1;
            candidate.matched_from = end - minima;
        }
        candidate
    }

    fn confirmed(&self, last: usize, terms: &Terms) -> Option<Pattern> {
        let c = self.present.as_ref().filter(|c| c.is_confirmed(terms.options))?;
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
    fn mismatch(&self, c: &Candidate, end: usize, terms: &Terms) -> Option<Fall> {
        let (a, b) = (&self.points[end - c.minima], &self.points[end]);
        let duration = b.t - a.t;
        if (duration - c.duration).abs() > terms.options.time_match * c.duration {
            return Some(Fall::Took(duration, c.duration));
        }
        let near = self.nearness(c, end, terms);
        for (i, (found, expected)) in change(a, b).into_iter().zip(&c.change).enumerate() {
            let (q, v) = near(i);
            if (found.0 - expected.0).abs() > q {
                return Some(Fall::Moved(i, found.0, expected.0));
            }
            if (found.1 - expected.1).abs() > v {
                return Some(Fall::Sped(i, found.1, expected.1));
            }
        }
        None
    }

    /// The coordinate whose shapes show that it moves on from instance to instance; None if none does.
    fn unlike(&self, c: &Candidate, last: usize, terms: &Terms) -> Option<Fall> {
        let start = last - c.minima;
        let instance = &self.points[start + 1..=last];
        let off = |change: f64, period: f64| {
            // Of an infinite period the only multiple is zero.
            let multiple = if period.is_finite() { (change / period).round() * period } else { 0.0 };
            (change - multiple).abs()
        };
        let shows = |(i, (q, _)): (usize, &(f64, f64))| {
            // From point to point, not over an instance of many, lest one tooth of a hundred be lost in the difference.
            let widest = instance.iter().map(|p| p.ranges.q[i].1 - p.ranges.q[i].0).fold(0.0, f64::max);
            let near = (terms.options.state_match * widest).max(terms.floors.q[i]);
            let mut periods = terms.periods.get(i).into_iter().flatten();
            (q.abs() > GETS_ON * widest && periods.any(|&period| off(*q, period) > near))
                .then_some(Fall::Unlike(i, *q))
        };
        change(&self.points[start], &self.points[last]).iter().enumerate().find_map(shows)
    }

    /// How near changes of a coordinate's position and velocity count as equal, by how far it ranges in the instance that
    /// ends at a point.
    fn nearness<'s>(&self, c: &Candidate, end: usize, terms: &'s Terms) -> impl Fn(usize) -> (f64, f64) + 's {
        let mut ranges = self.points[end].ranges.clone();
        (end + 1 - c.minima..end).for_each(|k| ranges.merge(&self.points[k].ranges));
        let share = terms.options.state_match;
        move |i| {
            let (q, v) = (ranges.q[i], ranges.v[i]);
            ((share * (q.1 - q.0)).max(terms.floors.q[i]), (share * (v.1 - v.0)).max(terms.floors.v[i]))
        }
    }
}

fn change(a: &Point, b: &Point) -> Vec<(f64, f64)> {
    let q = a.q.iter().zip(&b.q).map(|(x, y)| y - x);
    let v = a.v.iter().zip(&b.v).map(|(x, y)| y - x);
    q.zip(v).collect()
}

#[cfg(test)]
mod tests {
    use super::{Point, Series};
    use crate::terms::{Floors, Label, MatchOptions, Terms};
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
                let labels = [Label { name: "wheel".into(), turns: true }];
                let terms = Terms { options: &options, labels: &labels, floors: &floors, periods: &[] };
                let found = (0..bound).find_map(|k| series.add(point(k, m), &terms));
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
        let labels = [Label { name: "wheel".into(), turns: true }];
        let options = MatchOptions::default();
        let terms = Terms { options: &options, labels: &labels, floors: &floors, periods: &[] };
        for k in 0..40 {
            series.add(point(k, 5), &terms);
        }
        let formed: Vec<usize> = series.hypotheses.iter().map(|h| h.minima).collect();
        assert_eq!(formed, vec![1, 2, 3, 4, 5]);
        assert!(series.hypotheses[..4].iter().all(|h| h.fell.is_some() && h.why.is_some()));
        assert!(series.hypotheses[4].fell.is_none());
    }

    /// The position climbs by 1 a pattern, and looks the same after every 3: a pattern three times as long is found.
    #[test]
    fn patterns_go_on_only_where_shapes_are_alike() {
        let floors = Floors { q: vec![0.0], v: vec![0.0] };
        let (options, labels) = (MatchOptions::default(), [Label { name: "rack".into(), turns: false }]);
        for (m, period, expected) in [(1, 3.0, Some(3)), (2, 3.0, Some(6)), (2, f64::INFINITY, None)] {
            let periods = [vec![1.0, period]];
            let terms = Terms { options: &options, labels: &labels, floors: &floors, periods: &periods };
            let mut series = Series::default();
            let found = (0..60).find_map(|k| series.add(point(k, m), &terms));
            assert_eq!(found.map(|p| p.minima), expected);
            let why = series.hypotheses.iter().filter_map(|h| h.why.as_deref());
            assert!(why.clone().any(|w| w == "rack moves on by 1.000000, where its shape is not the same"));
        }
    }
}
