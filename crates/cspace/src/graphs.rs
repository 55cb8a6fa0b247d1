//! Where two elements, both graphs v(u), cross or touch over a common range.
//!
//! The sign of φ = v_i − v_j at the ends tells; between equal signs a dip is looked for where dφ/du changes sign. Every loop
//! is bounded.

use crate::element::Element;
use crate::equation::Equation;
use crate::pairs::Catalogue;

/// Positions nearer than this count as equal (scaled positions).
pub(crate) const SAME: f64 = 1e-10;
/// How often a common range is halved: so many times two pieces are looked at one by one.
const HALVINGS: u32 = 2;

/// Two graphs over a common range.
pub(crate) struct Graphs<'a> {
    pub catalogue: &'a Catalogue<'a>,
    pub first: (&'a Element, &'a Equation),
    pub second: (&'a Element, &'a Equation),
}

impl Graphs<'_> {
    fn values(&self, u: f64) -> (f64, f64) {
        let frame = self.catalogue.frame;
        let pose = frame.moving[0].place(u);
        let value = |(element, eq): (&Element, &Equation)| element.v_with(eq, frame, &pose);
        (value(self.first), value(self.second))
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
        let pose = frame.moving[0].place(u);
        let slope = |eq: &Equation, v: f64| {
            let g = eq.value_at(&frame.moving, &[pose, frame.moving[1].place(v)]);
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

    /// Zeros of φ between two positions, with the values there.
    pub fn zeros(&self, ends: [(f64, (f64, f64)); 2], out: &mut Vec<f64>) {
        // Equal all along: the same curve twice, cut at both ends only.
        if self.halved(ends, HALVINGS, out) == 1 << HALVINGS {
            out.clear();
            out.extend(ends.map(|e| e.0));
        }
    }

    /// Zeros of φ between two positions, part by part. In how many parts are the graphs equal at the right end?
    fn halved(&self, [l, r]: [(f64, (f64, f64)); 2], halvings: u32, out: &mut Vec<f64>) -> usize {
        let ((ai, aj), (bi, bj)) = (l.1, r.1);
        if ai.min(bi) > aj.max(bj) + SAME || aj.min(bj) > ai.max(bi) + SAME {
            return 0;
        }
        if halvings == 0 {
            self.part(l, r, out);
            return usize::from((bi - bj).abs() <= SAME);
        }
        let middle = 0.5 * (l.0 + r.0);
        let m = (middle, self.values(middle));
        self.halved([l, m], halvings - 1, out) + self.halved([m, r], halvings - 1, out)
    }

    /// Zeros of φ in a part in which the ranges of both graphs overlap.
    fn part(&self, l: (f64, (f64, f64)), r: (f64, (f64, f64)), out: &mut Vec<f64>) {
        let ((ai, aj), (bi, bj)) = (l.1, r.1);
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
