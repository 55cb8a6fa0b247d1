//! What a planar section looks like: layers of loops of lines and arcs, and the features of their boundary.
//!
//! Material lies to the **left** of every segment: outer loops run counterclockwise, holes clockwise.

use crate::{Scalar, Vec2};

/// A lateral surface of a primitive, seen in the plane as a line or a circle.
/// Order is the order of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CurveId {
    /// Index of the primitive in the machine.
    pub primitive: u32,
    /// Which face: of a block 0 −x, 1 +x, 2 −y, 3 +y, 4 −z, 5 +z (local); of a cylinder 0, its caps 1 (local z = 0)
    /// and 2.
    pub face: u8,
}

/// How the boundary turns at a corner, seen from the material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Sticks out: a contact feature.
    Convex,
    /// A notch: no feature of its own.
    Concave,
    /// Tangents agree: no feature of its own.
    Smooth,
}

/// A segment of a loop, from its start to the start of the next segment; material on the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment<S = f64> {
    Line {
        from: Vec2<S>,
        to: Vec2<S>,
    },
    /// `convex`: material inside the circle, run counterclockwise; else clockwise, material outside.
    Arc {
        from: Vec2<S>,
        to: Vec2<S>,
        center: Vec2<S>,
        radius: S,
        convex: bool,
    },
    /// A whole circle; `convex` as for arcs.
    Circle {
        center: Vec2<S>,
        radius: S,
        convex: bool,
    },
}

/// A segment with its identity.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge<S = f64> {
    pub segment: Segment<S>,
    /// The owner: of coincident curves the first in the text.
    pub curve: CurveId,
    /// The other curves that coincide with it here.
    pub aliases: Vec<CurveId>,
    /// Turn at the start of this segment (between the previous one and this).
    pub turn_at_start: Turn,
}

/// A closed boundary curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop<S = f64> {
    pub edges: Vec<Edge<S>>,
}

/// The section of a part in an interval of z (or of the working plane's normal).
#[derive(Clone, Debug, PartialEq)]
pub struct Layer<S = f64> {
    pub bottom: f64,
    pub top: f64,
    pub loops: Vec<Loop<S>>,
}

/// A part's planar outline: its layers from bottom to top, disjoint but for shared faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline<S = f64> {
    pub layers: Vec<Layer<S>>,
}

impl<S: Scalar> Segment<S> {
    /// Start point; for a whole circle the point at angle zero.
    pub fn start(&self) -> Vec2<S> {
        match *self {
            Segment::Line { from, .. } | Segment::Arc { from, .. } => from,
            Segment::Circle { center, radius, .. } => Vec2::new(center.x + radius, center.y),
        }
    }
}
