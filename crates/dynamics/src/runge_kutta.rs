//! One step of the Runge–Kutta method of order 8 with dense output (DOP853, see `tableau`).

use crate::linear::Small;
use crate::tableau::{A, C, D, DENSE_STAGES, E3, E5, POWERS, STAGES};

/// The right-hand side: derivative of `y` at time `t` into `dy`.
pub trait Equations {
    fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]);
}

/// A step from (t, y) to (t + h, end), with what dense output needs.
#[derive(Clone, Debug, Default)]
pub struct Step {
    n: usize,
    /// Stage derivatives, one row of n a stage.
    k: Vec<f64>,
    /// Result of the step.
    pub end: Vec<f64>,
    scratch: Vec<f64>,
}

impl Step {
    /// Prepares space for `n` unknowns.
    pub fn resize(&mut self, n: usize) {
        self.n = n;
        self.k.resize(DENSE_STAGES * n, 0.0);
        self.end.resize(n, 0.0);
        self.scratch.resize(n, 0.0);
    }

    /// Evaluates the derivative at the start, for any number of attempts from there.
    pub fn begin(&mut self, f: &mut impl Equations, t: f64, y: &[f64]) -> &[f64] {
        let n = self.n;
        f.derivative(t, y, &mut self.k[..n]);
        &self.k[..n]
    }

    /// Tries a step after `begin`; returns the error relative to `scale` (accept when ≤ 1).
    pub fn attempt(&mut self, f: &mut impl Equations, t: f64, y: &[f64], h: f64, scale: &[f64]) -> f64 {
        let n = self.n;
        for stage in 1..=STAGES {
            self.stage(f, stage, t, y, h);
        }
        self.end.copy_from_slice(&self.scratch);
        let mut norm = |weights: &[(usize, f64)]| -> f64 {
            combine(weights, &self.k, &mut self.scratch);
            self.scratch.iter().zip(scale).map(|(e, scale)| (e / scale) * (e / scale)).sum()
        };
        let (five, three) = (norm(E5), norm(E3));
        if five == 0.0 {
            return 0.0;
        }
        h * five / ((five + 0.01 * three) * n as f64).sqrt()
    }

    fn stage(&mut self, f: &mut impl Equations, stage: usize, t: f64, y: &[f64], h: f64) {
        let n = self.n;
        combine(A[stage], &self.k, &mut self.scratch);
        for (sum, start) in self.scratch.iter_mut().zip(y) {
            *sum = start + h * *sum;
        }
        let row = stage * n..(stage + 1) * n;
        f.derivative(t + C[stage] * h, &self.scratch, &mut self.k[row]);
    }

    /// Interpolation polynomials of the accepted step, order 7: one a unknown.
    pub fn dense(&mut self, f: &mut impl Equations, t: f64, y: &[f64], h: f64) -> Vec<Polynomial> {
        for stage in STAGES + 1..DENSE_STAGES {
            self.stage(f, stage, t, y, h);
        }
        let n = self.n;
        let mut higher: Small<f64, 32> = smallvec::smallvec![0.0; D.len() * n];
        for (row, sums) in D.iter().zip(higher.chunks_exact_mut(n.max(1))) {
            combine(row, &self.k, sums);
        }
        (0..n).map(|i| self.polynomial(i, y[i], h, |power| higher[power * n + i])).collect()
    }

    fn polynomial(&self, i: usize, start: f64, h: f64, higher: impl Fn(usize) -> f64) -> Polynomial {
        let k = |s: usize| self.k[s * self.n + i];
        let delta = self.end[i] - start;
        let mut f = [0.0; POWERS];
        f[0] = delta;
        f[1] = h * k(0) - delta;
        f[2] = 2.0 * delta - h * (k(STAGES) + k(0));
        for (power, value) in f[3..].iter_mut().enumerate() {
            *value = h * higher(power);
        }
        Polynomial { start, coefficients: f }
    }
}

/// Sums of stage derivatives (rows of `k`) with weights.
fn combine(weights: &[(usize, f64)], k: &[f64], sums: &mut [f64]) {
    match sums.len() {
        2 => combine_few::<2>(weights, k, sums),
        4 => combine_few::<4>(weights, k, sums),
        6 => combine_few::<6>(weights, k, sums),
        8 => combine_few::<8>(weights, k, sums),
        n => {
            sums.fill(0.0);
            for &(s, weight) in weights {
                sums.iter_mut().zip(&k[s * n..]).for_each(|(sum, k)| *sum += weight * k);
            }
        }
    }
}

/// The same where the compiler knows how many there are.
fn combine_few<const N: usize>(weights: &[(usize, f64)], k: &[f64], sums: &mut [f64]) {
    let mut few = [0.0; N];
    let (rows, _) = k.as_chunks::<N>();
    for &(s, weight) in weights {
        few.iter_mut().zip(&rows[s]).for_each(|(sum, k)| *sum += weight * k);
    }
    sums.copy_from_slice(&few);
}

/// `y(x) = start + x (F₀ + (1−x) (F₁ + x (F₂ + …)))` for x from 0 to 1 over the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial {
    pub start: f64,
    coefficients: [f64; POWERS],
}

impl Polynomial {
    /// From its first coefficients F₀ … F₃.
    pub fn short(start: f64, first: [f64; 4]) -> Self {
        let mut coefficients = [0.0; POWERS];
        coefficients[..4].copy_from_slice(&first);
        Self { start, coefficients }
    }

    /// dy/dx of a polynomial made by `short`.
    pub fn short_slope(&self) -> Self {
        let p = self.powers();
        let [a, b, c, d] = [p[1], 2.0 * p[2], 3.0 * p[3], 4.0 * p[4]];
        Self::short(a, [b + c + d, -(c + d), -d, 0.0])
    }

