//! Which features touch in the copies of a stored tile: the same place of the machine, another tooth.

use mainspring_cspace::{ConfigurationSpace, TileTurn};
use mainspring_geometry::Vec2;
use mainspring_mechanism::{Cone, Feature, FeatureShape, System};

/// Features one period apart are the same shape to this part of the size.
const SAME: f64 = 1e-6;

/// For each coordinate that repeats: which of the two parts does, and for each of its features the one that does the same
/// one period further.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tiles([Option<(usize, Vec<usize>)>; 2]);

impl Tiles {
    pub fn new(system: &System, map: &ConfigurationSpace, parts: [usize; 2]) -> Self {
        Tiles([0, 1].map(|k| {
            let turn = map.tile_turn(k)?;
            let slot = usize::from(turn.body != parts[0]);
            Some((slot, successors(&system.features[turn.body], &turn, SAME * system.size)))
        }))
    }

    /// The features that touch at `q` where those of the stored tile are `features`.
    pub fn at(&self, map: &ConfigurationSpace, q: [f64; 2], features: [usize; 2]) -> [usize; 2] {
        let mut found = features;
        let domain = map.domain();
        for k in 0..2 {
            let Some((slot, next)) = &self.0[k] else { continue };
            let periods = ((q[k] - domain[k].start) / domain[k].length).floor();
            let repeats = f64::from(map.repeats()[k]);
            // Whole turns come back to the same feature.
            for _ in 0..periods.rem_euclid(repeats) as usize {
                found[*slot] = next[found[*slot]];
            }
        }
        found
    }
}

/// For each feature the one it is turned into; itself where there is none.
fn successors(features: &[Feature], turn: &TileTurn, tolerance: f64) -> Vec<usize> {
    let (sin, cos) = turn.angle.sin_cos();
    let turned = |p: Vec2| {
        let d = p - turn.center;
        turn.center + Vec2::new(cos * d.x - sin * d.y, sin * d.x + cos * d.y)
    };
    let points: Vec<[Vec2; 3]> = features.iter().map(landmarks).collect();
    let mut order: Vec<usize> = (0..features.len()).collect();
    order.sort_by(|&i, &j| points[i][0].x.total_cmp(&points[j][0].x));
    let kind = |j: usize| std::mem::discriminant(&features[j].shape);
    let find = |i: usize| {
        let wanted = points[i].map(turned);
        let x = wanted[0].x;
        let off = |j: usize| (0..3).map(|k| (points[j][k] - wanted[k]).norm()).fold(0.0, f64::max);
        let first = order.partition_point(|&j| points[j][0].x < x - tolerance);
        let beside = order[first..].iter().copied().take_while(|&j| points[j][0].x <= x + tolerance);
        let alike = beside.filter(|&j| kind(j) == kind(i) && off(j) <= tolerance);
        alike.min_by(|&a, &b| off(a).total_cmp(&off(b)).then(a.cmp(&b))).unwrap_or(i)
    };
    (0..features.len()).map(find).collect()
}

/// Points that tell a feature from its like: the ends of an edge; of an arc the centre and two directions.
fn landmarks(feature: &Feature) -> [Vec2; 3] {
    match &feature.shape {
        FeatureShape::Edge { from, to, .. } => [*from, *to, *to],
        FeatureShape::Round { center, radius, cone } | FeatureShape::Hollow { center, radius, cone } => {
            let (a, b) = match *cone {
                Cone::Full => (Vec2::default(), Vec2::default()),
                Cone::Narrow { start, end } => (start, end),
                Cone::Wide { middle, .. } => (middle, middle),
            };
            [*center, *center + a * *radius, *center + b * *radius]
        }
    }
}
