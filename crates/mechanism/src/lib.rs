//! From solids to a mechanism: kinematic pairs, subsystems, possible interactions, gap functions.

// Contact: features, gaps, where they may close.
mod alike;
mod boundary;
mod constraint;
mod contact_law;
mod feature;
mod gap;
mod grouping;
mod hessian;
mod hinge;
mod interaction;
mod overlap;
mod placed;
mod places;
mod relative;
mod repeats;
mod source;
mod system;
mod tree;

pub use boundary::Boundary;
pub use constraint::{Constrained, Constraint, Moving};
pub use feature::{Cone, Feature, FeatureName, FeatureShape, features};
pub use gap::{GapKind, GapState, gap, gap_state, misses_cone};
pub use grouping::{Indices, join_sharing};
pub use hessian::Hessian;
pub use hinge::{Hinge, HingeConstraint, Hinged, Hung};
pub use interaction::{Exclusion, Interaction, System};
pub use overlap::{Overlaps, Successor, is_on};
pub use placed::{Field, MAX_CHAIN, MAX_ROW, Placed, PointMotion, Row};
pub use places::{Place, Sway, places};
pub use relative::{Approach, Relative, approach, gap_between};
pub use repeats::{Mark, order};
pub use source::{Candidate, ContactId, ContactSource, DirectSearch, feature_distance};
pub use system::{Body, Coordinate, Joint, Motion, Pose};
pub use tree::{FeatureTree, Node};

// Forces: drives, friction, stops, masses on chains, equations of motion.
mod drive;
mod equations;
mod forces;

pub use drive::{Drive, DrivePiece, Driven, Table};
pub use equations::{Coupled, Equations, EquationsJacobian};
pub use forces::{ContactLaw, Forces, Mass, Stop};

// Kinematics: from shapes to pairs, mobility and subsystems.
mod kinematics;

pub use kinematics::{
    AxisLine, Bounds, ClosedChain, CompileOptions, Dropped, Evidence, EvidenceKind, Freedom, JointDrive,
    JointForces, JointSpring, Mechanism, NearMiss, Pair, PairKind, Part, PartMass, PartValue, Subsystem,
    Symmetry, SymmetryType, Warning, WorkingPlane, canonical,
};
