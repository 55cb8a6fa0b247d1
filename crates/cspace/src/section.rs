//! One layer of a body: its boundary, which points are inside, which boundary point is nearest.

use crate::region::Ignored;
use crate::slat::Slat;
use crate::span::Span;
use crate::tree::{Discs, PENDING};
use mainspring_geometry::{Layer, Segment, Vec2};
use mainspring_mechanism::{Mark, Pose};

/// One layer of a body in local coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    pub heights: (f64, f64),
    pub spans: Vec<Span>,
    pub slats: Vec<Slat>,
    /// Index of the feature that each span is (`usize::MAX` if it takes no part in contact).
    pub features: Vec<usize>,
    /// Material inside the circle (arcs), by span.
    pub convex: Vec<bool>,
    pub all: Cover,
    /// Of spans that the other body can reach; none if that is all of them.
    close: Option<Cover>,
    /// Three points of each loop that takes part in contact.
    points: Vec<Vec2>,
}

/// A tree over spans.
#[derive(Clone, Debug)]
pub(crate) struct Cover {
    pub tree: Discs,
    /// Greatest radius of a span's disc under each node.
    pub greatest: Vec<f64>,
}

impl Cover {
    fn over(discs: &[(Vec2, f64)], chosen: impl IntoIterator<Item = u32>) -> Self {
        let tree = Discs::over(discs, chosen);
        Cover { greatest: tree.greatest(|k| discs[k as usize].1), tree }
    }
}

impl Section {
    pub fn new(layer: &Layer, local: &Pose, feature_of: impl Fn(usize, usize) -> usize) -> Self {
        let (mut spans, mut features, mut points, mut convex) = (vec![], vec![], vec![], vec![]);
        for (i, boundary) in layer.loops.iter().enumerate() {
            let mut point = None;
            for (j, edge) in boundary.edges.iter().enumerate() {
                let span = Span::new(&edge.segment, local);
                let feature = feature_of(i, j);
                if feature != usize::MAX {
                    point.get_or_insert_with(|| {
                        [span.ends()[0], span.samples(3, true)[0].0, span.samples(3, true)[2].0]
                    });
                }
                convex.push(!matches!(
                    edge.segment,
                    Segment::Arc { convex: false, .. } | Segment::Circle { convex: false, .. }
                ));
                spans.push(span);
                features.push(feature);
            }
            points.extend(point.into_iter().flatten());
        }
        let discs: Vec<_> = spans.iter().map(Span::disc).collect();
        let all = Cover::over(&discs, 0..discs.len() as u32);
        let slats = spans.iter().map(Slat::around).collect();
        let heights = (layer.bottom, layer.top);
        Section { heights, spans, slats, features, convex, all, close: None, points }
    }

    /// The same, where the other body can only reach what lies in some discs.
    pub fn within(mut self, reach: impl Fn((Vec2, f64)) -> bool) -> Self {
        let discs: Vec<_> = self.spans.iter().map(Span::disc).collect();
        let chosen: Vec<u32> = (0..discs.len() as u32)
            .filter(|&i| self.features[i as usize] != usize::MAX && reach(discs[i as usize]))
            .collect();
        self.close = (chosen.len() < discs.len()).then(|| Cover::over(&discs, chosen));
        self
    }

    /// Its spans, for the order of its symmetry about the local origin.
    pub fn marks(&self) -> Vec<Mark> {
        let of = |(span, feature): (&Span, &usize)| {
            let radius = match span {
                Span::Arc { radius, .. } => *radius,
                Span::Line { .. } => 0.0,
            };
            Mark { middle: span.disc().0, ends: span.ends(), radius, counts: *feature != usize::MAX }
        };
        self.spans.iter().zip(&self.features).map(of).collect()
    }

    /// Over the spans that may meet the other body.
    pub fn close(&self) -> &Cover {
        self.close.as_ref().unwrap_or(&self.all)
    }

