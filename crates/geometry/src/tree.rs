//! A set expression as a tree that is evaluated sparsely: only what holds a point is visited.
//!
//! With a point outside every primitive every node is false, so evaluation starts at the primitives that
//! hold the point and climbs. Chains of the same operation are one node, so ten thousand unions stay flat.

use crate::{Bounds3, Csg, CsgOp};
use std::collections::{BTreeMap, BinaryHeap};

/// Membership just left and just right of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sides {
    pub left: bool,
    pub right: bool,
}

impl Sides {
    pub const BOTH: Self = Self { left: true, right: true };

    pub fn differ(self) -> bool {
        self.left != self.right
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    op: CsgOp,
    parent: u32,
    /// Operand of a difference that is taken away.
    removed: bool,
    /// Is the whole true where this node is and nothing beside the way up is?
    carries: bool,
    operands: u32,
}

impl Node {
    /// Its membership, from the numbers of operands that hold the point: those that add, and those taken away.
    fn holds(&self, [kept, removed]: [u32; 2]) -> bool {
        match self.op {
            CsgOp::Intersection => kept == self.operands,
            CsgOp::Difference => kept > 0 && removed == 0,
            _ => kept > 0,
        }
    }
}

/// Nodes ordered so that parents come before their operands; node 0 is the whole.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    leaves: BTreeMap<u32, Vec<u32>>,
}

/// Scratch space for [`Tree::evaluate`], reused between calls.
#[derive(Default)]
pub(crate) struct Scratch {
    counts: Vec<[u32; 4]>,
    value: Vec<Sides>,
    stamp: Vec<u32>,
    epoch: u32,
    heap: BinaryHeap<u32>,
    touched: Vec<u32>,
    varying: Vec<(u32, u32)>,
}

impl Tree {
    /// `None` if the postfix program is malformed. An empty program is the empty set.
    pub fn new(csg: &Csg) -> Option<Self> {
        let mut draft = Draft::default();
        for op in &csg.ops {
            draft.push(*op)?;
        }
        match draft.stack.len() {
            0 => Some(Self { nodes: Vec::new(), leaves: BTreeMap::new() }),
            1 => Some(draft.ordered()),
            _ => None,
        }
    }

    /// The primitives that can matter, in ascending order.
    pub fn primitives(&self) -> impl Iterator<Item = u32> + '_ {
        self.leaves.keys().copied()
    }

    /// The leaves of one primitive.
    pub fn leaves_of(&self, primitive: u32) -> &[u32] {
        self.leaves.get(&primitive).map_or(&[], |l| l)
    }

    /// A box about every node.
    fn boxes(&self, of: impl Fn(u32) -> Bounds3) -> Vec<Bounds3> {
        let start = |n: &Node| match n.op {
            CsgOp::Leaf(i) => of(i),
            CsgOp::Intersection => Bounds3 { min: [f64::NEG_INFINITY; 3], max: [f64::INFINITY; 3] },
            _ => Bounds3::EMPTY,
        };
        let mut boxes: Vec<_> = self.nodes.iter().map(start).collect();
        for n in (1..self.nodes.len()).rev() {
            let (node, up) = (self.nodes[n], self.nodes[n].parent as usize);
            if self.nodes[up].op == CsgOp::Intersection {
                boxes[up] = boxes[up].common(&boxes[n]);
            } else if !node.removed {
                boxes[up] = boxes[up].hull(&boxes[n]);
            }
        }
        boxes
    }

    /// A box about the whole set, given one about every primitive.
    pub fn bounds(&self, of: impl Fn(u32) -> Bounds3) -> Bounds3 {
        self.boxes(of).first().copied().unwrap_or(Bounds3::EMPTY)
    }

    /// Drops the leaves that reach nowhere deeper than `tolerance` (a length) into the region where their
    /// membership matters, such as a cutter beside what it cuts.
    pub fn prune(&mut self, of: impl Fn(u32) -> Bounds3, tolerance: f64) {
        let boxes = self.boxes(&of);
        let mut matters = boxes.clone();
        for n in 1..self.nodes.len() {
            let up = self.nodes[n].parent as usize;
            matters[n] = match self.nodes[up].op {
                CsgOp::Union => matters[up],
                _ => matters[up].common(&boxes[up]),
            };
        }
        for (primitive, leaves) in &mut self.leaves {
            let own = of(*primitive);
            leaves.retain(|&n| own.common(&matters[n as usize]).thickness() > tolerance);
        }
        self.leaves.retain(|_, leaves| !leaves.is_empty());
    }

    /// The whole's membership on both sides, given that of the primitives (those not given are outside).
    /// `active` receives the primitives whose boundary is the whole's boundary here.
    pub fn evaluate(&self, given: &[(u32, Sides)], s: &mut Scratch, active: &mut Vec<u32>) -> Sides {
        active.clear();
        s.begin(self.nodes.len());
        for &(primitive, sides) in given {
            for &leaf in self.leaves_of(primitive) {
                s.settle(self, leaf, sides);
                if sides.differ() {
                    s.varying.push((leaf, primitive));
                }
            }
        }
        let whole = self.climb(s);
        if whole.differ() {
            self.collect_active(s, active);
        }
        whole
    }

    /// Evaluates upwards from the leaves just settled. Once a single branch is left its fate is known: every
    /// operand that could still join is outside.
    fn climb(&self, s: &mut Scratch) -> Sides {
        while let Some(n) = s.heap.pop() {
            let node = &self.nodes[n as usize];
            let sides = s.combine(node, n);
            s.touched.push(n);
            if s.heap.is_empty() {
                s.value[n as usize] = sides;
                return if node.carries { sides } else { Sides::default() };
            }
            s.settle(self, n, sides);
        }
        s.root_value()
    }

    /// A leaf is active if it and everything above it differs between the sides. The node touched last
    /// stands for the whole.
    fn collect_active(&self, s: &mut Scratch, active: &mut Vec<u32>) {
        for &n in s.touched.iter().rev().skip(1) {
            let up = self.nodes[n as usize].parent as usize;
            if !s.value[up].differ() {
                s.value[n as usize] = Sides::default();
            }
        }
        for &(leaf, primitive) in &s.varying {
            let up = if leaf == 0 { 0 } else { self.nodes[leaf as usize].parent as usize };
            if s.value[up].differ() {
                active.push(primitive);
            }
        }
        active.sort_unstable();
        active.dedup();
    }
}

