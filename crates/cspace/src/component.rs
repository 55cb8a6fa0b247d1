//! Components of free space.

use crate::cycles::Cycle;
use crate::lattice::Lattice;
use crate::slabs::NONE;
use crate::space::ConfigurationSpace;

/// A connected part of free space within the stored domain.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    pub id: u32,
    /// Boundary cycles, free space on their left (with both coordinates' ratios positive).
    pub boundary: Vec<Cycle>,
    /// Closed ways within it: periods of the domain they wind around both coordinates.
    pub windings: Lattice,
    /// The same in whole turns, for a space of which one period is stored.
    pub turns: Lattice,
    /// How many components it stands for over whole turns: copies by the symmetry of the bodies.
    pub copies: u32,
    /// Area in joint coordinates, to about 1e-9 of the domain's.
    pub area: f64,
    /// A configuration inside, within the domain, as far from the curves as the partition shows.
    pub inside: [f64; 2],
}

impl ConfigurationSpace {
    /// The components of free space, by their first appearance from smaller to greater first coordinate.
    pub fn components(&self) -> Vec<Component> {
        let cycles = self.cycles();
        let [n, m] = self.repeats.map(i64::from);
        let mut found: Vec<Component> = cycles
            .into_iter()
            .zip(&self.cells.windings)
            .enumerate()
            .map(|(id, (boundary, windings))| Component {
                id: id as u32,
                boundary,
                windings: windings.clone(),
                turns: windings.within(n, m),
                copies: windings.cosets(n, m) as u32,
                area: 0.0,
                inside: [f64::NAN; 2],
            })
            .collect();
        self.measure(&mut found);
        found
    }

    /// How many there are over whole turns.
    pub fn component_count(&self) -> usize {
        let [n, m] = self.repeats.map(i64::from);
        self.cells.windings.iter().map(|w| w.cosets(n, m) as usize).sum()
    }

    /// The component of a configuration, free or in contact; none if it is blocked or outside.
    pub fn component_of(&self, q: [f64; 2]) -> Option<u32> {
        let (cell, ..) = self.free_place(q)?;
        let id = self.cells.of[cell];
        (id != NONE).then_some(id)
    }

    fn measure(&self, found: &mut [Component]) {
        let ratios = self.atlas.frame.moving.map(|m| m.ratio);
        let mut widest = vec![0.0; found.len()];
        for cell in (0..self.slabs.free.len()).filter(|&c| self.slabs.free[c]) {
            let ((a, b), _) = self.sides_of(cell);
            let id = self.cells.of[cell] as usize;
            let height = |u: f64| {
                let (low, high) = self.extent(cell, u);
                high - low
            };
            found[id].area += area(a, b, 0, &height) / (ratios[0] * ratios[1]);
            let middle = 0.5 * (a + b);
            let (low, high) = self.extent(cell, middle);
            let width = (b - a) * self.levers[0] * ((high - low) * self.levers[1]);
            if width > widest[id] {
                widest[id] = width;
                let at = [middle, 0.5 * (low + high)];
                found[id].inside = [0, 1].map(|k| self.atlas.frame.axes[k].wrap(at[k]).0 / ratios[k]);
            }
        }
    }
}

/// Halvings of a slab for its area at most.
const DEEPEST: u32 = 20;
/// Difference between the two, in the units of scaled positions; the finer one is a hundred times as good.
const ERROR: f64 = 1e-11;

/// ∫ height du: by halves until Gauss's rule says nearly the same on two and on four panels. A fold just beyond an end, where the
/// height changes with a square root, takes some halvings.
fn area(a: f64, b: f64, depth: u32, height: &impl Fn(f64) -> f64) -> f64 {
    let (coarse, fine) = (quadrature(a, b, 2, height), quadrature(a, b, 4, height));
    if (coarse - fine).abs() <= ERROR || depth >= DEEPEST {
        return fine;
    }
    let middle = 0.5 * (a + b);
    area(a, middle, depth + 1, height) + area(middle, b, depth + 1, height)
}

/// ∫ height du by Gauss's rule of five points on panels after u = middle + half·sin(πs/2), which smooths folds at the ends.
fn quadrature(a: f64, b: f64, panels: u32, height: &impl Fn(f64) -> f64) -> f64 {
    const NODES: [(f64, f64); 5] = [
        (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
        (-0.538_469_310_105_683, 0.478_628_670_499_366_47),
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let quarter = 0.5 * std::f64::consts::PI;
    let width = 1.0 / f64::from(panels);
    let term = |panel: u32, (s, w): (f64, f64)| {
        let s = width * (2.0 * f64::from(panel) + 1.0 - f64::from(panels) + s);
        let (sin, cos) = (quarter * s).sin_cos();
        width * w * height(middle + half * sin) * half * quarter * cos
    };
    (0..panels).flat_map(|k| NODES.into_iter().map(move |n| (k, n))).map(|(k, n)| term(k, n)).sum()
}
