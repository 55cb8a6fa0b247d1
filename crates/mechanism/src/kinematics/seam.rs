//! The seam to contact and dynamics: coordinates, bodies, and the surfaces that are no contact features.

use super::mechanism::Mechanism;
use super::pair::PairKind;
use super::subsystems::Subsystem;
use super::surface::{parallel, perpendicular};
use crate::interaction::{Exclusion, System};
use crate::system::{Body, Coordinate, Motion};
use mainspring_geometry::{Outline, Vec2};
use mainspring_model::Error;
use std::sync::{Arc, OnceLock};

/// Greatest friction, spring constant and force over the inertia, in the file's units.
const MAX_RATE: f64 = 1e100;

/// What a cell keeps, made if it is empty.
fn kept(
    cell: &OnceLock<Arc<System>>,
    make: impl FnOnce() -> Result<System, Error>,
) -> Result<Arc<System>, Error> {
    if let Some(made) = cell.get() {
        return Ok(made.clone());
    }
    let made = Arc::new(make()?);
    Ok(cell.get_or_init(|| made).clone())
}

impl Mechanism {
    /// Everything contact and motion need.
    ///
    /// # Errors
    /// As [`Mechanism::coordinates`], [`Mechanism::forces`] and [`Mechanism::bodies`].
    pub fn system(&self) -> Result<System, Error> {
        let (coordinates, forces, bodies) = (self.coordinates()?, self.forces()?, self.bodies()?);
        Ok(System::new(coordinates, bodies, &self.exclusions(), self.size).with_forces(forces))
    }

    /// The same, made once and shared.
    ///
    /// # Errors
    /// As [`Mechanism::system`].
    pub fn kept_system(&self) -> Result<Arc<System>, Error> {
        kept(&self.whole, || self.system())
    }

    /// One coordinate for each subsystem, with inertia, friction, springs and constant forces seen at its root.
    /// Parts on chains of two joints or more have their inertia in [`Mechanism::forces`].
    ///
    /// # Errors
    /// What inspection allows and simulation cannot do: a part that hangs on nothing, closed chains, chains of more
    /// than [`crate::MAX_CHAIN`] joints, pairs with two freedoms, motion that is not planar, gears that lock each other or
    /// are carried differently, an inertia that is not known.
    pub fn coordinates(&self) -> Result<Vec<Coordinate>, Error> {
        self.check_motion()?;
        (0..self.parts.len()).filter(|p| *p != self.frame).try_for_each(|p| self.check_inertia(p))?;
        let mut coordinates: Vec<Coordinate> = self.subsystems.iter().map(|s| self.coordinate(s)).collect();
        for part in 0..self.parts.len() {
            let chain = self.chain(part);
            let Some(inertia) = self.constant_inertia(part, &chain)? else { continue };
            let c = &mut coordinates[chain[0].coordinate];
            c.inertia += inertia;
            c.force += self.constant_gravity(part, &chain);
        }
        self.check_finite(coordinates)
    }

    /// The same machine for questions of reach alone, which inertias, friction and springs do not answer; made once.
    ///
    /// # Errors
    /// As [`Mechanism::coordinates`], inertias and rates apart, and [`Mechanism::bodies`].
    pub fn system_of_shapes(&self) -> Result<Arc<System>, Error> {
        kept(&self.shapes, || {
            self.check_motion()?;
            self.system_beside_loose()
        })
    }

    /// As [`Mechanism::system_of_shapes`]; nothing is asked of parts that hang on nothing.
    pub(crate) fn system_beside_loose(&self) -> Result<System, Error> {
        self.check_pairs()?;
        let coordinates = self.subsystems.iter().map(|s| self.coordinate(s)).collect();
        let mut bodies = self.bodies()?;
        for (i, body) in bodies.iter_mut().enumerate().filter(|(i, _)| self.is_loose(*i)) {
            let name = self.parts[i].name.clone();
            *body = Body { name, chain: vec![], outline: Outline::default() };
        }
        Ok(System::new(coordinates, bodies, &self.exclusions(), self.size))
    }

