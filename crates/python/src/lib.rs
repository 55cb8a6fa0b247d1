//! The compiled core of the Python package: conversion and error mapping, no thought.

mod errors;
mod machine;
mod results;
mod space;

use errors::InputError;
use machine::{PyMachine, PyMechanism};
use pyo3::prelude::*;
use results::{PyPrediction, PyRun};
use space::PySpace;

/// The compiled core: numbers in the file's units and radians, text as JSON.
#[pymodule]
fn _core(py: Python<'_>, module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("InputError", py.get_type::<InputError>())?;
    module.add_function(wrap_pyfunction!(machine::load, module)?)?;
    module.add_function(wrap_pyfunction!(machine::parse, module)?)?;
    module.add_function(wrap_pyfunction!(results::compare_runs, module)?)?;
    module.add_function(wrap_pyfunction!(results::compare_predictions, module)?)?;
    module.add_class::<PyMachine>()?;
    module.add_class::<PyMechanism>()?;
    module.add_class::<PyRun>()?;
    module.add_class::<PySpace>()?;
    module.add_class::<PyPrediction>()
}
