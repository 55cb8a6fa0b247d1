//! Elements: stretches of trimmed contact curves on which v is a monotone function of u, or u is constant.

use crate::domain::Axis;
use crate::equation::Equation;
use crate::limits;
use crate::moving::{Moving, Roots};
use mainspring_mechanism::Pose;
use std::f64::consts::PI;

/// Least width of an element (scaled position): narrower ones lie within rounding of a critical position.
const LEAST: f64 = 1e-11;
/// A contact lies on its features when its margin is above minus this.
const MARGIN: f64 = 1e-9;

/// A stretch of a contact curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Element {
    /// Index of the feature pair.
    pub pair: u32,
    /// ±1: which root; 0: u is constant ("upright").
    pub branch: f64,
    pub u: [f64; 2],
    /// v at both ends; monotone between. For an upright element increasing.
    pub v: [f64; 2],
}

/// What curves are made for: the bodies, the domain, the unit of length.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub moving: [Moving; 2],
    pub axes: [Axis; 2],
    pub size: f64,
}

impl Element {
    pub fn is_upright(&self) -> bool {
        self.branch == 0.0
    }

    pub fn v_range(&self) -> (f64, f64) {
        (self.v[0].min(self.v[1]), self.v[0].max(self.v[1]))
    }

    /// v at u; for an upright element not defined.
    pub fn v_at(&self, eq: &Equation, frame: &Frame, u: f64) -> f64 {
        self.v_with(eq, frame, &frame.moving[0].place(u))
    }

    /// The same where the first body's pose is known.
    pub fn v_with(&self, eq: &Equation, frame: &Frame, pose: &Pose) -> f64 {
        let middle = 0.5 * (self.v[0] + self.v[1]);
        let (low, high) = self.v_range();
        let v = frame.axes[1].nearest(eq.root_v(&frame.moving, pose, self.branch), middle);
        // Without a root (a body on its own axis) the ends agree to rounding.
        if v.is_finite() { v.clamp(low, high) } else { middle }
    }
}

/// Work space for critical positions.
#[derive(Default)]
pub(crate) struct Scratch {
    raw: Vec<f64>,
    critical: Vec<f64>,
    folds: Vec<f64>,
}

/// All elements of a feature pair within the domain, by u.
pub(crate) fn elements(
    pair: u32,
    eq: &Equation,
    frame: &Frame,
    scratch: &mut Scratch,
    out: &mut Vec<Element>,
) {
    if eq.is_upright(&frame.moving, 1e-10 * frame.size) {
        upright(pair, eq, frame, scratch, out);
        return;
    }
    let (m, [au, av]) = (&frame.moving, &frame.axes);
    scratch.raw.clear();
    limits::folds(eq, m, &mut scratch.raw);
    scratch.folds.clear();
    scratch.folds.extend(scratch.raw.iter().filter_map(|&u| au.place(u, 0.0)));
    limits::ends(eq, m, &mut scratch.raw);
    limits::level(eq, m, av.start, &mut scratch.raw);
    limits::level(eq, m, av.end(), &mut scratch.raw);
    limits::extremes(eq, m, &mut scratch.raw);
    scratch.sort(au);
    for k in 1..scratch.critical.len() {
        let (a, b) = (scratch.critical[k - 1], scratch.critical[k]);
        if b - a < LEAST {
            continue;
        }
        let middle = 0.5 * (a + b);
        let roots = eq.solve_v(m, middle);
        for branch in branches(&roots) {
            let Some(v) = av.place(roots.root(branch), 0.0) else { continue };
            let poses = [m[0].place(middle), m[1].place(v)];
            if eq.margin(&poses, frame.size) >= -MARGIN {
                graph(&Graph { pair, eq, frame, branch, folds: &scratch.folds }, [a, b], v, out, 4);
            }
        }
    }
    flush(pair, eq, frame, scratch, out);
}

fn branches(roots: &Roots) -> impl Iterator<Item = f64> + use<> {
    let count = if !roots.reach {
        0
    } else if roots.single {
        1
    } else {
        2
    };
    [1.0, -1.0].into_iter().take(count)
}

impl Scratch {
    /// Critical positions within the domain, its limits included, in order and without repetition.
    fn sort(&mut self, axis: &Axis) {
        self.critical.clear();
        self.critical.extend([axis.start, axis.end()]);
        let placed = self.raw.iter().filter_map(|&u| axis.place(u, 0.0));
        self.critical.extend(placed.filter(|u| u.is_finite()));
        self.critical.sort_by(f64::total_cmp);
        self.critical.dedup_by(|b, a| *b - *a < LEAST);
    }
}

/// The curve of which stretches are made.
struct Graph<'a> {
    pair: u32,
    eq: &'a Equation,
    frame: &'a Frame,
    branch: f64,
    folds: &'a [f64],
}

