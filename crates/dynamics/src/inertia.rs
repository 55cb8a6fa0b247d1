//! Inertia at an instant: which coordinates move freely, and with what mass matrix.
//!
//! Coordinates that masses tie together (`System::coupled`) have a block of M at the positions at hand; with held ones
//! (driven, or stuck by dry friction) of given acceleration q̈_h, the free ones obey `M_ff q̈_f = f_f − M_fh q̈_h`. For all
//! others M is diagonal. A held coordinate has infinite inertia: nothing that acts on it moves it.

use crate::linear::{Small, factorize, solve_factorized};
use mainspring_mechanism::{Coupled, Equations, Mass, Motion, Row, System};

/// Which coordinates move freely.
#[derive(Clone, Debug)]
pub struct Freedom {
    held: Vec<bool>,
    /// I; infinite where the motion is given, and where a block holds the inertia.
    own: Vec<f64>,
}

impl Freedom {
    /// All but those `held`.
    pub fn new(system: &System, held: Vec<bool>) -> Self {
        let mut own: Vec<f64> = system.coordinates.iter().map(|c| c.inertia).collect();
        let tied = system.coupled.iter().flat_map(|g| g.coordinates.iter().copied());
        let given = (0..held.len()).filter(|&i| held[i]);
        tied.chain(given).for_each(|i| own[i] = f64::INFINITY);
        Self { held, own }
    }

    #[inline]
    pub fn is_held(&self, i: usize) -> bool {
        self.held[i]
    }

    /// 1/I; 0 where the motion is given, and where a block holds the inertia.
    #[inline]
    pub fn mobility(&self, i: usize) -> f64 {
        1.0 / self.own[i]
    }

    /// Does coordinate `i` move freely, with an inertia of its own alone?
    #[inline]
    pub fn is_alone(&self, i: usize) -> bool {
        self.own[i].is_finite()
    }
}

/// M of the free coordinates at an instant.
pub struct Inertia<'m> {
    system: &'m System,
    freedom: &'m Freedom,
    blocks: Vec<Block<'m>>,
}

struct Block<'m> {
    group: &'m Coupled,
    equations: Equations,
    /// Places of the free coordinates in the group.
    free: Small<usize>,
    /// Of M_ff.
    factor: Small<f64, 16>,
}

impl<'m> Block<'m> {
    fn new(system: &System, freedom: &Freedom, group: &'m Coupled, q: &[f64], v: &[f64]) -> Self {
        let (mut equations, n) = (Equations::default(), group.coordinates.len());
        system.equations(group, q, v, &mut equations);
        let free: Small<usize> = (0..n).filter(|&k| !freedom.held[group.coordinates[k]]).collect();
        let mut factor: Small<f64, 16> = free
            .iter()
            .flat_map(|i| free.iter().map(move |j| i * n + j))
            .map(|k| equations.mass[k])
            .collect();
        if !factorize(&mut factor, free.len()) {
            // No mass moves along some direction: nothing can be said of it, and the step fails.
            factor.fill(f64::NAN);
        }
        Self { group, equations, free, factor }
    }

    /// Entries of a row at the free coordinates; None if all are zero.
    fn part(&self, row: &Row) -> Option<Small<f64>> {
        let at = |k: &usize| row.at(self.group.coordinates[*k]);
        let part: Small<f64> = self.free.iter().map(at).collect();
        part.iter().any(|g| *g != 0.0).then_some(part)
    }

    fn place(&self, i: usize) -> Option<usize> {
        self.group.coordinates.iter().position(|c| *c == i)
    }

    /// (M x)_i for coordinate number `k` of the group.
    fn times(&self, k: usize, x: &[f64]) -> f64 {
        let n = self.group.coordinates.len();
        self.group.coordinates.iter().enumerate().map(|(j, i)| self.equations.mass[k * n + j] * x[*i]).sum()
    }
}

