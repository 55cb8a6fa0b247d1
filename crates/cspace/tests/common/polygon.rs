//! Do two outlines overlap? Asked of a library of polygons (i_overlay), which knows no arcs: they become polylines.
//!
//! A part lies between an inner and an outer polygon whose arcs run on either side of the true ones. Winding numbers make
//! that certain even where such polylines cross: each lens between an arc and its polyline takes one off, or adds one. If
//! the inner ones overlap so do the parts; if the outer ones do not, neither do the parts; else the arcs are cut finer. What
//! the finest polygons leave open is nearer to a contact than 4e-7.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::ShapeType;
use i_overlay::core::solver::Solver;
use i_overlay::float::relate::FloatPredicateOverlay;
use i_overlay::i_float::adapter::FloatPointAdapter;
use i_overlay::i_float::float::rect::FloatRect;
use mainspring_geometry::{Segment, Vec2};
use mainspring_mechanism::{Body, Pose};

/// Greatest distance of polylines from their arcs (lengths; parts have size 1), level by level.
const LEVELS: [f64; 4] = [3e-3, 1e-4, 4e-6, 1e-7];

type Contour = Vec<[f64; 2]>;

/// Inner and outer polygons of a layer, by level.
struct Levels {
    heights: (f64, f64),
    polygons: Vec<[Vec<Contour>; 2]>,
}

/// A body's layers as polygons, where it was modelled.
pub struct Polygons {
    layers: Vec<Levels>,
    radius: f64,
}

/// A segment without its end point; `outer` chooses the side away from the material.
fn polyline(segment: &Segment, outer: bool, off: f64, out: &mut Contour) {
    let (center, radius, convex, start, sweep) = match *segment {
        Segment::Line { from, .. } => {
            out.push([from.x, from.y]);
            return;
        }
        Segment::Arc { from, to, center, radius, convex } => {
            let angle = |p: Vec2| (p.y - center.y).atan2(p.x - center.x);
            let turn = angle(to) - angle(from);
            let tau = std::f64::consts::TAU;
            let sweep = if convex { turn.rem_euclid(tau) } else { -(-turn).rem_euclid(tau) };
            out.push([from.x, from.y]);
            (center, radius, convex, angle(from), sweep)
        }
        Segment::Circle { center, radius, convex } => {
            let sweep = if convex { std::f64::consts::TAU } else { -std::f64::consts::TAU };
            (center, radius, convex, 0.0, sweep)
        }
    };
    let whole = matches!(segment, Segment::Circle { .. });
    // A chord of angle δ is r(1 − cos δ/2) off.
    let delta = 2.0 * (1.0 - (off / radius).min(0.2)).acos();
    let n = (sweep.abs() / delta).ceil().max(3.0);
    let step = sweep / n;
    let tangents = outer == convex;
    let (first, r) = if tangents { (0.5, radius / (0.5 * step).cos()) } else { (1.0, radius) };
    let count = if tangents || whole { n as usize } else { n as usize - 1 };
    out.extend((0..count).map(|k| {
        let a = start + (first + k as f64) * step;
        [center.x + r * a.cos(), center.y + r * a.sin()]
    }));
}

impl Polygons {
    pub fn new(body: &Body) -> Self {
        let layers: Vec<Levels> = body
            .outline
            .layers
            .iter()
            .map(|layer| {
                let side = |outer: bool, off: f64| -> Vec<Contour> {
                    let of = |l: &mainspring_geometry::Loop| {
                        let mut contour = vec![];
                        l.edges.iter().for_each(|e| polyline(&e.segment, outer, off, &mut contour));
                        contour
                    };
                    layer.loops.iter().map(of).collect()
                };
                let polygons = LEVELS.iter().map(|&off| [side(false, off), side(true, off)]).collect();
                Levels { heights: (layer.bottom, layer.top), polygons }
            })
            .collect();
        let reach = layers.iter().flat_map(|l| l.polygons[0][1].iter().flatten());
        let radius = reach.map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
        Polygons { layers, radius }
    }
}

fn place(contours: &[Contour], pose: &Pose) -> Vec<Contour> {
    let of = |p: &[f64; 2]| {
        let q = pose.apply(Vec2::new(p[0], p[1]));
        [q.x, q.y]
    };
    contours.iter().map(|c| c.iter().map(of).collect()).collect()
}

fn intersect(a: &[Contour], b: &[Contour], reach: f64) -> bool {
    let rect = FloatRect { min_x: -reach, max_x: reach, min_y: -reach, max_y: reach };
    let adapter = FloatPointAdapter::<[f64; 2], i64>::new(rect);
    let n = a.iter().chain(b).map(Vec::len).sum();
    let mut overlay =
        FloatPredicateOverlay::with_adapter_custom(adapter, FillRule::Positive, Solver::default(), n);
    overlay.add_source(a, ShapeType::Subject);
    overlay.add_source(b, ShapeType::Clip);
    overlay.interiors_intersect()
}

/// Do two bodies overlap at joint positions `q`? None: they are nearer to a contact than the finest polygons tell.
pub fn overlap(a: (&Body, &Polygons), b: (&Body, &Polygons), q: &[f64]) -> Option<bool> {
    let (pa, pb) = (a.0.pose(q), b.0.pose(q));
    // In the second body's coordinates.
    let back = Pose { cos: pb.cos, sin: -pb.sin, shift: Vec2::default() };
    let rel = Pose { shift: -back.rotate(pb.shift), ..back }.then_after(&pa);
    let reach = (a.1.radius + rel.shift.norm()).max(b.1.radius) + 1e-2;
    let mut worst = Some(false);
    for l in &a.1.layers {
        for m in &b.1.layers {
            let common = l.heights.1.min(m.heights.1) - l.heights.0.max(m.heights.0);
            match layers_overlap(l, m, &rel, reach) {
                _ if common <= 1e-9 => {}
                Some(true) => return Some(true),
                Some(false) => {}
                None => worst = None,
            }
        }
    }
    worst
}

fn layers_overlap(l: &Levels, m: &Levels, rel: &Pose, reach: f64) -> Option<bool> {
    for (x, y) in l.polygons.iter().zip(&m.polygons) {
        if !intersect(&place(&x[1], rel), &y[1], reach) {
            return Some(false);
        }
        if intersect(&place(&x[0], rel), &y[0], reach) {
            return Some(true);
        }
    }
    None
}
