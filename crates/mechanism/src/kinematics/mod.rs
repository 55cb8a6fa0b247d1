//! Kinematics: from the shapes of the parts to pairs, mobility and subsystems (Gelsey 1995, Section 2.1).

mod analysis;
mod axial;
mod bounds;
mod chain;
mod compile;
mod cylinder_fit;
mod fits;
mod gears;
mod linear;
mod lower;
mod mechanism;
mod mobility;
mod near_miss;
mod pair;
mod patch;
mod placement;
mod plane;
mod plane_fit;
mod region;
mod search;
mod section;
mod start;
mod subsystems;
mod supplement;
mod surface;
mod symmetry;
mod words;

pub use bounds::Bounds;
pub use mechanism::{CompileOptions, JointSpring, Mechanism, Part, Warning};
pub use mobility::ClosedChain;
pub use near_miss::NearMiss;
pub use pair::{AxisLine, Dropped, Evidence, EvidenceKind, Freedom, Pair, PairKind};
pub use plane::WorkingPlane;
pub use subsystems::Subsystem;
pub use surface::canonical;
pub use symmetry::{Symmetry, SymmetryType};
