"""Machines built in Python: the same description as a TOML file, which it writes.

>>> import mainspring as ms
>>> b = ms.Builder("yoke", length="mm")
>>> b.parameter("r", 20, unit="mm", range=(5, 30), meaning="length of the crank")
>>> b.part("crank", motion=ms.Turns((0, 0)), outer=[ms.Circle(("r", 0), 4)])
>>> machine = b.build()

Numbers may be expressions of the parameters, as text. docs/guide/toml.md tells what everything means.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from mainspring.machine import Machine, parse

Number = float | int | str
Point = tuple[Number, Number]
Turn = Literal["left", "right"]


@dataclass(frozen=True)
class Line:
    """A straight edge to a point; `fillet` rounds the corner at its end."""

    to: Point
    fillet: Number | None = None


@dataclass(frozen=True)
class Arc:
    """An arc to a point, by its radius or about its centre; `left` turns counterclockwise."""

    to: Point
    turn: Turn
    radius: Number | None = None
    center: Point | None = None
    large: bool = False
    fillet: Number | None = None


@dataclass(frozen=True)
class Close:
    """The last edge, back to the start: a line, or an arc if it has a turn."""

    turn: Turn | None = None
    radius: Number | None = None
    center: Point | None = None
    large: bool = False
    fillet: Number | None = None


@dataclass(frozen=True)
class Path:
    """A loop written point by point; `repeat` makes it one of so many equal pieces about a point."""

    start: Point
    edges: Sequence[Line | Arc | Close]
    repeat: Number | None = None
    copies: Number | None = None
    about: Point | None = None
    fillet: Number | None = None


@dataclass(frozen=True)
class Circle:
    """A whole circle, or `copies` of it about a point."""

    center: Point
    radius: Number
    copies: Number | None = None
    about: Point | None = None


Loop = Path | Circle


@dataclass(frozen=True)
class Layer:
    """Boundaries between two heights."""

    z: Point
    outer: Sequence[Loop]
    inner: Sequence[Loop] = ()


@dataclass(frozen=True)
class Turns:
    """A rotation about a point, on the frame or on another part."""

    about: Point
    on: str = "frame"


@dataclass(frozen=True)
class Slides:
    """A translation along a direction, on the frame or on another part."""

    along: Point
    on: str = "frame"


@dataclass(frozen=True)
class Fixed:
    """No motion on its carrier."""

    on: str = "frame"


Motion = Turns | Slides | Fixed


@dataclass
class Builder:
    """A machine being described, part by part.

    Attributes
    ----------
    name
        The machine's name.
    length, time, mass
        Names of the units, for display; nothing converts them. Angles are in degrees.
    """

    name: str
    length: str | None = None
    time: str | None = None
    mass: str | None = None
    _parameters: dict[str, str] = field(default_factory=dict, repr=False)
    _solids: dict[str, str] = field(default_factory=dict, repr=False)
    _parts: dict[str, str] = field(default_factory=dict, repr=False)
    _gears: list[str] = field(default_factory=list, repr=False)
    _world: dict[str, str] = field(default_factory=dict, repr=False)

    def parameter(
        self,
        name: str,
        value: Number,
        *,
        unit: str | None = None,
        range: tuple[float, float] | None = None,
        whole: bool = False,
        meaning: str | None = None,
    ) -> None:
        """Add a parameter: a number, or an expression of others; a range holds both ends."""
        said = _given(unit=unit, range=range, whole=whole or None, meaning=meaning)
        self._new(self._parameters, name, _inline({"value": value, **said}) if said else _value(value))

    def solid(self, name: str, text: str) -> None:
        """Add a named solid, in the language of PADL."""
        self._new(self._solids, name, _value(text))

    def part(
        self,
        name: str,
        *,
        frame: bool = False,
        solid: str | None = None,
        outer: Sequence[Loop] = (),
        inner: Sequence[Loop] = (),
        z: Point | None = None,
        layers: Sequence[Layer] = (),
        at: Point | None = None,
        turn: Number | None = None,
        motion: Motion | None = None,
        density: Number | None = None,
        inertia: Number | None = None,
        friction: Number | None = None,
        spring: tuple[Number, Number] | None = None,
        torque: Number | None = None,
        force: Number | None = None,
        dry_friction: Number | None = None,
        drive: Number | Sequence[Point] | None = None,
        limits: tuple[Number | None, Number | None] | None = None,
        mass: Mapping[str, Any] | None = None,
        position: Number | None = None,
        velocity: Number | None = None,
        marks: Mapping[str, Number] | None = None,
    ) -> None:
        """Add a part: a solid, or loops of lines and arcs in one or several layers; and what acts on it.

        `spring` is (relaxed, constant), `drive` a speed or a table of (time, position), `mass` has the keys
        `value`, `center` and perhaps `inertia`; the rest as in docs/guide/toml.md.
        """
        said = _given(frame=frame or None, solid=solid, at=at, turn=turn, z=z)
        said |= _given(outer=_loops(outer), inner=_loops(inner), layers=[_layer(x) for x in layers] or None)
        said |= _given(motion=_motion(motion), density=density, inertia=inertia, friction=friction)
        said |= _given(torque=torque, force=force, dry_friction=dry_friction)
        said |= _given(position=position, velocity=velocity, marks=marks or None, mass=mass)
        if spring is not None:
            said["spring"] = {"relaxed": spring[0], "constant": spring[1]}
        if drive is not None:
            key = "speed" if isinstance(drive, int | float | str) else "table"
            said["drive"] = {key: drive}
        if limits is not None:
            said["limits"] = _given(low=limits[0], high=limits[1])
        self._new(self._parts, name, "\n".join(f"{k} = {_value(v)}" for k, v in said.items()))

    def gear(self, first: str, second: str, teeth: tuple[Number, Number], *, internal: bool = False) -> None:
        """State that two parts mesh as gears with so many teeth."""
        said = {"parts": [first, second], "teeth": list(teeth)} | _given(internal=internal or None)
        self._gears.append(_inline(said))

    def world(
        self, *, gravity: Sequence[Number] | None = None, contact: Mapping[str, Number] | None = None
    ) -> None:
        """Set gravity (two or three components) and the constants E, D, M of compliant contact."""
        said = _given(gravity=gravity, contact=contact)
        self._world |= {key: _value(value) for key, value in said.items()}

    def to_toml(self) -> str:
        """Return the machine as the text of a TOML file."""
        head = _given(name=self.name, length=self.length, time=self.time, mass=self.mass)
        pieces = [_table("machine", {key: _value(value) for key, value in head.items()})]
        for name, rows in (
            ("parameters", self._parameters),
            ("solids", self._solids),
            ("world", self._world),
        ):
            if rows:
                pieces.append(_table(name, rows))
        pieces += [
            f"[parts.{name}]\n{body}\n" if body else f"[parts.{name}]\n" for name, body in self._parts.items()
        ]
        if self._gears:
            pieces.insert(0, "gears = [" + ", ".join(self._gears) + "]\n")
        return "\n".join(pieces)

    def build(self) -> Machine:
        """Return the machine.

        Raises
        ------
        InputError
            As `load` does; places are those in the text of `to_toml`.
        """
        return parse(self.to_toml(), f"{self.name}.toml")

    @staticmethod
    def _new(known: dict[str, str], name: str, text: str) -> None:
        if name in known:
            raise ValueError(f"{name} is described already; expected another name")
        known[name] = text


def _given(**values: Any) -> dict[str, Any]:  # noqa: ANN401
    return {key: value for key, value in values.items() if value is not None}


def _table(name: str, rows: Mapping[str, str]) -> str:
    return f"[{name}]\n" + "".join(f"{key} = {text}\n" for key, text in rows.items())


def _value(value: Any) -> str:  # noqa: ANN401
    """Write a value as TOML, on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return _inline(value)
    if isinstance(value, Sequence):
        return "[" + ", ".join(map(_value, value)) + "]"
    return repr(float(value))


