"""Ctrl-C stops a run between two steps and leaves what is finished usable."""

import json
import os
import signal

import pytest

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
