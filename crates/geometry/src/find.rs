//! Finds an outline recipe: slabs between caps, a planar boolean in each, equal neighbours joined.

use crate::arrangement::Arrangement;
use crate::budget::OutlineBudget;
use crate::chain::{Chainer, RawCorner, RawEdge, RawLoop};
use crate::classes::{Classes, Tolerance};
use crate::classify::Slab;
use crate::recipe::{Corner, EdgeRecipe, LayerRecipe, LoopRecipe};
use crate::section::{Face, Section};
use crate::tree::{Scratch, Tree};
use crate::{Bounds3, Csg, CurveId, OutlineError, OutlineRecipe, Primitive, Rigid3, Root, Turn, Vec2};
use std::collections::{BTreeMap, BTreeSet};

/// What counts as coincident, relative to the part's size; the wider ones are tried where features so close
/// to the tolerance give a contradictory boundary.
const COINCIDENT: [f64; 6] = [1e-9, 3e-9, 1e-8, 3e-8, 1e-7, 1e-6];

/// Positions are known to a few units in the last place of the greatest coordinate.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// How far a corner of the owners' curves may lie from the vertex, relative to the part's size: curves that
/// coincide within 1e-9 and meet others at a shallow angle move it by more than they differ.
const DRIFT: f64 = 1e-5;

impl OutlineRecipe {
    /// The outline of the part `csg` in the working plane, whose normal is z of `plane_from_machine`.
    /// Coincidences are judged with a tolerance of 1e-9 of the part's size.
    ///
    /// # Errors
    /// [`OutlineError::NotPrismatic`] names the first primitive that matters and has no planar section;
    /// the others say that the input is malformed, too complex or ambiguous.
    pub fn find(
        primitives: &[Primitive],
        csg: &Csg,
        plane_from_machine: &Rigid3,
    ) -> Result<Self, OutlineError> {
        Self::find_within(primitives, csg, plane_from_machine, &mut OutlineBudget::default())
    }

    /// As [`OutlineRecipe::find`], for one of several outlines that share an allowance of work.
    ///
    /// # Errors
    /// As [`OutlineRecipe::find`].
    pub fn find_within(
        primitives: &[Primitive],
        csg: &Csg,
        plane_from_machine: &Rigid3,
        budget: &mut OutlineBudget,
    ) -> Result<Self, OutlineError> {
        Self::find_at_scale(primitives, csg, plane_from_machine, 0.0, budget)
    }

    /// As [`OutlineRecipe::find_within`], with tolerances relative to at least `size` (file's length).
    pub(crate) fn find_at_scale(
        primitives: &[Primitive],
        csg: &Csg,
        plane_from_machine: &Rigid3,
        size: f64,
        budget: &mut OutlineBudget,
    ) -> Result<Self, OutlineError> {
        let tree = Tree::new(csg).ok_or(OutlineError::Malformed { primitive: None })?;
        let boxes = boxes(primitives, &tree, plane_from_machine)?;
        let bounds = tree.bounds(|i| boxes[&i]);
        let mut outcome = Ok(Vec::new());
        for relative in COINCIDENT {
            if bounds.is_empty() {
                break;
            }
            let length = relative * bounds.diagonal().max(size) + ROUNDING * bounds.reach();
            let center = Vec2::new(bounds.min[0] + bounds.max[0], bounds.min[1] + bounds.max[1]) * 0.5;
            let tolerance = Tolerance { length, angle: length / bounds.diagonal().max(size), center };
            let mut tree = tree.clone();
            tree.prune(|i| boxes[&i], length);
            outcome =
                Finder { primitives, plane: plane_from_machine, tree, tolerance, bounds }.layers(budget);
            if outcome != Err(OutlineError::Degenerate) {
                break;
            }
        }
        Ok(Self { layers: outcome?, csg: csg.clone(), walls: None })
    }
}

/// Boxes of all primitives used, after checking their numbers.
fn boxes(
    primitives: &[Primitive],
    tree: &Tree,
    plane: &Rigid3,
) -> Result<BTreeMap<u32, Bounds3>, OutlineError> {
    let of = |i: u32| {
        let known = primitives.get(i as usize).map(|p| Bounds3::of(p, plane));
        let usable = known.filter(|b| b.diagonal().is_finite() && b.reach().is_finite() && !b.is_empty());
        Ok((i, usable.ok_or(OutlineError::Malformed { primitive: Some(i) })?))
    };
    tree.primitives().map(of).collect()
}

/// One attempt at one tolerance.
struct Finder<'a> {
    primitives: &'a [Primitive],
    plane: &'a Rigid3,
    tree: Tree,
    tolerance: Tolerance,
    bounds: Bounds3,
}

