//! Volume integrals of any solid by columns: exact along z, the midpoint rule across x and y.
//!
//! All primitives are convex, so a line meets each in one interval. The grid is doubled until volume and
//! second moments change by less than the accuracy asked for, or the work is spent.

use crate::moments::Moments;
use crate::tree::{Tree, Walk};
use crate::{Bounds3, Primitive, Rigid3, Shape, Vec3};

/// Change from one grid to the next, relative to the largest moment, that ends the doubling.
const ACCURACY: f64 = 1e-4;
/// Columns along each side of the first grid, if the work allows them; and of the smallest and the largest grid.
const FIRST_GRID: usize = 64;
const LEAST_GRID: usize = 8;
const LAST_GRID: usize = 1024;
/// Boxes passed by, and nodes of the set expression visited, that count as one unit of work.
const BOXES: usize = 16;
const NODES: usize = 8;

/// Moments about the middle of `bounds`, and their estimated relative error. One unit of `work` is one primitive
/// met by one column: about 60 nanoseconds. Two grids of [`LEAST_GRID`] are made in any case.
pub(crate) fn integrate(
    primitives: &[Primitive],
    tree: &Tree,
    bounds: &Bounds3,
    work: usize,
) -> (Moments, f64) {
    let solids: Vec<_> = tree.primitives().map(|i| Body::of(i, &primitives[i as usize], tree)).collect();
    // What the columns of one grid cost at most, each meeting everything.
    let affordable = |n: usize| n * n * (solids.len() + 1) * 5 <= work;
    let mut n = LEAST_GRID;
    while n < FIRST_GRID && affordable(2 * n) {
        n *= 2;
    }
    let mut columns =
        Columns { bounds, solids, walk: Walk::new(tree), row: Vec::new(), walls: Vec::new(), spent: 0 };
    let (mut error, mut moments) = (1.0, columns.grid(n));
    let mut first = true;
    while first || (error > ACCURACY && n < LAST_GRID && columns.spent.saturating_mul(5) < work) {
        n *= 2;
        let finer = columns.grid(n);
        error = change(&moments, &finer);
        (moments, first) = (finer, false);
    }
    (moments, error)
}

fn change(a: &Moments, b: &Moments) -> f64 {
    let volume = (a.zeroth - b.zeroth).abs() / b.zeroth.abs().max(f64::MIN_POSITIVE);
    let scale = (0..3).map(|i| b.second[i][i].abs()).fold(f64::MIN_POSITIVE, f64::max);
    let pairs = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    pairs.map(|(i, j)| (a.second[i][j] - b.second[i][j]).abs() / scale).fold(volume, f64::max)
}

struct Columns<'a> {
    bounds: &'a Bounds3,
    solids: Vec<Body<'a>>,
    walk: Walk<'a>,
    /// The solids that the row at hand may meet.
    row: Vec<u32>,
    /// Where the column at hand enters or leaves which solid.
    walls: Vec<(f64, u32)>,
    spent: usize,
}

impl Columns<'_> {
    /// With `n` columns along the longer and the shorter side each.
    fn grid(&mut self, n: usize) -> Moments {
        let b = *self.bounds;
        let step = [0, 1].map(|k| (b.max[k] - b.min[k]) / n as f64);
        let mut total = Moments::default();
        for i in 0..n {
            let x = b.min[0] + (i as f64 + 0.5) * step[0];
            let near = |s: &Body| s.bounds.min[0] < x && x < s.bounds.max[0];
            self.row.clear();
            self.row.extend((0u32..).zip(&self.solids).filter(|(_, s)| near(s)).map(|(k, _)| k));
            let mut sum = Moments::default();
            for j in 0..n {
                let y = b.min[1] + (j as f64 + 0.5) * step[1];
                self.column(x, y, &mut sum);
            }
            total.add(&sum);
        }
        let area = step[0] * step[1];
        total.zeroth *= area;
        total.first = total.first.map(|k| k * area);
        total.second = total.second.map(|r| r.map(|k| k * area));
        total
    }

    fn column(&mut self, x: f64, y: f64, sum: &mut Moments) {
        let Self { bounds, solids, walk, row, walls, spent } = self;
        walls.clear();
        for &k in row.iter() {
            let s = &solids[k as usize];
            if s.bounds.min[1] < y && y < s.bounds.max[1] {
                walls.extend(s.vertical(x, y).into_iter().flatten().map(|z| (z, k)));
                *spent += 1;
            }
        }
        walls.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let c = [0, 1, 2].map(|k| 0.5 * (bounds.min[k] + bounds.max[k]));
        let point = Moments { zeroth: 1.0, ..Moments::default() }.moved([x - c[0], y - c[1], 0.0]);
        let mut visited = 0;
        for (i, &(z, k)) in walls.iter().enumerate() {
            visited += walk.pass(solids[k as usize].leaves);
            let next = walls.get(i + 1).map_or(z, |w| w.0);
            if z < next && walk.inside() {
                sum.add(&point.extruded(z - c[2], next - c[2]));
            }
        }
        *spent += 1 + row.len() / BOXES + visited / NODES;
    }
}

