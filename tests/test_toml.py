"""Machines in TOML: loaded, built, written back; and the laws of the shipped ones."""

import json
import math

import numpy as np
import pytest

import mainspring as ms
from conftest import ROOT

EXAMPLES = ROOT / "examples"
GENEVA = EXAMPLES / "geneva-four" / "geneva-four.toml"


def test_both_forms_of_the_escapement_move_alike(mechanism):
    other = ms.load(ROOT / "tests" / "machines" / "escapement.toml").compile()
    assert ms.simulate(other, 10.0).to_json() == ms.simulate(mechanism, 10.0).to_json()
    ours, theirs = (json.loads(ms.find_pairs(m).to_json()) for m in (other, mechanism))
    assert ours["pairs"] == theirs["pairs"]
    assert ours["interactions"] == theirs["interactions"]


def test_parameters_tell_what_they_are():
    slots = ms.load(GENEVA).parameters[0]
    assert (slots.name, slots.value, slots.range, slots.whole) == ("slots", 4.0, (3.0, 12.0), True)
    assert slots.meaning == "slots of the wheel, and steps in its turn"


def test_units_and_marks_are_told():
    found = ms.find_pairs(ms.load(GENEVA).compile())
    assert dict(found.units) == {"length": "mm", "time": "s", "angle": "rad", "mass": "g"}
    marks = {m.name: (m.part, m.value) for m in found.marks}
    assert marks["enters"] == ("driver", pytest.approx(math.radians(135)))


def test_whole_numbers(cli):
    done = cli("inspect", GENEVA, "--set", "slots=2.5")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "--set:1:1: error: slots is 2.5; expected a whole number\n"


def test_saved_with_new_values(tmp_path):
    machine = ms.load(GENEVA)
    path = tmp_path / "new.toml"
    machine.save(path, pin=2.75)
    text = path.read_text(encoding="utf-8")
    assert text == GENEVA.read_text(encoding="utf-8").replace("value = 3,", "value = 2.75,")
    assert machine.to_toml(pin=2.75) == text
    assert machine.with_parameters(pin=2.75).parameters[2].value == 2.75
    with pytest.raises(ms.InputError, match="expected a value in its range"):
        machine.save(path, pin=75)
    assert path.read_text(encoding="utf-8") == text
    assert [p.name for p in tmp_path.iterdir()] == ["new.toml"]


def test_only_toml_is_written_back():
    padl = ms.load(EXAMPLES / "slide" / "slide.padl")
    with pytest.raises(ms.InputError, match=r"expected a model that ends in \.toml"):
        padl.to_toml()


def _yoke() -> ms.Builder:
    b = ms.Builder("yoke", length="mm")
    b.parameter("r", 20, unit="mm", range=(5, 30), meaning='length of the "crank"')
    b.parameter("n", 6, whole=True)
    b.solid("bolt", "cyl(d=2)")
    b.part("crank", motion=ms.Turns((0, 0)), inertia=100, drive=60, outer=[ms.Circle(("r", 0), 4)])
    slot = ms.Path(
        ("r + 4.01", "-r"),
        [
            ms.Line(("r + 4.01", "r")),
            ms.Arc(("r - 4.01", "r"), "left", center=("r", "r")),
            ms.Line(("r - 4.01", "-r")),
            ms.Close("left", radius=4.01),
        ],
    )
    corners = [("r + 10", "-r - 15"), ("r + 10", "r + 15"), ("r - 10", "r + 15")]
    plate = ms.Path(("r - 10", "-r - 15"), [*(ms.Line(c, fillet=2) for c in corners), ms.Close()], fillet=1)
    b.part(
        "yoke",
        motion=ms.Slides((1, 0)),
        density=0.01,
        friction=2000,
        outer=[plate],
        inner=[slot],
        marks={"middle": "-r"},
        limits=(-50, None),
    )
    b.part("pin", motion=ms.Fixed("yoke"), solid="bolt at (movx=r, movy=r + 7, movz=2)")
    layers = [ms.Layer((5, 6), [ms.Circle((0, 0), 2)]), ms.Layer((6, 7), [ms.Circle((0, 0), 1)])]
    b.part("wheel", motion=ms.Turns((0, 0)), layers=layers, inertia=1, spring=(0, 1), torque="r/2")
    b.world(gravity=(0, -9810))
    return b


def test_built_machines_are_files():
    b = _yoke()
    machine = b.build()
    assert ms.parse(b.to_toml(), "yoke.toml").to_toml() == b.to_toml()
    assert machine.parameters[0].meaning == 'length of the "crank"'
    found = ms.find_pairs(machine.compile())
    assert found.parts == ("crank", "yoke", "pin", "wheel", "frame")
    assert [(p.parts, p.kind) for p in found.pairs] == [
        (("crank", "frame"), "revolute"),
        (("yoke", "pin"), "fixed"),
        (("yoke", "frame"), "prismatic"),
        (("wheel", "frame"), "revolute"),
    ]
    assert found.marks[0].name == "middle"
    with pytest.raises(ValueError, match="described already"):
        b.part("yoke")


def test_errors_of_built_machines_have_places():
    b = ms.Builder("bad")
    b.part("p", outer=[ms.Circle((0, 0), "r")])
    with pytest.raises(ms.InputError, match=r"^bad\.toml:\d+:\d+: error: `r` is not defined; expected"):
        b.build()


@pytest.mark.parametrize("name", ["geneva-four", "geneva-six"])
def test_the_wheel_follows_the_law_of_geneva(name):
    mechanism = ms.load(EXAMPLES / name / f"{name}.toml").compile()
    a, n, w = 50.0, {"geneva-four": 4, "geneva-six": 6}[name], math.radians(60)
    r, play = a * math.sin(math.pi / n), 0.02
    run = ms.simulate(mechanism, 3.0)
    wheel = run.trajectory.parts.index("wheel")
    # While the pin pushes, from a little after it enters to the line of the axes.
    t = np.linspace((math.pi / 2 + math.pi / n) / w + 0.15, 3.0, 25)
    theta = w * t - math.pi
    x, y = a - r * np.cos(theta), r * np.sin(theta)
    law = -(np.arctan2(y, x) + math.pi / n) + np.arcsin(0.5 * play / np.hypot(x, y))
    assert run.trajectory.at(t).q[:, wheel] == pytest.approx(law, abs=2e-7)


def test_drawings_show_arcs():
    outlines = ms.load(EXAMPLES / "detent" / "detent.toml").compile().outlines()
    wheel = next(p for p in outlines["parts"] if p["name"] == "wheel")
    kinds = [s["kind"] for s in wheel["layers"][0]["loops"][0]]
    assert kinds == ["arc"] * 24
