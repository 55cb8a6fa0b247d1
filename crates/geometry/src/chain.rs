//! Chains boundary sub-edges to loops with material on the left.
//!
//! Where several loops meet at a vertex, a loop goes on along the edge that closes its own wedge of
//! material, so regions that only touch stay separate and no loop crosses itself.

use crate::classes::{Classes, Tolerance};
use crate::classify::BoundaryEdge;
use crate::{Curve, CurveId, OutlineError, Root, Segment, Turn, Vec2};
use std::f64::consts::{PI, TAU};

/// Tangents closer than this (radians) agree: the kink is too flat to be a contact feature.
const SMOOTH: f64 = 1e-7;

/// An edge between two corners, on one class.
#[derive(Clone, Debug)]
pub(crate) struct RawEdge {
    pub class: u32,
    pub forward: bool,
    /// `None` for a whole circle.
    pub start: Option<RawCorner>,
    /// An arc all the way round, back to the vertex where it starts.
    pub full_turn: bool,
    /// All curves that bound somewhere along it, ascending.
    pub curves: Vec<CurveId>,
}

/// The corner between the edge before and an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RawCorner {
    pub at: Vec2,
    /// Class of the edge before.
    pub before: u32,
    /// Which common point of the two classes, the lower class first.
    pub root: Root,
    pub turn: Turn,
}

/// What makes an edge the same in another slab.
pub(crate) type EdgeKey = (u32, bool, Option<(u32, Root)>);

impl RawEdge {
    pub fn key(&self) -> EdgeKey {
        (self.class, self.forward, self.start.map(|s| (s.before, s.root)))
    }
}

pub(crate) type RawLoop = Vec<RawEdge>;

/// The loops of a slab, each from its lowest edge on and in ascending order.
pub(crate) struct Chainer<'a> {
    pub vertices: &'a [Vec2],
    pub classes: &'a Classes,
    pub tolerance: &'a Tolerance,
}

/// A piece of a loop between vertices: an edge before its neighbours are known.
#[derive(Clone, Debug)]
struct Piece {
    class: u32,
    forward: bool,
    ends: [u32; 2],
    curves: Vec<CurveId>,
}

