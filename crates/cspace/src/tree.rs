//! A balanced tree of discs in a body's local coordinates.

use mainspring_geometry::Vec2;

/// A disc around one item or two smaller nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub center: Vec2,
    pub radius: f64,
    /// Distance of the centre from the body's origin, about which it turns.
    pub arm: f64,
    /// Item of a leaf, or the second child (the first follows its parent).
    pub link: u32,
    pub leaf: bool,
}

impl Node {
    pub fn leaf((center, radius): (Vec2, f64), item: u32) -> Self {
        Node { center, radius, arm: center.norm(), link: item, leaf: true }
    }
}

/// Nodes in depth-first order; empty without items.
#[derive(Clone, Debug, Default)]
pub(crate) struct Discs {
    pub nodes: Vec<Node>,
}

impl Discs {
    /// A tree over discs (centre, radius).
    pub fn new(items: &[(Vec2, f64)]) -> Self {
        Self::over(items, (0..items.len() as u32).collect())
    }

    /// A tree over some of the discs.
    pub fn over(items: &[(Vec2, f64)], mut chosen: Vec<u32>) -> Self {
        let mut tree = Self::default();
        if !chosen.is_empty() {
            tree.build(items, &mut chosen);
        }
        tree
    }

    fn build(&mut self, items: &[(Vec2, f64)], chosen: &mut [u32]) {
        let at = self.nodes.len();
        if let [only] = *chosen {
            self.nodes.push(Node::leaf(items[only as usize], only));
            return;
        }
        let center = |i: u32| items[i as usize].0;
        let mean = chosen.iter().fold(Vec2::default(), |s, &i| s + center(i)) * (1.0 / chosen.len() as f64);
        let radius =
            chosen.iter().map(|&i| (center(i) - mean).norm() + items[i as usize].1).fold(0.0, f64::max);
        self.nodes.push(Node { center: mean, radius, arm: mean.norm(), link: 0, leaf: false });
        let spread = |key: fn(Vec2) -> f64| {
            let keys = chosen.iter().map(|&i| key(center(i)));
            keys.clone().fold(f64::MIN, f64::max) - keys.fold(f64::MAX, f64::min)
        };
        let key: fn(Vec2) -> f64 = if spread(|c| c.x) >= spread(|c| c.y) { |c| c.x } else { |c| c.y };
        let half = chosen.len() / 2;
        chosen
            .select_nth_unstable_by(half, |&i, &j| key(center(i)).total_cmp(&key(center(j))).then(i.cmp(&j)));
        let (first, second) = chosen.split_at_mut(half);
        self.build(items, first);
        self.nodes[at].link = self.nodes.len() as u32;
        self.build(items, second);
    }

    /// The children of an inner node.
    pub fn children(&self, at: u32) -> [u32; 2] {
        [at + 1, self.nodes[at as usize].link]
    }

    /// The pairs of nodes that a pair, not both leaves, opens into: the larger node of the two is halved.
    pub fn halved(trees: [&Self; 2], (i, j): (u32, u32)) -> [(u32, u32); 2] {
        let (m, n) = (&trees[0].nodes[i as usize], &trees[1].nodes[j as usize]);
        if !m.leaf && (n.leaf || m.radius >= n.radius) {
            trees[0].children(i).map(|k| (k, j))
        } else {
            trees[1].children(j).map(|k| (i, k))
        }
    }

    /// Greatest value of the items under each node.
    pub fn greatest(&self, value: impl Fn(u32) -> f64) -> Vec<f64> {
        let mut found = vec![0.0; self.nodes.len()];
        for i in (0..self.nodes.len()).rev() {
            let node = &self.nodes[i];
            found[i] = if node.leaf {
                value(node.link)
            } else {
                let [a, b] = self.children(i as u32).map(|k| found[k as usize]);
                f64::max(a, b)
            };
        }
        found
    }
}
