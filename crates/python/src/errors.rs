//! Errors of the core as Python exceptions.

use mainspring::{Error, Mechanism};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

pyo3::create_exception!(
    mainspring,
    InputError,
    PyValueError,
    "Bad input: `FILE:LINE:COL: error: what; expected what`."
);

/// Bad input as `InputError`.
pub fn bad_input(error: Error) -> PyErr {
    InputError::new_err(error.to_string())
}

/// A count from Python, where whole numbers have a sign and no end.
pub fn count<T: TryFrom<i64>>(value: i64, option: &str) -> PyResult<T> {
    T::try_from(value).map_err(|_| {
        InputError::new_err(format!(
            "{option}:1:1: error: the count is {value}; expected a whole number that is not negative"
        ))
    })
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
            || format!("{option}:1:1: error: no part {name:?}; expected one of {}", moving.join(", "));
        let part = mechanism.part_index(name).ok_or_else(|| InputError::new_err(message()))?;
        Ok((part, *value))
    };
    values.iter().map(index).collect()
}