impl Graph<'_> {
    /// Follows v from the middle to another position; counted on through whole turns.
    fn follow(&self, from: f64, v: f64, to: f64) -> f64 {
        let axis = &self.frame.axes[1];
        if !axis.turns {
            return v;
        }
        [0.6, 0.95].into_iter().fold(v, |v, part| {
            let roots = self.eq.solve_v(&self.frame.moving, from + part * (to - from));
            axis.nearest(roots.root(self.branch), v)
        })
    }

    /// v at an end, where `near` is v close by and `within` a position inside. At a fold the two roots are one; found as two they would have half the
    /// digits.
    fn end(&self, u: f64, near: f64, within: f64) -> f64 {
        let axis = &self.frame.axes[1];
        let roots = self.eq.solve_v(&self.frame.moving, u);
        let at_fold = !roots.single && self.folds.iter().any(|f| (f - u).abs() <= LEAST);
        let beyond = axis.turns && roots.delta > 0.5 * PI;
        let v = match (at_fold, beyond) {
            (true, false) => roots.base,
            (true, true) => roots.base + PI,
            _ => roots.root(self.branch),
        };
        let v = axis.nearest(if v.is_finite() { v } else { self.limit(u, within) }, near);
        (if v.is_finite() { v } else { near }).clamp(axis.start, axis.end())
    }

    /// The limit of v at u where the equation holds for every v, by a parabola through three positions inside.
    fn limit(&self, u: f64, within: f64) -> f64 {
        let h = (1e-4 * (within - u).signum()).clamp(-0.1 * (within - u).abs(), 0.1 * (within - u).abs());
        let v = |k: f64| self.eq.solve_v(&self.frame.moving, u + k * h).root(self.branch);
        3.0 * v(1.0) - 3.0 * v(2.0) + v(3.0)
    }
}

/// Adds one stretch, of which v in the middle is known; wide ones in halves, so that which turn v belongs to is never in
/// doubt.
fn graph(g: &Graph, [a, b]: [f64; 2], v: f64, out: &mut Vec<Element>, halvings: u32) {
    let middle = 0.5 * (a + b);
    let [va, vb] = [a, b].map(|u| g.end(u, g.follow(middle, v, u), middle));
    if (va - vb).abs() > 3.0 && g.frame.axes[1].turns && halvings > 0 {
        for part in [[a, middle], [middle, b]] {
            let inner = 0.5 * (part[0] + part[1]);
            let there = g.frame.axes[1]
                .nearest(g.eq.solve_v(&g.frame.moving, inner).root(g.branch), g.follow(middle, v, inner));
            graph(g, part, there, out, halvings - 1);
        }
        return;
    }
    out.push(Element { pair: g.pair, branch: g.branch, u: [a, b], v: [va, vb] });
}

/// An equation that never depends on v.
fn upright(pair: u32, eq: &Equation, frame: &Frame, scratch: &mut Scratch, out: &mut Vec<Element>) {
    let mut positions = Vec::new();
    limits::level(eq, &frame.moving, frame.axes[1].start, &mut positions);
    positions.sort_by(f64::total_cmp);
    positions.dedup_by(|b, a| *b - *a < LEAST);
    for u in positions {
        upright_at(pair, eq, frame, u, scratch, out);
    }
}

/// Positions u at which an equation that depends on v elsewhere holds for every v: a part turns flush with the slide of the
/// other.
fn flush(pair: u32, eq: &Equation, frame: &Frame, scratch: &mut Scratch, out: &mut Vec<Element>) {
    let axis = &frame.axes[1];
    let holds = |u: f64| {
        let at = |part: f64| eq.value(&frame.moving, u, axis.start + part * axis.length).f.abs();
        [0.0, 0.37, 0.71].into_iter().all(|part| at(part) <= 1e-11 * frame.size)
    };
    let folds: Vec<f64> = scratch.folds.iter().copied().filter(|&u| holds(u)).collect();
    for (i, &u) in folds.iter().enumerate() {
        if folds[..i].iter().all(|f| (f - u).abs() > LEAST) {
            upright_at(pair, eq, frame, u, scratch, out);
        }
    }
}

fn upright_at(
    pair: u32,
    eq: &Equation,
    frame: &Frame,
    u: f64,
    scratch: &mut Scratch,
    out: &mut Vec<Element>,
) {
    let (m, [au, av]) = (&frame.moving, &frame.axes);
    let Some(u) = au.place(u, 0.0) else { return };
    scratch.raw.clear();
    limits::upright_ends(eq, m, u, &mut scratch.raw);
    scratch.sort(av);
    for k in 1..scratch.critical.len() {
        let (a, b) = (scratch.critical[k - 1], scratch.critical[k]);
        let poses = [m[0].place(u), m[1].place(0.5 * (a + b))];
        if b - a >= LEAST && eq.margin(&poses, frame.size) >= -MARGIN {
            out.push(Element { pair, branch: 0.0, u: [u, u], v: [a, b] });
        }
    }
}
