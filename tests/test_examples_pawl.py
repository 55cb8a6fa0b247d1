"""The forces that hold the pawl on its plate follow from statics alone."""

import math

import numpy as np
import pytest

import mainspring as ms
from conftest import ROOT
from mainspring.drawing import draw

FOLDER = ROOT / "examples" / "pawl-on-plate"


def _turn(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def _moment(arm: np.ndarray, force: np.ndarray) -> float:
    return float(arm[0] * force[1] - arm[1] * force[0])


def test_forces_of_the_blocked_pawl_are_those_of_statics():
    mechanism = ms.load(FOLDER / "pawl-on-plate.padl", FOLDER / "blocked.sup").compile()
    rest = ms.predict(mechanism)
    plate, pawl = (rest.starts["positions"][part] for part in ("plate", "pawl"))
    pin = _turn(plate) @ np.array([3.0, 2.4])
    nose = pin + _turn(plate + pawl + math.radians(132.5104)) @ np.array([4.0697, 0.0])
    slope = math.radians(35)
    face = np.array([math.cos(slope), -math.sin(slope)])
    back = np.array([-math.sin(slope), -math.cos(slope)])
    # The nose lies in the notch's corner, its radius away from both walls.
    assert nose == pytest.approx(np.array([0.0, 5.8]) + 0.2 * (face + back), abs=1e-9)
    # Moments about the plate's axis carry its torque, those about the pin the spring's.
    moments = [[_moment(arm, wall) for wall in (face, back)] for arm in (nose, nose - pin)]
    forces = np.linalg.solve(moments, [-6.0, 4.0 * (pawl + math.radians(40))])
    assert [c["force"] for c in rest.rest["held_by"]] == pytest.approx(list(forces), abs=1e-9)


def test_the_picture_moves_the_pawl_with_its_plate():
    mechanism = ms.load(FOLDER / "pawl-on-plate.padl").compile()
    at = {"plate": math.pi / 2, "pawl": math.radians(10)}
    shown = draw(mechanism.outlines(), title="pawl", at=at)
    assert "rotate(90 0 0) rotate(10 3 2.4)" in shown


def test_blows_do_not_depend_on_the_tolerance():
    """A corner that follows the face it ran along closes by the face's drift, which is no blow."""
    mechanism = ms.load(FOLDER / "pawl-on-plate.padl").compile()
    runs = [ms.simulate(mechanism, 20.0, rtol=rtol) for rtol in (1e-7, 1e-8, 1e-9)]
    assert len({run.stats["impacts"] for run in runs}) == 1
    for run in runs:
        assert min(e.impulse for e in run.events if e.kind == "impact") > 1e-3
