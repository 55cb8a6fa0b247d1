//! Bodies as point sets: do they overlap, how far are they apart.
//!
//! Two regions without a common boundary point overlap exactly if a boundary loop of one lies inside the other: the
//! outer boundary of a component of their common interior is then a whole loop of one of them. So the test is: boundaries
//! nearer than rounding, or a point of a loop inside.

use crate::moving::Moving;
use crate::reduce::relative;
use crate::span::Span;
use crate::tree::Discs;
use mainspring_geometry::{Layer, Segment, Vec2};
use mainspring_mechanism::Pose;

/// One layer of a body in local coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    pub heights: (f64, f64),
    pub spans: Vec<Span>,
    /// Index of the feature that each span is (`usize::MAX` if it takes no part in contact).
    pub features: Vec<usize>,
    /// Material inside the circle (arcs), by span.
    convex: Vec<bool>,
    tree: Discs,
    /// Three points of each loop that takes part in contact.
    points: Vec<Vec2>,
}

/// Two spans that never move against each other and touch: no overlap.
pub(crate) type Ignored = Vec<(u32, u32)>;

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
        Section {
            heights: (layer.bottom, layer.top),
            tree: Discs::new(&discs),
            spans,
            features,
            convex,
            points,
        }
    }

    /// Is the point inside? Counts crossings of a ray towards +x.
    pub fn contains(&self, p: Vec2) -> bool {
        let mut inside = false;
        let mut pending = vec![0u32];
        if self.tree.nodes.is_empty() {
            return false;
        }
        while let Some(i) = pending.pop() {
            let node = &self.tree.nodes[i as usize];
            let out = (node.center.y - p.y).abs() > node.radius || node.center.x + node.radius < p.x;
            if out {
                continue;
            }
            if node.leaf {
                inside ^= crossings(&self.spans[node.link as usize], p) % 2 == 1;
            } else {
                pending.extend(self.tree.children(i));
            }
        }
        inside
    }
}