    /// Does a part hang on nothing, or on one that does?
    pub(crate) fn is_loose(&self, part: usize) -> bool {
        let mut at = part;
        for _ in 0..self.parts.len() {
            if at == self.frame {
                return false;
            }
            match (self.parts[at].joint, self.parts[at].carrier) {
                (Some(_), Some(carrier)) => at = carrier,
                _ => return true,
            }
        }
        true
    }

    /// Can every part move in the plane, with one freedom of its own?
    fn check_motion(&self) -> Result<(), Error> {
        self.check_pairs()?;
        (0..self.parts.len()).filter(|p| *p != self.frame).try_for_each(|p| self.check_joint(p))
    }

    fn check_pairs(&self) -> Result<(), Error> {
        self.check_planar()?;
        self.check_carriers()?;
        self.check_chains()
    }

    pub(crate) fn fail<T>(&self, part: usize, message: String) -> Result<T, Error> {
        Err(self.machine.error(self.parts[part].place, message))
    }

    fn check_planar(&self) -> Result<(), Error> {
        let n = self.plane.normal;
        for pair in &self.pairs {
            let d = pair.axis.direction;
            let (turns, slides) = (pair.kind.turns(), pair.kind.slides());
            let moving = if pair.parts.0 == self.frame { pair.parts.1 } else { pair.parts.0 };
            let names = format!("{} and {}", self.parts[pair.parts.0].name, self.parts[pair.parts.1].name);
            if turns && slides {
                // Where shapes that are no prisms kept the second freedom, they are what has to change.
                if self.plane.planar {
                    self.check_outlines()?;
                }
                let message = format!(
                    "{names} form a cylindrical pair with two freedoms; expected one (it may turn and slide)"
                );
                return self.fail(moving, message);
            }
            if (turns && !parallel(d, n)) || (slides && !perpendicular(d, n)) {
                let message = format!(
                    "{names} do not move in the plane in which the others move; expected planar motion"
                );
                return self.fail(moving, message);
            }
        }
        Ok(())
    }

    fn check_chains(&self) -> Result<(), Error> {
        let Some(chain) = self.closed_chains.first() else { return Ok(()) };
        let names: Vec<&str> = chain.parts.iter().map(|p| self.parts[*p].name.as_str()).collect();
        let first = chain.parts.iter().copied().find(|p| *p != self.frame).unwrap_or(self.frame);
        let names = names.join(", ");
        let message = if chain.gears_only {
            format!("the gears of {names} lock each other; expected ratios that agree")
        } else {
            format!("{names} form a closed chain of pairs; expected an open one")
        };
        self.fail(first, message)
    }

    fn check_joint(&self, i: usize) -> Result<(), Error> {
        let part = &self.parts[i];
        if part.joint.is_none() {
            let message =
                format!("{} has no pair with the frame; expected one it turns or slides in", part.name);
            return self.fail(i, message);
        }
        Ok(())
    }

    fn check_inertia(&self, i: usize) -> Result<(), Error> {
        let part = &self.parts[i];
        let moves = part.joint.is_some_and(|j| self.pairs[j].kind != PairKind::Fixed);
        match part.inertia {
            None if moves => {
                let expected = if self.machine.is_toml() {
                    "`inertia`, `mass` or `density`"
                } else {
                    "a line of the supplement or a density"
                };
                let message = format!("the inertia of {} is not known; expected {expected}", part.name);
                self.fail(i, message)
            }
            Some(inertia) if !(inertia > 0.0 && inertia.is_finite()) => {
                self.fail(i, format!("the inertia of {} is {inertia}; expected a positive number", part.name))
            }
            _ => Ok(()),
        }
    }

