"""The ratchet: blocked one way, with a rest and forces known by hand; free the other way, tooth by tooth."""

import json
import math

import numpy as np
import pytest

import mainspring as ms
from conftest import ROOT

FOLDER = ROOT / "examples" / "ratchet"
FLOOR, TIP, NOSE = 4.4, 5.0, 0.25
PIVOT = np.array([-4.5, 8.0])
TOOTH = math.radians(30)


def _mechanism(supplement: str, **changed: float) -> ms.Mechanism:
    return ms.load(FOLDER / "ratchet.padl", FOLDER / supplement).compile(**changed)


def _run(until: float, supplement: str = "ratchet.sup", start=None, **changed: float) -> ms.Simulation:
    return ms.simulate(_mechanism(supplement, **changed), until, forces=True, positions=start)


def _moment(arm: np.ndarray, force: tuple[float, float]) -> float:
    return float(arm[0] * force[1] - arm[1] * force[0])


def _forces_by_hand(nose: float) -> tuple[float, float]:
    """Return the forces of the radial face and of the floor on the nose, from the moments on both parts."""
    on_face, on_floor = np.array([0, FLOOR + nose]), np.array([-nose, FLOOR])
    spring = {"wheel": 0.36 * math.radians(10_000), "pawl": 30 * math.radians(-60)}
    moments = [
        [_moment(on_face, (1, 0)), _moment(on_floor, (0, -1))],
        [_moment(on_face - PIVOT, (-1, 0)), _moment(on_floor - PIVOT, (0, 1))],
    ]
    face, floor = np.linalg.solve(moments, [-spring["wheel"], -spring["pawl"]])
    return float(face), float(floor)


@pytest.mark.parametrize("nose", [0.25, 0.1])
def test_blocked_it_rests_in_the_notch_with_the_forces_of_statics(nose):
    run = _run(100.0, "blocked.sup", nose=nose)
    assert run.status == "at_rest"
    assert run.positions == pytest.approx({"wheel": 0, "pawl": 0}, abs=1e-9)
    assert run.velocities == {"wheel": 0, "pawl": 0}
    face, floor = _forces_by_hand(nose)
    contacts = run.forces[-1]["contacts"]
    assert sorted(c["force"] for c in contacts) == pytest.approx(sorted((face, floor)), rel=1e-9)
    assert face > 0
    assert floor > 0


@pytest.mark.parametrize("teeth", [1, 5, 11])
def test_every_tooth_blocks_alike(teeth):
    start = {"wheel": math.radians(-15) - teeth * TOOTH, "pawl": math.radians(10)}
    run = _run(100.0, "blocked.sup", start)
    assert run.status == "at_rest"
    assert run.positions == pytest.approx({"wheel": -teeth * TOOTH, "pawl": 0}, abs=1e-9)


@pytest.fixture(scope="module")
def free() -> ms.Simulation:
    return _run(10.0)


def _nose(run: ms.Simulation, t: np.ndarray) -> np.ndarray:
    """Return the centre of the nose, turned with the wheel, `(n, 2)`."""
    wheel, pawl = run.trajectory.at(t).q.T
    arm = np.array([-NOSE, FLOOR + NOSE]) - PIVOT
    x = PIVOT[0] + np.cos(pawl) * arm[0] - np.sin(pawl) * arm[1]
    y = PIVOT[1] + np.sin(pawl) * arm[0] + np.cos(pawl) * arm[1]
    return np.stack([np.cos(wheel) * x + np.sin(wheel) * y, np.cos(wheel) * y - np.sin(wheel) * x], axis=1)


def _distance_to_the_teeth(point: np.ndarray) -> float:
    """Return how far a point is from the wheel's outline, as a polygon with the lands drawn as chords."""
    foot, end = np.array([0, FLOOR]), np.array([-math.sqrt(TIP**2 - FLOOR**2), FLOOR])
    corners = []
    for k in range(12):
        c, s = math.cos(k * TOOTH), math.sin(k * TOOTH)
        corners += [np.array([c * x - s * y, s * x + c * y]) for x, y in ((0, TIP), foot, end)]
    found = []
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        along = np.clip(np.dot(point - a, b - a) / np.dot(b - a, b - a), 0, 1)
        found.append(np.linalg.norm(point - a - along * (b - a)))
    return float(min(found))


def test_free_the_nose_never_enters_a_tooth(free):
    sagitta = TIP * (1 - math.cos((TOOTH - math.acos(FLOOR / TIP)) / 2))
    gaps = [_distance_to_the_teeth(p) - NOSE for p in _nose(free, np.linspace(0, 10, 2001))]
    assert min(gaps) > -1e-6
    assert sum(abs(gap) < 1e-6 + sagitta for gap in gaps) > 1000


def test_free_it_turns_tooth_by_tooth(free):
    assert free.status == "complete"
    assert free.positions["wheel"] < -20 * TOOTH
    assert np.all(free.trajectory.v[:, 0] < 1e-9)
    lifted = free.trajectory.at(np.linspace(0, 10, 2001)).q[:, 1]
    peaks = np.sum((lifted[1:-1] > lifted[:-2]) & (lifted[1:-1] >= lifted[2:]) & (lifted[1:-1] > 0.1))
    assert abs(peaks - free.positions["wheel"] / -TOOTH) < 1.5


def test_the_work_is_bounded(free):
    assert abs(free.energy.residual) < 1e-7
    assert free.stats["steps"] <= 300
    assert free.stats["gap_evaluations"] <= 40_000
    blocked = _run(100.0, "blocked.sup")
    assert abs(blocked.energy.residual) < 1e-7
    assert blocked.stats["gap_evaluations"] <= 1000


def test_predictions_of_both_ways():
    free = ms.predict(_mechanism("ratchet.sup"))
    assert free.status == "repeats"
    assert free.pattern.change["wheel"]["position"] == pytest.approx(-TOOTH, abs=1e-3)
    blocked = json.loads(ms.predict(_mechanism("blocked.sup")).to_json())
    assert blocked["status"] == "comes_to_rest"
    assert blocked["rest"]["jammed"] is True
