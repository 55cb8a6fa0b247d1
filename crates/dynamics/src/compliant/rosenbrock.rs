//! One step of the Rosenbrock method Rodas5P (see `tableau`) for second-order systems `q̈ = a(t, q, q̇)`.
//!
//! With μ = 1/(hγ), A = ∂a/∂q, B = ∂a/∂q̇, each stage solves
//! ```text
//! μ x − w = r_q = v_i + Σ c_ij x_j/h                      x, w: increments of q and q̇
//! μ w − A x − B w = r_v = a_i + Σ c_ij w_j/h + h γ_i ∂a/∂t
//! ```
//! by eliminating x: `(μ − B − A/μ) w = r_v + A r_q/μ`, a system of half the size, factored once a step.

use super::tableau::{A, C, DENSE, GAMMA, STAGES, TIME_WEIGHTS, TIMES};

/// A second-order system.
pub trait Accelerations {
    /// Accelerations into `a` (all of it is overwritten).
    fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]);
}

/// Derivatives of the accelerations at the start of a step; matrices row after row.
#[derive(Clone, Debug, Default)]
pub struct Jacobian {
    pub by_position: Vec<f64>,
    pub by_velocity: Vec<f64>,
    pub by_time: Vec<f64>,
}

impl Jacobian {
    /// Zeros for `n` coordinates.
    pub fn clear(&mut self, n: usize) {
        for (list, length) in
            [(&mut self.by_position, n * n), (&mut self.by_velocity, n * n), (&mut self.by_time, n)]
        {
            list.clear();
            list.resize(length, 0.0);
        }
    }
}

/// Where a step starts: time, positions, velocities and accelerations.
#[derive(Clone, Copy, Debug)]
pub struct Start<'s> {
    pub t: f64,
    pub q: &'s [f64],
    pub v: &'s [f64],
    pub a: &'s [f64],
}

/// A step with its stages: the increments of positions and of velocities.
#[derive(Clone, Debug, Default)]
pub struct Rosenbrock {
    n: usize,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    /// Result of the step.
    pub end_q: Vec<f64>,
    pub end_v: Vec<f64>,
    rates: Vec<f64>,
    right: Vec<f64>,
    matrix: Matrix,
}

impl Rosenbrock {
    /// Prepares space for `n` coordinates.
    pub fn resize(&mut self, n: usize) {
        self.n = n;
        for list in [&mut self.positions, &mut self.velocities] {
            list.resize(STAGES * n, 0.0);
        }
        for list in [&mut self.end_q, &mut self.end_v, &mut self.rates, &mut self.right] {
            list.resize(n, 0.0);
        }
    }

    /// Tries a step of length `h`. False if its system is singular or runs out of numbers; otherwise the result is
    /// in `end_q` and `end_v`, and its estimated errors in `error`.
    pub fn attempt(
        &mut self,
        f: &mut impl Accelerations,
        start: &Start,
        jacobian: &Jacobian,
        h: f64,
    ) -> bool {
        let mu = 1.0 / (h * GAMMA);
        if !self.matrix.factor(jacobian, mu, self.n) {
            return false;
        }
        for stage in 0..STAGES {
            self.stage(f, start, jacobian, (h, mu), stage);
        }
        self.add_to_end(STAGES - 1);
        self.end_q.iter().chain(&self.end_v).all(|x| x.is_finite())
    }

    /// Estimated errors of positions and velocities of the last step.
    pub fn error(&self) -> (&[f64], &[f64]) {
        let last = (STAGES - 1) * self.n..;
        (&self.positions[last.clone()], &self.velocities[last])
    }

    fn stage(
        &mut self,
        f: &mut impl Accelerations,
        start: &Start,
        jacobian: &Jacobian,
        (h, mu): (f64, f64),
        stage: usize,
    ) {
        let n = self.n;
        self.start_stage(start, stage);
        if stage == 0 {
            self.rates.copy_from_slice(start.a);
        } else {
            let t = start.t + TIMES[stage] * h;
            f.accelerations(t, &self.end_q, &self.end_v, &mut self.rates);
        }
        let own = stage * n;
        for i in 0..n {
            let sum = |u: &[f64]| C[stage].iter().enumerate().map(|(j, c)| c * u[j * n + i]).sum::<f64>() / h;
            let r_q = self.end_v[i] + sum(&self.positions);
            let time = h * TIME_WEIGHTS[stage] * jacobian.by_time[i];
            self.right[i] = self.rates[i] + sum(&self.velocities) + time;
            self.positions[own + i] = r_q;
        }
        for i in 0..n {
            let row = &jacobian.by_position[i * n..(i + 1) * n];
            let r_q = &self.positions[own..own + n];
            self.right[i] += row.iter().zip(r_q).map(|(a, r)| a * r).sum::<f64>() / mu;
        }
        self.matrix.solve(&mut self.right, n);
        for i in 0..n {
            self.velocities[own + i] = self.right[i];
            self.positions[own + i] = (self.positions[own + i] + self.right[i]) / mu;
        }
    }

