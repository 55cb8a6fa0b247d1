"""What configuration spaces consist of, and what questions about them are answered with."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Xy = tuple[float, float]


@dataclass(frozen=True)
class Axis:
    """One of the two coordinates: the joint position of a part, in radians or the file's length.

    Attributes
    ----------
    coordinate, motion
        The part's name, and `turn` or `slide`.
    low, high
        The range within which the map is stored.
    period
        The map goes on with this period; None where it ends.
    repeats
        How often the stored range repeats within a whole turn.
    """

    coordinate: str
    motion: str
    low: float
    high: float
    period: float | None
    repeats: int


@dataclass(frozen=True)
class Feature:
    """A feature of a part: which segment of the drawing, or with `corner` its start.

    `kind` is `edge`, `arc`, `corner` or `hollow arc`.
    """

    part: str
    layer: int
    loop: int
    edge: int
    corner: bool
    kind: str


@dataclass(frozen=True)
class Curve:
    """A stretch of contact curve that bounds free space: one pair of features.

    Attributes
    ----------
    id
        Its number, as half-edges, intervals and stages name it.
    features
        The two features that touch.
    points
        Configurations on it, `(n, 2)`, close enough to draw.
    start, end
        Its ends; the first coordinate grows from start to end unless its part runs against its gear train.
    slope
        Least and greatest slope, d second / d first coordinate; None for an upright curve.
    free
        Free space lies towards `greater` or `smaller` second coordinate (first, if it is upright).
    """

    id: int
    features: tuple[Feature, Feature]
    points: Floats = field(repr=False)
    start: Xy
    end: Xy
    slope: Xy | None
    free: str


class HalfEdge(NamedTuple):
    """A directed stretch of boundary, free space on its left; `curve` is None along a limit of the domain."""

    curve: int | None
    start: Xy
    end: Xy


@dataclass(frozen=True)
class Cycle:
    """A closed chain of half-edges, and the periods of the domain it winds along both coordinates."""

    edges: tuple[HalfEdge, ...]
    winding: tuple[int, int]


@dataclass(frozen=True)
class Component:
    """A connected part of free space.

    Attributes
    ----------
    id
        Its number.
    boundary
        Its boundary cycles.
    winding, turns
        Generators of the closed ways within it: periods of the domain, and whole turns.
    copies
        How many components over whole turns it stands for.
    area
        In the coordinates' units.
    inside
        A configuration well inside it.
    """

    id: int
    boundary: tuple[Cycle, ...] = field(repr=False)
    winding: tuple[tuple[int, int], ...]
    turns: tuple[tuple[int, int], ...]
    copies: int
    area: float
    inside: Xy


class Mark(NamedTuple):
    """A named value of one coordinate."""

    coordinate: str
    name: str
    value: float


class Gap(NamedTuple):
    """Gaps, and the indices in `features` of what would touch first; arrays for several places."""

    gap: Any
    features: Any


class Interval(NamedTuple):
    """A free interval, the curves at its low and high end (None at a limit), and its component."""

    low: float
    high: float
    curves: tuple[int | None, int | None]
    component: int


class Way(NamedTuple):
    """A way through free space.

    `points` `(n, 2)` count on from the start. `winding` tells by how many periods of the domain its end
    differs from the one asked for; `exact` whether the one asked for can be reached too.
    """

    points: Floats
    winding: tuple[int, int]
    exact: bool


class Stage(NamedTuple):
    """A stage of a walk: along one curve, or free with None; `features` are what touches."""

    curve: int | None
    start: Xy
    end: Xy
    features: tuple[Feature, Feature] | None


class Walk(NamedTuple):
    """A kinematic walk; `end` is `arrived`, `jammed` or `limit` (of a window)."""

    stages: tuple[Stage, ...]
    end: str


class Transmission(NamedTuple):
    """Motion that a contact transmits, at `n` configurations `at` `(n, 2)`.

    `ratio` `(n,)` is d second / d first coordinate, `derivatives` `(n, 2)` its first and second derivative
    by the first coordinate; `pressure_angles` `(n, 2)`, radians, of the bodies the two coordinates move;
    `point` and `normal` `(n, 2)` of the contact.
    """

    at: Floats
    ratio: Floats
    derivatives: Floats
    pressure_angles: Floats
    point: Floats
    normal: Floats


def xy(values: Any) -> Xy:  # noqa: ANN401
    """Return a pair of numbers."""
    return float(values[0]), float(values[1])


def features_of(o: Iterable[dict[str, Any]]) -> tuple[Feature, ...]:
    """Return features from their JSON objects."""
    return tuple(Feature(**f) for f in o)


def curve_of(o: dict[str, Any]) -> Curve:
    """Return a curve from its JSON object."""
    first, second = features_of(o["features"])
    points = np.array(o["points"], dtype=np.float64)
    points.setflags(write=False)
    slope = xy(o["slope"]) if o["slope"] else None
    return Curve(o["id"], (first, second), points, xy(o["from"]), xy(o["to"]), slope, o["free"])


def cycle_of(o: dict[str, Any]) -> Cycle:
    """Return a boundary cycle from its JSON object."""
    edges = tuple(HalfEdge(e["curve"], xy(e["from"]), xy(e["to"])) for e in o["edges"])
    return Cycle(edges, (o["winding"][0], o["winding"][1]))


def component_of(o: dict[str, Any]) -> Component:
    """Return a component from its JSON object."""
    pairs = {k: tuple((g[0], g[1]) for g in o[k]) for k in ("winding", "turns")}
    boundary = tuple(cycle_of(c) for c in o["boundary"])
    return Component(
        o["id"], boundary, pairs["winding"], pairs["turns"], o["copies"], o["area"], xy(o["inside"])
    )
