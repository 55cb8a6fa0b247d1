//! Volume integrals of any solid by columns: exact along z, the midpoint rule across x and y.
//!
//! All primitives are convex, so a line meets each in one interval. The grid is doubled until volume and
//! second moments change by less than the accuracy asked for, or the work is spent.

use crate::moments::Moments;
use crate::tree::{Scratch, Sides, Tree};
use crate::{Bounds3, Primitive, Rigid3, Shape, Vec3};

/// Change from one grid to the next, relative to the largest moment, that ends the doubling.
const ACCURACY: f64 = 1e-4;
/// Column-primitive pairs that may be tried in all.
const WORK: usize = 60_000_000;
const FIRST_GRID: usize = 64;
const LAST_GRID: usize = 1024;

/// Moments about the middle of `bounds`, and their estimated relative error.
pub(crate) fn integrate(primitives: &[Primitive], tree: &Tree, bounds: &Bounds3) -> (Moments, f64) {
    let solids: Vec<_> = tree.primitives().map(|i| Body::of(i, &primitives[i as usize])).collect();
    let mut columns = Columns { tree, bounds, solids, scratch: Scratch::default(), spent: 0 };
    let (mut n, mut error) = (FIRST_GRID, 1.0);
    let mut moments = columns.grid(n);
    while error > ACCURACY && n < LAST_GRID && columns.spent.saturating_mul(5) < WORK {
        n *= 2;
        let finer = columns.grid(n);
        error = change(&moments, &finer);
        moments = finer;
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
    tree: &'a Tree,
    bounds: &'a Bounds3,
    solids: Vec<Body>,
    scratch: Scratch,
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
            let row: Vec<_> =
                self.solids.iter().filter(|s| s.bounds.min[0] < x && x < s.bounds.max[0]).copied().collect();
            let mut sum = Moments::default();
            for j in 0..n {
                let y = b.min[1] + (j as f64 + 0.5) * step[1];
                self.column(x, y, &row, &mut sum);
            }
            total.add(&sum);
        }
        let area = step[0] * step[1];
        total.zeroth *= area;
        total.first = total.first.map(|k| k * area);
        total.second = total.second.map(|r| r.map(|k| k * area));
        total
    }

    fn column(&mut self, x: f64, y: f64, row: &[Body], sum: &mut Moments) {
        self.spent += row.len().max(1);
        let near = row.iter().filter(|s| s.bounds.min[1] < y && y < s.bounds.max[1]);
        let hit = |s: &Body| Some((s.index, s.vertical(x, y)?));
        let spans: Vec<(u32, [f64; 2])> = near.filter_map(hit).collect();
        let mut stops: Vec<f64> = spans.iter().flat_map(|s| s.1).collect();
        stops.sort_by(f64::total_cmp);
        let c = [0, 1, 2].map(|k| 0.5 * (self.bounds.min[k] + self.bounds.max[k]));
        let point = Moments { zeroth: 1.0, ..Moments::default() }.moved([x - c[0], y - c[1], 0.0]);
        for w in stops.windows(2).filter(|w| w[0] < w[1]) {
            let z = 0.5 * (w[0] + w[1]);
            let inside = spans.iter().filter(|s| s.1[0] < z && z < s.1[1]);
            let given: Vec<_> = inside.map(|s| (s.0, Sides::BOTH)).collect();
            if self.tree.evaluate(&given, &mut self.scratch, &mut Vec::new()).left {
                sum.add(&point.extruded(w[0] - c[2], w[1] - c[2]));
            }
        }
    }
}

/// A primitive, its box and the way into its own coordinates.
#[derive(Clone, Copy)]
struct Body {
    index: u32,
    bounds: Bounds3,
    shape: Shape,
    local_from_machine: Rigid3,
}

impl Body {
    fn of(index: u32, primitive: &Primitive) -> Self {
        Self {
            index,
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
    let kept: Vec<_> = stops.windows(2).filter(inside).collect();
    Some([kept.first()?[0], kept.last()?[1]])
}