    /// Is the point inside? Counts crossings of a ray towards +x.
    pub fn contains(&self, p: Vec2) -> bool {
        let mut inside = false;
        if self.all.tree.nodes.is_empty() {
            return false;
        }
        let mut pending = Vec::with_capacity(PENDING);
        pending.push(0u32);
        while let Some(i) = pending.pop() {
            let node = &self.all.tree.nodes[i as usize];
            let out = (node.center.y - p.y).abs() > node.radius || node.center.x + node.radius < p.x;
            if out {
                continue;
            }
            if node.leaf {
                inside ^= crossings(&self.spans[node.link as usize], p) % 2 == 1;
            } else {
                pending.extend(self.all.tree.children(i));
            }
        }
        inside
    }
}

impl Section {
    /// The boundary point nearest to `p`, with its distance.
    pub fn nearest_to(&self, p: Vec2) -> (Vec2, f64) {
        let mut best = (Vec2::default(), f64::INFINITY);
        let nodes = &self.all.tree.nodes;
        let bound = |i: u32| (nodes[i as usize].center - p).norm() - nodes[i as usize].radius;
        let mut pending = Vec::with_capacity(PENDING);
        pending.extend((!nodes.is_empty()).then(|| (bound(0), 0u32)));
        while let Some((least, i)) = pending.pop() {
            let node = &nodes[i as usize];
            if least >= best.1 {
                continue;
            }
            if node.leaf {
                let q = self.spans[node.link as usize].nearest_to(p);
                let distance = (q - p).norm();
                if distance < best.1 {
                    best = (q, distance);
                }
                continue;
            }
            let mut next = self.all.tree.children(i).map(|k| (bound(k), k));
            if next[0].0 < next[1].0 {
                next.swap(0, 1);
            }
            pending.extend(next);
        }
        best
    }
}

impl Section {
    /// Is a loop inside the other section, which it does not meet? Where spans touch for ever, points of theirs on the
    /// other's boundary do not tell; any other point does.
    pub fn reaches_into(&self, other: &Section, rel: &Pose, ignored: &Ignored, rounding: f64) -> bool {
        let strict = |p: Vec2| ignored.is_empty() || other.nearest_to(p).1 > 1e3 * rounding;
        let step = if ignored.is_empty() { 3 } else { 1 };
        self.points.iter().step_by(step).map(|p| rel.apply(*p)).any(|p| other.contains(p) && strict(p))
    }
}

/// How often a ray from `p` towards +x crosses the span; ends count by the half-open rule in y.
fn crossings(span: &Span, p: Vec2) -> u32 {
    match *span {
        Span::Line { from, to } => {
            if (from.y > p.y) == (to.y > p.y) {
                return 0;
            }
            let x = from.x + (p.y - from.y) / (to.y - from.y) * (to.x - from.x);
            u32::from(x > p.x)
        }
        Span::Arc { center, radius, .. } => {
            // Monotone stretches in y: the arc cut at its highest and lowest point.
            let [a, b] = span.ends();
            stretches(span, a, b).filter(|(s, e, right)| {
                if (s.y > p.y) == (e.y > p.y) {
                    return false;
                }
                let h = p.y - center.y;
                let half = ((radius - h) * (radius + h)).max(0.0).sqrt();
                center.x + if *right { half } else { -half } > p.x
            })
        }
        .count() as u32,
    }
}

/// Counterclockwise stretches of an arc, each on the right or the left half of its circle.
fn stretches(span: &Span, a: Vec2, b: Vec2) -> impl Iterator<Item = (Vec2, Vec2, bool)> + use<> {
    let mut found = [None; 4];
    if let Span::Arc { center, radius, sector } = *span {
        let (top, bottom) = (center + Vec2::new(0.0, radius), center - Vec2::new(0.0, radius));
        let whole = sector.start == sector.end;
        let (mut at, mut right) =
            (a, if sector.start.x != 0.0 { sector.start.x > 0.0 } else { sector.start.y < 0.0 });
        let end_right = if sector.end.x != 0.0 { sector.end.x > 0.0 } else { sector.end.y > 0.0 };
        for slot in &mut found {
            // Does the arc end on this half, ahead of here?
            let ahead = if right { b.y >= at.y } else { b.y <= at.y };
            let last = end_right == right && ahead && !(whole && at == a);
            let stop = if last {
                b
            } else if right {
                top
            } else {
                bottom
            };
            *slot = Some((at, stop, right));
            if last {
                break;
            }
            (at, right) = (stop, !right);
        }
    }
    found.into_iter().flatten()
}
