//! The surfaces that make a pair: as evidence, and as what is no contact between the two parts.

use super::bounds::Bounds;
use super::fits::{ShaftFit, Solid};
use super::pair::{AxisLine, Evidence, EvidenceKind, Pair, PairKind};
use super::patch::Scene;
use super::plane_fit::PlanePatch;
use super::search::Found;
use super::surface::{Face, Lateral, foot, off_line, parallel, perpendicular};
use mainspring_geometry::{CurveId, Vec3};

/// The surfaces that make a pair, and what they leave.
pub(crate) struct Fit {
    pub fits: Vec<ShaftFit>,
    pub patches: Vec<PlanePatch>,
    pub kind: PairKind,
    pub point: Vec3,
    pub direction: Vec3,
    pub exit: Option<Vec3>,
}

impl ShaftFit {
    pub(crate) fn primitives(&self) -> [u32; 2] {
        self.laterals.map(|l| l.id.primitive)
    }

    fn same_place(&self, other: &Self) -> bool {
        let near =
            |a: f64, b: f64| (a - b).abs() <= 1e-9 * self.laterals[0].height.max(self.laterals[0].radius);
        let shift = (other.laterals[0].middle - self.laterals[0].middle).dot(self.laterals[0].direction);
        let on_axis = off_line(other.laterals[0].middle, self.laterals[0].middle, self.laterals[0].direction);
        near(on_axis, 0.0)
            && near(self.laterals[self.solid].radius, other.laterals[other.solid].radius)
            && near(self.span.0, other.span.0 + shift)
            && near(self.span.1, other.span.1 + shift)
    }

    pub(crate) fn copy(&self) -> Self {
        ShaftFit { arcs: self.arcs.clone(), ..*self }
    }
}

impl PlanePatch {
    fn same_place(&self, other: &Self) -> bool {
        let size = self.area.sqrt();
        let around = |p: &Self| Bounds::of_points(p.corners.iter().copied());
        let (a, b) = (around(self), around(other));
        self.normal.dot(other.normal) > 0.5
            && (a.low - b.low).norm() <= 1e-9 * size
            && (a.high - b.high).norm() <= 1e-9 * size
            && (self.area - other.area).abs() <= 1e-9 * self.area
    }

    pub(crate) fn primitives(&self) -> [u32; 2] {
        self.faces.map(|f| f.id.primitive)
    }
}

impl Fit {
    pub(crate) fn into_pair(
        self,
        scene: &Scene<'_>,
        solids: [&Solid<'_>; 2],
        parts: (usize, usize),
    ) -> Found {
        let d = self.direction;
        let axis = AxisLine { point: foot(self.point, d, scene.tolerance), direction: d };
        let surfaces = [0, 1].map(|i| self.surfaces(i, solids[i], scene.tolerance));
        let gaps = self.patches.iter().filter(|p| perpendicular(p.normal, d)).map(|p| p.gap);
        let clearance = self.fits.iter().map(|f| f.clearance).chain(gaps).fold(0.0, f64::max);
        let clearance = if clearance <= scene.tolerance { 0.0 } else { clearance };
        let pair = Pair {
            kind: self.kind,
            shape_kind: self.kind,
            parts,
            axis,
            ratio: None,
            clearance,
            evidence: self.evidence(&axis),
            dropped: vec![],
            surfaces,
        };
        Found { pair, open: self.exit.is_some() }
    }

    /// Of coincident surfaces the first in the text speaks for all.
    fn evidence(&self, axis: &AxisLine) -> Vec<Evidence> {
        let mut list = Vec::new();
        let note = |what, primitives| Evidence { what, primitives, text: String::new() };
        for (k, fit) in self.fits.iter().enumerate() {
            if self.fits[..k].iter().any(|f| f.same_place(fit)) {
                continue;
            }
            let start = (fit.laterals[0].middle - axis.point).dot(axis.direction);
            let angle = fit.arcs.iter().map(|a| a.1 - a.0).sum();
            let radius = fit.laterals[fit.solid].radius;
            let (from, to) = (start + fit.span.0, start + fit.span.1);
            let (solid, clearance) = (fit.solid, fit.clearance);
            let what = EvidenceKind::ShaftInHole { solid, radius, clearance, from, to, angle };
            list.push(note(what, fit.primitives()));
        }
        for (k, p) in self.patches.iter().enumerate() {
            if self.patches[..k].iter().any(|q| q.same_place(p)) {
                continue;
            }
            let what = if perpendicular(p.normal, axis.direction) {
                EvidenceKind::SideFaces { normal: p.normal, clearance: p.gap, area: p.area }
            } else if parallel(p.normal, axis.direction) {
                EvidenceKind::EndFaces { normal: p.normal, area: p.area }
            } else {
                continue;
            };
            list.push(note(what, p.primitives()));
        }
        if let Some(exit) = self.exit {
            let primitives = list.first().map_or([0, 0], |e| e.primitives);
            list.push(note(EvidenceKind::OpenSide { exit }, primitives));
        }
        list
    }

    /// Every surface of the part that coincides with one of the pair and moves in itself with it. Faces that stop
    /// sliding are none of them: they are contact.
    fn surfaces(&self, i: usize, solid: &Solid<'_>, tolerance: f64) -> Vec<CurveId> {
        let on_shaft = |l: &&Lateral| {
            self.fits.iter().map(|f| &f.laterals[i]).any(|f| {
                (f.radius - l.radius).abs() <= tolerance
                    && parallel(f.direction, l.direction)
                    && off_line(l.middle, f.middle, f.direction) <= tolerance
            })
        };
        let on_face = |g: &&Face| {
            let sides = self.patches.iter().filter(|p| perpendicular(p.normal, self.direction));
            sides.map(|p| &p.faces[i]).any(|f| {
                parallel(f.normal, g.normal) && (f.middle - g.middle).dot(f.normal).abs() <= tolerance
            })
        };
        let shafts = solid.laterals.iter().filter(on_shaft).map(|l| l.id);
        let faces = solid.faces.iter().filter(on_face).map(|f| f.id);
        let mut all: Vec<CurveId> = shafts.chain(faces).collect();
        all.sort();
        all
    }
}