impl Scratch {
    fn begin(&mut self, nodes: usize) {
        if self.stamp.len() != nodes || self.epoch == u32::MAX {
            self.stamp = vec![0; nodes];
            self.counts = vec![[0; 4]; nodes];
            self.value = vec![Sides::default(); nodes];
            self.epoch = 0;
        }
        self.epoch += 1;
        self.touched.clear();
        self.varying.clear();
    }

    fn root_value(&self) -> Sides {
        if self.stamp.first() == Some(&self.epoch) { self.value[0] } else { Sides::default() }
    }

    fn combine(&self, node: &Node, n: u32) -> Sides {
        let c = self.counts[n as usize];
        Sides { left: node.holds([c[0], c[2]]), right: node.holds([c[1], c[3]]) }
    }

    /// Records a node's value and hands it to the parent.
    fn settle(&mut self, tree: &Tree, n: u32, sides: Sides) {
        let node = &tree.nodes[n as usize];
        self.value[n as usize] = sides;
        if n == 0 {
            self.stamp[0] = self.epoch;
            return;
        }
        if sides == Sides::default() {
            return;
        }
        let up = node.parent as usize;
        if self.stamp[up] != self.epoch {
            self.stamp[up] = self.epoch;
            self.counts[up] = [0; 4];
            self.heap.push(node.parent);
        }
        let base = if node.removed { 2 } else { 0 };
        self.counts[up][base] += u32::from(sides.left);
        self.counts[up][base + 1] += u32::from(sides.right);
    }
}

/// The whole's membership along a way that starts outside everything, kept up to date wall by wall: only nodes that
/// change are visited.
pub(crate) struct Walk<'a> {
    tree: &'a Tree,
    inside: Vec<bool>,
    /// Operands of every node that hold the point: those that add, and those taken away.
    held: Vec<[u32; 2]>,
}

impl<'a> Walk<'a> {
    pub fn new(tree: &'a Tree) -> Self {
        let nodes = tree.nodes.len();
        Self { tree, inside: vec![false; nodes], held: vec![[0; 2]; nodes] }
    }

    /// Passes the wall of a primitive, given its leaves; returns the number of nodes visited.
    pub fn pass(&mut self, leaves: &[u32]) -> usize {
        leaves.iter().map(|&leaf| self.flip(leaf as usize)).sum()
    }

    /// Is the point inside the whole?
    pub fn inside(&self) -> bool {
        self.inside.first() == Some(&true)
    }

    fn flip(&mut self, mut n: usize) -> usize {
        let mut visited = 1;
        loop {
            self.inside[n] = !self.inside[n];
            let node = &self.tree.nodes[n];
            if n == 0 {
                return visited;
            }
            let held = &mut self.held[node.parent as usize][usize::from(node.removed)];
            *held = if self.inside[n] { *held + 1 } else { *held - 1 };
            n = node.parent as usize;
            visited += 1;
            if self.inside[n] == self.tree.nodes[n].holds(self.held[n]) {
                return visited;
            }
        }
    }
}

