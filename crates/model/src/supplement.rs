//! What shapes do not tell: inertias, forces, drives, limits, the initial state (after Gelsey 1995, Fig. 13).
//!
//! Plain numbers as written, angles in degrees; whether a part turns or slides, and on what, is found later. Readers
//! of other formats fill the same lists and ask [`Supplement::check`].

use crate::error::{Fault, Place, Read};
use crate::machine::Machine;

/// A linear spring between a part and its carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Relaxed position as written: degrees, or the file's length for sliding parts.
    pub relaxed: f64,
    /// Torque per radian, or force per length.
    pub constant: f64,
}

/// A line `< PART : CARRIER > [inertia] friction [SPRING relaxed constant]`.
#[derive(Clone, Debug, PartialEq)]
pub struct PairData {
    /// Index of the moving part.
    pub part: usize,
    /// Index of its carrier: the frame or another moving part; the part itself: whatever carries it.
    pub other: usize,
    /// Moment of inertia about the joint's axis, or mass for sliding parts; none: from density or mass.
    pub inertia: Option<f64>,
    /// Torque per angular velocity (radians), or force per velocity.
    pub friction: f64,
    pub spring: Option<Spring>,
    pub place: Place,
    /// Where its first number stands.
    pub number: Place,
}

/// A line of one number for a part, such as `POSITION part value` or `COULOMB part value`.
#[derive(Clone, Debug, PartialEq)]
pub struct PartNumber {
    pub part: usize,
    /// As written: degrees (per time) or the file's length (per time) of a position or velocity.
    pub value: f64,
    pub place: Place,
}

/// A line `TORQUE part value` or `FORCE part value`: constant, between the part and its carrier.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceData {
    pub part: usize,
    pub value: f64,
    /// A torque (for parts that turn) or a force (for parts that slide).
    pub torque: bool,
    pub place: Place,
}

/// How a position is prescribed.
#[derive(Clone, Debug, PartialEq)]
pub enum DriveKind {
    /// Degrees, or the file's length, per time.
    Speed(f64),
    /// Times, increasing, and positions (degrees, or the file's length); two or more.
    Table(Vec<(f64, f64)>),
}

impl DriveKind {
    /// The word that begins its line.
    pub fn word(&self) -> &'static str {
        match self {
            DriveKind::Speed(_) => "SPEED",
            DriveKind::Table(_) => "TABLE",
        }
    }
}

/// A line `SPEED part value` or `TABLE part t x t x …`.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveData {
    pub part: usize,
    pub kind: DriveKind,
    pub place: Place,
}

/// A line `STOP part low high`: limits of a joint in degrees, or the file's length; at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct StopData {
    pub part: usize,
    pub low: Option<f64>,
    pub high: Option<f64>,
    pub place: Place,
}

/// A line `MASS part mass x y z [inertia]`.
#[derive(Clone, Debug, PartialEq)]
pub struct MassData {
    pub part: usize,
    pub mass: f64,
    /// The centre of mass where the part is modelled, in the machine's coordinates.
    pub center: [f64; 3],
    /// Moment of inertia about the centre of mass, along the normal of the plane of motion.
    pub inertia: Option<f64>,
    pub place: Place,
}

/// A line `GRAVITY x y z`: a uniform field, the file's length per time².
#[derive(Clone, Debug, PartialEq)]
pub struct GravityData {
    pub field: [f64; 3],
    pub place: Place,
}

/// A line `CONTACT E D M`: constants of compliant contact (Gelsey 1995, Eq. 4).
#[derive(Clone, Debug, PartialEq)]
pub struct ContactData {
    /// Force per overlap.
    pub e: f64,
    /// Force per rate of overlap.
    pub d: f64,
    /// Factor per overlap that lets damping set in gradually.
    pub m: f64,
    pub place: Place,
}

/// How a part moves, where the file says so and it is not to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionKind {
    /// About a point of the plane, counterclockwise; the axis is z.
    Turns { center: [f64; 2] },
    /// Along a direction of the plane, of any length but zero.
    Slides { direction: [f64; 2] },
    /// It does not move on its carrier.
    Fixed,
}

/// A stated motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionData {
    pub part: usize,
    /// Index of the part that carries it.
    pub carrier: usize,
    pub kind: MotionKind,
    pub place: Place,
}

/// Two parts stated to mesh as gears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GearPairData {
    pub parts: [usize; 2],
    pub teeth: [u32; 2],
    /// One of them has its teeth inside: both turn the same way.
    pub internal: bool,
    pub place: Place,
}

/// A named value of a part's coordinate, such as where a pawl is released.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub part: usize,
    pub name: String,
    /// Degrees, or the file's length.
    pub value: f64,
    pub place: Place,
}

/// What shapes do not tell. Each part is in each list at most once, and has at most one force and one drive.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Supplement {
    pub pairs: Vec<PairData>,
    pub positions: Vec<PartNumber>,
    pub velocities: Vec<PartNumber>,
    pub forces: Vec<ForceData>,
    /// Friction torque or force of constant size.
    pub coulomb: Vec<PartNumber>,
    pub drives: Vec<DriveData>,
    pub stops: Vec<StopData>,
    pub masses: Vec<MassData>,
    pub gravity: Option<GravityData>,
    pub contact: Option<ContactData>,
    /// In the order of the parts.
    pub motions: Vec<MotionData>,
    pub gears: Vec<GearPairData>,
    pub marks: Vec<Mark>,
}

impl Supplement {
    /// What one line alone cannot tell: each part needs an inertia, or a density or mass that it follows from.
    pub(crate) fn check(&self, machine: &Machine) -> Read<()> {
        for pair in self.pairs.iter().filter(|p| p.inertia.is_none()) {
            let model = &machine.parts()[pair.part];
            if model.density.is_none() && !self.masses.iter().any(|m| m.part == pair.part) {
                let name = &model.name;
                let message = format!(
                    "only one number, and {name} has no density; expected inertia and friction, or `attr {name} : density = …` in the model"
                );
                return Err(Fault::new(pair.number, message));
            }
        }
        Ok(())
    }
}

/// Refuses a second entry for a part. `what` names this line, `earlier` the one before with its place.
pub(crate) fn once(
    machine: &Machine,
    (part, place): (usize, Place),
    what: &str,
    earlier: Option<(&str, Place)>,
) -> Read<()> {
    let Some((before, at)) = earlier else { return Ok(()) };
    let name = &machine.parts()[part].name;
    let message = if before == what {
        format!("a second {what} for {name} (the first is at {}:{}); expected one", at.line, at.column)
    } else {
        format!(
            "a {what} for {name}, which has a {before} (at {}:{}); expected one of them",
            at.line, at.column
        )
    };
    Err(Fault::new(place, message))
}
