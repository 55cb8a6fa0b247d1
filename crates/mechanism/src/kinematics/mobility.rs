//! Which freedoms the pairs of a machine leave each other (Gelsey 1995, Fig. 3: the piston cannot turn).
//!
//! Only parts in loops of pairs constrain each other. Each connected set of loops is examined by itself: a freedom
//! whose rate is zero in every motion of the loops is not available.

use super::chain::{Chain, Coupling, Degree, Link, RATE_TOLERANCE};
use super::linear::{Matrix, null_space, rank};
use super::pair::{Freedom, Pair, PairKind};

/// A connected set of loops of pairs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClosedChain {
    /// Indices of its parts, the frame included where it takes part.
    pub parts: Vec<usize>,
    /// Number of independent motions.
    pub mobility: usize,
    /// Closed by gears alone: all moving parts turn about axes fixed in one part.
    pub gears_only: bool,
}

/// Loops with more freedoms than this are not examined.
const MAX_DEGREES: usize = 160;

/// A set of loops with its equations.
pub(crate) struct Loops {
    pub parts: Vec<usize>,
    pub chain: Chain,
    pub typical: Vec<Matrix>,
    pub gears_only: bool,
}

/// The loops of the machine. Pairs that join a part to the rest by a single way are in none.
/// The second result names the parts of loops too large to be examined.
pub(crate) fn loops(parts: usize, frame: usize, pairs: &[Pair], size: f64) -> (Vec<Loops>, Vec<Vec<usize>>) {
    let core = core_parts(parts, frame, pairs);
    let (mut found, mut too_large) = (Vec::new(), Vec::new());
    for members in pieces(&core, frame, pairs) {
        match build(&members, pairs, size) {
            Some(l) => found.push(l),
            None => too_large.push(members),
        }
    }
    (found, too_large)
}

/// What is left when parts with a single pair are taken away again and again.
fn core_parts(parts: usize, frame: usize, pairs: &[Pair]) -> Vec<bool> {
    let mut present = vec![true; parts];
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); parts];
    for p in pairs {
        neighbours[p.parts.0].push(p.parts.1);
        neighbours[p.parts.1].push(p.parts.0);
    }
    let mut degree: Vec<usize> = neighbours.iter().map(Vec::len).collect();
    let mut loose: Vec<usize> = (0..parts).filter(|&p| p != frame && degree[p] < 2).collect();
    while let Some(p) = loose.pop() {
        present[p] = false;
        for &q in neighbours[p].iter().filter(|&&q| present[q]) {
            degree[q] -= 1;
            if degree[q] == 1 && q != frame {
                loose.push(q);
            }
        }
    }
    present
}

/// Connected pieces of the core, the frame joining nothing but belonging to each piece that touches it.
fn pieces(core: &[bool], frame: usize, pairs: &[Pair]) -> Vec<Vec<usize>> {
    let mut seen = vec![false; core.len()];
    let mut pieces = Vec::new();
    for start in (0..core.len()).filter(|&p| core[p] && p != frame) {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let (mut members, mut next) = (vec![start], 0);
        while next < members.len() {
            let p = members[next];
            next += 1;
            for q in pairs.iter().filter(|q| q.parts.0 == p || q.parts.1 == p) {
                let other = q.other(p);
                let new =
                    if other == frame { !members.contains(&frame) } else { core[other] && !seen[other] };
                if new {
                    seen[other] |= other != frame;
                    members.push(other);
                }
            }
            // The frame is a member, not a way through.
            while next < members.len() && members[next] == frame {
                next += 1;
            }
        }
        members.sort_unstable();
        pieces.push(members);
    }
    pieces
}

fn build(members: &[usize], pairs: &[Pair], size: f64) -> Option<Loops> {
    let at = |part: usize| members.iter().position(|m| *m == part);
    let (mut degrees, mut links) = (Vec::new(), Vec::new());
    for (index, pair) in pairs.iter().enumerate().filter(|(_, p)| p.is_lower()) {
        let (Some(a), Some(b)) = (at(pair.parts.0), at(pair.parts.1)) else { continue };
        let first = degrees.len();
        let degree = |turns| Degree { pair: index, axis: pair.axis, turns };
        degrees.extend(pair.kind.turns().then(|| degree(true)));
        degrees.extend(pair.kind.slides().then(|| degree(false)));
        links.push(Link { bodies: (a, b), degrees: (first..degrees.len()).collect() });
    }
    if degrees.len() > MAX_DEGREES {
        return None;
    }
    let couplings: Vec<Coupling> =
        pairs.iter().filter(|p| !p.is_lower()).filter_map(|g| coupling(g, pairs, &degrees)).collect();
    let gears_only = links.len() < members.len();
    let chain = Chain::new(members.len(), degrees, links, couplings, size);
    let typical = chain.typical();
    Some(Loops { parts: members.to_vec(), chain, typical, gears_only })
}

