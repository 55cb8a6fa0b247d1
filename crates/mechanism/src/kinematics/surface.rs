//! The surfaces of primitives that lower pairs are made of: cylinders and planes, anywhere in space.

use super::bounds::local_box;
use mainspring_geometry::{CurveId, Primitive, Shape, Vec3};

/// The curved surface of a cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lateral {
    pub id: CurveId,
    /// Middle of the cylinder's axis.
    pub middle: Vec3,
    /// Unit vector, sign as in [`canonical`].
    pub direction: Vec3,
    pub radius: f64,
    pub height: f64,
}

/// A plane face, by the rectangle around it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub id: CurveId,
    pub middle: Vec3,
    /// Unit normal out of the primitive.
    pub normal: Vec3,
    /// Half extents along two unit directions of the plane.
    pub along: [(Vec3, f64); 2],
}

impl Face {
    /// Of the rectangle around it.
    pub(crate) fn area(&self) -> f64 {
        4.0 * self.along[0].1 * self.along[1].1
    }

    pub(crate) fn corners(&self) -> [Vec3; 4] {
        let [(u, a), (v, b)] = self.along;
        [(-a, -b), (a, -b), (a, b), (-a, b)].map(|(s, t)| self.middle + u * s + v * t)
    }
}

/// The direction, or its opposite, whose first component that is not zero (beyond `1e-9`) is positive;
/// components that are rounding errors become exactly 0.
pub fn canonical(direction: Vec3) -> Vec3 {
    let clean = |c: f64| if c.abs() < 1e-12 { 0.0 } else { c };
    let d = Vec3::new(clean(direction.x), clean(direction.y), clean(direction.z));
    let first = [d.x, d.y, d.z].into_iter().find(|c| c.abs() > 1e-9).unwrap_or(1.0);
    let signed = if first < 0.0 { -d } else { d };
    Vec3::new(signed.x + 0.0, signed.y + 0.0, signed.z + 0.0)
}

/// The point nearest the origin on the line through `p` along the unit vector `d`; components below `noise`
/// become exactly 0.
pub(crate) fn foot(p: Vec3, d: Vec3, noise: f64) -> Vec3 {
    let f = p - d * p.dot(d);
    let clean = |c: f64| if c.abs() <= noise { 0.0 } else { c };
    Vec3::new(clean(f.x), clean(f.y), clean(f.z))
}

/// Two unit vectors at right angles to `d` and to each other; `(u, v, d)` is right-handed. `u` is the machine's
/// x direction, or y where `d` is near x, made perpendicular.
pub(crate) fn across(d: Vec3) -> (Vec3, Vec3) {
    let pick = if d.x.abs() < 0.9 { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.0, 1.0, 0.0) };
    let u = (pick - d * pick.dot(d)).unit();
    (u, d.cross(u))
}

pub(crate) fn parallel(a: Vec3, b: Vec3) -> bool {
    a.cross(b).norm() <= 1e-9
}

pub(crate) fn perpendicular(a: Vec3, b: Vec3) -> bool {
    a.dot(b).abs() <= 1e-9
}

/// Distance of a point from a line.
pub(crate) fn off_line(p: Vec3, on: Vec3, direction: Vec3) -> f64 {
    (p - on).cross(direction).norm()
}

pub(crate) fn lateral(index: u32, primitive: &Primitive) -> Option<Lateral> {
    let Shape::Cylinder { radius, height } = primitive.shape else { return None };
    let pose = &primitive.machine_from_local;
    Some(Lateral {
        id: CurveId { primitive: index, face: 0 },
        middle: pose.translation + pose.columns[2] * (0.5 * height),
        direction: canonical(pose.columns[2]),
        radius,
        height,
    })
}

/// The plane faces of a primitive. Numbers: of blocks and wedges as in [`CurveId`], with a wedge's slanted face
/// as 1; of cylinders and cones 1 for the base, 2 for the upper end.
pub(crate) fn faces(index: u32, primitive: &Primitive) -> Vec<Face> {
    let pose = &primitive.machine_from_local;
    let (low, high) = local_box(&primitive.shape);
    let half = (high - low) * 0.5;
    let center = (high + low) * 0.5;
    let [x, y, z] = pose.columns;
    let sides = [
        (x, half.x, (y, half.y), (z, half.z)),
        (y, half.y, (z, half.z), (x, half.x)),
        (z, half.z, (x, half.x), (y, half.y)),
    ];
    let face = |axis: usize, upper: bool, number: u8| {
        let (n, h, u, v) = sides[axis];
        let normal = if upper { n } else { -n };
        Face {
            id: CurveId { primitive: index, face: number },
            middle: pose.apply(center) + normal * h,
            normal,
            along: [u, v],
        }
    };
    match primitive.shape {
        Shape::Block { .. } => (0..6).map(|k| face(k / 2, k % 2 == 1, k as u8)).collect(),
        Shape::Cylinder { .. } => vec![face(2, false, 1), face(2, true, 2)],
        Shape::Cone { .. } => vec![face(2, false, 1)],
        Shape::Sphere { .. } => vec![],
        Shape::Wedge { x: a, z: c, .. } => {
            let slope = a.hypot(c);
            let slanted = Face {
                id: CurveId { primitive: index, face: 1 },
                middle: pose.apply(center),
                normal: (x * c + z * a) * (1.0 / slope),
                along: [((x * a - z * c) * (1.0 / slope), 0.5 * slope), (y, half.y)],
            };
            vec![face(0, false, 0), slanted, face(1, false, 2), face(1, true, 3), face(2, false, 4)]
        }
    }
}
