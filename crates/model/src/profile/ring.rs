//! A loop at given values: its written edges, repeated, rounded, and turned so that the material lies to the left.
//!
//! An arc from a to b of radius r has its centre at (a + b)/2 ± √((r − c)(r + c)) n, c half the chord and n its unit
//! normal to the left; + if it turns left by less than half a turn, or right by more.

use super::draw::{DrawnEdge, Pose, SAME, point, real};
use super::fillet::{Corner, fillet, within};
use super::{EdgeKind, EdgeText, LoopShape, LoopText, Point, Repeat};
use crate::angle::{quotient, root};
use crate::error::{Fault, Read, number};
use crate::expression::Expression;
use crate::limits::PRIMITIVES;
use mainspring_geometry::{Scalar, Segment, Vec2};

/// An edge before corners are rounded.
#[derive(Clone, Copy)]
pub(super) struct RawEdge<S> {
    pub from: Vec2<S>,
    pub to: Vec2<S>,
    /// Centre, radius, and whether it turns left.
    pub arc: Option<(Vec2<S>, S, bool)>,
    pub fillet: Option<S>,
    pub text: usize,
    pub piece: u32,
}

impl<S: Scalar> RawEdge<S> {
    pub fn segment(&self) -> Segment<S> {
        let (from, to) = (self.from, self.to);
        match self.arc {
            None => Segment::Line { from, to },
            Some((center, radius, left)) => Segment::Arc { from, to, center, radius, convex: left },
        }
    }
}

/// A whole number of copies.
fn count<S: Scalar>(count: &Expression, values: &[S], what: &str) -> Read<u32> {
    let n = count.evaluate(values)?.re();
    if n.fract() != 0.0 || !(1.0..=PRIMITIVES as f64).contains(&n) {
        let message = format!("{what} is {}; expected a whole number from 1 to {PRIMITIVES}", number(n));
        return Err(Fault::new(count.place, message));
    }
    Ok(n as u32)
}

/// A loop being evaluated.
pub(super) struct Loop<'a, S> {
    pub part: &'a str,
    pub text: &'a LoopText,
    pub values: &'a [S],
}

