//! Machine and Mechanism as Python sees them.

use crate::errors::{InputError, bad_input, by_index, count};
use crate::results::{PyPrediction, PyRun, watch};
use crate::space::{self, PySpace};
use mainspring::{
    CompileOptions, ContactChoice, ContactLaw, ContactModel, ContactSearch, Machine, MatchOptions, Mechanism,
    PredictOptions, PredictionOptions, SimulationOptions, SpaceRequest, drawing_json, inspect_json,
    parameters_json, predict, simulate,
};
use pyo3::prelude::*;
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

type Values = Vec<(String, f64)>;

/// Read a model file and its supplement (found beside the model by name when None).
#[pyfunction]
#[pyo3(signature = (model, supplement = None))]
pub fn load(py: Python<'_>, model: &str, supplement: Option<&str>) -> PyResult<PyMachine> {
    let read = py.detach(|| Machine::load(Path::new(model), supplement.map(Path::new)));
    Ok(PyMachine(Arc::new(read.map_err(bad_input)?)))
}

/// Read a machine from a text; the ending of the name, which errors show, says which language it is in.
#[pyfunction]
pub fn parse(py: Python<'_>, text: &str, name: &str) -> PyResult<PyMachine> {
    let read = py.detach(|| Machine::parse(name, text.as_bytes(), None));
    Ok(PyMachine(Arc::new(read.map_err(bad_input)?)))
}

/// What a person edits: solids, parameters, springs.
#[pyclass(name = "Machine", module = "mainspring._core", frozen)]
pub struct PyMachine(Arc<Machine>);

#[pymethods]
impl PyMachine {
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// Parameters with their values and ranges, in the order of the text.
    fn parameters_json(&self) -> String {
        parameters_json(&self.0).to_string()
    }

    /// The file's text with new values of some parameters.
    fn text_with(&self, set: Values) -> PyResult<String> {
        self.0.text_with(&set).map_err(bad_input)
    }

    /// Write that text, whole or not at all.
    fn save(&self, py: Python<'_>, path: &str, set: Values) -> PyResult<()> {
        py.detach(|| self.0.save(Path::new(path), &set)).map_err(bad_input)
    }

    /// Evaluate the shapes with these parameters and analyse them.
    fn compile(
        &self,
        py: Python<'_>,
        set: Values,
        pair_clearance: f64,
        keep_axial: bool,
    ) -> PyResult<PyMechanism> {
        let (machine, options) = (self.0.clone(), CompileOptions { pair_clearance, keep_axial });
        let compiled = py.detach(|| Mechanism::compile(machine, &set, &options));
        Ok(PyMechanism(compiled.map_err(bad_input)?))
    }
}

/// A machine at fixed parameters, analysed.
#[pyclass(name = "Mechanism", module = "mainspring._core", frozen)]
pub struct PyMechanism(Mechanism);

impl PyMechanism {
    fn started(&self, positions: &Values, velocities: &Values) -> PyResult<Cow<'_, Mechanism>> {
        if positions.is_empty() && velocities.is_empty() {
            return Ok(Cow::Borrowed(&self.0));
        }
        let positions = by_index(&self.0, positions, "--position")?;
        let velocities = by_index(&self.0, velocities, "--velocity")?;
        self.0.starting_at(&positions, &velocities).map(Cow::Owned).map_err(bad_input)
    }
}

fn contact_of(name: &str, constants: Option<(f64, f64, f64)>, rtol: Option<f64>) -> PyResult<ContactChoice> {
    let model = ContactModel::named(name).ok_or_else(|| {
        InputError::new_err(format!(
            "--contact:1:1: error: no contact model {name:?}; expected rigid, compliant or both"
        ))
    })?;
    let law = constants.map(|(e, d, m)| ContactLaw { e, d, m });
    Ok(ContactChoice { model, law, rtol })
}

fn search_of(name: &str) -> PyResult<ContactSearch> {
    ContactSearch::named(name).ok_or_else(|| {
        InputError::new_err(format!("--search:1:1: error: no search {name:?}; expected direct or map"))
    })
}

#[pymethods]
impl PyMechanism {
    /// Parts, pairs, subsystems, interactions as one object.
    fn inspect_json(&self, py: Python<'_>) -> String {
        py.detach(|| inspect_json(&self.0).to_string())
    }

    /// The outlines that contact is computed with.
    fn drawing_json(&self) -> String {
        drawing_json(&self.0).to_string()
    }

    /// The configuration space of parts `a` and `b`.
    #[pyo3(signature = (a, b, coordinates, windows, held, progress = None))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of the Python method")]
    fn configuration_space(
        &self,
        py: Python<'_>,
        a: String,
        b: String,
        coordinates: Option<(String, String)>,
        windows: Vec<(String, f64, f64)>,
        held: Values,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PySpace> {
        let coordinates = coordinates.map(|(p, q)| [p, q]);
        space::make(py, &self.0, SpaceRequest { parts: [a, b], coordinates, windows, held }, progress)
    }

    /// Run to time `until`.
    #[pyo3(signature = (until, *, contact = "rigid", contact_constants = None, rtol = None, positions = vec![], velocities = vec![],
        forces = false, max_steps = None, search = "direct", progress = None))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of the Python method")]
    fn simulate(
        &self,
        py: Python<'_>,
        until: f64,
        contact: &str,
        contact_constants: Option<(f64, f64, f64)>,
        rtol: Option<f64>,
        positions: Values,
        velocities: Values,
        forces: bool,
        max_steps: Option<u64>,
        search: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyRun> {
        let contact = contact_of(contact, contact_constants, rtol)?;
        let mechanism = self.started(&positions, &velocities)?;
        let search = search_of(search)?;
        let mut options =
            SimulationOptions { until, contact, forces, search, ..SimulationOptions::default() };
        options.max_steps = max_steps.unwrap_or(options.max_steps);
        let run = watch(py, progress, |progress| simulate(&mechanism, &options, progress))?;
        Ok(PyRun(Arc::new(run.map_err(bad_input)?)))
    }

    /// Run until it is known what repeats.
    #[pyo3(signature = (*, contact = "rigid", contact_constants = None, rtol = None, positions = vec![], velocities = vec![], p_confirm = 2,
        p_range_fraction = 1e-5, p_ignore = 4, p_t_match = 0.01, p_s_v_match = 0.02, max_minima = 1000,
        max_time = 1e5, search = "direct", progress = None))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of the Python method")]
    fn predict(
        &self,
        py: Python<'_>,
        contact: &str,
        contact_constants: Option<(f64, f64, f64)>,
        rtol: Option<f64>,
        positions: Values,
        velocities: Values,
        p_confirm: i64,
        p_range_fraction: f64,
        p_ignore: i64,
        p_t_match: f64,
        p_s_v_match: f64,
        max_minima: i64,
        max_time: f64,
        search: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyPrediction> {
        let contact = contact_of(contact, contact_constants, rtol)?;
        let mechanism = self.started(&positions, &velocities)?;
        let matching = MatchOptions {
            confirm: count(p_confirm, "--confirm")?,
            range_fraction: p_range_fraction,
            ignore: count(p_ignore, "--ignore")?,
            time_match: p_t_match,
            state_match: p_s_v_match,
        };
        let max_minima = count(max_minima, "--max-minima")?;
        let source = search_of(search)?;
        let search = PredictOptions { matching, max_minima, max_time, ..PredictOptions::default() };
        let options = PredictionOptions { contact, search, source };
        let found = watch(py, progress, |progress| predict(&mechanism, &options, progress))?;
        Ok(PyPrediction(Arc::new(found.map_err(bad_input)?)))
    }
}
