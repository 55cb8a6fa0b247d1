//! A part's planar outline as an exact recipe: found once on numbers, evaluated over any scalar.

use crate::chain::segment_on;
use crate::section::cap_height;
use crate::{
    Csg, Curve, CurveId, Edge, Layer, Loop, Outline, Primitive, Rigid3, Root, Scalar, Shape, Turn, Vec2,
    Vec3, WallLayer, crossing,
};
use std::fmt;

/// A corner as a common point of two curves: one identity, however many primitives share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Corner {
    /// The owners of the edges that meet, the first in the text first.
    pub curves: [CurveId; 2],
    pub root: Root,
}

/// An edge of a recipe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EdgeRecipe {
    /// The owner: of coincident curves the first in the text.
    pub curve: CurveId,
    /// The other curves that bound the part along it, in the order of the text.
    pub aliases: Vec<CurveId>,
    /// Does the edge run in the owner's own direction, with the owner's primitive on the left? If not, the
    /// owner was cut away and the edge belongs to its hollow copy.
    pub forward: bool,
    /// Where it starts; `None` for a whole circle.
    pub start: Option<Corner>,
    /// An arc all the way round: it ends where it starts, though the corner there may be named by other
    /// curves than its start.
    pub full_turn: bool,
    pub turn_at_start: Turn,
}

/// A closed boundary curve of a recipe, material on the left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopRecipe {
    pub edges: Vec<EdgeRecipe>,
}

/// An interval of z with one and the same section.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayerRecipe {
    /// The cap that is the bottom. Caps are numbered as faces: of a block as lateral faces are, of a
    /// cylinder 1 at local z = 0 and 2 at local z = height.
    pub bottom: CurveId,
    pub top: CurveId,
    pub loops: Vec<LoopRecipe>,
}

/// Which curve of which primitive bounds a part where, and every corner as "this root of these two curves".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutlineRecipe {
    /// From bottom to top.
    pub layers: Vec<LayerRecipe>,
    pub(crate) csg: Csg,
    /// Given edge by edge, and not found from the set expression.
    pub(crate) walls: Option<Vec<WallLayer>>,
}

/// Why a part has no planar outline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OutlineError {
    /// A primitive that matters is no prism along the plane's normal.
    NotPrismatic { primitive: u32, shape: &'static str },
    /// Curves cross each other at more points, or more of them lie over and beside each other, than the
    /// [`OutlineBudget`](crate::OutlineBudget) allows; counted over all layers.
    TooComplex,
    /// The set expression is not well formed, or a primitive is missing or not made of finite numbers.
    Malformed { primitive: Option<u32> },
    /// Features so close to the tolerance that no consistent boundary was found.
    Degenerate,
}

impl fmt::Display for OutlineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotPrismatic { primitive, shape } => {
                write!(f, "primitive {primitive} ({shape}) is no prism along the normal of the working plane")
            }
            Self::TooComplex => write!(f, "too many curves cross each other in one plane"),
            Self::Malformed { primitive: Some(p) } => write!(f, "primitive {p} is absent or not finite"),
            Self::Malformed { primitive: None } => write!(f, "the set expression is not well formed"),
            Self::Degenerate => write!(f, "features too close to each other to tell inside from outside"),
        }
    }
}

impl std::error::Error for OutlineError {}

impl OutlineRecipe {
    /// The outline at other values of the same primitives, over any scalar: lines and circles from the
    /// primitives' faces, corners from the recipe's roots. A corner that no longer exists is not finite;
    /// see [`OutlineRecipe::holds_at`].
    ///
    /// # Panics
    /// If `primitives` is not the list the recipe was found on.
    pub fn evaluate<S: Scalar>(
        &self,
        primitives: &[Primitive<S>],
        plane_from_machine: &Rigid3<S>,
    ) -> Outline<S> {
        let at = Placed { primitives, plane: plane_from_machine };
        let layer = |l: &LayerRecipe| Layer {
            bottom: at.height(l.bottom).re(),
            top: at.height(l.top).re(),
            loops: l.loops.iter().map(|l| at.walk(l)).collect(),
        };
        Outline { layers: self.layers.iter().map(layer).collect() }
    }

    /// Bottom and top of every layer over any scalar, from the caps.
    ///
    /// # Panics
    /// As [`OutlineRecipe::evaluate`].
    pub fn heights<S: Scalar>(
        &self,
        primitives: &[Primitive<S>],
        plane_from_machine: &Rigid3<S>,
    ) -> Vec<[S; 2]> {
        let at = Placed { primitives, plane: plane_from_machine };
        self.layers.iter().map(|l| [at.height(l.bottom), at.height(l.top)]).collect()
    }

