"""The Python results: frozen, typed, and the same numbers as the JSON."""

import dataclasses
import json
import math

import numpy as np
import pytest

import mainspring as ms
from conftest import ESCAPEMENT, ROOT


def test_the_machine_tells_its_parameters():
    machine = ms.load(ESCAPEMENT)
    gap = next(p for p in machine.parameters if p.name == "gap")
    assert (gap.value, gap.range) == (36.0, (30.0, 40.0))


def test_an_unknown_parameter_is_an_input_error():
    with pytest.raises(ms.InputError, match=r"\d+:\d+: error: .*no_such"):
        ms.load(ESCAPEMENT).compile(no_such=1.0)


def test_results_are_frozen(mechanism, simulation, prediction):
    for result in (ms.find_pairs(mechanism), simulation, prediction):
        with pytest.raises(dataclasses.FrozenInstanceError):
            result.status = "other"
        with pytest.raises(TypeError):
            result.stats["steps"] = 0
        assert result.status in result._repr_html_() or "<strong>" in result._repr_html_()


def test_dense_evaluation_passes_through_the_steps(simulation):
    motion = simulation.trajectory
    assert motion.q.shape == motion.v.shape == (len(motion.t), 3)
    at = motion.at(motion.t)
    np.testing.assert_array_equal(at.q, motion.q)
    one = motion.at(float(motion.t[5]))
    assert one.q.shape == (3,)
    np.testing.assert_array_equal(one.q, motion.q[5])


def test_velocity_is_the_slope_of_position(simulation):
    t, h = np.linspace(0.11, 36.9, 173), 1e-5
    motion = simulation.trajectory
    events = np.array([e.t for e in simulation.events])
    clear = np.abs(t[:, None] - events).min(axis=1) > 1e-3
    slope = (motion.at(t + h).q - motion.at(t - h).q) / (2 * h)
    np.testing.assert_allclose(slope[clear], motion.at(t).v[clear], atol=2e-6)


def test_json_and_attributes_agree(simulation, prediction):
    found = json.loads(simulation.to_json())
    assert found["positions"] == dict(simulation.positions)
    assert found["stats"] == dict(simulation.stats)
    assert len(found["events"]) == len(simulation.events)
    assert json.loads(prediction.to_json())["sentences"] == list(prediction.sentences)


def test_progress_can_stop_a_run(mechanism):
    seen: list[float] = []

    def stop(t: float) -> bool:
        seen.append(t)
        return False

    run = ms.simulate(mechanism, 2000.0, progress=stop)
    assert run.status == "stopped"
    assert len(seen) == 1
    assert run.t < 2000.0
    assert run.trajectory.t[-1] == run.t


def test_public_names_exist():
    for name in ms.__all__:
        assert getattr(ms, name) is not None
    with pytest.raises(AttributeError):
        _ = ms.no_such_name


@pytest.mark.parametrize(
    "options",
    [
        {"until": math.nan},
        {"until": math.inf},
        {"until": 0},
        {"until": -1},
        {"until": 1, "rtol": 0},
        {"until": 1, "rtol": math.nan},
        {"until": 1, "rtol": 0.1},
        {"until": 1, "positions": {"lever": math.nan}},
        {"until": 1, "velocities": {"pawl": 1}},
        {"until": 1, "contact": "soft"},
    ],
)
def test_a_run_that_makes_no_sense_is_refused(mechanism, options):
    with pytest.raises(ms.InputError, match=r"^--[a-z-]+:1:1: error: .*; expected "):
        ms.simulate(mechanism, **options)


@pytest.mark.parametrize(
    "options",
    [
        {"confirm": 0},
        {"ignore": -1},
        {"range_fraction": math.nan},
        {"time_match": -1},
        {"state_match": 0},
        {"max_minima": 0},
        {"max_time": math.inf},
        {"rtol": 1e-20},
    ],
)
def test_a_search_that_makes_no_sense_is_refused(mechanism, options):
    with pytest.raises(ms.InputError, match=r"^--[a-z-]+:1:1: error: .*; expected "):
        ms.predict(mechanism, **options)


@pytest.mark.parametrize("t", [math.nan, -1e-9, 37.1, math.inf])
def test_the_motion_is_told_only_where_it_is_known(simulation, t):
    with pytest.raises(ValueError, match="expected one within the run"):
        simulation.trajectory.at(t)
    with pytest.raises(ValueError, match="expected one within the run"):
        simulation.trajectory.contacts(t)


def test_a_machine_at_rest_stays_there():
    slide = ms.load(ROOT / "examples" / "slide" / "slide.padl").compile()
    run = ms.simulate(slide, 10.0)
    assert run.status == "at_rest"
    assert run.trajectory.at(9.0).q == pytest.approx([-3.0])
    assert run.trajectory.at(9.0).v == [0.0]


@pytest.mark.parametrize("friction", ["1e6", "1e9", "1e12", "1e15"])
def test_rounding_has_no_minima(tmp_path, friction):
    """A balance that creeps moves so slowly that its energy is rounding beside the wheel's first blow."""
    text = ESCAPEMENT.with_suffix(".sup").read_text(encoding="utf-8")
    assert "< BWHEEL : FRAME > 20 6 " in text
    supplement = tmp_path / "creeping.sup"
    supplement.write_text(text.replace("FRAME > 20 6 ", f"FRAME > 20 {friction} "), encoding="utf-8")
    found = ms.predict(ms.load(ESCAPEMENT, supplement).compile())
    assert found.status == "no_pattern"
    assert found.simulated_seconds == 1e5
