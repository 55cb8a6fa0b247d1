"""Plots over time that stretch with the page: curves in SVG, words in HTML, one time axis for all."""

from dataclasses import dataclass

import numpy as np

from mainspring.drawing.ticks import Axis, angles, decades, lengths, times
from mainspring.report.sampling import Film, Floats
from mainspring.report.words import escape

DEEPEST = -9
_HARDLY = 0.1  # above this share of its largest an energy is drawn on an even scale
_CONSTANT = 1e-9


@dataclass(frozen=True)
class Curve:
    """One plotted quantity: its axis and its values at the film's times.

    `beside` is the same with another model of contact; NaN where it is not known.
    """

    title: str
    kind: str
    axis: Axis
    values: Floats
    beside: Floats | None = None


def curves(
    film: Film, motions: dict[str, str], colour: dict[str, str], beside: Floats | None = None
) -> list[Curve]:
    """Return the joint positions of all moving parts as curves in their colours."""
    found = []
    for column, part in enumerate(film.parts):
        values = film.q[:, column]
        other = None if beside is None else beside[:, column]
        all_values = values if other is None else np.concatenate((values, other[~np.isnan(other)]))
        make = angles if motions.get(part) == "turn" else lengths
        axis = make(float(all_values.min()), float(all_values.max()))
        found.append(Curve(part, colour[part], axis, values, other))
    return found


def energy_curve(film: Film) -> Curve:
    """Return the kinetic energy relative to its largest value: as a power of ten unless it hardly varies."""
    shares = film.kinetic / (float(film.kinetic.max()) or 1.0)
    least = float(shares.min())
    if least > _HARDLY:
        return Curve("kinetic energy", "pk", lengths(least, 1.0), shares)
    values = np.log10(np.maximum(shares, 10.0**DEEPEST))
    return Curve("kinetic energy", "pk", decades(DEEPEST, 3), values)


def energy_note(film: Film, minima: int) -> str:
    """Return what the plot of the kinetic energy shows, in words."""
    if np.ptp(film.kinetic) <= _CONSTANT * float(film.kinetic.max()):
        return "constant"
    return "of its largest, minima marked" if minima else "of its largest"


def line(t: Floats, values: Floats, time: Axis, axis: Axis, width: float, height: float) -> str:
    """Return an SVG path through the samples, y down; samples on a straight line are left out."""
    x = np.round((t - time.low) / (time.high - time.low) * width, 2)
    y = np.round((1 - (values - axis.low) / (axis.high - axis.low)) * height, 2)
    points = _needed(np.column_stack((x, y)))
    return "M" + "L".join(f"{a:.5g} {b:.5g}" for a, b in points.tolist())


def _needed(points: Floats) -> Floats:
    """Leave out points that repeat the one before, then those inside a level stretch."""
    new = np.concatenate(([True], np.any(np.diff(points, axis=0) != 0, axis=1)))
    points = points[new]
    y = points[:, 1]
    inside = np.zeros(len(y), dtype=bool)
    inside[1:-1] = (y[1:-1] == y[:-2]) & (y[1:-1] == y[2:])
    return points[~inside]


def _grid(axis: Axis) -> str:
    levels = [100 * (1 - axis.share(v)) for v, _ in axis.marks]
    return "".join(f'<path class="grid" d="M0 {y:.2f}H1000"/>' for y in levels)


def _labels(axis: Axis) -> str:
    places = ((100 * (1 - axis.share(v)), label) for v, label in axis.marks)
    return "".join(f'<span style="top:{y:.2f}%">{escape(label)}</span>' for y, label in places)


def _dots(moments: list[float], time: Axis, level: float) -> str:
    """Draw dots as strokes of no length: they stay round however the plot is stretched."""
    points = "".join(f"M{1000 * time.share(t):.2f} {level:.2f}h0" for t in moments)
    return f'<path class="dot" d="{points}"/>' if points else ""


def _framed(kind: str, data: str, ticks: str, told: str, drawn: str, label: str) -> str:
    """Return one row of the plots: marks at the left, the stretching picture, the value at the right."""
    svg = (
        '<svg viewBox="0 0 1000 100" preserveAspectRatio="none" role="img">'
        f"<title>{escape(told)}</title>{drawn}</svg>"
    )
    return (
        f'<div class="panel {kind}"{data}><div class="ticks" aria-hidden="true">{ticks}</div>'
        f'<div class="area">{svg}<span class="label">{label}</span></div>'
        '<output class="value" aria-live="off"></output></div>'
    )


def _beside(curve: Curve, film: Film, time: Axis) -> str:
    if curve.beside is None:
        return ""
    known = ~np.isnan(curve.beside)
    path = line(film.t[known], curve.beside[known], time, curve.axis, 1000, 100)
    return f'<path class="curve beside" d="{path}"/>'


def panel(curve: Curve, film: Film, time: Axis, minima: list[float] | None = None, note: str = "") -> str:
    """Return one plot with its own vertical axis; `minima` get dots near the lowest level shown."""
    path = line(film.t, curve.values, time, curve.axis, 1000, 100)
    level = 100 * (1 - max(0.05, curve.axis.share(float(DEEPEST))))
    drawn = f'{_grid(curve.axis)}<path class="curve" d="{path}"/>{_beside(curve, film, time)}'
    drawn += _dots(minima or [], time, level)
    title = escape(curve.title)
    told = f"{curve.title} against time"
    return _framed(curve.kind, f' data-curve="{title}"', _labels(curve.axis), told, drawn, title + note)


def lane(pair: str, label: str, spans: list[list[float]], blows: list[float], time: Axis) -> str:
    """Return a strip that shows when two parts touch (bars) and strike (dots); `label` is HTML."""
    ends = ((1000 * time.share(a), 1000 * time.share(b)) for a, b in spans)
    bars = "".join(f'<path class="bar" d="M{a:.2f} 50H{b:.2f}"/>' for a, b in ends)
    return _framed("lane", "", "", f"when {pair} touch", bars + _dots(blows, time, 50), label)


def time_axis(film: Film) -> Axis:
    """Return the time axis of a film."""
    return times(float(film.t[0]), float(film.t[-1]))


def time_labels(time: Axis) -> str:
    """Return the row of time marks under the plots."""
    places = ((100 * time.share(value), escape(text)) for value, text in time.marks)
    marks = "".join(f'<span style="left:{x:.3f}%">{text}</span>' for x, text in places)
    return (
        '<div class="panel times" aria-hidden="true"><div class="ticks"></div>'
        f'<div class="area">{marks}</div></div>'
    )
