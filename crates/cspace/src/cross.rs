//! Where elements cross, touch or meet: cuts.
//!
//! Within a box both elements are monotone graphs v(u), so boxes around them exclude most pairs. Otherwise the sign of
//! φ = v_i − v_j at the ends tells; between equal signs a dip is looked for where dφ/du changes sign. Every loop is
//! bounded. An end of one element on the other is a cut as well: cuts that change nothing do no harm.

use crate::element::Element;
use crate::equation::Equation;
use crate::pairs::{Catalogue, Cell};

/// Positions nearer than this count as equal (scaled positions).
const SAME: f64 = 1e-10;
/// Pieces of a common range that are looked at one by one.
const PARTS: usize = 4;

/// Cuts of elements, and which elements were met in the search.
#[derive(Default)]
pub(crate) struct Cuts {
    /// (element, u), for upright elements (element, v).
    pub at: Vec<(u32, f64)>,
    pub met: Vec<bool>,
    portions: Vec<Portion>,
}

/// What of an element lies within a box, in a box of its own.
#[derive(Clone, Copy)]
struct Portion {
    element: u32,
    u: [f64; 2],
    v: [f64; 2],
}

impl Portion {
    fn apart(&self, other: &Portion) -> bool {
        let apart = |a: [f64; 2], b: [f64; 2]| a[0] > b[1] + SAME || b[0] > a[1] + SAME;
        apart(self.u, other.u) || apart(self.v, other.v)
    }
}

/// Two graphs over a common range.
struct Graphs<'a> {
    catalogue: &'a Catalogue<'a>,
    first: (&'a Element, &'a Equation),
    second: (&'a Element, &'a Equation),
}

impl Graphs<'_> {
    fn values(&self, u: f64) -> (f64, f64) {
        let frame = self.catalogue.frame;
        (self.first.0.v_at(self.first.1, frame, u), self.second.0.v_at(self.second.1, frame, u))
    }

    fn difference(&self, u: f64) -> f64 {
        let (a, b) = self.values(u);
        a - b
    }

    /// dφ/du.
    fn slope(&self, u: f64) -> f64 {
        self.slope_at(u, self.values(u))
    }

    /// dφ/du where both values are known.
    fn slope_at(&self, u: f64, (first, second): (f64, f64)) -> f64 {
        let frame = self.catalogue.frame;
        let slope = |eq: &Equation, v: f64| {
            let g = eq.value(&frame.moving, u, v);
            -g.fu / g.fv
        };
        let d = slope(self.first.1, first) - slope(self.second.1, second);
        if d.is_nan() { 0.0 } else { d }
    }

    /// A little inside the range where folds may end it: there slopes are infinite.
    fn slope_within(&self, (u, values): (f64, (f64, f64)), inner: f64) -> (f64, f64) {
        let ends = |e: &Element| u == e.u[0] || u == e.u[1];
        if ends(self.first.0) || ends(self.second.0) {
            (u + inner, self.slope(u + inner))
        } else {
            (u, self.slope_at(u, values))
        }
    }

    /// The zero of `f` between a and b, where it has opposite signs: inverse quadratic interpolation where that is safe, else
    /// bisection (Chandrupatla 1997).
    fn zero(&self, f: impl Fn(f64) -> f64, (mut a, mut fa): (f64, f64), (mut b, mut fb): (f64, f64)) -> f64 {
        let mut part = 0.5;
        for _ in 0..120 {
            let (u, width) = (a + part * (b - a), (b - a).abs());
            let fu = f(u);
            // What the new value replaces is kept for the interpolation.
            let (c, fc) = if (fu > 0.0) == (fa > 0.0) { (a, fa) } else { (b, fb) };
            if (fu > 0.0) != (fa > 0.0) {
                (b, fb) = (a, fa);
            }
            (a, fa) = (u, fu);
            let little = 2e-16 * (1.0 + a.abs());
            if fu == 0.0 || (b - a).abs() <= 2.0 * little || (b - a).abs() == width {
                break;
            }
            let (x, y) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
            let safe = y * y < x && (1.0 - y) * (1.0 - y) < 1.0 - x;
            part = if safe {
                fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            } else {
                0.5
            };
            let least = (little / (b - a).abs()).min(0.5);
            part = part.clamp(least, 1.0 - least);
        }
        if fa.abs() <= fb.abs() { a } else { b }
    }

    /// Zeros of φ in [l, r].
    fn zeros(&self, l: f64, r: f64, out: &mut Vec<f64>) {
        let at = |k: usize| if k == PARTS { r } else { l + (r - l) * k as f64 / PARTS as f64 };
        let mut left = (l, self.values(l));
        let mut near = 0;
        for k in 1..=PARTS {
            let right = (at(k), self.values(at(k)));
            near += usize::from((right.1.0 - right.1.1).abs() <= SAME);
            self.part(left, right, out);
            left = right;
        }
        // Equal all along: the same curve twice, cut at both ends only.
        if near == PARTS {
            out.clear();
            out.extend([l, r]);
        }
    }

    fn part(&self, l: (f64, (f64, f64)), r: (f64, (f64, f64)), out: &mut Vec<f64>) {
        let ((ai, aj), (bi, bj)) = (l.1, r.1);
        let apart = ai.min(bi) > aj.max(bj) + SAME || aj.min(bj) > ai.max(bi) + SAME;
        if apart {
            return;
        }
        let (fl, fr) = (ai - aj, bi - bj);
        for (u, f) in [(l.0, fl), (r.0, fr)] {
            if f.abs() <= SAME {
                out.push(u);
            }
        }
        if (fl > 0.0) != (fr > 0.0) {
            out.push(self.zero(|u| self.difference(u), (l.0, fl), (r.0, fr)));
            return;
        }
        // Equal signs: a dip to zero between has two zeros, or one if they only touch.
        let inner = 1e-9 * (r.0 - l.0);
        let ((a, da), (b, db)) = (self.slope_within(l, inner), self.slope_within(r, -inner));
        let dips = if fl > 0.0 { da < 0.0 && db > 0.0 } else { da > 0.0 && db < 0.0 };
        if !dips {
            return;
        }
        let deepest = self.zero(|u| self.slope(u), (a, da), (b, db));
        let fd = self.difference(deepest);
        if fd.abs() <= SAME {
            out.push(deepest);
        }
        if (fd > 0.0) != (fl > 0.0) {
            out.push(self.zero(|u| self.difference(u), (l.0, fl), (deepest, fd)));
            out.push(self.zero(|u| self.difference(u), (deepest, fd), (r.0, fr)));
        }
    }
}

