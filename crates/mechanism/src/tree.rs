//! A tree of discs over the features of a body, for finding those near another body. Features of one class are together:
//! most classes make no contact with themselves, and whole subtrees need no look.

use crate::feature::{Feature, FeatureShape};
use mainspring_geometry::Vec2;

/// A disc in the body's modelled coordinates, around one feature or two smaller nodes.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub center: Vec2,
    pub radius: f64,
    /// Index of the feature of a leaf, or of the second child (the first child follows its parent).
    pub link: usize,
    pub leaf: bool,
    /// Classes of the features below.
    classes: u8,
}

/// Classes of features, one bit each.
const CORNER: u8 = 1;
const EDGE: u8 = 2;
const ARC: u8 = 4;

impl Node {
    /// Could any feature below make contact with any below the other?
    #[inline]
    pub fn can_meet(&self, other: &Node) -> bool {
        let corner = self.classes & CORNER != 0 && other.classes & (EDGE | ARC) != 0;
        let edge = self.classes & EDGE != 0 && other.classes & (CORNER | ARC) != 0;
        corner || edge || (self.classes & ARC != 0)
    }
}

fn class(feature: &Feature) -> u8 {
    match feature.shape {
        FeatureShape::Edge { .. } => EDGE,
        FeatureShape::Round { radius: 0.0, .. } => CORNER,
        _ => ARC,
    }
}

/// Nodes in depth-first order; empty for a body without features.
#[derive(Clone, Debug, Default)]
pub struct FeatureTree {
    pub nodes: Vec<Node>,
}

impl FeatureTree {
    /// A balanced tree over the chosen features.
    pub fn new(features: &[Feature], mut chosen: Vec<usize>) -> Self {
        let mut tree = Self::default();
        if !chosen.is_empty() {
            tree.build(features, &mut chosen);
        }
        tree
    }

    fn build(&mut self, features: &[Feature], chosen: &mut [usize]) -> usize {
        let at = self.nodes.len();
        if let [only] = *chosen {
            let Feature { center, radius, .. } = features[only];
            self.nodes.push(Node { center, radius, link: only, leaf: true, classes: class(&features[only]) });
            return at;
        }
        let center = |i: usize| features[i].center;
        let mean = chosen.iter().fold(Vec2::default(), |s, &i| s + center(i)) * (1.0 / chosen.len() as f64);
        let reach = |i: usize| (center(i) - mean).norm() + features[i].radius;
        let radius = chosen.iter().map(|&i| reach(i)).fold(0.0, f64::max);
        let classes = chosen.iter().fold(0, |all, &i| all | class(&features[i]));
        self.nodes.push(Node { center: mean, radius, link: 0, leaf: false, classes });
        let half = if classes.is_power_of_two() {
            halve(features, chosen)
        } else {
            let first = 1 << classes.trailing_zeros();
            chosen.sort_by_key(|&i| (class(&features[i]), i));
            chosen.partition_point(|&i| class(&features[i]) == first)
        };
        let (first, second) = chosen.split_at_mut(half);
        self.build(features, first);
        self.nodes[at].link = self.build(features, second);
        at
    }
}

/// Parts features along the direction in which they lie further apart; returns how many are the first half.
fn halve(features: &[Feature], chosen: &mut [usize]) -> usize {
    let center = |i: usize| features[i].center;
    let spread = |key: fn(Vec2) -> f64| {
        let keys = chosen.iter().map(|&i| key(center(i)));
        keys.clone().fold(f64::MIN, f64::max) - keys.fold(f64::MAX, f64::min)
    };
    let key: fn(Vec2) -> f64 = if spread(|c| c.x) >= spread(|c| c.y) { |c| c.x } else { |c| c.y };
    let half = chosen.len() / 2;
    let order = |i: &usize, j: &usize| key(center(*i)).total_cmp(&key(center(*j))).then(i.cmp(j));
    chosen.select_nth_unstable_by(half, order);
    half
}
