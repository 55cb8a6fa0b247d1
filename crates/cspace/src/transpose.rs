//! The map with its coordinates exchanged, from the same boundary pieces.
//!
//! A piece is monotone in both positions, so it is a graph over the other one too: of the transposed equation's two
//! roots the one that passes the piece's middle.

use crate::element::Element;
use crate::error::SpaceError;
use crate::links::{links, parts};
use crate::locate::Locator;
use crate::pieces::Piece;
use crate::region::Regions;
use crate::slabs::{Atlas, build};
use crate::space::ConfigurationSpace;
use std::sync::{Arc, OnceLock};

/// A piece flatter than this (scaled position) becomes upright.
const FLAT: f64 = 1e-10;

fn swap<T: Clone>([a, b]: &[T; 2]) -> [T; 2] {
    [b.clone(), a.clone()]
}

impl Regions {
    fn transposed(&self) -> Self {
        let turned =
            |f: &(usize, usize, Vec<(u32, u32)>)| (f.1, f.0, f.2.iter().map(|&(i, j)| (j, i)).collect());
        Regions {
            sections: swap(&self.sections),
            facing: self.facing.iter().map(turned).collect(),
            rounding: self.rounding,
        }
    }
}

impl Atlas {
    fn transposed(&self) -> Self {
        let mut frame = self.frame.clone();
        frame.moving.swap(0, 1);
        frame.axes.swap(0, 1);
        let equations: Vec<_> = self.equations.iter().map(|e| e.swapped()).collect();
        let mut atlas = Atlas { frame, pieces: vec![], elements: vec![], equations };
        for (id, piece) in self.pieces.iter().enumerate() {
            let pair = self.elements[piece.element as usize].pair;
            let (element, piece) = self.turned(&atlas, id as u32, pair, piece);
            atlas.elements.push(element);
            atlas.pieces.push(piece);
        }
        atlas
    }

    fn turned(&self, atlas: &Atlas, id: u32, pair: u32, piece: &Piece) -> (Element, Piece) {
        let rising = piece.v[1] >= piece.v[0];
        let order = |r: [f64; 2]| if rising { r } else { [r[1], r[0]] };
        let (u, v) = (order(piece.v), order(piece.u));
        if (u[1] - u[0]).abs() <= FLAT {
            let at = 0.5 * (u[0] + u[1]);
            let (low, high) = (v[0].min(v[1]), v[0].max(v[1]));
            let (u, v) = ([at, at], [low, high]);
            let element = Element { pair, branch: 0.0, u, v };
            return (element, Piece { element: id, u, v, free_above: piece.free_above });
        }
        let free_above = if piece.is_upright() { piece.free_above } else { piece.free_above != rising };
        let middle = 0.5 * (u[0] + u[1]);
        let inner = if piece.is_upright() { piece.u[0] } else { self.u_at(id, middle) };
        let roots = atlas.equations[pair as usize].solve_v(&atlas.frame.moving, middle);
        let off = |branch: f64| (atlas.frame.axes[1].nearest(roots.root(branch), inner) - inner).abs();
        let branch = if off(1.0) <= off(-1.0) { 1.0 } else { -1.0 };
        (Element { pair, branch, u, v }, Piece { element: id, u, v, free_above })
    }

    /// u at v on a graph piece, by bisection (monotone).
    fn u_at(&self, piece: u32, v: f64) -> f64 {
        let p = &self.pieces[piece as usize];
        let rising = p.v[1] >= p.v[0];
        let (mut a, mut b) = (p.u[0], p.u[1]);
        for _ in 0..60 {
            let u = 0.5 * (a + b);
            if (self.v_at(piece, u) < v) == rising { a = u } else { b = u }
        }
        0.5 * (a + b)
    }
}

impl ConfigurationSpace {
    /// The space with its two coordinates exchanged; curves keep their numbers.
    ///
    /// # Errors
    /// [`SpaceError::Degenerate`] as for the space itself.
    pub fn transposed(&self) -> Result<&ConfigurationSpace, SpaceError> {
        let made = self.transposed.get_or_init(|| Arc::new(self.transpose()));
        made.as_ref().as_ref().map_err(Clone::clone)
    }

    fn transpose(&self) -> Result<ConfigurationSpace, SpaceError> {
        let atlas = self.atlas.transposed();
        let regions = self.regions.transposed();
        let levers = swap(&self.levers);
        let judge = crate::pieces::Judge::new(&atlas.frame, &regions, levers);
        let ratios = atlas.frame.moving.map(|m| m.ratio);
        let slabs = build(&atlas, &judge, |at| [at[1] / ratios[1], at[0] / ratios[0]])?;
        let links = links(&slabs, &atlas);
        let cells = parts(&slabs, &links);
        let locator = Locator::new(&atlas, &slabs);
        Ok(ConfigurationSpace {
            names: self.names.clone(),
            coordinates: swap(&self.coordinates),
            moved: swap(&self.moved),
            flipped: !self.flipped,
            atlas,
            slabs,
            locator,
            links,
            cells,
            regions,
            levers,
            transposed: OnceLock::new(),
            parts: swap(&self.parts),
            pairs: self.pairs.iter().map(swap).collect(),
            repeats: swap(&self.repeats),
            work: self.work,
        })
    }
}
