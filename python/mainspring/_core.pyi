"""The compiled core: numbers in the file's units and radians, text as JSON.

Nothing here is meant for users; `mainspring` wraps all of it. JSON texts have a fixed key order.
"""

from collections.abc import Callable
from typing import final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "InputError",
    "Machine",
    "Mechanism",
    "Prediction",
    "Run",
    "Space",
    "compare_predictions",
    "compare_runs",
    "load",
    "parse",
]

class InputError(ValueError):
    """Bad input. `str(e)` is the whole line `FILE:LINE:COL: error: what, what was expected`."""

def load(model: str, supplement: str | None = None) -> Machine:
    """Read a model file and its supplement (found beside the model by name when None)."""

def parse(text: str, name: str) -> Machine:
    """Read a machine from a text; the ending of the name, which errors show, says which language it is in."""

def compare_runs(rigid: Run, compliant: Run, timing: bool) -> str:
    """Return the object that `simulate --contact both --json` prints."""

def compare_predictions(rigid: Prediction, compliant: Prediction) -> str:
    """Return the object that `predict --contact both --json` prints."""

@final
class Machine:
    """What a person edits: solids, parameters, springs."""

    @property
    def name(self) -> str: ...
    def parameters_json(self) -> str:
        """Return `[{"name", "value", "range", "whole", "unit", "meaning"}]` in the order of the text."""

    def text_with(self, set: list[tuple[str, float]]) -> str:
        """Return the file's text with new values of some parameters (TOML machines only)."""

    def save(self, path: str, set: list[tuple[str, float]]) -> None:
        """Write that text, whole or not at all."""

    def compile(self, set: list[tuple[str, float]], pair_clearance: float, keep_axial: bool) -> Mechanism:
        """Evaluate the shapes with these parameters and analyse them."""

@final
class Mechanism:
    """A machine at fixed parameters, analysed."""

    def inspect_json(self) -> str:
        """Return parts, pairs, subsystems, interactions as one object (docs/guide/json.md).

        Besides the documented keys: `near_misses` `[{"parts": [a, b], "why"}]`, `warnings` `[str]`,
        `plane` (`{"origin", "x", "y", "normal"}` or null) and `units` (`{"length", "time", ...}`).
        """

    def drawing_json(self) -> str:
        """Return the outlines that contact is computed with, in the working plane.

        `{"size", "parts": [{"name", "frame", "motion": {"kind": "turn", "center"} |
        {"kind": "slide", "direction"} | null, "layers": [{"bottom", "top", "loops": [[segment]]}],
        "gears": [{"center", "radius"}]}], "springs": [{"part", "relaxed", "constant"}]}` with segments
        `{"kind": "line", "from", "to"}`, `{"kind": "arc", "from", "to", "center", "radius", "convex"}`,
        `{"kind": "circle", "center", "radius", "convex"}`; material lies to the left; `relaxed` in
        radians or length.
        """

    def configuration_space(
        self,
        a: str,
        b: str,
        coordinates: tuple[str, str] | None,
        windows: list[tuple[str, float, float]],
        held: list[tuple[str, float]],
        progress: Callable[[float], bool] | None = None,
    ) -> Space:
        """Return the configuration space of parts `a` and `b`; Ctrl-C is heard while it is made.

        `coordinates` names the parts whose joints are the two coordinates; `windows` their ranges `(part,
        low, high)`; `held` the positions of other joints. `progress(part)` is told the part done, 0 to 1,
        twenty times a second; returning False raises KeyboardInterrupt.
        """

    def simulate(
        self,
        until: float,
        *,
        contact: str = "rigid",
        contact_constants: tuple[float, float, float] | None = None,
        rtol: float | None = None,
        positions: list[tuple[str, float]] = ...,
        velocities: list[tuple[str, float]] = ...,
        forces: bool = False,
        max_steps: int | None = None,
        search: str = "direct",
        progress: Callable[[float], bool] | None = None,
    ) -> Run:
        """Run to time `until`, with `rigid` or `compliant` contact.

        `contact_constants` are E, D, M; None: the supplement's. `rtol` None: the model's own. `search` is
        `direct` or `map`. `progress(t)` is called now and then (about every hundred events), never inside a
        step; returning False stops the run with status `stopped` and everything up to then.
        """

    def predict(
        self,
        *,
        contact: str = "rigid",
        contact_constants: tuple[float, float, float] | None = None,
        rtol: float | None = None,
        positions: list[tuple[str, float]] = ...,
        velocities: list[tuple[str, float]] = ...,
        p_confirm: int = 2,
        p_range_fraction: float = 1e-5,
        p_ignore: int = 4,
        p_t_match: float = 0.01,
        p_s_v_match: float = 0.02,
        max_minima: int = ...,
        max_time: float = ...,
        search: str = "direct",
        progress: Callable[[float], bool] | None = None,
    ) -> Prediction:
        """Run until it is known what repeats (Gelsey 1995, Algorithm 12, corrected).

        `progress` as for `simulate`; a stopped search has status `stopped`.
        """

