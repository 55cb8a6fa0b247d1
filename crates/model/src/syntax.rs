//! A model's text as parsed: definitions in postfix order, names not yet looked up.

use crate::description::SymmetryKind;
use crate::error::Place;
use crate::expression::Function;
use crate::shape_text::ShapeKind;
use mainspring_geometry::Axis;

/// A step of a definition in postfix order; indices into the lists of [`Syntax`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Op {
    Number(f64),
    Name(u32),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Call(Function, u32),
    Shape(u32),
    At(u32),
    Copies(u32),
    Union,
    Difference,
    Intersection,
}

/// Operations with the place of their operator, name or number.
pub(crate) type Ops = Vec<(Op, Place)>;

/// What an expression is, as far as its text alone tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Number,
    Solid,
    /// A bare name: whatever the name stands for.
    Name,
}

#[derive(Debug)]
pub(crate) struct Definition {
    pub name: u32,
    pub place: Place,
    pub kind: Kind,
    pub ops: Ops,
    pub range: Option<(f64, f64)>,
}

#[derive(Debug)]
pub(crate) struct Attribute {
    pub name: u32,
    pub place: Place,
    pub key: AttributeKey,
    pub value: Ops,
    pub value_place: Place,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AttributeKey {
    Frame,
    Gear,
    Teeth,
    Depth,
    Density,
}

impl AttributeKey {
    pub const NAMES: [(&'static str, Self); 5] = [
        ("frame", Self::Frame),
        ("gear", Self::Gear),
        ("teeth", Self::Teeth),
        ("depth", Self::Depth),
        ("density", Self::Density),
    ];

    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, k)| *k == self).map_or("", |(n, _)| n)
    }
}

#[derive(Debug)]
pub(crate) struct RawShape {
    pub kind: ShapeKind,
    pub sizes: [Option<Ops>; 3],
    pub place: Place,
    /// The solid in whose definition it stands.
    pub solid: u32,
}

#[derive(Debug)]
pub(crate) struct RawMotion {
    pub turns: bool,
    pub axis: Axis,
    pub amount: Ops,
}

#[derive(Debug)]
pub(crate) struct RawCopies {
    pub kind: SymmetryKind,
    pub axis: Axis,
    pub count: u32,
    pub range: Ops,
    pub place: Place,
}

/// A name with its spelling where it is first written.
#[derive(Debug)]
pub(crate) struct Name {
    pub text: String,
    /// Index of its definition.
    pub definition: Option<u32>,
    /// Where it stands in the generic's list.
    pub formal: Option<Place>,
}

/// A whole model file.
#[derive(Debug, Default)]
pub(crate) struct Syntax {
    pub generic: String,
    /// The generic's result and the place where it is named.
    pub result: (u32, Place),
    /// The other names of the generic's list.
    pub formals: Vec<u32>,
    /// Operands of the result's `asb`; none before the result is defined.
    pub parts: Option<Vec<(u32, Place)>>,
    pub names: Vec<Name>,
    pub definitions: Vec<Definition>,
    pub attributes: Vec<Attribute>,
    pub shapes: Vec<RawShape>,
    pub placements: Vec<Vec<RawMotion>>,
    pub copies: Vec<RawCopies>,
}
