//! The plane in which the machine works.

use super::pair::{EvidenceKind, Pair, PairKind};
use super::surface::{across, canonical, parallel, perpendicular};
use mainspring_geometry::{Csg, Primitive, Rigid3, Shape, Vec3};

/// Coordinates in which all motion is planar: z is the normal, and the origin is the machine's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkingPlane {
    pub plane_from_machine: Rigid3,
    /// In machine coordinates; its first component that is not zero is positive.
    pub normal: Vec3,
    /// Every turning axis is along the normal and every sliding axis across it.
    pub planar: bool,
}

impl WorkingPlane {
    pub(crate) fn across(normal: Vec3, planar: bool) -> Self {
        let (u, v) = across(normal);
        let machine_from_plane = Rigid3 { columns: [u, v, normal], translation: Vec3::default() };
        // The inverse of a rotation; its translation is zero without a sign.
        let plane_from_machine = Rigid3 { translation: Vec3::default(), ..machine_from_plane.inverse() };
        WorkingPlane { plane_from_machine, normal, planar }
    }
}

/// Chooses the normal: the one that suits most pairs; of equal ones that with most turning axes along it, then that
/// along which most parts are prisms, then z, then the first in the text. Cylindrical pairs suit along and across.
pub(crate) fn choose(pairs: &[Pair], primitives: &[Primitive], parts: &[&Csg]) -> WorkingPlane {
    let z = Vec3::new(0.0, 0.0, 1.0);
    let mut best: Option<([usize; 3], Vec3)> = None;
    for n in candidates(pairs) {
        let suits = pairs.iter().filter(|p| suits(p, n)).count();
        let along =
            pairs.iter().filter(|p| p.is_lower() && p.kind.turns() && parallel(p.axis.direction, n)).count();
        let prisms =
            parts.iter().filter(|c| c.leaves().all(|i| is_prism(&primitives[i as usize], n))).count();
        let score = [suits, along, prisms];
        if best.is_none_or(|(known, _)| score > known) {
            best = Some((score, n));
        }
    }
    let normal = best.map_or(z, |b| b.1);
    WorkingPlane::across(normal, is_planar(pairs, normal))
}

/// Does every pair turn about the normal or slide across it?
pub(crate) fn is_planar(pairs: &[Pair], normal: Vec3) -> bool {
    pairs.iter().all(|p| suits(p, normal))
}

fn suits(pair: &Pair, n: Vec3) -> bool {
    let d = pair.axis.direction;
    match pair.kind {
        PairKind::Revolute | PairKind::Gear => parallel(d, n),
        PairKind::Prismatic => perpendicular(d, n),
        PairKind::Cylindrical => parallel(d, n) || perpendicular(d, n),
        PairKind::Fixed => true,
    }
}

fn candidates(pairs: &[Pair]) -> Vec<Vec3> {
    let mut found = vec![Vec3::new(0.0, 0.0, 1.0)];
    let mut add = |n: Vec3| {
        if found.len() < 32 && !found.iter().any(|f| parallel(*f, n)) {
            found.push(canonical(n));
        }
    };
    pairs.iter().filter(|p| p.kind.turns()).for_each(|p| add(p.axis.direction));
    for pair in pairs.iter().filter(|p| p.kind == PairKind::Prismatic) {
        for evidence in &pair.evidence {
            if let EvidenceKind::SideFaces { normal, .. } = evidence.what {
                add(normal);
            }
        }
        let (u, v) = across(pair.axis.direction);
        add(u);
        add(v);
    }
    found
}

/// Is it a prism along `n`: all faces along or across it?
pub(crate) fn is_prism(primitive: &Primitive, n: Vec3) -> bool {
    let [x, y, z] = primitive.machine_from_local.columns;
    match primitive.shape {
        Shape::Block { .. } => parallel(x, n) || parallel(y, n) || parallel(z, n),
        Shape::Cylinder { .. } => parallel(z, n),
        Shape::Wedge { .. } => parallel(y, n),
        Shape::Cone { .. } | Shape::Sphere { .. } => false,
    }
}
