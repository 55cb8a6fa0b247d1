//! The compiled machine: immutable numbers at given parameter values.

use super::bounds::Bounds;
use super::joint_forces::JointForces;
use super::masses::PartMass;
use super::mobility::ClosedChain;
use super::near_miss::NearMiss;
use super::pair::Pair;
use super::plane::WorkingPlane;
use super::subsystems::Subsystem;
use super::symmetry::Symmetry;
use crate::forces::ContactLaw;
use crate::interaction::System;
use mainspring_geometry::{Csg, Outline, OutlineRecipe, Primitive, Vec3};
use mainspring_model::{Machine, Place};
use std::sync::{Arc, OnceLock};

/// What `compile` may assume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompileOptions {
    /// A shaft smaller than its hole by up to this (difference of radii or of half widths, in the file's length)
    /// still makes a pair.
    pub pair_clearance: f64,
    /// Keep freedoms that nothing uses (the 2½-dimensional rule is switched off).
    pub keep_axial: bool,
}

impl Default for CompileOptions {
    fn default() -> Self {
        CompileOptions { pair_clearance: 0.0, keep_axial: false }
    }
}

/// A spring of a joint: torque or force `−constant (x − relaxed)`, x the joint's position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointSpring {
    /// Radians, or the file's length.
    pub relaxed: f64,
    /// Torque per radian, or force per length.
    pub constant: f64,
}

/// A part with everything known of it.
#[derive(Clone, Debug)]
pub struct Part {
    pub name: String,
    pub is_frame: bool,
    pub csg: Csg,
    /// Box around its primitives, as modelled.
    pub bounds: Bounds,
    /// Diagonal of that box.
    pub size: f64,
    pub symmetries: Vec<Symmetry>,
    /// The pair by which it hangs on the frame or on its carrier; none for the frame and for parts held by nothing.
    pub joint: Option<usize>,
    /// The other part of that pair.
    pub carrier: Option<usize>,
    /// Moment of inertia about the joint's axis, or mass of a sliding part; given, or from the density.
    pub inertia: Option<f64>,
    /// The inertia was computed from the density.
    pub inertia_from_density: bool,
    /// As far as known; a density is looked at where the inertia, a moving carrier or gravity asks for it.
    pub mass: PartMass,
    /// Torque per angular velocity (radians), or force per velocity.
    pub friction: f64,
    pub spring: Option<JointSpring>,
    /// What else acts along its joint.
    pub forces: JointForces,
    /// Joint position at the start: radians, or the file's length.
    pub position: f64,
    /// Joint velocity at the start.
    pub velocity: f64,
    /// Section in the working plane, as modelled; none if the part is no prism along its normal.
    pub outline: Option<Outline>,
    pub recipe: Option<OutlineRecipe>,
    /// Why there is no outline, or what it leaves out.
    pub note: Option<String>,
    /// The primitive that keeps the part from having an outline.
    pub tilted: Option<u32>,
    /// Where it is written, or its line in the supplement.
    pub place: Place,
}

/// A remark about the machine, with its place in the text if it has one.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    pub place: Option<Place>,
    /// Indices of the parts it is about.
    pub parts: Vec<usize>,
    pub message: String,
}

/// A machine compiled at given parameter values: how its parts can move.
#[derive(Clone, Debug)]
pub struct Mechanism {
    pub machine: Arc<Machine>,
    /// Every parameter with its value.
    pub parameters: Vec<(String, f64)>,
    pub options: CompileOptions,
    /// Placed in the machine, as modelled.
    pub primitives: Vec<Primitive>,
    pub parts: Vec<Part>,
    /// Index of the frame.
    pub frame: usize,
    /// Lower pairs, then gear pairs; each by the order of its parts.
    pub pairs: Vec<Pair>,
    pub near_misses: Vec<NearMiss>,
    pub subsystems: Vec<Subsystem>,
    /// Loops of pairs; gear trains on fixed axes are not listed unless they are locked.
    pub closed_chains: Vec<ClosedChain>,
    /// Independent motions of the whole machine, as far as it was examined.
    pub mobility: usize,
    pub plane: WorkingPlane,
    /// Acceleration of the uniform field in machine coordinates; 0 if none was given.
    pub gravity: Vec3,
    /// Constants of compliant contact.
    pub contact: ContactLaw,
    pub warnings: Vec<Warning>,
    /// Diagonal of the box around all parts: tolerances are relative to it.
    pub size: f64,
    pub(crate) tolerance: f64,
    /// What [`Mechanism::system_of_shapes`] made, once it was asked.
    pub(crate) shapes: OnceLock<Arc<System>>,
    /// What [`Mechanism::kept_system`] made, once it was asked; another start state makes another.
    pub(crate) whole: OnceLock<Arc<System>>,
}

impl Mechanism {
    /// Index of a part by its name, in any letter case.
    pub fn part_index(&self, name: &str) -> Option<usize> {
        self.machine.part_index(name)
    }

    /// The subsystem a part moves with, and its velocity over that of the root.
    pub fn subsystem_of(&self, part: usize) -> Option<(usize, f64)> {
        self.subsystems
            .iter()
            .enumerate()
            .find_map(|(i, s)| s.parts.iter().find(|(p, _)| *p == part).map(|(_, ratio)| (i, *ratio)))
    }

    /// Names of the state variables: `PART.position` and `PART.velocity` of each subsystem's root.
    pub fn state_variables(&self) -> Vec<String> {
        let of = |s: &Subsystem| {
            let name = &self.parts[s.root].name;
            [format!("{name}.position"), format!("{name}.velocity")]
        };
        self.subsystems.iter().flat_map(of).collect()
    }
}
