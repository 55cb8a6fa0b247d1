//! A closed chain of pairs: the equations that its loops close, at its modelled place and moved away from it.
//!
//! Pose of a body by products of exponentials along a spanning tree; every pair outside the tree closes a loop and
//! gives six equations between the rates of the freedoms. A gear pair gives one more.

use super::linear::{Matrix, least_squares, null_space};
use super::pair::AxisLine;
use mainspring_geometry::{Rigid3, Vec3};

/// A freedom of a pair: the unknown is its rate, of the second part against the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Degree {
    /// Index of the pair in the machine.
    pub pair: usize,
    pub axis: AxisLine,
    pub turns: bool,
}

/// A pair as an edge between bodies (numbered within the chain); its freedoms are `degrees`.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub bodies: (usize, usize),
    pub degrees: Vec<usize>,
}

/// Rates r[second] = ratio · r[first].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupling {
    pub first: usize,
    pub second: usize,
    pub ratio: f64,
}

pub(crate) struct Chain {
    pub bodies: usize,
    pub degrees: Vec<Degree>,
    pub links: Vec<Link>,
    pub couplings: Vec<Coupling>,
    /// Lengths are divided by this.
    pub size: f64,
    /// For each body its tree link (none for roots), and the links that close loops.
    tree: Vec<Option<usize>>,
    closing: Vec<usize>,
    order: Vec<usize>,
}

/// (angular, linear at the origin), lengths in units of the chain's size.
type Twist = [f64; 6];

/// Rates relative to the largest below this count as zero.
pub(crate) const RATE_TOLERANCE: f64 = 1e-7;

impl Chain {
    pub(crate) fn new(
        bodies: usize,
        degrees: Vec<Degree>,
        links: Vec<Link>,
        couplings: Vec<Coupling>,
        size: f64,
    ) -> Self {
        let mut chain = Chain {
            bodies,
            degrees,
            links,
            couplings,
            size,
            tree: vec![None; bodies],
            closing: vec![],
            order: vec![],
        };
        chain.span();
        chain
    }

    /// Breadth first from the lowest body of each connected piece.
    fn span(&mut self) {
        let mut used = vec![false; self.links.len()];
        let mut reached = vec![false; self.bodies];
        for root in 0..self.bodies {
            if reached[root] {
                continue;
            }
            reached[root] = true;
            let mut queue = std::collections::VecDeque::from([root]);
            while let Some(body) = queue.pop_front() {
                self.order.push(body);
                for (k, link) in self.links.iter().enumerate() {
                    let (a, b) = link.bodies;
                    let next = if a == body { b } else { a };
                    if (a == body || b == body) && !reached[next] {
                        (reached[next], used[k], self.tree[next]) = (true, true, Some(k));
                        queue.push_back(next);
                    }
                }
            }
        }
        self.closing = (0..self.links.len()).filter(|k| !used[*k]).collect();
    }

    /// Poses at joint positions `x`: where each body has moved from its modelled place.
    fn poses(&self, x: &[f64]) -> Vec<Rigid3> {
        let mut poses = vec![Rigid3::identity(); self.bodies];
        for &body in &self.order {
            let Some(k) = self.tree[body] else { continue };
            let (a, b) = self.links[k].bodies;
            let motion = self.motion(&self.links[k], x);
            poses[body] =
                if b == body { poses[a].then_after(&motion) } else { poses[b].then_after(&motion.inverse()) };
        }
        poses
    }

    fn motion(&self, link: &Link, x: &[f64]) -> Rigid3 {
        link.degrees
            .iter()
            .fold(Rigid3::identity(), |pose, &d| pose.then_after(&self.degrees[d].motion(x[d], self.size)))
    }

    /// The rows of all loops and couplings at joint positions `x`.
    pub(crate) fn equations(&self, x: &[f64]) -> Matrix {
        let poses = self.poses(x);
        let n = self.degrees.len();
        // The twist of each body as a combination of rates.
        let mut twists: Vec<Vec<Twist>> = vec![vec![[0.0; 6]; n]; self.bodies];
        for &body in &self.order {
            let Some(k) = self.tree[body] else { continue };
            let (a, b) = self.links[k].bodies;
            let (parent, sign) = if b == body { (a, 1.0) } else { (b, -1.0) };
            let mut twist = twists[parent].clone();
            for &d in &self.links[k].degrees {
                let screw = self.degrees[d].screw(&poses[a], self.size);
                twist[d].iter_mut().zip(screw).for_each(|(t, s)| *t += sign * s);
            }
            twists[body] = twist;
        }
        let mut rows = Vec::new();
        for &k in &self.closing {
            let (a, b) = self.links[k].bodies;
            let mut block = vec![vec![0.0; n]; 6];
            for d in 0..n {
                let screw = self.degrees[d].screw(&poses[a], self.size);
                let own = if self.links[k].degrees.contains(&d) { 1.0 } else { 0.0 };
                for c in 0..6 {
                    block[c][d] = twists[a][d][c] + own * screw[c] - twists[b][d][c];
                }
            }
            rows.extend(block);
        }
        rows.extend(self.couplings.iter().map(|c| {
            let mut row = vec![0.0; n];
            row[c.second] += 1.0;
            row[c.first] -= c.ratio;
            row
        }));
        rows
    }

