//! Decides for every sub-edge whether it bounds the part, by evaluating the set expression just left and
//! just right of it. Primitives with a face along the sub-edge count by orientation, not by coordinates, so
//! a shaft that fills its hole leaves exactly nothing.

use crate::arrangement::{Arrangement, Budget};
use crate::classes::Classes;
use crate::section::{Face, Section};
use crate::tree::{Scratch, Sides, Tree};
use crate::{Curve, CurveId, OutlineError};
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
    /// The sections that reach through the slab.
    pub sections: Vec<&'a Section>,
}

impl Slab<'_> {
    /// The sub-edges of `arrangement` with material on one side only.
    pub fn boundary(
        &self,
        arrangement: &Arrangement,
        scratch: &mut Scratch,
        budget: &mut Budget,
    ) -> Result<Vec<BoundaryEdge>, OutlineError> {
        let index = self.index();
        let (mut given, mut active) = (Vec::new(), Vec::new());
        let mut edges = Vec::new();
        arrangement.visit(self.classes, |sub, along| {
            self.sides_along(sub.class, along, &mut given);
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
                let curves = self.curves_of(along, &active);
                edges.push(BoundaryEdge { class: sub.class, forward: sides.left, ends, curves });
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
    fn sides_along(&self, class: u32, along: &[u32], given: &mut Vec<(u32, Sides)>) {
        given.clear();
        let circle = matches!(self.classes.curves[class as usize], Curve::Circle { .. });
        for &face in along {
            let left = circle || self.classes.same_way[face as usize];
            given.push((self.faces[face as usize].id.primitive, Sides { left, right: !left }));
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

    fn curves_of(&self, along: &[u32], active: &[u32]) -> Vec<CurveId> {
        let ids = along.iter().map(|&f| self.faces[f as usize].id);
        let mut curves: Vec<_> = ids.filter(|id| active.binary_search(&id.primitive).is_ok()).collect();
        curves.sort_unstable();
        curves
    }
}
