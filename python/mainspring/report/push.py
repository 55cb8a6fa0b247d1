"""A kinematic walk as a film: the first part is pushed all round, the other yields along the curves."""

import math
from typing import Any

import numpy as np

from mainspring.space import ConfigurationSpace
from mainspring.space_parts import Stage, Walk, Xy

_SAMPLES = 25
_DIGITS = 5
_MOST_STAGES = 400
_DIRECTIONS = 16
_NUDGES = (1e-6, 1e-4, 1e-2)


def push(space: ConfigurationSpace) -> dict[str, Any] | None:
    """Return the points of the longer of the two walks from the start, one each way, and how it ended.

    A start in contact is left by a hair; without anything free near it there is no walk.
    """
    start = _free(space)
    if not start:
        return None
    name = space.coordinates[0]
    walks = [space.walk(start, {name: goal}) for goal in _goals(space, start)]
    found = [walk for walk in walks if walk and walk.stages]
    if not found:
        return None
    walk = max(found, key=lambda w: abs(w.stages[-1].end[0] - start[0]))
    return {"points": _points(space, walk), "end": walk.end}


def _free(space: ConfigurationSpace) -> Xy | None:
    a, b = space.start
    x, y = (d.high - d.low for d in space.domain)
    if space.domain[0].motion == space.domain[1].motion:
        x = y = min(x, y)
    turns = [2 * math.pi * k / _DIRECTIONS for k in range(_DIRECTIONS)]
    near = [(a + h * x * math.cos(t), b + h * y * math.sin(t)) for h in _NUDGES for t in turns]
    return next((p for p in [(a, b), *near] if space.is_free(p)), None)


def _goals(space: ConfigurationSpace, start: Xy) -> tuple[float, float]:
    axis = space.domain[0]
    if axis.period:
        return start[0] + 2 * math.pi, start[0] - 2 * math.pi
    return axis.high, axis.low


def _points(space: ConfigurationSpace, walk: Walk) -> list[list[float]]:
    found = [walk.stages[0].start]
    for stage in walk.stages[:_MOST_STAGES]:
        found += _along(space, stage)
    return [[float(f"{v:.{_DIGITS}g}") for v in p] for p in found]


def _along(space: ConfigurationSpace, stage: Stage) -> list[Xy]:
    """Return points of a stage after its start: on a curve from its own points, moved to the stage's turn."""
    if stage.curve is None or stage.start[0] == stage.end[0]:
        return [stage.end]
    curve = space.curves[stage.curve]
    (c0, _), (c1, _) = curve.start, curve.end
    if c0 == c1:
        return [stage.end]
    period = space.domain[0].period or math.inf
    middle = 0.5 * (stage.start[0] + stage.end[0])
    shift = period * round((middle - 0.5 * (c0 + c1)) / period) if math.isfinite(period) else 0.0
    x = np.linspace(stage.start[0], stage.end[0], _SAMPLES)
    y = space.transmission(stage.curve, np.clip((x - shift - c0) / (c1 - c0), 0.0, 1.0)).at[:, 1]
    y += stage.start[1] - y[0]
    return [*zip(x[1:-1].tolist(), y[1:-1].tolist(), strict=True), stage.end]
