//! Why parts that nearly fit form no pair.

use super::fits::ShaftMiss;
use super::pair::Pair;
use super::search::{Finding, Loose};
use super::surface::{off_line, parallel};

/// Parts that nearly form a pair, and why they do not.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMiss {
    /// Indices of the parts, the first in the text first.
    pub parts: (usize, usize),
    /// A primitive of each part.
    pub primitives: [u32; 2],
    /// In words, with names and numbers.
    pub reason: String,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Miss {
    pub parts: (usize, usize),
    pub primitives: [u32; 2],
    pub why: Why,
}

/// Reasons; `solid` is 0 or 1, the part with the material inside. Lengths in the file's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Why {
    BothSolid,
    BothHollow,
    /// Hole radius minus shaft radius.
    Radius {
        solid: usize,
        difference: f64,
    },
    Offset {
        by: f64,
    },
    Apart {
        by: f64,
    },
    CutAway {
        part: usize,
    },
    Arc {
        degrees: f64,
    },
    Faces,
    OffCentre {
        plays: (f64, f64),
    },
    OpenSide,
    /// Would fit if this play were allowed.
    Play {
        play: f64,
    },
    /// Gear envelopes that do not reach each other, by this much.
    GearsApart {
        by: f64,
    },
    /// Gear envelopes that overlap by more than the tooth depth given.
    GearsTooDeep {
        overlap: f64,
        depth: f64,
    },
    /// Gears whose axis is not the one their part turns about.
    GearOffAxis {
        part: usize,
    },
    /// Gears turning in different carriers.
    GearCarriers,
}

impl Miss {
    pub(crate) fn play(parts: (usize, usize), primitives: [u32; 2], play: f64) -> Self {
        Miss { parts, primitives, why: Why::Play { play } }
    }
}

/// Axes of two parts on which the nearest miss is looked for.
const MAX_AXES: usize = 500;
/// Near misses listed for one pair of parts.
const MAX_LISTED: usize = 3;

/// The near misses of two parts worth telling: one for each axis on which they form no pair.
pub(crate) fn relevant(
    parts: (usize, usize),
    finding: &Finding,
    pair: Option<&Pair>,
    tolerance: f64,
) -> Vec<Miss> {
    let mut best: Vec<(u8, &ShaftMiss, Why)> = Vec::new();
    for miss in &finding.misses {
        let [a, _] = &miss.laterals;
        let same_axis = |m: &ShaftMiss| {
            let b = &m.laterals[0];
            parallel(a.direction, b.direction) && off_line(b.middle, a.middle, a.direction) <= tolerance
        };
        let on_pair = |p: &Pair| {
            parallel(p.axis.direction, a.direction)
                && off_line(a.middle, p.axis.point, a.direction) <= 10.0 * tolerance + miss.offset
        };
        if pair.is_some_and(on_pair) {
            continue;
        }
        let Some((rank, why)) = why(miss, pair.is_some(), tolerance) else { continue };
        let full = best.len() >= MAX_AXES;
        match best.iter_mut().find(|(_, m, _)| same_axis(m)) {
            Some(known) if better(rank, &why, known.0, &known.2) => *known = (rank, miss, why),
            Some(_) => {}
            None if !full => best.push((rank, miss, why)),
            None => {}
        }
    }
    best.sort_by_key(|(rank, ..)| *rank);
    let mut list: Vec<Miss> = best
        .into_iter()
        .map(|(_, miss, why)| Miss { parts, primitives: miss.laterals.map(|l| l.id.primitive), why })
        .collect();
    if pair.is_none() {
        list.extend(finding.loose.as_ref().map(|l| loose(parts, l)));
        list.extend(finding.left_open.map(|primitives| Miss { parts, primitives, why: Why::OpenSide }));
    }
    list.truncate(MAX_LISTED);
    list
}

fn better(rank: u8, why: &Why, known_rank: u8, known: &Why) -> bool {
    let by = |w: &Why| match w {
        Why::Radius { difference, .. } => difference.abs(),
        Why::Offset { by } | Why::Apart { by } => *by,
        _ => 0.0,
    };
    rank < known_rank || (rank == known_rank && by(why) < by(known))
}

