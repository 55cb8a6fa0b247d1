//! Solids: primitives with sizes and poses, and the set operations that make parts of them.

use crate::{Rigid3, Scalar};

/// A primitive's shape in its own coordinates; sizes in the file's length, all positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<S = f64> {
    /// `[0, x] × [0, y] × [0, z]`: a corner at the origin.
    Block { x: S, y: S, z: S },
    /// About the z axis, standing on z = 0.
    Cylinder { radius: S, height: S },
    /// About the z axis: base radius at z = 0, apex at z = height.
    Cone { radius: S, height: S },
    /// Centred at the origin.
    Sphere { radius: S },
    /// The half of a block below the plane from the edge (x, ·, 0) to the edge (0, ·, z).
    Wedge { x: S, y: S, z: S },
}

/// A shape placed in the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive<S = f64> {
    pub shape: Shape<S>,
    pub machine_from_local: Rigid3<S>,
}

impl<S: Scalar> Shape<S> {
    /// The word of the input language.
    pub fn name(&self) -> &'static str {
        match self {
            Shape::Block { .. } => "blo",
            Shape::Cylinder { .. } => "cyl",
            Shape::Cone { .. } => "con",
            Shape::Sphere { .. } => "sph",
            Shape::Wedge { .. } => "wed",
        }
    }

    /// The value without derivatives.
    pub fn re(&self) -> Shape<f64> {
        match *self {
            Shape::Block { x, y, z } => Shape::Block { x: x.re(), y: y.re(), z: z.re() },
            Shape::Cylinder { radius, height } => {
                Shape::Cylinder { radius: radius.re(), height: height.re() }
            }
            Shape::Cone { radius, height } => Shape::Cone { radius: radius.re(), height: height.re() },
            Shape::Sphere { radius } => Shape::Sphere { radius: radius.re() },
            Shape::Wedge { x, y, z } => Shape::Wedge { x: x.re(), y: y.re(), z: z.re() },
        }
    }
}

impl<S: Scalar> Primitive<S> {
    /// The value without derivatives.
    pub fn re(&self) -> Primitive<f64> {
        Primitive { shape: self.shape.re(), machine_from_local: self.machine_from_local.re() }
    }
}

/// One step of a set expression in postfix order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CsgOp {
    /// Index of a primitive.
    Leaf(u32),
    Union,
    Difference,
    Intersection,
}

/// A set expression over primitives in postfix order (flat, so that ten thousand unions need no deep stack).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Csg {
    pub ops: Vec<CsgOp>,
}

impl Csg {
    /// Is a point inside, given for each primitive whether the point is inside that one?
    /// `stack` is scratch space, reused between calls.
    pub fn contains(&self, inside: impl Fn(u32) -> bool, stack: &mut Vec<bool>) -> bool {
        stack.clear();
        for op in &self.ops {
            if let CsgOp::Leaf(i) = op {
                stack.push(inside(*i));
                continue;
            }
            let (Some(b), Some(a)) = (stack.pop(), stack.pop()) else { return false };
            stack.push(match op {
                CsgOp::Union => a || b,
                CsgOp::Difference => a && !b,
                _ => a && b,
            });
        }
        stack.pop().unwrap_or(false)
    }

    /// The primitives used, in the order of the text.
    pub fn leaves(&self) -> impl Iterator<Item = u32> + '_ {
        self.ops.iter().filter_map(|op| match op {
            CsgOp::Leaf(i) => Some(*i),
            _ => None,
        })
    }
}
