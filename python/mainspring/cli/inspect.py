"""`mainspring inspect`: how the parts can move and touch, and why."""

from argparse import Namespace
from pathlib import Path

import mainspring as ms
from mainspring.cli import opening, output, tables
from mainspring.pairs import Axis, Joint, Kinematics, Pair
from mainspring.result import counted

_MOVES = {"revolute": "turns", "prismatic": "slides", "cylindrical": "turns and slides"}


def run(options: Namespace) -> None:
    """Print the analysis; with `--svg` draw the machine first."""
    mechanism = opening.mechanism(options)
    found = ms.find_pairs(mechanism)
    opening.warn(found.warnings)
    if options.svg:
        from mainspring.drawing import draw

        output.write_text(Path(options.svg), draw(mechanism.outlines(), title=mechanism.name))
    if options.json:
        output.print_json(found.to_json())
    else:
        account(mechanism, found)
        if options.svg:
            print(f"\ndrawing: {options.svg}")


def account(mechanism: "ms.Mechanism", found: Kinematics) -> None:
    """Say the analysis in sentences, then in tables."""
    print(f"{mechanism.name}: " + "\n".join(sentences(found)))
    tables.show("pairs", ("parts", "kind", "axis through", "along"), map(_pair_row, found.pairs))
    reasons = ((" – ".join(p.parts), "; ".join(counted(p.evidence))) for p in found.pairs)
    tables.show("why they are pairs", ("parts", "evidence"), reasons)
    acting = ((j.part, j.carrier, "; ".join(_acting(j))) for j in found.joints if _tells(j, found.frame))
    tables.show("joints with more than spring and friction", ("part", "on", "what acts"), acting)
    rows = ((s.root, ", ".join(s.parts), _inertia(s.inertia)) for s in found.subsystems)
    tables.show("subsystems", ("root", "parts", "inertia"), rows, numeric=(2,))
    misses = ((" – ".join(n.parts), n.why) for n in found.near_misses)
    tables.show("no pairs, though alike", ("parts", "why not"), misses)


def sentences(found: Kinematics) -> list[str]:
    """Return what moves, what can touch and how many numbers describe the state."""
    by_kind: dict[str, list[str]] = {}
    for pair in found.pairs:
        moving = [p for p in pair.parts if p != found.frame]
        if pair.kind in _MOVES and len(moving) == 1:
            by_kind.setdefault(pair.kind, []).append(moving[0])
    said = [f"{listed(names)} {_verb(kind, names)}." for kind, names in by_kind.items()]
    said += [f"{part} {verb} on {carrier}." for part, verb, carrier in _carried(found)]
    chains = [
        f"{listed(list(c.parts))} form a closed chain, mobility {c.mobility}." for c in found.closed_chains
    ]
    said += chains
    gears = [" and ".join(p.parts) for p in found.pairs if p.kind == "gear"]
    said += [f"{listed(gears)} mesh as gears."] if gears else []
    if any(found.gravity):
        said.append("Gravity: (" + ", ".join(tables.signed(g) for g in found.gravity) + ").")
    touching = listed(["–".join(i) for i in found.interactions])
    said.append(f"Can ever touch: {touching}." if touching else "No parts can ever touch.")
    said.append(f"State: {len(found.state_variables)} variables.")
    return said


def _carried(found: Kinematics) -> list[tuple[str, str, str]]:
    """Return the parts that turn or slide on other moving parts."""
    return [(j.part, f"{j.motion}s", j.carrier) for j in found.joints if j.carrier != found.frame]


def _tells(joint: Joint, frame: str | None) -> bool:
    return joint.carrier != frame or bool(_acting(joint))


def _acting(joint: Joint) -> list[str]:
    """Return what acts on a part beside spring and viscous friction, in words."""
    said = []
    if joint.drive and joint.drive.speed is not None:
        said.append(f"driven at {tables.coordinate(joint.drive.speed, joint.motion)} per time")
    elif joint.drive and joint.drive.table is not None:
        said.append(f"driven by a table of {len(joint.drive.table)} points")
    what = "torque" if joint.motion == "turn" else "force"
    said += [f"constant {what} {tables.signed(joint.torque)}"] if joint.torque else []
    said += [f"dry friction {tables.signed(joint.coulomb)}"] if joint.coulomb else []
    low, high = (None if s is None else tables.coordinate(s, joint.motion) for s in joint.stops)
    if low and high:
        said.append(f"stops at {low} and {high}")
    elif low or high:
        said.append(f"{'lower' if low else 'upper'} stop at {low or high}")
    return said


def _verb(kind: str, names: list[str]) -> str:
    axis = "an axis fixed in the frame" if kind != "prismatic" else "a direction fixed in the frame"
    how = {"revolute": "about", "prismatic": "along", "cylindrical": "about and along"}[kind]
    verb = (
        _MOVES[kind] if len(names) == 1 else _MOVES[kind].replace("turns", "turn").replace("slides", "slide")
    )
    return f"{verb} {how} {axis}" if len(names) == 1 else f"each {verb} {how} {axis}"


def listed(words: list[str]) -> str:
    """Return words with commas and a last "and"."""
    if len(words) < 2:
        return "".join(words)
    return ", ".join(words[:-1]) + " and " + words[-1]


def _inertia(value: float | None) -> str:
    return "not given" if value is None else tables.signed(value)


def _pair_row(pair: Pair) -> tuple[str, str, str, str]:
    kind = pair.kind if pair.kind == pair.shape_kind else f"{pair.kind} (shape: {pair.shape_kind})"
    through, along = _axis(pair.axis)
    if pair.ratio is not None:
        along = f"ratio {tables.signed(pair.ratio)}"
    return " – ".join(pair.parts), kind, through, along


def _axis(axis: Axis | None) -> tuple[str, str]:
    if not axis:
        return "", ""
    point = ", ".join(tables.signed(v, 4) for v in axis.point)
    for name, unit in zip("xyz", ((1, 0, 0), (0, 1, 0), (0, 0, 1)), strict=True):
        if axis.direction == unit:
            return f"({point})", name
    return f"({point})", "(" + ", ".join(tables.signed(v, 4) for v in axis.direction) + ")"