impl<S: Scalar> Loop<'_, S> {
    pub fn fault(&self, edge: Option<usize>, what: &str) -> Box<Fault> {
        let at = match (edge, &self.text.shape) {
            (Some(i), LoopShape::Path { edges, .. }) => edges.get(i).map(|e| (i, e)),
            _ => None,
        };
        let (part, name) = (self.part, &self.text.name);
        match at {
            Some((i, e)) => {
                Fault::new(e.place, format!("part {part}, {name}, segment {} ({}): {what}", i + 1, e.word()))
            }
            None => Fault::new(self.text.place, format!("part {part}, {name}: {what}")),
        }
    }

    pub fn copies(&self, repeat: Option<&Repeat>) -> Read<Vec<Pose<S>>> {
        let Some(repeat) = repeat else { return Ok(self.turns(1, None)) };
        let n = count(&repeat.count, self.values, "the number of copies")?;
        let about = repeat.about.as_ref().map(|p| point(p, self.values)).transpose()?;
        Ok(self.turns(n, about))
    }

    fn turns(&self, n: u32, about: Option<Vec2<S>>) -> Vec<Pose<S>> {
        let o = Vec2::new(S::constant(0.0), S::constant(0.0));
        let about = about.unwrap_or(o);
        (0..n).map(|k| Pose::about(about, 360.0 * f64::from(k) / f64::from(n))).collect()
    }

    pub fn ring(&self) -> Read<Vec<DrawnEdge<S>>> {
        match &self.text.shape {
            LoopShape::Circle { center, radius } => {
                let r = radius.evaluate(self.values)?;
                if r.re() <= 0.0 {
                    let what = format!("the radius is {}; expected a positive number", number(r.re()));
                    return Err(Fault::new(radius.place, self.fault(None, &what).message));
                }
                let center = point(center, self.values)?;
                let segment = Segment::Circle { center, radius: r, convex: !self.text.hole };
                Ok(vec![DrawnEdge { segment, text: 0, piece: 0, fillet: false }])
            }
            LoopShape::Path { from, from_fillet, edges, repeat } => {
                let raw = self.pieces(from, from_fillet.as_ref(), edges, repeat.as_ref())?;
                let rounded = self.rounded(&raw)?;
                self.oriented(rounded)
            }
        }
    }

    /// The written edges, all pieces of them; the last one ends where the first begins.
    fn pieces(
        &self,
        from: &Point,
        from_fillet: Option<&Expression>,
        edges: &[EdgeText],
        repeat: Option<&Repeat>,
    ) -> Read<Vec<RawEdge<S>>> {
        let start = point(from, self.values)?;
        let mut at = start;
        let mut one = Vec::with_capacity(edges.len());
        for (i, text) in edges.iter().enumerate() {
            let to = text.to.as_ref().map(|p| point(p, self.values)).transpose()?.unwrap_or(start);
            one.push(self.raw(i, text, at, to)?);
            at = to;
        }
        let fillet = from_fillet.map(|f| f.evaluate(self.values)).transpose()?;
        let last = one.len() - 1;
        one[last].fillet = one[last].fillet.or(fillet);
        let turns = self.piece_turns(&one, at, repeat)?;
        let mut all: Vec<RawEdge<S>> = Vec::with_capacity(one.len() * turns.len());
        for (piece, turn) in (0u32..).zip(&turns) {
            all.extend(one.iter().map(|e| RawEdge {
                from: turn.apply(e.from),
                to: turn.apply(e.to),
                arc: e.arc.map(|(c, r, left)| (turn.apply(c), r, left)),
                piece,
                ..*e
            }));
        }
        for i in 0..all.len() {
            all[i].to = all[(i + 1) % all.len()].from;
        }
        Ok(all)
    }

    /// How the pieces are turned, in the order in which they follow each other: the piece ends at `end`, where the next
    /// begins.
    fn piece_turns(&self, one: &[RawEdge<S>], end: Vec2<S>, repeat: Option<&Repeat>) -> Read<Vec<Pose<S>>> {
        let n = repeat.map(|r| count(&r.count, self.values, "repeat")).transpose()?.unwrap_or(1);
        if one.len() * n as usize > PRIMITIVES {
            let what = format!("{} edges; expected at most {PRIMITIVES}", one.len() * n as usize);
            return Err(self.fault(None, &what));
        }
        let start = one[0].from;
        let about = repeat.and_then(|r| r.about.as_ref()).map(|p| point(p, self.values)).transpose()?;
        let mut turns = self.turns(n, about);
        let size = one.iter().map(|e| (e.from.re() - start.re()).norm()).fold(0.0, f64::max);
        let reach = about.unwrap_or(start * S::constant(0.0)).re() - start.re();
        let size = if n > 1 { size.max(reach.norm()) } else { size };
        let next = |turn: Option<&Pose<S>>| turn.map_or(start, |t| t.apply(start)).re();
        let gap = |turn: Option<&Pose<S>>| (next(turn) - end.re()).norm();
        if n > 1 && gap(turns.get(1)) > gap(turns.last()) {
            turns[1..].reverse();
        }
        let left = gap(turns.get(1));
        if left.is_nan() || left > SAME * size {
            return Err(self.open(n, end.re(), next(turns.get(1))));
        }
        Ok(turns)
    }

    fn open(&self, n: u32, end: Vec2, start: Vec2) -> Box<Fault> {
        let at = |p: Vec2| format!("({}, {})", number(p.x), number(p.y));
        let what = if n > 1 {
            let start = at(start);
            format!("the piece ends at {} and the next of {n} begins at {start}; expected one point", at(end))
        } else {
            format!(
                "the loop is open: it ends at {} and begins at {}; expected a closed loop (`close = true`)",
                at(end),
                at(start)
            )
        };
        self.fault(None, &what)
    }

    fn raw(&self, i: usize, text: &EdgeText, from: Vec2<S>, to: Vec2<S>) -> Read<RawEdge<S>> {
        let chord = (to.re() - from.re()).norm();
        if chord.is_nan() || chord == 0.0 {
            let what = "it ends where it starts; expected two points apart (a whole circle is `circle`)";
            return Err(self.fault(Some(i), what));
        }
        let arc = match &text.kind {
            EdgeKind::Line => None,
            EdgeKind::Radius { radius, left, large } => {
                let r = radius.evaluate(self.values)?;
                Some((self.center(i, from, to, r, *left != *large)?, r, *left))
            }
            EdgeKind::Center { center, left } => {
                let c = point(center, self.values)?;
                Some((c, self.radius(i, from, to, c)?, *left))
            }
        };
        let fillet = text.fillet.as_ref().map(|f| f.evaluate(self.values)).transpose()?;
        Ok(RawEdge { from, to, arc, fillet, text: i, piece: 0 })
    }

    /// The centre left or right of the way from one end to the other.
    fn center(&self, i: usize, from: Vec2<S>, to: Vec2<S>, r: S, left: bool) -> Read<Vec2<S>> {
        let d = to - from;
        let chord = root(d.dot(d));
        let half = chord * 0.5;
        let slack = (r.re() - half.re()) / half.re();
        if r.re() <= 0.0 || slack < -SAME {
            let what = format!(
                "the radius {} does not reach: its ends are {} apart; expected a radius of at least {}",
                number(r.re()),
                number(chord.re()),
                number(half.re())
            );
            return Err(self.fault(Some(i), &what));
        }
        let square = (r - half) * (r + half);
        let away = if square.re() > 0.0 { root(square) } else { S::constant(0.0) };
        let normal = d.perp() * quotient(away, chord);
        let middle = (from + to) * S::constant(0.5);
        Ok(if left { middle + normal } else { middle - normal })
    }

    /// The distance of both ends from the centre.
    fn radius(&self, i: usize, from: Vec2<S>, to: Vec2<S>, c: Vec2<S>) -> Read<S> {
        let (a, b) = (from - c, to - c);
        let r = root(a.dot(a));
        let [r0, r1] = [r.re(), b.re().norm()];
        if r0 == 0.0 || (r0 - r1).abs() > SAME * r0.max(r1) {
            let what = format!(
                "its ends are {} and {} from its centre; expected the same distance",
                number(r0),
                number(r1)
            );
            return Err(self.fault(Some(i), &what));
        }
        Ok(r)
    }

    /// Corners with a fillet become arcs.
    fn rounded(&self, raw: &[RawEdge<S>]) -> Read<Vec<DrawnEdge<S>>> {
        let n = raw.len();
        let mut corners: Vec<Option<Corner<S>>> = Vec::with_capacity(n);
        for i in 0..n {
            let Some(f) = raw[i].fillet.filter(|f| f.re() != 0.0) else {
                corners.push(None);
                continue;
            };
            let corner = if f.re() > 0.0 { fillet(&raw[i], &raw[(i + 1) % n], f) } else { None };
            let Some(corner) = corner else {
                let what = format!(
                    "a fillet of radius {} at its end does not fit; expected a smaller one, at a corner",
                    number(f.re())
                );
                return Err(self.fault(Some(raw[i].text), &what));
            };
            corners.push(Some(corner));
        }
        let mut edges = Vec::with_capacity(n);
        for i in 0..n {
            let (before, after) = (&corners[(i + n - 1) % n], &corners[i]);
            let mut edge = raw[i];
            edge.from = before.as_ref().map_or(edge.from, |c| c.end);
            edge.to = after.as_ref().map_or(edge.to, |c| c.start);
            if !within(&raw[i], &edge) {
                let what = "its fillets take more than its length; expected smaller ones";
                return Err(self.fault(Some(edge.text), what));
            }
            let of = |segment, fillet| DrawnEdge { segment, text: edge.text, piece: edge.piece, fillet };
            edges.push(of(edge.segment(), false));
            edges.extend(after.as_ref().map(|c| of(c.segment(), true)));
        }
        Ok(edges)
    }

    /// Turned round if the material would lie on the right.
    fn oriented(&self, mut edges: Vec<DrawnEdge<S>>) -> Read<Vec<DrawnEdge<S>>> {
        let origin = edges[0].segment.start().re();
        let area: f64 = edges.iter().map(|e| real(&e.segment).area_about(origin)).sum();
        if area == 0.0 || !area.is_finite() {
            return Err(self.fault(None, "it encloses nothing; expected a loop around an area"));
        }
        if (area > 0.0) == self.text.hole {
            edges.reverse();
            edges.iter_mut().for_each(|e| e.segment = turned_round(&e.segment));
        }
        Ok(edges)
    }
}

fn turned_round<S: Scalar>(segment: &Segment<S>) -> Segment<S> {
    match *segment {
        Segment::Line { from, to } => Segment::Line { from: to, to: from },
        Segment::Arc { from, to, center, radius, convex } => {
            Segment::Arc { from: to, to: from, center, radius, convex: !convex }
        }
        circle => circle,
    }
}
