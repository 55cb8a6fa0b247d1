//! Contact features of a body's outline: straight edges, convex arcs and corners, concave arcs.
//!
//! A convex corner is an arc of radius 0 with its cone of outward normals. Concave corners and smooth joints are
//! no features. The same curve in several layers is one feature with several intervals of z.

use mainspring_geometry::{CurveId, Edge, Layer, Loop, Outline, Segment, Turn, Vec2};
use std::collections::BTreeMap;

/// Directions an outward normal may take along a round feature, counterclockwise from `start` to `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cone {
    Full,
    /// Less than about 115°: tested by cross products, exact to rounding at both ends.
    Narrow {
        start: Vec2,
        end: Vec2,
    },
    /// Wider: within `acos(cos_half)` of `middle`.
    Wide {
        middle: Vec2,
        cos_half: f64,
    },
}

impl Cone {
    fn new(start: Vec2, end: Vec2, sweep: f64) -> Self {
        if sweep < 2.0 {
            return Cone::Narrow { start, end };
        }
        let half = 0.5 * sweep;
        let (s, c) = half.sin_cos();
        let middle = Vec2::new(c * start.x - s * start.y, s * start.x + c * start.y);
        Cone::Wide { middle, cos_half: c }
    }

    /// How far inside the cone the unit vector `d` lies: radians to first order near the ends, negative outside.
    pub fn margin(&self, d: Vec2) -> f64 {
        match self {
            Cone::Full => 1.0,
            Cone::Narrow { start, end } => {
                let inside = start.cross(d).min(d.cross(*end));
                if (*start + *end).dot(d) > 0.0 { inside } else { inside.min(-0.5) }
            }
            Cone::Wide { middle, cos_half } => middle.dot(d) - cos_half,
        }
    }

    /// Does the unit vector `d` stay outside as long as it turns by no more than `turn` (radians)? Narrow cones are told
    /// only up to half a radian; false where it is not known.
    pub fn misses(&self, d: Vec2, turn: f64) -> bool {
        match self {
            Cone::Full => false,
            Cone::Narrow { start, end } => {
                // The cone widened by at least `turn` at both ends, still narrower than half a turn.
                let tan = turn * (1.0 + 0.4 * turn * turn);
                let before = start.cross(d) + tan * start.dot(d) < 0.0;
                turn <= 0.5 && (before || d.cross(*end) + tan * end.dot(d) < 0.0)
            }
            Cone::Wide { middle, cos_half } => middle.dot(d) < cos_half - turn,
        }
    }
}

/// The shape of a feature, in the coordinates of the part as modelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FeatureShape {
    /// Material on the left of `from → to`; `tangent` and outward `normal` are unit vectors.
    Edge { from: Vec2, to: Vec2, tangent: Vec2, normal: Vec2, length: f64 },
    /// Convex arc, or a convex corner when the radius is 0.
    Round { center: Vec2, radius: f64, cone: Cone },
    /// Concave arc: material outside the circle; `cone` holds directions from the centre.
    Hollow { center: Vec2, radius: f64, cone: Cone },
}

/// Name of a feature that survives changes of parameters: the curves that make it, and which occurrence it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FeatureName {
    pub curve: CurveId,
    /// The second curve of a corner.
    pub next: Option<CurveId>,
    /// Counts features of the same curves along the outline, from 0.
    pub occurrence: u32,
}

/// One feature of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    pub name: FeatureName,
    pub shape: FeatureShape,
    /// Curves that pass here, aliases included (for a corner those of both sides, in two lists).
    pub curves: [Vec<CurveId>; 2],
    /// Where it is in the outline: layer, loop and edge (a corner is the start of its edge).
    pub at: (usize, usize, usize),
    /// Intervals of z in which it bounds the part.
    pub heights: Vec<(f64, f64)>,
    /// For a corner: its edges or arcs; for an edge or arc: the convex corners at its ends.
    pub neighbours: Vec<usize>,
    /// A disc around the feature.
    pub center: Vec2,
    pub radius: f64,
}

impl Feature {
    pub fn is_corner(&self) -> bool {
        matches!(self.shape, FeatureShape::Round { radius, .. } if radius == 0.0)
    }

    /// Do the two features lie in a common interval of z of positive height?
    pub fn shares_height(&self, other: &Feature, tolerance: f64) -> bool {
        self.heights.iter().any(|a| other.heights.iter().any(|b| a.1.min(b.1) - a.0.max(b.0) > tolerance))
    }
}

