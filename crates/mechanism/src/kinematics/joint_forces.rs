//! What acts on a joint beside spring and viscous friction: constant torque, dry friction, a drive, stops.

use super::mechanism::Mechanism;
use super::near_miss::number;
use crate::drive::{Driven, Table};
use mainspring_model::{DriveKind, Error, Place};

/// How a joint's position is prescribed; radians, or the file's length.
#[derive(Clone, Debug, PartialEq)]
pub enum JointDrive {
    /// Constant speed from the initial position on.
    Speed(f64),
    Table(Table),
}

impl JointDrive {
    /// The motion at time `t` of a joint that starts at `start` (tables know their own start).
    pub fn at(&self, start: f64, t: f64) -> Driven {
        match self {
            JointDrive::Speed(speed) => Driven { q: start + speed * t, v: *speed, a: 0.0 },
            JointDrive::Table(table) => crate::drive::Drive::Table(table.clone()).at(t),
        }
    }
}

/// What acts on a part along its joint, against its carrier.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointForces {
    /// Constant torque, or force of a sliding part.
    pub torque: f64,
    /// Size of the dry friction torque (or force) against the motion.
    pub coulomb: f64,
    pub drive: Option<JointDrive>,
    /// Least and greatest position allowed: radians, or the file's length.
    pub stops: [Option<f64>; 2],
}

/// Start positions may lie beyond a stop by this much (radians, or parts of the machine's size).
const BEYOND: f64 = 1e-9;

/// Puts forces, friction, drives and stops of the supplement into the parts.
pub(crate) fn given(mechanism: &mut Mechanism) -> Result<(), Error> {
    let machine = mechanism.machine.clone();
    let supplement = machine.supplement();
    for f in &supplement.forces {
        let word = if f.torque { "torque" } else { "force" };
        joint(mechanism, f.part, f.place, word)?;
        let slides = mechanism.slides(f.part);
        if slides == f.torque {
            let name = &mechanism.parts[f.part].name;
            let message = if slides {
                format!("{name} slides and takes no torque; expected FORCE in place of TORQUE")
            } else {
                format!("{name} turns and takes no force; expected TORQUE in place of FORCE")
            };
            return Err(machine.error(f.place, message));
        }
        mechanism.parts[f.part].forces.torque = f.value;
    }
    for f in &supplement.coulomb {
        joint(mechanism, f.part, f.place, "Coulomb friction")?;
        mechanism.parts[f.part].forces.coulomb = f.value;
    }
    for s in &supplement.stops {
        joint(mechanism, s.part, s.place, "stop")?;
        let unit = mechanism.unit(s.part);
        mechanism.parts[s.part].forces.stops = [s.low, s.high].map(|x| x.map(|x| x * unit));
    }
    drives(mechanism)
}

/// A part that is to take something needs a joint of its own.
fn joint(mechanism: &Mechanism, part: usize, place: Place, what: &str) -> Result<(), Error> {
    if mechanism.subsystem_of(part).is_some() {
        return Ok(());
    }
    let name = &mechanism.parts[part].name;
    let message = format!("{name} has no joint to take a {what}; expected a part that turns or slides");
    Err(mechanism.machine.error(place, message))
}

fn drives(mechanism: &mut Mechanism) -> Result<(), Error> {
    let machine = mechanism.machine.clone();
    let mut driven: Vec<Option<(usize, Place)>> = vec![None; mechanism.subsystems.len()];
    for d in &machine.supplement().drives {
        let word = d.kind.word();
        joint(mechanism, d.part, d.place, if word == "SPEED" { "speed" } else { "table" })?;
        let Some((s, _)) = mechanism.subsystem_of(d.part) else { continue };
        let name = &mechanism.parts[d.part].name;
        if mechanism.subsystems[s].closed {
            let message = format!("{name} is in a closed chain of pairs; expected no {word} for its parts");
            return Err(machine.error(d.place, message));
        }
        if let Some((other, at)) = driven[s] {
            let message = format!(
                "{name} moves with {}, which is driven already (at {}:{}); expected one drive for both",
                mechanism.parts[other].name, at.line, at.column
            );
            return Err(machine.error(d.place, message));
        }
        driven[s] = Some((d.part, d.place));
        let unit = mechanism.unit(d.part);
        let drive = match &d.kind {
            DriveKind::Speed(speed) => JointDrive::Speed(speed * unit),
            DriveKind::Table(points) => {
                let points: Vec<(f64, f64)> = points.iter().map(|(t, x)| (*t, x * unit)).collect();
                JointDrive::Table(Table::new(&points))
            }
        };
        mechanism.parts[d.part].forces.drive = Some(drive);
    }
    mechanism.check_states()
}

