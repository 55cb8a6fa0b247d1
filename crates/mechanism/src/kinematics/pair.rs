//! Kinematic pairs: what they are and what they were found from (Gelsey 1995, Fig. 6).

use mainspring_geometry::{CurveId, Vec3};

/// How two parts constrain each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairKind {
    /// Turns about the axis.
    Revolute,
    /// Slides along the axis.
    Prismatic,
    /// Turns and slides: two freedoms.
    Cylindrical,
    /// Two gears in mesh.
    Gear,
    /// Neither turns nor slides.
    Fixed,
}

impl PairKind {
    /// The word used in tables and JSON.
    pub fn name(self) -> &'static str {
        match self {
            PairKind::Revolute => "revolute",
            PairKind::Prismatic => "prismatic",
            PairKind::Cylindrical => "cylindrical",
            PairKind::Gear => "gear",
            PairKind::Fixed => "fixed",
        }
    }

    pub(crate) fn of_freedoms(turns: bool, slides: bool) -> Self {
        match (turns, slides) {
            (true, true) => PairKind::Cylindrical,
            (true, false) => PairKind::Revolute,
            (false, true) => PairKind::Prismatic,
            (false, false) => PairKind::Fixed,
        }
    }

    /// Does it allow turning about its axis?
    pub fn turns(self) -> bool {
        matches!(self, PairKind::Revolute | PairKind::Cylindrical)
    }

    /// Does it allow sliding along its axis?
    pub fn slides(self) -> bool {
        matches!(self, PairKind::Prismatic | PairKind::Cylindrical)
    }
}

/// A line in space with a sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLine {
    /// The point nearest the machine's origin.
    pub point: Vec3,
    /// Unit vector whose first component that is not zero is positive; positive turning is right-handed about it.
    pub direction: Vec3,
}

/// One reason why a pair was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    pub what: EvidenceKind,
    /// A primitive of the pair's first and of its second part.
    pub primitives: [u32; 2],
    /// In words, with names and numbers.
    pub text: String,
}

/// The observation behind an [`Evidence`]. `solid` is 0 or 1: which of the pair's parts has material inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EvidenceKind {
    /// A shaft in a hole, over a stretch of the axis (lengths from the axis' point) and a part of the turn (radians).
    ShaftInHole { solid: usize, radius: f64, clearance: f64, from: f64, to: f64, angle: f64 },
    /// Faces that block motion across the axis.
    SideFaces { normal: Vec3, clearance: f64, area: f64 },
    /// Faces that block the first part's motion along the axis, in the direction of `normal`.
    EndFaces { normal: Vec3, area: f64 },
    /// The surfaces leave a way out in this direction, across the axis.
    OpenSide { exit: Vec3 },
    /// Stated in the machine's file, whatever the shapes say.
    Stated,
    /// Gear envelopes in mesh: how deep they overlap.
    Mesh { overlap: f64, internal: bool },
}

/// A freedom that shape allows and the machine does not use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    Turning,
    Sliding,
}

/// A freedom left out of a pair's kind in the machine, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dropped {
    pub freedom: Freedom,
    /// True: the other pairs forbid it. False: nothing drives it, so it is left out.
    pub blocked: bool,
    pub reason: String,
}

/// Two parts that constrain each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The kind in the machine, where other pairs may forbid what shape allows.
    pub kind: PairKind,
    /// The kind by the shapes of the two parts alone.
    pub shape_kind: PairKind,
    /// Indices of the parts, the first in the text first.
    pub parts: (usize, usize),
    /// For gears the axis of the first part.
    pub axis: AxisLine,
    /// For gears: velocity of the second part over that of the first.
    pub ratio: Option<f64>,
    /// Radial play between shaft and hole, or face and face; the centre is kept.
    pub clearance: f64,
    pub evidence: Vec<Evidence>,
    pub dropped: Vec<Dropped>,
    /// Surfaces of the first and second part that make the pair: no contact features between these two parts.
    pub surfaces: [Vec<CurveId>; 2],
}

impl Pair {
    /// A lower pair: surfaces in contact, not gears.
    pub fn is_lower(&self) -> bool {
        self.kind != PairKind::Gear
    }

    /// The other part of the pair.
    pub fn other(&self, part: usize) -> usize {
        if self.parts.0 == part { self.parts.1 } else { self.parts.0 }
    }
}
