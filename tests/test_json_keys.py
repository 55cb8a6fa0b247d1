"""Keys of results are a promise: names, order, and a place in the documentation."""

import json

import mainspring as ms
from conftest import ROOT

INSPECT = ["parts", "frame", "pairs", "joints", "subsystems", "state_variables", "interactions"]
INSPECT += ["near_misses", "closed_chains", "mobility", "warnings", "plane", "gravity", "contact", "units"]
INSPECT += ["marks"]
SIMULATE = ["status", "advice", "t", "positions", "velocities", "kinetic_energy_minima"]
SIMULATE += ["events", "energy", "stats"]
PREDICT = ["status", "reason", "pattern", "starts", "rest", "simulated_seconds", "hypotheses"]
PREDICT += ["sentences", "stats"]
JOINT = ["part", "carrier", "motion", "position", "velocity", "inertia", "mass", "center", "friction"]
JOINT += ["coulomb", "spring", "torque", "drive", "stops"]
PAIR = ["kind", "shape_kind", "parts", "axis", "ratio", "clearance", "evidence"]


def test_inspect_keys(inspected):
    assert list(inspected) == INSPECT
    assert list(inspected["pairs"][0]) == PAIR
    assert list(inspected["joints"][0]) == JOINT
    assert list(inspected["contact"]) == ["E", "D", "M"]
    assert list(inspected["pairs"][0]["axis"]) == ["point", "direction"]
    assert list(inspected["subsystems"][0]) == ["root", "parts", "ratios", "inertia", "locked"]


def test_simulate_keys(simulation):
    found = json.loads(simulation.to_json())
    assert list(found) == SIMULATE
    account = ["initial", "final", "work", "friction", "impacts", "kinetic_max", "residual"]
    assert list(found["energy"]) == account
    assert list(found["stats"]) == ["steps", "gap_evaluations", "impacts"]
    assert {tuple(e) for e in found["events"]} == {("t", "kind", "parts", "impulse", "moving_together")}


def test_forces_only_when_asked(mechanism):
    asked = ms.simulate(mechanism, 3.0, forces=True)
    found = json.loads(asked.to_json())
    assert list(found) == [*SIMULATE[:-1], "forces", "stats"]
    instants = [f["t"] for f in found["forces"]]
    assert instants == sorted({0.0, 3.0, *(e["t"] for e in found["events"])})
    contact = next(c for f in found["forces"] for c in f["contacts"])
    assert list(contact) == ["parts", "points", "normal", "force", "features"]
    assert len(asked.forces) == len(instants)


def test_predict_keys(prediction):
    found = json.loads(prediction.to_json())
    assert list(found) == PREDICT
    assert list(found["pattern"]) == ["minima", "duration", "change", "basis"]
    assert list(found["starts"]) == ["t", "positions", "velocities"]
    assert list(found["hypotheses"][0]) == ["minima", "formed", "fell", "why"]
    assert {tuple(c) for c in found["pattern"]["change"].values()} == {("position", "velocity")}


def test_every_key_is_documented():
    told = (ROOT / "docs" / "guide" / "json.md").read_text(encoding="utf-8")
    assert [k for k in INSPECT + JOINT + SIMULATE + PREDICT if f"`{k}`" not in told] == []
