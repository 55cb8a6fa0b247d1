//! Do two finished parts overlap? Touching is allowed.

use crate::tree::Tree;
use crate::{Bounds3, Csg, CsgOp, OutlineBudget, OutlineError, OutlineRecipe, Primitive, Rigid3, Vec2};

/// A finished part: primitives and the set expression over them.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    pub primitives: &'a [Primitive],
    pub csg: &'a Csg,
}

/// Where two parts overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// A point inside both, in the working plane, and its height.
    pub point: Vec2,
    pub height: f64,
    /// The greatest area common to both at one height.
    pub area: f64,
}

impl Part<'_> {
    /// The size to which tolerances are relative: the diagonal of its box. 0 if it is empty or malformed.
    pub fn size(&self, plane_from_machine: &Rigid3) -> f64 {
        let known = |i: u32| self.primitives.get(i as usize).map(|p| Bounds3::of(p, plane_from_machine));
        Tree::new(self.csg).map_or(0.0, |t| t.bounds(|i| known(i).unwrap_or(Bounds3::EMPTY)).diagonal())
    }
}

/// Where two parts, each with its own list of primitives, overlap with positive area over a positive height.
/// Thinner overlaps than 1e-9 of the larger part's size, such as touching surfaces, do not count.
///
/// # Errors
/// As [`OutlineRecipe::find`], for the region that both parts reach; a primitive's index in an error counts
/// on from the first part's list to the second's.
pub fn overlap(a: Part, b: Part, plane_from_machine: &Rigid3) -> Result<Option<Overlap>, OutlineError> {
    let size = a.size(plane_from_machine).max(b.size(plane_from_machine));
    overlap_within(a, b, plane_from_machine, size, &mut OutlineBudget::default())
}

/// As [`overlap`], for one of several questions that share an allowance of work; tolerances are relative to `size`
/// (file's length), so that parts may be given without what is far from the other.
///
/// # Errors
/// As [`overlap`].
pub fn overlap_within(
    a: Part,
    b: Part,
    plane_from_machine: &Rigid3,
    size: f64,
    budget: &mut OutlineBudget,
) -> Result<Option<Overlap>, OutlineError> {
    for (part, base) in [(a, 0), (b, a.primitives.len() as u32)] {
        let absent = part.csg.leaves().find(|&i| i as usize >= part.primitives.len());
        if let Some(i) = absent {
            return Err(OutlineError::Malformed { primitive: Some(i.saturating_add(base)) });
        }
    }
    let used = Used::of(a, b);
    let primitives = used.primitives(a, b);
    let both = used.intersection(a.csg, b.csg);
    let recipe = OutlineRecipe::find_at_scale(&primitives, &both, plane_from_machine, size, budget)
        .map_err(|e| used.named(e))?;
    let outline = recipe.evaluate(&primitives, plane_from_machine);
    let witness = outline.layers.iter().filter_map(|l| {
        let point = l.interior_point()?;
        Some(Overlap { point, height: 0.5 * (l.bottom + l.top), area: l.area() })
    });
    Ok(witness.max_by(|a, b| a.area.total_cmp(&b.area)))
}

/// The primitives that two parts use, ascending; those of the second count on from the first's list.
struct Used {
    indices: Vec<u32>,
    base: u32,
}

impl Used {
    fn of(a: Part, b: Part) -> Self {
        let base = a.primitives.len() as u32;
        let mut indices: Vec<u32> = a.csg.leaves().collect();
        indices.extend(b.csg.leaves().map(|i| i.saturating_add(base)));
        indices.sort_unstable();
        indices.dedup();
        Self { indices, base }
    }

    fn primitives(&self, a: Part, b: Part) -> Vec<Primitive> {
        let of = |&i: &u32| match i.checked_sub(self.base) {
            Some(i) => b.primitives[i as usize],
            None => a.primitives[i as usize],
        };
        self.indices.iter().map(of).collect()
    }

    /// The common part, over the primitives used.
    fn intersection(&self, a: &Csg, b: &Csg) -> Csg {
        if a.ops.is_empty() || b.ops.is_empty() {
            return Csg::default();
        }
        let moved = |ops: &[CsgOp], base: u32| -> Vec<CsgOp> {
            let place = |i: u32| self.indices.partition_point(|&k| k < i.saturating_add(base)) as u32;
            let op = |op: &CsgOp| match *op {
                CsgOp::Leaf(i) => CsgOp::Leaf(place(i)),
                op => op,
            };
            ops.iter().map(op).collect()
        };
        let mut ops = moved(&a.ops, 0);
        ops.extend(moved(&b.ops, self.base));
        ops.push(CsgOp::Intersection);
        Csg { ops }
    }

    /// An error in terms of the parts' own lists.
    fn named(&self, error: OutlineError) -> OutlineError {
        let name = |i: u32| self.indices.get(i as usize).copied().unwrap_or(i);
        match error {
            OutlineError::NotPrismatic { primitive, shape } => {
                OutlineError::NotPrismatic { primitive: name(primitive), shape }
            }
            OutlineError::Malformed { primitive } => {
                OutlineError::Malformed { primitive: primitive.map(name) }
            }
            other => other,
        }
    }
}
