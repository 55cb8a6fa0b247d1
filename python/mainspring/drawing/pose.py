"""Where parts are at given joint positions, and how much room the picture needs.

A joint moves its part against the part's carrier; a part's place is the product of the motions from the frame
outwards.
"""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from mainspring.drawing.outline import Xy, number, points

Part = dict[str, Any]


def chain(parts: Mapping[str, Part], name: str) -> list[Part]:
    """Return the parts with a motion that carry a part, from the frame outwards, and the part itself."""
    found: list[Part] = []
    at: str | None = name
    for _ in range(len(parts)):
        if at is None or at not in parts:
            break
        found.append(parts[at])
        at = parts[at].get("carrier")
    return [part for part in reversed(found) if part["motion"]]


def placed(parts: Mapping[str, Part], name: str, pose: Mapping[str, float]) -> str:
    """Return the SVG transform (y up) of a part where all joint positions are those of `pose`."""
    moves = (transform(part, pose.get(part["name"], 0.0)) for part in chain(parts, name))
    return " ".join(move for move in moves if move)


def transform(part: Part, q: float) -> str:
    """Return the SVG transform (y up) of a part against its carrier at joint position `q`."""
    motion = part["motion"]
    if not motion or q == 0:
        return ""
    if motion["kind"] == "turn":
        x, y = motion["center"]
        return f"rotate({number(math.degrees(q))} {number(x)} {number(y)})"
    x, y = motion["direction"]
    return f"translate({number(q * x)} {number(q * y)})"


def moved(part: Part, q: float, p: Xy) -> Xy:
    """Return a point of a part, given as modelled, at joint position `q` against its carrier."""
    motion = part["motion"]
    if not motion:
        return p
    if motion["kind"] == "slide":
        x, y = motion["direction"]
        return p[0] + q * x, p[1] + q * y
    (x, y), c, s = motion["center"], math.cos(q), math.sin(q)
    dx, dy = p[0] - x, p[1] - y
    return x + c * dx - s * dy, y + s * dx + c * dy


def part_points(part: Part) -> list[Xy]:
    """Return points that span a part as modelled, gear circles included."""
    found = [p for layer in part["layers"] for p in points(layer["loops"])]
    for gear in part["gears"]:
        (x, y), r = gear["center"], gear["radius"]
        found += [(x - r, y), (x + r, y), (x, y - r), (x, y + r)]
    return found


def bounds(
    parts: list[Part], poses: Iterable[Mapping[str, float]], others: Iterable[Xy] = ()
) -> tuple[float, float, float, float]:
    """Return the box (left, bottom, right, top) of all parts in all these poses and of other points."""
    spans = {part["name"]: part_points(part) for part in parts}
    named = {part["name"]: part for part in parts}
    chains = {name: chain(named, name)[::-1] for name in named}
    found = list(others)
    for pose in poses:
        for name, span in spans.items():
            for part in chains[name]:
                span = [moved(part, pose.get(part["name"], 0.0), p) for p in span]
            found += span
    if not found:
        return -1.0, -1.0, 1.0, 1.0
    xs, ys = [p[0] for p in found], [p[1] for p in found]
    return min(xs), min(ys), max(xs), max(ys)
