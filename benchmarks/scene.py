"""The escapement of Gelsey 1995, Figs. 12 and 13, as convex pieces for engines that want them.

Every piece is a block or a circle of the paper's listing. The engines see the planar section that the
wheel's teeth, the lever, the balance's pin and the frame's posts share. To be fair to them they are told
which pieces can ever touch (Mainspring is not); the wheel's hub and the lever's beam, which nothing
reaches, are left out. Angles in radians, other units as in the paper (unnamed and consistent).
"""

from dataclasses import dataclass
from enum import IntFlag
from math import cos, radians, sin

Point = tuple[float, float]

UNTIL = 37.0
TEETH = 10
PIN = (-3.0, 0.0)
POSTS = ((-1.6, 14.0), (1.6, 14.0))
RADIUS = 0.5
# The wheel has turned five teeth by the end: the tenth reversal of the balance comes shortly before 37 s.
WHEEL_AT_END = radians(-180.4)
WHEEL_ALLOWANCE = radians(3.0)


class Touches(IntFlag):
    """What a piece may touch; two pieces that share a flag are tested against each other."""

    NOTHING = 0
    TEETH_AND_PALLETS = 1
    PIN_AND_FORK = 2
    POSTS_AND_STEM = 4


@dataclass(frozen=True)
class Block:
    """A rectangle: its centre about the part's axis, its size, and the angle its x side is turned by."""

    center: Point
    size: Point
    angle: float
    touches: Touches


@dataclass(frozen=True)
class Part:
    """A part that turns about `axis`; torque = -stiffness (angle - relaxed) - friction * speed."""

    name: str
    axis: Point
    inertia: float
    friction: float
    stiffness: float
    relaxed: float


WHEEL = Part("ewheel", (0.0, 0.0), 200.0, 20.0, 20.0, radians(-10000.0))
LEVER = Part("lever", (0.0, 7.5), 10.0, 5.0, 0.0, 0.0)
BALANCE = Part("bwheel", (0.0, 20.0), 20.0, 6.0, 15.0, radians(90.0))
PARTS = (WHEEL, LEVER, BALANCE)


def turned(point: Point, degrees: float) -> Point:
    """Return `point` turned about the origin."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return c * point[0] - s * point[1], s * point[0] + c * point[1]


def piece(size: Point, before: Point, degrees: float, after: Point, touches: Touches) -> Block:
    """Return a block with a corner at the origin, moved by `before`, turned, then moved by `after`."""
    center = turned((before[0] + size[0] / 2, before[1] + size[1] / 2), degrees)
    return Block((center[0] + after[0], center[1] + after[1]), size, radians(degrees), touches)


def teeth() -> list[Block]:
    """Return the ten teeth about the wheel's axis."""
    touches = Touches.TEETH_AND_PALLETS
    return [piece((0.3, 5.4), (-3.2, 0.0), 36.0 * k, (0.0, 0.0), touches) for k in range(TEETH)]


def lever() -> list[Block]:
    """Return the lever's blocks about its pivot, turned by the five degrees of the listing."""
    pallet, stem, fork = Touches.TEETH_AND_PALLETS, Touches.POSTS_AND_STEM, Touches.PIN_AND_FORK
    pieces = (
        piece((0.9, 2.0), (0.0, 0.0), 7.0, (-3.0, -1.9), pallet),
        piece((0.9, 2.0), (0.0, 0.0), 25.0, (-3.0, -1.9), pallet),
        piece((1.0, 2.0), (0.0, 0.1), -40.0, (2.4, -1.8), pallet),
        piece((1.0, 8.0), (-0.5, 8.0), 0.0, (0.0, -7.5), stem),
        piece((1.0, 1.8), (0.0, -1.0), -45.0, (0.0, 8.7), fork),
        piece((1.0, 1.8), (-1.0, -1.0), 45.0, (0.0, 8.7), fork),
    )
    return [Block(turned(p.center, 5.0), p.size, p.angle + radians(5.0), p.touches) for p in pieces]


def corners(block: Block) -> list[Point]:
    """Return the block's corners, counterclockwise."""
    c, s = cos(block.angle), sin(block.angle)
    (x, y), (w, h) = block.center, (block.size[0] / 2, block.size[1] / 2)
    return [(x + c * u - s * v, y + s * u + c * v) for u, v in ((-w, -h), (w, -h), (w, h), (-w, h))]
