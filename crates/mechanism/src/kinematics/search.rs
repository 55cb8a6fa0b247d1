//! The pair two parts form by their shapes alone (Gelsey 1995, Algorithms 2 to 5).
//!
//! Algorithm 3 compares primitives; here the surfaces of the finished parts are compared. All places where the
//! parts meet are taken together (which merges several bearings into one pair), and the motions they leave are
//! read from the section across the common direction and from the faces that block motion along it.

use super::fit::Fit;
use super::fits::{ShaftFit, ShaftMiss, Solid, end_patches, face_pairs, face_patches, shafts};
use super::lower::PAIR_WORK;
use super::pair::{Pair, PairKind};
use super::patch::Scene;
use super::plane_fit::PlanePatch;
use super::section::{Section, Wall, may_turn, section, wall};
use super::surface::{across, canonical, parallel, perpendicular};
use super::work::Work;
use mainspring_geometry::{Vec2, Vec3};

/// What the shapes of two parts say about each other.
#[derive(Debug, Default)]
pub(crate) struct Finding {
    pub pair: Option<Found>,
    /// Cylinders that fit nothing.
    pub misses: Vec<ShaftMiss>,
    /// The parts fit somewhere, but the fit leaves too much free, or is not centred.
    pub loose: Option<Loose>,
    /// A fit with a way out that was left to contact.
    pub left_open: Option<[u32; 2]>,
    /// Not all faces could be examined.
    pub too_many_faces: bool,
}

impl Finding {
    pub(crate) fn says_something(&self) -> bool {
        self.pair.is_some() || self.loose.is_some() || !self.misses.is_empty()
    }
}

