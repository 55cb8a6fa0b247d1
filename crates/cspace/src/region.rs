//! Bodies as point sets: do they overlap, how far are they apart.
//!
//! Two regions without a common boundary point overlap exactly if a boundary loop of one lies inside the other: the
//! outer boundary of a component of their common interior is then a whole loop of one of them. So the test is: boundaries
//! nearer than rounding, or a point of a loop inside.

use crate::element::Frame;
use crate::moving::Moving;
use crate::recent::Recent;
use crate::reduce::relative;
use crate::section::Section;
use crate::span::Span;
use crate::tree::{Discs, PENDING};
use crate::within::Within;
use mainspring_geometry::Vec2;
use mainspring_mechanism::Pose;

/// Two spans that never move against each other and touch: no overlap.
pub(crate) type Ignored = Vec<(u32, u32)>;

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
    pub fn new(sections: [Vec<Section>; 2], frame: &Frame, within: &Within) -> Self {
        let size = frame.size;
        let rounding = 1e-12 * size;
        let [first, second] = sections;
        let sections: [Vec<Section>; 2] = [(0, first), (1, second)]
            .map(|(k, all)| all.into_iter().map(|s| s.within(|disc| within.reach(k, disc))).collect());
        let mut facing = Vec::new();
        for (i, a) in sections[0].iter().enumerate() {
            for (j, b) in sections[1].iter().enumerate() {
                let common = a.heights.1.min(b.heights.1) - a.heights.0.max(b.heights.0);
                if common > 1e-9 * size {
                    facing.push((i, j, forever(a, b, &frame.moving, size)));
                }
            }
        }
        Regions { sections, facing, rounding }
    }

    /// Do the bodies overlap at these poses?
    pub fn overlap(&self, poses: &[Pose; 2]) -> bool {
        self.overlap_again(poses, &mut Met::default())
    }

    /// The same; spans that met before are tried first.
    pub fn overlap_again(&self, poses: &[Pose; 2], met: &mut Met) -> bool {
        let rel = relative(&poses[0], &poses[1]);
        let back = relative(&poses[1], &poses[0]);
        if met.iter().any(|&(f, spans)| self.touch(&rel, f, spans)) {
            return true;
        }
        self.facing.iter().enumerate().any(|(f, (i, j, ignored))| {
            let (a, b) = (&self.sections[0][*i], &self.sections[1][*j]);
            if let Some(spans) = meeting(a, b, &rel, self.rounding, ignored) {
                met.remember((f, spans));
                return true;
            }
            a.reaches_into(b, &rel, ignored, self.rounding)
                || b.reaches_into(a, &back, ignored, self.rounding)
        })
    }

    /// Do two spans of two facing sections meet?
    fn touch(&self, rel: &Pose, facing: usize, (s, t): (usize, usize)) -> bool {
        let (i, j, _) = &self.facing[facing];
        let (a, b) = (&self.sections[0][*i], &self.sections[1][*j]);
        a.slats[s].apart(rel, &b.slats[t]) <= self.rounding
            && a.spans[s].placed(rel).distance(&b.spans[t]) <= self.rounding
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
            search([(a, &a.all.tree), (b, &b.all.tree)], &rel, ignored, |distance, spans| {
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

/// Spans that met when bodies were found to overlap lately, by pair of sections: likely to meet in the next configuration too.
pub(crate) type Met = Recent<(usize, (usize, usize))>;

/// Spans of two sections that meet, if any do.
fn meeting(a: &Section, b: &Section, rel: &Pose, rounding: f64, ignored: &Ignored) -> Option<(usize, usize)> {
    let mut met = None;
    search([(a, &a.close().tree), (b, &b.close().tree)], rel, ignored, |distance, spans| {
        if distance <= rounding {
            met = Some(spans);
        }
        if met.is_some() { -1.0 } else { 2.0 * rounding }
    });
    met
}

/// Visits pairs of spans that may be nearer than a reach; `visit` gets their distance and returns the new reach. Trees
/// over spans of their sections.
fn search(
    [(a, ta), (b, tb)]: [(&Section, &Discs); 2],
    rel: &Pose,
    ignored: &Ignored,
    mut visit: impl FnMut(f64, (usize, usize)) -> f64,
) {
    let trees = [ta, tb];
    let (ta, tb) = (&ta.nodes, &tb.nodes);
    if ta.is_empty() || tb.is_empty() {
        return;
    }
    let mut reach = visit(f64::INFINITY, (0, 0));
    let apart = |i: u32, j: u32| {
        let (m, n) = (&ta[i as usize], &tb[j as usize]);
        (rel.apply(m.center) - n.center).norm() - m.radius - n.radius
    };
    let mut pending = Vec::with_capacity(PENDING);
    pending.push((apart(0, 0), 0u32, 0u32));
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
            if a.slats[s].apart(rel, &b.slats[t]) < reach {
                reach = visit(a.spans[s].placed(rel).distance(&b.spans[t]), (s, t));
            }
            continue;
        }
        let [(k, l), (m, n)] = Discs::halved(trees, (i, j));
        let (first, second) = (apart(k, l), apart(m, n));
        // The nearer one is looked at first.
        let (nearer, farther) =
            if first <= second { ((first, k, l), (second, m, n)) } else { ((second, m, n), (first, k, l)) };
        for next in [farther, nearer] {
            if next.0 < reach {
                pending.push(next);
            }
        }
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
