//! Parts that share one degree of freedom (Gelsey 1995, Section 2.1.3, Algorithm 7).

use super::pair::{Pair, PairKind};

/// Parts whose joint positions are multiples of one position, that of the root.
#[derive(Clone, Debug, PartialEq)]
pub struct Subsystem {
    /// The first of its parts in the text.
    pub root: usize,
    /// Each part with its joint's velocity over that of the root, in the order of the text; the root has 1.
    pub parts: Vec<(usize, f64)>,
    /// `Σ I r²`: moment of inertia about the axis, or mass, seen at the root. None where one is not known.
    pub inertia: Option<f64>,
    /// Loops of gears whose ratios contradict each other: nothing in it can move.
    pub locked: bool,
    /// Joined by a closed chain of pairs: the ratios are those at the modelled place and change as it moves.
    pub closed: bool,
}

/// How each part hangs on the frame: the pair that carries it, and the part that carries it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Hold {
    pub pair: usize,
    pub carrier: usize,
}

/// The pairs by which parts hang on the frame, breadth first; none for the frame and for parts not reached.
pub(crate) fn holds(parts: usize, frame: usize, pairs: &[Pair]) -> Vec<Option<Hold>> {
    let mut holds = vec![None; parts];
    let mut queue = std::collections::VecDeque::from([frame]);
    while let Some(carrier) = queue.pop_front() {
        for (index, pair) in pairs.iter().enumerate().filter(|(_, p)| p.is_lower()) {
            if pair.parts.0 != carrier && pair.parts.1 != carrier {
                continue;
            }
            let part = pair.other(carrier);
            if part != frame && holds[part].is_none() {
                holds[part] = Some(Hold { pair: index, carrier });
                queue.push_back(part);
            }
        }
    }
    holds
}

/// Ratios of different ways round a loop of gears may differ by this much, relatively.
const RATIO_TOLERANCE: f64 = 1e-9;

/// Groups the moving parts by gears. Parts that are fixed to their carrier, or held by nothing, are in none.
pub(crate) fn subsystems(holds: &[Option<Hold>], pairs: &[Pair]) -> Vec<Subsystem> {
    let moves = |p: usize| holds[p].is_some_and(|h| pairs[h.pair].kind != PairKind::Fixed);
    let mut ratio: Vec<Option<f64>> = vec![None; holds.len()];
    let mut found = Vec::new();
    for root in (0..holds.len()).filter(|&p| moves(p)) {
        if ratio[root].is_some() {
            continue;
        }
        ratio[root] = Some(1.0);
        let (mut members, mut next, mut locked) = (vec![root], 0, false);
        while next < members.len() {
            let a = members[next];
            next += 1;
            let at_a = ratio[a].unwrap_or(1.0);
            // A ratio holds against the part that carries both gears.
            let carrier = |p: usize| holds[p].map(|h| h.carrier);
            for (b, factor) in gears_of(a, pairs).filter(|(b, _)| moves(*b) && carrier(*b) == carrier(a)) {
                let at_b = at_a * factor;
                match ratio[b] {
                    Some(known) => locked |= (known - at_b).abs() > RATIO_TOLERANCE * known.abs(),
                    None => {
                        ratio[b] = Some(at_b);
                        members.push(b);
                    }
                }
            }
        }
        members.sort_unstable();
        let parts = members.iter().map(|&p| (p, ratio[p].unwrap_or(1.0))).collect();
        found.push(Subsystem { root, parts, inertia: None, locked, closed: false });
    }
    found
}

/// The gears in mesh with a part, and their velocity over the part's.
fn gears_of(part: usize, pairs: &[Pair]) -> impl Iterator<Item = (usize, f64)> + '_ {
    pairs.iter().filter_map(move |p| {
        let ratio = p.ratio.filter(|_| p.kind == PairKind::Gear)?;
        match p.parts {
            (a, b) if a == part => Some((b, ratio)),
            (a, b) if b == part => Some((a, ratio.recip())),
            _ => None,
        }
    })
}

/// Joins the subsystems of a closed chain that has one motion. `rates` are those of its pairs, each the rate of the
/// pair's second part against its first. Left as they are if the first part stands still at the modelled place.
pub(crate) fn join(
    subsystems: &mut Vec<Subsystem>,
    rates: &[(usize, f64)],
    holds: &[Option<Hold>],
    pairs: &[Pair],
) {
    let rate = |part: usize| {
        let hold = holds[part]?;
        let (_, rate) = rates.iter().find(|(pair, _)| *pair == hold.pair)?;
        Some(if pairs[hold.pair].parts.1 == part { *rate } else { -*rate })
    };
    let takes_part = |s: &Subsystem| s.parts.iter().any(|(p, _)| rate(*p).is_some());
    let Some(first) = subsystems.iter().find(|s| takes_part(s)) else { return };
    let root = first.root;
    let largest = rates.iter().fold(0.0, |m: f64, r| m.max(r.1.abs()));
    let Some(root_rate) = rate(root).filter(|r| r.abs() > 1e-9 * largest) else { return };
    let (members, rest): (Vec<Subsystem>, Vec<Subsystem>) = subsystems.drain(..).partition(|s| takes_part(s));
    let mut parts = Vec::new();
    for s in &members {
        // The other parts of a member follow the one that takes part, by gears.
        let Some((scale, at)) = s.parts.iter().find_map(|(p, r)| Some((rate(*p)? / root_rate, *r))) else {
            continue;
        };
        parts.extend(s.parts.iter().map(|(p, r)| (*p, scale * r / at)));
    }
    parts.sort_by_key(|p| p.0);
    let locked = members.iter().any(|s| s.locked);
    *subsystems = rest;
    subsystems.push(Subsystem { root, parts, inertia: None, locked, closed: true });
    subsystems.sort_by_key(|s| s.root);
}
