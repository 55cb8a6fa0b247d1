"""Configuration spaces: where two parts are free, where blocked, and the contact curves between."""

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mainspring import _core
from mainspring.drawing.space import draw_space
from mainspring.machine import Mechanism
from mainspring.result import Written, frozen, pairs_of, parse
from mainspring.space_parts import (
    Axis,
    Component,
    Curve,
    Feature,
    Floats,
    Gap,
    Interval,
    Mark,
    Stage,
    Transmission,
    Walk,
    Way,
    Xy,
    component_of,
    curve_of,
    features_of,
    xy,
)


@dataclass(frozen=True)
class ConfigurationSpace(Written):
    """The configuration space of two parts; `status` is `complete`.

    Configurations are pairs of joint positions, in the order of `coordinates`, in radians or the file's
    length, of any turn. What is mapped is the closure of free space's interior; contacts are placed to
    about 1e-12 of the size.

    Attributes
    ----------
    parts, coordinates
        The two parts, and the parts whose joints are the two coordinates.
    held
        Positions of other joints that move the two parts.
    domain
        The two coordinates' ranges.
    start
        The configuration at the start.
    components, curves, marks
        What free space consists of, what bounds it, and named values of the coordinates.
    features
        All contact features of the first and of the second part, by index.
    """

    parts: tuple[str, str]
    coordinates: tuple[str, str]
    held: Mapping[str, float]
    domain: tuple[Axis, Axis]
    start: Xy
    components: tuple[Component, ...] = field(repr=False)
    curves: tuple[Curve, ...] = field(repr=False)
    marks: tuple[Mark, ...]
    features: tuple[tuple[Feature, ...], tuple[Feature, ...]] = field(repr=False)
    _mechanism: Mechanism = field(repr=False)
    _inner: _core.Space = field(repr=False)

    def is_free(self, points: ArrayLike) -> Any:  # noqa: ANN401
        """Tell whether configurations are free.

        Parameters
        ----------
        points
            One configuration `(2,)` or `(n, 2)`; a million take a tenth of a second.

        Returns
        -------
        bool or (n,) booleans
            False also outside a window; in contact, to rounding, either.
        """
        rows, one = _rows(points)
        free = self._inner.is_free(rows)
        return bool(free[0]) if one else free

    def gap(self, points: ArrayLike) -> Gap:
        """Tell how far the parts are apart, and which features are at the nearest contact.

        Returns
        -------
        Gap
            `gap` is the distance where it is free; where it is blocked, the (negative) gap of the nearest
            contact curve along one of the coordinates, to first order the overlap there; NaN where neither
            exists. `features` are indices into `self.features`, -1 for none.
        """
        rows, one = _rows(points)
        gaps, features = self._inner.gap(rows)
        if one:
            return Gap(float(gaps[0]), (int(features[0, 0]), int(features[0, 1])))
        return Gap(gaps, features)

    def named(self, indices: Sequence[int]) -> tuple[Feature, Feature]:
        """Return the two features with these indices, as `gap` gives them for one configuration."""
        return self.features[0][indices[0]], self.features[1][indices[1]]

    def component(self, points: ArrayLike) -> Any:  # noqa: ANN401
        """Tell in which components configurations lie: an id (None if blocked), or `(n,)` ids with -1."""
        rows, one = _rows(points)
        found = self._inner.components_of(rows)
        if one:
            return int(found[0]) if found[0] >= 0 else None
        return found

    def slice(self, at: Mapping[str, float] | None = None, /, **value: float) -> tuple[Interval, ...]:
        """Return the free intervals of one coordinate with the other fixed, as in `space.slice(lever=0.1)`.

        The coordinates also go by their places `a` and `b`, unless parts bear these names.
        Intervals lie within one period of the stored domain; `high` may reach over its end.
        """
        axis, x = self._one({**(at or {}), **value})
        rows = self._inner.slice(axis, x)
        return tuple(Interval(low, high, (a, b), c) for low, high, a, b, c in rows)

    def play(self, point: ArrayLike) -> tuple[Xy, Xy] | None:
        """Return how far each coordinate can move with the other held: `(low, high)` each; None if blocked.

        Infinite where it can turn for ever.
        """
        return self._inner.play(_point(point))

    def way(self, start: ArrayLike, end: ArrayLike) -> Way | None:
        """Return a way from one free configuration to another; None if they are not connected."""
        found = self._inner.way(_point(start), _point(end))
        return Way(*found) if found else None

    def walk(
        self, start: ArrayLike, goal: Mapping[str, float] | None = None, /, **value: float
    ) -> Walk | None:
        """Push one coordinate and see where that takes the other, as in `space.walk((0, 0), wheel=6.28)`.

        The other coordinate stays until it is touched, then yields along the contact curves, until the goal
        is reached or it jams. None from a blocked start. Coordinates go by part or by place, as in `slice`.
        """
        axis, x = self._one({**(goal or {}), **value})
        found = self._inner.walk(_point(start), axis, x)
        if not found:
            return None
        stages, end = found
        made = (Stage(c, a, b, self.named(f) if f else None) for c, a, b, f in stages)
        return Walk(tuple(made), end)

    def transmission(
        self, curve: int, fraction: ArrayLike = 0.5, at: Mapping[str, ArrayLike] | None = None
    ) -> Transmission:
        """Return the motion transmitted along a curve.

        Parameters
        ----------
        curve
            Its number.
        fraction
            Where, from 0 at its start to 1 at its end, in steps of the first coordinate (of the second on
            an upright curve); one or `(n,)`.
        at
            Instead of fractions, values of the first coordinate by its name, within the curve.
        """
        if not 0 <= curve < len(self.curves):
            raise ValueError(f"no curve {curve}; expected one from 0 to {len(self.curves) - 1}")
        shares = np.atleast_1d(np.asarray(fraction, dtype=np.float64))
        if at is not None:
            shares = self._shares(curve, at)
        if not np.all((shares >= -1e-12) & (shares <= 1 + 1e-12)):
            raise ValueError("beyond the curve; expected fractions from 0 to 1")
        return Transmission(*self._inner.transmission(curve, np.clip(shares, 0.0, 1.0)))

    def _shares(self, curve: int, at: Mapping[str, ArrayLike]) -> Floats:
        first = self.coordinates[0]
        if list(at) != [first]:
            raise ValueError(f"values of {', '.join(at) or 'nothing'}; expected values of {first}")
        (a, _), (b, _) = self.curves[curve].start, self.curves[curve].end
        values = np.atleast_1d(np.asarray(at[first], dtype=np.float64))
        found: Floats = (values - a) / (b - a) if b != a else np.full_like(values, np.nan)
        return found

    def _one(self, values: Mapping[str, float]) -> tuple[int, float]:
        """Return the coordinate named, and its value."""
        names = {"a": 0, "b": 1, **{name.lower(): k for k, name in enumerate(self.coordinates)}}
        if len(values) == 1:
            (name, value) = next(iter(values.items()))
            if name.lower() in names and math.isfinite(value):
                return names[name.lower()], float(value)
        said = ", ".join(f"{name} {value}" for name, value in values.items()) or "nothing"
        raise ValueError(f"values of {said}; expected a finite one of {' or '.join(self.coordinates)}")

    def drawing_data(self) -> dict[str, Any]:
        """Return what a picture is drawn from: the JSON object, polygons of free space, outlines."""
        return {
            **parse(self._text),
            **parse(self._inner.picture_json()),
            "outlines": self._mechanism.outlines(),
            "machine": self._mechanism.name,
        }

    def svg(self) -> str:
        """Draw the space as an SVG file: free white, blocked grey, contact curves named on hover."""
        return draw_space(self.drawing_data())

    def _sentences(self) -> Iterable[str]:
        a, b = self.parts
        count = sum(c.copies for c in self.components)
        spaces = (
            "one free component" if count == 1 else f"{count} free components" if count else "no free space"
        )
        return (f"{a} and {b}: {spaces}, {len(self.curves)} contact curves.",)

    def _repr_html_(self) -> str:
        """Draw the space in a notebook."""
        return self.svg()


