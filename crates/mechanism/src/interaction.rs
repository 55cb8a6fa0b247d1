//! Which bodies can ever touch, by the regions their features sweep (Gelsey 1995, Sec. 2.1.4).

use crate::equations::{Coupled, coupled};
use crate::feature::{Feature, features};
use crate::forces::Forces;
use crate::gap::GapKind;
use crate::placed::MAX_CHAIN;
use crate::source::DirectSearch;
use crate::system::{Body, Coordinate, Joint, Motion};
use crate::tree::FeatureTree;
use mainspring_geometry::{CurveId, Vec2};
use std::collections::BTreeMap;

/// Pairs of features up to which an interaction lists all.
const MOST_PAIRS: usize = 512;

/// Curves of two bodies that are no contact features of this pair: surfaces of their lower pair, gear envelopes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Exclusion {
    pub bodies: (usize, usize),
    pub curves: Vec<CurveId>,
}

/// Two bodies that may come into contact.
#[derive(Clone, Debug)]
pub struct Interaction {
    pub bodies: (usize, usize),
    /// Trees over the features of either body that can reach the other.
    pub trees: (FeatureTree, FeatureTree),
    /// Greatest lever arms: how far a feature moves at most per unit of a joint's own position, by joint of the
    /// chain. For the first and the second body.
    pub levers: ([f64; MAX_CHAIN], [f64; MAX_CHAIN]),
    /// For each feature of either body, how far it moves at most as a fraction of the greatest lever arm.
    pub shares: (Vec<f64>, Vec<f64>),
    /// All pairs of features that can ever touch, in order; empty where there are more than `MOST_PAIRS`.
    pub pairs: Vec<(u32, u32, GapKind)>,
    /// Which features are no surfaces of the bodies' own pair.
    usable: (Vec<bool>, Vec<bool>),
    height_tolerance: f64,
}

impl Interaction {
    /// The kind of contact of two features (named by index); None if they are surfaces of the bodies' own pair or
    /// never lie in a common layer.
    pub fn kind(&self, ids: (usize, usize), features: (&Feature, &Feature)) -> Option<GapKind> {
        if !self.usable.0[ids.0] || !self.usable.1[ids.1] {
            return None;
        }
        let kind = GapKind::of(features.0, features.1)?;
        features.0.shares_height(features.1, self.height_tolerance).then_some(kind)
    }
}

/// Everything contact and motion need to know of a mechanism.
#[derive(Clone, Debug)]
pub struct System {
    pub coordinates: Vec<Coordinate>,
    pub bodies: Vec<Body>,
    /// Features of each body.
    pub features: Vec<Vec<Feature>>,
    pub interactions: Vec<Interaction>,
    /// The machine's size in the file's length: tolerances of contact are relative to it.
    pub size: f64,
    /// What acts beside the linear forces of coordinates.
    pub forces: Forces,
    /// Coordinates that do not fly in closed form: tied together by masses, or pulled by gravity as they turn.
    pub coupled: Vec<Coupled>,
}

impl System {
    /// Finds features and possible interactions. Bodies on the same coordinates never interact; neither do
    /// features named in an exclusion of their pair.
    pub fn new(coordinates: Vec<Coordinate>, bodies: Vec<Body>, exclusions: &[Exclusion], size: f64) -> Self {
        let features: Vec<Vec<Feature>> = bodies.iter().map(|b| features(&b.outline, size)).collect();
        let excluded = by_pair(exclusions);
        let mut interactions = Vec::new();
        for i in 0..bodies.len() {
            for j in i + 1..bodies.len() {
                if bodies[i].chain == bodies[j].chain {
                    continue;
                }
                let excluded = excluded.get(&(i, j)).map_or(&[][..], Vec::as_slice);
                interactions.extend(interaction((i, j), &bodies, &features, excluded, size));
            }
        }
        let forces = Forces::none(coordinates.len());
        Self { coordinates, bodies, features, interactions, size, forces, coupled: vec![] }
    }

    /// The same system with more acting on it; lists by coordinate must have an entry for each.
    pub fn with_forces(self, forces: Forces) -> Self {
        let system = Self { forces, ..self };
        Self { coupled: coupled(&system), ..system }
    }

    /// The direct search for contacts.
    pub fn direct_search(&self) -> DirectSearch<'_> {
        DirectSearch { interactions: &self.interactions, features: &self.features }
    }
}

