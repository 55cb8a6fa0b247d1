"""The moments a report shows: even steps, finer within one pattern, and every event exactly."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mainspring.prediction import Prediction
from mainspring.simulation import Simulation

Floats = NDArray[np.float64]

_FRAMES_PER_SECOND = 60.0
_MOST_NUMBERS = 12_000
_MOST_EVENTS = 1_500
_FEWEST_MOMENTS = 400
_JUST_BEFORE = 1e-7  # of the run: shows what a blow takes as a step and not as a slope


@dataclass(frozen=True)
class Film:
    """A motion at chosen moments.

    Attributes
    ----------
    parts
        Moving parts, the order of the columns of `q`.
    t, q, kinetic
        Times `(n,)`, positions `(n, parts)`, kinetic energy `(n,)`.
    loop
        Start and end of one pattern within the motion, or None.
    """

    parts: tuple[str, ...]
    t: Floats
    q: Floats
    kinetic: Floats
    loop: tuple[float, float] | None


def loop_of(result: Simulation | Prediction) -> tuple[float, float] | None:
    """Return one whole pattern that lies within the simulated stretch."""
    if not isinstance(result, Prediction) or not result.pattern or not result.starts:
        return None
    end, duration = result.simulation.t, result.pattern.duration
    start = min(float(result.starts["t"]), end - duration)
    return (start, start + duration) if duration > 0 and start >= 0 else None


def _moments(run: Simulation, loop: tuple[float, float] | None) -> Floats:
    budget = _MOST_NUMBERS // max(1, len(run.trajectory.parts))
    count = max(_FEWEST_MOMENTS, math.ceil(run.t * _FRAMES_PER_SECOND))
    even = np.linspace(0.0, run.t, min(budget // 2, count) + 2)
    pieces = [even]
    if loop:
        count = min(budget // 2, math.ceil((loop[1] - loop[0]) * _FRAMES_PER_SECOND))
        pieces.append(np.linspace(*loop, count + 2))
    events = np.array([e.t for e in run.events][:_MOST_EVENTS])
    minima = np.array(run.kinetic_energy_minima[:_MOST_EVENTS])
    near = np.array([-1e-2, -2e-3, -3e-4, 0.0, 3e-4, 2e-3, 1e-2])
    pieces += [events, events - _JUST_BEFORE * run.t, (minima[:, None] + near).ravel()]
    return np.unique(np.clip(np.concatenate(pieces), 0.0, run.t))


def beside_film(shown: Film, other: Simulation) -> Floats:
    """Return the positions of another run at a film's moments, `(n, parts)`; NaN where it is not known."""
    known = shown.t <= other.t if other.status != "at_rest" else np.full(len(shown.t), True)
    q = np.full(shown.q.shape, np.nan)
    q[known] = other.trajectory.at(shown.t[known]).q
    return q


def film(result: Simulation | Prediction) -> Film:
    """Choose the moments of a result and evaluate the motion there."""
    run = result.simulation if isinstance(result, Prediction) else result
    loop = loop_of(result)
    t = _moments(run, loop)
    motion = run.trajectory
    return Film(motion.parts, t, motion.at(t).q, motion.kinetic_energy(t), loop)
