"""Which parts turn or slide about what, and which can ever touch (Gelsey 1995, Algorithms 1-7)."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from mainspring.machine import Mechanism
from mainspring.result import Result, frozen, parse

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Axis:
    """A line in space: its point nearest the origin and its unit direction, first non-zero component > 0."""

    point: Point
    direction: Point


@dataclass(frozen=True)
class Pair:
    """Two parts that constrain each other.

    Attributes
    ----------
    kind
        `revolute`, `prismatic`, `cylindrical`, `gear` or `fixed`, as it acts in the machine.
    shape_kind
        The kind its shapes alone allow.
    parts
        The two parts' names.
    axis
        None for gear pairs.
    ratio
        Turns of the second part for one turn of the first; None but for gear pairs.
    evidence
        Why it was found, one sentence each.
    """

    kind: str
    shape_kind: str
    parts: tuple[str, ...]
    axis: Axis | None
    ratio: float | None
    evidence: tuple[str, ...]


@dataclass(frozen=True)
class Subsystem:
    """Parts that share one freedom; `inertia` is all of theirs, reflected to the root."""

    root: str
    parts: tuple[str, ...]
    inertia: float | None


@dataclass(frozen=True)
class NearMiss:
    """Two parts that look like a pair and are none, and why."""

    parts: tuple[str, ...]
    why: str


@dataclass(frozen=True)
class Kinematics(Result):
    """How a machine can move; lengths in the file's unit, `status` is `complete`."""

    parts: tuple[str, ...]
    frame: str | None
    pairs: tuple[Pair, ...]
    subsystems: tuple[Subsystem, ...]
    state_variables: tuple[str, ...]
    interactions: tuple[tuple[str, ...], ...]
    near_misses: tuple[NearMiss, ...]
    warnings: tuple[str, ...]
    units: Mapping[str, Any]

    def _sentences(self) -> Iterable[str]:
        return (
            f"{len(self.parts)} parts, {len(self.pairs)} pairs, {len(self.subsystems)} subsystems.",
            "Can touch: " + (", ".join("–".join(i) for i in self.interactions) or "none") + ".",
        )


def _texts(value: str | Iterable[str] | None) -> tuple[str, ...]:
    if not value:
        return ()
    return (value,) if isinstance(value, str) else tuple(value)


def _pair(p: dict[str, Any]) -> Pair:
    axis = p.get("axis")
    line = Axis(tuple(axis["point"]), tuple(axis["direction"])) if axis else None
    parts, evidence = tuple(p["parts"]), _texts(p["evidence"])
    return Pair(p["kind"], p["shape_kind"], parts, line, p.get("ratio"), evidence)


def find_pairs(mechanism: Mechanism) -> Kinematics:
    """Tell how the parts of a mechanism constrain each other, and why.

    Returns
    -------
    Kinematics
        Pairs with their axes and evidence, subsystems, state variables, possible contacts.

    Notes
    -----
    Gelsey 1995, Sec. 2.1, with the refinements told in docs/theory/kinematics.md.
    """
    text = mechanism._inner.inspect_json()
    o = parse(text)
    return Kinematics(
        status="complete",
        stats=frozen({"parts": len(o["parts"]), "pairs": len(o["pairs"])}),
        _text=text,
        parts=tuple(o["parts"]),
        frame=o["frame"],
        pairs=tuple(_pair(p) for p in o["pairs"]),
        subsystems=tuple(Subsystem(s["root"], tuple(s["parts"]), s["inertia"]) for s in o["subsystems"]),
        state_variables=tuple(o["state_variables"]),
        interactions=tuple(tuple(i) for i in o["interactions"]),
        near_misses=tuple(NearMiss(tuple(n["parts"]), n["why"]) for n in o["near_misses"]),
        warnings=tuple(o["warnings"]),
        units=frozen(o["units"]),
    )
