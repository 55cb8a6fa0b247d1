//! Where a part's material lies near a place: membership of points, decided on surfaces by direction.
//!
//! A point on a surface has no side of its own. Every wall that coincides with the surface under examination (to a
//! tolerance) is judged by the direction in which one leaves the point, so that coincident surfaces of several
//! primitives are counted by orientation and never by rounding. Walls that only touch the surface along a line do
//! not coincide with it: they are judged by the sign of the distance.

use super::bounds::Bounds;
use super::surface::{faces, off_line, parallel};
use mainspring_geometry::{Csg, CsgOp, Primitive, Rigid3, Shape, Vec3};

/// Is there material just behind and just ahead of a point, seen along a direction?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sides {
    pub behind: bool,
    pub ahead: bool,
}

impl Sides {
    /// A surface with its material behind it.
    pub(crate) fn is_solid(self) -> bool {
        self.behind && !self.ahead
    }

    /// A surface with its material ahead of it.
    pub(crate) fn is_hollow(self) -> bool {
        !self.behind && self.ahead
    }
}

/// The surface on which points will be examined.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Carrier {
    /// None: points anywhere.
    Space,
    Plane,
    Cylinder {
        point: Vec3,
        direction: Vec3,
        radius: f64,
    },
}

/// The primitives of a part that reach into a box, and the set expression left of them.
pub(crate) struct Region {
    pub members: Vec<Member>,
    csg: Csg,
    tolerance: f64,
}

pub(crate) struct Member {
    pub shape: Shape,
    pub machine_from_local: Rigid3,
    local_from_machine: Rigid3,
    pub bounds: Bounds,
    /// Plane walls, and the round wall, may coincide with the carrier.
    coincide: [bool; 2],
}

impl Region {
    /// `boxes[i]` bounds primitive `i`; `tolerance` is a length below which walls coincide with the carrier.
    pub(crate) fn new(
        all: &[Primitive],
        csg: &Csg,
        boxes: &[Bounds],
        near: &Bounds,
        carrier: Carrier,
        tolerance: f64,
    ) -> Self {
        let near = near.grown(4.0 * tolerance);
        let mut members = Vec::new();
        let csg = reduced(csg, |i| {
            boxes[i as usize].touches(&near).then(|| {
                members.push(Member::new(&all[i as usize], boxes[i as usize], carrier, tolerance));
                members.len() as u32 - 1
            })
        });
        Region { members, csg, tolerance }
    }

    /// The region as points of the line `p + t w` (unit `w`) see it: without the members it passes by.
    pub(crate) fn along(&self, p: Vec3, w: Vec3) -> Thread<'_> {
        let meets = |i: u32| self.members[i as usize].bounds.meets_line(p, w, 4.0 * self.tolerance);
        Thread { region: self, csg: reduced(&self.csg, |i| meets(i).then_some(i)) }
    }

    /// Is there material along `from + t d`, 0 ≤ t ≤ `length`?
    pub(crate) fn crosses_material(&self, from: Vec3, d: Vec3, length: f64) -> bool {
        let mut cuts = vec![0.0, length];
        let thread = self.along(from, d);
        thread.crossings(from, d, &mut cuts);
        cuts.retain(|t| (0.0..=length).contains(t));
        cuts.sort_by(f64::total_cmp);
        let mut stack = Vec::new();
        cuts.windows(2).any(|c| {
            let middle = from + d * within(c[0], c[1]);
            c[1] - c[0] > self.tolerance && thread.inside(middle, d, &mut stack)
        })
    }
}

/// A region along a line.
pub(crate) struct Thread<'a> {
    region: &'a Region,
    csg: Csg,
}

impl Thread<'_> {
    /// Set operations that a question about a point costs.
    pub(crate) fn cost(&self) -> usize {
        self.csg.ops.len()
    }

    /// Is there material just off a point `p` of the line, in the unit direction `d`?
    pub(crate) fn inside(&self, p: Vec3, d: Vec3, stack: &mut Vec<bool>) -> bool {
        let Region { members, tolerance, .. } = self.region;
        self.csg.contains(|i| members[i as usize].holds(p, d, *tolerance), stack)
    }

    pub(crate) fn sides(&self, p: Vec3, normal: Vec3, stack: &mut Vec<bool>) -> Sides {
        Sides { behind: self.inside(p, -normal, stack), ahead: self.inside(p, normal, stack) }
    }

    /// Appends every t at which `p + t w` (unit `w`) passes a wall of a member that matters.
    pub(crate) fn crossings(&self, p: Vec3, w: Vec3, out: &mut Vec<f64>) {
        self.csg.leaves().for_each(|i| self.region.members[i as usize].crossings(p, w, out));
    }
}

