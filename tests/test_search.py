"""Contacts from maps of each pair move every machine as direct search does, to the last bit."""

import numpy as np
import pytest

import mainspring as ms
from conftest import MODELS, ROOT

OPEN = [p for p in MODELS if p.stem != "slider-crank"]  # a closed chain is not simulated


@pytest.mark.parametrize("contact", ["rigid", "compliant"])
@pytest.mark.parametrize("model", OPEN, ids=lambda p: p.stem)
def test_the_motion_is_the_same_to_the_last_bit(model, contact):
    mechanism = ms.load(model).compile()
    direct, mapped = (
        ms.simulate(mechanism, 3.0, contact=contact, search=search, forces=True)
        for search in ("direct", "map")
    )
    times = np.linspace(0.0, direct.t, 1001)
    for found, expected in zip(mapped.trajectory.at(times), direct.trajectory.at(times), strict=True):
        assert found.tobytes() == expected.tobytes()
    assert (mapped.events, mapped.energy, mapped.forces) == (direct.events, direct.energy, direct.forces)
    assert mapped.positions == direct.positions


def test_what_is_predicted_is_the_same(mechanism):
    direct, mapped = (ms.predict(mechanism, search=search) for search in ("direct", "map"))
    assert mapped.to_json() == direct.to_json()


def test_the_command_takes_either(cli):
    model = ROOT / "examples" / "ratchet" / "ratchet.padl"
    runs = [cli("simulate", model, "--until", "2", "--json", *more) for more in ((), ("--search", "map"))]
    assert runs[0].stdout.split('"stats"')[0] == runs[1].stdout.split('"stats"')[0] != ""
    told = [cli("predict", model, "--json", *more).stdout for more in ((), ("--search", "map"))]
    assert told[0] == told[1] != ""
    wrong = cli("simulate", model, "--until", "2", "--search", "cleverly")
    assert (wrong.returncode, wrong.stdout) == (2, "")
