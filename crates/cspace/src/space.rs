//! The configuration space of two bodies and two coordinates.

use crate::bodies::{Contact, contact};
use crate::cells::{Work, search};
use crate::check::{check, touching};
use crate::cross::Cuts;
use crate::domain::Axis;
use crate::element::Frame;
use crate::error::SpaceError;
use crate::links::{Link, Parts, links, parts};
use crate::locate::Locator;
use crate::options::SpaceOptions;
use crate::pairs::{Catalogue, Part};
use crate::pieces::{Judge, pieces, weld};
use crate::progress::Progress;
use crate::proofs::Proofs;
use crate::range::axis;
use crate::reduce::{Reduced, reduce};
use crate::region::Regions;
use crate::section::Section;
use crate::slabs::{Atlas, Slabs, build};
use crate::within::Within;
use crate::witness::Witnesses;
use mainspring_mechanism::{System, order};
use std::sync::{Arc, OnceLock};

/// Free and blocked space of two bodies over two coordinates, made once for a system at given parameters.
///
/// What it says is that of the closure of free space's interior: passages narrower than 1e-9 of the size count as
/// blocked. Positions are joint coordinates q as the system counts them, of any turn; contacts are placed to about
/// 1e-12 of the size.
#[derive(Clone, Debug)]
pub struct ConfigurationSpace {
    pub(crate) names: [String; 2],
    pub(crate) coordinates: [usize; 2],
    /// The body that the first coordinate moves, and the other.
    pub(crate) moved: [usize; 2],
    /// `moved` is in the opposite order of the bodies asked for.
    pub(crate) flipped: bool,
    pub(crate) atlas: Atlas,
    pub(crate) slabs: Slabs,
    pub(crate) locator: Locator,
    pub(crate) links: Vec<Link>,
    pub(crate) cells: Parts,
    pub(crate) regions: Regions,
    pub(crate) levers: [f64; 2],
    /// The same map with its coordinates exchanged, made when first needed.
    pub(crate) transposed: OnceLock<Arc<Result<ConfigurationSpace, SpaceError>>>,
    pub(crate) parts: [Vec<Part>; 2],
    /// For each element's feature pair, the parts.
    pub(crate) pairs: Vec<[u32; 2]>,
    pub(crate) repeats: [u32; 2],
    pub(crate) work: Work,
}

impl ConfigurationSpace {
    /// The space of bodies `bodies` over coordinates `coordinates` (indices in the system).
    ///
    /// # Errors
    /// See [`SpaceError`].
    pub fn new(
        system: &System,
        bodies: [usize; 2],
        coordinates: [usize; 2],
        options: &SpaceOptions,
    ) -> Result<Self, SpaceError> {
        Self::watched(system, bodies, coordinates, options, &Progress::default())
    }

    /// The same, told and stopped by `progress`.
    ///
    /// # Errors
    /// See [`SpaceError`].
    pub fn watched(
        system: &System,
        bodies: [usize; 2],
        coordinates: [usize; 2],
        options: &SpaceOptions,
        progress: &Progress,
    ) -> Result<Self, SpaceError> {
        check(system, bodies, coordinates, options)?;
        let reduced = reduce(system, bodies, coordinates, &options.held)?;
        let contact = contact(system, &reduced);
        let sections = [0, 1].map(|k| contact.sections(k, &reduced.moving[k]));
        let parts = [0, 1].map(|k| contact.parts(k, &reduced.moving[k]));
        let mut repeats = [1, 1];
        for k in 0..2 {
            if options.periodic && reduced.moving[k].turns() && options.windows[k].is_none() {
                let marks: Vec<_> = sections[k].iter().map(Section::marks).collect();
                repeats[k] = order(&marks, 1e-9 * system.size).unwrap_or(1);
            }
        }
        let mut axes = Vec::new();
        for k in 0..2 {
            let name = &system.coordinates[coordinates[k]].name;
            axes.push(axis(k, &reduced, &parts, options.windows[k], repeats[k], name)?);
        }
        let frame = Frame { moving: reduced.moving, axes: [axes[0], axes[1]], size: system.size };
        let within = Within::new(&frame, sections.each_ref().map(Vec::as_slice));
        let regions = Regions::new(sections, &frame, &within);
        Made { system, coordinates, bodies, reduced, contact, frame, within, regions, parts, repeats }
            .finish(options.budget, progress)
    }

