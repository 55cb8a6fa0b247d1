//! Decides for every sub-edge whether it bounds the part, by evaluating the set expression just left and
//! just right of it. Primitives with a face along the sub-edge count by orientation, not by coordinates, so
//! a shaft that fills its hole leaves exactly nothing.

use crate::arrangement::{Along, Arrangement};
use crate::budget::OutlineBudget;
use crate::classes::{Classes, Tolerance};
use crate::section::{Face, Section};
use crate::tree::{Scratch, Sides, Tree};
use crate::{CurveId, OutlineError};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A sub-edge of the boundary.
#[derive(Clone, Debug)]
pub(crate) struct BoundaryEdge {
    pub class: u32,
    /// Runs in the class's own direction (material is always on the left)?
    pub forward: bool,
    /// Start and end vertex; `None` for a whole circle.
    pub ends: Option<[u32; 2]>,
    /// The curves that bound here, ascending.
    pub curves: Vec<CurveId>,
}

/// Everything of one slab that classification looks at.
pub(crate) struct Slab<'a> {
    pub faces: &'a [Face],
    pub classes: &'a Classes,
    pub tree: &'a Tree,
    pub tolerance: &'a Tolerance,
    /// The sections that reach through the slab.
    pub sections: Vec<&'a Section>,
}

impl Slab<'_> {
    /// The sub-edges of `arrangement` with material on one side only.
    pub fn boundary(
        &self,
        arrangement: &Arrangement,
        scratch: &mut Scratch,
        budget: &mut OutlineBudget,
    ) -> Result<Vec<BoundaryEdge>, OutlineError> {
        let index = self.index();
        let (mut given, mut active) = (Vec::new(), Vec::new());
        let mut edges = Vec::new();
        arrangement.visit(self.classes, self.tolerance, |sub, along| {
            self.sides_along(along, &mut given);
            let known = given.len();
            let p = sub.middle;
            for hit in index.locate_all_at_point([p.x, p.y]) {
                budget.spend_probes(1)?;
                let section = self.sections[hit.data as usize];
                let listed = given[..known].binary_search_by_key(&section.primitive, |g| g.0).is_ok();
                if !listed && section.contains(p) {
                    given.push((section.primitive, Sides::BOTH));
                }
            }
            budget.spend_probes(known)?;
            let sides = self.tree.evaluate(&given, scratch, &mut active);
            if sides.differ() {
                let mut ends = sub.ends;
                if let (false, Some(e)) = (sides.left, ends.as_mut()) {
                    e.reverse();
                }
                let (class, same_way, curves) = self.owner(along, &active);
                edges.push(BoundaryEdge { class, forward: sides.left == same_way, ends, curves });
            }
            Ok(())
        })?;
        Ok(edges)
    }

    fn index(&self) -> RTree<GeomWithData<Rectangle<[f64; 2]>, u32>> {
        let boxed = |s: &&Section| AABB::from_corners([s.min.x, s.min.y], [s.max.x, s.max.y]);
        let entry = |(i, s)| GeomWithData::new(Rectangle::from_aabb(boxed(s)), i);
        RTree::bulk_load((0u32..).zip(&self.sections).map(entry).collect())
    }

    /// Sides of the primitives with a face along the sub-edge, ascending by primitive.
    fn sides_along(&self, along: &[Along], given: &mut Vec<(u32, Sides)>) {
        given.clear();
        for &(face, same_way) in along {
            let Face { id, curve, .. } = &self.faces[face as usize];
            let left = (curve.is_circle() || self.classes.same_way[face as usize]) == same_way;
            given.push((id.primitive, Sides { left, right: !left }));
        }
        given.sort_unstable_by_key(|g| g.0);
        given.dedup_by(|later, kept| {
            let twice = later.0 == kept.0;
            if twice && later.1 != kept.1 {
                kept.1 = Sides::default();
            }
            twice
        });
    }

    /// The class of the first bounding face in the text, whether it runs the same way as the sub-edge, and
    /// all bounding curves of this class.
    fn owner(&self, along: &[Along], active: &[u32]) -> (u32, bool, Vec<CurveId>) {
        let bounds = |a: &&Along| active.binary_search(&self.faces[a.0 as usize].id.primitive).is_ok();
        let Some(&(first, same_way)) = along.iter().filter(bounds).min() else {
            return (0, true, Vec::new());
        };
        let class = self.classes.of[first as usize];
        let same_class = |a: &&Along| self.classes.of[a.0 as usize] == class;
        let ids = along.iter().filter(bounds).filter(same_class).map(|a| self.faces[a.0 as usize].id);
        let mut curves: Vec<_> = ids.collect();
        curves.sort_unstable();
        (class, same_way, curves)
    }
}
