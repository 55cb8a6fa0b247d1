//! Outlines given edge by edge: every edge is a lateral face of a primitive of its own, its *wall*.
//!
//! A straight wall is face 2 of a block whose local x axis runs from the edge's start to its end, the block on the
//! left; a round wall is face 0 of a cylinder whose local x axis points to the edge's start. So every corner is the
//! start of a wall and needs no common point of curves: it is exact where neighbours are tangent or in line, and
//! carries the derivatives of the point as it was written.

use crate::recipe::{Corner, EdgeRecipe, LayerRecipe, LoopRecipe, Placed};
use crate::section::is_upright;
use crate::{CurveId, OutlineError, OutlineRecipe, Primitive, Rigid3, Root, Segment, Shape, Turn};
use std::f64::consts::{PI, TAU};

/// Tangents closer than this (radians) agree: the kink is too flat to be a contact feature.
const SMOOTH: f64 = 1e-7;

/// One edge of a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wall {
    /// Index of the primitive that has it as a face.
    pub primitive: u32,
    /// Of a round wall: material inside the circle, run counterclockwise. True for straight walls.
    pub convex: bool,
}

/// A layer given by its walls, loop by loop, with material on the left. A loop of one wall is a whole circle.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WallLayer {
    pub loops: Vec<Vec<Wall>>,
}

impl OutlineRecipe {
    /// The recipe of an outline given by walls, layers from bottom to top. Whether the loops are simple and do not
    /// cross is not looked at: see [`crate::crossing`].
    ///
    /// # Errors
    /// [`OutlineError::NotPrismatic`] if the walls are not upright in the working plane, [`OutlineError::Malformed`]
    /// if a wall is neither block nor cylinder or is absent.
    pub fn of_walls(
        primitives: &[Primitive],
        layers: &[WallLayer],
        plane_from_machine: &Rigid3,
    ) -> Result<Self, OutlineError> {
        let walls = layers.iter().flat_map(|l| &l.loops).flatten();
        for wall in walls {
            check(primitives, wall.primitive, plane_from_machine)?;
        }
        let at = Placed { primitives, plane: plane_from_machine };
        let layers_of = |l: &WallLayer| layer(&at, l);
        Ok(Self {
            layers: layers.iter().filter_map(layers_of).collect(),
            csg: crate::Csg::default(),
            walls: Some(layers.to_vec()),
        })
    }
}

fn check(primitives: &[Primitive], index: u32, plane: &Rigid3) -> Result<(), OutlineError> {
    let malformed = OutlineError::Malformed { primitive: Some(index) };
    let primitive = primitives.get(index as usize).ok_or(malformed.clone())?;
    match primitive.shape {
        Shape::Block { .. } | Shape::Cylinder { .. } => {}
        _ => return Err(malformed),
    }
    let pose = plane.then_after(&primitive.machine_from_local);
    if is_upright(&pose, 2) {
        return Ok(());
    }
    Err(OutlineError::NotPrismatic { primitive: index, shape: "outline" })
}

fn layer(at: &Placed<'_, f64>, given: &WallLayer) -> Option<LayerRecipe> {
    let first = given.loops.first()?.first()?.primitive;
    let caps = match at.primitives[first as usize].shape {
        Shape::Block { .. } => [4, 5],
        _ => [1, 2],
    };
    let [bottom, top] = caps.map(|face| CurveId { primitive: first, face });
    Some(LayerRecipe { bottom, top, loops: given.loops.iter().map(|l| with_turns(at, l)).collect() })
}

fn with_turns(at: &Placed<'_, f64>, walls: &[Wall]) -> LoopRecipe {
    let mut recipe = LoopRecipe { edges: (0..walls.len()).map(|i| edge(at, walls, i)).collect() };
    let segments: Vec<Segment> = at.walk(&recipe).edges.into_iter().map(|e| e.segment).collect();
    let n = segments.len();
    if n > 1 {
        for (i, edge) in recipe.edges.iter_mut().enumerate() {
            edge.turn_at_start = turn(&segments[(i + n - 1) % n], &segments[i]);
        }
    }
    recipe
}

fn edge(at: &Placed<'_, f64>, walls: &[Wall], i: usize) -> EdgeRecipe {
    let curve = |w: Wall| match at.primitives[w.primitive as usize].shape {
        Shape::Block { .. } => CurveId { primitive: w.primitive, face: 2 },
        _ => CurveId { primitive: w.primitive, face: 0 },
    };
    let (own, before) = (curve(walls[i]), curve(walls[(i + walls.len() - 1) % walls.len()]));
    let start = (walls.len() > 1).then(|| {
        let root = if own < before { Root::Start } else { Root::End };
        Corner { curves: [own.min(before), own.max(before)], root }
    });
    EdgeRecipe {
        curve: own,
        aliases: vec![],
        forward: walls[i].convex,
        start,
        full_turn: false,
        turn_at_start: Turn::Smooth,
    }
}

/// How a boundary with material on the left turns from one segment to the next.
fn turn(before: &Segment, after: &Segment) -> Turn {
    let (d, e) = (before.tangent(1.0), after.tangent(0.0));
    if d.cross(e).abs() > SMOOTH {
        return if d.cross(e) > 0.0 { Turn::Convex } else { Turn::Concave };
    }
    if d.dot(e) > 0.0 {
        return Turn::Smooth;
    }
    // A cusp: the sides are told apart where they have left each other.
    let reach = 0.25 * before.length().min(after.length());
    let corner = after.start();
    let back = before.at(1.0 - reach / before.length()) - corner;
    let ahead = after.at(reach / after.length()) - corner;
    let wedge = back.y.atan2(back.x) - ahead.y.atan2(ahead.x);
    if wedge.rem_euclid(TAU) < PI { Turn::Convex } else { Turn::Concave }
}
