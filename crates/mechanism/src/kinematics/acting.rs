//! The seam to dynamics, second half: chains of joints, masses on them, gravity, drives and stops.

use super::joint_forces::JointDrive;
use super::masses::PartMass;
use super::mechanism::Mechanism;
use super::pair::PairKind;
use crate::drive::Drive;
use crate::feature::features;
use crate::forces::{Forces, Mass, Stop};
use crate::placed::MAX_CHAIN;
use crate::system::{Joint, Motion};
use mainspring_geometry::{Vec2, Vec3};
use mainspring_model::Error;

impl Mechanism {
    /// The joints between a part and the frame, from the frame outwards.
    pub(crate) fn chain(&self, part: usize) -> Vec<Joint> {
        let (mut chain, mut at) = (Vec::new(), part);
        for _ in 0..self.parts.len() {
            let (Some(joint), Some(carrier)) = (self.parts[at].joint, self.parts[at].carrier) else { break };
            if let Some((coordinate, ratio)) = self.subsystem_of(at) {
                chain.push(Joint { coordinate, ratio, motion: self.motion(joint) });
            }
            at = carrier;
        }
        chain.reverse();
        chain
    }

    /// The part that a part moves as one with: itself, or what it is fixed to.
    pub(crate) fn mover(&self, part: usize) -> usize {
        let mut at = part;
        for _ in 0..self.parts.len() {
            match (self.parts[at].joint, self.parts[at].carrier) {
                (Some(j), Some(c)) if self.pairs[j].kind == PairKind::Fixed => at = c,
                _ => break,
            }
        }
        at
    }

    /// Refuses chains that are too long, and gears whose axes are carried differently.
    pub(crate) fn check_carriers(&self) -> Result<(), Error> {
        for pair in self.pairs.iter().filter(|p| p.kind == PairKind::Gear) {
            let (a, b) = pair.parts;
            let (Some(c), Some(d)) = (self.parts[a].carrier, self.parts[b].carrier) else { continue };
            if self.mover(c) != self.mover(d) {
                let name = |i: usize| &self.parts[i].name;
                let message = format!(
                    "{} and {} mesh, but {} carries the one and {} the other; expected both axes on one part",
                    name(a),
                    name(b),
                    name(c),
                    name(d)
                );
                return self.fail(b, message);
            }
        }
        for i in 0..self.parts.len() {
            let joints = self.chain(i).len();
            if joints > MAX_CHAIN {
                let name = &self.parts[i].name;
                let message = format!(
                    "{name} hangs on the frame by a chain of {joints} joints; expected at most {MAX_CHAIN}"
                );
                return self.fail(i, message);
            }
        }
        Ok(())
    }

    /// Constant inertia that a part adds to its coordinate; none for parts on chains of two joints or more.
    ///
    /// # Errors
    /// A part fixed to a moving one, of which the mass is not known.
    pub(crate) fn constant_inertia(&self, part: usize, chain: &[Joint]) -> Result<Option<f64>, Error> {
        let [joint] = *chain else { return Ok(None) };
        let own = if self.mover(part) == part {
            self.parts[part].inertia.unwrap_or(0.0)
        } else {
            let (mass, center, inertia) = self.whole_mass(part, chain)?;
            match joint.motion {
                Motion::Slide { .. } => mass,
                Motion::Turn { center: o } => inertia + mass * (center - o).dot(center - o),
            }
        };
        Ok(Some(own * joint.ratio * joint.ratio))
    }

    /// Constant force of gravity on a part that slides on the frame, seen at its coordinate.
    pub(crate) fn constant_gravity(&self, part: usize, chain: &[Joint]) -> f64 {
        let [Joint { ratio, motion: Motion::Slide { direction }, .. }] = *chain else { return 0.0 };
        self.parts[part].mass.mass.unwrap_or(0.0) * self.plane_gravity().dot(direction) * ratio
    }

    /// Gravity in the working plane.
    pub(crate) fn plane_gravity(&self) -> Vec2 {
        let g = self.plane.plane_from_machine.rotate(self.gravity);
        Vec2::new(g.x, g.y)
    }

    fn in_plane(&self, p: Vec3) -> Vec2 {
        let p = self.plane.plane_from_machine.apply(p);
        Vec2::new(p.x, p.y)
    }

    /// Mass, centre in the plane and moment of inertia about it. What no joint of the chain asks for counts as zero.
    fn whole_mass(&self, part: usize, chain: &[Joint]) -> Result<(f64, Vec2, f64), Error> {
        let turns = chain.iter().any(|j| matches!(j.motion, Motion::Turn { .. }));
        let PartMass { mass, center, inertia } = self.parts[part].mass;
        let Some(mass) = mass.filter(|_| !turns || center.is_some()) else {
            return self.unknown_mass(part, "moves on a moving part", "mass and centre of mass");
        };
        let Some(inertia) = inertia.or((!turns).then_some(0.0)) else {
            let name = &self.parts[part].name;
            let message = format!(
                "{name} turns with its carrier, and its moment of inertia about its centre of mass is not known; expected {}",
                self.mass_line(part, " inertia")
            );
            return self.fail(part, message);
        };
        Ok((mass, self.in_plane(center.unwrap_or_default()), inertia))
    }

