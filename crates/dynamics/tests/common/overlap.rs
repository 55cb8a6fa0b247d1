//! An overlap check without any pruning: every segment of one body against every segment of the other, in all
//! layers of common height. It knows nothing of features, gaps or candidates.

use mainspring_dynamics::Run;
use mainspring_geometry::{Layer, Segment, Vec2};
use mainspring_mechanism::{Body, Pose, System};
use std::f64::consts::TAU;

/// A placed segment.
#[derive(Clone, Copy)]
enum Piece {
    Line {
        from: Vec2,
        to: Vec2,
    },
    /// Counterclockwise over `sweep` from the angle `start`.
    Arc {
        center: Vec2,
        radius: f64,
        start: f64,
        sweep: f64,
    },
}

/// Boundary of one layer of a placed body.
struct Boundary {
    pieces: Vec<Piece>,
}

/// Greatest depth to which a boundary of one body lies inside another, over the run: at every step's time and at
/// `between` times inside every step. Returns depth and time.
pub fn deepest(system: &System, run: &Run, between: u32) -> (f64, f64) {
    let times = &run.trajectory.times;
    let mut worst = (0.0f64, 0.0);
    let mut look = |t: f64| {
        let q: Vec<f64> = (0..system.coordinates.len()).map(|i| run.trajectory.state(i, t).q).collect();
        let depth = depth_at(system, &q);
        if depth > worst.0 {
            worst = (depth, t);
        }
    };
    times.iter().for_each(|&t| look(t));
    for pair in times.windows(2) {
        for k in 1..=between {
            look(pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(between + 1));
        }
    }
    worst
}

/// Asserts that no part ever lies deeper in another than 1e-7 of the machine's size.
pub fn assert_never_overlaps(system: &System, run: &Run, between: u32) {
    let (depth, t) = deepest(system, run, between);
    assert!(depth <= 1e-7 * system.size, "overlap {depth:e} at t = {t}");
}

/// Most instants at which [`assert_free`] looks.
const INSTANTS: usize = 600;

/// Asserts the same at every step's time and half way to the next, or at [`INSTANTS`] of them spread over the run.
pub fn assert_free(system: &System, run: &Run) {
    let times = &run.trajectory.times;
    let halves = times.windows(2).map(|w| 0.5 * (w[0] + w[1]));
    let all: Vec<f64> = times.iter().copied().chain(halves).collect();
    let stride = all.len().div_ceil(INSTANTS).max(1);
    for &t in all.iter().step_by(stride) {
        let q: Vec<f64> = (0..system.coordinates.len()).map(|i| run.trajectory.state(i, t).q).collect();
        let depth = depth_at(system, &q);
        assert!(depth <= 1e-7 * system.size, "overlap {depth:e} at t = {t}");
    }
}

/// Greatest depth of any body's boundary inside any other body at positions `q`.
pub fn depth_at(system: &System, q: &[f64]) -> f64 {
    let bodies = &system.bodies;
    let mut worst = 0.0f64;
    for i in 0..bodies.len() {
        for j in i + 1..bodies.len() {
            if bodies[i].chain != bodies[j].chain {
                worst =
                    worst.max(depth_of((&bodies[i], &bodies[i].pose(q)), (&bodies[j], &bodies[j].pose(q))));
            }
        }
    }
    worst
}

fn depth_of(a: (&Body, &Pose), b: (&Body, &Pose)) -> f64 {
    let mut worst = 0.0f64;
    for la in &a.0.outline.layers {
        for lb in &b.0.outline.layers {
            if la.top.min(lb.top) - la.bottom.max(lb.bottom) <= 1e-9 {
                continue;
            }
            let (pa, pb) = (Boundary::new(la, a.1), Boundary::new(lb, b.1));
            worst = worst.max(pb.depth_of_boundary(&pa)).max(pa.depth_of_boundary(&pb));
        }
    }
    worst
}

impl Boundary {
    fn new(layer: &Layer, pose: &Pose) -> Self {
        let edges = layer.loops.iter().flat_map(|l| &l.edges);
        Self { pieces: edges.map(|e| Piece::new(&e.segment, pose)).collect() }
    }

    /// Every piece of the other boundary, cut where it crosses this one, tried at the middle of each part.
    fn depth_of_boundary(&self, other: &Boundary) -> f64 {
        let mut worst = 0.0f64;
        for piece in &other.pieces {
            let mut cuts = vec![0.0, 1.0];
            self.pieces.iter().for_each(|mine| piece.crossings(mine, &mut cuts));
            cuts.sort_by(f64::total_cmp);
            let middles = cuts.windows(2).map(|w| 0.5 * (w[0] + w[1]));
            for s in middles.chain([0.0, 0.5]) {
                worst = worst.max(self.depth(piece.at(s)));
            }
        }
        worst
    }

    /// How deep a point lies in the material; 0 outside.
    fn depth(&self, p: Vec2) -> f64 {
        let near = self.pieces.iter().map(|piece| piece.distance(p)).fold(f64::INFINITY, f64::min);
        // A ray in a direction that no drawing has meets no corner.
        let along = Vec2::new(0.617_283_945_1, 0.786_737_123_4);
        let count: usize = self.pieces.iter().map(|piece| piece.hits(p, along)).sum();
        if count % 2 == 1 { near } else { 0.0 }
    }
}

