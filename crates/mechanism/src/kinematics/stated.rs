//! Pairs that the machine's file states: how a part moves on its carrier, and which parts mesh as gears.
//!
//! A stated pair takes the place of what shapes say about the same two parts; where shapes say something else, a
//! warning tells so. Stated motion lies in the plane z = 0.

use super::mechanism::{Part, Warning};
use super::near_miss::number;
use super::pair::{AxisLine, Evidence, EvidenceKind, Pair, PairKind};
use super::surface::{off_line, parallel};
use mainspring_geometry::{CurveId, Segment, Vec2, Vec3};
use mainspring_model::{GearPairData, MotionData, MotionKind, Supplement};

/// Puts the stated pairs in place of found ones and adds stated gears.
pub(crate) fn apply(
    pairs: &mut Vec<Pair>,
    stated: &Supplement,
    frame: usize,
    tolerance: f64,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let on = |part: usize| stated.motions.iter().find(|m| m.part == part).map(|m| m.carrier);
    for motion in &stated.motions {
        let own = pair(motion);
        let is_same = |p: &Pair| p.is_lower() && p.parts == own.parts;
        let said = pairs.iter().find(|p| is_same(p)).filter(|found| !agrees(found, &own, tolerance));
        warnings.extend(said.map(|found| disagreement(motion, found)));
        // Of the parts that move as stated, or do not move, no other carries this one.
        let carries = |other: usize| on(other) == Some(motion.part) || on(other).is_none() && other != frame;
        pairs.retain(|p| {
            let involved = p.is_lower() && (p.parts.0 == motion.part || p.parts.1 == motion.part);
            !involved || (!is_same(p) && (carries(p.other(motion.part)) || is_stated(p)))
        });
        pairs.push(own);
    }
    pairs.sort_by_key(|p| (!p.is_lower(), p.parts));
    for gear in &stated.gears {
        match mesh(pairs, gear) {
            Some(pair) => pairs.push(pair),
            None => {
                let message = "these parts are stated to mesh and do not both turn: the line is left out";
                let parts = gear.parts.to_vec();
                warnings.push(Warning { place: Some(gear.place), parts, message: message.to_string() });
            }
        }
    }
    pairs.sort_by_key(|p| (!p.is_lower(), p.parts));
    warnings
}

fn is_stated(pair: &Pair) -> bool {
    pair.evidence.iter().any(|e| matches!(e.what, EvidenceKind::Stated))
}

fn pair(motion: &MotionData) -> Pair {
    let z = Vec3::new(0.0, 0.0, 1.0);
    let (kind, axis) = match motion.kind {
        MotionKind::Turns { center: [x, y] } => {
            (PairKind::Revolute, AxisLine { point: Vec3::new(x, y, 0.0), direction: z })
        }
        MotionKind::Slides { direction: [x, y] } => {
            let length = x.hypot(y);
            let direction = Vec3::new(x / length, y / length, 0.0);
            (PairKind::Prismatic, AxisLine { point: Vec3::default(), direction })
        }
        MotionKind::Fixed => (PairKind::Fixed, AxisLine { point: Vec3::default(), direction: z }),
    };
    let (low, high) = (motion.part.min(motion.carrier), motion.part.max(motion.carrier));
    of(kind, (low, high), axis, None)
}

fn of(kind: PairKind, parts: (usize, usize), axis: AxisLine, ratio: Option<f64>) -> Pair {
    let evidence = Evidence { what: EvidenceKind::Stated, primitives: [0, 0], text: String::new() };
    Pair {
        kind,
        shape_kind: kind,
        parts,
        axis,
        ratio,
        clearance: 0.0,
        evidence: vec![evidence],
        dropped: vec![],
        surfaces: [vec![], vec![]],
    }
}

/// Does what shapes say allow the stated motion?
fn agrees(found: &Pair, stated: &Pair, tolerance: f64) -> bool {
    match stated.kind {
        PairKind::Revolute => {
            let offset = off_line(stated.axis.point, found.axis.point, found.axis.direction);
            found.kind.turns()
                && parallel(found.axis.direction, stated.axis.direction)
                && offset <= found.clearance + 100.0 * tolerance
        }
        PairKind::Prismatic => found.kind.slides() && parallel(found.axis.direction, stated.axis.direction),
        _ => true,
    }
}

fn disagreement(motion: &MotionData, found: &Pair) -> Warning {
    let (p, d) = (found.axis.point, found.axis.direction);
    let message = format!(
        "by their shapes they form a {} pair at ({}, {}, {}) along ({}, {}, {}); the stated motion is used",
        found.kind.name(),
        number(p.x),
        number(p.y),
        number(p.z),
        number(d.x),
        number(d.y),
        number(d.z)
    );
    let parts = vec![found.parts.0, found.parts.1];
    Warning { place: Some(motion.place), parts, message }
}

/// Velocity of the second part over that of the first: −z₁/z₂, + if one has its teeth inside.
fn mesh(pairs: &[Pair], gear: &GearPairData) -> Option<Pair> {
    let turning = |part: usize| {
        pairs.iter().find(|p| p.kind == PairKind::Revolute && (p.parts.0 == part || p.parts.1 == part))
    };
    let ([mut a, mut b], [mut m, mut n]) = (gear.parts, gear.teeth);
    if a > b {
        (a, b, m, n) = (b, a, n, m);
    }
    let (first, _) = (turning(a)?, turning(b)?);
    let size = f64::from(m) / f64::from(n);
    let ratio = if gear.internal { size } else { -size };
    Some(of(PairKind::Gear, (a, b), first.axis, Some(ratio)))
}

/// The surfaces along which stated pairs slide: arcs about the axis, lines along the direction. Between the two parts
/// their gaps never change.
pub(crate) fn find_surfaces(pairs: &mut [Pair], parts: &[Part], tolerance: f64) {
    for pair in pairs.iter_mut().filter(|p| p.is_lower() && is_stated(p)) {
        let (point, d) = (pair.axis.point, pair.axis.direction);
        let (center, along) = (Vec2::new(point.x, point.y), Vec2::new(d.x, d.y));
        let keeps = |s: &Segment| match (pair.kind, *s) {
            (PairKind::Prismatic, Segment::Line { from, to }) => {
                (to - from).unit().cross(along).abs() <= 1e-9
            }
            (PairKind::Revolute, Segment::Arc { center: c, .. } | Segment::Circle { center: c, .. }) => {
                (c - center).norm() <= 10.0 * tolerance
            }
            _ => false,
        };
        let curves = |part: usize| -> Vec<CurveId> {
            let layers = parts[part].outline.iter().flat_map(|o| &o.layers);
            let edges = layers.flat_map(|l| &l.loops).flat_map(|l| &l.edges);
            let mut found: Vec<CurveId> = edges
                .filter(|e| keeps(&e.segment))
                .flat_map(|e| std::iter::once(e.curve).chain(e.aliases.iter().copied()))
                .collect();
            found.sort_unstable();
            found.dedup();
            found
        };
        pair.surfaces = [curves(pair.parts.0), curves(pair.parts.1)];
    }
}