    /// Where the stage evaluates, left in `end_q` and `end_v`.
    fn start_stage(&mut self, start: &Start, stage: usize) {
        let n = self.n;
        let Some(row) = A.get(stage) else { return self.add_to_end(stage - 1) };
        for i in 0..n {
            let sum = |u: &[f64]| row.iter().enumerate().map(|(j, a)| a * u[j * n + i]).sum::<f64>();
            self.end_q[i] = start.q[i] + sum(&self.positions);
            self.end_v[i] = start.v[i] + sum(&self.velocities);
        }
    }

    fn add_to_end(&mut self, stage: usize) {
        let own = stage * self.n;
        for i in 0..self.n {
            self.end_q[i] += self.positions[own + i];
            self.end_v[i] += self.velocities[own + i];
        }
    }

    /// k₁, k₂, k₃ of the dense output for the position (or velocity) of coordinate `i`.
    pub fn dense(&self, velocity: bool, i: usize) -> [f64; 3] {
        let u = if velocity { &self.velocities } else { &self.positions };
        DENSE.map(|row| row.iter().enumerate().map(|(j, d)| d * u[j * self.n + i]).sum())
    }
}

/// The matrix `μ − B − A/μ`, factored with row exchanges.
#[derive(Clone, Debug, Default)]
struct Matrix {
    entries: Vec<f64>,
    pivots: Vec<usize>,
}

impl Matrix {
    /// False if it is singular or not finite.
    fn factor(&mut self, jacobian: &Jacobian, mu: f64, n: usize) -> bool {
        let Self { entries: m, pivots } = self;
        m.clear();
        m.extend(jacobian.by_position.iter().zip(&jacobian.by_velocity).map(|(a, b)| -b - a / mu));
        pivots.clear();
        for i in 0..n {
            m[i * n + i] += mu;
        }
        for k in 0..n {
            let mut pivot = k;
            for i in k + 1..n {
                if m[i * n + k].abs() > m[pivot * n + k].abs() {
                    pivot = i;
                }
            }
            pivots.push(pivot);
            if pivot != k {
                (0..n).for_each(|j| m.swap(k * n + j, pivot * n + j));
            }
            let head = m[k * n + k];
            if head == 0.0 || !head.is_finite() {
                return false;
            }
            for i in k + 1..n {
                let factor = m[i * n + k] / head;
                m[i * n + k] = factor;
                for j in k + 1..n {
                    m[i * n + j] -= factor * m[k * n + j];
                }
            }
        }
        true
    }

    fn solve(&self, x: &mut [f64], n: usize) {
        let m = &self.entries;
        // Rows were exchanged whole, factors included: all exchanges come first.
        for (k, &pivot) in self.pivots.iter().enumerate() {
            x.swap(k, pivot);
        }
        for i in 0..n {
            for k in 0..i {
                x[i] -= m[i * n + k] * x[k];
            }
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                x[i] -= m[i * n + k] * x[k];
            }
            x[i] /= m[i * n + i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Accelerations, Jacobian, Rosenbrock, Start};

    /// A driven, damped, nonlinear oscillator beside a linear one that turns with it: `q̈₀ = −q₀³ − q₁ v₀ + sin t`,
    /// `q̈₁ = q₀ − s (q₁ − cos t) − s v₁`.
    struct Test {
        stiff: f64,
    }

    impl Accelerations for Test {
        fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) {
            a[0] = -q[0].powi(3) - q[1] * v[0] + t.sin();
            a[1] = q[0] - self.stiff * (q[1] - t.cos()) - self.stiff * v[1];
        }
    }

