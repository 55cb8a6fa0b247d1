//! A primitive seen in the working plane: a rectangle or a disc over an interval of z.

use crate::curve::Curve;
use crate::{Bounds3, CurveId, Primitive, Rigid3, Scalar, Shape, Vec2, Vec3};

/// How far a primitive's axis may lean out of the plane's normal, in radians: rounding of the rotations
/// that placed it, no more.
const LEAN: f64 = 1e-9;

/// A lateral face: its curve and, of a line, the end points with the primitive to the left of the way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub id: CurveId,
    pub curve: Curve,
    /// `None` for a whole circle.
    pub ends: Option<[Vec2; 2]>,
}

/// A prismatic primitive in the coordinates of the working plane.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    pub primitive: u32,
    /// Heights of the lower and the upper cap, and their faces.
    pub z: [f64; 2],
    pub caps: [CurveId; 2],
    /// Lateral faces, in counterclockwise order.
    pub faces: Vec<Face>,
    /// Box in the plane.
    pub min: Vec2,
    pub max: Vec2,
}

impl Section {
    /// `None` if the primitive is not a prism along the plane's normal.
    pub fn of(index: u32, primitive: &Primitive, plane_from_machine: &Rigid3) -> Option<Self> {
        let pose = plane_from_machine.then_after(&primitive.machine_from_local);
        let upright = |k: usize| is_upright(&pose, k);
        let (caps, faces) = match primitive.shape {
            Shape::Block { .. } => {
                let axis = (0..3).find(|&k| upright(k))?;
                ([2 * axis as u8, 2 * axis as u8 + 1], lateral_faces_of_block(axis))
            }
            Shape::Cylinder { .. } if upright(2) => ([1, 2], vec![0]),
            _ => return None,
        };
        let id = |face| CurveId { primitive: index, face };
        let height = |face| cap_height(primitive, face, plane_from_machine);
        let mut caps = caps.map(|face| (height(face), id(face)));
        caps.sort_by(|a, b| a.0.total_cmp(&b.0));
        let curves = faces.iter().map(|&f| Some((id(f), Curve::of(primitive, f, plane_from_machine)?)));
        let curves = curves.collect::<Option<Vec<_>>>()?;
        let b = Bounds3::of(primitive, plane_from_machine);
        Some(Self {
            primitive: index,
            z: caps.map(|c| c.0),
            caps: caps.map(|c| c.1),
            faces: with_ends(&curves),
            min: Vec2::new(b.min[0], b.min[1]),
            max: Vec2::new(b.max[0], b.max[1]),
        })
    }

    /// Is a point of the plane strictly inside?
    pub fn contains(&self, p: Vec2) -> bool {
        self.faces.iter().all(|f| match f.curve {
            Curve::Line { point, normal } => normal.dot(p - point) < 0.0,
            Curve::Circle { center, radius } => (p - center).dot(p - center) < radius * radius,
        })
    }

    /// The least extent, of the plane section and along z.
    pub fn thickness(&self) -> f64 {
        let flat = match self.faces[..] {
            [Face { curve: Curve::Circle { radius, .. }, .. }] => 2.0 * radius,
            _ => {
                self.faces.iter().filter_map(|f| f.ends).map(|[a, b]| (b - a).norm()).fold(f64::MAX, f64::min)
            }
        };
        flat.min(self.z[1] - self.z[0])
    }
}

/// Is local axis `k` along the plane's normal?
pub(crate) fn is_upright(plane_from_local: &Rigid3, k: usize) -> bool {
    let axis = plane_from_local.columns[k];
    axis.x.hypot(axis.y) <= LEAN
}

/// The four lateral faces of a block whose caps are normal to local `axis`, around that axis.
fn lateral_faces_of_block(axis: usize) -> Vec<u8> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    vec![2 * v as u8, 2 * u as u8 + 1, 2 * v as u8 + 1, 2 * u as u8]
}

/// Adds the end points where neighbouring lines meet, and puts the lines in counterclockwise order.
fn with_ends(curves: &[(CurveId, Curve)]) -> Vec<Face> {
    if curves.len() < 4 {
        return curves.iter().map(|&(id, curve)| Face { id, curve, ends: None }).collect();
    }
    let mut curves = curves.to_vec();
    if let (Curve::Line { normal: a, .. }, Curve::Line { normal: b, .. }) = (curves[0].1, curves[1].1)
        && a.cross(b) < 0.0
    {
        curves.reverse();
    }
    let corner = |i: usize| curves[i % 4].1.meet(&curves[(i + 1) % 4].1, crate::Root::Only);
    let face =
        |i: usize| Face { id: curves[i].0, curve: curves[i].1, ends: Some([corner(i + 3), corner(i)]) };
    (0..4).map(face).collect()
}

/// The height of a cap over the working plane. Caps of a block are numbered as its faces; of a cylinder
/// 1 is the one on local z = 0 and 2 the other. Faces that are no caps give the height of the origin.
pub(crate) fn cap_height<S: Scalar>(primitive: &Primitive<S>, face: u8, plane: &Rigid3<S>) -> S {
    let mut local = [S::constant(0.0); 3];
    match primitive.shape {
        Shape::Block { x, y, z } if face % 2 == 1 && face < 6 => {
            let axis = usize::from(face / 2);
            local[axis] = [x, y, z][axis];
        }
        Shape::Cylinder { height, .. } if face == 2 => local[2] = height,
        _ => {}
    }
    let [x, y, z] = local;
    plane.then_after(&primitive.machine_from_local).apply(Vec3::new(x, y, z)).z
}