/// The section of one slab, or of several equal ones on top of each other.
struct RawLayer {
    /// Indices of its lower and upper level.
    levels: [usize; 2],
    loops: Vec<RawLoop>,
}

type Finished = Result<LayerRecipe, OutlineError>;

/// All sections with their faces, ascending by primitive and face.
struct Sections {
    list: Vec<Section>,
    faces: Vec<Face>,
    /// First face of every section, and the end.
    first: Vec<usize>,
    classes: Classes,
}

impl Finder<'_> {
    fn layers(&self, budget: &mut OutlineBudget) -> Result<Vec<LayerRecipe>, OutlineError> {
        let sections = self.sections()?;
        let levels = levels(&sections.list, self.tolerance.length);
        let raw = self.raw_layers(&sections, &levels, budget)?;
        (0..raw.len()).map(|k| self.finish(k, &sections, &levels, &raw)).collect()
    }

    fn sections(&self) -> Result<Sections, OutlineError> {
        let mut list = Vec::new();
        for i in self.tree.primitives() {
            let primitive = &self.primitives[i as usize];
            let section = Section::of(i, primitive, self.plane);
            let shape = primitive.shape.name();
            let section = section.ok_or(OutlineError::NotPrismatic { primitive: i, shape })?;
            if section.thickness() > self.tolerance.length {
                list.push(section);
            }
        }
        let (mut faces, mut first) = (Vec::new(), vec![0]);
        for section in &list {
            let mut own = section.faces.clone();
            own.sort_unstable_by_key(|f| f.id);
            faces.extend(own);
            first.push(faces.len());
        }
        let classes = Classes::of(&faces, &self.tolerance);
        Ok(Sections { list, faces, first, classes })
    }

    /// The non-empty layers from bottom to top.
    fn raw_layers(
        &self,
        all: &Sections,
        levels: &[Level],
        budget: &mut OutlineBudget,
    ) -> Result<Vec<RawLayer>, OutlineError> {
        let mut scratch = Scratch::default();
        let mut layers: Vec<RawLayer> = Vec::new();
        for k in 1..levels.len() {
            let z = 0.5 * (levels[k - 1].z + levels[k].z);
            if z < self.bounds.min[2] || z > self.bounds.max[2] {
                continue;
            }
            let loops = self.slab(all, z, &mut scratch, budget)?;
            match layers.last_mut() {
                Some(below) if below.levels[1] == k - 1 && same_loops(&below.loops, &loops) => {
                    below.levels[1] = k;
                    unite_curves(&mut below.loops, &loops);
                }
                _ if loops.is_empty() => {}
                _ => layers.push(RawLayer { levels: [k - 1, k], loops }),
            }
        }
        Ok(layers)
    }

    /// The loops at height `z`.
    fn slab(
        &self,
        all: &Sections,
        z: f64,
        scratch: &mut Scratch,
        budget: &mut OutlineBudget,
    ) -> Result<Vec<RawLoop>, OutlineError> {
        let inside = |i: &usize| all.list[*i].z[0] < z && z < all.list[*i].z[1];
        let here: Vec<usize> = (0..all.list.len()).filter(inside).collect();
        let members: Vec<u32> =
            here.iter().flat_map(|&i| all.first[i] as u32..all.first[i + 1] as u32).collect();
        let arrangement = Arrangement::new(&all.faces, &members, &all.classes, &self.tolerance, budget)?;
        let slab = Slab {
            faces: &all.faces,
            classes: &all.classes,
            tree: &self.tree,
            tolerance: &self.tolerance,
            sections: here.iter().map(|&i| &all.list[i]).collect(),
        };
        let edges = slab.boundary(&arrangement, scratch, budget)?;
        let vertices = &arrangement.vertices;
        Chainer { vertices, classes: &all.classes, tolerance: &self.tolerance }.loops(&edges)
    }

    fn finish(&self, k: usize, all: &Sections, levels: &[Level], raw: &[RawLayer]) -> Finished {
        let layer = &raw[k];
        let loops = layer.loops.iter().map(|l| self.finish_loop(l, all)).collect::<Result<Vec<_>, _>>()?;
        let mut loops: Vec<_> = loops.into_iter().map(from_lowest_edge).collect();
        loops.sort_by(|a, b| a.edges.iter().map(edge_key).cmp(b.edges.iter().map(edge_key)));
        let meets = |other: Option<&RawLayer>, end: usize| {
            let beside = other.filter(|o| o.levels[1 - end] == layer.levels[end]);
            levels[layer.levels[end]].cap([Some(layer), beside])
        };
        let (bottom, top) = (meets(raw[..k].last(), 0), meets(raw.get(k + 1), 1));
        Ok(LayerRecipe { bottom, top, loops })
    }

    fn finish_loop(&self, raw: &RawLoop, all: &Sections) -> Result<LoopRecipe, OutlineError> {
        let edge = |i: usize| {
            let (edge, before) = (&raw[i], &raw[(i + raw.len() - 1) % raw.len()]);
            let owner = all.face(edge.curves[0]);
            let start = match edge.start {
                Some(corner) => Some(self.finish_corner(before, edge, &corner, all)?),
                None => None,
            };
            Ok(EdgeRecipe {
                curve: edge.curves[0],
                aliases: edge.curves[1..].to_vec(),
                forward: edge.forward == all.classes.same_way[owner],
                start,
                full_turn: edge.full_turn,
                turn_at_start: edge.start.map_or(Turn::Smooth, |s| s.turn),
            })
        };
        Ok(LoopRecipe { edges: (0..raw.len()).map(edge).collect::<Result<_, _>>()? })
    }

    /// The corner as a root of the owners' curves, which must give the same place.
    fn finish_corner(
        &self,
        before: &RawEdge,
        after: &RawEdge,
        corner: &RawCorner,
        all: &Sections,
    ) -> Result<Corner, OutlineError> {
        let mut curves = [before.curves[0], after.curves[0]];
        curves.sort_unstable();
        let [a, b] = curves.map(|id| &all.faces[all.face(id)].curve);
        let root = a.root_at(b, corner.at, corner.root == Root::Tangent);
        let off = (a.meet(b, root) - corner.at).norm();
        let size = self.tolerance.length / self.tolerance.angle;
        // Near their point of contact two curves run together over about the root of size times distance.
        let allowed = match root {
            Root::Tangent => 4.0 * (size * self.tolerance.length).sqrt(),
            _ => size * DRIFT,
        };
        if off <= allowed { Ok(Corner { curves, root }) } else { Err(OutlineError::Degenerate) }
    }
}

