//! The small convex problem behind impacts and contact forces.
//!
//! Find λ ≥ 0 with `w = A λ + b ≥ 0` and `λᵀ w = 0`, where `A = G M⁻¹ Gᵀ` is positive semidefinite: the conditions of
//! least `(x − x₀)ᵀ M (x − x₀)` subject to `G x + c ≥ 0`. Active-set method of Lawson and Hanson (Solving Least Squares
//! Problems, 1974, ch. 23) on the dual; columns that depend on active ones are exchanged, never added.

use crate::linear::{Cholesky, Small};

/// A solution; `w` and `lambda` have one entry a contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    pub lambda: Vec<f64>,
    pub w: Vec<f64>,
    /// Contacts with independent rows whose λ the solution rests on, in increasing order.
    pub active: Vec<usize>,
    /// False if no x satisfies the conditions to the tolerance, or the bound on steps was met.
    pub solved: bool,
}

/// Solves for an `n × n` matrix in row order. `tolerance[i]` says which |w_i| counts as zero.
pub fn solve(a: &[f64], b: &[f64], tolerance: &[f64]) -> Solution {
    let n = b.len();
    let mut s = Solution { lambda: vec![0.0; n], w: b.to_vec(), active: vec![], solved: true };
    for _ in 0..(20 * n + 20) {
        let Some(entering) = most_negative(&s, tolerance) else { return s };
        match enter(a, b, entering, &mut s) {
            Entry::Done => refresh(a, b, &mut s),
            Entry::Rounding => s.w[entering] = 0.0,
            Entry::Impossible => break,
        }
    }
    s.solved = false;
    s
}

fn most_negative(s: &Solution, tolerance: &[f64]) -> Option<usize> {
    let scaled = |i: usize| s.w[i] / tolerance[i].max(f64::MIN_POSITIVE);
    (0..s.w.len())
        .filter(|&i| s.w[i] < -tolerance[i] && !s.active.contains(&i))
        .min_by(|&i, &j| scaled(i).total_cmp(&scaled(j)))
}

/// What came of bringing a contact into the active set.
enum Entry {
    Done,
    /// Its row depends on active ones, whose w is 0 only to rounding; its own w is no more than that.
    Rounding,
    /// No λ can satisfy it beside the active ones.
    Impossible,
}

/// Brings one contact into the active set, letting others leave so that no λ becomes negative.
fn enter(a: &[f64], b: &[f64], entering: usize, s: &mut Solution) -> Entry {
    let n = b.len();
    if let Some(factor) = factor(a, n, &s.active) {
        let column: Small<f64> = s.active.iter().map(|&i| a[i * n + entering]).collect();
        let response = factor.solve(&column);
        let rest: f64 =
            a[entering * n + entering] - response.iter().zip(&column).map(|(x, y)| x * y).sum::<f64>();
        if rest <= 1e-11 * a[entering * n + entering] {
            if s.w[entering].abs() <= rounding(a, b, entering, &response, s) {
                return Entry::Rounding;
            }
            // Dependent: moving along the null direction lowers the cost until an active λ reaches zero.
            let blocking = s
                .active
                .iter()
                .zip(&response)
                .filter(|(_, d)| **d > 1e-14)
                .map(|(&i, d)| (s.lambda[i] / d, i))
                .min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let Some((step, leaving)) = blocking else { return Entry::Impossible };
            for (&i, d) in s.active.iter().zip(&response) {
                s.lambda[i] = (s.lambda[i] - step * d).max(0.0);
            }
            s.lambda[entering] = step;
            s.lambda[leaving] = 0.0;
            s.active.retain(|&i| i != leaving);
        }
    }
    s.active.push(entering);
    s.active.sort_unstable();
    if descend(a, b, s) { Entry::Done } else { Entry::Impossible }
}

/// Bound on the rounding error in w of a row that is the `response` combination of the active rows.
fn rounding(a: &[f64], b: &[f64], entering: usize, response: &[f64], s: &Solution) -> f64 {
    let n = b.len();
    let sum =
        |i: usize| b[i].abs() + s.active.iter().map(|&j| (a[i * n + j] * s.lambda[j]).abs()).sum::<f64>();
    let active: f64 = s.active.iter().zip(response).map(|(&i, d)| d.abs() * sum(i)).sum();
    8.0 * n as f64 * f64::EPSILON * (sum(entering) + active)
}

/// Moves λ to the minimum over the active set, dropping contacts whose λ would become negative.
fn descend(a: &[f64], b: &[f64], s: &mut Solution) -> bool {
    let n = b.len();
    for _ in 0..=n {
        let Some(factor) = factor(a, n, &s.active) else { return false };
        let right: Small<f64> = s.active.iter().map(|&i| -b[i]).collect();
        let target = factor.solve(&right);
        let step = |i: usize, t: f64| if t < 0.0 { s.lambda[i] / (s.lambda[i] - t) } else { 1.0 };
        let limit = s.active.iter().zip(&target).map(|(&i, &t)| step(i, t)).fold(1.0, f64::min);
        for (&i, t) in s.active.iter().zip(&target) {
            s.lambda[i] += limit * (t - s.lambda[i]);
        }
        if limit >= 1.0 {
            return true;
        }
        let (active, lambda) = (&mut s.active, &mut s.lambda);
        let scale = active.iter().map(|&i| lambda[i]).fold(0.0, f64::max);
        active.retain(|&i| {
            let keep = lambda[i] > 1e-15 * scale;
            if !keep {
                lambda[i] = 0.0;
            }
            keep
        });
    }
    false
}

fn factor(a: &[f64], n: usize, active: &[usize]) -> Option<Cholesky> {
    let entries = active.iter().flat_map(|&i| active.iter().map(move |&j| a[i * n + j])).collect();
    Cholesky::new(entries, active.len())
}

fn refresh(a: &[f64], b: &[f64], s: &mut Solution) {
    let n = b.len();
    for i in 0..n {
        s.w[i] = b[i] + (0..n).map(|j| a[i * n + j] * s.lambda[j]).sum::<f64>();
    }
    for &i in &s.active {
        s.w[i] = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::solve;

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
        assert_eq!(solve(&[2.0], &[3.0], &[1e-12]).lambda, vec![0.0]);
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
        assert!(s.solved && s.active == [1, 3] && s.lambda[1] > 2000.0, "{s:?}");
    }

    #[test]
    fn contacts_that_no_force_can_satisfy_are_told() {
        assert!(!solve(&[1.0, -1.0, -1.0, 1.0], &[-1.0, -1.0], &[1e-12; 2]).solved);
    }
}
