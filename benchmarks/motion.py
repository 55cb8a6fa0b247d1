"""What is read off a recorded motion: does it tick, and with what period."""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from scene import UNTIL, WHEEL_ALLOWANCE, WHEEL_AT_END

Array = NDArray[np.float64]
# A reversal counts outside this swing about the balance's rest at 90 degrees; a pin that rebounds does not.
SWING = pi / 2


@dataclass(frozen=True)
class Motion:
    """Times, and angles and speeds of wheel, lever and balance in columns."""

    t: Array
    q: Array
    v: Array


def reversals(motion: Motion) -> Array:
    """Return the times at which the balance turns back, by the line through two samples of its speed."""
    speed = motion.v[:, 2]
    far = np.abs(motion.q[1:, 2] - pi / 2) > SWING
    k = np.flatnonzero((speed[:-1] * speed[1:] < 0) & far)
    share = speed[k] / (speed[k] - speed[k + 1])
    return np.asarray(motion.t[k] + share * (motion.t[k + 1] - motion.t[k]))


def ticks(motion: Motion) -> bool:
    """Return whether the wheel let five teeth pass, no fewer and no more, one with each two swings.

    The tenth reversal comes at 36.92 s: a slow engine may miss it before the end without having failed.
    """
    final = float(np.interp(UNTIL, motion.t, motion.q[:, 0]))
    return len(reversals(motion)) in (9, 10) and abs(final - WHEEL_AT_END) < WHEEL_ALLOWANCE


def period(times: Array) -> float:
    """Return the mean duration of a pattern (two reversals) from the third to the ninth, in seconds."""
    return float(times[8] - times[2]) / 3
