"""MuJoCo and pymunk behind one face: a motion to judge, seconds of stepping, and fine steps for the limit."""

from collections.abc import Callable
from dataclasses import dataclass

import with_mujoco
import with_pymunk
from motion import Motion, ticks
from scene import UNTIL

# Steps tried for the largest robust one, ascending, in seconds: where engines begin to fail, a coarser series
# steps over failures (MuJoCo fails at 5.22 ms and not at 5.3, pymunk at 8.22 ms and not at 8.3).
STEPS = (
    *(k * 0.00025 for k in range(2, 16)),
    *(k * 0.0001 for k in range(40, 50)),
    *(k * 0.00002 for k in range(250, 1001)),
)


@dataclass(frozen=True)
class Peer:
    """An engine with a fixed step and one setting of its own.

    `motion(dt)` is the recorded motion of 37 s; `seconds(dt, until)` are the wall seconds of the engine's own
    stepping and the wheel's angle at the end; `fine` are two steps, the finer first; `module` and `more`
    are what peak.py needs to run it.
    """

    name: str
    version: str
    setting: str
    motion: Callable[[float], Motion]
    seconds: Callable[[float, float], tuple[float, float]]
    fine: tuple[float, float]
    module: str
    more: tuple[str, ...] = ()


def _mujoco_seconds(dt: float, until: float) -> tuple[float, float]:
    motion, wall, _ = with_mujoco.simulate(dt, until)
    return wall, float(motion.q[-1, 0])


def mujoco() -> Peer:
    """Return MuJoCo."""
    return Peer(
        with_mujoco.NAME,
        with_mujoco.version(),
        with_mujoco.SETTING,
        lambda dt: with_mujoco.simulate(dt)[0],
        _mujoco_seconds,
        with_mujoco.REFINED,
        "with_mujoco",
    )


def pymunk(iterations: int) -> Peer:
    """Return pymunk with a number of iterations."""
    return Peer(
        with_pymunk.NAME,
        with_pymunk.version(),
        with_pymunk.setting(iterations),
        lambda dt: with_pymunk.motion(dt, iterations),
        lambda dt, until: with_pymunk.seconds(dt, iterations, until),
        with_pymunk.REFINED,
        "with_pymunk",
        (str(iterations),),
    )


def robust_step(peer: Peer) -> float:
    """Return the largest step below which every tested step ticks; success is not monotone in the step."""
    best = 0.0
    for dt in STEPS:
        if not ticks(peer.motion(dt)):
            break
        best = dt
    if best == 0.0:
        raise SystemExit(f"{peer.name}, {peer.setting}, does not tick at its smallest step")
    return best


def chosen() -> list[tuple[Peer, float]]:
    """Return both peers with their largest robust steps; pymunk with the setting faster at its own."""
    settings = [pymunk(n) for n in with_pymunk.ITERATIONS]
    tried = [(p, robust_step(p)) for p in settings]
    for peer, dt in tried:
        print(f"{peer.name}, {peer.setting}: every tested step up to {dt * 1e3:g} ms ticks")
    fastest = min(tried, key=lambda t: min(t[0].seconds(t[1], UNTIL)[0] for _ in range(5)))
    other = mujoco()
    dt = robust_step(other)
    print(f"{other.name}, {other.setting}: every tested step up to {dt * 1e3:g} ms ticks")
    return [(other, dt), fastest]