/// All contact features of an outline. `size` is the part's size; equal features of several layers are merged
/// when they agree to `1e-9 · size`.
pub fn features(outline: &Outline, size: f64) -> Vec<Feature> {
    let mut found = Found::default();
    for (i, layer) in outline.layers.iter().enumerate() {
        for (j, boundary) in layer.loops.iter().enumerate() {
            add_loop(&mut found, layer, boundary, (i, j), 1e-9 * size);
        }
    }
    found.features
}

/// Features found so far, and which of them have the same curves, in order.
#[derive(Default)]
struct Found {
    features: Vec<Feature>,
    named: BTreeMap<(CurveId, Option<CurveId>), Vec<usize>>,
}

fn add_loop(found: &mut Found, layer: &Layer, boundary: &Loop, at: (usize, usize), tolerance: f64) {
    let edges = &boundary.edges;
    let heights = vec![(layer.bottom, layer.top)];
    let placed = |feature: Feature, edge: usize| Feature { at: (at.0, at.1, edge), ..feature };
    let curves: Vec<usize> = edges
        .iter()
        .enumerate()
        .map(|(i, edge)| found.insert(placed(curve_feature(edge, heights.clone()), i), tolerance))
        .collect();
    for (i, edge) in edges.iter().enumerate() {
        if edge.turn_at_start != Turn::Convex || matches!(edge.segment, Segment::Circle { .. }) {
            continue;
        }
        let before = (i + edges.len() - 1) % edges.len();
        let corner = placed(corner_feature(&edges[before], edge, heights.clone()), i);
        let corner = found.insert(corner, tolerance);
        for neighbour in [curves[before], curves[i]] {
            link(&mut found.features, corner, neighbour);
            link(&mut found.features, neighbour, corner);
        }
    }
}

fn link(found: &mut [Feature], from: usize, to: usize) {
    if !found[from].neighbours.contains(&to) {
        found[from].neighbours.push(to);
    }
}

impl Found {
    /// Merges with an equal feature of another layer, or appends.
    fn insert(&mut self, feature: Feature, tolerance: f64) -> usize {
        let named = self.named.entry((feature.name.curve, feature.name.next)).or_default();
        let equal = |f: &Feature| {
            (f.center - feature.center).norm() <= tolerance
                && (f.radius - feature.radius).abs() <= tolerance
                && same_shape(&f.shape, &feature.shape, tolerance)
        };
        if let Some(&i) = named.iter().find(|&&i| equal(&self.features[i])) {
            self.features[i].heights.extend(feature.heights);
            return i;
        }
        let name = FeatureName { occurrence: named.len() as u32, ..feature.name };
        named.push(self.features.len());
        self.features.push(Feature { name, ..feature });
        self.features.len() - 1
    }
}

fn same_shape(a: &FeatureShape, b: &FeatureShape, tolerance: f64) -> bool {
    let near = |p: Vec2, q: Vec2| (p - q).norm() <= tolerance.max(1e-9);
    let same_cone = |a: &Cone, b: &Cone| match (a, b) {
        (Cone::Full, Cone::Full) => true,
        (Cone::Narrow { start: s, end: e }, Cone::Narrow { start: t, end: f }) => {
            near(*s, *t) && near(*e, *f)
        }
        (Cone::Wide { middle: m, cos_half: c }, Cone::Wide { middle: n, cos_half: d }) => {
            near(*m, *n) && (c - d).abs() <= 1e-9
        }
        _ => false,
    };
    match (a, b) {
        (FeatureShape::Edge { from: a, to: b, .. }, FeatureShape::Edge { from: c, to: d, .. }) => {
            near(*a, *c) && near(*b, *d)
        }
        (FeatureShape::Round { cone: a, .. }, FeatureShape::Round { cone: b, .. })
        | (FeatureShape::Hollow { cone: a, .. }, FeatureShape::Hollow { cone: b, .. }) => same_cone(a, b),
        _ => false,
    }
}

