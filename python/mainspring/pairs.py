"""Which parts turn or slide about what, and which can ever touch (Gelsey 1995, Algorithms 1-7)."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from mainspring.machine import Mechanism
from mainspring.result import Written, frozen, parse

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
    clearance
        Play between the surfaces, in the file's length; 0 unless `pair_clearance` allowed some.
    evidence
        Why it was found and what was decided about it, one sentence each.
    """

    kind: str
    shape_kind: str
    parts: tuple[str, ...]
    axis: Axis | None
    ratio: float | None
    clearance: float
    evidence: tuple[str, ...]


@dataclass(frozen=True)
class Drive:
    """A prescribed motion: a constant speed, or points (time, position); the other is None."""

    speed: float | None
    table: tuple[tuple[float, float], ...] | None


@dataclass(frozen=True)
class Joint:
    """How a part hangs on its carrier and what acts between them; angles in radians.

    Attributes
    ----------
    part, carrier
        Names; the carrier is the frame or another moving part.
    motion
        `turn` or `slide`.
    position, velocity
        At the start.
    inertia
        About the joint's axis, or the mass of a sliding part; None if not known.
    mass, center
        Mass and centre of mass as modelled; None where nothing asked for them.
    friction, coulomb
        Viscous friction, and the size of dry friction.
    spring
        Relaxed position and constant; None without one.
    torque
        Constant torque or force.
    drive
        Prescribed motion; None without one.
    stops
        Least and greatest position, each None where there is none.
    """

    part: str
    carrier: str
    motion: str
    position: float
    velocity: float
    inertia: float | None
    mass: float | None
    center: Point | None
    friction: float
    coulomb: float
    spring: tuple[float, float] | None
    torque: float
    drive: Drive | None
    stops: tuple[float | None, float | None]


@dataclass(frozen=True)
class Subsystem:
    """Parts that share one freedom.

    Attributes
    ----------
    root, parts
        The part whose position and velocity are the state, and all parts.
    ratios
        Velocity of each part over that of the root.
    inertia
        Of all parts, reflected to the root; None if one is not known.
    locked
        Its gears contradict each other, so it cannot move.
    """

    root: str
    parts: tuple[str, ...]
    ratios: tuple[float, ...]
    inertia: float | None
    locked: bool


@dataclass(frozen=True)
class ClosedChain:
    """Parts in loops of pairs, and how many independent motions these leave."""

    parts: tuple[str, ...]
    mobility: int


@dataclass(frozen=True)
class NearMiss:
    """Two parts that look like a pair and are none, and why."""

    parts: tuple[str, ...]
    why: str


@dataclass(frozen=True)
class Mark:
    """A named value of a part's coordinate: radians, or the file's length."""

    part: str
    name: str
    value: float


@dataclass(frozen=True)
class Kinematics(Written):
    """How a machine can move; lengths in the file's unit, `status` is `complete`."""

    parts: tuple[str, ...]
    frame: str | None
    pairs: tuple[Pair, ...]
    joints: tuple[Joint, ...]
    subsystems: tuple[Subsystem, ...]
    state_variables: tuple[str, ...]
    interactions: tuple[tuple[str, ...], ...]
    near_misses: tuple[NearMiss, ...]
    closed_chains: tuple[ClosedChain, ...]
    mobility: int
    warnings: tuple[str, ...]
    gravity: Point
    contact: Mapping[str, float]
    units: Mapping[str, Any]
    marks: tuple[Mark, ...]

    def _sentences(self) -> Iterable[str]:
        return (
            f"{len(self.parts)} parts, {len(self.pairs)} pairs, {len(self.subsystems)} subsystems.",
            "Can touch: " + (", ".join("–".join(i) for i in self.interactions) or "none") + ".",
        )


def _pair(p: dict[str, Any]) -> Pair:
    axis = p["axis"]
    line = Axis(tuple(axis["point"]), tuple(axis["direction"])) if axis else None
    return Pair(
        p["kind"],
        p["shape_kind"],
        tuple(p["parts"]),
        line,
        p["ratio"],
        p["clearance"],
        tuple(p["evidence"]),
    )


def _drive(d: dict[str, Any]) -> Drive:
    table = d["table"]
    return Drive(d["speed"], tuple((t, x) for t, x in table) if table is not None else None)


def _joint(j: dict[str, Any]) -> Joint:
    own = dict(j)
    low, high = j["stops"] or (None, None)
    own["center"] = tuple(j["center"]) if j["center"] else None
    own["spring"] = (j["spring"]["relaxed"], j["spring"]["constant"]) if j["spring"] else None
    own["drive"] = _drive(j["drive"]) if j["drive"] else None
    own["stops"] = (low, high)
    return Joint(**own)


def _subsystem(s: dict[str, Any]) -> Subsystem:
    return Subsystem(s["root"], tuple(s["parts"]), tuple(s["ratios"]), s["inertia"], s["locked"])


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
        joints=tuple(_joint(j) for j in o["joints"]),
        subsystems=tuple(_subsystem(s) for s in o["subsystems"]),
        state_variables=tuple(o["state_variables"]),
        interactions=tuple(tuple(i) for i in o["interactions"]),
        near_misses=tuple(NearMiss(tuple(n["parts"]), n["why"]) for n in o["near_misses"]),
        closed_chains=tuple(ClosedChain(tuple(c["parts"]), c["mobility"]) for c in o["closed_chains"]),
        mobility=o["mobility"],
        warnings=tuple(o["warnings"]),
        gravity=tuple(o["gravity"]),
        contact=frozen(o["contact"]),
        units=frozen(o["units"]),
        marks=tuple(Mark(m["part"], m["name"], m["value"]) for m in o["marks"]),
    )
