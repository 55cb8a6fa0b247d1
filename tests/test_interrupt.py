"""Ctrl-C stops a run between two steps and leaves what is finished usable."""

import json
import math
import os
import signal

import pytest

import mainspring as ms
import mainspring.simulation
from conftest import ESCAPEMENT
from mainspring.cli import main
from mainspring.cli.progress import watch


def test_ctrl_c_asks_the_run_to_stop_and_leaves_no_handler():
    before = signal.getsignal(signal.SIGINT)
    with watch("testing", 1.0) as progress:
        assert progress(0.1) is True
        os.kill(os.getpid(), signal.SIGINT)
        assert progress(0.2) is False
    assert progress.stopped
    assert signal.getsignal(signal.SIGINT) is before


def test_a_second_ctrl_c_stops_at_once():
    with pytest.raises(KeyboardInterrupt), watch("testing"):
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)


def test_what_is_finished_is_kept(monkeypatch, capsys, tmp_path):
    whole = mainspring.simulation.simulate

    def interrupted(*arguments, **options):
        os.kill(os.getpid(), signal.SIGINT)
        return whole(*arguments, **options)

    monkeypatch.setattr(mainspring.simulation, "simulate", interrupted)
    out = tmp_path / "run"
    code = main(["simulate", str(ESCAPEMENT), "--until", "2000", "--out", str(out), "--json"])
    printed, said = capsys.readouterr()
    assert code == 130
    assert said == ""
    assert json.loads(printed)["status"] == "stopped"
    assert json.loads((out / "result.json").read_text()) == json.loads(printed)
    assert (out / "trajectory.npz").exists()


def test_no_progress_is_shown_when_piped(capsys, monkeypatch):
    clock = iter(range(100))
    monkeypatch.setattr("time.monotonic", lambda: float(next(clock)))
    with watch("testing", 9.0) as progress:
        for t in range(9):
            assert progress(float(t)) is True
    assert capsys.readouterr() == ("", "")


def _stars(n: int) -> ms.Mechanism:
    """Two rough stars: their map takes a few seconds."""
    b = ms.Builder("stars")
    for name, x in (("left", 0.0), ("right", 2.15)):
        radii = [1 + 0.1 * math.sin(k * k + x) for k in range(n)]
        points = [
            (x + r * math.cos(math.tau * k / n), r * math.sin(math.tau * k / n)) for k, r in enumerate(radii)
        ]
        outline = ms.Path(points[0], [*(ms.Line(p) for p in points[1:]), ms.Close()])
        b.part(name, inertia=1, motion=ms.Turns((x, 0)), outer=[outline])
    return b.build().compile()


def test_a_map_tells_its_progress_and_can_be_stopped():
    mechanism, told = _stars(161), []
    ms.configuration_space(mechanism, "left", "right", progress=lambda part: told.append(part) or True)
    assert (told[0], told[-1]) == (0, 1)
    assert told == sorted(told)
    with pytest.raises(KeyboardInterrupt):
        ms.configuration_space(mechanism, "left", "right", progress=lambda part: part == 0)
    with pytest.raises(KeyboardInterrupt):
        ms.configuration_space(mechanism, "left", "right", progress=lambda part: part > 0)