#[derive(Debug)]
pub(crate) struct Found {
    pub pair: Pair,
    /// The surfaces leave a way out: counts only for parts that have no closed pair.
    pub open: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Loose {
    /// Shaft and hole meet over this angle only (radians).
    Arc { primitives: [u32; 2], angle: f64 },
    /// Opposite faces, but no section closed by them.
    Faces { primitives: [u32; 2] },
    /// Play on opposite sides differs.
    OffCentre { primitives: [u32; 2], plays: (f64, f64) },
}

/// `solids` are the parts as far as they are near each other, `whole` all of them.
pub(crate) fn find(
    scene: &Scene<'_>,
    solids: [&Solid<'_>; 2],
    whole: [&Solid<'_>; 2],
    parts: (usize, usize),
    clearance: f64,
) -> Finding {
    let (fits, misses) = shafts(scene, solids, clearance);
    let mut finding = Finding { misses, ..Finding::default() };
    if !solids[0].bounds.grown(clearance + scene.tolerance).touches(&solids[1].bounds) {
        return finding;
    }
    let found = match fits.first() {
        Some(first) => {
            let d = first.laterals[0].direction;
            let (mut patches, cut) = face_patches(scene, solids, clearance, |n| perpendicular(n, d));
            patches.extend(end_patches(scene, solids, d));
            finding.too_many_faces = cut || scene.work.ran_out();
            // What was found is judged, however much it cost.
            scene.work.open(PAIR_WORK / 2);
            with_shaft(scene, &fits, patches)
        }
        None => faces_only(scene, solids, clearance),
    };
    match found {
        Ok(Some(fit)) => finding.pair = Some(fit.into_pair(scene, whole, parts)),
        Ok(None) => {}
        Err(loose) => finding.loose = Some(loose),
    }
    finding
}

/// Play up to this part of the smaller part's size is looked through for near misses.
const NEAR_PLAY: f64 = 0.05;
/// Parts with more faces near each other are not looked through for near misses.
const MAX_NEAR_FACES: usize = 400;

/// Would the faces of two parts make a pair if some play were allowed? The primitives and the play.
pub(crate) fn with_more_play(scene: &Scene<'_>, solids: [&Solid<'_>; 2]) -> Option<([u32; 2], f64)> {
    let play = NEAR_PLAY * solids[0].bounds.diagonal().min(solids[1].bounds.diagonal());
    if !solids[0].bounds.grown(play).touches(&solids[1].bounds)
        || face_pairs(scene, solids, play, |_| true).len() > MAX_NEAR_FACES
    {
        return None;
    }
    let fit = faces_only(scene, solids, play).ok()??;
    let gap = fit.patches.iter().map(|p| p.gap).fold(0.0, f64::max);
    (gap > scene.tolerance && fit.exit.is_none()).then(|| (fit.patches[0].primitives(), gap))
}

fn with_shaft(scene: &Scene<'_>, fits: &[ShaftFit], patches: Vec<PlanePatch>) -> Result<Option<Fit>, Loose> {
    let d = fits[0].laterals[0].direction;
    let origin = fits[0].laterals[0].middle;
    let make = |patches: &[PlanePatch], kind, exit| {
        let (fits, patches) = (fits.iter().map(ShaftFit::copy).collect(), patches.to_vec());
        Ok(Some(Fit { fits, patches, kind, point: origin, direction: d, exit }))
    };
    let ends = || -> Vec<PlanePatch> { patches.iter().filter(|p| parallel(p.normal, d)).cloned().collect() };
    if fits.iter().any(|f| !parallel(f.laterals[0].direction, d)) {
        return make(&patches, PairKind::Fixed, None);
    }
    let view = View::new(origin, d, fits, &patches);
    let slides = !blocked_both_ways(&patches, d);
    off_centre(scene, &patches, d)?;
    match around_shafts(&view.walls(fits, &[]), &view.walls(&[], &patches), &scene.work) {
        Section::Locked => make(&patches, PairKind::of_freedoms(false, slides), None),
        Section::LockedOpen { exit } => {
            make(&patches, PairKind::of_freedoms(false, slides), Some(view.lift(exit)))
        }
        // Faces that the part leans on are contact, not pair.
        Section::Turning { .. } => make(&ends(), PairKind::of_freedoms(true, slides), None),
        Section::TurningOpen { exit, .. } => {
            make(&ends(), PairKind::of_freedoms(true, slides), Some(view.lift(exit)))
        }
        Section::Free => {
            let angle = fits[0].arcs.iter().map(|a| a.1 - a.0).sum();
            Err(Loose::Arc { primitives: fits[0].primitives(), angle })
        }
    }
}

/// What shafts and side faces leave. A part that leans on a stop may still turn the other way: only faces that forbid
/// turning both ways count against a bearing.
fn around_shafts(shafts: &[Wall], faces: &[Wall], work: &Work) -> Section {
    let all = [shafts, faces].concat();
    match section(shafts, work) {
        Section::Turning { center } if may_turn(faces, center) => Section::Turning { center },
        Section::Turning { .. } => Section::Locked,
        Section::TurningOpen { center, exit } if may_turn(faces, center) => {
            Section::TurningOpen { center, exit }
        }
        _ => section(&all, work),
    }
}

/// A pair made by plane faces: a block in a hole, however the hole was made.
fn faces_only(scene: &Scene<'_>, solids: [&Solid<'_>; 2], clearance: f64) -> Result<Option<Fit>, Loose> {
    let candidates = face_pairs(scene, solids, clearance + scene.tolerance, |_| true);
    let Some((first, _)) = candidates.first() else { return Ok(None) };
    if candidates.iter().all(|(a, _)| parallel(a.normal, first.normal)) {
        return Ok(None);
    }
    let (patches, _) = face_patches(scene, solids, clearance, |_| true);
    let mut best: Option<(u32, Fit)> = None;
    let corners: usize = patches.iter().map(|p| p.corners.len()).sum();
    for d in directions(&patches) {
        if !scene.work.spend(corners) {
            break;
        }
        let origin = middle(scene, &patches, d);
        let view = View::new(origin, d, &[], &patches);
        let across_d: Vec<PlanePatch> =
            patches.iter().filter(|p| perpendicular(p.normal, d)).cloned().collect();
        let slides = !blocked_both_ways(&patches, d);
        let (rank, exit) = match section(&view.walls(&[], &across_d), &scene.work) {
            Section::Locked if slides => (0, None),
            Section::Locked => (1, None),
            Section::LockedOpen { exit } if slides => (2, Some(view.lift(exit))),
            Section::LockedOpen { exit } => (3, Some(view.lift(exit))),
            _ => continue,
        };
        off_centre(scene, &across_d, d)?;
        if best.as_ref().is_none_or(|(r, _)| rank < *r) {
            let kind = PairKind::of_freedoms(false, slides);
            best = Some((
                rank,
                Fit { fits: vec![], patches: patches.clone(), kind, point: origin, direction: d, exit },
            ));
        }
    }
    match best {
        Some((_, fit)) => Ok(Some(fit)),
        None => opposite(scene, &patches).map_or(Ok(None), |primitives| Err(Loose::Faces { primitives })),
    }
}

/// Two patches facing opposite ways: the parts embrace, yet form no pair.
fn opposite(scene: &Scene<'_>, patches: &[PlanePatch]) -> Option<[u32; 2]> {
    let against = |a: &PlanePatch, b: &PlanePatch| a.normal.dot(b.normal) < -1.0 + 1e-9;
    let meets = |i: usize| patches[..i].iter().any(|p| against(p, &patches[i]));
    let mut affordable = (0..patches.len()).take_while(|i| scene.work.spend(i / 8 + 1));
    let i = affordable.find(|&i| meets(i))?;
    Some(patches[i].primitives())
}

/// Directions along which at least two faces that are not parallel run.
fn directions(patches: &[PlanePatch]) -> Vec<Vec3> {
    let mut normals: Vec<Vec3> = Vec::new();
    for p in patches {
        if normals.len() < 24 && !normals.iter().any(|n| parallel(*n, p.normal)) {
            normals.push(p.normal);
        }
    }
    let mut found: Vec<Vec3> = Vec::new();
    for (i, a) in normals.iter().enumerate() {
        for b in &normals[..i] {
            let d = canonical(a.cross(*b).unit());
            if !found.iter().any(|f| parallel(*f, d)) {
                found.push(d);
            }
        }
    }
    found
}

/// A point of the axis of faces along `d`: the middle of the one block they belong to, else of the faces.
fn middle(scene: &Scene<'_>, patches: &[PlanePatch], d: Vec3) -> Vec3 {
    let used: Vec<&PlanePatch> = patches.iter().filter(|p| perpendicular(p.normal, d)).collect();
    for part in 0..2 {
        let Some(first) = used.first().map(|p| p.faces[part].id.primitive) else { continue };
        if used.iter().all(|p| p.faces[part].id.primitive == first) {
            let primitive = &scene.primitives[first as usize];
            let (low, high) = super::bounds::local_box(&primitive.shape);
            return primitive.machine_from_local.apply((low + high) * 0.5);
        }
    }
    let (mut sum, mut count) = (Vec3::default(), 0.0);
    for corner in used.iter().flat_map(|p| &p.corners) {
        sum = sum + *corner;
        count += 1.0;
    }
    sum * (1.0 / f64::max(count, 1.0))
}

fn blocked_both_ways(patches: &[PlanePatch], d: Vec3) -> bool {
    let blocks = |sign: f64| patches.iter().any(|p| parallel(p.normal, d) && p.normal.dot(d) * sign > 0.0);
    blocks(1.0) && blocks(-1.0)
}

/// Faces on opposite sides must have the same play, or the fit has no centre to keep.
fn off_centre(scene: &Scene<'_>, patches: &[PlanePatch], d: Vec3) -> Result<(), Loose> {
    let tolerance = scene.tolerance;
    // Patches with one normal and play are often many: the first of each speaks for all.
    let mut known: Vec<&PlanePatch> = Vec::new();
    for a in patches.iter().filter(|p| perpendicular(p.normal, d)) {
        if !scene.work.spend(known.len() / 8 + 1) {
            break;
        }
        for b in &known {
            let opposed = a.normal.dot(b.normal) < -1.0 + 1e-9;
            if opposed && (a.gap - b.gap).abs() > 4.0 * tolerance {
                return Err(Loose::OffCentre { primitives: a.primitives(), plays: (b.gap, a.gap) });
            }
        }
        let like =
            |b: &&PlanePatch| a.normal.dot(b.normal) > 1.0 - 1e-12 && (a.gap - b.gap).abs() <= tolerance;
        if !known.iter().any(like) {
            known.push(a);
        }
    }
    Ok(())
}

/// The section across a direction, in units of the fit's size.
struct View {
    origin: Vec3,
    axes: (Vec3, Vec3),
    d: Vec3,
    size: f64,
}

impl View {
    fn new(origin: Vec3, d: Vec3, fits: &[ShaftFit], patches: &[PlanePatch]) -> Self {
        let mut size: f64 = 0.0;
        for p in patches.iter().flat_map(|p| &p.corners) {
            size = size.max((*p - origin).cross(d).norm());
        }
        for lateral in fits.iter().flat_map(|f| &f.laterals) {
            size = size.max((lateral.middle - origin).cross(d).norm() + lateral.radius);
        }
        View { origin, axes: across(d), d, size: size.max(f64::MIN_POSITIVE) }
    }

