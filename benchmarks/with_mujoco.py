"""The escapement in MuJoCo: hinges with spring and damper, blocks and spheres, contacts without friction.

Each centre of mass sits a little off its hinge, with the same inertia about the hinge: with the mass on
the axis the contact's inverse weight in translation is zero and contacts blow up. `solref` is four steps:
a shorter time constant is stiffer than the step can carry.
"""

import time
from math import degrees

import mujoco
import numpy as np
from mujoco import rollout

from motion import Motion
from scene import (
    BALANCE,
    LEVER,
    PARTS,
    PIN,
    POSTS,
    RADIUS,
    UNTIL,
    WHEEL,
    Block,
    Part,
    Point,
    Touches,
    lever,
    teeth,
)

NAME = "mujoco"
SETTING = "solref 4 dt, implicitfast, dense"
# The two fine steps that the limit and its doubt are taken from.
REFINED = (2.5e-5, 5e-5)
OFFSET, MASS = 0.1, 1.0
STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS


def version() -> str:
    """Return the engine's version."""
    return str(mujoco.__version__)


def bits(touches: Touches) -> str:
    """Return the attributes that say what a piece may touch."""
    return f'contype="{int(touches)}" conaffinity="{int(touches)}"'


def block_geom(block: Block) -> str:
    """Return the XML of a block of unit thickness."""
    (x, y), (w, h) = block.center, block.size
    return (
        f'<geom type="box" pos="{x!r} {y!r} 0" euler="0 0 {degrees(block.angle)!r}" '
        f'size="{w / 2!r} {h / 2!r} 0.5" {bits(block.touches)}/>'
    )


def sphere_geom(center: Point, touches: Touches) -> str:
    """Return the XML of a sphere, whose section in the plane is the pin's or post's circle."""
    return f'<geom type="sphere" pos="{center[0]!r} {center[1]!r} 0" size="{RADIUS!r}" {bits(touches)}/>'


def body(part: Part, geoms: list[str]) -> str:
    """Return the XML of a part on its hinge."""
    central = part.inertia - MASS * OFFSET**2
    return (
        f'<body pos="{part.axis[0]!r} {part.axis[1]!r} 0">'
        f'<inertial pos="{OFFSET!r} 0 0" mass="{MASS!r}" diaginertia="{central!r} {central!r} {central!r}"/>'
        f'<joint type="hinge" axis="0 0 1" stiffness="{part.stiffness!r}" damping="{part.friction!r}" '
        f'springref="{degrees(part.relaxed)!r}"/>{"".join(geoms)}</body>'
    )


def model(dt: float) -> mujoco.MjModel:
    """Return the compiled machine for one time step."""
    bodies = (
        body(WHEEL, [block_geom(b) for b in teeth()]),
        body(LEVER, [block_geom(b) for b in lever()]),
        body(BALANCE, [sphere_geom(PIN, Touches.PIN_AND_FORK)]),
    )
    posts = (sphere_geom(p, Touches.POSTS_AND_STEM) for p in POSTS)
    text = (
        f'<mujoco><option gravity="0 0 0" timestep="{dt!r}" integrator="implicitfast" jacobian="dense"/>'
        f'<default><geom condim="1" solref="{4 * dt!r} 1"/></default>'
        f"<worldbody>{''.join(posts)}{''.join(bodies)}</worldbody></mujoco>"
    )
    return mujoco.MjModel.from_xml_string(text)


def simulate(dt: float, until: float = UNTIL) -> tuple[Motion, float, int]:
    """Return the motion, the wall seconds of MuJoCo's own rollout in C, and the number of steps."""
    machine = model(dt)
    data = mujoco.MjData(machine)
    start = np.zeros(mujoco.mj_stateSize(machine, STATE))
    mujoco.mj_getState(machine, data, start, STATE)
    steps = round(until / dt)
    began = time.perf_counter()
    states, _ = rollout.rollout(machine, data, start[None], nstep=steps)
    wall = time.perf_counter() - began
    rows, n = np.asarray(states[0]), len(PARTS)
    return Motion(rows[:, 0], rows[:, 1 : 1 + n], rows[:, 1 + n : 1 + 2 * n]), wall, steps