    /// Does the same order of features hold at other values? Found again there and compared; curves that
    /// merely coincide with an owner may come and go.
    pub fn holds_at(&self, primitives: &[Primitive], plane_from_machine: &Rigid3) -> bool {
        let Some(walls) = &self.walls else {
            return Self::find(primitives, &self.csg, plane_from_machine).is_ok_and(|o| self.same_order(&o));
        };
        let other = Self::of_walls(primitives, walls, plane_from_machine);
        let simple = |o: &Self| o.is_simple(primitives, plane_from_machine);
        other.is_ok_and(|o| self.same_order(&o) && simple(&o))
    }

    /// Do no two edges of a layer touch but where they follow each other?
    fn is_simple(&self, primitives: &[Primitive], plane: &Rigid3) -> bool {
        let outline = self.evaluate(primitives, plane);
        let tolerance = 1e-9 * outline.size();
        let segments = |l: &Loop| l.edges.iter().map(|e| e.segment).collect();
        outline.layers.iter().all(|l| {
            let loops: Vec<Vec<_>> = l.loops.iter().map(segments).collect();
            crossing(&loops, tolerance) == Ok(None)
        })
    }

    /// The same layers, loops, owners, corners and turns?
    pub fn same_order(&self, other: &Self) -> bool {
        let same_edge = |a: &EdgeRecipe, b: &EdgeRecipe| {
            (a.curve, a.forward, a.start, a.full_turn, a.turn_at_start)
                == (b.curve, b.forward, b.start, b.full_turn, b.turn_at_start)
        };
        let same_loop = |a: &LoopRecipe, b: &LoopRecipe| {
            a.edges.len() == b.edges.len() && a.edges.iter().zip(&b.edges).all(|(a, b)| same_edge(a, b))
        };
        let same_layer = |a: &LayerRecipe, b: &LayerRecipe| {
            (a.bottom, a.top, a.loops.len()) == (b.bottom, b.top, b.loops.len())
                && a.loops.iter().zip(&b.loops).all(|(a, b)| same_loop(a, b))
        };
        self.layers.len() == other.layers.len()
            && self.layers.iter().zip(&other.layers).all(|(a, b)| same_layer(a, b))
    }
}

/// Primitives at given values, seen from the working plane.
pub(crate) struct Placed<'a, S> {
    pub primitives: &'a [Primitive<S>],
    pub plane: &'a Rigid3<S>,
}

impl<S: Scalar> Placed<'_, S> {
    fn height(&self, cap: CurveId) -> S {
        cap_height(&self.primitives[cap.primitive as usize], cap.face, self.plane)
    }

    fn curve(&self, id: CurveId) -> Curve<S> {
        let curve = Curve::of(&self.primitives[id.primitive as usize], id.face, self.plane);
        curve.expect("the recipe was found on these primitives")
    }

    fn corner(&self, edge: &EdgeRecipe) -> Option<Vec2<S>> {
        let Corner { curves: [a, b], root } = edge.start?;
        if matches!(root, Root::Start | Root::End) {
            return Some(self.start_of(edge.curve));
        }
        Some(self.curve(a).meet(&self.curve(b), root))
    }

    /// Where a wall starts: at the block's origin, or where the cylinder's own x axis meets the circle.
    fn start_of(&self, wall: CurveId) -> Vec2<S> {
        let primitive = &self.primitives[wall.primitive as usize];
        let o = S::constant(0.0);
        let local = match primitive.shape {
            Shape::Cylinder { radius, .. } => Vec3::new(radius, o, o),
            _ => Vec3::new(o, o, o),
        };
        let p = self.plane.then_after(&primitive.machine_from_local).apply(local);
        Vec2::new(p.x, p.y)
    }

    pub(crate) fn walk(&self, recipe: &LoopRecipe) -> Loop<S> {
        let mut corners: Vec<_> = recipe.edges.iter().map(|e| self.corner(e)).collect();
        for (i, _) in recipe.edges.iter().enumerate().filter(|(_, e)| e.full_turn) {
            let next = (i + 1) % corners.len();
            corners[next] = corners[i];
        }
        let edge = |(i, e): (usize, &EdgeRecipe)| {
            let curve = self.curve(e.curve);
            let segment = match (corners[i], corners[(i + 1) % corners.len()], curve) {
                (Some(from), Some(to), _) => segment_on(&curve, e.forward, from, to),
                (_, _, Curve::Circle { center, radius }) => {
                    crate::Segment::Circle { center, radius, convex: e.forward }
                }
                (_, _, Curve::Line { point, .. }) => crate::Segment::Line { from: point, to: point },
            };
            Edge { segment, curve: e.curve, aliases: e.aliases.clone(), turn_at_start: e.turn_at_start }
        };
        Loop { edges: recipe.edges.iter().enumerate().map(edge).collect() }
    }
}
