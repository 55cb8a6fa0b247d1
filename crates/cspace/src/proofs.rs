//! Proofs that a whole box of configurations is blocked.

use crate::around::Around;
use crate::crossing::Crossed;
use crate::region::Regions;
use crate::witness::{Overlapped, Witnesses};

/// Proofs are looked for in proportion to the feature pairs that one would save, and to how often it was found lately: so
/// many pairs of tree nodes for each feature pair at certain success. Crossing boundaries first,
const CROSSINGS: f64 = 30.0;
/// then overlapping discs.
const DISCS: f64 = 50.0;
/// Success is never taken to be rarer than this part of the boxes,
const RARE: f64 = 0.02;
/// and to begin with to be this part.
const AT_FIRST: f64 = 0.1;
/// Boxes over which success is averaged.
const MEMORY: f64 = 15.0;

/// How often a kind of proof was found lately.
struct Success(f64);

impl Success {
    /// Pairs of tree nodes to look at for a proof that would save this many feature pairs.
    fn effort(&self, gain: f64, pairs: usize) -> usize {
        (gain * self.0 * pairs as f64) as usize
    }

    fn learn(&mut self, proved: bool) -> bool {
        self.0 += (f64::from(u8::from(proved)) - self.0) / MEMORY;
        self.0 = self.0.max(RARE);
        proved
    }
}

/// What proves boxes blocked, and what it learnt on the way.
pub(crate) struct Proofs<'a> {
    regions: &'a Regions,
    witnesses: &'a Witnesses,
    crossed: Crossed,
    overlapped: Overlapped,
    crossings: Success,
    discs: Success,
}

impl<'a> Proofs<'a> {
    pub fn new(regions: &'a Regions, witnesses: &'a Witnesses) -> Self {
        let (crossings, discs) = (Success(AT_FIRST), Success(AT_FIRST));
        Proofs {
            regions,
            witnesses,
            crossed: Crossed::default(),
            overlapped: Overlapped::default(),
            crossings,
            discs,
        }
    }

    /// Do boundaries cross throughout? Worth the more, the more pairs of nodes may touch in the box.
    pub fn cross(&mut self, around: &Around, pairs: usize) -> bool {
        let effort = self.crossings.effort(CROSSINGS, pairs);
        self.crossings.learn(self.crossed.throughout(self.regions, around, effort))
    }

    /// Do discs inside overlap throughout? Worth the more, the more feature pairs may touch in the box.
    pub fn overlap(&mut self, around: &Around, pairs: usize) -> bool {
        let effort = self.discs.effort(DISCS, pairs);
        self.discs.learn(self.witnesses.blocked_again(around, effort, &mut self.overlapped))
    }
}
