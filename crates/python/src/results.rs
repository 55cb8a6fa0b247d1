//! Runs and predictions as Python sees them.

use mainspring::{PredictionResult, SimulationResult, compared_predictions, compared_runs};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// Steps between calls of a progress function, and between looks for Ctrl-C.
const STEPS_PER_CALL: u32 = 100;

/// Runs `work` without the interpreter lock; calls `progress` now and then and stops on its False or on Ctrl-C.
pub fn watch<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&mut dyn FnMut(f64) -> bool) -> T + Send,
) -> PyResult<T> {
    let mut failure = None;
    let mut steps = 0;
    let done = py.detach(|| {
        work(&mut |t| {
            steps += 1;
            if steps % STEPS_PER_CALL != 0 {
                return true;
            }
            Python::attach(|py| match ask(py, progress.as_ref(), t) {
                Ok(go_on) => go_on,
                Err(error) => {
                    failure = Some(error);
                    false
                }
            })
        })
    });
    failure.map_or(Ok(done), Err)
}

/// Tells Python how far it is; false or an error to stop.
pub fn ask(py: Python<'_>, progress: Option<&Py<PyAny>>, t: f64) -> PyResult<bool> {
    py.check_signals()?;
    match progress {
        Some(function) => function.bind(py).call1((t,))?.is_truthy(),
        None => Ok(true),
    }
}

/// A simulated stretch of time with its dense motion.
#[pyclass(name = "Run", module = "mainspring._core", frozen)]
pub struct PyRun(pub Arc<SimulationResult>);

impl PyRun {
    fn check_time(&self, t: f64) -> PyResult<()> {
        if self.0.knows(t) {
            return Ok(());
        }
        let end = self.0.end();
        Err(PyValueError::new_err(format!("time is {t}; expected one within the run, from 0 to {end}")))
    }
}

#[pymethods]
impl PyRun {
    #[getter]
    fn parts(&self) -> Vec<String> {
        self.0.parts()
    }

    /// The object that `simulate --json` prints.
    fn json(&self, timing: bool) -> String {
        self.0.json(timing).to_string()
    }

    /// The same without its long lists, events and forces.
    fn brief_json(&self) -> String {
        self.0.brief_json().to_string()
    }

    /// The accepted step and event times, `(n,)`.
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.times())
    }

    /// `q, v`, each `(n, parts)`, at the times `t`, `(n,)`.
    #[expect(clippy::type_complexity, reason = "two arrays")]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        t: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>)> {
        t.as_array().iter().try_for_each(|t| self.check_time(*t))?;
        let states: Vec<(Vec<f64>, Vec<f64>)> = t.as_array().iter().map(|&t| self.0.at(t)).collect();
        let shape = [states.len(), self.0.parts().len()];
        let array = |pick: fn(&(Vec<f64>, Vec<f64>)) -> &Vec<f64>| {
            let flat: Vec<f64> = states.iter().flat_map(|s| pick(s).iter().copied()).collect();
            PyArray1::from_vec(py, flat).reshape(shape)
        };
        Ok((array(|s| &s.0)?, array(|s| &s.1)?))
    }

    /// The kinetic energy at the times `t`, `(n,)`.
    fn kinetic_energy<'py>(
        &self,
        py: Python<'py>,
        t: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        t.as_array().iter().try_for_each(|t| self.check_time(*t))?;
        Ok(PyArray1::from_iter(py, t.as_array().iter().map(|t| self.0.kinetic_energy(*t))))
    }

    /// What touches at `t`, as a JSON list.
    fn contacts_at(&self, t: f64) -> PyResult<String> {
        self.check_time(t)?;
        Ok(self.0.contacts_at(t).to_string())
    }
}

/// What a machine will do, and the simulated stretch this is based on.
#[pyclass(name = "Prediction", module = "mainspring._core", frozen)]
pub struct PyPrediction(pub Arc<PredictionResult>);

#[pymethods]
impl PyPrediction {
    /// The object that `predict --json` prints.
    fn json(&self) -> String {
        self.0.json().to_string()
    }

    fn run(&self) -> PyRun {
        PyRun(self.0.run())
    }
}

/// Two runs of one machine from the same state as the object that `simulate --contact both --json` prints.
#[pyfunction]
pub fn compare_runs(rigid: &PyRun, compliant: &PyRun, timing: bool) -> String {
    compared_runs(&rigid.0, &compliant.0, timing).to_string()
}

/// Two predictions of one machine as the object that `predict --contact both --json` prints.
#[pyfunction]
pub fn compare_predictions(rigid: &PyPrediction, compliant: &PyPrediction) -> String {
    compared_predictions(&rigid.0, &compliant.0).to_string()
}
