//! Feature pairs that can touch, found cell by cell: the curves made for them are kept.

use crate::element::{Element, Frame, Scratch, elements};
use crate::equation::Equation;
use crate::shape::{Shape, unrotate};
use crate::tree::Discs;
use mainspring_geometry::Vec2;
use mainspring_mechanism::{GapKind, Pose};
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
        kind: &'a dyn Fn(usize, usize) -> Option<GapKind>,
    ) -> Self {
        let trees = parts.map(|p| Discs::new(&p.iter().map(|p| p.disc).collect::<Vec<_>>()));
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

    /// May two tree nodes hold features that touch within the cell?
    pub fn near(&self, i: u32, j: u32, poses: &[Pose; 2], half: [f64; 2]) -> bool {
        let (m, n) = (&self.trees[0].nodes[i as usize], &self.trees[1].nodes[j as usize]);
        let [m1, m2] = &self.frame.moving;
        let motion = half[0] * m1.lever(m.center, m.radius) + half[1] * m2.lever(n.center, n.radius);
        (poses[0].apply(m.center) - poses[1].apply(n.center)).norm() <= m.radius + n.radius + motion
    }

    /// May two features touch within the cell? Sharper than `near`: signed distance and normals.
    pub fn may_touch(&self, i: u32, j: u32, poses: &[Pose; 2], half: [f64; 2]) -> bool {
        let (a, b) = (&self.parts[0][i as usize], &self.parts[1][j as usize]);
        match (&a.shape, &b.shape) {
            (Shape::Arc { .. }, Shape::Arc { .. }) => self.arcs_may_touch(a, b, poses, half),
            (Shape::Arc { .. }, Shape::Edge { .. }) => {
                self.edge_may_touch((a, &poses[0], half[0], 0), (b, &poses[1], half[1], 1))
            }
            (Shape::Edge { .. }, Shape::Arc { .. }) => {
                self.edge_may_touch((b, &poses[1], half[1], 1), (a, &poses[0], half[0], 0))
            }
            _ => false,
        }
    }

    fn turning(&self, axis: usize, half: f64) -> f64 {
        if self.frame.moving[axis].turns() { half } else { 0.0 }
    }

    fn edge_may_touch(&self, arc: (&Part, &Pose, f64, usize), edge: (&Part, &Pose, f64, usize)) -> bool {
        let (
            Shape::Arc { center, radius, directions, hollow },
            Shape::Edge { from, tangent, normal, length },
        ) = (&arc.0.shape, &edge.0.shape)
        else {
            return false;
        };
        if *hollow {
            return false;
        }
        let own = self.frame.moving[arc.3].lever(*center, 0.0) * arc.2;
        let radius_motion = if self.frame.moving[edge.3].turns() { edge.2 * radius } else { 0.0 };
        let motion = own + edge.0.lever * edge.2 + radius_motion + 1e-9 * self.frame.size;
        let offset = unrotate(edge.1, arc.1.apply(*center) - edge.1.shift) - *from;
        let (along, gap) = (tangent.dot(offset), normal.dot(offset) - radius);
        if gap.abs() > motion || along < -motion || along > length + motion {
            return false;
        }
        let turn = self.turning(arc.3, arc.2) + self.turning(edge.3, edge.2) + 1e-9;
        turn >= 0.5 || directions.margin(unrotate(arc.1, -edge.1.rotate(*normal))) >= -turn
    }

    fn arcs_may_touch(&self, a: &Part, b: &Part, poses: &[Pose; 2], half: [f64; 2]) -> bool {
        let (
            Shape::Arc { center: p, radius: r, directions: da, hollow: ha },
            Shape::Arc { center: q, radius: s, directions: db, hollow: hb },
        ) = (&a.shape, &b.shape)
        else {
            return false;
        };
        let [m1, m2] = &self.frame.moving;
        let inside = *ha || *hb;
        let rho = if inside { (r - s).abs() } else { r + s };
        let motion = m1.lever(*p, 0.0) * half[0] + m2.lever(*q, 0.0) * half[1] + 1e-9 * self.frame.size;
        let d = poses[0].apply(*p) - poses[1].apply(*q);
        let length = d.norm();
        if (length - rho).abs() > motion {
            return false;
        }
        // The direction of centres turns by at most asin(motion/ρ), and the bodies turn.
        let turn = 1.6 * motion / rho.max(f64::MIN_POSITIVE) + 1e-9;
        if turn >= 0.4 || length == 0.0 {
            return true;
        }
        let d = d * (1.0 / length);
        let (out_a, out_b) = match (*ha, *hb) {
            (false, false) => (-d, d),
            (false, true) => (d, d),
            _ => (-d, -d),
        };
        let (ta, tb) = (turn + self.turning(0, half[0]), turn + self.turning(1, half[1]));
        (ta >= 0.5 || da.margin(unrotate(&poses[0], out_a)) >= -ta)
            && (tb >= 0.5 || db.margin(unrotate(&poses[1], out_b)) >= -tb)
    }
}
