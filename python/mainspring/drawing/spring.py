"""Springs drawn as springs: a spiral for a turning part, a zigzag for a sliding one.

The shape follows the motion: the spiral's inner end turns with the part while its outer end stays.
How many coils are drawn says how strongly it is wound, not how many it has.
"""

import math
from dataclasses import dataclass
from typing import Any

from mainspring.drawing.outline import Xy, number
from mainspring.drawing.pose import Part, part_points

_MOST_TURNS = 7.0
_LEAST_TURNS = 3.0


@dataclass(frozen=True)
class Spiral:
    """A spiral spring about `center` between two radii, with its winding (radians) at q = 0."""

    center: Xy
    inner: float
    outer: float
    winding: float

    def path(self, q: float) -> str:
        """Return its curve (y up) at joint position `q`."""
        total = self.winding + q
        count = max(24, int(abs(total) * 6))
        return "M" + "L".join(self._point(k / count, total) for k in range(count + 1))

    def _point(self, s: float, total: float) -> str:
        angle = 0.75 * math.pi + (1 - s) * total
        radius = self.inner + s * (self.outer - self.inner)
        x, y = self.center
        return f"{number(x + radius * math.cos(angle))} {number(y + radius * math.sin(angle))}"

    @property
    def fixed(self) -> Xy:
        """The end held by the frame."""
        slant = math.sqrt(0.5) * self.outer
        return self.center[0] - slant, self.center[1] + slant

    def data(self) -> dict[str, Any]:
        """Return what the page needs to draw it."""
        return {"kind": "spiral", "c": self.center, "r": [self.inner, self.outer], "w": self.winding}


@dataclass(frozen=True)
class Coil:
    """A zigzag from a fixed end to a moving one, along `direction`."""

    end: Xy
    direction: Xy
    length: float
    width: float

    def path(self, q: float) -> str:
        """Return its line (y up) at joint position `q`."""
        (x, y), (dx, dy) = self.end, self.direction
        span = self.length + q
        steps = [(0.0, 0.0), (0.12, 0.0)]
        steps += [(0.12 + 0.76 * (k + 0.5) / 14, self.width * (-1) ** k) for k in range(14)]
        steps += [(0.88, 0.0), (1.0, 0.0)]
        at = [(a * span - self.length, b) for a, b in steps]
        return "M" + "L".join(f"{number(x + a * dx - b * dy)} {number(y + a * dy + b * dx)}" for a, b in at)

    @property
    def fixed(self) -> Xy:
        """The end held by the frame."""
        return self.end[0] - self.length * self.direction[0], self.end[1] - self.length * self.direction[1]

    def data(self) -> dict[str, Any]:
        """Return what the page needs to draw it."""
        return {"kind": "coil", "e": self.end, "d": self.direction, "l": self.length, "b": self.width}


def _spiral(part: Part, relaxed: float) -> Spiral:
    x, y = part["motion"]["center"]
    reach = max(math.hypot(px - x, py - y) for px, py in part_points(part))
    turns = min(_MOST_TURNS, _LEAST_TURNS + 0.4 * abs(relaxed) / (2 * math.pi))
    sign = 1.0 if relaxed <= 0 else -1.0
    return Spiral((x, y), 0.15 * reach, 0.42 * reach, sign * 2 * math.pi * turns)


def _coil(part: Part, relaxed: float, size: float) -> Coil:
    dx, dy = part["motion"]["direction"]
    found = part_points(part)
    along = min(px * dx + py * dy for px, py in found)
    across = sum(-px * dy + py * dx for px, py in found) / len(found)
    end = (along * dx - across * dy, along * dy + across * dx)
    return Coil(end, (dx, dy), max(0.2 * size, 1.4 * abs(relaxed)), 0.025 * size)


def shape(part: Part, spring: dict[str, Any], size: float) -> Spiral | Coil | None:
    """Return the drawn form of a spring between a part and the frame; None for a fixed part."""
    if not part["motion"] or not part_points(part):
        return None
    if part["motion"]["kind"] == "turn":
        return _spiral(part, spring["relaxed"])
    return _coil(part, spring["relaxed"], size)