impl Chainer<'_> {
    pub fn loops(&self, edges: &[BoundaryEdge]) -> Result<Vec<RawLoop>, OutlineError> {
        let mut loops: Vec<RawLoop> = edges.iter().filter(|e| e.ends.is_none()).map(whole).collect();
        let pieces: Vec<Piece> = edges.iter().filter_map(Piece::of).collect();
        for chain in self.chains(&pieces)? {
            let joined = self.join(chain.iter().map(|&i| &pieces[i as usize]));
            let raw = self.with_corners(&joined);
            if self.is_real(&raw) {
                loops.push(raw);
            }
        }
        loops.sort_by(|a, b| a.iter().map(RawEdge::key).cmp(b.iter().map(RawEdge::key)));
        Ok(loops)
    }

    fn curve(&self, class: u32) -> &Curve {
        &self.classes.curves[class as usize]
    }

    /// Closed sequences of pieces.
    fn chains(&self, pieces: &[Piece]) -> Result<Vec<Vec<u32>>, OutlineError> {
        let next = self.successors(pieces)?;
        let mut used = vec![false; pieces.len()];
        let mut chains = Vec::new();
        for first in 0..pieces.len() as u32 {
            let mut chain = Vec::new();
            let mut at = first;
            while !used[at as usize] {
                used[at as usize] = true;
                chain.push(at);
                at = next[at as usize];
            }
            if at != first {
                return Err(OutlineError::Degenerate);
            }
            if !chain.is_empty() {
                chains.push(chain);
            }
        }
        Ok(chains)
    }

    /// The piece that follows each piece.
    fn successors(&self, pieces: &[Piece]) -> Result<Vec<u32>, OutlineError> {
        let sorted_by_end = |end: usize| {
            let mut list: Vec<u32> = (0..pieces.len() as u32).collect();
            list.sort_by_key(|&i| (pieces[i as usize].ends[end], i));
            list
        };
        let (starts, stops) = (sorted_by_end(0), sorted_by_end(1));
        let mut next = vec![0; pieces.len()];
        let mut from = 0;
        while from < starts.len() {
            let vertex = pieces[starts[from] as usize].ends[0];
            let here = |list: &[u32], end: usize| {
                list[from..].iter().take_while(|&&i| pieces[i as usize].ends[end] == vertex).count()
            };
            let count = here(&starts, 0);
            if here(&stops, 1) != count {
                return Err(OutlineError::Degenerate);
            }
            let range = from..from + count;
            self.pair(pieces, vertex, &stops[range.clone()], &starts[range], &mut next);
            from += count;
        }
        Ok(next)
    }

    /// Pairs each incoming piece with the outgoing one that closes its wedge of material.
    fn pair(&self, pieces: &[Piece], vertex: u32, incoming: &[u32], outgoing: &[u32], next: &mut [u32]) {
        if let ([i], [o]) = (incoming, outgoing) {
            next[*i as usize] = *o;
            return;
        }
        let all = incoming.iter().chain(outgoing);
        let reach = all.map(|&i| self.reach(&pieces[i as usize])).fold(f64::INFINITY, f64::min);
        let at = self.vertices[vertex as usize];
        let out: Vec<(f64, u32)> =
            outgoing.iter().map(|&o| (self.ray(&pieces[o as usize], at, true, 0.5 * reach), o)).collect();
        for &i in incoming {
            let back = self.ray(&pieces[i as usize], at, false, 0.5 * reach);
            let wedge = |angle: f64| (back - angle).rem_euclid(TAU);
            if let Some(best) = out.iter().min_by(|a, b| wedge(a.0).total_cmp(&wedge(b.0))) {
                next[i as usize] = best.1;
            }
        }
    }

    /// How far from its ends a piece surely gets.
    fn reach(&self, piece: &Piece) -> f64 {
        let [a, b] = piece.ends.map(|v| self.vertices[v as usize]);
        match *self.curve(piece.class) {
            Curve::Line { .. } => (b - a).norm(),
            Curve::Circle { radius, .. } => {
                let segment = self.segment(piece);
                2.0 * radius * (0.5 * segment.sweep().min(PI)).sin()
            }
        }
    }

    fn segment(&self, piece: &Piece) -> Segment {
        let [a, b] = piece.ends.map(|v| self.vertices[v as usize]);
        segment_on(self.curve(piece.class), piece.forward, a, b)
    }

    /// The direction (an angle) in which a piece lies at distance `reach` from its start or its end `at`.
    fn ray(&self, piece: &Piece, at: Vec2, start: bool, reach: f64) -> f64 {
        let curve = self.curve(piece.class);
        let along = piece.forward == start;
        let t = curve.tangent(at);
        let angle = if along { t.y.atan2(t.x) } else { (-t.y).atan2(-t.x) };
        match *curve {
            Curve::Line { .. } => angle,
            Curve::Circle { radius, .. } => {
                let bend = (0.5 * reach / radius).min(1.0).asin();
                if along { angle + bend } else { angle - bend }
            }
        }
    }

    /// Joins neighbours on the same class.
    fn join<'p>(&self, chain: impl Iterator<Item = &'p Piece>) -> Vec<Piece> {
        let mut joined: Vec<Piece> = Vec::new();
        for piece in chain {
            match joined.last_mut() {
                Some(last) if last.continues(piece) => last.append(piece),
                _ => joined.push(piece.clone()),
            }
        }
        if joined.len() > 1 && joined[joined.len() - 1].continues(&joined[0]) {
            let first = joined.remove(0);
            if let Some(last) = joined.last_mut() {
                last.append(&first);
            }
        }
        joined
    }

    fn with_corners(&self, pieces: &[Piece]) -> RawLoop {
        if let [only] = pieces {
            let Piece { class, forward, ref curves, .. } = *only;
            return vec![RawEdge { class, forward, start: None, full_turn: false, curves: curves.clone() }];
        }
        let corner = |i: usize| self.corner(&pieces[(i + pieces.len() - 1) % pieces.len()], &pieces[i]);
        let edge = |(i, p): (usize, &Piece)| RawEdge {
            class: p.class,
            forward: p.forward,
            start: Some(corner(i)),
            full_turn: p.ends[0] == p.ends[1],
            curves: p.curves.clone(),
        };
        let mut edges: RawLoop = pieces.iter().enumerate().map(edge).collect();
        let first = (0..edges.len()).min_by_key(|&i| edges[i].key()).unwrap_or(0);
        edges.rotate_left(first);
        edges
    }

    fn corner(&self, before: &Piece, after: &Piece) -> RawCorner {
        let at = self.vertices[after.ends[0] as usize];
        let (low, high) = (before.class.min(after.class), before.class.max(after.class));
        let (a, b) = (self.curve(low), self.curve(high));
        let root = a.root_at(b, at, a.touches(b, self.tolerance.length));
        RawCorner { at, before: before.class, root, turn: self.turn(before, after, at, root) }
    }

    fn turn(&self, before: &Piece, after: &Piece, at: Vec2, root: Root) -> Turn {
        let direction = |p: &Piece| {
            let t = self.curve(p.class).tangent(at);
            if p.forward { t } else { -t }
        };
        let (d, e) = (direction(before), direction(after));
        if root != Root::Tangent && d.cross(e).abs() > SMOOTH {
            return if d.cross(e) > 0.0 { Turn::Convex } else { Turn::Concave };
        }
        if d.dot(e) > 0.0 {
            return Turn::Smooth;
        }
        let reach = 0.5 * self.reach(before).min(self.reach(after));
        let wedge = self.ray(before, at, false, reach) - self.ray(after, at, true, reach);
        if wedge.rem_euclid(TAU) < PI { Turn::Convex } else { Turn::Concave }
    }

    /// Thicker than the tolerance?
    fn is_real(&self, raw: &RawLoop) -> bool {
        let segments: Vec<_> = (0..raw.len()).map(|i| raw_segment(raw, i, self.classes)).collect();
        let area: f64 = segments.iter().map(|s| s.area_about(self.tolerance.center)).sum();
        let length: f64 = segments.iter().map(Segment::length).sum();
        area.abs() > self.tolerance.length * length
    }
}

