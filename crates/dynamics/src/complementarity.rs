//! The small convex problem behind impacts, contact forces and dry friction.
//!
//! Find λ within `l ≤ λ ≤ u` with `w = A λ + b`, where w ≥ 0 at the lower bound, w ≤ 0 at the upper and w = 0 between;
//! `A = G M⁻¹ Gᵀ` is positive semidefinite. For contacts (l = 0, u = ∞) these are the conditions of least
//! `(x − x₀)ᵀ M (x − x₀)` subject to `G x + c ≥ 0`; a part held by dry friction of size T has l = −T, u = T. Active-set
//! method of Lawson and Hanson (Solving Least Squares Problems, 1974, ch. 23) on the dual, with bounds as Stark and
//! Parker add them (Computational Statistics 10, 1995); columns that depend on active ones are exchanged, never added.

use crate::linear::{Cholesky, Small};

/// A solution; `w` and `lambda` have one entry a row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    pub lambda: Small<f64, 8>,
    pub w: Small<f64, 8>,
    /// Independent rows whose λ the solution rests on, in increasing order.
    pub active: Small<usize, 8>,
    /// False if no x satisfies the conditions to the tolerance, or the bound on steps was met.
    pub solved: bool,
}

/// A with b and the bounds of λ: 0 and ∞ for the first rows, ∓ `sizes` for the last.
struct Problem<'p> {
    a: &'p [f64],
    b: &'p [f64],
    sizes: &'p [f64],
}

/// Solves for an `n × n` matrix in row order with λ ≥ 0. `tolerance[i]` says which |w_i| counts as zero.
pub fn solve(a: &[f64], b: &[f64], tolerance: &[f64]) -> Solution {
    solve_bounded(a, b, tolerance, &[])
}

/// The same where the last rows have `|λ| ≤ size`.
pub fn solve_bounded(a: &[f64], b: &[f64], tolerance: &[f64], sizes: &[f64]) -> Solution {
    let n = b.len();
    let lambda = smallvec::smallvec![0.0; n];
    let mut s = Solution { lambda, w: Small::from_slice(b), active: Small::new(), solved: true };
    // Most often there is one contact or none.
    if let ([a], [b], []) = (a, b, sizes)
        && *a > 0.0
        && *b < -tolerance[0]
    {
        (s.lambda[0], s.w[0]) = (-b / a, 0.0);
        s.active.push(0);
        return s;
    }
    let problem = Problem { a, b, sizes };
    for _ in 0..(20 * n + 20) {
        let Some(entering) = problem.worst(&s, tolerance) else { return s };
        match problem.enter(entering, &mut s) {
            Entry::Done => problem.refresh(&mut s),
            Entry::Rounding => s.w[entering] = 0.0,
            Entry::Impossible => break,
        }
    }
    s.solved = false;
    s
}

/// What came of bringing a row into the active set.
enum Entry {
    Done,
    /// Its row depends on active ones, whose w is 0 only to rounding; its own w is no more than that.
    Rounding,
    /// No λ can satisfy it beside the active ones.
    Impossible,
}