/// The reason and its rank: lower is nearer to a pair.
fn why(miss: &ShaftMiss, has_pair: bool, tolerance: f64) -> Option<(u8, Why)> {
    let [a, b] = &miss.seen;
    let difference = miss.laterals[1].radius - miss.laterals[0].radius;
    if let Some(by) = miss.gap {
        return (!has_pair).then_some((4, Why::Apart { by }));
    }
    let opposed = (a.solid && b.hollow, a.hollow && b.solid);
    if miss.offset > tolerance {
        return (opposed.0 || opposed.1).then_some((2, Why::Offset { by: miss.offset }));
    }
    if difference.abs() > tolerance {
        return match opposed {
            (true, _) => Some((1, Why::Radius { solid: 0, difference })),
            (_, true) => Some((1, Why::Radius { solid: 1, difference: -difference })),
            _ => None,
        };
    }
    let seen = |s: &super::patch::Seen| s.solid || s.hollow;
    match (seen(a), seen(b)) {
        (true, true) if a.solid && b.solid => Some((0, Why::BothSolid)),
        (true, true) if a.hollow && b.hollow => Some((0, Why::BothHollow)),
        (true, true) => (!has_pair).then_some((3, Why::CutAway { part: 1 })),
        (false, _) => (!has_pair).then_some((5, Why::CutAway { part: 0 })),
        (_, false) => (!has_pair).then_some((5, Why::CutAway { part: 1 })),
    }
}

fn loose(parts: (usize, usize), loose: &Loose) -> Miss {
    let (primitives, why) = match *loose {
        // Held all round and yet not: other shafts and faces leave no single motion.
        Loose::Arc { primitives, angle } if angle > std::f64::consts::PI + 1e-6 => (primitives, Why::Faces),
        Loose::Arc { primitives, angle } => (primitives, Why::Arc { degrees: angle.to_degrees() }),
        Loose::Faces { primitives } => (primitives, Why::Faces),
        Loose::OffCentre { primitives, plays } => (primitives, Why::OffCentre { plays }),
    };
    Miss { parts, primitives, why }
}

impl Miss {
    /// In words; `name` gives the name of the pair's first (0) or second (1) part.
    pub(crate) fn reason(&self, name: impl Fn(usize) -> String) -> String {
        let n = |x: f64| number(x);
        match self.why {
            Why::BothSolid => "coaxial cylinders of the same radius, but both are solid".into(),
            Why::BothHollow => "coaxial cylinders of the same radius, but both are hollow".into(),
            Why::Radius { solid, difference } if difference > 0.0 => {
                format!(
                    "the shaft of {} is smaller than its hole: radii differ by {}",
                    name(solid),
                    n(difference)
                )
            }
            Why::Radius { solid, difference } => {
                format!(
                    "the shaft of {} is larger than its hole: radii differ by {}",
                    name(solid),
                    n(-difference)
                )
            }
            Why::Offset { by } => {
                format!("shaft and hole of the same radius, but their axes are {} apart", n(by))
            }
            Why::Apart { by } => {
                format!(
                    "cylinders of the same radius on one axis, but {} apart along it: no intersection",
                    n(by)
                )
            }
            Why::CutAway { part } => {
                format!(
                    "coaxial cylinders of the same radius, but the surface of {} is cut away where they meet",
                    name(part)
                )
            }
            Why::Arc { degrees } => {
                format!(
                    "shaft and hole meet over {} degrees only: less than half a turn holds nothing",
                    n(degrees)
                )
            }
            Why::Faces => "their surfaces meet on opposite sides, but leave no single motion".into(),
            Why::OffCentre { plays: (a, b) } => {
                format!("the play on opposite sides differs: {} and {}", n(a), n(b))
            }
            Why::OpenSide => {
                "they fit, but one side is open and both parts are held elsewhere: left to contact".into()
            }
            Why::Play { play } => format!("the sections agree but for a play of {}", n(play)),
            Why::GearsApart { by } => format!("the gear envelopes do not overlap: {} apart", n(by)),
            Why::GearsTooDeep { overlap, depth } => {
                format!(
                    "the gear envelopes overlap by {}, more than the tooth depth {}",
                    n(overlap),
                    n(depth)
                )
            }
            Why::GearOffAxis { part } => {
                format!("the gear envelopes overlap, but {} does not turn about its gear's axis", name(part))
            }
            Why::GearCarriers => "the gear envelopes overlap, but the gears turn in different parts".into(),
        }
    }
}

/// A length in words: six significant digits.
pub(crate) fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = (5 - x.abs().log10().floor() as i32).clamp(0, 17) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}
