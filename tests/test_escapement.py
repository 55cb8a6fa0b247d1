"""The paper's machine: what Gelsey 1995 says of it, and numbers found by an independent experiment."""

import math

import pytest

import mainspring as ms


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
