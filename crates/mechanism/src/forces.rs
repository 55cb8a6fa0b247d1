//! What acts beside the linear forces of coordinates: drives, dry friction, stops, masses on chains, gravity.

use crate::drive::Drive;
use mainspring_geometry::Vec2;

/// Constants of compliant contact: the force is `o (e + d m ȯ)` at overlap o, never negative (Gelsey 1995, Eq. 4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// E: force per overlap, > 0.
    pub e: f64,
    /// D: force per rate of overlap, ≥ 0.
    pub d: f64,
    /// M: factor per overlap that lets damping set in gradually, ≥ 0.
    pub m: f64,
}

impl Default for ContactLaw {
    /// The paper's values.
    fn default() -> Self {
        Self { e: 1e5, d: 1e4, m: 100.0 }
    }
}

/// A limit of a joint, one-sided: the gap `g = side · lever · (q − limit) ≥ 0` of its coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    pub coordinate: usize,
    /// Indices of the limited body and of its carrier.
    pub bodies: (usize, usize),
    /// Is it the upper limit of the body's own joint?
    pub upper: bool,
    /// Position of the coordinate at the stop.
    pub limit: f64,
    /// Length per unit of the coordinate, > 0: how far out the stop acts on a part that turns.
    pub lever: f64,
    /// +1 where the coordinate must stay above, −1 where it must stay below.
    pub side: f64,
}

impl Stop {
    /// The gap in the file's length: positive apart, zero touching.
    pub fn gap(&self, q: f64) -> f64 {
        self.slope() * (q - self.limit)
    }

    /// ∂g/∂q.
    pub fn slope(&self) -> f64 {
        self.side * self.lever
    }
}

/// A body's mass, for what the constant inertia of a coordinate cannot say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    pub body: usize,
    pub mass: f64,
    /// Centre of mass in the working plane, where the body is modelled.
    pub center: Vec2,
    /// Moment of inertia about the centre of mass.
    pub inertia: f64,
    /// On a chain of two joints or more: its inertia depends on positions and is in no [`crate::Coordinate`].
    /// Otherwise only gravity acts on this mass.
    pub chained: bool,
}

/// What acts beside the linear forces; lists by coordinate have an entry for each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Forces {
    /// The part of the coordinate's constant force that TORQUE and FORCE exert; its work is no stored energy.
    pub applied: Vec<f64>,
    /// Size of the dry friction against the coordinate's motion, ≥ 0.
    pub coulomb: Vec<f64>,
    /// Prescribed motions.
    pub drives: Vec<Option<Drive>>,
    /// By coordinate, lower before upper.
    pub stops: Vec<Stop>,
    /// By body.
    pub masses: Vec<Mass>,
    /// Acceleration of the uniform field in the working plane.
    pub gravity: Vec2,
    pub contact: ContactLaw,
}

impl Forces {
    /// Nothing acts on `n` coordinates.
    pub fn none(n: usize) -> Self {
        Self { applied: vec![0.0; n], coulomb: vec![0.0; n], drives: vec![None; n], ..Self::default() }
    }
}
