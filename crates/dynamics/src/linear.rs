//! Dense symmetric systems of a few unknowns.

/// A list that stays off the heap while it is short.
pub type Small<T, const N: usize = 4> = smallvec::SmallVec<[T; N]>;

/// Replaces an `n × n` matrix in row order by its factor L, `A = L Lᵀ`, in the lower triangle. False when a pivot falls
/// below 1e-12 of its diagonal entry.
pub fn factorize(a: &mut [f64], n: usize) -> bool {
    for j in 0..n {
        let diagonal = a[j * n + j];
        for k in 0..j {
            a[j * n + j] -= a[j * n + k] * a[j * n + k];
        }
        let pivot = a[j * n + j];
        if pivot <= 1e-12 * diagonal || !pivot.is_finite() {
            return false;
        }
        let root = pivot.sqrt();
        a[j * n + j] = root;
        for i in j + 1..n {
            for k in 0..j {
                a[i * n + j] -= a[i * n + k] * a[j * n + k];
            }
            a[i * n + j] /= root;
        }
    }
    true
}

/// Replaces b by the solution of `L Lᵀ x = b`, for a factor made by `factorize`.
pub fn solve_factorized(l: &[f64], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        for k in 0..i {
            x[i] -= l[i * n + k] * x[k];
        }
        x[i] /= l[i * n + i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            x[i] -= l[k * n + i] * x[k];
        }
        x[i] /= l[i * n + i];
    }
}

/// A factor `L Lᵀ` of a positive definite matrix.
#[derive(Clone, Debug)]
pub struct Cholesky {
    factor: Small<f64, 16>,
}

impl Cholesky {
    /// Factors an `n × n` matrix in row order; None when a pivot falls below 1e-12 of its diagonal entry.
    pub fn new(mut a: Small<f64, 16>, n: usize) -> Option<Self> {
        factorize(&mut a, n).then_some(Self { factor: a })
    }

    /// Solves `A x = b`.
    pub fn solve(&self, b: &[f64]) -> Small<f64> {
        let mut x = Small::from_slice(b);
        solve_factorized(&self.factor, &mut x);
        x
    }
}
