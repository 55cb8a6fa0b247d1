//! From solids to a mechanism: kinematic pairs, subsystems, possible interactions, gap functions.

// Contact: features, gaps, where they may close.
mod feature;
mod gap;
mod interaction;
mod placed;
mod relative;
mod source;
mod system;
mod tree;

pub use feature::{Cone, Feature, FeatureName, FeatureShape, features};
pub use gap::{GapKind, GapState, gap, gap_state};
pub use interaction::{Exclusion, Interaction, System};
pub use placed::{Field, MAX_CHAIN, MAX_ROW, Placed, PointMotion, Row};
pub use relative::{Approach, Relative, approach};
pub use source::{Candidate, ContactId, ContactSource, DirectSearch};
pub use system::{Body, Coordinate, Joint, Motion, Pose};
pub use tree::{FeatureTree, Node};

// Kinematics: from shapes to pairs, mobility and subsystems.
mod kinematics;

pub use kinematics::{
    AxisLine, Bounds, ClosedChain, CompileOptions, Dropped, Evidence, EvidenceKind, Freedom, JointSpring,
    Mechanism, NearMiss, Pair, PairKind, Part, PartValue, Subsystem, Symmetry, SymmetryType, Warning,
    WorkingPlane, canonical,
};
