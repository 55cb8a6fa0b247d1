//! Geometry of machines: points, rigid motions, solids, and planar outlines as exact recipes.

mod arrangement;
mod bounds;
mod budget;
mod chain;
mod classes;
mod classify;
mod columns;
mod curve;
mod find;
mod flat_overlap;
mod mass;
mod measure;
mod moments;
mod outline;
mod overlap;
mod recipe;
mod rigid;
mod scalar;
mod section;
mod segment;
mod simple;
mod solid;
mod tree;
mod vector;
mod walls;

pub use bounds::Bounds3;
pub use budget::OutlineBudget;
pub use curve::{Curve, Root};
pub use mass::{
    MASS_WORK, MassProperties, mass_properties, mass_properties_of_outline, mass_properties_within,
};
pub use outline::{CurveId, Edge, Layer, Loop, Outline, Segment, Turn};
pub use overlap::{Overlap, Part, overlap, overlap_within};
pub use recipe::{Corner, EdgeRecipe, LayerRecipe, LoopRecipe, OutlineError, OutlineRecipe};
pub use rigid::{Axis, Rigid3};
pub use scalar::Scalar;
pub use simple::{Crossing, crossing};
pub use solid::{Csg, CsgOp, Primitive, Shape};
pub use vector::{Vec2, Vec3};
pub use walls::{Wall, WallLayer};
