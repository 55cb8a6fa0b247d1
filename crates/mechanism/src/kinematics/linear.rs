//! Small dense linear algebra: null spaces and least squares, for the equations of closed chains.

/// Rows of equal length.
pub(crate) type Matrix = Vec<Vec<f64>>;

/// Reduces to echelon form with full pivoting; returns the pivot columns. Entries below `tolerance` times the
/// largest entry count as zero.
fn eliminate(rows: &mut Matrix, columns: usize, tolerance: f64) -> Vec<usize> {
    let largest = rows.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut pivots: Vec<usize> = Vec::new();
    for step in 0..rows.len().min(columns) {
        let mut best = (0.0, 0, 0);
        for (i, row) in rows.iter().enumerate().skip(step) {
            for (j, x) in row.iter().enumerate() {
                if x.abs() > best.0 {
                    best = (x.abs(), i, j);
                }
            }
        }
        let (size, i, j) = best;
        if size <= tolerance * largest {
            break;
        }
        rows.swap(step, i);
        let pivot = rows[step].clone();
        for (k, row) in rows.iter_mut().enumerate() {
            let factor = row[j] / pivot[j];
            if k != step && factor != 0.0 {
                row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
                row[j] = 0.0;
            }
        }
        pivots.push(j);
    }
    pivots
}

/// A basis of the null space, one vector each, scaled to largest entry 1.
pub(crate) fn null_space(rows: &Matrix, columns: usize, tolerance: f64) -> Matrix {
    let mut rows = rows.clone();
    let pivots = eliminate(&mut rows, columns, tolerance);
    let free = (0..columns).filter(|j| !pivots.contains(j));
    free.map(|f| {
        let mut v = vec![0.0; columns];
        v[f] = 1.0;
        for (row, &p) in rows.iter().zip(&pivots) {
            v[p] = -row[f] / row[p];
        }
        let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        v.iter().map(|x| x / largest).collect()
    })
    .collect()
}

pub(crate) fn rank(rows: &Matrix, columns: usize, tolerance: f64) -> usize {
    eliminate(&mut rows.clone(), columns, tolerance).len()
}

/// The step x of least length that brings `rows x` nearest to `target`, lightly damped (Levenberg).
pub(crate) fn least_squares(rows: &Matrix, target: &[f64], columns: usize) -> Vec<f64> {
    let mut normal = vec![vec![0.0; columns + 1]; columns];
    for (row, t) in rows.iter().zip(target) {
        for i in 0..columns {
            for j in 0..columns {
                normal[i][j] += row[i] * row[j];
            }
            normal[i][columns] += row[i] * t;
        }
    }
    let scale = (0..columns).map(|i| normal[i][i]).fold(0.0, f64::max);
    for (i, row) in normal.iter_mut().enumerate() {
        row[i] += 1e-10 * scale;
    }
    solve_symmetric(normal, columns)
}

/// Gauss elimination without pivoting: enough for a positive definite matrix with its right side appended.
fn solve_symmetric(mut a: Matrix, n: usize) -> Vec<f64> {
    for k in 0..n {
        let pivot = a[k].clone();
        for row in a.iter_mut().skip(k + 1) {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|j| a[k][j] * x[j]).sum();
        x[k] = (a[k][n] - rest) / a[k][k];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn null_space_is_what_the_rows_annihilate() {
        let rows = vec![vec![1.0, 2.0, -1.0, 0.5], vec![2.0, 4.0, -2.0, 1.0], vec![0.0, 1.0, 1.0, -3.0]];
        let basis = null_space(&rows, 4, 1e-12);
        assert_eq!((basis.len(), rank(&rows, 4, 1e-12)), (2, 2));
        for v in &basis {
            for row in &rows {
                let product: f64 = row.iter().zip(v).map(|(a, b)| a * b).sum();
                assert!(product.abs() < 1e-12, "{product}");
            }
        }
    }

    #[test]
    fn least_squares_meets_consistent_equations() {
        let rows = vec![vec![2.0, 1.0, 0.0], vec![0.0, 1.0, 3.0]];
        let x = least_squares(&rows, &[3.0, 5.0], 3);
        assert!((2.0 * x[0] + x[1] - 3.0).abs() < 1e-7 && (x[1] + 3.0 * x[2] - 5.0).abs() < 1e-7);
    }
}
