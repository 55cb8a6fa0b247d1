//! Repeated teeth: the greatest n for which a turn by 2π/n maps boundaries onto themselves.

use crate::system::Pose;
use mainspring_geometry::Vec2;
use std::f64::consts::TAU;

/// A stretch of boundary seen from an axis: what must be mapped onto another one.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    /// A point that goes along; of a whole circle its centre.
    pub middle: Vec2,
    /// The same point twice for a whole circle, which begins anywhere.
    pub ends: [Vec2; 2],
    /// 0 for a line.
    pub radius: f64,
    /// Does it take part in contact?
    pub counts: bool,
}

/// The order n ≥ 1 of the rotational symmetry of all layers about the axis, to `tolerance` (a length); None for what looks
/// the same at every angle.
pub fn order(layers: &[Vec<Mark>], tolerance: f64) -> Option<u32> {
    let near = |p: Vec2, q: Vec2| (p - q).norm() <= tolerance;
    let anywhere = |m: &Mark| near(m.middle, Vec2::default()) && near(m.ends[0], m.ends[1]);
    let telling = |marks: &Vec<Mark>| marks.iter().copied().filter(|m| !anywhere(m)).collect();
    let layers: Vec<Vec<Mark>> = layers.iter().map(telling).collect();
    let fewest = layers.iter().map(Vec::len).filter(|&n| n > 0).min()?;
    let candidates = (2..=fewest).rev().filter(|n| layers.iter().all(|m| m.len() % n == 0));
    let mut found = candidates.filter(|&n| layers.iter().all(|m| maps_onto_itself(m, n, tolerance)));
    Some(found.next().unwrap_or(1) as u32)
}

fn maps_onto_itself(marks: &[Mark], n: usize, tolerance: f64) -> bool {
    let turn = Pose::turn(TAU / n as f64);
    let near = |p: Vec2, q: Vec2| (p - q).norm() <= tolerance;
    // Images follow each other along the outline as the marks do: the search goes on behind the last one found.
    let mut next = 0;
    marks.iter().all(|m| {
        let (middle, ends) = (turn.apply(m.middle), m.ends.map(|e| turn.apply(e)));
        let same = |o: &Mark| {
            let round = near(m.ends[0], m.ends[1]) && near(o.ends[0], o.ends[1]);
            near(o.middle, middle)
                && o.counts == m.counts
                && (o.radius - m.radius).abs() <= tolerance
                && (round || (near(o.ends[0], ends[0]) && near(o.ends[1], ends[1])))
        };
        let found = (next..marks.len()).chain(0..next).find(|&k| same(&marks[k]));
        next = found.map_or(next, |k| k + 1);
        found.is_some()
    })
}
