//! What a machine consists of, in the words of its text.

use crate::error::Place;
use crate::expression::Expression;
use mainspring_geometry::{Axis, Csg, WallLayer};

/// A numeric definition; every one can be overridden.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// As first written.
    pub name: String,
    /// The value when nothing is overridden; none if it cannot be evaluated (see [`crate::Machine::values`]).
    pub default: Option<f64>,
    /// Least and greatest value allowed, both included.
    pub range: Option<(f64, f64)>,
    /// Only whole numbers are allowed, as for numbers of teeth.
    pub whole: bool,
    /// As written, for display; none if not given.
    pub unit: Option<String>,
    /// What it means, in one line; none if not given.
    pub meaning: Option<String>,
    pub place: Place,
}

/// A part: an operand of the result's `asb`.
#[derive(Clone, Debug, PartialEq)]
pub struct PartModel {
    /// As first written.
    pub name: String,
    /// The part's solid; leaves index the list of [`crate::Machine::primitives`].
    pub csg: Csg,
    pub is_frame: bool,
    pub density: Option<Density>,
    /// The layers of a part drawn by its boundaries; its primitives are their walls (see [`crate::Machine::at`]).
    pub walls: Option<Vec<WallLayer>>,
    /// Where the part is defined.
    pub place: Place,
}

/// Mass per volume in the file's units; evaluated by [`crate::Machine::density`].
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    pub value: Expression,
    pub place: Place,
}

/// An instance, inside a part, of a solid marked `gear = 1` (Gelsey 1995, Alg. 6): the motion envelope of a gear.
#[derive(Clone, Debug, PartialEq)]
pub struct Gear {
    /// Index of the part that contains it.
    pub part: usize,
    /// The cylinders of the marked solid, at least one.
    pub members: Vec<GearMember>,
    /// Number of teeth, if given; evaluated by [`crate::Machine::teeth`].
    pub teeth: Option<Expression>,
    /// Depth of the teeth in the file's length, if given; evaluated by [`crate::Machine::tooth_depth`].
    pub depth: Option<Expression>,
    /// The marked solid, as first written.
    pub name: String,
    /// Where the solid is marked.
    pub place: Place,
}

/// A cylinder of a gear's envelope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GearMember {
    /// Index of the primitive.
    pub primitive: u32,
    /// Adds material to the marked solid (it stands under an even number of right sides of `dif` in it).
    pub adds: bool,
}

/// How the copies of a symmetric union follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SymmetryKind {
    /// About the axis; the range is in degrees.
    Rotational,
    /// Along the axis; the range is in the file's length.
    Translational,
}

/// An instance of a `SYMMETRIC_UNION`: copies at k·range/count, k = 0 … count−1.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricUnion {
    /// Index of the part that contains it.
    pub part: usize,
    pub kind: SymmetryKind,
    /// Through the origin of the union's own coordinates (see [`crate::Machine::union_pose`]).
    pub axis: Axis,
    pub count: u32,
    /// Degrees or the file's length; evaluated by [`crate::Machine::evaluate`].
    pub range: Expression,
    /// The primitives it expands to, copy by copy: each copy has `primitives.len() / count` of them.
    pub primitives: Vec<u32>,
    pub place: Place,
    pub(crate) pose: u32,
}
