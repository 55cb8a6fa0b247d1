"""The escapement in pymunk (Chipmunk): pivots, damped rotary springs, convex pieces without bounce."""

import time

import numpy as np
import pymunk

from motion import Motion
from scene import PARTS, PIN, POSTS, RADIUS, UNTIL, Touches, corners, lever, teeth

NAME = "pymunk"
# Chipmunk's own number, and the one that ticks at longer steps.
ITERATIONS = (10, 50)
# Chipmunk's own default, 0.1, is a third of a tooth's width: with it the machine locks.
SLOP = 0.001
# The two fine steps that the limit and its doubt are taken from.
REFINED = (5e-5, 1e-4)
MASS = 10.0


def version() -> str:
    """Return the engine's version."""
    return str(pymunk.version)


def bodies(space: pymunk.Space) -> list[pymunk.Body]:
    """Add the three parts with pivot, spring and damper; return them in the order of the scene."""
    made = []
    for part in PARTS:
        body = pymunk.Body(MASS, part.inertia)
        body.position = part.axis
        pivot = pymunk.PivotJoint(space.static_body, body, part.axis)
        # Chipmunk measures the angle of the first body against the second: the relaxed angle changes sign.
        spring = pymunk.DampedRotarySpring(
            space.static_body, body, -part.relaxed, part.stiffness, part.friction
        )
        space.add(body, pivot, spring)
        made.append(body)
    return made


def shapes(space: pymunk.Space, wheel: pymunk.Body, arm: pymunk.Body, balance: pymunk.Body) -> None:
    """Add the pieces, each seen only by those it may touch."""
    for body, blocks in ((wheel, teeth()), (arm, lever())):
        for block in blocks:
            space.add(smooth(pymunk.Poly(body, corners(block)), block.touches))
    space.add(smooth(pymunk.Circle(balance, RADIUS, PIN), Touches.PIN_AND_FORK))
    for post in POSTS:
        space.add(smooth(pymunk.Circle(space.static_body, RADIUS, post), Touches.POSTS_AND_STEM))


def smooth(shape: pymunk.Shape, touches: Touches) -> pymunk.Shape:
    """Return the shape without friction and bounce."""
    shape.filter = pymunk.ShapeFilter(categories=int(touches), mask=int(touches))
    shape.friction, shape.elasticity = 0.0, 0.0
    return shape


def setting(iterations: int) -> str:
    """Return the words for the table."""
    return f"{iterations} iterations, slop {SLOP}"


def machine(iterations: int) -> tuple[pymunk.Space, list[pymunk.Body]]:
    """Return a new machine at rest as modelled."""
    space = pymunk.Space()
    space.iterations, space.collision_slop = iterations, SLOP
    made = bodies(space)
    shapes(space, *made)
    return space, made


def motion(dt: float, iterations: int) -> Motion:
    """Return the motion of the first 37 s."""
    steps = round(UNTIL / dt)
    space, made = machine(iterations)
    q, v = np.empty((steps, len(PARTS))), np.empty((steps, len(PARTS)))
    for k in range(steps):
        space.step(dt)
        q[k] = [b.angle for b in made]
        v[k] = [b.angular_velocity for b in made]
    return Motion(np.linspace(dt, steps * dt, steps), q, v)


def seconds(dt: float, iterations: int, until: float = UNTIL) -> tuple[float, float]:
    """Return the wall seconds of stepping alone, and the wheel's angle at the end."""
    space, made = machine(iterations)
    step, steps = space.step, range(round(until / dt))
    began = time.perf_counter()
    for _ in steps:
        step(dt)
    return time.perf_counter() - began, made[0].angle


def simulate(dt: float, until: float, iterations: float) -> None:
    """Run and keep nothing, to measure memory."""
    seconds(dt, int(iterations), until)