impl Mechanism {
    /// Radians, or the file's length, per unit of the supplement for a part's joint.
    pub fn unit(&self, part: usize) -> f64 {
        if self.slides(part) { 1.0 } else { std::f64::consts::PI / 180.0 }
    }

    /// The part of a subsystem whose joint is driven.
    pub(crate) fn driven_part(&self, subsystem: usize) -> Option<usize> {
        let parts = &self.subsystems.get(subsystem)?.parts;
        parts.iter().map(|(p, _)| *p).find(|p| self.parts[*p].forces.drive.is_some())
    }

    /// What prescribes a part's velocity (or, with `position`, its position): the word of the line and its place.
    pub(crate) fn prescribed(&self, part: usize, position: bool) -> Option<(&'static str, Place)> {
        let driven = self.driven_part(self.subsystem_of(part)?.0)?;
        let line = self.machine.supplement().drives.iter().find(|d| d.part == driven)?;
        let counts = !position || matches!(line.kind, DriveKind::Table(_));
        counts.then(|| (line.kind.word(), line.place))
    }

    /// POSITION and VELOCITY lines of parts whose motion is prescribed contradict it.
    fn check_states(&self) -> Result<(), Error> {
        let supplement = self.machine.supplement();
        let lists = [(&supplement.positions, "POSITION"), (&supplement.velocities, "VELOCITY")];
        for (list, word) in lists {
            for state in list {
                let Some((drive, at)) = self.prescribed(state.part, word == "POSITION") else { continue };
                let message = format!(
                    "the {} of {} is prescribed by {drive} (at {}:{}); expected no {word} line for it",
                    word.to_lowercase(),
                    self.parts[state.part].name,
                    at.line,
                    at.column
                );
                return Err(self.machine.error(state.place, message));
            }
        }
        Ok(())
    }

    /// Start states of driven subsystems follow their drives.
    pub(crate) fn start_drives(&mut self) {
        for s in 0..self.subsystems.len() {
            let Some(part) = self.driven_part(s) else { continue };
            let Some(drive) = self.parts[part].forces.drive.clone() else { continue };
            let members = self.subsystems[s].parts.clone();
            let ratio = members.iter().find(|m| m.0 == part).map_or(1.0, |m| m.1);
            let Driven { q, v, .. } = drive.at(self.parts[part].position, 0.0);
            for (member, r) in members {
                (self.parts[member].position, self.parts[member].velocity) = (q / ratio * r, v / ratio * r);
            }
        }
    }

    /// Start positions and tables must lie within the stops, and no constant speed may run into one.
    pub(crate) fn check_stops(&self) -> Result<(), Error> {
        for stop in &self.machine.supplement().stops {
            let part = &self.parts[stop.part];
            let Some((s, ratio)) = self.subsystem_of(stop.part) else { continue };
            let fail = |message: String| Err(self.machine.error(stop.place, message));
            let driven = self.driven_part(s).map(|d| (d, &self.parts[d].forces.drive));
            match driven {
                Some((_, Some(JointDrive::Speed(speed)))) if *speed != 0.0 => {
                    let message = format!(
                        "{} would run into its stop at the constant speed prescribed; expected no STOP, or a TABLE",
                        part.name
                    );
                    return fail(message);
                }
                Some((d, Some(JointDrive::Table(table)))) => {
                    let own = self.subsystem_of(d).map_or(1.0, |s| s.1);
                    let passed = table.points().map(|(t, x)| (t, x / own * ratio));
                    if let Some((t, x)) = passed.into_iter().find(|(_, x)| self.beyond(stop.part, *x)) {
                        let message = format!(
                            "{} is at {} at time {} of its table, beyond its stop; expected positions within",
                            part.name,
                            number(x / self.unit(stop.part)),
                            number(t)
                        );
                        return fail(message);
                    }
                }
                _ if self.beyond(stop.part, part.position) => {
                    let message = format!(
                        "{} starts at {}, beyond its stop; expected a position within",
                        part.name,
                        number(part.position / self.unit(stop.part))
                    );
                    return fail(message);
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn beyond(&self, part: usize, x: f64) -> bool {
        let slack = BEYOND * if self.slides(part) { self.size } else { 1.0 };
        let [low, high] = self.parts[part].forces.stops;
        low.is_some_and(|l| x < l - slack) || high.is_some_and(|h| x > h + slack)
    }
}