    impl Test {
        fn jacobian(&self, t: f64, q: &[f64], v: &[f64]) -> Jacobian {
            let s = self.stiff;
            Jacobian {
                by_position: vec![-3.0 * q[0] * q[0], -v[0], 1.0, -s],
                by_velocity: vec![-q[1], 0.0, 0.0, -s],
                by_time: vec![t.cos(), -s * t.sin()],
            }
        }
    }

    /// Goes from 0 to 1 in equal steps; returns the end, the state half way through the first step, and the greatest
    /// estimated error.
    fn run(stiff: f64, steps: u32) -> (Vec<f64>, Vec<f64>, f64) {
        let (mut f, mut step) = (Test { stiff }, Rosenbrock::default());
        step.resize(2);
        let h = 1.0 / f64::from(steps);
        let (mut q, mut v) = (vec![0.3, 0.8], vec![0.5, -0.2]);
        let (mut middle, mut worst) = (vec![], 0.0f64);
        for k in 0..steps {
            let t = h * f64::from(k);
            let mut a = vec![0.0; 2];
            f.accelerations(t, &q, &v, &mut a);
            let jacobian = f.jacobian(t, &q, &v);
            assert!(step.attempt(&mut f, &Start { t, q: &q, v: &v, a: &a }, &jacobian, h));
            if k == 0 {
                middle = (0..2).map(|i| middle_of(step.dense(false, i), q[i], step.end_q[i])).collect();
                middle.extend((0..2).map(|i| middle_of(step.dense(true, i), v[i], step.end_v[i])));
            }
            worst = worst.max(step.error().1.iter().fold(0.0, |m, e| e.abs().max(m)));
            (q, v) = (step.end_q.clone(), step.end_v.clone());
        }
        q.extend(v);
        (q, middle, worst)
    }

    fn middle_of(k: [f64; 3], start: f64, end: f64) -> f64 {
        0.5 * start + 0.5 * (end + 0.5 * (k[0] + 0.5 * (k[1] + 0.5 * k[2])))
    }

    fn distance(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Order conditions: the error falls by 2⁵ when the step is halved, the estimate's by 2⁵ a step (order 4), the
    /// dense output's by 2⁵ over one step (order 4).
    #[test]
    fn orders_are_five_four_and_four() {
        let fine = run(1.0, 320).0;
        let (coarse, half) = (run(1.0, 10), run(1.0, 20));
        let order = (distance(&coarse.0, &fine) / distance(&half.0, &fine)).log2();
        assert!((4.6..6.5).contains(&order), "order {order}");
        let estimate = (coarse.2 / half.2).log2();
        assert!((4.4..6.0).contains(&estimate), "local order of the estimate {estimate}");
        // Half a step: the middle of one step of 0.1 is the end of the second of 0.025, of 0.05 that of 0.0125.
        let inside = |steps: u32| {
            let short = run_to(1.0, 0.5 / f64::from(steps), 16);
            distance(&run(1.0, steps).1, &short)
        };
        let dense = (inside(5) / inside(10)).log2();
        assert!((4.4..6.5).contains(&dense), "local order of the dense output {dense}");
    }

    fn run_to(stiff: f64, until: f64, steps: u32) -> Vec<f64> {
        let (mut f, mut step) = (Test { stiff }, Rosenbrock::default());
        step.resize(2);
        let h = until / f64::from(steps);
        let (mut q, mut v) = (vec![0.3, 0.8], vec![0.5, -0.2]);
        for k in 0..steps {
            let t = h * f64::from(k);
            let mut a = vec![0.0; 2];
            f.accelerations(t, &q, &v, &mut a);
            let jacobian = f.jacobian(t, &q, &v);
            assert!(step.attempt(&mut f, &Start { t, q: &q, v: &v, a: &a }, &jacobian, h));
            (q, v) = (step.end_q.clone(), step.end_v.clone());
        }
        q.extend(v);
        q
    }

    /// With a rate of 10⁹ steps of a tenth stay on the slow motion q₁ ≈ cos t − …: L-stability.
    #[test]
    fn stiff_parts_are_damped_at_once() {
        let end = run(1e9, 10).0;
        // v₁ ≈ cos t − q₁ on the slow motion, to 1/s.
        assert!((end[3] - (1.0f64.cos() - end[1])).abs() < 1e-5, "{end:?}");
        let fine = run(1e9, 160).0;
        assert!(distance(&end, &fine) < 1e-4, "{end:?} {fine:?}");
    }
}
