//! Repeated teeth: the greatest n for which a turn by 2π/n about the body's axis maps its outline onto itself.

use crate::section::Section;
use crate::span::Span;
use mainspring_geometry::Vec2;
use mainspring_mechanism::Pose;
use std::f64::consts::TAU;

/// What must be mapped onto itself: the ends and the middle of a span, and whether it takes part in contact.
#[derive(Clone, Copy)]
struct Mark {
    center: Vec2,
    ends: [Vec2; 2],
    radius: f64,
    counts: bool,
}

/// The order n ≥ 1 of the rotational symmetry of all sections about the local origin, to `tolerance` (a length);
/// 1 also for a body that looks the same at every angle.
pub(crate) fn order(sections: &[Section], tolerance: f64) -> u32 {
    let marks: Vec<Vec<Mark>> = sections.iter().map(|s| marks(s, tolerance)).collect();
    let fewest = marks.iter().map(Vec::len).filter(|&n| n > 0).min().unwrap_or(0);
    let candidates = (2..=fewest).rev().filter(|n| marks.iter().all(|m| m.len() % n == 0));
    let mut found = candidates.filter(|&n| marks.iter().all(|m| maps_onto_itself(m, n, tolerance)));
    found.next().unwrap_or(1) as u32
}

fn marks(section: &Section, tolerance: f64) -> Vec<Mark> {
    let of = |(span, feature): (&Span, &usize)| {
        let radius = match span {
            Span::Arc { radius, .. } => *radius,
            Span::Line { .. } => 0.0,
        };
        Mark { center: span.disc().0, ends: span.ends(), radius, counts: *feature != usize::MAX }
    };
    let whole = |m: &Mark| m.center.norm() <= tolerance && (m.ends[0] - m.ends[1]).norm() <= tolerance;
    section.spans.iter().zip(&section.features).map(of).filter(|m| !whole(m)).collect()
}

fn maps_onto_itself(marks: &[Mark], n: usize, tolerance: f64) -> bool {
    let (sin, cos) = (TAU / n as f64).sin_cos();
    let turn = Pose { cos, sin, shift: Vec2::default() };
    let near = |p: Vec2, q: Vec2| (p - q).norm() <= tolerance;
    // Images follow each other along the outline as the marks do: the search goes on behind the last one found.
    let mut next = 0;
    marks.iter().all(|m| {
        let (center, ends) = (turn.apply(m.center), m.ends.map(|e| turn.apply(e)));
        let same = |o: &Mark| {
            // A whole circle begins anywhere.
            let round = near(m.ends[0], m.ends[1]) && near(o.ends[0], o.ends[1]);
            near(o.center, center)
                && o.counts == m.counts
                && (o.radius - m.radius).abs() <= tolerance
                && (round || (near(o.ends[0], ends[0]) && near(o.ends[1], ends[1])))
        };
        let found = (0..marks.len()).map(|k| (next + k) % marks.len()).find(|&k| same(&marks[k]));
        next = found.map_or(next, |k| k + 1);
        found.is_some()
    })
}