    /// Range of the two coordinates within which the map is stored (joint coordinates q).
    pub fn domain(&self) -> [Axis; 2] {
        [0, 1].map(|k| {
            let (a, r) = (self.atlas.frame.axes[k], self.atlas.frame.moving[k].ratio);
            Axis { start: a.start / r, length: a.length / r, ..a }
        })
    }

    /// How often the space repeats within a whole turn of either coordinate: the rotational symmetry of the bodies.
    pub fn repeats(&self) -> [u32; 2] {
        self.repeats
    }

    /// Counts of work done to make the space.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Names of the two bodies, in the order asked for.
    pub fn names(&self) -> &[String; 2] {
        &self.names
    }

    /// Scaled positions within the domain, and the periods taken off.
    pub(crate) fn scaled(&self, q: [f64; 2]) -> ([f64; 2], [i64; 2]) {
        let at = [0, 1].map(|k| self.atlas.frame.axes[k].wrap(q[k] * self.atlas.frame.moving[k].ratio));
        ([at[0].0, at[1].0], [at[0].1, at[1].1])
    }
}

/// Everything known before the search.
struct Made<'a> {
    system: &'a System,
    coordinates: [usize; 2],
    bodies: [usize; 2],
    reduced: Reduced,
    contact: Contact<'a>,
    frame: Frame,
    within: Within,
    regions: Regions,
    parts: [Vec<Part>; 2],
    repeats: [u32; 2],
}

impl Made<'_> {
    fn finish(self, budget: usize, progress: &Progress) -> Result<ConfigurationSpace, SpaceError> {
        let size = self.frame.size;
        let witnesses = Witnesses::new(&self.regions, self.repeats, &self.within, size);
        if let Some(k) = witnesses.thin() {
            return Err(SpaceError::Thin { body: self.system.bodies[self.reduced.bodies[k]].name.clone() });
        }
        let ratios = self.frame.moving.map(|m| m.ratio);
        if let Some([u, v]) = touching(&self.frame, &self.regions, &witnesses) {
            return Err(SpaceError::Degenerate { at: [u / ratios[0], v / ratios[1]] });
        }
        let levers =
            [0, 1].map(|k| self.parts[k].iter().map(|p| p.lever).fold(1e-3 * size.min(1.0), f64::max));
        let kind = |i: usize, j: usize| self.contact.kind(i, j);
        let of_bodies = [&self.parts[0][..], &self.parts[1][..]];
        let mut catalogue = Catalogue::new(&self.frame, of_bodies, &self.within, &kind);
        let mut cuts = Cuts::default();
        let mut work = Work::default();
        if self.contact.exists() {
            let mut proofs = Proofs::new(&self.regions, &witnesses);
            work = search(&mut catalogue, &mut proofs, &mut cuts, (budget, progress))?;
        }
        let judge = Judge::new(&self.frame, &self.regions, levers);
        let (mut pieces, tested) = pieces(&catalogue, &mut cuts, &judge);
        weld(&catalogue, &self.frame, &mut pieces);
        work.tested = tested;
        let pairs = catalogue.curves.iter().map(|c| c.parts).collect();
        let equations = catalogue.curves.iter().map(|c| c.eq).collect();
        let elements = std::mem::take(&mut catalogue.elements);
        let atlas = Atlas { frame: self.frame.clone(), pieces, elements, equations };
        let slabs = build(&atlas, &judge, |at| [at[0] / ratios[0], at[1] / ratios[1]])?;
        let links = links(&slabs, &atlas);
        let cells = parts(&slabs, &links);
        let locator = Locator::new(&atlas, &slabs);
        Ok(ConfigurationSpace {
            names: self.bodies.map(|b| self.system.bodies[b].name.clone()),
            coordinates: self.coordinates,
            moved: self.reduced.bodies,
            flipped: self.reduced.bodies != self.bodies,
            atlas,
            slabs,
            locator,
            links,
            cells,
            regions: self.regions,
            levers,
            transposed: OnceLock::new(),
            parts: self.parts,
            pairs,
            repeats: self.repeats,
            work,
        })
    }
}
