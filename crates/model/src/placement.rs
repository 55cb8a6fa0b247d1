//! Where solids are put: the motions of `at`, and the copies of a symmetric union.

use crate::angle::{rotation, translation};
use crate::description::SymmetryKind;
use crate::error::Read;
use crate::expression::Expression;
use mainspring_geometry::{Axis, Rigid3, Scalar};

/// One motion of an `at` group: `mov…` in the file's length, `deg…` in degrees.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    pub turns: bool,
    pub axis: Axis,
    pub amount: Expression,
}

/// A placement as written: the motions of one `at`, applied left to right about the origin and its axes.
pub(crate) type Placement = Vec<Motion>;

/// How copies of a symmetric union follow each other.
#[derive(Clone, Debug)]
pub(crate) struct Copies {
    pub kind: SymmetryKind,
    pub axis: Axis,
    pub count: u32,
    pub range: Expression,
}

/// A pose relative to another one; the poses of a machine form a forest, parents first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PoseStep {
    /// Index of the pose this one is relative to; pose 0 is the machine itself.
    pub parent: u32,
    pub kind: StepKind,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum StepKind {
    /// The machine's own coordinates.
    Root,
    /// Index of a placement.
    Placed(u32),
    /// Index of a symmetric union's copies, and which copy.
    Copy(u32, u32),
}

/// The motion of a placement: the outermost motion is the last written.
pub(crate) fn placed<S: Scalar>(motions: &Placement, values: &[S]) -> Read<Rigid3<S>> {
    let mut pose = Rigid3::identity();
    for motion in motions {
        let amount = motion.amount.evaluate(values)?;
        pose = moved(motion.turns, motion.axis, amount).then_after(&pose);
    }
    Ok(pose)
}

/// Copy k of a symmetric union lies at k · range / count (Gelsey 1995, Alg. 14, corrected).
pub(crate) fn copied<S: Scalar>(copies: &Copies, k: u32, values: &[S]) -> Read<Rigid3<S>> {
    let amount = copies.range.evaluate(values)? * f64::from(k) / f64::from(copies.count);
    Ok(moved(copies.kind == SymmetryKind::Rotational, copies.axis, amount))
}

fn moved<S: Scalar>(turns: bool, axis: Axis, amount: S) -> Rigid3<S> {
    if turns { rotation(axis, amount) } else { translation(axis, amount) }
}