/// A gear pair as a relation between the turning rates of its parts against their common carrier.
fn coupling(gear: &Pair, pairs: &[Pair], degrees: &[Degree]) -> Option<Coupling> {
    let (a, b) = gear.parts;
    for (i, first) in degrees.iter().enumerate().filter(|(_, d)| d.turns) {
        let p = &pairs[first.pair];
        if p.parts.0 != a && p.parts.1 != a {
            continue;
        }
        let carrier = p.other(a);
        for (j, second) in degrees.iter().enumerate().filter(|(_, d)| d.turns) {
            let q = &pairs[second.pair];
            if (q.parts.0 == b && q.parts.1 == carrier) || (q.parts.1 == b && q.parts.0 == carrier) {
                // A rate is that of the pair's second part: the other sign where the gear is its first.
                let sign = |pair: &Pair, part| if pair.parts.1 == part { 1.0 } else { -1.0 };
                let ratio = gear.ratio? * sign(p, a) * sign(q, b);
                return Some(Coupling { first: i, second: j, ratio });
            }
        }
    }
    None
}

impl Loops {
    fn columns(&self) -> usize {
        self.chain.degrees.len()
    }

    /// The freedoms that no motion uses, as (pair, freedom).
    pub(crate) fn unavailable(&self) -> Vec<(usize, Freedom)> {
        let bases: Vec<Matrix> =
            self.typical.iter().map(|rows| null_space(rows, self.columns(), RATE_TOLERANCE)).collect();
        let used = |d: usize| bases.iter().flatten().any(|v| v[d].abs() > RATE_TOLERANCE);
        let name = |d: usize| {
            let degree = &self.chain.degrees[d];
            (degree.pair, if degree.turns { Freedom::Turning } else { Freedom::Sliding })
        };
        (0..self.columns()).filter(|&d| !used(d)).map(name).collect()
    }

    /// May the freedoms be left out without changing how all others can move?
    pub(crate) fn idle(&self, left_out: &[(usize, Freedom)]) -> bool {
        let out = self.mask(left_out);
        let without = |row: &Vec<f64>| -> Vec<f64> {
            row.iter().zip(&out).filter(|(_, out)| !**out).map(|(x, _)| *x).collect()
        };
        let kept = out.iter().filter(|o| !**o).count();
        self.typical.iter().all(|rows| {
            let all: Matrix = null_space(rows, self.columns(), RATE_TOLERANCE).iter().map(without).collect();
            let fewer: Matrix = rows.iter().map(without).collect();
            rank(&all, kept, RATE_TOLERANCE) == null_space(&fewer, kept, RATE_TOLERANCE).len()
        })
    }

    /// Number of independent motions when some freedoms are left out.
    pub(crate) fn mobility(&self, left_out: &[(usize, Freedom)]) -> usize {
        let out = self.mask(left_out);
        let without = |row: &Vec<f64>| -> Vec<f64> {
            row.iter().zip(&out).filter(|(_, out)| !**out).map(|(x, _)| *x).collect()
        };
        let kept = out.iter().filter(|o| !**o).count();
        let count = |rows: &Matrix| {
            let fewer: Matrix = rows.iter().map(without).collect();
            null_space(&fewer, kept, RATE_TOLERANCE).len()
        };
        self.typical.iter().map(count).min().unwrap_or(0)
    }

    /// Rates of the pairs' freedoms at the modelled place, if there is a single motion: (pair, rate), the rate of the
    /// pair's second part against its first in radians, or the file's length.
    pub(crate) fn rates(&self, left_out: &[(usize, Freedom)]) -> Option<Vec<(usize, f64)>> {
        let degrees = &self.chain.degrees;
        let kept: Vec<usize> = {
            let out = self.mask(left_out);
            (0..degrees.len()).filter(|d| !out[*d]).collect()
        };
        let here = self.chain.equations(&vec![0.0; degrees.len()]);
        let fewer: Matrix = here.iter().map(|row| kept.iter().map(|d| row[*d]).collect()).collect();
        let [motion] = &null_space(&fewer, kept.len(), RATE_TOLERANCE)[..] else { return None };
        let scale = |d: usize| if degrees[d].turns { 1.0 } else { self.chain.size };
        Some(kept.iter().zip(motion).map(|(&d, rate)| (degrees[d].pair, rate * scale(d))).collect())
    }

    pub(crate) fn has(&self, pair: usize) -> bool {
        self.chain.degrees.iter().any(|d| d.pair == pair)
    }

    fn mask(&self, left_out: &[(usize, Freedom)]) -> Vec<bool> {
        let is_out = |d: &Degree| {
            let freedom = if d.turns { Freedom::Turning } else { Freedom::Sliding };
            left_out.contains(&(d.pair, freedom))
        };
        self.chain.degrees.iter().map(is_out).collect()
    }
}

/// Takes a freedom out of a pair's kind.
pub(crate) fn without(kind: PairKind, freedom: Freedom) -> PairKind {
    match freedom {
        Freedom::Turning => PairKind::of_freedoms(false, kind.slides()),
        Freedom::Sliding => PairKind::of_freedoms(kind.turns(), false),
    }
}
