"""From segments to SVG paths: lines stay lines and arcs stay arcs.

Paths are written with y up; whoever places them flips the picture once. Convex arcs and circles run
counterclockwise, which with y up is SVG's positive sweep.
"""

import math
from typing import Any

Segment = dict[str, Any]
Xy = tuple[float, float]


def number(x: float) -> str:
    """Return a short decimal, exact enough for a picture (six significant digits)."""
    return f"{x + 0.0:.6g}" if abs(x) > 1e-9 else "0"


def _xy(p: Any) -> str:  # noqa: ANN401
    return f"{number(p[0])} {number(p[1])}"


def sweep(segment: Segment) -> float:
    """Return the angle an arc spans, in (0, 2 pi], along its direction."""
    (cx, cy), a, b = segment["center"], segment["from"], segment["to"]
    turn = math.atan2(b[1] - cy, b[0] - cx) - math.atan2(a[1] - cy, a[0] - cx)
    turn = turn if segment["convex"] else -turn
    return turn % (2 * math.pi) or 2 * math.pi


def at_angle(segment: Segment, share: float) -> Xy:
    """Return the point after this share of an arc or circle."""
    cx, cy = segment["center"]
    if segment["kind"] == "circle":
        start, span = 0.0, 2 * math.pi
    else:
        start = math.atan2(segment["from"][1] - cy, segment["from"][0] - cx)
        span = sweep(segment)
    angle = start + share * (span if segment["convex"] else -span)
    return cx + segment["radius"] * math.cos(angle), cy + segment["radius"] * math.sin(angle)


def _arc_to(segment: Segment, end: Xy) -> str:
    radius = number(segment["radius"])
    return f"A{radius} {radius} 0 0 {int(segment['convex'])} {_xy(end)}"


def drawn(segment: Segment) -> str:
    """Return the path commands that continue from the segment's start to its end."""
    if segment["kind"] == "line":
        return f"L{_xy(segment['to'])}"
    if segment["kind"] == "arc" and sweep(segment) < math.pi:
        return _arc_to(segment, tuple(segment["to"]))
    cuts = (1 / 3, 2 / 3, 1.0)
    return "".join(_arc_to(segment, at_angle(segment, c)) for c in cuts)


def start(segment: Segment) -> Xy:
    """Return where a segment starts; a circle starts at angle zero."""
    if segment["kind"] == "circle":
        return at_angle(segment, 0.0)
    return segment["from"][0], segment["from"][1]


def path(loops: list[list[Segment]]) -> str:
    """Return one path for all loops of a layer."""
    pieces = []
    for loop in loops:
        if loop:
            pieces.append(f"M{_xy(start(loop[0]))}" + "".join(map(drawn, loop)) + "Z")
    return "".join(pieces)


def edge_path(segment: Segment) -> str:
    """Return one segment as a path of its own, to be lit when it touches."""
    return f"M{_xy(start(segment))}" + drawn(segment)


def points(loops: list[list[Segment]]) -> list[Xy]:
    """Return points on the loops whose bounds are the loops' bounds, nearly."""
    found: list[Xy] = []
    for segment in (s for loop in loops for s in loop):
        found.append(start(segment))
        if segment["kind"] != "line":
            found += [at_angle(segment, k / 8) for k in range(1, 8)]
    return found