impl Problem<'_> {
    fn bounds(&self, i: usize) -> (f64, f64) {
        match i.checked_sub(self.b.len() - self.sizes.len()) {
            Some(k) => (-self.sizes[k], self.sizes[k]),
            None => (0.0, f64::INFINITY),
        }
    }

    /// The row whose w is furthest on the wrong side against its tolerance.
    fn worst(&self, s: &Solution, tolerance: &[f64]) -> Option<usize> {
        let wrong = |i: usize| {
            let (low, high) = self.bounds(i);
            let rises = s.w[i] < -tolerance[i] && s.lambda[i] < high;
            rises || (s.w[i] > tolerance[i] && s.lambda[i] > low)
        };
        let scaled = |i: usize| -s.w[i].abs() / tolerance[i].max(f64::MIN_POSITIVE);
        (0..s.w.len())
            .filter(|&i| wrong(i) && !s.active.contains(&i))
            .min_by(|&i, &j| scaled(i).total_cmp(&scaled(j)))
    }

    /// Brings one row into the active set, letting others leave so that every λ stays within its bounds.
    fn enter(&self, entering: usize, s: &mut Solution) -> Entry {
        let (a, n) = (self.a, self.b.len());
        if let Some(factor) = self.factor(&s.active) {
            let column: Small<f64> = s.active.iter().map(|&i| a[i * n + entering]).collect();
            let response = factor.solve(&column);
            let rest: f64 =
                a[entering * n + entering] - response.iter().zip(&column).map(|(x, y)| x * y).sum::<f64>();
            if rest <= 1e-11 * a[entering * n + entering] {
                if s.w[entering].abs() <= self.rounding(entering, &response, s) {
                    return Entry::Rounding;
                }
                match self.exchange(entering, &response, s) {
                    Some(true) => {}
                    Some(false) => return Entry::Done,
                    None => return Entry::Impossible,
                }
            }
        }
        s.active.push(entering);
        s.active.sort_unstable();
        if self.descend(s) { Entry::Done } else { Entry::Impossible }
    }

    /// A dependent row: moving along the null direction lowers the cost until a λ reaches a bound, which then
    /// leaves. False if that is the entering row's own; None if there is no such bound.
    fn exchange(&self, entering: usize, response: &[f64], s: &mut Solution) -> Option<bool> {
        let side = if s.w[entering] < 0.0 { 1.0 } else { -1.0 };
        let room = |i: usize, rate: f64| {
            let (low, high) = self.bounds(i);
            if rate < 0.0 { (s.lambda[i] - low) / -rate } else { (high - s.lambda[i]) / rate }
        };
        let blocking = s
            .active
            .iter()
            .zip(response)
            .filter(|(_, d)| d.abs() > 1e-14)
            .map(|(&i, d)| (room(i, -side * d), i))
            .min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let own = room(entering, side);
        let (step, leaving) = blocking.filter(|b| b.0 <= own).unwrap_or((own, entering));
        if !step.is_finite() {
            return None;
        }
        for (&i, d) in s.active.iter().zip(response) {
            let (low, high) = self.bounds(i);
            s.lambda[i] = (s.lambda[i] - side * step * d).clamp(low, high);
        }
        s.lambda[entering] += side * step;
        let (low, high) = self.bounds(leaving);
        s.lambda[leaving] = if s.lambda[leaving] - low <= high - s.lambda[leaving] { low } else { high };
        s.active.retain(|&mut i| i != leaving);
        Some(leaving != entering)
    }

    /// Bound on the rounding error in w of a row that is the `response` combination of the active rows.
    fn rounding(&self, entering: usize, response: &[f64], s: &Solution) -> f64 {
        let n = self.b.len();
        let sum = |i: usize| {
            self.b[i].abs() + s.active.iter().map(|&j| (self.a[i * n + j] * s.lambda[j]).abs()).sum::<f64>()
        };
        let active: f64 = s.active.iter().zip(response).map(|(&i, d)| d.abs() * sum(i)).sum();
        8.0 * n as f64 * f64::EPSILON * (sum(entering) + active)
    }

    /// Moves λ to the minimum over the active set, dropping rows whose λ would pass a bound.
    fn descend(&self, s: &mut Solution) -> bool {
        let n = self.b.len();
        for _ in 0..=n {
            let Some(factor) = self.factor(&s.active) else { return false };
            // Rows at a bound that is not zero push as well.
            let pushed = |i: usize| -> f64 {
                let set = |j: &usize| s.lambda[*j] != 0.0 && !s.active.contains(j);
                (n - self.sizes.len()..n).filter(set).map(|j| self.a[i * n + j] * s.lambda[j]).sum()
            };
            let right: Small<f64> = s.active.iter().map(|&i| -self.b[i] - pushed(i)).collect();
            let target = factor.solve(&right);
            let step = |i: usize, t: f64| {
                let ((low, high), now) = (self.bounds(i), s.lambda[i]);
                if t < low {
                    (now - low) / (now - t)
                } else if t > high {
                    (high - now) / (t - now)
                } else {
                    1.0
                }
            };
            let limit = s.active.iter().zip(&target).map(|(&i, &t)| step(i, t)).fold(1.0, f64::min);
            for (&i, t) in s.active.iter().zip(&target) {
                s.lambda[i] += limit * (t - s.lambda[i]);
            }
            if limit >= 1.0 {
                return true;
            }
            self.drop_bounded(s);
        }
        false
    }

    /// Rows whose λ has come to a bound leave the active set and stay there.
    fn drop_bounded(&self, s: &mut Solution) {
        let (active, lambda) = (&mut s.active, &mut s.lambda);
        let scale = active.iter().map(|&i| lambda[i].abs()).fold(0.0, f64::max);
        active.retain(|&mut i| {
            let (low, high) = self.bounds(i);
            if lambda[i] - low <= 1e-15 * scale {
                lambda[i] = low;
            } else if high - lambda[i] <= 1e-15 * scale {
                lambda[i] = high;
            }
            lambda[i] > low && lambda[i] < high
        });
    }

    fn factor(&self, active: &[usize]) -> Option<Cholesky> {
        let n = self.b.len();
        let entries = active.iter().flat_map(|&i| active.iter().map(move |&j| self.a[i * n + j])).collect();
        Cholesky::new(entries, active.len())
    }

    fn refresh(&self, s: &mut Solution) {
        let n = self.b.len();
        for i in 0..n {
            s.w[i] = self.b[i] + (0..n).map(|j| self.a[i * n + j] * s.lambda[j]).sum::<f64>();
        }
        for &i in &s.active {
            s.w[i] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{solve, solve_bounded};

    fn check(a: &[f64], b: &[f64]) {
        let n = b.len();
        let s = solve(a, b, &vec![1e-10; n]);
        assert!(s.solved, "{a:?} {b:?}");
        for i in 0..n {
            let w: f64 = b[i] + (0..n).map(|j| a[i * n + j] * s.lambda[j]).sum::<f64>();
            assert!(s.lambda[i] >= 0.0 && w >= -1e-9 && (s.lambda[i] * w).abs() < 1e-9, "{s:?}");
        }
    }

    #[test]
    fn one_contact_pushes_only_when_it_must() {
        assert!((solve(&[2.0], &[-3.0], &[1e-12]).lambda[0] - 1.5).abs() < 1e-14);
        assert_eq!(solve(&[2.0], &[3.0], &[1e-12]).lambda[..], [0.0]);
    }

    #[test]
    fn random_problems_with_dependent_rows_satisfy_the_conditions() {
        // A = G Gᵀ with more contacts than coordinates, b in the range of feasible problems: b = G x.
        let mut seed = 7u64;
        let mut next = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / f64::from(1u32 << 30) - 1.0
        };
        for case in 0..3000 {
            let (n, m) = (1 + case % 7, 1 + case % 3);
            let g: Vec<f64> = (0..n * m).map(|_| next()).collect();
            let x: Vec<f64> = (0..m).map(|_| next()).collect();
            let dot = |i: usize, j: usize| (0..m).map(|k| g[i * m + k] * g[j * m + k]).sum::<f64>();
            let a: Vec<f64> = (0..n * n).map(|k| dot(k / n, k % n)).collect();
            let b: Vec<f64> = (0..n).map(|i| (0..m).map(|k| g[i * m + k] * x[k]).sum()).collect();
            check(&a, &b);
        }
    }

    /// Dry friction among contacts: λ of the last rows within ± size, dependent rows among them.
    #[test]
    fn random_problems_with_friction_satisfy_the_conditions() {
        let mut seed = 11u64;
        let mut next = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / f64::from(1u32 << 30) - 1.0
        };
        for case in 0..4000 {
            let (contacts, m) = (case % 5, 1 + case % 4);
            let stuck = 1 + case % m;
            let n = contacts + stuck;
            let mut g: Vec<f64> = (0..n * m).map(|_| next()).collect();
            for k in 0..stuck {
                (0..m).for_each(|j| g[(contacts + k) * m + j] = f64::from(u8::from(j == k)));
            }
            let x: Vec<f64> = (0..m).map(|_| next()).collect();
            let dot = |i: usize, j: usize| (0..m).map(|k| g[i * m + k] * g[j * m + k]).sum::<f64>();
            let a: Vec<f64> = (0..n * n).map(|k| dot(k / n, k % n)).collect();
            let b: Vec<f64> = (0..n).map(|i| (0..m).map(|k| g[i * m + k] * x[k]).sum()).collect();
            let sizes: Vec<f64> = (0..stuck).map(|_| 0.5 * next().abs()).collect();
            let s = solve_bounded(&a, &b, &vec![1e-10; n], &sizes);
            assert!(s.solved, "{case}: {a:?} {b:?}");
            for i in 0..n {
                let w: f64 = b[i] + (0..n).map(|j| a[i * n + j] * s.lambda[j]).sum::<f64>();
                let (low, high) = if i < contacts {
                    (0.0, f64::INFINITY)
                } else {
                    (-sizes[i - contacts], sizes[i - contacts])
                };
                assert!(s.lambda[i] >= low && s.lambda[i] <= high, "{case}: {s:?}");
                let fits = w.abs() < 1e-9 || if w > 0.0 { s.lambda[i] == low } else { s.lambda[i] == high };
                assert!(fits, "{case}: {i} {w} {s:?}");
            }
        }
    }

    #[test]
    fn twice_the_same_contact_carries_the_load_once() {
        let s = solve(&[1.0, 1.0, 1.0, 1.0], &[-2.0, -2.0], &[1e-12, 1e-12]);
        assert!(s.solved && s.active.len() == 1);
        assert!((s.lambda.iter().sum::<f64>() - 2.0).abs() < 1e-12);
    }
    #[test]
    fn a_third_contact_in_a_narrow_wedge_is_judged_to_rounding() {
        // Two almost opposite faces hold the body with forces of some 2000 times the load; the others follow.
        let g = [
            [-0.15491016674786806, -0.10211377963423729],
            [-0.478861971758306, -0.9644392542541027],
            [-0.5820838734507561, 0.08945785835385323],
            [0.4932478051632643, 0.99257508572191],
        ];
        let x = [-0.9647237844765186, -0.22816268634051085];
        let dot = |u: &[f64; 2], v: &[f64; 2]| u[0] * v[0] + u[1] * v[1];
        let a: Vec<f64> = (0..16).map(|k| dot(&g[k / 4], &g[k % 4])).collect();
        let b: Vec<f64> = g.iter().map(|row| dot(row, &x)).collect();
        let s = solve(&a, &b, &[1e-10; 4]);
        assert!(s.solved && s.active[..] == [1, 3] && s.lambda[1] > 2000.0, "{s:?}");
    }

    #[test]
    fn contacts_that_no_force_can_satisfy_are_told() {
        assert!(!solve(&[1.0, -1.0, -1.0, 1.0], &[-1.0, -1.0], &[1e-12; 2]).solved);
    }
}
