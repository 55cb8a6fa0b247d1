//! Where two coincident surfaces meet in the finished parts.
//!
//! The surface is cut into cells by everything that reaches it: scan lines within every interval between events,
//! and along each line the exact crossings with every wall. A cell counts if the material of one part lies behind
//! the surface and that of the other ahead of it, both judged at a point within the cell.

use super::bounds::Bounds;
use super::region::{Carrier, Member, Region, Sides, Thread, within};
use super::work::Work;
use mainspring_geometry::Vec3;

/// A piece of surface where the parts meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// Interval of the scan parameter: an angle (radians) or a length.
    pub s: (f64, f64),
    /// Interval along the scan line.
    pub t: (f64, f64),
    /// The first part's material lies behind the surface (its normal points out of the first part).
    pub first_is_solid: bool,
}

/// What was found on a surface, also where the parts do not meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Seen {
    pub solid: bool,
    pub hollow: bool,
}

#[derive(Debug, Default)]
pub(crate) struct Meeting {
    pub cells: Vec<Cell>,
    /// How the surface of the first and of the second part was seen.
    pub seen: [Seen; 2],
}

/// A scan line: where it starts on the surface of the first and of the second part (they differ by the
/// clearance), its unit direction, and the surface's normal along it.
pub(crate) struct Line {
    pub from: [Vec3; 2],
    pub along: Vec3,
    pub normal: Vec3,
}

/// At most this many scan lines are laid over one surface.
const MAX_LINES: usize = 2048;
/// Bound on scan lines times the squared number of primitives that reach the surface.
const MAX_WORK: usize = 400_000;

/// Scans a surface. `breaks` are the events of the scan parameter, its ends included; `span` tells the interval
/// of a line that counts, if any; pieces narrower than `least_s` or `tolerance` are not counted. Where `work` runs
/// out, nothing is told.
#[allow(clippy::too_many_arguments)]
pub(crate) fn scan(
    regions: [&Region; 2],
    mut breaks: Vec<f64>,
    span: impl Fn(&Line) -> Option<(f64, f64)>,
    least_s: f64,
    tolerance: f64,
    work: &Work,
    line: impl Fn(f64) -> Line,
) -> Meeting {
    breaks.sort_by(f64::total_cmp);
    let mut meeting = Meeting::default();
    let members: usize = regions.iter().map(|r| r.members.len()).sum();
    let lines = (MAX_WORK / (members * members).max(1)).clamp(24, MAX_LINES);
    let stride = breaks.len().div_ceil(lines).max(1);
    let mut from = breaks[0];
    for &to in breaks[1..].iter().step_by(stride).chain(breaks.last()) {
        if to - from > least_s {
            let line = line(within(from, to));
            if let Some(span) = span(&line) {
                let thorough = scan_line(regions, &line, (from, to), span, tolerance, work, &mut meeting);
                if !thorough {
                    return Meeting::default();
                }
            }
            from = to;
        }
    }
    meeting
}

/// False if the work ran out.
fn scan_line(
    regions: [&Region; 2],
    line: &Line,
    s: (f64, f64),
    span: (f64, f64),
    tolerance: f64,
    work: &Work,
    meeting: &mut Meeting,
) -> bool {
    let mut cuts = vec![span.0, span.1];
    if !work.spend(regions.iter().map(|r| r.members.len()).sum::<usize>() + 8) {
        return false;
    }
    let threads = [0, 1].map(|i| regions[i].along(line.from[i], line.along));
    for (thread, from) in threads.iter().zip(line.from) {
        thread.crossings(from, line.along, &mut cuts);
    }
    cuts.retain(|&t| t >= span.0 && t <= span.1);
    cuts.sort_by(f64::total_cmp);
    let cost: usize = threads.iter().map(Thread::cost).sum();
    if !work.spend(cuts.len() * (2 * cost + 1)) {
        return false;
    }
    let mut stack = Vec::new();
    let mut from = cuts[0];
    for &to in &cuts[1..] {
        if to - from <= tolerance {
            continue;
        }
        let middle = line.along * within(from, to);
        let [a, b] = [0, 1].map(|i| threads[i].sides(line.from[i] + middle, line.normal, &mut stack));
        note(&mut meeting.seen, a, b);
        if (a.is_solid() && b.is_hollow()) || (a.is_hollow() && b.is_solid()) {
            meeting.cells.push(Cell { s, t: (from, to), first_is_solid: a.is_solid() });
        }
        from = to;
    }
    true
}

fn note(seen: &mut [Seen; 2], a: Sides, b: Sides) {
    for (seen, sides) in seen.iter_mut().zip([a, b]) {
        seen.solid |= sides.is_solid();
        seen.hollow |= sides.is_hollow();
    }
}

/// A part as the search for pairs sees it.
pub(crate) struct Site<'a> {
    pub csg: &'a mainspring_geometry::Csg,
}

/// What every search needs: all primitives, their boxes, the tolerance as a length, and the work allowed.
pub(crate) struct Scene<'a> {
    pub primitives: &'a [mainspring_geometry::Primitive],
    pub boxes: &'a [Bounds],
    pub tolerance: f64,
    pub work: Work,
}

impl Scene<'_> {
    /// What it costs to see which primitives of two parts reach a place.
    pub(crate) fn primitives_of(&self, sites: [&Site<'_>; 2]) -> usize {
        // Most are passed by at once.
        sites.iter().map(|s| s.csg.ops.len() / 8).sum()
    }

    pub(crate) fn member(&self, i: u32, carrier: Carrier) -> Member {
        let (primitive, bounds) = (&self.primitives[i as usize], self.boxes[i as usize]);
        Member::new(primitive, bounds, carrier, self.tolerance)
    }

    pub(crate) fn region(&self, site: &Site<'_>, near: &Bounds, carrier: Carrier) -> Region {
        Region::new(self.primitives, site.csg, self.boxes, near, carrier, self.tolerance)
    }
}