/// A primitive, its box and the way into its own coordinates.
struct Body<'a> {
    leaves: &'a [u32],
    bounds: Bounds3,
    shape: Shape,
    local_from_machine: Rigid3,
}

impl<'a> Body<'a> {
    fn of(index: u32, primitive: &Primitive, tree: &'a Tree) -> Self {
        Self {
            leaves: tree.leaves_of(index),
            bounds: Bounds3::of(primitive, &Rigid3::identity()),
            shape: primitive.shape,
            local_from_machine: primitive.machine_from_local.inverse(),
        }
    }

    /// The heights between which the vertical line through (x, y) is inside.
    fn vertical(&self, x: f64, y: f64) -> Option<[f64; 2]> {
        let local = &self.local_from_machine;
        let (p, d) = (local.apply(Vec3::new(x, y, 0.0)), local.columns[2]);
        inside_along(self.shape, p, d)
    }
}

/// The parameters t between which p + t d is inside a shape.
fn inside_along(shape: Shape, p: Vec3, d: Vec3) -> Option<[f64; 2]> {
    let all = Some([f64::NEG_INFINITY, f64::INFINITY]);
    match shape {
        Shape::Block { x, y, z } => block(p, d, [x, y, z]),
        Shape::Wedge { x, y, z } => {
            half_space(block(p, d, [x, y, z]), p.x / x + p.z / z - 1.0, d.x / x + d.z / z)
        }
        Shape::Sphere { radius } => quadric(all, [d.dot(d), p.dot(d), p.dot(p) - radius * radius]),
        Shape::Cylinder { radius, height } => {
            let q = [d.x * d.x + d.y * d.y, p.x * d.x + p.y * d.y, p.x * p.x + p.y * p.y - radius * radius];
            quadric(slab(all, p.z, d.z, height), q)
        }
        Shape::Cone { radius, height } => {
            let (k, e) = (radius / height, height - p.z);
            let q = [
                d.x * d.x + d.y * d.y - k * k * d.z * d.z,
                p.x * d.x + p.y * d.y + k * k * e * d.z,
                p.x * p.x + p.y * p.y - k * k * e * e,
            ];
            quadric(slab(all, p.z, d.z, height), q)
        }
    }
}

/// Where f + t f′ ≤ 0.
fn half_space(span: Option<[f64; 2]>, f: f64, slope: f64) -> Option<[f64; 2]> {
    let [a, b] = span?;
    let t = -f / slope;
    let cut = if slope > 0.0 {
        [a, b.min(t)]
    } else if slope < 0.0 {
        [a.max(t), b]
    } else if f <= 0.0 {
        [a, b]
    } else {
        return None;
    };
    (cut[0] < cut[1]).then_some(cut)
}

/// Where 0 ≤ p + t d ≤ size.
fn slab(span: Option<[f64; 2]>, p: f64, d: f64, size: f64) -> Option<[f64; 2]> {
    half_space(half_space(span, -p, -d), p - size, d)
}

fn block(p: Vec3, d: Vec3, sizes: [f64; 3]) -> Option<[f64; 2]> {
    let start = Some([f64::NEG_INFINITY, f64::INFINITY]);
    [(p.x, d.x), (p.y, d.y), (p.z, d.z)]
        .iter()
        .zip(sizes)
        .fold(start, |s, (&(p, d), size)| slab(s, p, d, size))
}

/// Where q₀ t² + 2 q₁ t + q₂ ≤ 0 within a span on which that is one interval.
fn quadric(span: Option<[f64; 2]>, [a, b, c]: [f64; 3]) -> Option<[f64; 2]> {
    let [lo, hi] = span?;
    let root = (b * b - a * c).max(0.0).sqrt();
    // The root with the larger numerator first, so that none is a difference of nearly equal numbers.
    let s = -(b + if b < 0.0 { -root } else { root });
    let mut stops = [lo, s / a, c / s, hi].map(|t| if t.is_nan() { lo } else { t.clamp(lo, hi) });
    stops.sort_by(f64::total_cmp);
    let inside = |w: &&[f64]| {
        let t = match (w[0].is_finite(), w[1].is_finite()) {
            (true, true) => 0.5 * (w[0] + w[1]),
            (true, false) => w[0] + 1.0,
            (false, true) => w[1] - 1.0,
            _ => 0.0,
        };
        w[0] < w[1] && (a * t + 2.0 * b) * t + c <= 0.0
    };
    let first = stops.windows(2).find(inside)?;
    let last = stops.windows(2).rfind(inside)?;
    Some([first[0], last[1]])
}
