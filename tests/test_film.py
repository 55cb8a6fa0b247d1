"""The film of a run: degenerate lengths, and samples where something happens."""

import dataclasses
import json

import numpy as np
import pytest

from mainspring.drawing.ticks import Axis
from mainspring.report import page
from mainspring.report.plots import line
from mainspring.report.sampling import film


def test_a_run_that_never_moves_has_a_page(mechanism, simulation):
    class Still:
        parts = simulation.trajectory.parts

        def at(self, t):
            return simulation.trajectory.at(np.zeros_like(t))

        def kinetic_energy(self, t):
            return simulation.trajectory.kinetic_energy(np.zeros_like(t))

        def contacts(self, _t):
            return []

        class _run:  # noqa: N801 - the core's run, without events
            @staticmethod
            def json(_timing):
                return json.dumps(json.loads(simulation.to_json()) | {"events": []})

    still = dataclasses.replace(
        simulation, t=0.0, kinetic_energy_minima=(), status="at_rest", trajectory=Still()
    )
    assert still.events == ()
    text = page(mechanism, still)
    assert "at rest" in text
    assert "NaN" not in text


def test_events_and_minima_are_sampled_exactly(simulation):
    shown = film(simulation)
    moments = set(shown.t.tolist())
    assert {e.t for e in simulation.events} <= moments
    assert set(simulation.kinetic_energy_minima) <= moments
    assert shown.kinetic.max() == pytest.approx(simulation.energy.kinetic_max, rel=0.02)


def test_a_line_keeps_its_corners():
    t = np.linspace(0, 1, 101)
    values = np.where(t < 0.5, 0.0, 1.0)
    drawn = line(t, values, Axis(0, 1, ()), Axis(0, 1, ()), 100, 10)
    assert drawn == "M0 10L49 10L50 0L100 0"


def test_a_step_stays_upright_beside_repeated_samples():
    t = np.array([0.0, 0.3, 0.5 - 1e-9, 0.5, 0.5, 0.8, 1.0])
    values = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    drawn = line(t, values, Axis(0, 1, ()), Axis(0, 1, ()), 100, 10)
    assert drawn == "M0 0L50 0L50 10L100 10"
