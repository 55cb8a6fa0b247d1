"""`mainspring cspace`: its answers in text, JSON and files, and what it refuses."""

import json
import math
import re

import pytest

import mainspring as ms
from conftest import ESCAPEMENT, ROOT

RATCHET = ROOT / "examples" / "ratchet" / "ratchet.padl"
PLATE = ROOT / "examples" / "pawl-on-plate" / "pawl-on-plate.padl"

SPACE = [
    "status",
    "parts",
    "coordinates",
    "held",
    "domain",
    "start",
    "components",
    "curves",
    "marks",
    "stats",
]
AXIS = ["coordinate", "motion", "low", "high", "period", "repeats"]
COMPONENT = ["id", "boundary", "winding", "turns", "copies", "area", "inside"]
CURVE = ["id", "features", "points", "from", "to", "slope", "free"]
FEATURE = ["part", "layer", "loop", "edge", "corner", "kind"]
STATS = ["components", "curves", "cells", "cells_blocked", "cells_cut", "feature_pairs", "elements"]
STATS += ["stretches_tested"]
ANSWER = ["at", "free", "component", "gap", "features"]
INTERVAL = ["low", "high", "curves", "component"]


def _json(cli, *arguments):
    done = cli("cspace", *arguments, "--json")
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert done.stdout.count("\n") == 1
    return json.loads(done.stdout)


def test_keys_are_a_promise(cli):
    found = _json(
        cli, ESCAPEMENT, "ewheel", "lever", "--at", "ewheel=4deg,lever=2deg", "--slice", "lever=0deg"
    )
    assert list(found) == [*SPACE, "at", "slices"]
    assert [list(d) for d in found["domain"]] == [AXIS, AXIS]
    assert list(found["start"]) == ["at", "component", "gap"]
    assert {tuple(c) for c in found["components"]} == {tuple(COMPONENT)}
    cycle = found["components"][0]["boundary"][0]
    assert list(cycle) == ["edges", "winding"]
    assert list(cycle["edges"][0]) == ["curve", "from", "to"]
    assert {tuple(c) for c in found["curves"]} == {tuple(CURVE)}
    assert list(found["curves"][0]["features"][0]) == FEATURE
    assert list(found["stats"]) == STATS
    assert list(found["at"][0]) == ANSWER
    assert list(found["slices"][0]) == ["coordinate", "value", "intervals"]
    assert list(found["slices"][0]["intervals"][0]) == INTERVAL
    told = (ROOT / "docs" / "guide" / "json.md").read_text(encoding="utf-8")
    keys = {*SPACE, *AXIS, *COMPONENT, *CURVE, *FEATURE, *STATS, *ANSWER, *INTERVAL, "edges", "slices"}
    assert sorted(k for k in keys if f"`{k}`" not in told) == []


def test_json_is_the_python_result(cli):
    plain = cli("cspace", RATCHET, "wheel", "pawl", "--json").stdout
    space = ms.configuration_space(ms.load(RATCHET).compile(), "wheel", "pawl")
    assert plain == space.to_json() + "\n"


def test_degrees_outside_are_radians_inside(cli):
    found = _json(
        cli, RATCHET, "Wheel", "PAWL", "--window", "pawl=-5deg:25deg", "--at", "pawl=5deg,wheel=-1deg"
    )
    pawl = found["domain"][1]
    assert (pawl["low"], pawl["high"]) == pytest.approx((math.radians(-5), math.radians(25)))
    assert pawl["period"] is None
    assert found["at"][0]["at"] == pytest.approx([math.radians(-1), math.radians(5)])


def test_a_person_reads_what_it_shows(cli):
    said = cli("cspace", ESCAPEMENT, "ewheel", "lever", "--at", "ewheel=76deg,lever=2deg").stdout
    assert "ewheel and lever: one free component, 22 contact curves." in said
    assert "ewheel turns from −18° to 18°, 10 times in a turn." in said
    assert "ewheel 76°, lever 2°: free, component 0; gap 0.133683, ewheel corner (6.12, 1.37)" in said
    assert "lever can move from −16.4101° to 13.2668°." in said
    blocked = cli("cspace", ESCAPEMENT, "ewheel", "lever", "--at", "ewheel=4deg,lever=-60deg").stdout
    assert "lever −60°: blocked or in contact" in blocked


