"""The pin in the groove: the arm follows the pin as a closed form says, and the run an independent equation.

With the pin at (c cos θ, D + c sin θ) from the arm's axis and upright along y, the middle of the groove
runs through the pin's centre where the arm leans by φ(θ) = -atan2(c cos θ, D + c sin θ).
"""

import math

import numpy as np
import pytest

import mainspring as ms
from conftest import ROOT

MODEL = ROOT / "examples" / "rotary-to-reciprocating" / "rotary-to-reciprocating.padl"
UNTIL = 20.0
CRANK, DEPTH = 3.0, 10.0
WHEEL, ARM = (60.0, 60.0), (100.0, 10.0)  # inertia, friction: those of the supplement
RELAXED, CONSTANT = math.radians(100_000), 0.1


def _run(play: float, rtol: float = 1e-8) -> ms.Simulation:
    return ms.simulate(ms.load(MODEL).compile(play=play), UNTIL, rtol=rtol)


def _off_the_middle(run: ms.Simulation, t: np.ndarray) -> np.ndarray:
    """Return by how much the pin's centre is off the middle of the groove; start at 0."""
    wheel, arm = run.trajectory.at(t).q.T
    x, y = CRANK * np.cos(wheel), DEPTH + CRANK * np.sin(wheel)
    lean = arm - math.atan2(CRANK, DEPTH)
    return np.asarray(x * np.cos(lean) + y * np.sin(lean))


@pytest.fixture(scope="module")
def shipped() -> ms.Simulation:
    return _run(play=0.02)


def test_the_pin_stays_in_the_groove(shipped):
    at_steps = _off_the_middle(shipped, shipped.trajectory.t)
    assert np.max(at_steps) == pytest.approx(0.01, abs=1e-10)
    assert np.min(at_steps) == pytest.approx(-0.01, abs=1e-10)
    between = _off_the_middle(shipped, np.linspace(0, UNTIL, 20_001))
    assert np.max(np.abs(between)) < 0.01 + 1e-6


def test_while_they_touch_the_pin_is_at_one_face(shipped):
    times = np.linspace(0.011, UNTIL - 0.003, 1999)
    touching = [t for t in times if shipped.trajectory.contacts(t)]
    assert len(touching) > 1500
    assert np.abs(_off_the_middle(shipped, np.array(touching))) == pytest.approx(0.01, abs=1e-6)


def test_the_groove_is_kept_better_the_more_is_asked():
    times = np.linspace(0, UNTIL, 5001)
    beyond = [np.max(np.abs(_off_the_middle(_run(0.02, rtol=r), times))) - 0.01 for r in (1e-8, 1e-10, 1e-12)]
    assert beyond[1] < 0.1 * beyond[0]
    assert beyond[2] < 1e-9


def test_the_work_is_bounded(shipped):
    assert shipped.status == "complete"
    assert abs(shipped.energy.residual) < 1e-7
    assert shipped.stats["gap_evaluations"] <= 40_000
    assert 2 * 8 <= shipped.stats["impacts"] <= 2 * 10


def _slope(wheel: float) -> tuple[float, float]:
    """Return dφ/dθ and d²φ/dθ² of the arm's lean."""
    square = CRANK**2 + DEPTH**2 + 2 * CRANK * DEPTH * math.sin(wheel)
    first = (CRANK**2 + CRANK * DEPTH * math.sin(wheel)) / square
    change = CRANK * DEPTH * math.cos(wheel)
    return first, change * (1 - 2 * first) / square


def _acceleration(wheel: float, speed: float) -> float:
    """Return the wheel's, from Lagrange's equation of the machine without play, which has one freedom."""
    first, second = _slope(wheel)
    inertia = WHEEL[0] + ARM[0] * first**2
    friction = WHEEL[1] + ARM[1] * first**2
    drive = CONSTANT * (RELAXED - wheel)
    return (drive - friction * speed - ARM[0] * first * second * speed**2) / inertia


def _without_play(steps: int) -> float:
    """Return the wheel's angle at the end, by the classical method of Runge and Kutta."""
    h, q, v = UNTIL / steps, 0.0, 0.0
    for _ in range(steps):
        a = _acceleration(q, v)
        b = _acceleration(q + h / 2 * v, v + h / 2 * a)
        c = _acceleration(q + h / 2 * (v + h / 2 * a), v + h / 2 * b)
        d = _acceleration(q + h * (v + h / 2 * b), v + h * c)
        q, v = q + h * v + h * h / 6 * (a + b + c), v + h / 6 * (a + 2 * b + 2 * c + d)
    return q


def test_with_hardly_any_play_it_moves_as_a_machine_of_one_freedom():
    end = _without_play(4000)
    assert end == pytest.approx(_without_play(2000), abs=1e-8)
    off = [abs(_run(play=p).positions["wheel"] - end) for p in (1e-4, 1e-6)]
    assert off[0] < 1e-4
    assert off[1] < 1e-6
