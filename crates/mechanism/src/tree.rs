//! A tree of discs over the features of a body, for finding those near another body.

use crate::feature::Feature;
use mainspring_geometry::Vec2;

/// A disc in the body's modelled coordinates, around one feature or two smaller nodes.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub center: Vec2,
    pub radius: f64,
    /// Index of the feature of a leaf, or of the second child (the first child follows its parent).
    pub link: usize,
    pub leaf: bool,
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
            self.nodes.push(Node { center, radius, link: only, leaf: true });
            return at;
        }
        let center = |i: usize| features[i].center;
        let mean = chosen.iter().fold(Vec2::default(), |s, &i| s + center(i)) * (1.0 / chosen.len() as f64);
        let reach = |i: usize| (center(i) - mean).norm() + features[i].radius;
        let radius = chosen.iter().map(|&i| reach(i)).fold(0.0, f64::max);
        self.nodes.push(Node { center: mean, radius, link: 0, leaf: false });
        let spread = |key: fn(Vec2) -> f64| {
            let keys = chosen.iter().map(|&i| key(center(i)));
            keys.clone().fold(f64::MIN, f64::max) - keys.fold(f64::MAX, f64::min)
        };
        let key: fn(Vec2) -> f64 = if spread(|c| c.x) >= spread(|c| c.y) { |c| c.x } else { |c| c.y };
        chosen.sort_by(|&i, &j| key(center(i)).total_cmp(&key(center(j))).then(i.cmp(&j)));
        let (first, second) = chosen.split_at_mut(chosen.len() / 2);
        self.build(features, first);
        self.nodes[at].link = self.build(features, second);
        at
    }
}