    fn flat(&self, v: Vec3) -> Vec2 {
        Vec2::new(v.dot(self.axes.0), v.dot(self.axes.1))
    }

    fn lift(&self, v: Vec2) -> Vec3 {
        canonical_noise(self.axes.0 * v.x + self.axes.1 * v.y)
    }

    fn walls(&self, fits: &[ShaftFit], patches: &[PlanePatch]) -> Vec<Wall> {
        let mut walls = Vec::new();
        let place = |p: Vec3| self.flat(p - self.origin) * (1.0 / self.size);
        for fit in fits {
            let lateral = &fit.laterals[0];
            let (u, v) = across(lateral.direction);
            for angle in fit.arcs.iter().flat_map(|arc| spread(*arc)) {
                let (sin, cos) = angle.sin_cos();
                let out = u * cos + v * sin;
                let normal = if fit.solid == 0 { out } else { -out };
                walls.push(wall(place(lateral.middle + out * lateral.radius), self.flat(normal)));
            }
        }
        for patch in patches.iter().filter(|p| perpendicular(p.normal, self.d)) {
            let side = patch.normal.cross(self.d);
            let reach = |a: &&Vec3, b: &&Vec3| a.dot(side).total_cmp(&b.dot(side));
            let ends = [patch.corners.iter().min_by(reach), patch.corners.iter().max_by(reach)];
            walls.extend(ends.into_iter().flatten().map(|p| wall(place(*p), self.flat(patch.normal))));
        }
        walls
    }
}

fn canonical_noise(v: Vec3) -> Vec3 {
    let clean = |c: f64| if c.abs() < 1e-12 { 0.0 } else { c };
    Vec3::new(clean(v.x), clean(v.y), clean(v.z))
}

/// Angles over an arc, ends included, at most a quarter turn apart.
fn spread((from, to): (f64, f64)) -> impl Iterator<Item = f64> {
    let steps = ((to - from) / std::f64::consts::FRAC_PI_2).ceil().max(1.0) as usize;
    (0..=steps).map(move |k| from + (to - from) * k as f64 / steps as f64)
}
