"""Compliant contact beside SciPy's Radau: the same law on equations written anew.

Two machines: the pin in its groove (rotary to reciprocating), whose geometry is a few lines of
trigonometry, and the escapement until its balance has met the lever, with the lines and circles of three
contacts written out. SciPy integrates the law as it stands, switches and clamp included. Run with
`benchmarks/.venv/bin/python benchmarks/independent.py` after `make build` and `make benchmarks/.venv/ready`.
"""

import json
from collections.abc import Callable
from math import atan2, cos, pi, radians, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import machines
import with_mainspring

Array = NDArray[np.float64]
E, D, M = 1e5, 1e4, 100.0
TOLERANCE = 1e-10
FINE = 1e-9  # of Mainspring


def force(depth: float, rate: float) -> float:
    """Return the force of Gelsey's Eq. 4, corrected and clamped."""
    slope = E + D * M * rate
    return depth * slope if depth > 0 and slope > 0 else 0.0


def cross(a: Array, b: Array) -> float:
    """Return the third component of a vector product."""
    return float(a[0] * b[1] - a[1] * b[0])


WHEEL, ARM = 60.0, 100.0  # moments of inertia


def rocker(_t: float, y: Array) -> list[float]:
    """Return the derivative of wheel and arm: a pin in a groove wider by 0.02."""
    wheel, arm, wheel_speed, arm_speed = y
    pin = np.array([3 * cos(wheel), 3 * sin(wheel)])
    axis = np.array([0.0, -10.0])
    lean = -atan2(3.0, 10.0) + arm
    across = np.array([cos(lean), sin(lean)])
    arm_to_pin = pin - axis
    off = float(across @ arm_to_pin)
    pin_velocity = wheel_speed * np.array([-pin[1], pin[0]])
    groove_velocity = arm_speed * np.array([-arm_to_pin[1], arm_to_pin[0]])
    rate = float(across @ (pin_velocity - groove_velocity))
    side = 1.0 if off > 0 else -1.0
    push = side * force(side * off - 0.01, side * rate) * across
    wheel_torque = -cross(pin, push) - 0.1 * (wheel - radians(100000)) - 60 * wheel_speed
    arm_torque = cross(arm_to_pin, push) - 10 * arm_speed
    return [wheel_speed, arm_speed, wheel_torque / WHEEL, arm_torque / ARM]


def turned(point: Array, angle: float, about: Array) -> Array:
    """Return a point turned about another."""
    c, s = cos(angle), sin(angle)
    d = point - about
    return about + np.array([c * d[0] - s * d[1], s * d[0] + c * d[1]])


WHEEL_AXIS, LEVER_AXIS, BALANCE_AXIS = np.zeros(2), np.array([0.0, 7.5]), np.array([0.0, 20.0])
CENTERS = (WHEEL_AXIS, LEVER_AXIS, BALANCE_AXIS)


def touch(
    q: Array, v: Array, point: Array, on: int | None, line: tuple[Array, Array], radius: float
) -> list[float]:
    """Return the torques on wheel, lever and balance where a round point of a body meets a line of the lever.

    `point` is where the body is modelled (`on`: 0 wheel, 2 balance, None the frame); `line` is a point on
    the lever as modelled and its outward normal.
    """
    at = point if on is None else turned(point, q[on], CENTERS[on])
    base = turned(line[0], q[1], LEVER_AXIS)
    normal = turned(line[0] + line[1], q[1], LEVER_AXIS) - base
    depth = radius - float(normal @ (at - base))
    foot = at - radius * normal
    velocity = np.zeros(2)
    if on is not None:
        arm = at - CENTERS[on]
        velocity = v[on] * np.array([-arm[1], arm[0]])
    lever_arm = at - LEVER_AXIS
    lever_velocity = v[1] * np.array([-lever_arm[1], lever_arm[0]])
    push = force(depth, -float(normal @ (velocity - lever_velocity))) * normal
    torques = [0.0, 0.0, 0.0]
    torques[1] -= cross(foot - LEVER_AXIS, push)
    if on is not None:
        torques[on] += cross(at - radius * normal - CENTERS[on], push)
    return torques