/// Curves that are no contact features, by pair of bodies, the lesser first; in the order of the exclusions.
fn by_pair(exclusions: &[Exclusion]) -> BTreeMap<(usize, usize), Vec<CurveId>> {
    let mut found: BTreeMap<(usize, usize), Vec<CurveId>> = BTreeMap::new();
    for Exclusion { bodies: (i, j), curves } in exclusions {
        found.entry((*i.min(j), *i.max(j))).or_default().extend(curves);
    }
    found
}

fn interaction(
    pair: (usize, usize),
    bodies: &[Body],
    features: &[Vec<Feature>],
    excluded: &[CurveId],
    size: f64,
) -> Option<Interaction> {
    let (a, b) = (&bodies[pair.0], &bodies[pair.1]);
    let (fa, fb) = (&features[pair.0], &features[pair.1]);
    let height_tolerance = 1e-9 * size;
    let usable = |f: &Feature| !is_excluded(f, excluded);
    let shared = shared_joints(a, b);
    let swept = |body: &Body, list: &[Feature]| -> Vec<Option<Swept>> {
        list.iter().map(|f| usable(f).then(|| Swept::new(&body.chain[shared..], f))).collect()
    };
    let (sa, sb) = (swept(a, fa), swept(b, fb));
    let meets = |i: usize, j: usize| {
        let (Some(p), Some(q)) = (&sa[i], &sb[j]) else { return false };
        GapKind::of(&fa[i], &fb[j]).is_some()
            && fa[i].shares_height(&fb[j], height_tolerance)
            && p.meets(q, 1e-9 * size)
    };
    let chosen_a: Vec<usize> = (0..fa.len()).filter(|&i| (0..fb.len()).any(|j| meets(i, j))).collect();
    if chosen_a.is_empty() {
        return None;
    }
    let chosen_b: Vec<usize> = (0..fb.len()).filter(|&j| chosen_a.iter().any(|&i| meets(i, j))).collect();
    let pairs = chosen_a.iter().flat_map(|&i| chosen_b.iter().map(move |&j| (i, j)));
    let kind = |i: usize, j: usize| GapKind::of(&fa[i], &fb[j]).map(|kind| (i as u32, j as u32, kind));
    let mut pairs: Vec<_> =
        pairs.filter(|&(i, j)| meets(i, j)).filter_map(|(i, j)| kind(i, j)).take(MOST_PAIRS + 1).collect();
    if pairs.len() > MOST_PAIRS {
        pairs.clear();
    }
    let levers = (levers(a, shared, fa, &chosen_a), levers(b, shared, fb, &chosen_b));
    let greatest = |levers: &[f64; MAX_CHAIN]| levers.get(shared).copied().unwrap_or(0.0);
    let shares = (
        shares(&a.chain[shared..], fa, greatest(&levers.0)),
        shares(&b.chain[shared..], fb, greatest(&levers.1)),
    );
    let trees = (FeatureTree::new(fa, chosen_a), FeatureTree::new(fb, chosen_b));
    let usable = (fa.iter().map(usable).collect(), fb.iter().map(usable).collect());
    Some(Interaction { bodies: pair, trees, levers, shares, pairs, usable, height_tolerance })
}

/// How many joints both chains begin with: these move both bodies alike, and nothing between them depends on it.
fn shared_joints(a: &Body, b: &Body) -> usize {
    a.chain.iter().zip(&b.chain).take_while(|(j, k)| j == k).count()
}

/// A curve is excluded when its owner or an alias is; a corner when both of its sides are.
fn is_excluded(feature: &Feature, excluded: &[CurveId]) -> bool {
    let hit = |curves: &[CurveId]| curves.iter().any(|c| excluded.contains(c));
    hit(&feature.curves[0]) && (feature.name.next.is_none() || hit(&feature.curves[1]))
}

/// The region a feature can sweep: all of it is inside.
enum Swept {
    Disc {
        center: Vec2,
        radius: f64,
    },
    Ring {
        center: Vec2,
        inner: f64,
        outer: f64,
    },
    /// Between two parallel lines: `low ≤ normal · p ≤ high`.
    Band {
        normal: Vec2,
        low: f64,
        high: f64,
    },
    Everywhere,
}