/// The tree as it is built, in the order of the text.
#[derive(Default)]
struct Draft {
    ops: Vec<CsgOp>,
    operands: Vec<Vec<u32>>,
    stack: Vec<u32>,
}

impl Draft {
    fn push(&mut self, op: CsgOp) -> Option<()> {
        if matches!(op, CsgOp::Leaf(_)) {
            self.add(op, Vec::new());
            return Some(());
        }
        let (b, a) = (self.stack.pop()?, self.stack.pop()?);
        if self.ops[a as usize] == op {
            self.operands[a as usize].push(b);
            self.stack.push(a);
        } else {
            self.add(op, vec![a, b]);
        }
        Some(())
    }

    fn add(&mut self, op: CsgOp, operands: Vec<u32>) {
        self.stack.push(self.ops.len() as u32);
        self.ops.push(op);
        self.operands.push(operands);
    }

    /// Numbers the nodes breadth first.
    fn ordered(self) -> Tree {
        let mut nodes: Vec<Node> = Vec::with_capacity(self.ops.len());
        let mut queue = vec![(self.stack[0], 0, false)];
        let mut leaves: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let mut next = 0;
        while next < queue.len() {
            let (old, parent, removed) = queue[next];
            let (op, operands) = (self.ops[old as usize], &self.operands[old as usize]);
            if let CsgOp::Leaf(i) = op {
                leaves.entry(i).or_default().push(next as u32);
            }
            let carries = next == 0 || {
                let up: &Node = &nodes[parent as usize];
                up.carries && !removed && up.op != CsgOp::Intersection
            };
            nodes.push(Node { op, parent, removed, carries, operands: operands.len() as u32 });
            let difference = op == CsgOp::Difference;
            queue.extend(operands.iter().enumerate().map(|(k, &o)| (o, next as u32, difference && k > 0)));
            next += 1;
        }
        Tree { nodes, leaves }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All set expressions of one shape family, by the digits of a number.
    fn expression(mut code: u32, leaves: u32) -> Csg {
        let mut ops = vec![CsgOp::Leaf(0)];
        let mut digit = |n: u32| {
            let d = code % n;
            code = code / n + 7 * d;
            d
        };
        let op = |d| [CsgOp::Union, CsgOp::Difference, CsgOp::Intersection][d as usize];
        for i in 1..leaves {
            ops.push(CsgOp::Leaf(i));
            if digit(3) == 0 {
                ops.extend([CsgOp::Leaf(i / 2), op(digit(3))]);
            }
            ops.push(op(digit(3)));
        }
        Csg { ops }
    }

    #[test]
    fn evaluation_agrees_with_the_postfix_program() {
        let (mut scratch, mut active, mut stack) = (Scratch::default(), Vec::new(), Vec::new());
        let mut walked = Vec::new();
        for code in 0..3_000 {
            let csg = expression(code * 7919, 6);
            let tree = Tree::new(&csg).expect("well formed");
            for bits in 0..64u32 {
                let other = bits.wrapping_mul(2_654_435_761) >> 26;
                let side = |i: u32| Sides { left: bits >> i & 1 == 1, right: other >> i & 1 == 1 };
                let given: Vec<_> = (0..6).map(|i| (i, side(i))).collect();
                let found = tree.evaluate(&given, &mut scratch, &mut active);
                assert_eq!(found.left, csg.contains(|i| side(i).left, &mut stack), "{csg:?}");
                assert_eq!(found.right, csg.contains(|i| side(i).right, &mut stack), "{csg:?}");
                assert_eq!(active.is_empty(), !found.differ());
                assert!(active.iter().all(|&i| side(i).differ()));
                let mut walk = Walk::new(&tree);
                for pick in [|s: Sides| s.left, |s: Sides| s.left != s.right] {
                    (0..6).filter(|&i| pick(side(i))).for_each(|i| _ = walk.pass(tree.leaves_of(i)));
                    walked.push(walk.inside());
                }
                assert_eq!([found.left, found.right][..], walked);
                walked.clear();
            }
        }
    }

    #[test]
    fn malformed_programs_are_refused() {
        let new = |ops: &[CsgOp]| Tree::new(&Csg { ops: ops.to_vec() }).is_none();
        assert!(new(&[CsgOp::Union]));
        assert!(new(&[CsgOp::Leaf(0), CsgOp::Union]));
        assert!(new(&[CsgOp::Leaf(0), CsgOp::Leaf(1)]));
        assert!(!new(&[]));
    }
}