    /// What gives a part a mass, in the words of the machine's file.
    fn mass_line(&self, part: usize, more: &str) -> String {
        if self.machine.is_toml() {
            return "a `density`, or `mass` with a centre".to_string();
        }
        format!("a density or `MASS {} mass x y z{more}`", self.parts[part].name)
    }

    fn unknown_mass<T>(&self, part: usize, why: &str, what: &str) -> Result<T, Error> {
        let name = &self.parts[part].name;
        let message =
            format!("{name} {why}, and its {what} are not known; expected {}", self.mass_line(part, ""));
        self.fail(part, message)
    }

    /// Everything that acts beside the linear forces of the coordinates.
    ///
    /// # Errors
    /// A mass that a chain or gravity asks for and that is not known, values that overflow.
    pub fn forces(&self) -> Result<Forces, Error> {
        let mut forces = Forces {
            gravity: self.plane_gravity(),
            contact: self.contact,
            ..Forces::none(self.subsystems.len())
        };
        for (s, subsystem) in self.subsystems.iter().enumerate() {
            for &(part, ratio) in &subsystem.parts {
                let own = &self.parts[part].forces;
                forces.applied[s] += own.torque * ratio;
                forces.coulomb[s] += own.coulomb * ratio.abs();
                forces.drives[s] = self.drive(part, ratio).or(forces.drives[s].take());
            }
            let mut stops: Vec<Stop> =
                subsystem.parts.iter().flat_map(|&(p, r)| self.stops(s, p, r)).collect();
            stops.sort_by(|a, b| b.side.total_cmp(&a.side));
            forces.stops.extend(stops);
            let finite = forces.applied[s].is_finite() && forces.coulomb[s].is_finite();
            if !finite || !forces.stops.iter().all(|s| s.limit.is_finite() && s.lever.is_finite()) {
                let name = &self.parts[subsystem.root].name;
                let message =
                    format!("the forces on {name} overflow; expected finite torque, friction and stops");
                return self.fail(subsystem.root, message);
            }
        }
        for part in 0..self.parts.len() {
            forces.masses.extend(self.mass(part)?);
        }
        Ok(forces)
    }

    fn mass(&self, body: usize) -> Result<Option<Mass>, Error> {
        let chain = self.chain(body);
        if chain.len() > 1 {
            let (mass, center, inertia) = self.whole_mass(body, &chain)?;
            return Ok(Some(Mass { body, mass, center, inertia, chained: true }));
        }
        let [Joint { motion: Motion::Turn { center: axis }, .. }] = chain[..] else { return Ok(None) };
        if self.plane_gravity() == Vec2::default() {
            return Ok(None);
        }
        let PartMass { mass: Some(mass), center: Some(center), .. } = self.parts[body].mass else {
            return self.unknown_mass(body, "turns under gravity", "mass and centre of mass");
        };
        // Balanced: gravity does no work on it.
        let center = self.in_plane(center);
        let hangs = (center - axis).norm() > self.tolerance;
        Ok(hangs.then_some(Mass { body, mass, center, inertia: 0.0, chained: false }))
    }

    fn drive(&self, part: usize, ratio: f64) -> Option<Drive> {
        let own = self.parts[part].forces.drive.clone()?;
        let own = match own {
            JointDrive::Speed(speed) => Drive::Speed { start: self.parts[part].position, speed },
            JointDrive::Table(table) => Drive::Table(table),
        };
        Some(own.scaled(ratio.recip()))
    }

    fn stops(&self, coordinate: usize, part: usize, ratio: f64) -> Vec<Stop> {
        let Some(carrier) = self.parts[part].carrier else { return vec![] };
        let [low, high] = self.parts[part].forces.stops;
        let lever = self.reach(part) * ratio.abs();
        let stop = |limit: f64, upper: bool| {
            let side = if upper { -ratio.signum() } else { ratio.signum() };
            Stop { coordinate, bodies: (part, carrier), upper, limit: limit / ratio, lever, side }
        };
        low.map(|x| stop(x, false)).into_iter().chain(high.map(|x| stop(x, true))).collect()
    }

    /// How far out a stop acts: 1 for a part that slides; for one that turns the greatest distance of its outline
    /// (whole circles for arcs) from its axis.
    fn reach(&self, part: usize) -> f64 {
        let Some(Motion::Turn { center }) = self.parts[part].joint.map(|j| self.motion(j)) else {
            return 1.0;
        };
        let outline = self.parts[part].outline.as_ref();
        let far = outline.map_or(0.0, |o| {
            features(o, self.size).iter().map(|f| f.shape.distances_from(center).1).fold(0.0, f64::max)
        });
        if far > self.tolerance { far } else { 0.5 * self.parts[part].size }
    }
}