impl<'m> Inertia<'m> {
    /// At positions `q` and velocities `v`, with the blocks named (indices into `System::coupled`).
    pub fn new(
        system: &'m System,
        freedom: &'m Freedom,
        blocks: impl Iterator<Item = usize>,
        (q, v): (&[f64], &[f64]),
    ) -> Self {
        let block = |k: usize| Block::new(system, freedom, &system.coupled[k], q, v);
        Self { system, freedom, blocks: blocks.map(block).collect() }
    }

    /// With every block.
    pub fn whole(system: &'m System, freedom: &'m Freedom, state: (&[f64], &[f64])) -> Self {
        Self::new(system, freedom, 0..system.coupled.len(), state)
    }

    pub fn has_blocks(&self) -> bool {
        !self.blocks.is_empty()
    }

    /// The blocks' part of `M⁻¹ g` for the row of which `entry` tells the entries, coordinate by coordinate.
    pub fn respond(&self, entry: impl Fn(usize) -> f64, mut each: impl FnMut(usize, f64)) {
        for block in &self.blocks {
            let coordinate = |k: usize| block.group.coordinates[k];
            let mut response: Small<f64> = block.free.iter().map(|&k| entry(coordinate(k))).collect();
            if response.iter().any(|g| *g != 0.0) {
                solve_factorized(&block.factor, &mut response);
                block.free.iter().zip(response).for_each(|(&k, x)| each(coordinate(k), x));
            }
        }
    }

