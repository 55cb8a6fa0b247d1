//! A primitive as written: its word and the expressions of its sizes.

use crate::error::{Fault, Place, Read, number};
use crate::expression::Expression;
use mainspring_geometry::{Scalar, Shape};

/// The primitives of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShapeKind {
    Block,
    Cylinder,
    Cone,
    Sphere,
    Wedge,
}

impl ShapeKind {
    pub const NAMES: [(&'static str, Self); 5] = [
        ("blo", Self::Block),
        ("cyl", Self::Cylinder),
        ("con", Self::Cone),
        ("sph", Self::Sphere),
        ("wed", Self::Wedge),
    ];

    pub fn named(lower: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(n, _)| *n == lower).map(|(_, k)| *k)
    }

    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, k)| *k == self).map_or("", |(n, _)| n)
    }

    /// Names of the sizes in the order of [`ShapeText::sizes`]; `d` and `r` share the first slot.
    pub fn sizes(self) -> &'static [&'static str] {
        match self {
            Self::Block | Self::Wedge => &["x", "y", "z"],
            Self::Cylinder | Self::Cone => &["d", "h", "r"],
            Self::Sphere => &["d", "r"],
        }
    }
}

/// A primitive as written. Omitted sizes are 1; an omitted diameter is 1, so the radius 0.5.
#[derive(Clone, Debug)]
pub(crate) struct ShapeText {
    pub kind: ShapeKind,
    /// One for each name of [`ShapeKind::sizes`].
    pub sizes: [Option<Expression>; 3],
    pub place: Place,
    /// The solid in whose definition it stands, and its word: `tooth (blo)`.
    pub label: String,
}

impl ShapeText {
    /// The shape; every size is positive and finite.
    pub fn evaluate<S: Scalar>(&self, values: &[S]) -> Read<Shape<S>> {
        let size = |name: &str| self.size(name, values);
        Ok(match self.kind {
            ShapeKind::Block => Shape::Block { x: size("x")?, y: size("y")?, z: size("z")? },
            ShapeKind::Wedge => Shape::Wedge { x: size("x")?, y: size("y")?, z: size("z")? },
            ShapeKind::Cylinder => Shape::Cylinder { radius: self.radius(values)?, height: size("h")? },
            ShapeKind::Cone => Shape::Cone { radius: self.radius(values)?, height: size("h")? },
            ShapeKind::Sphere => Shape::Sphere { radius: self.radius(values)? },
        })
    }

    fn radius<S: Scalar>(&self, values: &[S]) -> Read<S> {
        if self.written("r").is_some() {
            return self.size("r", values);
        }
        let radius = self.size("d", values)? * 0.5;
        // Half of the least positive number is zero.
        if radius.re() > 0.0 { Ok(radius) } else { Err(self.not_positive("d", 0.0, self.place)) }
    }

    fn written(&self, name: &str) -> Option<&Expression> {
        let slot = self.kind.sizes().iter().position(|n| *n == name)?;
        self.sizes[slot].as_ref()
    }

    fn size<S: Scalar>(&self, name: &str, values: &[S]) -> Read<S> {
        let Some(expression) = self.written(name) else { return Ok(S::constant(1.0)) };
        let size = expression.evaluate(values)?;
        if size.re() > 0.0 { Ok(size) } else { Err(self.not_positive(name, size.re(), expression.place)) }
    }

    fn not_positive(&self, name: &str, size: f64, place: Place) -> Box<Fault> {
        Fault::new(
            place,
            format!("size {name} of {} is {}; expected a positive number", self.label, number(size)),
        )
    }
}