impl Cuts {
    /// Cuts the elements of the given pairs of tree nodes (leaves) against each other within a box.
    pub fn cut(&mut self, catalogue: &mut Catalogue, front: &[(u32, u32)], cell: &Cell) {
        self.portions.clear();
        let ((ul, ur), (vl, vr)) = (cell.range(0), cell.range(1));
        for &(i, j) in front {
            let parts =
                (catalogue.trees[0].nodes[i as usize].link, catalogue.trees[1].nodes[j as usize].link);
            let Some(curves) = catalogue.curves_of(parts.0, parts.1) else { continue };
            let (start, end) = catalogue.curves[curves as usize].elements;
            for k in start..end {
                let element = &catalogue.elements[k as usize];
                let (low, high) = element.v_range();
                let overlaps = element.u[0] <= ur + SAME
                    && element.u[1] >= ul - SAME
                    && low <= vr + SAME
                    && high >= vl - SAME;
                if overlaps {
                    self.portions.extend(portion(catalogue, k, cell));
                }
            }
        }
        self.met.resize(catalogue.elements.len(), false);
        for a in 0..self.portions.len() {
            let first = self.portions[a];
            self.met[first.element as usize] = true;
            for b in a + 1..self.portions.len() {
                let second = self.portions[b];
                if !first.apart(&second) {
                    self.pair(catalogue, first.element, second.element, cell);
                }
            }
        }
    }

    fn pair(&mut self, catalogue: &Catalogue, i: u32, j: u32, cell: &Cell) {
        let (a, b) = (&catalogue.elements[i as usize], &catalogue.elements[j as usize]);
        let eq = |e: &Element| &catalogue.curves[e.pair as usize].eq;
        match (a.is_upright(), b.is_upright()) {
            (false, false) => {
                let (ul, ur) = cell.range(0);
                let l = a.u[0].max(b.u[0]).max(ul - SAME);
                let r = a.u[1].min(b.u[1]).min(ur + SAME);
                if l > r || ranges_apart(a.v_range(), b.v_range()) {
                    return;
                }
                let graphs = Graphs { catalogue, first: (a, eq(a)), second: (b, eq(b)) };
                let mut found = Vec::new();
                graphs.zeros(l, r, &mut found);
                self.at.extend(found.iter().flat_map(|&u| [(i, u), (j, u)]));
            }
            (true, true) => {
                if (a.u[0] - b.u[0]).abs() <= SAME && !ranges_apart(a.v_range(), b.v_range()) {
                    self.at.extend([(i, b.v[0]), (i, b.v[1]), (j, a.v[0]), (j, a.v[1])]);
                }
            }
            (true, false) => self.upright(catalogue, (i, a), (j, b, eq(b))),
            (false, true) => self.upright(catalogue, (j, b), (i, a, eq(a))),
        }
    }

    fn upright(&mut self, catalogue: &Catalogue, up: (u32, &Element), graph: (u32, &Element, &Equation)) {
        let u = up.1.u[0];
        if u < graph.1.u[0] - SAME || u > graph.1.u[1] + SAME {
            return;
        }
        let u = u.clamp(graph.1.u[0], graph.1.u[1]);
        let v = graph.1.v_at(graph.2, catalogue.frame, u);
        let (low, high) = up.1.v_range();
        if v >= low - SAME && v <= high + SAME {
            self.at.extend([(up.0, v), (graph.0, u)]);
        }
    }
}

fn ranges_apart(a: (f64, f64), b: (f64, f64)) -> bool {
    a.0 > b.1 + SAME || b.0 > a.1 + SAME
}

/// What of the element passes the box, if any does. Monotone: its values at the ends of the common range tell.
fn portion(catalogue: &Catalogue, k: u32, cell: &Cell) -> Option<Portion> {
    let element = &catalogue.elements[k as usize];
    if element.is_upright() {
        return Some(Portion { element: k, u: element.u, v: element.v });
    }
    let ((ul, ur), (vl, vr)) = (cell.range(0), cell.range(1));
    let eq = &catalogue.curves[element.pair as usize].eq;
    let value = |u: f64, end: usize, inside: bool| {
        if inside { (u, element.v_at(eq, catalogue.frame, u)) } else { (element.u[end], element.v[end]) }
    };
    // A little wider than the box, as far as crossings are looked for.
    let a = value(ul - SAME, 0, element.u[0] < ul - SAME);
    let b = value(ur + SAME, 1, element.u[1] > ur + SAME);
    let (low, high) = (a.1.min(b.1), a.1.max(b.1));
    let passes = low <= vr + SAME && high >= vl - SAME;
    passes.then_some(Portion { element: k, u: [a.0, b.0], v: [low, high] })
}
