//! Feature pairs that can touch, found cell by cell: the curves made for them are kept.

use crate::domain::Axis;
use crate::element::{Element, Frame, Scratch, elements};
use crate::equation::Equation;
use crate::shape::Shape;
use crate::tree::Discs;
use crate::within::Within;
use mainspring_geometry::Vec2;
use mainspring_mechanism::GapKind;
use std::collections::HashMap;

/// A feature of one of the two bodies.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Index among the body's features.
    pub id: usize,
    pub shape: Shape,
    /// Neighbours in the outline, by their indices among the body's features.
    pub neighbours: Vec<usize>,
    /// A disc around it in local coordinates.
    pub disc: (Vec2, f64),
    /// Greatest speed of its points per unit of the scaled position.
    pub lever: f64,
    /// The same for an arc's centre (of no use for an edge).
    pub center_lever: f64,
}

/// A feature pair with its elements.
#[derive(Clone, Debug)]
pub(crate) struct Curves {
    /// Indices into the parts of the first and second body.
    pub parts: [u32; 2],
    pub eq: Equation,
    /// Range of its elements.
    pub elements: (u32, u32),
}

/// A box of configurations: centre and half widths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub center: [f64; 2],
    pub half: [f64; 2],
}

impl Cell {
    /// The whole domain.
    pub fn whole(axes: &[Axis; 2]) -> Self {
        let half = [0, 1].map(|k| 0.5 * axes[k].length);
        Cell { center: [0, 1].map(|k| axes[k].start + half[k]), half }
    }

    pub fn range(&self, axis: usize) -> (f64, f64) {
        (self.center[axis] - self.half[axis], self.center[axis] + self.half[axis])
    }
}

/// All parts of both bodies and the curves found so far.
pub(crate) struct Catalogue<'a> {
    pub frame: &'a Frame,
    pub parts: [&'a [Part]; 2],
    pub trees: [Discs; 2],
    /// Which pairs can touch (layers, kinds, exclusions).
    pub kind: &'a dyn Fn(usize, usize) -> Option<GapKind>,
    pub curves: Vec<Curves>,
    pub elements: Vec<Element>,
    known: HashMap<(u32, u32), Option<u32>>,
    scratch: Scratch,
}

impl<'a> Catalogue<'a> {
    pub fn new(
        frame: &'a Frame,
        parts: [&'a [Part]; 2],
        within: &Within,
        kind: &'a dyn Fn(usize, usize) -> Option<GapKind>,
    ) -> Self {
        let trees = [0, 1].map(|k| {
            let discs: Vec<_> = parts[k].iter().map(|p| p.disc).collect();
            let chosen = (0..discs.len() as u32).filter(|&i| within.reach(k, discs[i as usize]));
            Discs::over(&discs, chosen)
        });
        Catalogue {
            frame,
            parts,
            trees,
            kind,
            curves: vec![],
            elements: vec![],
            known: HashMap::new(),
            scratch: Scratch::default(),
        }
    }

    /// The curves of a pair, made when first asked for; none if it cannot touch.
    pub fn curves_of(&mut self, i: u32, j: u32) -> Option<u32> {
        if let Some(known) = self.known.get(&(i, j)) {
            return *known;
        }
        let (a, b) = (&self.parts[0][i as usize], &self.parts[1][j as usize]);
        let made = (self.kind)(a.id, b.id).map(|_| {
            let eq = Equation::new([a.shape, b.shape]);
            let (index, start) = (self.curves.len() as u32, self.elements.len() as u32);
            elements(index, &eq, self.frame, &mut self.scratch, &mut self.elements);
            let range = (start, self.elements.len() as u32);
            self.curves.push(Curves { parts: [i, j], eq, elements: range });
            index
        });
        self.known.insert((i, j), made);
        made
    }
}
