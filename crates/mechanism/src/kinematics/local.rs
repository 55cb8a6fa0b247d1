//! A part as another part near it sees it: without the primitives that are far away.

use super::bounds::Bounds;
use super::fits::Solid;
use super::patch::{Scene, Site};
use super::region::with_leaves;
use mainspring_geometry::Csg;

/// Parts with fewer set operations are taken as they are.
const SMALL: usize = 32;

/// The set expression of what reaches into a zone; none if the part is small, or the work does not suffice.
pub(crate) fn nearby(scene: &Scene<'_>, solid: &Solid<'_>, zone: &Bounds) -> Option<Csg> {
    let operations = solid.site.csg.ops.len();
    let worth = operations > SMALL && scene.work.spend(operations / 8);
    worth.then(|| with_leaves(solid.site.csg, |i| scene.boxes[i as usize].touches(zone)))
}

/// The part with an expression that [`nearby`] made, and the surfaces of the primitives in the zone. Its box stays.
pub(crate) fn local<'a>(scene: &Scene<'_>, solid: &Solid<'_>, csg: &'a Csg, zone: &Bounds) -> Solid<'a> {
    let here = |primitive: u32| scene.boxes[primitive as usize].touches(zone);
    Solid {
        site: Site { csg },
        bounds: solid.bounds,
        laterals: solid.laterals.iter().filter(|l| here(l.id.primitive)).copied().collect(),
        faces: solid.faces.iter().filter(|f| here(f.id.primitive)).copied().collect(),
    }
}