impl Sections {
    /// Index of the face with this name. Names come from `faces`, so it is always there.
    fn face(&self, id: CurveId) -> usize {
        self.faces.partition_point(|f| f.id < id)
    }
}

/// A height where caps lie.
struct Level {
    z: f64,
    caps: Vec<CurveId>,
}

impl Level {
    /// The first cap in the text, of a primitive that bounds one of the layers beside it if there is one.
    fn cap(&self, beside: [Option<&RawLayer>; 2]) -> CurveId {
        let bounding: BTreeSet<u32> = beside.into_iter().flatten().flat_map(RawLayer::primitives).collect();
        *self.caps.iter().find(|c| bounding.contains(&c.primitive)).unwrap_or(&self.caps[0])
    }
}

impl RawLayer {
    fn primitives(&self) -> impl Iterator<Item = u32> + '_ {
        self.loops.iter().flatten().flat_map(|e| &e.curves).map(|c| c.primitive)
    }
}

fn levels(sections: &[Section], tolerance: f64) -> Vec<Level> {
    let mut caps: Vec<(f64, CurveId)> =
        sections.iter().flat_map(|s| [0, 1].map(|k| (s.z[k], s.caps[k]))).collect();
    caps.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let level = |group: &[(f64, CurveId)]| {
        let mut caps: Vec<_> = group.iter().map(|c| c.1).collect();
        caps.sort_unstable();
        Level { z: group[0].0, caps }
    };
    caps.chunk_by(|a, b| b.0 - a.0 <= tolerance).map(level).collect()
}

fn same_loops(a: &[RawLoop], b: &[RawLoop]) -> bool {
    let same = |a: &RawLoop, b: &RawLoop| a.iter().map(RawEdge::key).eq(b.iter().map(RawEdge::key));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
}

fn unite_curves(below: &mut [RawLoop], above: &[RawLoop]) {
    for (a, b) in below.iter_mut().flatten().zip(above.iter().flatten()) {
        a.curves.extend(&b.curves);
        a.curves.sort_unstable();
        a.curves.dedup();
    }
}

fn edge_key(e: &EdgeRecipe) -> (CurveId, bool, Option<Corner>) {
    (e.curve, e.forward, e.start)
}

fn from_lowest_edge(mut l: LoopRecipe) -> LoopRecipe {
    let first = (0..l.edges.len()).min_by_key(|&i| edge_key(&l.edges[i])).unwrap_or(0);
    l.edges.rotate_left(first);
    l
}