def _inline(values: Mapping[str, Any]) -> str:
    return "{ " + ", ".join(f"{key} = {_value(value)}" for key, value in values.items()) + " }"


def _loops(loops: Sequence[Loop]) -> list[dict[str, Any]] | None:
    return [_loop(loop) for loop in loops] or None


def _loop(loop: Loop) -> dict[str, Any]:
    around = _given(copies=loop.copies, about=loop.about)
    if isinstance(loop, Circle):
        return {"circle": {"center": loop.center, "radius": loop.radius}} | around
    start = {"from": loop.start} | _given(fillet=loop.fillet)
    return {"path": [start, *map(_edge, loop.edges)]} | _given(repeat=loop.repeat) | around


def _edge(edge: Line | Arc | Close) -> dict[str, Any]:
    if isinstance(edge, Line):
        return {"line": edge.to} | _given(fillet=edge.fillet)
    said: dict[str, Any] = {"arc": edge.to} if isinstance(edge, Arc) else {"close": True}
    said |= _given(turn=edge.turn, radius=edge.radius, center=edge.center, large=edge.large or None)
    return said | _given(fillet=edge.fillet)


def _layer(layer: Layer) -> dict[str, Any]:
    return {"z": layer.z} | _given(outer=_loops(layer.outer), inner=_loops(layer.inner))


def _motion(motion: Motion | None) -> dict[str, Any] | None:
    if motion is None:
        return None
    if isinstance(motion, Turns):
        return {"turns": motion.about, "on": motion.on}
    if isinstance(motion, Slides):
        return {"slides": motion.along, "on": motion.on}
    return {"fixed": True, "on": motion.on}