def placed(x: float, y: float, *moves: tuple[str, float]) -> Array:
    """Return a point of the listing after its motions, `at (…)`, left to right."""
    p = np.array([x, y])
    for kind, amount in moves:
        if kind == "degz":
            p = turned(p, radians(amount), np.zeros(2))
        else:
            p = p + (np.array([amount, 0.0]) if kind == "movx" else np.array([0.0, amount]))
    return p


def on_lever(points: list[Array]) -> list[Array]:
    """Return points of the lever's solids as it is drawn: turned by 5 degrees about its axis."""
    return [turned(p, radians(5), LEVER_AXIS) for p in points]


def outward(a: Array, b: Array) -> tuple[Array, Array]:
    """Return the line from a to b with material to its left: its outward normal is to the right."""
    along = (b - a) / np.hypot(*(b - a))
    return a, np.array([along[1], -along[0]])


Contact = tuple[Array, int | None, tuple[Array, Array], float]


def contacts() -> list[Contact]:
    """Return the contacts of the first 1.9 s: tooth on entry pallet, stop on lever, pin on fork."""
    flank = [("degz", 25.0), ("movx", -3.0), ("movy", 5.6)]
    fork = [("movy", -1.0), ("degz", -45.0), ("movy", 16.2)]
    return [
        (np.array([-2.9, 5.4]), 0, face(placed(0, 2, *flank), placed(0, 0, *flank)), 0.0),
        (np.array([-1.6, 14.0]), None, face(np.array([-0.5, 16.0]), np.array([-0.5, 8.0])), 0.5),
        (np.array([-3.0, 20.0]), 2, face(placed(0, 1.8, *fork), placed(0, 0, *fork)), 0.5),
    ]


def face(a: Array, b: Array) -> tuple[Array, Array]:
    """Return a face of the lever's solids as drawn, turned by 5 degrees: a point, the normal right of ab."""
    a, b = (turned(p, radians(5), LEVER_AXIS) for p in (a, b))
    along = (b - a) / np.hypot(*(b - a))
    return a, np.array([along[1], -along[0]])


CONTACTS = contacts()
INERTIA, FRICTION = np.array([200.0, 10.0, 20.0]), np.array([20.0, 5.0, 6.0])
SPRING, RELAXED = np.array([20.0, 0.0, 15.0]), np.array([radians(-10000), 0.0, pi / 2])


def escapement(_t: float, y: Array) -> Array:
    """Return the derivative of wheel, lever and balance."""
    q, v = y[:3], y[3:]
    torque = -SPRING * (q - RELAXED) - FRICTION * v
    for point, on, line, radius in CONTACTS:
        torque = torque + touch(q, v, point, on, line, radius)
    return np.concatenate((v, torque / INERTIA))


def reference(f: Callable[[float, Array], Any], n: int, until: float) -> Array:
    """Return the positions at a time, from rest as modelled."""
    scale = TOLERANCE * np.concatenate((np.full(n, 1e-2), np.full(n, 1.0)))
    done = solve_ivp(f, (0.0, until), np.zeros(2 * n), "Radau", rtol=TOLERANCE, atol=scale, max_step=0.02)
    assert done.success, done.message
    return np.asarray(done.y[:n, -1])


def ours(model: str, until: float) -> Array:
    """Return Mainspring's positions at a time."""
    program = str(with_mainspring.ROOT / with_mainspring.PROGRAM)
    options = ("--contact=compliant", f"--rtol={FINE!r}", f"--until={until!r}", "--json")
    found = json.loads(with_mainspring.call(program, "simulate", model, *options))
    return np.array(list(found["positions"].values()))


def main() -> None:
    """Print both programs' positions and their distance."""
    cases = [("rocker", machines.ROCKER, rocker, 2, t) for t in (2.0, 10.0, 20.0)]
    cases += [("escapement", with_mainspring.ESCAPEMENT, escapement, 3, t) for t in (0.2, 1.0, 1.82, 1.9)]
    print("machine       until s  positions of Radau                        greatest distance")
    for name, model, f, n, until in cases:
        theirs = reference(f, n, until)
        apart = np.abs(theirs - ours(model, until)).max()
        shown = ", ".join(f"{x:.9f}" for x in theirs)
        print(f"{name:12s} {until:8g}  {shown:42s} {apart:.1e}")


if __name__ == "__main__":
    main()