@final
class Run:
    """A simulated stretch of time with its dense motion."""

    @property
    def parts(self) -> list[str]: ...
    def json(self, timing: bool) -> str:
        """Return the object that `simulate --json` prints."""

    def brief_json(self) -> str:
        """Return the same without its long lists, events and forces."""

    def times(self) -> NDArray[np.float64]:
        """Return the accepted step and event times, `(n,)`."""

    def sample(self, t: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return `q, v`, each `(n, parts)`, at the times `t`, `(n,)`."""

    def kinetic_energy(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the kinetic energy at the times `t`, `(n,)`."""

    def contacts_at(self, t: float) -> str:
        """Return what touches at `t`.

        `[{"parts": [a, b], "points": [[x, y]], "normal": [nx, ny], "force": number | null,
        "features": [{"part", "layer", "loop", "edge", "corner": bool}]}]`: `edge` counts the segments
        of that loop as in `drawing_json`; with `corner` the start point of that segment is meant. The
        normal points from the second part to the first; `force` is what the first part feels along it.
        """

@final
class Prediction:
    """What a machine will do, and the simulated stretch this is based on."""

    def json(self) -> str:
        """Return the object that `predict --json` prints."""

    def run(self) -> Run: ...

@final
class Space:
    """The configuration space of two parts; values are the two joints' positions, radians or length."""

    def json(self) -> str:
        """Return the object that `cspace --json` prints."""

    def picture_json(self) -> str:
        """Return free space within the stored domain as polygons, and what moves with which coordinate.

        `{"free": [[[x, y]]], "moves": [{"part", "axis": 0 | 1, "ratio"}], "others": {part: position},
        "tiles": [{"part", "center", "angle"} | null]}`;
        polygons may reach over the domain's end, and both copies are there then; a part's position is `ratio`
        times that of the axis. One period along an axis further, what touches is turned, as modelled, by the
        tile's `angle` about its `center`.
        """

    def features_json(self, k: int) -> str:
        """Return the features of the first (0) or the second (1) part, a list as in `curves`."""

    def is_free(self, at: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return for each of `(n, 2)` configurations whether it is free, `(n,)`."""

    def gap(self, at: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Return gaps `(n,)` and indices of the features at the nearest contact, `(n, 2)`; NaN, -1: none."""

    def components_of(self, at: NDArray[np.float64]) -> NDArray[np.int64]:
        """Return the component of each of `(n, 2)` configurations, `(n,)`; -1 where it is blocked."""

    def slice(self, axis: int, x: float) -> list[tuple[float, float, int | None, int | None, int]]:
        """Return free intervals of the other coordinate: low, high, the curves that bound it, component."""

    def play(self, at: tuple[float, float]) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """Return how far each coordinate can move with the other held; None if blocked."""

    def way(
        self, start: tuple[float, float], end: tuple[float, float]
    ) -> tuple[NDArray[np.float64], tuple[int, int], bool] | None:
        """Return points `(n, 2)`, winding, and whether just that turn is reached; None without a way."""

    def walk(
        self, start: tuple[float, float], axis: int, goal: float
    ) -> (
        tuple[list[tuple[int | None, tuple[float, float], tuple[float, float], list[int] | None]], str] | None
    ):
        """Return stages and `arrived`, `jammed` or `limit`; None from a blocked start.

        A stage is the curve, from, to, and the indices of the features that touch.
        """

    def transmission(
        self, curve: int, fractions: NDArray[np.float64]
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
    ]:
        """Return at `(n, 2)`, ratio `(n,)`, derivatives, pressure angles, point and normal `(n, 2)`."""
