//! The gap at a configuration, and the features at the nearest contact.

use crate::equation::Equation;
use crate::pairs::Part;
use crate::space::ConfigurationSpace;
use mainspring_mechanism::Pose;

/// The nearest contact of a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Free: the bodies' distance. Blocked: the gap (negative) of the contact curve nearest along one of the
    /// coordinates, to first order the overlap there.
    pub gap: f64,
    /// Features of the first and second body, by their indices in the system.
    pub features: [usize; 2],
}

impl ConfigurationSpace {
    /// The gap at a configuration. None outside a window, where the bodies have no features in common layers, and
    /// where a blocked configuration has no contact curve beside it whose features overlap.
    pub fn gap(&self, q: [f64; 2]) -> Option<Gap> {
        let (at, _) = self.scaled(q);
        let cell = self.cell_at(at)?;
        let poses = [0, 1].map(|k| self.atlas.frame.moving[k].place(at[k]));
        let found = if self.slabs.free[cell] { self.apart(&poses) } else { self.overlapping(at, &poses) };
        found.map(|g| if self.flipped { Gap { features: [g.features[1], g.features[0]], ..g } } else { g })
    }

    fn apart(&self, poses: &[Pose; 2]) -> Option<Gap> {
        let (distance, [a, b]) = self.regions.nearest(poses)?;
        let id = |k: usize, (section, span): (usize, usize)| self.regions.sections[k][section].features[span];
        let ids = [id(0, a), id(1, b)];
        // The nearest points may be corners at the spans' ends: of the features there, the pair that touches deepest
        // inside both.
        let around = |k: usize| {
            let part = |id: usize| self.parts[k].iter().find(|p| p.id == id);
            let own = part(ids[k]);
            let near: Vec<&Part> =
                own.iter().flat_map(|p| p.neighbours.iter().filter_map(|&n| part(n))).collect();
            own.into_iter().chain(near).collect::<Vec<_>>()
        };
        let mut best = (f64::NEG_INFINITY, ids);
        for i in around(0) {
            for j in around(1) {
                let eq = Equation::new([i.shape, j.shape]);
                let g = self.true_gap(&eq, poses);
                let margin = eq.margin(poses, self.atlas.frame.size);
                if (g - distance).abs() <= 1e-9 * self.atlas.frame.size && margin > best.0 {
                    best = (margin, [i.id, j.id]);
                }
            }
        }
        Some(Gap { gap: distance, features: best.1 })
    }

    /// The gap as a distance: F of two arcs is a difference of squares.
    fn true_gap(&self, eq: &Equation, poses: &[Pose; 2]) -> f64 {
        let f = eq.value_at(&self.atlas.frame.moving, poses).f;
        match eq.carried {
            [crate::moving::Carried::Point(_), crate::moving::Carried::Point(_)] => {
                let square = eq.rho * eq.rho + 2.0 * eq.rho * f * eq.side;
                eq.side * (square.max(0.0).sqrt() - eq.rho)
            }
            _ => f,
        }
    }

    fn overlapping(&self, at: [f64; 2], poses: &[Pose; 2]) -> Option<Gap> {
        let mut near: Vec<(f64, u32)> = self.beside(at, self.levers[1]);
        if let Ok(across) = self.transposed() {
            near.extend(across.beside([at[1], at[0]], self.levers[0]));
        }
        let of = |(off, piece): (f64, u32)| {
            let element = &self.atlas.elements[self.atlas.pieces[piece as usize].element as usize];
            let [i, j] = self.pairs[element.pair as usize];
            let features = [self.parts[0][i as usize].id, self.parts[1][j as usize].id];
            (off, piece, Gap { gap: self.true_gap(self.atlas.equation(piece), poses), features })
        };
        // A curve far off may belong to features that are apart here.
        let overlapping = near.into_iter().map(of).filter(|(.., g)| g.gap <= 1e-9 * self.atlas.frame.size);
        overlapping.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(.., g)| g)
    }

    /// Pieces below and above a configuration with their distance along v times the lever.
    fn beside(&self, at: [f64; 2], lever: f64) -> Vec<(f64, u32)> {
        let Some(cell) = self.cell_at(at) else { return vec![] };
        let (_, between) = self.sides_of(cell);
        let axis = &self.atlas.frame.axes[1];
        let off = |p: u32| {
            let d = (self.atlas.v_at(p, at[0]) - at[1]).abs();
            if axis.wraps { d.min(axis.length - d) } else { d }
        };
        let pieces = [between.lower, between.upper].into_iter().filter(|&p| p != crate::slabs::NONE);
        pieces.map(|p| (off(p) * lever, p)).collect()
    }
}
