//! Everything in which two parts fit each other: shafts in holes, faces on faces; and what nearly does.

use super::bounds::Bounds;
use super::cylinder_fit;
use super::patch::{Meeting, Scene, Seen, Site};
use super::plane_fit::{self, PlanePatch};
use super::surface::{Face, Lateral, off_line, parallel};
use mainspring_geometry::Vec3;

/// A part with its surfaces, as the search sees it.
pub(crate) struct Solid<'a> {
    pub site: Site<'a>,
    pub bounds: Bounds,
    pub laterals: Vec<Lateral>,
    pub faces: Vec<Face>,
}

/// A shaft of one part in a hole of the other.
#[derive(Debug)]
pub(crate) struct ShaftFit {
    pub laterals: [Lateral; 2],
    /// Which of the two has the material inside.
    pub solid: usize,
    pub clearance: f64,
    /// Along the axis, from the middle of the first lateral.
    pub span: (f64, f64),
    /// Angles about the axis where they meet, from the first direction of `across`.
    pub arcs: Vec<(f64, f64)>,
}

/// Two coaxial (or nearly coaxial) cylinders that do not fit, and what was seen of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShaftMiss {
    pub laterals: [Lateral; 2],
    /// Distance of the axes.
    pub offset: f64,
    /// No common stretch of the axis, by this length.
    pub gap: Option<f64>,
    pub seen: [Seen; 2],
}

/// Radii further apart than this part of the larger one are no near miss.
const NEAR_RADIUS: f64 = 0.25;
/// Axes further apart than this part of the radius are no near miss.
const NEAR_OFFSET: f64 = 0.1;
/// Cylinders on one axis further apart than this many times their heights are no near miss.
const NEAR_GAP: f64 = 2.0;
/// Face pairs examined for each pair of parts.
const MAX_FACE_PAIRS: usize = 10_000;
/// Work that a near miss kept in mind costs, and two faces near each other.
const MISS: usize = 50;
const FACE_PAIR: usize = 16;
/// Of faces across the axis only the largest are examined.
const MAX_END_PAIRS: usize = 500;

/// How far outside a part's box another may lie that is still a near miss of one of its cylinders, with the
/// surfaces on which that is judged: radii differ by a third of the smaller one at most.
pub(crate) fn near_reach(solid: &Solid<'_>) -> f64 {
    let radii = NEAR_OFFSET + NEAR_RADIUS / (1.0 - NEAR_RADIUS);
    solid.laterals.iter().map(|l| NEAR_GAP * l.height + radii * l.radius).fold(0.0, f64::max)
}

