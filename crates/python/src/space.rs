//! Configuration spaces as Python sees them: joint positions in, arrays out.

use crate::errors::bad_input;
use crate::results::ask;
use mainspring::{End, Mechanism, Progress, Space, SpaceRequest, watched_space};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use std::sync::{Arc, mpsc};
use std::time::Duration;

/// How often Ctrl-C is looked for while a map is made.
const LOOK: Duration = Duration::from_millis(50);

type Point = (f64, f64);
type Floats<'py> = Bound<'py, PyArray1<f64>>;
type Rows<'py> = Bound<'py, PyArray2<f64>>;

fn stopped() -> PyErr {
    PyKeyboardInterrupt::new_err("stopped before the map was made")
}

/// Makes the map in a thread of its own, so that Ctrl-C is heard; tells `progress` the part done, 0 first and 1 last.
pub fn make(
    py: Python<'_>,
    mechanism: &Mechanism,
    request: SpaceRequest,
    progress: Option<Py<PyAny>>,
) -> PyResult<PySpace> {
    if !ask(py, progress.as_ref(), 0.0)? {
        return Err(stopped());
    }
    let (send, mut receive) = mpsc::channel();
    let (mechanism, shared) = (mechanism.clone(), Arc::new(Progress::default()));
    let own = shared.clone();
    std::thread::spawn(move || {
        // Nobody listens any more after Ctrl-C.
        let _ = send.send(Box::new(watched_space(&mechanism, &request, &own)));
    });
    loop {
        let waited = py.detach(move || (receive.recv_timeout(LOOK), receive));
        receive = waited.1;
        match waited.0 {
            Ok(made) => {
                let space = PySpace(Arc::new(made.map_err(bad_input)?));
                ask(py, progress.as_ref(), 1.0)?; // a map that is made is kept, whatever the answer
                return Ok(space);
            }
            Err(mpsc::RecvTimeoutError::Timeout) => {
                let go_on = ask(py, progress.as_ref(), shared.done());
                if !matches!(go_on, Ok(true)) {
                    shared.stop();
                    go_on?;
                    return Err(stopped());
                }
            }
            Err(fault) => return Err(PyValueError::new_err(fault.to_string())),
        }
    }
}

/// Rows of a `(n, 2)` array.
fn points(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 2]>> {
    let view = array.as_array();
    if view.ncols() != 2 {
        return Err(PyValueError::new_err(format!(
            "the array has {} columns; expected two, a value of each coordinate",
            view.ncols()
        )));
    }
    Ok(view.rows().into_iter().map(|r| [r[0], r[1]]).collect())
}

fn rows<'py>(py: Python<'py>, list: &[[f64; 2]]) -> PyResult<Rows<'py>> {
    PyArray1::from_slice(py, list.as_flattened()).reshape([list.len(), 2])
}

/// The configuration space of two parts.
#[pyclass(name = "Space", module = "mainspring._core", frozen)]
pub struct PySpace(Arc<Space>);