/// The expression with absent leaves taken as empty, and leaves renumbered by `keep`.
fn reduced(csg: &Csg, mut keep: impl FnMut(u32) -> Option<u32>) -> Csg {
    let mut ops: Vec<CsgOp> = Vec::new();
    let mut stack: Vec<(usize, bool)> = Vec::new();
    for op in &csg.ops {
        if let CsgOp::Leaf(i) = *op {
            let kept = keep(i);
            stack.push((ops.len(), kept.is_some()));
            ops.extend(kept.map(CsgOp::Leaf));
            continue;
        }
        let (Some((start_b, b)), Some((start, a))) = (stack.pop(), stack.pop()) else { break };
        let left = match op {
            CsgOp::Union => a || b,
            CsgOp::Difference => a,
            _ => a && b,
        };
        match (a && b, left) {
            (true, _) => ops.push(*op),
            (false, true) if !b => ops.truncate(start_b),
            (false, true) => {}
            (false, false) => ops.truncate(start),
        }
        stack.push((start, left));
    }
    Csg { ops }
}

/// The expression with all leaves but some taken as empty.
pub(crate) fn with_leaves(csg: &Csg, keep: impl Fn(u32) -> bool) -> Csg {
    reduced(csg, |i| keep(i).then_some(i))
}

/// The expression with some leaves taken as empty; they are given in ascending order.
pub(crate) fn without_leaves(csg: &Csg, left_out: &[u32]) -> Csg {
    with_leaves(csg, |i| left_out.binary_search(&i).is_err())
}

/// Signed distance inside a wall (to first order), and its rate along a direction.
type Wall = (f64, f64);

impl Member {
    pub(crate) fn new(primitive: &Primitive, bounds: Bounds, carrier: Carrier, tolerance: f64) -> Self {
        let Primitive { shape, machine_from_local } = *primitive;
        let axis = machine_from_local.columns[2];
        let coincide = match (carrier, shape) {
            (Carrier::Space, _) => [false, false],
            (Carrier::Plane, _) => [true, false],
            (Carrier::Cylinder { point, direction, radius: r }, Shape::Cylinder { radius, .. }) => {
                let offset = off_line(machine_from_local.translation, point, direction);
                [false, parallel(axis, direction) && offset.max((radius - r).abs()) <= 2.0 * tolerance]
            }
            (Carrier::Cylinder { .. }, _) => [false, false],
        };
        let local_from_machine = machine_from_local.inverse();
        Member { shape, machine_from_local, local_from_machine, bounds, coincide }
    }

    fn holds(&self, p: Vec3, d: Vec3, tolerance: f64) -> bool {
        if !self.bounds.holds(p, tolerance) {
            return false;
        }
        // Most points are clearly inside or outside.
        let depth = self.depth(p);
        if depth.abs() > tolerance {
            return depth > 0.0;
        }
        let (walls, n) = self.walls(p, d);
        let round = match self.shape {
            Shape::Cylinder { .. } => 2,
            Shape::Cone { .. } => 1,
            Shape::Sphere { .. } => 0,
            Shape::Block { .. } | Shape::Wedge { .. } => n,
        };
        walls[..n].iter().enumerate().all(|(k, &(slack, rate))| {
            let by_direction = self.coincide[usize::from(k == round)] && slack.abs() <= tolerance;
            if by_direction { rate > 1e-9 } else { slack > 0.0 }
        })
    }

    /// Is the point inside or on the boundary, to the tolerance?
    pub(crate) fn reaches(&self, p: Vec3, tolerance: f64) -> bool {
        self.bounds.holds(p, tolerance) && self.depth(p) > -tolerance
    }

    /// Signed distance inside the nearest wall (to first order): the least slack of [`Member::walls`].
    fn depth(&self, p: Vec3) -> f64 {
        let q = self.local_from_machine.apply(p);
        match self.shape {
            Shape::Block { x, y, z } => q.x.min(x - q.x).min(q.y.min(y - q.y)).min(q.z.min(z - q.z)),
            Shape::Cylinder { radius, height } => {
                q.z.min(height - q.z).min(radius - (q.x * q.x + q.y * q.y).sqrt())
            }
            Shape::Cone { radius, height } => {
                let lateral = radius * (1.0 - q.z / height) - (q.x * q.x + q.y * q.y).sqrt();
                q.z.min(lateral * (height / radius.hypot(height)))
            }
            Shape::Sphere { radius } => radius - q.norm(),
            Shape::Wedge { x, y, z } => {
                let k = x * z / x.hypot(z);
                q.x.min(k * (1.0 - q.x / x - q.z / z)).min(q.y.min(y - q.y)).min(q.z)
            }
        }
    }

