//! Which stretches of the curves bound free space.
//!
//! A stretch between two cuts is free along its whole length or nowhere, for free and blocked change only where
//! another contact begins. So one test tells: the configuration in its middle, moved off its own contact by a hair along the
//! gap's gradient, must not overlap anywhere. Free space narrower than twice that hair is taken as blocked: what is
//! mapped is the closure of free space's interior, to `HAIR`.

use crate::cross::Cuts;
use crate::element::{Element, Frame};
use crate::pairs::Catalogue;
use crate::region::{Met, Regions};
use std::cell::RefCell;

/// How far off its contact a stretch is tested: a gap, relative to the size.
pub(crate) const HAIR: f64 = 1e-9;
/// Stretches shorter than this in both positions are dropped.
const SHORT: f64 = 1e-10;

/// A stretch of the boundary of free space, monotone in both positions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub element: u32,
    pub u: [f64; 2],
    pub v: [f64; 2],
    /// Free space lies above (towards greater v); for an upright piece, towards greater u.
    pub free_above: bool,
}

impl Piece {
    pub fn is_upright(&self) -> bool {
        self.u[0] == self.u[1]
    }
}

/// What tells free from blocked.
pub(crate) struct Judge<'a> {
    pub frame: &'a Frame,
    pub regions: &'a Regions,
    /// Greatest levers of both bodies, at least a bit of the size.
    pub levers: [f64; 2],
    met: RefCell<Met>,
}

impl<'a> Judge<'a> {
    pub fn new(frame: &'a Frame, regions: &'a Regions, levers: [f64; 2]) -> Self {
        Judge { frame, regions, levers, met: RefCell::default() }
    }

    /// Do the bodies overlap at this configuration?
    pub fn blocked(&self, u: f64, v: f64) -> bool {
        let (m, [au, av]) = (&self.frame.moving, &self.frame.axes);
        let poses = [m[0].place(au.wrap(u).0), m[1].place(av.wrap(v).0)];
        self.regions.overlap_again(&poses, &mut self.met.borrow_mut())
    }

    /// The side of an element on which it is free at a configuration on it; none if it is blocked.
    fn free_side(&self, catalogue: &Catalogue, element: &Element, u: f64, v: f64) -> Option<bool> {
        let eq = &catalogue.curves[element.pair as usize].eq;
        let g = eq.value(&self.frame.moving, u, v);
        let [l, k] = self.levers;
        let steepness = (g.fu / l).powi(2) + (g.fv / k).powi(2);
        let step = HAIR * self.frame.size / steepness;
        if !step.is_finite() {
            return None;
        }
        // No longer step than the element's own gap would allow at a dead point.
        let most = HAIR.sqrt() * self.frame.size / steepness.sqrt();
        let step = step.min(most);
        let (du, dv) = (step * g.fu / (l * l), step * g.fv / (k * k));
        let free = !self.blocked(u + du, v + dv);
        free.then_some(if element.is_upright() { g.fu > 0.0 } else { g.fv > 0.0 })
    }
}

/// All stretches that bound free space, by element and position, and how many were tested.
pub(crate) fn pieces(catalogue: &Catalogue, cuts: &mut Cuts, judge: &Judge) -> (Vec<Piece>, usize) {
    cuts.at.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let (mut found, mut tested, mut at) = (Vec::new(), 0, 0);
    let mut stops: Vec<f64> = Vec::new();
    for (k, element) in catalogue.elements.iter().enumerate() {
        let start = at;
        while at < cuts.at.len() && cuts.at[at].0 as usize == k {
            at += 1;
        }
        if !cuts.met.get(k).copied().unwrap_or(false) {
            continue;
        }
        let range = if element.is_upright() { element.v } else { element.u };
        stops.clear();
        stops.push(range[0]);
        stops.extend(cuts.at[start..at].iter().map(|c| c.1.clamp(range[0], range[1])));
        stops.push(range[1]);
        stops.dedup_by(|b, a| *b - *a <= 0.1 * SHORT);
        for w in stops.windows(2) {
            let piece = stretch(catalogue, judge.frame, k as u32, [w[0], w[1]]);
            let length = (piece.u[1] - piece.u[0]).abs().max((piece.v[1] - piece.v[0]).abs());
            if length <= SHORT {
                continue;
            }
            tested += 1;
            let (u, v) = middle(catalogue, judge.frame, &piece);
            if let Some(free_above) = judge.free_side(catalogue, element, u, v) {
                found.push(Piece { free_above, ..piece });
            }
        }
    }
    (found, tested)
}

fn stretch(catalogue: &Catalogue, frame: &Frame, k: u32, [a, b]: [f64; 2]) -> Piece {
    let element = &catalogue.elements[k as usize];
    if element.is_upright() {
        return Piece { element: k, u: element.u, v: [a, b], free_above: false };
    }
    let eq = &catalogue.curves[element.pair as usize].eq;
    let v =
        |u: f64, end: usize| if u == element.u[end] { element.v[end] } else { element.v_at(eq, frame, u) };
    Piece { element: k, u: [a, b], v: [v(a, 0), v(b, 1)], free_above: false }
}

/// The configuration half way along.
fn middle(catalogue: &Catalogue, frame: &Frame, piece: &Piece) -> (f64, f64) {
    let u = 0.5 * (piece.u[0] + piece.u[1]);
    if piece.is_upright() {
        return (u, 0.5 * (piece.v[0] + piece.v[1]));
    }
    let element = &catalogue.elements[piece.element as usize];
    (u, element.v_at(&catalogue.curves[element.pair as usize].eq, frame, u))
}

/// Ends of pieces with u within `WELD_U` and v within `WELD_V` are one vertex.
const WELD_U: f64 = 1e-9;
const WELD_V: f64 = 1e-7;

/// Gives ends that meet one and the same v. Near a fold v has only half the digits that u has; of the curves that meet
/// the flattest knows it best.
pub(crate) fn weld(catalogue: &Catalogue, frame: &Frame, pieces: &mut [Piece]) {
    let mut ends: Vec<(f64, f64, f64, u32, usize)> = Vec::new();
    for (i, p) in pieces.iter().enumerate() {
        let element = &catalogue.elements[p.element as usize];
        let eq = &catalogue.curves[element.pair as usize].eq;
        for end in 0..2 {
            let g = eq.value(&frame.moving, p.u[end], p.v[end]);
            let steepness = if p.is_upright() { f64::INFINITY } else { (g.fu / g.fv).abs() };
            ends.push((p.u[end], p.v[end], steepness, i as u32, end));
        }
    }
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.3.cmp(&b.3)));
    let mut done = vec![false; ends.len()];
    for i in 0..ends.len() {
        if done[i] {
            continue;
        }
        let near = |e: &(f64, f64, f64, u32, usize)| e.0 - ends[i].0 <= WELD_U;
        let group: Vec<usize> = (i..ends.len())
            .take_while(|&k| near(&ends[k]))
            .filter(|&k| !done[k] && (ends[k].1 - ends[i].1).abs() <= WELD_V)
            .collect();
        let flattest = group.iter().copied().min_by(|&a, &b| ends[a].2.total_cmp(&ends[b].2)).unwrap_or(i);
        for &k in &group {
            done[k] = true;
            pieces[ends[k].3 as usize].v[ends[k].4] = ends[flattest].1;
        }
    }
}
