//! Do two finished parts overlap? Touching is allowed.

use crate::tree::Tree;
use crate::{Bounds3, Csg, CsgOp, OutlineError, OutlineRecipe, Primitive, Rigid3, Vec2};

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
    let primitives = [a.primitives, b.primitives].concat();
    let size = a.size(plane_from_machine).max(b.size(plane_from_machine));
    let both = intersection(a.csg, b.csg, a.primitives.len() as u32);
    let recipe = OutlineRecipe::find_at_scale(&primitives, &both, plane_from_machine, size)?;
    let outline = recipe.evaluate(&primitives, plane_from_machine);
    let witness = outline.layers.iter().filter_map(|l| {
        let point = l.interior_point()?;
        Some(Overlap { point, height: 0.5 * (l.bottom + l.top), area: l.area() })
    });
    Ok(witness.max_by(|a, b| a.area.total_cmp(&b.area)))
}

fn intersection(a: &Csg, b: &Csg, base: u32) -> Csg {
    let moved = b.ops.iter().map(|op| match *op {
        CsgOp::Leaf(i) => CsgOp::Leaf(i.saturating_add(base)),
        op => op,
    });
    let mut ops = a.ops.clone();
    ops.extend(moved);
    if a.ops.is_empty() || b.ops.is_empty() {
        return Csg::default();
    }
    ops.push(CsgOp::Intersection);
    Csg { ops }
}
