//! What of either body lies within reach of the other anywhere in the domain. Of wheels whose period is used that is a few
//! teeth: trees and discs of the others need not be made.

use crate::around::Around;
use crate::element::Frame;
use crate::pairs::Cell;
use crate::section::Section;
use crate::tree::Node;
use mainspring_geometry::Vec2;

/// Positions this part of the size beyond the domain count as within it: tests step off curves by less.
const BEYOND: f64 = 1e-3;

/// Discs around the sections of both bodies, and how far all moves within the domain.
pub(crate) struct Within {
    domain: Around,
    bodies: [Vec<Node>; 2],
    beyond: f64,
}

impl Within {
    pub fn new(frame: &Frame, sections: [&[Section]; 2]) -> Self {
        let domain = Around::new(&frame.moving, &Cell::whole(&frame.axes), frame.size);
        let bodies = sections.map(|s| s.iter().filter_map(|s| s.all.tree.nodes.first().copied()).collect());
        Within { domain, bodies, beyond: BEYOND * frame.size }
    }

    /// May what lies in this disc of body `k` (local coordinates) meet the other body?
    pub fn reach(&self, k: usize, (center, radius): (Vec2, f64)) -> bool {
        let disc = Node::leaf((center, radius + self.beyond), 0);
        self.bodies[1 - k]
            .iter()
            .any(|other| if k == 0 { self.domain.near(&disc, other) } else { self.domain.near(other, &disc) })
    }
}
