"""The command line's promises: one JSON object on standard output, files written whole, exit codes."""

import json
import math
import re

import numpy as np
import pytest

from conftest import ESCAPEMENT

COMMANDS = ("demo", "inspect", "cspace", "simulate", "predict", "examples", "cite")


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_an_example(cli, command):
    done = cli(command, "--help")
    assert done.returncode == 0
    assert f"example:\n  mainspring {command}" in done.stdout


def test_top_help_lists_the_commands(cli):
    said = cli("--help").stdout
    assert all(f"    {command} " in said for command in COMMANDS)


@pytest.mark.parametrize(
    "arguments",
    [
        ("inspect", ESCAPEMENT),
        ("simulate", ESCAPEMENT, "--until", "5"),
        ("cspace", ESCAPEMENT, "ewheel", "lever"),
        ("predict", ESCAPEMENT),
        ("demo",),
        ("examples",),
        ("cite",),
    ],
)
def test_json_is_one_object_and_nothing_else(cli, arguments):
    done = cli(*arguments, "--json")
    assert done.returncode == 0, done.stderr
    assert isinstance(json.loads(done.stdout), dict)
    assert done.stdout.count("\n") == 1
    assert done.stderr == ""


def test_degrees_on_the_command_line_are_radians_inside(cli):
    done = cli("simulate", ESCAPEMENT, "--until", "1e-9", "--position", "BWheel=-20deg", "--json")
    positions = json.loads(done.stdout)["positions"]
    assert positions["bwheel"] == pytest.approx(math.radians(-20), abs=1e-9)


def test_velocities_are_degrees_per_second(cli):
    done = cli("simulate", ESCAPEMENT, "--until", "1e-9", "--velocity", "bwheel=30deg/s", "--json")
    velocities = json.loads(done.stdout)["velocities"]
    assert velocities["bwheel"] == pytest.approx(math.radians(30), rel=1e-6)


def test_out_writes_the_printed_result_and_the_trajectory(cli, tmp_path):
    done = cli("simulate", ESCAPEMENT, "--until", "8", "--out", "run", "--csv", "--json")
    result = json.loads(done.stdout)
    assert sorted(p.name for p in (tmp_path / "run").iterdir()) == [
        "result.json",
        "trajectory.csv",
        "trajectory.npz",
    ]
    assert json.loads((tmp_path / "run" / "result.json").read_text()) == result
    with np.load(tmp_path / "run" / "trajectory.npz", allow_pickle=False) as kept:
        t, q, v, parts = (kept[k] for k in ("t", "q", "v", "parts"))
    assert q.shape == v.shape == (len(t), len(parts))
    assert t[0] == 0.0
    assert t[-1] == result["t"]
    assert dict(zip(parts.tolist(), q[-1].tolist(), strict=True)) == result["positions"]
    rows = (tmp_path / "run" / "trajectory.csv").read_text().splitlines()
    assert rows[0].split(",")[1] == f"{parts[0]}.position"
    assert len(rows) == len(t) + 1
    assert [float(x) for x in rows[-1].split(",")] == [t[-1], *q[-1], *v[-1]]


def test_timing_only_on_request(cli):
    plain = json.loads(cli("simulate", ESCAPEMENT, "--until", "1", "--json").stdout)
    timed = json.loads(cli("simulate", ESCAPEMENT, "--until", "1", "--timing", "--json").stdout)
    assert "wall_seconds" not in plain["stats"]
    assert timed["stats"].pop("wall_seconds") > 0
    assert timed == plain


def test_demo_writes_its_report_and_says_so(cli, tmp_path):
    done = cli("demo")
    assert done.returncode == 0, done.stderr
    assert "mainspring-demo/report.html" in done.stdout
    assert "Repeats every" in done.stdout
    report = (tmp_path / "mainspring-demo" / "report.html").read_text()
    assert report.startswith("<!doctype html>")
    assert list((tmp_path / "mainspring-demo").iterdir()) == [tmp_path / "mainspring-demo" / "report.html"]


def test_examples_copies_a_machine_that_runs(cli, tmp_path):
    assert "escapement" in cli("examples").stdout
    done = cli("examples", "escapement", "my-clock")
    assert done.returncode == 0, done.stderr
    model = tmp_path / "my-clock" / "escapement.padl"
    assert model.read_bytes() == ESCAPEMENT.read_bytes()
    assert cli("inspect", model).returncode == 0


def test_set_changes_a_parameter(cli):
    done = cli("inspect", ESCAPEMENT, "--set", "gap=36", "--json")
    assert done.stdout == cli("inspect", ESCAPEMENT, "--json").stdout
    assert cli("inspect", ESCAPEMENT, "--set", "gap=35.5").returncode == 0


def test_cite_follows_the_result(cli, tmp_path):
    (tmp_path / "p.json").write_text(cli("inspect", ESCAPEMENT, "--json").stdout)
    said = cli("cite", "p.json").stdout
    assert "Gelsey" in said
    assert "Moreau" not in said
    (tmp_path / "s.json").write_text(cli("cspace", ESCAPEMENT, "ewheel", "lever", "--json").stdout)
    assert "Sacks" in cli("cite", "s.json").stdout
    assert "Sacks" not in said
    assert {"Moreau", "Sacks"} <= set(re.findall(r"\w+", cli("cite").stdout))


def test_svg_draws_true_arcs(cli, tmp_path):
    assert cli("inspect", ESCAPEMENT, "--svg", "machine.svg").returncode == 0
    drawn = (tmp_path / "machine.svg").read_text()
    assert drawn.count('class="axis"') == 3
    assert "A4 4 0 0 1" in drawn, "the balance's rim is an arc of radius 4"
    assert "prefers-color-scheme:dark" in drawn