fn curve_feature(edge: &Edge, heights: Vec<(f64, f64)>) -> Feature {
    let (shape, center, radius) = match edge.segment {
        Segment::Line { from, to } => {
            let length = (to - from).norm();
            let tangent = (to - from) * (1.0 / length);
            let shape = FeatureShape::Edge { from, to, tangent, normal: -tangent.perp(), length };
            (shape, (from + to) * 0.5, 0.5 * length)
        }
        Segment::Arc { from, to, center, radius, convex } => {
            let (start, end) = if convex { (from, to) } else { (to, from) };
            let (u, w) = ((start - center).unit(), (end - center).unit());
            let sweep = u.cross(w).atan2(u.dot(w)).rem_euclid(std::f64::consts::TAU);
            let cone = Cone::new(u, w, sweep);
            let (middle, reach) = arc_disc(center, radius, u, sweep);
            (round(center, radius, cone, convex), middle, reach)
        }
        Segment::Circle { center, radius, convex } => {
            (round(center, radius, Cone::Full, convex), center, radius)
        }
    };
    let mut curves = vec![edge.curve];
    curves.extend(&edge.aliases);
    let name = FeatureName { curve: edge.curve, next: None, occurrence: 0 };
    Feature {
        name,
        shape,
        curves: [curves, vec![]],
        at: (0, 0, 0),
        heights,
        neighbours: vec![],
        center,
        radius,
    }
}

fn round(center: Vec2, radius: f64, cone: Cone, convex: bool) -> FeatureShape {
    if convex {
        FeatureShape::Round { center, radius, cone }
    } else {
        FeatureShape::Hollow { center, radius, cone }
    }
}

/// A disc around an arc that starts in direction `u` and sweeps counterclockwise.
fn arc_disc(center: Vec2, radius: f64, u: Vec2, sweep: f64) -> (Vec2, f64) {
    if sweep >= std::f64::consts::PI {
        return (center, radius);
    }
    let half = 0.5 * sweep;
    let (s, c) = half.sin_cos();
    let middle = Vec2::new(c * u.x - s * u.y, s * u.x + c * u.y);
    (center + middle * (radius * c), radius * s.max(1.0 - c))
}

fn corner_feature(before: &Edge, after: &Edge, heights: Vec<(f64, f64)>) -> Feature {
    let p = after.segment.start();
    let (start, end) = (outward(&before.segment, p), outward(&after.segment, p));
    let sweep = start.cross(end).atan2(start.dot(end)).rem_euclid(std::f64::consts::TAU);
    let all = |edge: &Edge| {
        let mut curves = vec![edge.curve];
        curves.extend(&edge.aliases);
        curves
    };
    Feature {
        name: FeatureName { curve: before.curve, next: Some(after.curve), occurrence: 0 },
        shape: FeatureShape::Round { center: p, radius: 0.0, cone: Cone::new(start, end, sweep) },
        curves: [all(before), all(after)],
        at: (0, 0, 0),
        heights,
        neighbours: vec![],
        center: p,
        radius: 0.0,
    }
}

/// Outward normal of a segment at its point `p`.
fn outward(segment: &Segment, p: Vec2) -> Vec2 {
    match *segment {
        Segment::Line { from, to } => -(to - from).unit().perp(),
        Segment::Arc { center, convex, .. } | Segment::Circle { center, convex, .. } => {
            if convex {
                (p - center).unit()
            } else {
                (center - p).unit()
            }
        }
    }
}

impl FeatureShape {
    /// The centre of a round feature, the start of an edge.
    pub fn anchor(&self) -> Vec2 {
        match *self {
            FeatureShape::Edge { from, .. } => from,
            FeatureShape::Round { center, .. } | FeatureShape::Hollow { center, .. } => center,
        }
    }

    /// The radius of a round feature, 0 for an edge.
    pub fn radius(&self) -> f64 {
        match *self {
            FeatureShape::Edge { .. } => 0.0,
            FeatureShape::Round { radius, .. } | FeatureShape::Hollow { radius, .. } => radius,
        }
    }

    /// Least and greatest distance of the feature's points from `p`: exact for edges and corners, the whole
    /// circle's for arcs.
    pub fn distances_from(&self, p: Vec2) -> (f64, f64) {
        match *self {
            FeatureShape::Edge { from, to, tangent, length, .. } => {
                let s = tangent.dot(p - from).clamp(0.0, length);
                let near = (from + tangent * s - p).norm();
                (near, (from - p).norm().max((to - p).norm()))
            }
            FeatureShape::Round { center, radius, .. } | FeatureShape::Hollow { center, radius, .. } => {
                let d = (center - p).norm();
                ((d - radius).abs(), d + radius)
            }
        }
    }
}
