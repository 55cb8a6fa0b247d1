//! What moves: coordinates with their linear forces, and bodies whose pose is a chain of joint motions.
//!
//! Between contacts a coordinate obeys `I q̈ = f − k q − h q̇` (Gelsey 1995, Eqs. 3 and 5 without contact terms).

use mainspring_geometry::{Outline, Scalar, Vec2};

/// One joint position: the coordinate of a subsystem, in radians (turning) or the file's length (sliding).
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Name of the subsystem's root part.
    pub name: String,
    /// Reflected inertia I > 0: moment of inertia about the axis, or mass.
    pub inertia: f64,
    /// Viscous friction h ≥ 0.
    pub damping: f64,
    /// Sum of reflected spring constants k ≥ 0.
    pub stiffness: f64,
    /// Constant part f of the force: `Σ kᵢ rᵢ xᵢ` for springs relaxed at xᵢ on members of ratio rᵢ.
    pub force: f64,
    /// Elastic energy at q = 0, so that energies of springs are never negative.
    pub energy_at_zero: f64,
    /// Position at t = 0.
    pub position: f64,
    /// Velocity at t = 0.
    pub velocity: f64,
}

impl Coordinate {
    /// One at zero and at rest that nothing acts on.
    pub fn free(name: impl Into<String>, inertia: f64) -> Self {
        Self {
            name: name.into(),
            inertia,
            damping: 0.0,
            stiffness: 0.0,
            force: 0.0,
            energy_at_zero: 0.0,
            position: 0.0,
            velocity: 0.0,
        }
    }
}

impl Coordinate {
    /// Potential energy of the springs at position `q`.
    pub fn potential(&self, q: f64) -> f64 {
        (0.5 * self.stiffness * q - self.force) * q + self.energy_at_zero
    }

    /// Acceleration without contacts.
    pub fn free_acceleration(&self, q: f64, v: f64) -> f64 {
        (self.force - self.stiffness * q - self.damping * v) / self.inertia
    }
}

/// How a joint moves its body in the working plane as its own position grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Counterclockwise about a point of the carrier's modelled place.
    Turn { center: Vec2 },
    /// Along a unit vector.
    Slide { direction: Vec2 },
}

/// A joint of a pose chain: its position is `ratio · q[coordinate]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    pub coordinate: usize,
    pub ratio: f64,
    pub motion: Motion,
}

/// A rigid motion of the plane: `p ↦ (c −s; s c) p + t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<S = f64> {
    pub cos: S,
    pub sin: S,
    pub shift: Vec2<S>,
}

impl<S: Scalar> Pose<S> {
    pub fn identity() -> Self {
        let zero = S::constant(0.0);
        Self { cos: S::constant(1.0), sin: zero, shift: Vec2::new(zero, zero) }
    }

    /// A turn about the origin by an angle in radians.
    pub fn turn(angle: S) -> Self {
        let (sin, cos) = angle.sine_and_cosine();
        let zero = S::constant(0.0);
        Self { cos, sin, shift: Vec2::new(zero, zero) }
    }

    /// The image of a direction.
    pub fn rotate(&self, d: Vec2<S>) -> Vec2<S> {
        Vec2::new(self.cos * d.x - self.sin * d.y, self.sin * d.x + self.cos * d.y)
    }

    /// The image of a point.
    pub fn apply(&self, p: Vec2<S>) -> Vec2<S> {
        self.rotate(p) + self.shift
    }

    /// The direction whose image is `d`.
    pub fn rotate_back(&self, d: Vec2<S>) -> Vec2<S> {
        Vec2::new(self.cos * d.x + self.sin * d.y, self.cos * d.y - self.sin * d.x)
    }

    /// The point whose image is `p`.
    pub fn apply_back(&self, p: Vec2<S>) -> Vec2<S> {
        self.rotate_back(p - self.shift)
    }

    /// `self ∘ inner`: first `inner`, then `self`.
    pub fn then_after(&self, inner: &Self) -> Self {
        Self {
            cos: self.cos * inner.cos - self.sin * inner.sin,
            sin: self.sin * inner.cos + self.cos * inner.sin,
            shift: self.apply(inner.shift),
        }
    }
}

impl Motion {
    /// The centre of a turn or the direction of a slide, where the carrier is as modelled.
    pub fn vector(&self) -> Vec2 {
        match *self {
            Motion::Turn { center } => center,
            Motion::Slide { direction } => direction,
        }
    }

    /// The rigid motion at joint position `x`.
    pub fn pose<S: Scalar>(&self, x: S) -> Pose<S> {
        match *self {
            Motion::Turn { center } => {
                let (c, turn) = (Vec2::constant(center), Pose::turn(x));
                Pose { shift: c - turn.rotate(c), ..turn }
            }
            Motion::Slide { direction } => {
                Pose { shift: Vec2::<S>::constant(direction) * x, ..Pose::identity() }
            }
        }
    }
}

/// A part as contact sees it: its pose chain, from the frame outwards, and its outline as modelled.
#[derive(Clone, Debug)]
pub struct Body {
    pub name: String,
    /// Empty for the frame.
    pub chain: Vec<Joint>,
    pub outline: Outline,
}

impl Body {
    /// machine_from_modelled: where the part is at joint positions `q`.
    pub fn pose<S: Scalar>(&self, q: &[S]) -> Pose<S> {
        self.chain.iter().fold(Pose::identity(), |pose, joint| {
            pose.then_after(&joint.motion.pose(q[joint.coordinate] * joint.ratio))
        })
    }
}