    pub fn scaled(&self, factor: f64) -> Self {
        Self { start: factor * self.start, coefficients: self.coefficients.map(|c| factor * c) }
    }

    pub fn at(&self, x: f64) -> f64 {
        let mut y = 0.0;
        for (i, f) in self.coefficients.iter().rev().enumerate() {
            y = (y + f) * if i % 2 == 0 { x } else { 1.0 - x };
        }
        self.start + y
    }

    /// Coefficients of powers of x, from 0 to 7.
    fn powers(&self) -> [f64; POWERS + 1] {
        let mut p = [0.0; POWERS + 1];
        for (i, f) in self.coefficients.iter().rev().enumerate() {
            p[0] += f;
            // Times x or times 1 − x, from the highest power down.
            for k in (1..p.len()).rev() {
                p[k] = if i % 2 == 0 { p[k - 1] } else { p[k] - p[k - 1] };
            }
            p[0] *= if i % 2 == 0 { 0.0 } else { 1.0 };
        }
        p[0] += self.start;
        p
    }

    /// Bounds of |y|, |dy/dx| and |d²y/dx²| over the step: a polynomial lies within its Bernstein coefficients.
    pub fn bounds(&self) -> [f64; 3] {
        let p = self.powers();
        let slope: [f64; POWERS] = derivative(&p);
        let bend: [f64; POWERS - 1] = derivative(&slope);
        [bernstein_bound(&p), bernstein_bound(&slope), bernstein_bound(&bend)]
    }

    /// dy/dx.
    pub fn slope(&self, x: f64) -> f64 {
        let (mut y, mut dy) = (0.0, 0.0);
        for (i, f) in self.coefficients.iter().rev().enumerate() {
            let (factor, sign) = if i % 2 == 0 { (x, 1.0) } else { (1.0 - x, -1.0) };
            dy = dy * factor + (y + f) * sign;
            y = (y + f) * factor;
        }
        dy
    }
}

/// Coefficients of the derivative's powers, one fewer.
fn derivative<const M: usize>(p: &[f64]) -> [f64; M] {
    std::array::from_fn(|k| (k + 1) as f64 * p[k + 1])
}

/// Greatest magnitude of the Bernstein coefficients `bᵢ = Σ_{k ≤ i} C(i, k) / C(n, k) pₖ` of a polynomial.
fn bernstein_bound<const M: usize>(p: &[f64; M]) -> f64 {
    let shares = const { inverse_binomials::<M>() };
    let mut b: [f64; M] = std::array::from_fn(|k| shares[k] * p[k]);
    // Sums with binomial weights, as in Pascal's triangle.
    for round in 1..M {
        for i in (round..M).rev() {
            b[i] += b[i - 1];
        }
    }
    b.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// `1 / C(M − 1, k)`.
const fn inverse_binomials<const M: usize>() -> [f64; M] {
    let (mut found, mut binomial, mut k) = ([1.0; M], 1.0, 1);
    while k < M {
        binomial *= (M - k) as f64 / k as f64;
        found[k] = 1.0 / binomial;
        k += 1;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{Equations, Step};

    struct Oscillator;
    impl Equations for Oscillator {
        fn derivative(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) {
            dy[0] = y[1];
            dy[1] = -y[0];
        }
    }

    fn error(h: f64) -> (f64, f64) {
        let (y, mut step) = ([0.0, 1.0], Step::default());
        step.resize(2);
        step.begin(&mut Oscillator, 0.0, &y);
        step.attempt(&mut Oscillator, 0.0, &y, h, &[1.0, 1.0]);
        let end = (step.end[0] - h.sin()).abs();
        let dense = step.dense(&mut Oscillator, 0.0, &y, h);
        let inside = (1..20).map(|i| f64::from(i) / 20.0);
        (end, inside.map(|x| (dense[0].at(x) - (x * h).sin()).abs()).fold(0.0, f64::max))
    }

    #[test]
    fn orders_are_eight_at_the_end_and_seven_between() {
        let ((end, inside), (half_end, half_inside)) = (error(0.8), error(0.4));
        assert!((end / half_end).log2() > 8.5, "local order 9, was {}", (end / half_end).log2());
        assert!((inside / half_inside).log2() > 7.0, "was {}", (inside / half_inside).log2());
    }

    /// Bounds hold at every place of the step and are near the greatest values.
    #[test]
    fn bounds_hold_over_the_step() {
        for h in [0.1, 0.8, 2.0] {
            let (y, mut step) = ([0.3, 1.0], Step::default());
            step.resize(2);
            step.begin(&mut Oscillator, 0.0, &y);
            step.attempt(&mut Oscillator, 0.0, &y, h, &[1.0, 1.0]);
            for p in step.dense(&mut Oscillator, 0.0, &y, h) {
                let [value, slope, second] = p.bounds();
                let xs = || (0..=200).map(|i| f64::from(i) / 200.0);
                let most = |f: &dyn Fn(f64) -> f64| xs().map(|x| f(x).abs()).fold(0.0, f64::max);
                let bend = |x: f64| (p.slope(x + 1e-5) - p.slope(x - 1e-5)) / 2e-5;
                for (bound, found) in
                    [(value, most(&|x| p.at(x))), (slope, most(&|x| p.slope(x))), (second, most(&bend))]
                {
                    assert!(found <= bound * (1.0 + 1e-6), "{found} against {bound}");
                    assert!(bound <= 1.5 * found, "{bound} is far above {found}");
                }
            }
        }
    }
}
