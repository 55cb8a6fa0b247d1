//! Proofs that a whole box of configurations is blocked.

use crate::around::Around;
use crate::crossing::Crossed;
use crate::region::Regions;
use crate::witness::Witnesses;

/// Discs are looked at in proportion to the feature pairs that a proof would save, and to how often it succeeded lately:
/// so many pairs of tree nodes for each feature pair at certain success.
const GAIN: f64 = 100.0;
/// Success is never taken to be rarer than this part of the boxes,
const RARE: f64 = 0.02;
/// and to begin with to be this part.
const AT_FIRST: f64 = 0.25;
/// Boxes over which success is averaged.
const MEMORY: f64 = 100.0;

/// Pairs of tree nodes looked at for crossing boundaries, for each pair of nodes that may touch in the box.
const NODES: usize = 10;

/// What proves boxes blocked, and what it learnt on the way.
pub(crate) struct Proofs<'a> {
    regions: &'a Regions,
    witnesses: &'a Witnesses,
    crossed: Crossed,
    /// How often discs have succeeded lately.
    success: f64,
}

impl<'a> Proofs<'a> {
    pub fn new(regions: &'a Regions, witnesses: &'a Witnesses) -> Self {
        Proofs { regions, witnesses, crossed: Crossed::default(), success: AT_FIRST }
    }

    /// Do boundaries cross throughout? Worth the more, the more pairs of nodes may touch in the box.
    pub fn cross(&mut self, around: &Around, pairs: usize) -> bool {
        self.crossed.throughout(self.regions, around, NODES * pairs)
    }

    /// Do discs inside overlap throughout? Worth the more, the more feature pairs may touch in the box.
    pub fn overlap(&mut self, around: &Around, pairs: usize) -> bool {
        let effort = (GAIN * self.success * pairs as f64) as usize;
        let proved = self.witnesses.blocked(around, 0.0, effort);
        self.success += (f64::from(u8::from(proved)) - self.success) / MEMORY;
        self.success = self.success.max(RARE);
        proved
    }
}