def _rows(points: ArrayLike) -> tuple[Floats, bool]:
    """Return configurations as `(n, 2)`, and whether it was a single one."""
    array = np.asarray(points, dtype=np.float64)
    if array.ndim not in (1, 2) or array.shape[-1] != 2:
        raise ValueError(f"an array of shape {array.shape}; expected (2,) or (n, 2)")
    return np.ascontiguousarray(np.atleast_2d(array)), array.ndim == 1


def _point(point: ArrayLike) -> Xy:
    rows, one = _rows(point)
    if not one:
        raise ValueError("several configurations; expected one, of shape (2,)")
    return float(rows[0, 0]), float(rows[0, 1])


def configuration_space(
    mechanism: Mechanism,
    a: str,
    b: str,
    *,
    coordinates: tuple[str, str] | None = None,
    window: Mapping[str, tuple[float, float]] | None = None,
    held: Mapping[str, float] | None = None,
    progress: Callable[[float], bool] | None = None,
) -> ConfigurationSpace:
    """Map where two parts of a mechanism are free and where they block each other.

    Parameters
    ----------
    a, b
        The parts, in any letter case; the frame is a part too.
    coordinates
        The parts whose joints are the two coordinates. By default `a` and `b`; where one of them carries
        the other, or is the frame, the other's own joint and the one next to it.
    window
        Ranges of coordinates by part, radians or the file's length. By default a whole turn, or as far as a
        sliding part can touch; two sliding parts need windows.
    held
        Positions of other joints that move the two parts, by part; by default those of the start.
    progress
        Called with the part done: 0 first, then now and then, 1 last. Returning False before raises
        KeyboardInterrupt.

    Raises
    ------
    InputError
        For parts that do not exist or share one freedom, more freedoms, motion that is not planar, windows
        that are needed or make no sense.

    Notes
    -----
    Contact curves are solved for in closed form, feature pair by feature pair, and trimmed; only the free
    boundary is partitioned (docs/guide/spaces.md).
    """
    windows = [(name, float(r[0]), float(r[1])) for name, r in (window or {}).items()]
    core = mechanism._inner.configuration_space(a, b, coordinates, windows, pairs_of(held), progress)
    text = core.json()
    o = parse(text)
    first, second = (features_of(json.loads(core.features_json(k))) for k in (0, 1))
    x, y = (Axis(**d) for d in o["domain"])
    return ConfigurationSpace(
        status=o["status"],
        stats=frozen(o["stats"]),
        _text=text,
        parts=(o["parts"][0], o["parts"][1]),
        coordinates=(x.coordinate, y.coordinate),
        held=frozen(o["held"]),
        domain=(x, y),
        start=xy(o["start"]["at"]),
        components=tuple(component_of(c) for c in o["components"]),
        curves=tuple(curve_of(c) for c in o["curves"]),
        marks=tuple(Mark(m["coordinate"], m["name"], m["value"]) for m in o["marks"]),
        features=(first, second),
        _mechanism=mechanism,
        _inner=core,
    )
