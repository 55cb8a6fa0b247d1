//! Where elements cross, touch or meet: cuts.
//!
//! Within a box both elements are monotone graphs v(u), so boxes around them exclude most pairs. An end of one element on
//! the other is a cut as well: cuts that change nothing do no harm.

use crate::element::Element;
use crate::equation::Equation;
use crate::graphs::{Graphs, SAME};
use crate::pairs::{Catalogue, Cell};

/// Cuts of elements, and which elements were met in the search.
#[derive(Default)]
pub(crate) struct Cuts {
    /// (element, u), for upright elements (element, v).
    pub at: Vec<(u32, f64)>,
    pub met: Vec<bool>,
    portions: Vec<Portion>,
}

/// What of an element lies within a box: where it begins and ends.
#[derive(Clone, Copy)]
struct Portion {
    element: u32,
    u: [f64; 2],
    v: [f64; 2],
}

impl Portion {
    fn apart(&self, other: &Portion) -> bool {
        let range = |a: [f64; 2]| (a[0].min(a[1]), a[0].max(a[1]));
        ranges_apart((self.u[0], self.u[1]), (other.u[0], other.u[1]))
            || ranges_apart(range(self.v), range(other.v))
    }

    /// v at u if it is known.
    fn known(&self, u: f64) -> Option<f64> {
        (0..2).find(|&k| self.u[k] == u).map(|k| self.v[k])
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
                    self.pair(catalogue, first, second);
                }
            }
        }
    }

    fn pair(&mut self, catalogue: &Catalogue, first: Portion, second: Portion) {
        let (i, j) = (first.element, second.element);
        let (a, b) = (&catalogue.elements[i as usize], &catalogue.elements[j as usize]);
        let eq = |e: &Element| &catalogue.curves[e.pair as usize].eq;
        match (a.is_upright(), b.is_upright()) {
            (false, false) => {
                let (l, r) = (first.u[0].max(second.u[0]), first.u[1].min(second.u[1]));
                if l > r {
                    return;
                }
                let graphs = Graphs { catalogue, first: (a, eq(a)), second: (b, eq(b)) };
                let at = |p: &Portion, e: &Element, u| {
                    p.known(u).unwrap_or_else(|| e.v_at(eq(e), catalogue.frame, u))
                };
                let ends = [l, r].map(|u| (u, (at(&first, a, u), at(&second, b, u))));
                let mut found = Vec::new();
                graphs.zeros(ends, &mut found);
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
    passes.then_some(Portion { element: k, u: [a.0, b.0], v: [a.1, b.1] })
}
