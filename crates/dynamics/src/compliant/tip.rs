//! A place where two parts overlap, or a joint lies beyond its stop.

use mainspring_mechanism::{Candidate, GapState, Row};

/// A place where two parts overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// The pair of features that gives the depth, or the stop.
    pub candidate: Candidate,
    /// Whether the clamp of the law holds its force at zero.
    pub clamped: bool,
    /// Places of its bodies in the group's list.
    pub sides: (usize, usize),
}

impl Tip {
    /// Of a contact that has just closed.
    pub fn new(candidate: Candidate) -> Self {
        Self { candidate, clamped: false, sides: (0, 0) }
    }

    /// The index of its stop, if it is none of two features.
    pub fn stop(&self) -> Option<usize> {
        self.candidate.id.stop()
    }
}

/// A tip at one state.
#[derive(Clone, Copy, Debug)]
pub struct TipState {
    pub gap: GapState,
    pub row: Row,
    pub depth: f64,
    pub rate: f64,
}