pub(crate) fn shafts(
    scene: &Scene<'_>,
    solids: [&Solid<'_>; 2],
    clearance: f64,
) -> (Vec<ShaftFit>, Vec<ShaftMiss>) {
    let (mut fits, mut misses) = (Vec::new(), Vec::new());
    for a in &solids[0].laterals {
        if !scene.work.spend(solids[1].laterals.len() / 8 + 1) {
            break;
        }
        for b in &solids[1].laterals {
            // What was not looked at is no near miss.
            if scene.work.ran_out() {
                break;
            }
            let difference = (a.radius - b.radius).abs();
            let larger = a.radius.max(b.radius);
            if difference > NEAR_RADIUS * larger + clearance || !parallel(a.direction, b.direction) {
                continue;
            }
            let offset = off_line(b.middle, a.middle, a.direction);
            let laterals = [*a, *b];
            let miss = |gap, seen| ShaftMiss { laterals, offset, gap, seen };
            if offset > scene.tolerance {
                if offset <= NEAR_OFFSET * larger && difference <= scene.tolerance {
                    let meeting = cylinder_fit::meet(scene, [&solids[0].site, &solids[1].site], a, b);
                    misses.push(miss(None, meeting.seen));
                }
                continue;
            }
            if cylinder_fit::common_span(a, b, scene.tolerance).is_none() {
                let apart = (b.middle - a.middle).dot(a.direction).abs() - 0.5 * (a.height + b.height);
                if difference <= scene.tolerance && apart <= NEAR_GAP * (a.height + b.height) {
                    misses.push(miss(Some(apart.max(0.0)), [Seen::default(); 2]));
                    scene.work.spend(MISS);
                }
                continue;
            }
            let meeting = cylinder_fit::meet(scene, [&solids[0].site, &solids[1].site], a, b);
            scene.work.spend(MISS);
            if scene.work.ran_out() {
                break;
            }
            match shaft_fit(laterals, &meeting, difference, clearance, scene.tolerance) {
                Some(fit) => fits.push(fit),
                None => misses.push(miss(None, meeting.seen)),
            }
        }
    }
    (fits, misses)
}

fn shaft_fit(
    laterals: [Lateral; 2],
    meeting: &Meeting,
    difference: f64,
    clearance: f64,
    tolerance: f64,
) -> Option<ShaftFit> {
    let exact = difference <= tolerance;
    if !exact && difference > clearance + tolerance {
        return None;
    }
    let smaller_first = laterals[0].radius < laterals[1].radius;
    let first = meeting.cells.first()?;
    let first_is_solid = if exact { first.first_is_solid } else { smaller_first };
    let mut cells = meeting.cells.iter().filter(|c| c.first_is_solid == first_is_solid).peekable();
    cells.peek()?;
    let (mut span, mut arcs) = ((f64::INFINITY, f64::NEG_INFINITY), Vec::<(f64, f64)>::new());
    for cell in cells {
        span = (span.0.min(cell.t.0), span.1.max(cell.t.1));
        match arcs.last_mut() {
            Some(last) if cell.s.0 <= last.1 => last.1 = last.1.max(cell.s.1),
            _ => arcs.push(cell.s),
        }
    }
    let clearance = if exact { 0.0 } else { difference };
    Some(ShaftFit { laterals, solid: usize::from(!first_is_solid), clearance, span, arcs })
}

/// All patches in which plane faces of the two parts meet, at a distance up to `clearance`. `wanted` says whether
/// faces of a normal matter; true with the patches if not all could be examined.
pub(crate) fn face_patches(
    scene: &Scene<'_>,
    solids: [&Solid<'_>; 2],
    clearance: f64,
    wanted: impl Fn(Vec3) -> bool,
) -> (Vec<PlanePatch>, bool) {
    let pairs = face_pairs(scene, solids, clearance + scene.tolerance, wanted);
    let examined = pairs.iter().take(MAX_FACE_PAIRS);
    let sites = [&solids[0].site, &solids[1].site];
    let patches = examined.flat_map(|(a, b)| plane_fit::meet(scene, sites, a, b)).collect();
    (patches, pairs.len() > MAX_FACE_PAIRS)
}

/// Patches that block motion along `d`: the first found in either sense of each.
pub(crate) fn end_patches(scene: &Scene<'_>, solids: [&Solid<'_>; 2], d: Vec3) -> Vec<PlanePatch> {
    let sites = [&solids[0].site, &solids[1].site];
    let mut found: Vec<PlanePatch> = Vec::new();
    let mut pairs = face_pairs(scene, solids, scene.tolerance, |n| parallel(n, d));
    // Large faces first: they are the likeliest to stop a part. Equal ones stay in the order of the text.
    let size = |(a, b): &(Face, Face)| a.area().min(b.area());
    pairs.sort_by(|p, q| size(q).total_cmp(&size(p)));
    for (a, b) in pairs.iter().take(MAX_END_PAIRS) {
        for patch in plane_fit::meet(scene, sites, a, b) {
            if !found.iter().any(|p| p.normal.dot(patch.normal) > 0.0) {
                found.push(patch);
            }
        }
        if found.len() == 2 {
            break;
        }
    }
    found
}

/// Faces in parallel planes at most `reach` apart, the first face's normal pointing to the second where they do
/// not coincide. If the work runs out, some are missing.
pub(crate) fn face_pairs(
    scene: &Scene<'_>,
    solids: [&Solid<'_>; 2],
    reach: f64,
    wanted: impl Fn(Vec3) -> bool,
) -> Vec<(Face, Face)> {
    let near = |of: &Solid<'_>, other: &Solid<'_>| -> Vec<(Face, Bounds)> {
        let zone = other.bounds.grown(reach);
        let boxed = of.faces.iter().map(|f| (*f, Bounds::of_points(f.corners()).grown(reach)));
        boxed.filter(|(f, b)| b.touches(&zone) && wanted(f.normal)).collect()
    };
    let (first, second) = (near(solids[0], solids[1]), near(solids[1], solids[0]));
    let mut pairs = Vec::new();
    for (a, around_a) in &first {
        let before = pairs.len();
        if !scene.work.spend(second.len() / 8 + 1) {
            break;
        }
        for (b, around_b) in &second {
            let gap = (b.middle - a.middle).dot(a.normal);
            if gap.abs() <= reach && around_a.touches(around_b) && parallel(a.normal, b.normal) {
                let normal = if gap < 0.0 { -a.normal } else { a.normal };
                pairs.push((Face { normal, ..*a }, *b));
            }
        }
        if !scene.work.spend(FACE_PAIR * (pairs.len() - before)) {
            break;
        }
    }
    pairs
}
