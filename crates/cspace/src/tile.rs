//! One period further: which feature touches there.
//!
//! A body that looks the same after a turn by P about its joint's centre shows, at u + P, another of its features where
//! one of the stored tile was at u. With the body placed by `place(u) local` the same point of the machine is
//! `place(u) local p = place(u + P) local p'`, so `p' = local⁻¹ R(∓P) local p`: a turn about the joint's centre as modelled.

use crate::reduce::inverse;
use crate::space::ConfigurationSpace;
use mainspring_geometry::Vec2;

/// The turn, in coordinates as modelled, that takes a feature of the stored tile to the one that does the same one period
/// further.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileTurn {
    /// Index of the body that repeats.
    pub body: usize,
    pub center: Vec2,
    /// Radians, counterclockwise.
    pub angle: f64,
}

impl ConfigurationSpace {
    /// For a coordinate of which a part of the turn is stored: the turn for one period; none where nothing repeats.
    pub fn tile_turn(&self, coordinate: usize) -> Option<TileTurn> {
        let (moving, axis) = (&self.atlas.frame.moving[coordinate], &self.atlas.frame.axes[coordinate]);
        (self.repeats[coordinate] > 1).then(|| TileTurn {
            body: self.moved[coordinate],
            center: inverse(&moving.local).apply(Vec2::default()),
            angle: -moving.sign * axis.length,
        })
    }
}