    fn walls(&self, p: Vec3, d: Vec3) -> ([Wall; 6], usize) {
        let (q, e) = (self.local_from_machine.apply(p), self.local_from_machine.rotate(d));
        let mut walls = [(0.0, 0.0); 6];
        let rho = (q.x * q.x + q.y * q.y).sqrt();
        let radial = if rho > 0.0 { (q.x * e.x + q.y * e.y) / rho } else { 0.0 };
        let n = match self.shape {
            Shape::Block { x, y, z } => {
                walls =
                    [(q.x, e.x), (x - q.x, -e.x), (q.y, e.y), (y - q.y, -e.y), (q.z, e.z), (z - q.z, -e.z)];
                6
            }
            Shape::Cylinder { radius, height } => {
                walls[..3].copy_from_slice(&[(q.z, e.z), (height - q.z, -e.z), (radius - rho, -radial)]);
                3
            }
            Shape::Cone { radius, height } => {
                let cos = height / radius.hypot(height);
                let lateral = radius * (1.0 - q.z / height) - rho;
                walls[..2]
                    .copy_from_slice(&[(q.z, e.z), (lateral * cos, (-radius / height * e.z - radial) * cos)]);
                2
            }
            Shape::Sphere { radius } => {
                let r = q.norm();
                walls[0] = (radius - r, if r > 0.0 { -q.dot(e) / r } else { 0.0 });
                1
            }
            Shape::Wedge { x, y, z } => {
                let k = x * z / x.hypot(z);
                walls[..5].copy_from_slice(&[
                    (q.x, e.x),
                    (k * (1.0 - q.x / x - q.z / z), -k * (e.x / x + e.z / z)),
                    (q.y, e.y),
                    (y - q.y, -e.y),
                    (q.z, e.z),
                ]);
                5
            }
        };
        (walls, n)
    }

    /// Its plane walls as (unit normal, a point).
    pub(crate) fn planes(&self) -> Vec<(Vec3, Vec3)> {
        let primitive = Primitive { shape: self.shape, machine_from_local: self.machine_from_local };
        faces(0, &primitive).into_iter().map(|f| (f.normal, f.middle)).collect()
    }

    /// Appends every t at which `p + t w` (unit `w`) passes one of its walls.
    pub(crate) fn crossings(&self, p: Vec3, w: Vec3, out: &mut Vec<f64>) {
        let (q, e) = (self.local_from_machine.apply(p), self.local_from_machine.rotate(w));
        let flat = |out: &mut Vec<f64>, slack: f64, rate: f64| {
            if rate.abs() > 1e-12 {
                out.push(-slack / rate);
            }
        };
        let (a, b, c, r) = match self.shape {
            Shape::Block { .. } | Shape::Wedge { .. } => {
                let (walls, n) = self.walls(p, w);
                walls[..n].iter().for_each(|&(slack, rate)| flat(out, slack, rate));
                return;
            }
            Shape::Cylinder { radius, height } => {
                flat(out, q.z, e.z);
                flat(out, height - q.z, -e.z);
                let (a, b) = (e.x * e.x + e.y * e.y, q.x * e.x + q.y * e.y);
                (a, b, q.x * q.x + q.y * q.y - radius * radius, radius)
            }
            Shape::Cone { radius, height } => {
                flat(out, q.z, e.z);
                let (r, k) = (radius * (1.0 - q.z / height), -radius / height * e.z);
                let (a, b) = (e.x * e.x + e.y * e.y - k * k, q.x * e.x + q.y * e.y - r * k);
                (a, b, q.x * q.x + q.y * q.y - r * r, radius)
            }
            Shape::Sphere { radius } => (1.0, q.dot(e), q.dot(q) - radius * radius, radius),
        };
        quadratic(a, b, c, a * r * r, out);
    }
}

/// Real roots of `a t² + 2 b t + c`; where they nearly coincide, as for a line that touches a circle, also the point
/// between them (found even if rounding leaves no root). `scale` is the size of the discriminant of a clear crossing.
fn quadratic(a: f64, b: f64, c: f64, scale: f64, out: &mut Vec<f64>) {
    let disc = b * b - a * c;
    if disc.abs() <= 1e-6 * scale.abs() && a.abs() > 1e-12 {
        out.push(-b / a);
    }
    if disc < 0.0 {
        return;
    }
    let s = -(b + disc.sqrt().copysign(b));
    if a.abs() > 1e-12 {
        out.push(s / a);
    }
    if s != 0.0 {
        out.push(c / s);
    }
}

/// A place within an interval that is not its middle: shapes are often symmetric, and what touches tends to touch
/// there.
pub(crate) fn within(from: f64, to: f64) -> f64 {
    from + 0.473_183_7 * (to - from)
}
