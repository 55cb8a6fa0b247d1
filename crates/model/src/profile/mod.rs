//! Parts drawn by their boundaries: loops of lines and arcs in layers, every number an expression.
//!
//! A loop is written point by point; [`draw`] evaluates it over any scalar, [`check`] says whether it bounds anything,
//! [`walls`] makes the primitives of which each edge is a face.

mod check;
mod draw;
mod fillet;
mod ring;
mod walls;

pub(crate) use walls::WallText;

use crate::error::Place;
use crate::expression::Expression;

/// The boundaries of a part.
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    /// As first written.
    pub part: String,
    pub layers: Vec<LayerText>,
    /// Where the origin of its coordinates lies, and by how many degrees they are turned.
    pub at: Option<Point>,
    pub turn: Option<Expression>,
}

pub(crate) type Point = [Expression; 2];

#[derive(Clone, Debug)]
pub(crate) struct LayerText {
    /// Bottom and top in the file's length; 0 and 1 if not given.
    pub z: Option<[Expression; 2]>,
    pub loops: Vec<LoopText>,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub(crate) struct LoopText {
    /// In words: `outer 1`, `inner 2`.
    pub name: String,
    pub hole: bool,
    pub shape: LoopShape,
    /// The whole loop again, turned about a point.
    pub copies: Option<Repeat>,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub(crate) enum LoopShape {
    Circle {
        center: Point,
        radius: Expression,
    },
    /// `repeat`: the path is one of several equal pieces around a point.
    Path {
        from: Point,
        from_fillet: Option<Expression>,
        edges: Vec<EdgeText>,
        repeat: Option<Repeat>,
    },
}

#[derive(Clone, Debug)]
pub(crate) struct Repeat {
    pub count: Expression,
    /// The origin if not given.
    pub about: Option<Point>,
}

/// A line or arc to a point; without the point back to the start of the loop.
#[derive(Clone, Debug)]
pub(crate) struct EdgeText {
    pub kind: EdgeKind,
    pub to: Option<Point>,
    /// Radius of the arc that rounds the corner at its end.
    pub fillet: Option<Expression>,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub(crate) enum EdgeKind {
    Line,
    /// By its radius: `left` turns counterclockwise, `large` sweeps more than half a turn.
    Radius {
        radius: Expression,
        left: bool,
        large: bool,
    },
    Center {
        center: Point,
        left: bool,
    },
}

impl EdgeText {
    pub fn word(&self) -> &'static str {
        if matches!(self.kind, EdgeKind::Line) { "line" } else { "arc" }
    }

    /// Everything written in it.
    pub fn expressions(&self) -> Vec<&Expression> {
        let mut all: Vec<&Expression> = self.to.iter().flatten().chain(&self.fillet).collect();
        match &self.kind {
            EdgeKind::Line => {}
            EdgeKind::Radius { radius, .. } => all.push(radius),
            EdgeKind::Center { center, .. } => all.extend(center),
        }
        all
    }
}

impl LoopText {
    /// Everything written in it.
    pub fn expressions(&self) -> Vec<&Expression> {
        let mut all: Vec<&Expression> = Vec::new();
        match &self.shape {
            LoopShape::Circle { center, radius } => {
                all.extend(center);
                all.push(radius);
            }
            LoopShape::Path { from, from_fillet, edges, .. } => {
                all.extend(from);
                all.extend(from_fillet);
                all.extend(edges.iter().flat_map(EdgeText::expressions));
            }
        }
        all.extend(self.repeats().flat_map(|r| std::iter::once(&r.count).chain(r.about.iter().flatten())));
        all
    }

    fn repeats(&self) -> impl Iterator<Item = &Repeat> {
        let inner = match &self.shape {
            LoopShape::Path { repeat, .. } => repeat.as_ref(),
            LoopShape::Circle { .. } => None,
        };
        self.copies.iter().chain(inner)
    }
}