    /// `G M⁻¹ Gᵀ` in row order.
    #[inline]
    pub fn inverse(&self, rows: &[Row]) -> Small<f64, 16> {
        let n = rows.len();
        let mut a: Small<f64, 16> = smallvec::smallvec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                let product = rows[i].product(&rows[j], |k| self.freedom.own[k]);
                (a[i * n + j], a[j * n + i]) = (product, product);
            }
        }
        self.add_blocks(rows, &mut a);
        a
    }

    fn add_blocks(&self, rows: &[Row], a: &mut [f64]) {
        let n = rows.len();
        for block in &self.blocks {
            let parts: Small<Option<Small<f64>>> = rows.iter().map(|row| block.part(row)).collect();
            for (i, part) in parts.iter().enumerate() {
                let Some(mut response) = part.clone() else { continue };
                solve_factorized(&block.factor, &mut response);
                for (j, other) in parts.iter().enumerate() {
                    let Some(other) = other else { continue };
                    a[i * n + j] += response.iter().zip(other).map(|(x, y)| x * y).sum::<f64>();
                }
            }
        }
    }

    /// Adds `M⁻¹ Gᵀ λ`.
    pub fn add_forces(&self, rows: &[Row], lambda: &[f64], change: &mut [f64]) {
        for (row, l) in rows.iter().zip(lambda) {
            for (i, g) in row.entries() {
                change[i] += g * l / self.freedom.own[i];
            }
        }
        for block in &self.blocks {
            for (row, l) in rows.iter().zip(lambda) {
                let Some(mut response) = block.part(row) else { continue };
                solve_factorized(&block.factor, &mut response);
                for (k, x) in block.free.iter().zip(response) {
                    change[block.group.coordinates[*k]] += x * l;
                }
            }
        }
    }

    /// Accelerations of the blocks' free coordinates without contacts; `a` holds those of held coordinates, and
    /// `dry` tells the constant friction of sliding.
    pub fn accelerate(&self, dry: impl Fn(usize) -> f64, a: &mut [f64]) {
        for block in &self.blocks {
            let n = block.group.coordinates.len();
            let held = |k: &usize| !block.free.contains(k);
            let mut right: Small<f64> = Small::new();
            for &k in &block.free {
                let carried: f64 = (0..n)
                    .filter(held)
                    .map(|j| block.equations.mass[k * n + j] * a[block.group.coordinates[j]])
                    .sum();
                right.push(block.equations.force[k] + dry(block.group.coordinates[k]) - carried);
            }
            solve_factorized(&block.factor, &mut right);
            for (k, x) in block.free.iter().zip(right) {
                a[block.group.coordinates[*k]] = x;
            }
        }
    }

    /// `(M q̈ − f)_i`: the force that is missing for the accelerations `a` at `(q, v)`, dry friction and contacts not
    /// counted.
    pub fn missing(&self, i: usize, (q, v): (&[f64], &[f64]), a: &[f64]) -> f64 {
        match self.blocks.iter().find_map(|b| Some((b, b.place(i)?))) {
            Some((block, k)) => block.times(k, a) - block.equations.force[k],
            None => {
                let c = &self.system.coordinates[i];
                c.inertia * a[i] - (c.force - c.stiffness * q[i] - c.damping * v[i])
            }
        }
    }

    /// `(M x)_i`.
    pub fn momentum(&self, i: usize, x: &[f64]) -> f64 {
        match self.blocks.iter().find_map(|b| Some((b, b.place(i)?))) {
            Some((block, k)) => block.times(k, x),
            None => self.system.coordinates[i].inertia * x[i],
        }
    }

    /// Size of the accelerations that meet at each coordinate, before they cancel; `a` are those given.
    pub fn weights(&self, (q, v): (&[f64], &[f64]), a: &[f64]) -> Small<f64, 8> {
        let force = |i: usize| {
            let c = &self.system.coordinates[i];
            let dry = self.system.forces.coulomb[i];
            (c.force - c.stiffness * q[i]).abs() + (c.damping * v[i]).abs() + dry
        };
        let alone = |i: usize| match self.freedom.held[i] {
            true => a[i].abs(),
            false => force(i) / self.freedom.own[i],
        };
        let mut weights: Small<f64, 8> = (0..q.len()).map(alone).collect();
        for block in &self.blocks {
            let masses: f64 = block.group.masses.iter().map(|&k| self.mass_weight(k, v)).sum();
            let n = block.group.coordinates.len();
            let carried = |k: usize| -> f64 {
                (0..n).map(|j| (block.equations.mass[k * n + j] * a[block.group.coordinates[j]]).abs()).sum()
            };
            for (k, &place) in block.free.iter().enumerate() {
                let mut unit: Small<f64> = smallvec::smallvec![0.0; block.free.len()];
                unit[k] = 1.0;
                solve_factorized(&block.factor, &mut unit);
                let sizes =
                    block.free.iter().map(|&j| force(block.group.coordinates[j]) + masses + carried(j));
                weights[block.group.coordinates[place]] =
                    unit.iter().zip(sizes).map(|(x, f)| x.abs() * f).sum();
            }
        }
        weights
    }

    /// Size of gravity and velocity terms of a mass.
    fn mass_weight(&self, k: usize, v: &[f64]) -> f64 {
        let Mass { body, mass, .. } = self.system.forces.masses[k];
        let (size, g) = (self.system.size, self.system.forces.gravity.norm());
        let speed = |j: &mainspring_mechanism::Joint| {
            let rate = (j.ratio * v[j.coordinate]).abs();
            if matches!(j.motion, Motion::Turn { .. }) { rate } else { rate / size }
        };
        let rate: f64 = self.system.bodies[body].chain.iter().map(speed).sum();
        mass * (g + rate * rate * size) * size.max(1.0)
    }

    /// The time in which the springs, friction or weights of coordinate `i` act: √(I/k), or I/h, or 1.
    pub fn natural_time(&self, i: usize) -> f64 {
        let c = &self.system.coordinates[i];
        let block = self.blocks.iter().find_map(|b| Some((b, b.place(i)?)));
        let (inertia, weight) = match block {
            Some((block, k)) => {
                let g = self.system.forces.gravity.norm();
                let masses = block.group.masses.iter().map(|&m| self.system.forces.masses[m].mass);
                let n = block.group.coordinates.len();
                (block.equations.mass[k * n + k], g * masses.sum::<f64>() * self.system.size)
            }
            None => (c.inertia, 0.0),
        };
        let stiffness = c.stiffness + weight;
        if stiffness > 0.0 {
            (inertia / stiffness).sqrt()
        } else if c.damping > 0.0 {
            inertia / c.damping
        } else {
            1.0
        }
    }
}
