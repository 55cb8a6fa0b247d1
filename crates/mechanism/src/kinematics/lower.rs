//! All lower pairs of a machine, and what nearly was one.

use super::bounds::Bounds;
use super::fits::{Solid, near_reach};
use super::local::{local, nearby};
use super::near_miss::{Miss, relevant};
use super::neighbours::neighbours;
use super::pair::Pair;
use super::patch::{Scene, Site};
use super::search::{self, Found};
use super::surface::{faces, lateral};
use mainspring_geometry::{Csg, Primitive};

/// Lower pairs in the order of the parts, and near misses.
pub(crate) struct Lower {
    pub pairs: Vec<Pair>,
    pub misses: Vec<Miss>,
    /// Parts with more faces against each other than are examined.
    pub cut_short: Vec<(usize, usize)>,
    /// Near misses were not looked for everywhere.
    pub misses_cut_short: bool,
    /// More parts are near each other than are examined.
    pub crowded: bool,
}

/// A point is on a surface within this part of the machine's size.
pub(crate) const RELATIVE_TOLERANCE: f64 = 1e-9;

/// Bound on the work for the surfaces of two parts, and again for what they leave free; of that for all.
pub(crate) const PAIR_WORK: u64 = 6_000_000;
/// Bound on the work for a near miss.
const MISS_WORK: u64 = 1_000_000;

/// Parts near each other that are examined, two by two.
pub(crate) const MAX_NEIGHBOURS: usize = 100_000;

/// Near misses told of one machine.
pub(crate) const MAX_MISSES: usize = 200;

/// The part's solid and its surfaces.
pub(crate) fn solid<'a>(primitives: &[Primitive], boxes: &[Bounds], csg: &'a Csg) -> Solid<'a> {
    let mut leaves: Vec<u32> = csg.leaves().collect();
    leaves.sort_unstable();
    leaves.dedup();
    let of = |i: &u32| &primitives[*i as usize];
    Solid {
        site: Site { csg },
        bounds: leaves.iter().fold(Bounds::EMPTY, |b, i| b.join(&boxes[*i as usize])),
        laterals: leaves.iter().filter_map(|i| lateral(*i, of(i))).collect(),
        faces: leaves.iter().flat_map(|i| faces(*i, of(i))).collect(),
    }
}

pub(crate) fn lower_pairs(scene: &Scene<'_>, solids: &[Solid<'_>], clearance: f64) -> Lower {
    let mut findings = Vec::new();
    // Parts further from each other than this form no pair and miss none.
    let reach = |s: &Solid<'_>| s.bounds.grown(near_reach(s) + clearance + 2.0 * scene.tolerance);
    let reaches: Vec<Bounds> = solids.iter().map(reach).collect();
    let candidates = neighbours(&reaches, MAX_NEIGHBOURS);
    for (i, j) in candidates.pairs {
        scene.work.open(PAIR_WORK);
        let zone = reaches[i].common(&reaches[j]).grown(4.0 * scene.tolerance);
        let mut finding = find(scene, [&solids[i], &solids[j]], (i, j), clearance, &zone);
        finding.too_many_faces |= scene.work.ran_out() || !scene.work.spend(1);
        let near = solids[i].bounds.touches(&solids[j].bounds);
        if near || finding.too_many_faces || finding.says_something() {
            findings.push(((i, j), finding));
        }
    }
    findings.sort_by_key(|(parts, _)| *parts);
    keep_needed(&mut findings, solids.len());
    let (mut misses, mut misses_cut_short) = (Vec::new(), false);
    for (parts, finding) in &findings {
        let pair = finding.pair.as_ref().map(|f| &f.pair);
        let mut found = relevant(*parts, finding, pair, scene.tolerance);
        if pair.is_none() && found.is_empty() {
            let pair = [&solids[parts.0], &solids[parts.1]];
            scene.work.open(MISS_WORK);
            found.extend(search::with_more_play(scene, pair).map(|(p, play)| Miss::play(*parts, p, play)));
        }
        misses_cut_short |= scene.work.ran_out();
        misses.extend(found);
        misses.truncate(MAX_MISSES + 1);
    }
    let cut_short = findings.iter().filter(|(_, f)| f.too_many_faces).map(|(parts, _)| *parts).collect();
    let pairs = findings.into_iter().filter_map(|(_, f)| f.pair).map(|f| f.pair).collect();
    Lower { pairs, misses, cut_short, misses_cut_short, crowded: candidates.cut_short }
}

/// Both parts are searched where they are near each other.
fn find(
    scene: &Scene<'_>,
    solids: [&Solid<'_>; 2],
    parts: (usize, usize),
    clearance: f64,
    zone: &Bounds,
) -> search::Finding {
    let csgs = solids.map(|s| nearby(scene, s, zone));
    let [a, b] = [0, 1].map(|k| csgs[k].as_ref().map(|csg| local(scene, solids[k], csg, zone)));
    let near = [a.as_ref().unwrap_or(solids[0]), b.as_ref().unwrap_or(solids[1])];
    search::find(scene, near, solids, parts, clearance)
}

/// A fit that leaves a way out holds only while something keeps the part in it: it makes a pair for a part that has
/// no closed pair, and else is left to contact.
fn keep_needed(findings: &mut [((usize, usize), search::Finding)], parts: usize) {
    let mut closed = vec![false; parts];
    let is_closed = |f: &Found| !f.open;
    for ((i, j), finding) in findings.iter() {
        if finding.pair.as_ref().is_some_and(is_closed) {
            (closed[*i], closed[*j]) = (true, true);
        }
    }
    for ((i, j), finding) in findings.iter_mut() {
        if closed[*i] && closed[*j] && finding.pair.as_ref().is_some_and(|f| f.open) {
            finding.left_open = finding.pair.take().map(|f| f.pair.evidence[0].primitives);
        }
    }
}
