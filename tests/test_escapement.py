"""The paper's machine: what Gelsey 1995 says of it, and numbers found by an independent experiment."""

import itertools
import math

import numpy as np
import pytest

import mainspring as ms
from conftest import ESCAPEMENT


def test_kinematics(inspected):
    assert inspected["parts"] == ["ewheel", "lever", "bwheel", "frame"]
    assert {tuple(p["parts"]) for p in inspected["pairs"]} == {
        ("ewheel", "frame"),
        ("lever", "frame"),
        ("bwheel", "frame"),
    }
    assert {p["kind"] for p in inspected["pairs"]} == {"revolute"}
    assert all(p["axis"]["direction"] == [0, 0, 1] for p in inspected["pairs"])
    assert [p["axis"]["point"][1] for p in inspected["pairs"]] == pytest.approx([0, 7.5, 20])
    assert [s["inertia"] for s in inspected["subsystems"]] == [200, 10, 20]
    assert len(inspected["state_variables"]) == 6
    assert inspected["interactions"] == [["bwheel", "lever"], ["ewheel", "lever"], ["frame", "lever"]]


def test_the_pattern(prediction):
    assert prediction.status == "repeats"
    pattern = prediction.pattern
    assert pattern.minima == 2
    change = {part: math.degrees(c["position"]) for part, c in pattern.change.items()}
    assert change["ewheel"] == pytest.approx(-36, abs=0.05)
    assert change["lever"] == pytest.approx(0, abs=0.05)
    assert abs(change["bwheel"]) < 2


def test_the_tenth_minimum_is_near_37_seconds(mechanism):
    run = ms.simulate(mechanism, 40.0)
    assert run.kinetic_energy_minima[9] == pytest.approx(37.0, abs=0.7)


def test_the_energy_account_closes(simulation):
    e = simulation.energy
    lost = e.friction + e.impacts
    assert abs(e.initial - e.final - lost) / max(lost, e.kinetic_max) < 1e-7
    assert abs(e.residual) < 1e-7
    assert e.friction > 0
    assert e.impacts > 0


def test_the_work_is_bounded(simulation):
    assert simulation.stats["gap_evaluations"] <= 100_000


def test_the_tenth_minimum_converges(mechanism):
    tenth = {
        rtol: ms.simulate(mechanism, 40.0, rtol=rtol).kinetic_energy_minima[9]
        for rtol in (1e-6, 1e-8, 1e-10, 1e-12)
    }
    assert max(abs(t - tenth[1e-12]) for t in tenth.values()) < 1e-5


def _with(tmp_path, *lines: str) -> ms.Mechanism:
    """Return the escapement with another supplement."""
    supplement = tmp_path / "other.sup"
    supplement.write_text("\n".join(lines) + "\n")
    return ms.load(ESCAPEMENT, supplement).compile()


LEVER = "< LEVER : FRAME > 10 5"
BALANCE = "< BWHEEL : FRAME > 20 6 SPRING 90 15"
WHEEL = "< EWHEEL : FRAME > 200 20 SPRING -10000 20"


def test_under_constant_torque_settled_periods_repeat(tmp_path):
    mechanism = _with(tmp_path, LEVER, BALANCE, "< EWHEEL : FRAME > 200 20 SPRING -10000000 0.02")
    minima = ms.simulate(mechanism, 400.0).kinetic_energy_minima
    periods = [b - a for a, b in zip(minima[-13:-2], minima[-11:], strict=True)]
    assert max(periods) - min(periods) < 1e-6


def test_the_whole_run_down_ends_at_rest(mechanism):
    run = ms.simulate(mechanism, 10_000.0)
    assert run.status == "at_rest"
    assert math.degrees(run.positions["ewheel"]) == pytest.approx(-10_000, abs=36)
    assert abs(run.energy.residual) < 1e-7
    starts = run.kinetic_energy_minima[::2]
    wheel = run.trajectory.parts.index("ewheel")
    turned = np.degrees(run.trajectory.at(starts).q[:, wheel])
    steps = zip(itertools.pairwise(starts), np.diff(turned), strict=True)
    ticking = [ends for ends, step in steps if abs(step + 36) < 1]
    assert 200 < len(ticking) <= 277
    changes = np.array([e.t for e in run.events if e.kind != "impact"])
    assert max(np.count_nonzero((a <= changes) & (changes < b)) for a, b in ticking) <= 30


def test_a_stiffer_balance_spring_ticks_faster(tmp_path, prediction):
    other = ms.predict(_with(tmp_path, LEVER, "< BWHEEL : FRAME > 20 6 SPRING 90 18", WHEEL))
    assert other.status == "repeats"
    assert math.degrees(other.pattern.change["ewheel"]["position"]) == pytest.approx(-36, abs=0.05)
    assert other.pattern.duration < 0.97 * prediction.pattern.duration


def test_a_balance_that_cannot_reach_the_lever_stalls(tmp_path):
    other = ms.predict(_with(tmp_path, LEVER, "< BWHEEL : FRAME > 20 6 SPRING 20 15", WHEEL))
    assert other.status == "comes_to_rest"
    assert other.rest["jammed"] is True
    assert [c["parts"] for c in other.rest["held_by"]] == [["ewheel", "lever"], ["lever", "frame"]]
    assert math.degrees(other.starts["positions"]["bwheel"]) == pytest.approx(20, abs=1e-3)


def test_without_a_mainspring_the_balance_swings_out(tmp_path):
    other = ms.predict(_with(tmp_path, LEVER, BALANCE, "< EWHEEL : FRAME > 200 20"))
    assert other.status == "comes_to_rest"
    assert other.rest["jammed"] is False
    assert math.degrees(other.starts["positions"]["bwheel"]) == pytest.approx(90, abs=1e-3)
