//! Contact curves as they bound free space.

use crate::pieces::Piece;
use crate::space::ConfigurationSpace;

/// A stretch of contact curve that bounds free space: one pair of features, monotone in both coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'s> {
    space: &'s ConfigurationSpace,
    /// Index of the piece, the curve's name within the space.
    pub id: u32,
}

impl ConfigurationSpace {
    /// All curves that bound free space, within the stored domain.
    pub fn curves(&self) -> Vec<Curve<'_>> {
        (0..self.atlas.pieces.len() as u32).map(|id| Curve { space: self, id }).collect()
    }

    /// One of them.
    pub fn curve(&self, id: u32) -> Option<Curve<'_>> {
        ((id as usize) < self.atlas.pieces.len()).then_some(Curve { space: self, id })
    }

    fn joint(&self, u: f64, v: f64) -> [f64; 2] {
        let m = &self.atlas.frame.moving;
        [u / m[0].ratio, v / m[1].ratio]
    }
}

impl<'s> Curve<'s> {
    pub(crate) fn space(&self) -> &'s ConfigurationSpace {
        self.space
    }

    pub(crate) fn piece(&self) -> &'s Piece {
        &self.space.atlas.pieces[self.id as usize]
    }

    /// Features of the first and the second body (indices in the system).
    pub fn features(&self) -> [usize; 2] {
        let element = &self.space.atlas.elements[self.piece().element as usize];
        let [i, j] = self.space.pairs[element.pair as usize];
        let ids = [self.space.parts[0][i as usize].id, self.space.parts[1][j as usize].id];
        if self.space.flipped { [ids[1], ids[0]] } else { ids }
    }

    /// Does the curve not depend on the second coordinate?
    pub fn is_upright(&self) -> bool {
        self.piece().is_upright()
    }

    /// The configuration at a fraction of the way (of the first coordinate; of the second if upright).
    pub fn at(&self, fraction: f64) -> [f64; 2] {
        let p = self.piece();
        let mix = |r: [f64; 2]| r[0] + (r[1] - r[0]) * fraction;
        if p.is_upright() {
            return self.space.joint(p.u[0], mix(p.v));
        }
        let u = mix(p.u);
        self.space.joint(u, self.space.atlas.v_at(self.id, u))
    }

    pub fn from(&self) -> [f64; 2] {
        let p = self.piece();
        self.space.joint(p.u[0], p.v[0])
    }

    pub fn to(&self) -> [f64; 2] {
        let p = self.piece();
        self.space.joint(p.u[1], p.v[1])
    }

    /// Is free space on the side of greater second coordinate (of greater first, if upright)?
    pub fn free_above(&self) -> bool {
        self.piece().free_above
    }
}
