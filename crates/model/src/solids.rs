//! Solids as trees, and how large they become when named solids are expanded: counted, before anything is built.

use crate::error::{Fault, Read};
use crate::limits::{EXPANSION_STEPS, PRIMITIVES};
use crate::resolve::{Meaning, Resolved};
use crate::syntax::Op;

/// A node of a solid's tree; children are indices of nodes, other numbers as in [`Op`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Node {
    Shape(u32),
    /// A definition.
    Named(u32),
    At(u32, u32),
    Copies(u32, u32),
    Set(Op, u32, u32),
}

/// What a solid expands to.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Size {
    pub primitives: u64,
    /// Named solids entered, `at` groups and copies.
    pub steps: u64,
}

impl Size {
    fn plus(self, other: Self) -> Self {
        Self {
            primitives: self.primitives.saturating_add(other.primitives),
            steps: self.steps.saturating_add(other.steps),
        }
    }

    fn times(self, count: u32) -> Self {
        let count = u64::from(count);
        Self { primitives: self.primitives.saturating_mul(count), steps: self.steps.saturating_mul(count) }
    }

    fn step(self) -> Self {
        Self { steps: self.steps.saturating_add(1), ..self }
    }

    /// What is too large, if anything, in words.
    pub fn excess(self) -> Option<String> {
        if self.primitives > PRIMITIVES as u64 {
            let at_least = if self.primitives == u64::MAX { "at least " } else { "" };
            let count = self.primitives;
            return Some(format!(
                "{at_least}{count} primitives after expansion; expected at most {PRIMITIVES}"
            ));
        }
        let what = "steps of expansion (named solids, `at` groups, copies)";
        let steps = self.steps;
        (steps > EXPANSION_STEPS as u64)
            .then(|| format!("{steps} {what}; expected at most {EXPANSION_STEPS}"))
    }
}

/// The trees of all solids.
pub(crate) struct Solids {
    pub nodes: Vec<Node>,
    /// Root node of each definition; none for numbers.
    pub roots: Vec<Option<u32>>,
    pub sizes: Vec<Size>,
}

impl Solids {
    pub fn new(resolved: &Resolved) -> Read<Self> {
        let count = resolved.syntax.definitions.len();
        let mut solids =
            Self { nodes: Vec::new(), roots: vec![None; count], sizes: vec![Size::default(); count] };
        for &d in &resolved.order {
            let name = resolved.syntax.definitions[d as usize].name;
            if matches!(resolved.meanings[name as usize], Meaning::Solid(_)) {
                solids.add(resolved, d as usize)?;
            }
        }
        Ok(solids)
    }

    fn add(&mut self, resolved: &Resolved, d: usize) -> Read<()> {
        let definition = &resolved.syntax.definitions[d];
        let mut stack: Vec<(u32, Size)> = Vec::new();
        for (op, place) in &definition.ops {
            let mut pop =
                || stack.pop().ok_or_else(|| Fault::new(*place, "incomplete solid; expected a solid"));
            let (node, size) = match *op {
                Op::Shape(i) => (Node::Shape(i), Size { primitives: 1, steps: 0 }),
                Op::Name(name) => {
                    let other = resolved.solid(name, *place)?;
                    (Node::Named(other), self.sizes[other as usize].step())
                }
                Op::At(i) => {
                    let (child, size) = pop()?;
                    (Node::At(child, i), size.step())
                }
                Op::Copies(i) => {
                    let (child, size) = pop()?;
                    (Node::Copies(child, i), size.step().times(resolved.syntax.copies[i as usize].count))
                }
                Op::Union | Op::Difference | Op::Intersection => {
                    let ((right, b), (left, a)) = (pop()?, pop()?);
                    (Node::Set(*op, left, right), a.plus(b))
                }
                _ => return Err(Fault::new(*place, "a number where a solid belongs; expected a solid")),
            };
            stack.push((self.nodes.len() as u32, size));
            self.nodes.push(node);
        }
        // A part without a solid.
        let Some((root, size)) = stack.pop() else { return Ok(()) };
        if let Some(excess) = size.excess() {
            return Err(Fault::new(
                definition.place,
                format!("{} has {excess}", resolved.name(definition.name)),
            ));
        }
        (self.roots[d], self.sizes[d]) = (Some(root), size);
        Ok(())
    }

    /// What several definitions expand to together.
    pub fn total(&self, definitions: impl Iterator<Item = u32>) -> Size {
        definitions.fold(Size::default(), |sum, d| sum.plus(self.sizes[d as usize].step()))
    }
}
