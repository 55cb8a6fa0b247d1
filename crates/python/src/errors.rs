//! Errors of the core as Python exceptions.

use mainspring::{Error, Mechanism};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

pyo3::create_exception!(
    _core,
    InputError,
    PyValueError,
    "Bad input: `FILE:LINE:COL: error: what, what was expected`."
);

/// Bad input as `InputError`.
pub fn bad_input(error: Error) -> PyErr {
    InputError::new_err(error.to_string())
}

/// Part names with values as part indices with values.
pub fn by_index(
    mechanism: &Mechanism,
    values: &[(String, f64)],
    option: &str,
) -> PyResult<Vec<(usize, f64)>> {
    let index = |(name, value): &(String, f64)| {
        let moving: Vec<&str> =
            mechanism.parts.iter().filter(|p| !p.is_frame).map(|p| p.name.as_str()).collect();
        let message =
            || format!("{option}:1:1: error: no part {name:?}, expected one of {}", moving.join(", "));
        let part = mechanism.part_index(name).ok_or_else(|| InputError::new_err(message()))?;
        Ok((part, *value))
    };
    values.iter().map(index).collect()
}
