//! Where parts stand at given joint positions, and whether they overlap at the start.

use super::bounds::Bounds;
use super::chain::turn;
use super::lower::MAX_NEIGHBOURS;
use super::mechanism::{Mechanism, Warning};
use super::neighbours::neighbours;
use super::pair::{EvidenceKind, Pair, PairKind};
use super::start::{Envelopes, Extent, Start};
use super::work::Work;
use mainspring_geometry::{OutlineBudget, OutlineError, Primitive, Rigid3, Vec3};
use mainspring_model::Error;
use std::cell::Cell;
use std::collections::BTreeMap;

/// Bound on the scans for overlaps.
const MAX_WORK: u64 = 8_000_000;

impl Mechanism {
    /// Where each part has moved from its modelled place at the initial positions: machine_from_modelled.
    pub fn start_poses(&self) -> Vec<Rigid3> {
        (0..self.parts.len()).map(|p| self.start_pose(p)).collect()
    }

    fn start_pose(&self, part: usize) -> Rigid3 {
        let (mut pose, mut at) = (Rigid3::identity(), part);
        // At most as many carriers as parts.
        for _ in 0..self.parts.len() {
            let (Some(joint), Some(carrier)) = (self.parts[at].joint, self.parts[at].carrier) else { break };
            let (pair, x) = (&self.pairs[joint], self.parts[at].position);
            let motion = match pair.kind {
                PairKind::Prismatic => Rigid3::translation(pair.axis.direction * x),
                PairKind::Fixed => Rigid3::identity(),
                _ if x == 0.0 => Rigid3::identity(),
                _ => turn(pair.axis.point, pair.axis.direction, x),
            };
            pose = motion.then_after(&pose);
            at = carrier;
        }
        pose
    }

    /// All primitives at the initial positions.
    pub fn start_primitives(&self) -> Vec<Primitive> {
        let mut primitives = self.primitives.clone();
        for (part, pose) in self.parts.iter().zip(self.start_poses()) {
            if pose != Rigid3::identity() {
                for i in part.csg.leaves() {
                    let p = &mut primitives[i as usize];
                    p.machine_from_local = pose.then_after(&self.primitives[i as usize].machine_from_local);
                }
            }
        }
        primitives
    }

    /// Parts that overlap at the start are an error; where the work for it runs out, a warning says so.
    pub(crate) fn check_start(&self) -> Result<Option<Warning>, Error> {
        let primitives = self.start_primitives();
        let boxes: Vec<Bounds> = primitives.iter().map(Bounds::of).collect();
        let plane = &self.plane.plane_from_machine;
        let csgs = self.parts.iter().map(|p| &p.csg);
        let extents: Vec<Extent<'_>> = csgs.map(|c| Extent::of(c, &primitives, &boxes, plane)).collect();
        let bounds: Vec<Bounds> = extents.iter().map(|e| e.bounds).collect();
        let start = Start {
            primitives: &primitives,
            boxes: &boxes,
            plane_from_machine: *plane,
            tolerance: self.tolerance,
            work: Work::new(MAX_WORK),
            budget: Cell::new(OutlineBudget::default().halved()),
        };
        let gears = self.pairs.iter().filter(|p| p.kind == PairKind::Gear);
        let mut meshes: BTreeMap<(usize, usize), Vec<Envelopes>> = BTreeMap::new();
        gears.for_each(|p| meshes.entry(p.parts).or_default().extend(self.envelopes(p)));
        let mut unchecked = Vec::new();
        let touching = neighbours(&bounds, MAX_NEIGHBOURS);
        for (i, j) in touching.pairs {
            if self.is_drawn(i) || self.is_drawn(j) {
                match self.flat_clash([i, j], &primitives) {
                    Ok(None) => {}
                    Ok(Some(point)) => return Err(self.clash_error(i, j, point)),
                    Err(_) => unchecked.push((i, j)),
                }
                continue;
            }
            let meshes = meshes.get(&(i, j)).map_or(&[][..], |m| m);
            if let Some(clash) = start.clash([&extents[i], &extents[j]], meshes) {
                return Err(self.clash_error(i, j, clash.point));
            }
            if start.work.ran_out() {
                unchecked.push((i, j));
            }
        }
        let crowded = touching.cut_short.then(|| {
            let message =
                format!("only the first {MAX_NEIGHBOURS} pairs of touching boxes were checked for overlap");
            Warning { place: None, parts: vec![], message }
        });
        Ok(self.unchecked(&unchecked).or(crowded))
    }

    fn is_drawn(&self, part: usize) -> bool {
        self.machine.parts()[part].walls.is_some()
    }

    /// Where two parts, one of them drawn, overlap in the plane. Gears in mesh and parts without outline are left out.
    fn flat_clash(&self, parts: [usize; 2], primitives: &[Primitive]) -> Result<Option<Vec3>, OutlineError> {
        let gears = |p: &Pair| p.kind == PairKind::Gear && [p.parts.0, p.parts.1] == parts;
        let recipes = parts.map(|i| self.parts[i].recipe.as_ref());
        let [Some(a), Some(b)] = recipes else { return Ok(None) };
        if self.pairs.iter().any(gears) {
            return Ok(None);
        }
        let plane = &self.plane.plane_from_machine;
        let size = self.parts[parts[0]].size.max(self.parts[parts[1]].size);
        let placed = [a, b].map(|r| r.evaluate(primitives, plane));
        let found = placed[0].overlap(&placed[1], 1e-9 * size)?;
        Ok(found.map(|(p, height)| plane.inverse().apply(Vec3::new(p.x, p.y, height))))
    }

    fn unchecked(&self, pairs: &[(usize, usize)]) -> Option<Warning> {
        let &(i, j) = pairs.first()?;
        let others = match pairs.len() - 1 {
            0 => String::new(),
            n => format!(", nor were {n} other pairs of parts"),
        };
        let (a, b) = (&self.parts[i].name, &self.parts[j].name);
        let message = format!("{a} and {b} have too many primitives to be checked for overlap{others}");
        Some(Warning { place: None, parts: vec![i, j], message })
    }

    /// Names the parts and the place, and why they do not mesh if they nearly do.
    fn clash_error(&self, i: usize, j: usize, p: Vec3) -> Error {
        let n = super::near_miss::number;
        let near = self.near_misses.iter().find(|m| m.parts == (i, j));
        let hint = near.map_or(String::new(), |m| format!(" (near miss: {})", m.reason));
        let message = format!(
            "{} and {} overlap at the start, near ({}, {}, {}); expected parts that at most touch{hint}",
            self.parts[i].name,
            self.parts[j].name,
            n(p.x),
            n(p.y),
            n(p.z)
        );
        self.machine.error(self.machine.parts()[j].place, message)
    }

    fn envelopes(&self, gears: &Pair) -> Vec<Envelopes> {
        let of = |e: &super::pair::Evidence| {
            let [a, b] = e.primitives;
            let radius = |i: u32| Bounds::of(&self.primitives[i as usize]).diagonal();
            match e.what {
                EvidenceKind::Mesh { internal: true, .. } => {
                    Some(Envelopes::Internal { pinion: if radius(a) < radius(b) { a } else { b } })
                }
                EvidenceKind::Mesh { .. } => Some(Envelopes::External([a, b])),
                _ => None,
            }
        };
        gears.evidence.iter().filter_map(of).collect()
    }
}
