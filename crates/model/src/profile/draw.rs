//! Evaluates boundaries over any scalar: every loop as a ring of segments with material on the left.

use super::ring::Loop;
use super::{LayerText, LoopShape, Point, Profile};
use crate::angle::sin_cos_degrees;
use crate::error::{Fault, Place, Read, number};
use crate::limits::PRIMITIVES;
use mainspring_geometry::{Scalar, Segment, Vec2};

/// Points that should be one may differ by this part of the loop's size.
pub(super) const SAME: f64 = 1e-9;

/// A layer at given values.
pub(crate) struct Drawn<S> {
    pub z: [S; 2],
    pub rings: Vec<Ring<S>>,
}

/// A loop at given values, material on the left.
pub(crate) struct Ring<S> {
    pub edges: Vec<DrawnEdge<S>>,
    /// Index of the loop in its layer, and which copy of it.
    pub text: usize,
    pub copy: u32,
}

#[derive(Clone, Copy)]
pub(crate) struct DrawnEdge<S> {
    pub segment: Segment<S>,
    /// Index of the written edge, and which of the repeated pieces; a fillet has those of the edge it ends.
    pub text: usize,
    pub piece: u32,
    pub fillet: bool,
}

impl Profile {
    /// All layers in the order of the text.
    pub fn draw<S: Scalar>(&self, values: &[S]) -> Read<Vec<Drawn<S>>> {
        let pose = self.pose(values)?;
        let mut edges = 0;
        self.layers.iter().map(|l| self.layer(l, values, &pose, &mut edges)).collect()
    }

    fn layer<S: Scalar>(
        &self,
        layer: &LayerText,
        values: &[S],
        pose: &Pose<S>,
        edges: &mut usize,
    ) -> Read<Drawn<S>> {
        let z = self.heights(layer, values)?;
        let mut rings = Vec::new();
        for (text, l) in layer.loops.iter().enumerate() {
            let of = Loop { part: &self.part, text: l, values };
            let copies = of.copies(l.copies.as_ref())?;
            let drawn = of.ring()?;
            *edges += drawn.len() * copies.len();
            if *edges > PRIMITIVES {
                let message = format!(
                    "part {}, {}: more than {PRIMITIVES} edges; expected at most as many",
                    self.part, l.name
                );
                return Err(Fault::new(l.place, message));
            }
            for (copy, turn) in (0u32..).zip(&copies) {
                let place = |e: &DrawnEdge<S>| DrawnEdge {
                    segment: moved(&e.segment, |p| pose.apply(turn.apply(p))),
                    ..*e
                };
                rings.push(Ring { edges: drawn.iter().map(place).collect(), text, copy });
            }
        }
        Ok(Drawn { z, rings })
    }

    fn heights<S: Scalar>(&self, layer: &LayerText, values: &[S]) -> Read<[S; 2]> {
        let z = match &layer.z {
            Some([bottom, top]) => [bottom.evaluate(values)?, top.evaluate(values)?],
            None => [S::constant(0.0), S::constant(1.0)],
        };
        if z[0].re() >= z[1].re() {
            let message = format!(
                "part {}: a layer from {} to {}; expected a top above the bottom",
                self.part,
                number(z[0].re()),
                number(z[1].re())
            );
            return Err(Fault::new(layer.place, message));
        }
        Ok(z)
    }

    fn pose<S: Scalar>(&self, values: &[S]) -> Read<Pose<S>> {
        let turn = self.turn.as_ref().map(|t| t.evaluate(values)).transpose()?;
        let (sin, cos) = turn.map_or((S::constant(0.0), S::constant(1.0)), sin_cos_degrees);
        let o = Vec2::new(S::constant(0.0), S::constant(0.0));
        let at = self.at.as_ref().map(|p| point(p, values)).transpose()?.unwrap_or(o);
        Ok(Pose { sin, cos, center: o, shift: at })
    }
}

/// A rotation about a point, then a shift.
pub(super) struct Pose<S> {
    sin: S,
    cos: S,
    center: Vec2<S>,
    shift: Vec2<S>,
}

impl<S: Scalar> Pose<S> {
    pub fn about(center: Vec2<S>, degrees: f64) -> Self {
        let (sin, cos) = sin_cos_degrees(degrees);
        let o = S::constant(0.0);
        Self { sin: S::constant(sin), cos: S::constant(cos), center, shift: Vec2::new(o, o) }
    }

    pub fn apply(&self, p: Vec2<S>) -> Vec2<S> {
        if self.sin.re() == 0.0 && self.cos.re() == 1.0 && S::NDERIV == 0 {
            return p + self.shift;
        }
        let d = p - self.center;
        let turned = Vec2::new(d.x * self.cos - d.y * self.sin, d.x * self.sin + d.y * self.cos);
        self.center + turned + self.shift
    }
}

fn moved<S: Scalar>(segment: &Segment<S>, place: impl Fn(Vec2<S>) -> Vec2<S>) -> Segment<S> {
    match *segment {
        Segment::Line { from, to } => Segment::Line { from: place(from), to: place(to) },
        Segment::Arc { from, to, center, radius, convex } => {
            Segment::Arc { from: place(from), to: place(to), center: place(center), radius, convex }
        }
        Segment::Circle { center, radius, convex } => {
            Segment::Circle { center: place(center), radius, convex }
        }
    }
}

pub(super) fn point<S: Scalar>(p: &Point, values: &[S]) -> Read<Vec2<S>> {
    Ok(Vec2::new(p[0].evaluate(values)?, p[1].evaluate(values)?))
}

/// The value without derivatives.
pub(super) fn real<S: Scalar>(segment: &Segment<S>) -> Segment {
    match *segment {
        Segment::Line { from, to } => Segment::Line { from: from.re(), to: to.re() },
        Segment::Arc { from, to, center, radius, convex } => {
            Segment::Arc { from: from.re(), to: to.re(), center: center.re(), radius: radius.re(), convex }
        }
        Segment::Circle { center, radius, convex } => {
            Segment::Circle { center: center.re(), radius: radius.re(), convex }
        }
    }
}

/// Where a loop of a part is written.
pub(super) fn place_of(profile: &Profile, layer: usize, text: usize, edge: Option<usize>) -> Place {
    let l = &profile.layers[layer].loops[text];
    match (edge, &l.shape) {
        (Some(i), LoopShape::Path { edges, .. }) => edges.get(i).map_or(l.place, |e| e.place),
        _ => l.place,
    }
}
