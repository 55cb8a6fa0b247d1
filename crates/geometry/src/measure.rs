//! Measures of an outline: boxes, areas, membership. Over `f64`, in the coordinates of the working plane.

use crate::{Layer, Loop, Outline, Segment, Vec2};

/// Heights tried for a witness point: the middles of the widest intervals between features.
const WITNESS_ROWS: usize = 16;

type Corners = (Vec2, Vec2);

fn hull(a: Option<Corners>, b: Corners) -> Option<Corners> {
    let Some(a) = a else { return Some(b) };
    let min = Vec2::new(a.0.x.min(b.0.x), a.0.y.min(b.0.y));
    Some((min, Vec2::new(a.1.x.max(b.1.x), a.1.y.max(b.1.y))))
}

impl Outline<f64> {
    /// The least and the greatest corner of the smallest box about all layers; `None` if there are none.
    pub fn bounds(&self) -> Option<(Vec2, Vec2)> {
        self.layers.iter().filter_map(Layer::bounds).fold(None, hull)
    }

    /// The part's size in the plane, to which tolerances are relative: the diagonal of its box.
    pub fn size(&self) -> f64 {
        self.bounds().map_or(0.0, |(min, max)| (max - min).norm())
    }

    /// The greatest distance of a boundary point from `center`.
    pub fn bounding_radius(&self, center: Vec2) -> f64 {
        let edges = self.layers.iter().flat_map(|l| &l.loops).flat_map(|l| &l.edges);
        edges.map(|e| e.segment.farthest_from(center)).fold(0.0, f64::max)
    }

    /// Area times height, summed over the layers.
    pub fn volume(&self) -> f64 {
        self.layers.iter().map(|l| l.area() * (l.top - l.bottom)).sum()
    }

    /// The layer that holds a height strictly inside.
    pub fn layer_at(&self, z: f64) -> Option<&Layer> {
        self.layers.iter().find(|l| l.bottom < z && z < l.top)
    }
}

impl Loop<f64> {
    /// The area inside, positive counterclockwise (outer loops), negative clockwise (holes).
    pub fn area(&self) -> f64 {
        let origin = self.edges.first().map_or(Vec2::new(0.0, 0.0), |e| e.segment.start());
        self.edges.iter().map(|e| e.segment.area_about(origin)).sum()
    }

    /// The least and the greatest corner of the smallest box about it.
    pub fn bounds(&self) -> Option<(Vec2, Vec2)> {
        self.edges.iter().map(|e| e.segment.bounds()).fold(None, hull)
    }
}

impl Layer<f64> {
    /// The area of material.
    pub fn area(&self) -> f64 {
        self.loops.iter().map(Loop::area).sum()
    }

    /// The least and the greatest corner of the smallest box about it.
    pub fn bounds(&self) -> Option<(Vec2, Vec2)> {
        self.loops.iter().filter_map(Loop::bounds).fold(None, hull)
    }

    /// Is a point inside the material? On the boundary the answer may be either.
    pub fn contains(&self, p: Vec2) -> bool {
        self.crossings(p.y).iter().filter(|&&x| x > p.x).count() % 2 == 1
    }

    /// Where the line at height `y` crosses the boundary, ascending. Between the first and the second, the
    /// third and the fourth and so on there is material.
    pub fn crossings(&self, y: f64) -> Vec<f64> {
        let mut found = Vec::new();
        for edge in self.loops.iter().flat_map(|l| &l.edges) {
            edge.segment.crossings(y, &mut found);
        }
        found.sort_by(f64::total_cmp);
        found
    }

    /// A point well inside the material; `None` if there is no material.
    pub fn interior_point(&self) -> Option<Vec2> {
        let boxes = self.loops.iter().flat_map(|l| &l.edges).map(|e| e.segment.bounds());
        let mut heights: Vec<f64> = boxes.flat_map(|(min, max)| [min.y, max.y]).collect();
        heights.sort_by(f64::total_cmp);
        let mut rows: Vec<_> = heights.windows(2).map(|w| (w[1] - w[0], 0.5 * (w[0] + w[1]))).collect();
        rows.sort_by(|a, b| b.0.total_cmp(&a.0));
        let widest = |&(depth, y): &(f64, f64)| {
            let spans =
                self.crossings(y).chunks_exact(2).map(|c| (c[1] - c[0], 0.5 * (c[0] + c[1]))).collect();
            let spans: Vec<(f64, f64)> = spans;
            let best = spans.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
            (best.0 > 0.0 && depth > 0.0).then_some((best.0.min(depth), Vec2::new(best.1, y)))
        };
        let found = rows.iter().take(WITNESS_ROWS).filter_map(widest);
        found.max_by(|a, b| a.0.total_cmp(&b.0)).map(|best| best.1)
    }
}

impl Segment<f64> {
    /// The greatest distance of its points from `p`.
    pub fn farthest_from(&self, p: Vec2) -> f64 {
        let ends = (self.start() - p).norm().max((self.end() - p).norm());
        match *self {
            Segment::Arc { center, radius, .. } | Segment::Circle { center, radius, .. } => {
                let away = center - p;
                if self.sweeps_over(away) { away.norm() + radius } else { ends }
            }
            Segment::Line { .. } => ends,
        }
    }

    /// Adds where the line at height `y` crosses, counting the lower end of every rising or falling piece
    /// and not the upper, so that closed loops are always crossed an even number of times.
    fn crossings(&self, y: f64, found: &mut Vec<f64>) {
        let crosses = |y0: f64, y1: f64| (y0 <= y) != (y1 <= y);
        match *self {
            Segment::Line { from: a, to: b } => {
                if crosses(a.y, b.y) {
                    found.push(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
                }
            }
            Segment::Arc { center, radius, .. } | Segment::Circle { center, radius, .. } => {
                let half = ((radius - (y - center.y)) * (radius + (y - center.y))).max(0.0).sqrt();
                let pieces = self.rising_and_falling();
                for w in pieces.windows(2).filter(|w| crosses(w[0].1, w[1].1)) {
                    let right = self.at(0.5 * (w[0].0 + w[1].0)).x > center.x;
                    found.push(center.x + if right { half } else { -half });
                }
            }
        }
    }

    /// An arc's ends and its highest and lowest points in the order of the way: fractions and heights.
    fn rising_and_falling(&self) -> Vec<(f64, f64)> {
        let (Segment::Arc { center, radius, convex, .. } | Segment::Circle { center, radius, convex }) =
            *self
        else {
            return Vec::new();
        };
        let mut stops = vec![(0.0, self.start().y), (1.0, self.end().y)];
        let from = self.start() - center;
        for side in [-1.0, 1.0] {
            let angle = (from.x * side).atan2(from.y * side);
            let fraction =
                (if convex { angle } else { -angle }).rem_euclid(std::f64::consts::TAU) / self.sweep();
            if fraction > 0.0 && fraction < 1.0 {
                stops.push((fraction, center.y + radius * side));
            }
        }
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        stops
    }
}