    /// Without its inertia: friction, springs, constant torques and forces, start.
    fn coordinate(&self, s: &Subsystem) -> Coordinate {
        let root = &self.parts[s.root];
        let mut c = Coordinate {
            name: root.name.clone(),
            inertia: 0.0,
            damping: 0.0,
            stiffness: 0.0,
            force: 0.0,
            energy_at_zero: 0.0,
            position: root.position,
            velocity: root.velocity,
        };
        for &(part, r) in &s.parts {
            let part = &self.parts[part];
            c.damping += part.friction * r * r;
            c.force += part.forces.torque * r;
            if let Some(spring) = part.spring {
                let k = spring.constant;
                c.stiffness += k * r * r;
                c.force += k * r * spring.relaxed;
                c.energy_at_zero += 0.5 * k * spring.relaxed * spring.relaxed;
            }
        }
        c
    }

    fn check_finite(&self, coordinates: Vec<Coordinate>) -> Result<Vec<Coordinate>, Error> {
        for (c, s) in coordinates.iter().zip(&self.subsystems) {
            if ![c.inertia, c.stiffness, c.force, c.damping].iter().all(|x| x.is_finite()) {
                let message = format!(
                    "the values of {} overflow; expected finite inertia, friction and spring",
                    c.name
                );
                return self.fail(s.root, message);
            }
            self.check_rates(c, s.root)?;
        }
        Ok(coordinates)
    }

    /// Squares of rates must be finite, or the motion is not. Coordinates of chains alone have no inertia of their own.
    fn check_rates(&self, c: &Coordinate, root: usize) -> Result<(), Error> {
        let rates = [(c.damping, "friction"), (c.stiffness, "spring constant"), (c.force, "spring's force")];
        let too_large = |(value, _): &&(f64, &str)| (value / c.inertia).abs() > MAX_RATE;
        let Some((value, what)) = rates.iter().find(too_large).filter(|_| c.inertia > 0.0) else {
            return Ok(());
        };
        let message = format!(
            "the {what} of {} is {value:e}, its inertia {:e}; expected a ratio below {MAX_RATE:e}",
            c.name, c.inertia
        );
        self.fail(root, message)
    }

    /// The parts as contact sees them, in the working plane, in the order of [`Mechanism::parts`].
    ///
    /// # Errors
    /// A part that is no prism along the working plane's normal and may touch another.
    pub fn bodies(&self) -> Result<Vec<Body>, Error> {
        self.check_outlines()?;
        Ok((0..self.parts.len()).map(|i| self.body(i)).collect())
    }

    fn body(&self, i: usize) -> Body {
        let part = &self.parts[i];
        let outline = part.outline.clone().unwrap_or_default();
        let chain = self.chain(i);
        Body { name: part.name.clone(), chain, outline }
    }

    pub(crate) fn motion(&self, joint: usize) -> Motion {
        let pair = &self.pairs[joint];
        let plane = &self.plane.plane_from_machine;
        if pair.kind.slides() {
            let d = plane.rotate(pair.axis.direction);
            return Motion::Slide { direction: Vec2::new(d.x, d.y) };
        }
        let c = plane.apply(pair.axis.point);
        Motion::Turn { center: Vec2::new(c.x, c.y) }
    }

    fn check_outlines(&self) -> Result<(), Error> {
        if self.parts.iter().all(|p| p.outline.is_some()) {
            return Ok(());
        }
        self.with_reach(|parts| {
            for (i, part) in self.parts.iter().enumerate().filter(|(_, p)| p.outline.is_none()) {
                let touched = |j: &usize| *j != i && parts.may_touch(i, *j);
                if let Some(j) = (0..self.parts.len()).find(touched) {
                    let place = part.tilted.map_or(part.place, |p| self.machine.place_of_primitive(p));
                    let why = part.note.as_deref().unwrap_or("it has no planar outline");
                    let message =
                        format!("{} may touch {}, but {why}; expected prisms", part.name, self.parts[j].name);
                    return Err(self.machine.error(place, message));
                }
            }
            Ok(())
        })
    }

    /// Surfaces of lower pairs and gear envelopes: between the parts of the pair they are no contact features.
    pub fn exclusions(&self) -> Vec<Exclusion> {
        let of = |p: &super::pair::Pair| Exclusion { bodies: p.parts, curves: p.surfaces.concat() };
        self.pairs.iter().map(of).collect()
    }
}