impl Section {
    /// The boundary point nearest to `p`, with its distance.
    pub fn nearest_to(&self, p: Vec2) -> (Vec2, f64) {
        let mut best = (Vec2::default(), f64::INFINITY);
        let nodes = &self.tree.nodes;
        let bound = |i: u32| (nodes[i as usize].center - p).norm() - nodes[i as usize].radius;
        let mut pending = if nodes.is_empty() { vec![] } else { vec![(bound(0), 0u32)] };
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
            let mut next = self.tree.children(i).map(|k| (bound(k), k));
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
    fn reaches_into(&self, other: &Section, rel: &Pose, ignored: &Ignored, rounding: f64) -> bool {
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

/// The layers of two bodies that lie at a common height.
#[derive(Clone, Debug)]
pub(crate) struct Regions {
    pub sections: [Vec<Section>; 2],
    /// Pairs of sections at a common height, with spans that touch for ever.
    pub facing: Vec<(usize, usize, Ignored)>,
    /// Boundaries nearer than this count as overlapping (length).
    pub rounding: f64,
}

impl Regions {
    pub fn new(sections: [Vec<Section>; 2], moving: &[Moving; 2], size: f64) -> Self {
        let rounding = 1e-12 * size;
        let mut facing = Vec::new();
        for (i, a) in sections[0].iter().enumerate() {
            for (j, b) in sections[1].iter().enumerate() {
                let common = a.heights.1.min(b.heights.1) - a.heights.0.max(b.heights.0);
                if common > 1e-9 * size {
                    facing.push((i, j, forever(a, b, moving, size)));
                }
            }
        }
        Regions { sections, facing, rounding }
    }

    /// Do the bodies overlap at these poses?
    pub fn overlap(&self, poses: &[Pose; 2]) -> bool {
        let rel = relative(&poses[0], &poses[1]);
        let back = relative(&poses[1], &poses[0]);
        self.facing.iter().any(|(i, j, ignored)| {
            let (a, b) = (&self.sections[0][*i], &self.sections[1][*j]);
            meet(a, b, &rel, self.rounding, ignored)
                || a.reaches_into(b, &rel, ignored, self.rounding)
                || b.reaches_into(a, &back, ignored, self.rounding)
        })
    }

    /// Do the bodies overlap by no more than `little` (a length): free if moved by that in some direction?
    pub fn barely_overlap(&self, poses: &[Pose; 2], little: f64) -> bool {
        let moved = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4 + 0.1).sin_cos();
            let shift = poses[0].shift + Vec2::new(cos, sin) * little;
            [Pose { shift, ..poses[0] }, poses[1]]
        };
        self.overlap(poses) && (0..8).any(|k| !self.overlap(&moved(k)))
    }

    /// Distance of the bodies' boundaries with the spans that are nearest: (distance, pair of sections, spans).
    pub fn nearest(&self, poses: &[Pose; 2]) -> Option<(f64, [(usize, usize); 2])> {
        let rel = relative(&poses[0], &poses[1]);
        let mut best: Option<(f64, [(usize, usize); 2])> = None;
        for (i, j, ignored) in &self.facing {
            let (a, b) = (&self.sections[0][*i], &self.sections[1][*j]);
            let mut least = best.map_or(f64::INFINITY, |b| b.0);
            search(a, b, &rel, ignored, |distance, spans| {
                if distance < least {
                    least = distance;
                    best = Some((distance, [(*i, spans.0), (*j, spans.1)]));
                }
                least
            });
        }
        best
    }
}

fn meet(a: &Section, b: &Section, rel: &Pose, rounding: f64, ignored: &Ignored) -> bool {
    let mut met = false;
    search(a, b, rel, ignored, |distance, _| {
        met |= distance <= rounding;
        if met { -1.0 } else { 2.0 * rounding }
    });
    met
}

/// Visits pairs of spans that may be nearer than a reach; `visit` gets their distance and returns the new reach.
fn search(
    a: &Section,
    b: &Section,
    rel: &Pose,
    ignored: &Ignored,
    mut visit: impl FnMut(f64, (usize, usize)) -> f64,
) {
    let (ta, tb) = (&a.tree.nodes, &b.tree.nodes);
    if ta.is_empty() || tb.is_empty() {
        return;
    }
    let mut reach = visit(f64::INFINITY, (0, 0));
    let apart = |i: u32, j: u32| {
        let (m, n) = (&ta[i as usize], &tb[j as usize]);
        (rel.apply(m.center) - n.center).norm() - m.radius - n.radius
    };
    let mut pending = vec![(apart(0, 0), 0u32, 0u32)];
    while let Some((bound, i, j)) = pending.pop() {
        if bound >= reach {
            continue;
        }
        let (m, n) = (&ta[i as usize], &tb[j as usize]);
        if m.leaf && n.leaf {
            let (s, t) = (m.link as usize, n.link as usize);
            let excluded = a.features[s] == usize::MAX || b.features[t] == usize::MAX;
            if excluded || ignored.contains(&(m.link, n.link)) {
                continue;
            }
            reach = visit(a.spans[s].placed(rel).distance(&b.spans[t]), (s, t));
            continue;
        }
        let first = !m.leaf && (n.leaf || m.radius >= n.radius);
        let mut next = if first {
            a.tree.children(i).map(|k| (apart(k, j), k, j))
        } else {
            b.tree.children(j).map(|k| (apart(i, k), i, k))
        };
        // The nearer one is looked at first.
        if next[0].0 < next[1].0 {
            next.swap(0, 1);
        }
        pending.extend(next);
    }
}

/// Arcs about their bodies' own axes keep their distance: those that touch from outside for ever do not overlap.
fn forever(a: &Section, b: &Section, moving: &[Moving; 2], size: f64) -> Ignored {
    let own = |span: &Span, m: &Moving| match *span {
        Span::Arc { center, radius, .. } if m.turns() && center.norm() <= 1e-10 * size => Some(radius),
        _ => None,
    };
    let d = (moving[0].center - moving[1].center).norm();
    let near = |x: f64| x.abs() <= 1e-9 * size;
    let mut found = Vec::new();
    for (i, s) in a.spans.iter().enumerate() {
        let Some(r) = own(s, &moving[0]) else { continue };
        for (j, t) in b.spans.iter().enumerate() {
            let Some(q) = own(t, &moving[1]) else { continue };
            let touching = match (a.convex[i], b.convex[j]) {
                (true, true) => near(d - r - q),
                (true, false) => near(d - (q - r)),
                (false, true) => near(d - (r - q)),
                (false, false) => false,
            };
            if touching {
                found.push((i as u32, j as u32));
            }
        }
    }
    found
}

impl Section {
    pub fn convex(&self) -> &[bool] {
        &self.convex
    }
}