fn whole(edge: &BoundaryEdge) -> RawLoop {
    let BoundaryEdge { class, forward, ref curves, .. } = *edge;
    vec![RawEdge { class, forward, start: None, full_turn: false, curves: curves.clone() }]
}

/// The segment of a raw loop's edge, on the class's own curve.
fn raw_segment(raw: &RawLoop, i: usize, classes: &Classes) -> Segment {
    let at = |i: usize| raw[i % raw.len()].start.map_or(Vec2::new(0.0, 0.0), |s| s.at);
    let curve = &classes.curves[raw[i].class as usize];
    match (raw[i].start, *curve) {
        (None, Curve::Circle { center, radius }) => {
            Segment::Circle { center, radius, convex: raw[i].forward }
        }
        _ => segment_on(curve, raw[i].forward, at(i), at(i + 1)),
    }
}

/// The segment of a curve between two of its points, in the curve's own direction or against it.
pub(crate) fn segment_on<S: crate::Scalar>(
    curve: &Curve<S>,
    forward: bool,
    from: Vec2<S>,
    to: Vec2<S>,
) -> Segment<S> {
    match *curve {
        Curve::Line { .. } => Segment::Line { from, to },
        Curve::Circle { center, radius } => Segment::Arc { from, to, center, radius, convex: forward },
    }
}

impl Piece {
    fn of(edge: &BoundaryEdge) -> Option<Self> {
        let BoundaryEdge { class, forward, ends, ref curves } = *edge;
        Some(Self { class, forward, ends: ends?, curves: curves.clone() })
    }

    fn continues(&self, next: &Self) -> bool {
        self.class == next.class && self.forward == next.forward && self.ends[1] == next.ends[0]
    }

    fn append(&mut self, next: &Self) {
        self.ends[1] = next.ends[1];
        self.curves.extend(&next.curves);
        self.curves.sort_unstable();
        self.curves.dedup();
    }
}