def test_slices_are_told_with_their_curves(cli):
    said = cli(
        "cspace", ESCAPEMENT, "ewheel", "lever", "--slice", "ewheel=5deg", "--slice", "lever=80deg"
    ).stdout
    row = re.search(r"^\s*−13\.4414°\s+13\.6977°\s+0\s+curve \d+\s+curve \d+", said, re.M)
    assert row, said
    assert "ewheel is nowhere free at lever 80°." in said


def test_a_part_on_a_moving_part_meets_the_frame(cli):
    found = _json(cli, PLATE, "pawl", "frame")
    assert found["coordinates"] == ["pawl", "plate"]
    held = cli("cspace", PLATE, "plate", "pawl")
    assert held.returncode == 2
    assert "one joint only" in held.stderr


def test_files_are_written_whole_and_said(cli, tmp_path):
    done = cli("cspace", RATCHET, "wheel", "pawl", "--svg", "map.svg", "--html", "map.html")
    assert done.returncode == 0, done.stderr
    assert "wrote map.svg" in done.stdout
    assert "wrote map.html" in done.stdout
    assert sorted(p.name for p in tmp_path.iterdir()) == ["map.html", "map.svg"]
    assert (tmp_path / "map.svg").read_text().startswith("<svg xmlns=")
    assert (tmp_path / "map.html").read_text().startswith("<!doctype html>")


BAD = [
    ("ewheel",),
    ("ewheel", "leever"),
    ("ewheel", "ewheel"),
    ("ewheel", "frame"),
    ("ewheel", "lever", "--window", "lever=3"),
    ("ewheel", "lever", "--window", "lever=3:5"),
    ("ewheel", "lever", "--window", "lever=9deg:3deg"),
    ("ewheel", "lever", "--window", "lever=0deg:400deg"),
    ("ewheel", "lever", "--window", "lever=0deg:4deg", "--window", "LEVER=0deg:5deg"),
    ("ewheel", "lever", "--window", "bwheel=0deg:5deg"),
    ("ewheel", "lever", "--hold", "lever=1deg"),
    ("ewheel", "lever", "--hold", "frame=1deg"),
    ("ewheel", "lever", "--coordinates", "ewheel"),
    ("ewheel", "lever", "--coordinates", "ewheel,bwheel"),
    ("ewheel", "lever", "--at", "lever=1deg"),
    ("ewheel", "lever", "--at", "lever=1deg,bwheel=1deg"),
    ("ewheel", "lever", "--at", "lever=1deg,ewheel=1"),
    ("ewheel", "lever", "--at", "lever=1deg,lever=2deg"),
    ("ewheel", "lever", "--slice", "lever"),
    ("ewheel", "lever", "--slice", "lever=nan"),
    ("ewheel", "lever", "--set", "gap=99"),
]


@pytest.mark.parametrize("arguments", BAD, ids=lambda a: " ".join(a)[-44:])
def test_bad_requests_are_one_clear_line(cli, tmp_path, arguments):
    done = cli("cspace", ESCAPEMENT, *arguments, "--svg", "map.svg", "--html", "map.html")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1, done.stderr
    assert "Traceback" not in done.stderr
    assert "error: " in done.stderr
    assert "--help)" in done.stderr or "; expected " in done.stderr, done.stderr
    assert list(tmp_path.iterdir()) == []


def test_coordinates_go_by_place_too(cli):
    by_name = _json(cli, RATCHET, "wheel", "pawl", "--at", "wheel=3deg,pawl=5deg", "--slice", "pawl=5deg")
    by_place = _json(cli, RATCHET, "wheel", "pawl", "--at", "a=3deg,b=5deg", "--slice", "b=5deg")
    assert by_place == by_name
    twice = cli("cspace", RATCHET, "wheel", "pawl", "--at", "a=3deg,wheel=5deg")
    assert (twice.returncode, twice.stdout) == (2, "")
    assert "wheel is given twice" in twice.stderr
