//! Second derivatives of a gap: `H = ∂²g/∂q²`, for implicit solvers.
//!
//! `γ(q̇) = q̇ᵀ H q̇` is the part of g̈ that accelerations do not cause, so H follows from γ by polarisation:
//! `H_ij = ½ (γ(e_i + e_j) − γ(e_i) − γ(e_j))`. Exact to rounding.

use crate::gap::GapState;
use crate::placed::{MAX_ROW, Placed, Row};

/// A symmetric matrix over the coordinates of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hessian {
    pub entries: [[f64; MAX_ROW]; MAX_ROW],
}

impl GapState {
    /// H over the coordinates of `row`, in their order. `scratch` is all zero, one entry a coordinate of the system,
    /// and is left so.
    pub fn hessian(&self, a: &Placed, b: &Placed, row: &Row, scratch: &mut [f64]) -> Hessian {
        let mut hessian = Hessian::default();
        let h = &mut hessian.entries;
        for i in 0..row.count {
            scratch[row.coordinate[i]] = 1.0;
            h[i][i] = self.bias(a, b, scratch);
            for j in 0..i {
                scratch[row.coordinate[j]] = 1.0;
                h[i][j] = 0.5 * (self.bias(a, b, scratch) - h[i][i] - h[j][j]);
                h[j][i] = h[i][j];
                scratch[row.coordinate[j]] = 0.0;
            }
            scratch[row.coordinate[i]] = 0.0;
        }
        hessian
    }
}