#[pymethods]
impl PySpace {
    /// The object that `cspace --json` prints.
    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| self.0.json().to_string())
    }

    /// Free space as polygons, and what moves with which coordinate.
    fn picture_json(&self, py: Python<'_>) -> String {
        py.detach(|| self.0.picture_json().to_string())
    }

    /// The features of the first (0) or the second (1) part, as a JSON list.
    fn features_json(&self, k: usize) -> String {
        let k = k.min(1);
        let list = (0..self.0.features(k).len()).map(|i| self.0.feature_json(k, i));
        format!("[{}]", list.map(|f| f.to_string()).collect::<Vec<_>>().join(","))
    }

    /// For each of `(n, 2)` configurations whether it is free, `(n,)`.
    fn is_free<'py>(
        &self,
        py: Python<'py>,
        at: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let view = at.as_array();
        let free: Vec<bool> = match view.to_slice().filter(|_| view.ncols() == 2) {
            Some(flat) => py.detach(|| flat.as_chunks().0.iter().map(|x| self.0.is_free(*x)).collect()),
            None => {
                let list = points(&at)?;
                py.detach(|| list.iter().map(|x| self.0.is_free(*x)).collect())
            }
        };
        Ok(PyArray1::from_vec(py, free))
    }

    /// Gaps `(n,)` and indices of the features at the nearest contact, `(n, 2)`; NaN and -1 where there is none.
    fn gap<'py>(
        &self,
        py: Python<'py>,
        at: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Floats<'py>, Bound<'py, PyArray2<i64>>)> {
        let list = points(&at)?;
        let found: Vec<_> = py.detach(|| list.iter().map(|x| self.0.gap(*x)).collect());
        let gaps = found.iter().map(|g| g.map_or(f64::NAN, |g| g.gap)).collect();
        let features: Vec<i64> =
            found.iter().flat_map(|g| g.map_or([-1, -1], |g| g.features.map(|f| f as i64))).collect();
        let features = PyArray1::from_vec(py, features).reshape([found.len(), 2])?;
        Ok((PyArray1::from_vec(py, gaps), features))
    }

    /// The component of each of `(n, 2)` configurations, `(n,)`; -1 where it is blocked.
    fn components_of<'py>(
        &self,
        py: Python<'py>,
        at: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let list = points(&at)?;
        let found = py.detach(|| {
            list.iter().map(|x| self.0.component_of(*x).map_or(-1, i64::from)).collect::<Vec<_>>()
        });
        Ok(PyArray1::from_vec(py, found))
    }

    /// Free intervals with coordinate `axis` at `x`: `(low, high, lower curve, upper curve, component)`.
    #[expect(clippy::type_complexity, reason = "a plain row")]
    fn slice(
        &self,
        py: Python<'_>,
        axis: usize,
        x: f64,
    ) -> PyResult<Vec<(f64, f64, Option<u32>, Option<u32>, u32)>> {
        let found = py.detach(|| self.0.slice(axis.min(1), x)).map_err(bad_input)?;
        Ok(found.iter().map(|i| (i.low, i.high, i.curves[0], i.curves[1], i.component)).collect())
    }

    /// How far each coordinate can move with the other held: two pairs; None for a blocked configuration.
    fn play(&self, py: Python<'_>, at: Point) -> PyResult<Option<(Point, Point)>> {
        let found = py.detach(|| self.0.play([at.0, at.1])).map_err(bad_input)?;
        Ok(found.map(|[a, b]| (a, b)))
    }

    /// A way: points `(n, 2)`, winding, and whether the end is reached in just its turn; None if there is none.
    #[expect(clippy::type_complexity, reason = "a plain row")]
    fn way<'py>(
        &self,
        py: Python<'py>,
        start: Point,
        end: Point,
    ) -> PyResult<Option<(Rows<'py>, (i64, i64), bool)>> {
        let way = py.detach(|| self.0.way([start.0, start.1], [end.0, end.1]));
        way.map(|w| Ok((rows(py, &w.points)?, (w.winding[0], w.winding[1]), w.exact))).transpose()
    }

    /// Pushes coordinate `axis` to `goal`: stages `(curve, from, to, features)` and how it ended; None from a blocked start.
    #[expect(clippy::type_complexity, reason = "a plain row")]
    fn walk(
        &self,
        py: Python<'_>,
        start: Point,
        axis: usize,
        goal: f64,
    ) -> PyResult<Option<(Vec<(Option<u32>, Point, Point, Option<[usize; 2]>)>, &'static str)>> {
        let walk = py.detach(|| self.0.walk([start.0, start.1], axis.min(1), goal)).map_err(bad_input)?;
        Ok(walk.map(|(stages, end)| {
            let middle = |s: &mainspring::Stage| [0, 1].map(|k| 0.5 * (s.from[k] + s.to[k]));
            let row = |s: &mainspring::Stage| {
                let features = s.curve.and_then(|c| self.0.touching(c, middle(s)));
                (s.curve, s.from.into(), s.to.into(), features)
            };
            (stages.iter().map(row).collect(), word(end))
        }))
    }

    /// Along a curve at fractions `(n,)`: at `(n, 2)`, ratio `(n,)`, derivatives, pressure angles, point, normal `(n, 2)`.
    fn transmission<'py>(
        &self,
        py: Python<'py>,
        curve: u32,
        fractions: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(Rows<'py>, Floats<'py>, Rows<'py>, Rows<'py>, Rows<'py>, Rows<'py>)> {
        let fractions: Vec<f64> = fractions.as_array().iter().copied().collect();
        let found = py.detach(|| fractions.iter().map(|f| self.0.transmission(curve, *f)).collect());
        let found: Option<Vec<mainspring::Transmission>> = found;
        let Some(found) = found else {
            return Err(PyValueError::new_err(format!(
                "no curve {curve}; expected one of the space's curves"
            )));
        };
        let pick = |of: fn(&mainspring::Transmission) -> [f64; 2]| {
            rows(py, &found.iter().map(of).collect::<Vec<_>>())
        };
        Ok((
            pick(|t| t.at)?,
            PyArray1::from_iter(py, found.iter().map(|t| t.ratio)),
            pick(|t| t.derivatives)?,
            pick(|t| t.pressure_angles)?,
            pick(|t| [t.point.x, t.point.y])?,
            pick(|t| [t.normal.x, t.normal.y])?,
        ))
    }
}

fn word(end: End) -> &'static str {
    match end {
        End::Arrived => "arrived",
        End::Jammed => "jammed",
        End::Limit => "limit",
    }
}
