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
    let marks: Vec<([Vec2; 3], f64)> = features.iter().map(landmarks).collect();
    let near = |p: &[Vec2; 3], q: &[Vec2; 3]| p.iter().zip(q).all(|(p, q)| (*p - *q).norm() <= tolerance);
    let kind = |i: usize| std::mem::discriminant(&features[i].shape);
    // Images follow each other along the outline as the features do: the search goes on behind the last one found.
    let mut next = 0;
    let image = |i: usize| {
        let (points, radius) = (marks[i].0.map(turned), marks[i].1);
        let same = |j: &usize| {
            kind(*j) == kind(i) && near(&marks[*j].0, &points) && (marks[*j].1 - radius).abs() <= tolerance
        };
        let found = (next..features.len()).chain(0..next).find(same);
        next = found.map_or(next, |j| j + 1);
        found.unwrap_or(i)
    };
    (0..features.len()).map(image).collect()
}

/// Points that tell a feature from its like: the ends of an edge; of an arc the centre and two directions; and the radius.
fn landmarks(feature: &Feature) -> ([Vec2; 3], f64) {
    match &feature.shape {
        FeatureShape::Edge { from, to, .. } => ([*from, *to, *to], 0.0),
        FeatureShape::Round { center, radius, cone } | FeatureShape::Hollow { center, radius, cone } => {
            let (a, b) = match *cone {
                Cone::Full => (Vec2::default(), Vec2::default()),
                Cone::Narrow { start, end } => (start, end),
                Cone::Wide { middle, .. } => (middle, middle),
            };
            ([*center, *center + a * *radius, *center + b * *radius], *radius)
        }
    }
}
