"""Keys of results are a promise: names, order, and a place in the documentation."""

import json

from conftest import ROOT

INSPECT = ["parts", "frame", "pairs", "subsystems", "state_variables", "interactions"]
INSPECT += ["near_misses", "warnings", "plane", "units"]
SIMULATE = ["status", "t", "positions", "velocities", "kinetic_energy_minima", "events", "energy", "stats"]
PREDICT = ["status", "pattern", "starts", "simulated_seconds", "hypotheses", "sentences"]


def test_inspect_keys(inspected):
    assert list(inspected) == INSPECT
    assert list(inspected["pairs"][0]) == ["kind", "shape_kind", "parts", "axis", "ratio", "evidence"]
    assert list(inspected["pairs"][0]["axis"]) == ["point", "direction"]
    assert list(inspected["subsystems"][0]) == ["root", "parts", "inertia"]


def test_simulate_keys(simulation):
    found = json.loads(simulation.to_json())
    assert list(found) == SIMULATE
    assert list(found["energy"]) == ["initial", "final", "friction", "impacts", "kinetic_max", "residual"]
    assert list(found["stats"]) == ["steps", "gap_evaluations", "impacts"]
    assert {tuple(e) for e in found["events"]} == {("t", "kind", "parts", "impulse", "moving_together")}


def test_predict_keys(prediction):
    found = json.loads(prediction.to_json())
    assert list(found) == PREDICT
    assert list(found["pattern"]) == ["minima", "duration", "change"]
    assert list(found["starts"]) == ["t", "positions", "velocities"]
    assert list(found["hypotheses"][0]) == ["minima", "formed", "fell", "why"]
    assert {tuple(c) for c in found["pattern"]["change"].values()} == {("position", "velocity")}


def test_every_key_is_documented():
    told = (ROOT / "docs" / "guide" / "json.md").read_text(encoding="utf-8")
    assert [k for k in INSPECT + SIMULATE + PREDICT if f"`{k}`" not in told] == []