impl Swept {
    fn new(chain: &[Joint], feature: &Feature) -> Self {
        let (center, radius) = (feature.center, feature.radius);
        match chain {
            [] => Swept::Disc { center, radius },
            [joint] => match joint.motion {
                Motion::Turn { center: axis } => {
                    let (inner, outer) = feature.shape.distances_from(axis);
                    Swept::Ring { center: axis, inner, outer }
                }
                Motion::Slide { direction } => {
                    let normal = direction.perp();
                    let at = normal.dot(center);
                    Swept::Band { normal, low: at - radius, high: at + radius }
                }
            },
            [first, rest @ ..] => Swept::new(rest, feature).moved(&first.motion),
        }
    }

    /// All places of the region as a joint moves it.
    fn moved(self, motion: &Motion) -> Self {
        match (self, motion) {
            (Swept::Everywhere, _) | (Swept::Band { .. }, Motion::Turn { .. }) => Swept::Everywhere,
            (Swept::Band { normal, low, high }, Motion::Slide { direction }) => {
                let along = normal.dot(*direction).abs() <= 1e-12;
                if along { Swept::Band { normal, low, high } } else { Swept::Everywhere }
            }
            (round, Motion::Turn { center: axis }) => {
                let (c, inner, outer) = round.ring();
                let apart = (c - *axis).norm();
                let inner = (apart - outer).max(inner - apart).max(0.0);
                Swept::Ring { center: *axis, inner, outer: apart + outer }
            }
            (round, Motion::Slide { direction }) => {
                let (c, _, outer) = round.ring();
                let normal = direction.perp();
                let at = normal.dot(c);
                Swept::Band { normal, low: at - outer, high: at + outer }
            }
        }
    }

    fn meets(&self, other: &Swept, slack: f64) -> bool {
        use Swept::{Band, Disc, Everywhere, Ring};
        match (self, other) {
            (Everywhere, _) | (_, Everywhere) => true,
            (Band { normal, low, high }, Band { normal: other_normal, low: l, high: h }) => {
                // Parallel bands meet if their intervals do; others always cross.
                let along = normal.dot(*other_normal);
                if normal.cross(*other_normal).abs() > 1e-12 {
                    return true;
                }
                let (l, h) = if along > 0.0 { (*l, *h) } else { (-*h, -*l) };
                *low <= h + slack && l <= *high + slack
            }
            (Band { normal, low, high }, ring) | (ring, Band { normal, low, high }) => {
                let (center, _, outer) = ring.ring();
                let at = normal.dot(center);
                at + outer >= low - slack && at - outer <= high + slack
            }
            (Disc { .. } | Ring { .. }, Disc { .. } | Ring { .. }) => {
                let ((c, inner_c, outer_c), (d, inner_d, outer_d)) = (self.ring(), other.ring());
                let apart = (c - d).norm();
                apart <= outer_c + outer_d + slack
                    && apart + outer_d >= inner_c - slack
                    && apart + outer_c >= inner_d - slack
            }
        }
    }

    fn ring(&self) -> (Vec2, f64, f64) {
        match *self {
            Swept::Disc { center, radius } => (center, 0.0, radius),
            Swept::Ring { center, inner, outer } => (center, inner, outer),
            _ => (Vec2::default(), 0.0, f64::INFINITY),
        }
    }
}

/// How far features move at most per unit of each joint's position: 1 for a slide, the distance from the axis for a
/// turn, whatever the turns later in the chain; slides between add their own positions to it. 0 for joints that
/// both bodies share.
fn levers(body: &Body, shared: usize, features: &[Feature], chosen: &[usize]) -> [f64; MAX_CHAIN] {
    let mut levers = [0.0; MAX_CHAIN];
    let mut outer: Option<(Vec2, f64)> = None;
    for (k, joint) in body.chain.iter().enumerate().take(MAX_CHAIN).skip(shared).rev() {
        let Motion::Turn { center } = joint.motion else {
            levers[k] = 1.0;
            continue;
        };
        levers[k] = match outer {
            Some((axis, reach)) => (axis - center).norm() + reach,
            None => chosen.iter().map(|&i| features[i].shape.distances_from(center).1).fold(0.0, f64::max),
        };
        outer = Some((center, levers[k]));
    }
    levers
}

/// Lever arms of single features on a body that only turns, relative to the greatest; 1 for all others. `chain` is
/// what the other body does not share.
fn shares(chain: &[Joint], features: &[Feature], greatest: f64) -> Vec<f64> {
    let share = |f: &Feature| match chain {
        [joint] => match joint.motion {
            Motion::Turn { center } if greatest > 0.0 => {
                (f.shape.distances_from(center).1 / greatest).min(1.0)
            }
            _ => 1.0,
        },
        _ => 1.0,
    };
    features.iter().map(share).collect()
}
