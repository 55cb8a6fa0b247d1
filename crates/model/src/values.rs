//! Values of the numeric definitions.

use mainspring_geometry::Scalar;

/// Names and values given by `--set`; names in any letter case.
pub type Overrides = Vec<(String, f64)>;

/// The value of every numeric definition, in the order of [`crate::Machine::parameters`].
#[derive(Clone, Debug, PartialEq)]
pub struct Values<S = f64> {
    pub(crate) numbers: Vec<S>,
}

impl<S: Scalar> Values<S> {
    /// The value of a parameter by its index.
    pub fn get(&self, parameter: usize) -> Option<S> {
        self.numbers.get(parameter).copied()
    }

    /// All values, one for each parameter.
    pub fn as_slice(&self) -> &[S] {
        &self.numbers
    }

    /// The values without derivatives.
    pub fn re(&self) -> Values<f64> {
        Values { numbers: self.numbers.iter().map(|v| v.re()).collect() }
    }
}
