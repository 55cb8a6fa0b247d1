//! Geometry of machines: points, rigid motions, solids, and planar outlines as exact recipes.

mod outline;
mod rigid;
mod scalar;
mod solid;
mod vector;

pub use outline::{CurveId, Edge, Layer, Loop, Outline, Segment, Turn};
pub use rigid::{Axis, Rigid3};
pub use scalar::Scalar;
pub use solid::{Csg, CsgOp, Primitive, Shape};
pub use vector::{Vec2, Vec3};
