//! A balanced tree of discs in a body's local coordinates.

use mainspring_geometry::Vec2;

/// Room for so many nodes, or pairs of them, that wait to be looked at.
pub(crate) const PENDING: usize = 64;

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
        Self::over(items, 0..items.len() as u32)
    }

    /// A tree over some of the discs.
    pub fn over(items: &[(Vec2, f64)], chosen: impl IntoIterator<Item = u32>) -> Self {
        let mut leaves: Vec<Node> = chosen.into_iter().map(|i| Node::leaf(items[i as usize], i)).collect();
        let mut tree = Self { nodes: Vec::with_capacity(2 * leaves.len()) };
        if !leaves.is_empty() {
            tree.build(&mut leaves);
        }
        tree
    }

    fn build(&mut self, leaves: &mut [Node]) {
        let at = self.nodes.len();
        if let [only] = *leaves {
            self.nodes.push(only);
            return;
        }
        let mean = leaves.iter().fold(Vec2::default(), |s, n| s + n.center) * (1.0 / leaves.len() as f64);
        let radius = leaves.iter().map(|n| (n.center - mean).norm() + n.radius).fold(0.0, f64::max);
        self.nodes.push(Node { center: mean, radius, arm: mean.norm(), link: 0, leaf: false });
        let half = leaves.len() / 2;
        if is_wide(leaves) {
            part(leaves, half, |n| n.center.x);
        } else {
            part(leaves, half, |n| n.center.y);
        }
        let (first, second) = leaves.split_at_mut(half);
        self.build(first);
        self.nodes[at].link = self.nodes.len() as u32;
        self.build(second);
    }

    /// The children of an inner node.
    #[inline]
    pub fn children(&self, at: u32) -> [u32; 2] {
        [at + 1, self.nodes[at as usize].link]
    }

    /// The pairs of nodes that a pair, not both leaves, opens into: the larger node of the two is halved.
    #[inline]
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

/// Do centres reach as far along x as along y?
fn is_wide(leaves: &[Node]) -> bool {
    let (mut low, mut high) = (leaves[0].center, leaves[0].center);
    for n in leaves {
        low = Vec2::new(low.x.min(n.center.x), low.y.min(n.center.y));
        high = Vec2::new(high.x.max(n.center.x), high.y.max(n.center.y));
    }
    high.x - low.x >= high.y - low.y
}

/// Puts the leaves with the `half` least keys first.
fn part(leaves: &mut [Node], half: usize, key: impl Fn(&Node) -> f64) {
    leaves.select_nth_unstable_by(half, |m, n| key(m).total_cmp(&key(n)).then(m.link.cmp(&n.link)));
}