impl Piece {
    fn new(segment: &Segment, pose: &Pose) -> Self {
        match *segment {
            Segment::Line { from, to } => Piece::Line { from: pose.apply(from), to: pose.apply(to) },
            Segment::Circle { center, radius, .. } => {
                Piece::Arc { center: pose.apply(center), radius, start: 0.0, sweep: TAU }
            }
            Segment::Arc { from, to, center, radius, convex } => {
                let center = pose.apply(center);
                let angle = |p: Vec2| {
                    let d = pose.apply(p) - center;
                    d.y.atan2(d.x)
                };
                let (a, b) = if convex { (angle(from), angle(to)) } else { (angle(to), angle(from)) };
                Piece::Arc { center, radius, start: a, sweep: (b - a).rem_euclid(TAU) }
            }
        }
    }

    /// The point at parameter s in [0, 1].
    fn at(&self, s: f64) -> Vec2 {
        match *self {
            Piece::Line { from, to } => from + (to - from) * s,
            Piece::Arc { center, radius, start, sweep } => {
                let (sin, cos) = (start + sweep * s).sin_cos();
                center + Vec2::new(cos, sin) * radius
            }
        }
    }

    /// Parameter of a point on the piece's line or circle, if it lies within the piece.
    fn parameter(&self, p: Vec2) -> Option<f64> {
        let s = match *self {
            Piece::Line { from, to } => (p - from).dot(to - from) / (to - from).dot(to - from),
            Piece::Arc { center, start, sweep, .. } => {
                let d = p - center;
                (d.y.atan2(d.x) - start).rem_euclid(TAU) / sweep
            }
        };
        (0.0..=1.0).contains(&s).then_some(s)
    }

    fn distance(&self, p: Vec2) -> f64 {
        match *self {
            Piece::Line { from, to } => {
                let s = (p - from).dot(to - from) / (to - from).dot(to - from);
                (self.at(s.clamp(0.0, 1.0)) - p).norm().min((from - p).norm()).min((to - p).norm())
            }
            Piece::Arc { center, radius, .. } => {
                let ends = (self.at(0.0) - p).norm().min((self.at(1.0) - p).norm());
                match self.parameter(p) {
                    Some(_) => ends.min(((p - center).norm() - radius).abs()),
                    None => ends,
                }
            }
        }
    }

    /// How often a ray from `p` meets the piece.
    fn hits(&self, p: Vec2, along: Vec2) -> usize {
        match *self {
            Piece::Line { from, to } => {
                let (a, b) = (along.cross(from - p), along.cross(to - p));
                if (a > 0.0) == (b > 0.0) {
                    return 0;
                }
                let at = from + (to - from) * (a / (a - b));
                usize::from(along.dot(at - p) > 0.0)
            }
            Piece::Arc { center, radius, .. } => line_and_circle(p, along, center, radius)
                .iter()
                .filter(|&&s| s > 0.0 && self.parameter(p + along * s).is_some())
                .count(),
        }
    }

    /// Adds the parameters at which another piece crosses this one.
    fn crossings(&self, other: &Piece, cuts: &mut Vec<f64>) {
        let points: Vec<Vec2> = match (*self, *other) {
            (Piece::Line { from, to }, Piece::Line { from: a, to: b }) => {
                let turn = (to - from).cross(b - a);
                if turn == 0.0 {
                    return;
                }
                vec![from + (to - from) * ((a - from).cross(b - a) / turn)]
            }
            (Piece::Line { from, to }, Piece::Arc { center, radius, .. })
            | (Piece::Arc { center, radius, .. }, Piece::Line { from, to }) => {
                line_and_circle(from, to - from, center, radius)
                    .iter()
                    .map(|s| from + (to - from) * *s)
                    .collect()
            }
            (Piece::Arc { center: c, radius: r, .. }, Piece::Arc { center: d, radius: s, .. }) => {
                let between = d - c;
                let apart = between.norm();
                if apart == 0.0 {
                    return;
                }
                let x = (apart * apart + r * r - s * s) / (2.0 * apart);
                let y = (r * r - x * x).max(0.0).sqrt();
                let (along, across) = (between * (x / apart), between.perp() * (y / apart));
                vec![c + along + across, c + along - across]
            }
        };
        let slack = |p: &Vec2| other.distance(*p) < 1e-9 * (1.0 + p.norm());
        cuts.extend(points.iter().filter(|p| slack(p)).filter_map(|p| self.parameter(*p)));
    }
}

/// Parameters along `from + s · along` at which it meets a circle.
fn line_and_circle(from: Vec2, along: Vec2, center: Vec2, radius: f64) -> Vec<f64> {
    let d = from - center;
    let (a, b, c) = (along.dot(along), along.dot(d), d.dot(d) - radius * radius);
    let root = b * b - a * c;
    if root <= 0.0 {
        return vec![];
    }
    vec![(-b - root.sqrt()) / a, (-b + root.sqrt()) / a]
}