    /// By how much the loops fail to close at `x`, in the order of the rows of [`Chain::equations`].
    fn errors(&self, x: &[f64]) -> Vec<f64> {
        let poses = self.poses(x);
        let mut errors = Vec::new();
        for &k in &self.closing {
            let (a, b) = self.links[k].bodies;
            let wanted = poses[a].then_after(&self.motion(&self.links[k], x));
            errors.extend(difference(&wanted, &poses[b], self.size));
        }
        errors.extend(self.couplings.iter().map(|c| x[c.second] - c.ratio * x[c.first]));
        errors
    }

    /// Positions of a nearby place, reached by following the free motions a step and closing the loops again.
    /// None if the loops do not close there.
    fn moved(&self, basis: &Matrix, step: f64) -> Option<Vec<f64>> {
        let n = self.degrees.len();
        let mut x = vec![0.0; n];
        for (k, v) in basis.iter().enumerate() {
            // No special relation between the parts of the motion.
            let share = step * (0.61 + 0.39 * (1.7 * k as f64).sin());
            x.iter_mut().zip(v).for_each(|(x, v)| *x += share * v);
        }
        for _ in 0..40 {
            let errors = self.errors(&x);
            if errors.iter().all(|e| e.abs() < 1e-11) {
                return Some(x);
            }
            let dx = least_squares(&self.equations(&x), &errors, n);
            x.iter_mut().zip(&dx).for_each(|(x, d)| *x -= d);
            if !x.iter().all(|x| x.is_finite() && x.abs() < 1.0) {
                return None;
            }
        }
        None
    }

    /// The equations at the modelled place and at places near it: of these, the ones with the fewest free motions
    /// (a place where the chain stands singular, as at a dead centre, says too much or too little).
    pub(crate) fn typical(&self) -> Vec<Matrix> {
        let n = self.degrees.len();
        let start = self.equations(&vec![0.0; n]);
        let basis = null_space(&start, n, RATE_TOLERANCE);
        let mut found = vec![(basis.len(), start)];
        for step in [0.11, -0.07, 0.013] {
            if let Some(x) = self.moved(&basis, step) {
                let rows = self.equations(&x);
                found.push((null_space(&rows, n, RATE_TOLERANCE).len(), rows));
            }
        }
        let fewest = found.iter().map(|f| f.0).min().unwrap_or(0);
        found.into_iter().filter(|f| f.0 == fewest).map(|f| f.1).collect()
    }
}

impl Degree {
    fn motion(&self, x: f64, size: f64) -> Rigid3 {
        let AxisLine { point, direction } = self.axis;
        if !self.turns {
            return Rigid3::translation(direction * (x * size));
        }
        turn(point, direction, x)
    }

    fn screw(&self, pose: &Rigid3, size: f64) -> Twist {
        let d = pose.rotate(self.axis.direction);
        if !self.turns {
            return [0.0, 0.0, 0.0, d.x, d.y, d.z];
        }
        let v = pose.apply(self.axis.point).cross(d) * (1.0 / size);
        [d.x, d.y, d.z, v.x, v.y, v.z]
    }
}

/// The rotation by `angle` (radians, right-handed) about a line.
pub(crate) fn turn(point: Vec3, d: Vec3, angle: f64) -> Rigid3 {
    let (sin, cos) = angle.sin_cos();
    let image = |e: Vec3| e * cos + d.cross(e) * sin + d * (d.dot(e) * (1.0 - cos));
    let columns =
        [image(Vec3::new(1.0, 0.0, 0.0)), image(Vec3::new(0.0, 1.0, 0.0)), image(Vec3::new(0.0, 0.0, 1.0))];
    let rotation = Rigid3 { columns, translation: Vec3::default() };
    Rigid3 { translation: point - rotation.rotate(point), ..rotation }
}

/// The small twist from pose `b` to pose `a`.
fn difference(a: &Rigid3, b: &Rigid3, size: f64) -> Twist {
    let m = a.then_after(&b.inverse());
    let [x, y, z] = m.columns;
    let t = m.translation * (1.0 / size);
    [0.5 * (y.z - z.y), 0.5 * (z.x - x.z), 0.5 * (x.y - y.x), t.x, t.y, t.z]
}
