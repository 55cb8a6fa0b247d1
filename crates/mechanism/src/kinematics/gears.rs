//! Gear pairs from motion envelopes (Gelsey 1995, Algorithm 6).
//!
//! A gear is a cylinder marked `gear`. Two gears mesh when their envelopes overlap, their axes are parallel and
//! their parts turn about these axes in one carrier. Material inside the envelope makes an external gear, material
//! outside an internal one: that is read from the finished part.

use super::cylinder_fit;
use super::fits::Solid;
use super::near_miss::{Miss, Why};
use super::pair::{AxisLine, Evidence, EvidenceKind, Pair, PairKind};
use super::patch::Scene;
use super::surface::{Lateral, off_line, parallel};
use mainspring_geometry::CurveId;

/// A marked gear with its numbers.
#[derive(Clone, Debug)]
pub(crate) struct GearData {
    pub part: usize,
    pub members: Vec<Member>,
    pub teeth: Option<u32>,
    pub depth: Option<f64>,
    pub name: String,
}

/// A cylinder of a gear's envelope.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Member {
    pub lateral: Lateral,
    pub internal: bool,
}

/// Gear pairs, near misses, and the marks of which the use is in doubt.
#[derive(Debug, Default)]
pub(crate) struct Meshes {
    pub pairs: Vec<Pair>,
    pub misses: Vec<Miss>,
    pub warnings: Vec<String>,
}

/// Envelopes apart by more than this part of the smaller radius are no near miss.
const NEAR: f64 = 0.1;

/// Is the envelope hollow in its finished part? Where the surface is cut away, the marked solid decides (`adds`).
pub(crate) fn is_internal(scene: &Scene<'_>, solid: &Solid<'_>, lateral: &Lateral, adds: bool) -> bool {
    let meeting = cylinder_fit::meet(scene, [&solid.site, &solid.site], lateral, lateral);
    let seen = meeting.seen[0];
    if seen.solid == seen.hollow { !adds } else { seen.hollow }
}

pub(crate) fn meshes(gears: &[GearData], pairs: &[Pair], tolerance: f64) -> Meshes {
    let mut found = Meshes::default();
    for (i, a) in gears.iter().enumerate() {
        for b in &gears[i + 1..] {
            if a.part == b.part {
                continue;
            }
            let (a, b) = if a.part < b.part { (a, b) } else { (b, a) };
            for m in &a.members {
                for n in &b.members {
                    consider(&mut found, [a, b], [m, n], pairs, tolerance);
                }
            }
        }
    }
    found.pairs.sort_by_key(|p| p.parts);
    found.misses.sort_by_key(|m| m.parts);
    found
}

fn consider(
    found: &mut Meshes,
    gears: [&GearData; 2],
    members: [&Member; 2],
    pairs: &[Pair],
    tolerance: f64,
) {
    let [m, n] = members.map(|m| m.lateral);
    if !parallel(m.direction, n.direction) || cylinder_fit::common_span(&m, &n, tolerance).is_none() {
        return;
    }
    let apart = off_line(n.middle, m.middle, m.direction);
    let Some(overlap) = overlap(members, apart) else { return };
    let parts = (gears[0].part, gears[1].part);
    let primitives = [m.id.primitive, n.id.primitive];
    let mut miss = |why| found.misses.push(Miss { parts, primitives, why });
    if overlap <= tolerance {
        if -overlap <= NEAR * m.radius.min(n.radius) {
            miss(Why::GearsApart { by: -overlap });
        }
        return;
    }
    let depth = [gears[0].depth, gears[1].depth].into_iter().flatten().reduce(f64::min);
    if let Some(depth) = depth.filter(|d| overlap > d * (1.0 + 1e-9)) {
        return miss(Why::GearsTooDeep { overlap, depth });
    }
    let carriers = [0, 1].map(|i| carriers(pairs, gears[i].part, &members[i].lateral, tolerance));
    if let Some(i) = (0..2).find(|&i| carriers[i].is_empty()) {
        return miss(Why::GearOffAxis { part: i });
    }
    if !carriers[0].iter().any(|c| carriers[1].contains(c)) {
        return miss(Why::GearCarriers);
    }
    if found.pairs.iter().any(|p| p.parts == parts) {
        return;
    }
    let (teeth, warning) = teeth(gears);
    found.warnings.extend(warning);
    found.pairs.push(pair(parts, members, overlap, teeth, tolerance));
}

/// How deep the envelopes overlap: negative where they are apart, none where they lie within each other.
fn overlap(members: [&Member; 2], apart: f64) -> Option<f64> {
    let [m, n] = members.map(|m| m.lateral.radius);
    match members.map(|m| m.internal) {
        [false, false] => (apart > (m - n).abs()).then_some(m + n - apart),
        [true, true] => None,
        [first, _] => {
            let (ring, pinion) = if first { (m, n) } else { (n, m) };
            (pinion < ring && apart < ring && apart > 0.0).then_some(apart + pinion - ring)
        }
    }
}

/// The parts in which `part` turns about the gear's axis.
fn carriers(pairs: &[Pair], part: usize, gear: &Lateral, tolerance: f64) -> Vec<usize> {
    let about = |p: &&Pair| {
        p.is_lower()
            && p.kind.turns()
            && (p.parts.0 == part || p.parts.1 == part)
            && parallel(p.axis.direction, gear.direction)
            && off_line(gear.middle, p.axis.point, p.axis.direction) <= 10.0 * tolerance
    };
    pairs.iter().filter(about).map(|p| p.other(part)).collect()
}

fn teeth(gears: [&GearData; 2]) -> (Option<(u32, u32)>, Option<String>) {
    match gears.map(|g| g.teeth) {
        [Some(a), Some(b)] => (Some((a, b)), None),
        [None, None] => (None, None),
        [a, _] => {
            let without = if a.is_none() { 0 } else { 1 };
            let (with, without) = (&gears[1 - without].name, &gears[without].name);
            let text = format!(
                "gear {with} has a number of teeth and {without}, in mesh with it, has none: their ratio is taken from the diameters"
            );
            (None, Some(text))
        }
    }
}

fn pair(
    parts: (usize, usize),
    members: [&Member; 2],
    overlap: f64,
    teeth: Option<(u32, u32)>,
    tolerance: f64,
) -> Pair {
    let [m, n] = members.map(|m| m.lateral);
    let internal = members[0].internal || members[1].internal;
    let sizes = teeth.map_or(m.radius / n.radius, |(a, b)| f64::from(a) / f64::from(b));
    let direction = m.direction;
    let point = super::surface::foot(m.middle, direction, tolerance);
    let evidence = Evidence {
        what: EvidenceKind::Mesh { overlap, internal },
        primitives: [m.id.primitive, n.id.primitive],
        text: String::new(),
    };
    let curves = |l: &Lateral| vec![CurveId { primitive: l.id.primitive, face: 0 }];
    Pair {
        kind: PairKind::Gear,
        shape_kind: PairKind::Gear,
        parts,
        axis: AxisLine { point, direction },
        ratio: Some(if internal { sizes } else { -sizes }),
        clearance: 0.0,
        evidence: vec![evidence],
        dropped: vec![],
        surfaces: [curves(&m), curves(&n)],
    }
}
