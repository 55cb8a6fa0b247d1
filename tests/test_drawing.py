"""Drawings: true arcs with the right sweep, springs that follow, colours that stay."""

import math
import re

import pytest

from mainspring.drawing.outline import at_angle, drawn, path, sweep
from mainspring.drawing.pose import bounds, moved
from mainspring.drawing.spring import Coil, Spiral
from mainspring.drawing.svg import colours, picture


def arc(a: float, b: float, *, convex: bool) -> dict:
    ends = [[2 * math.cos(x), 2 * math.sin(x)] for x in (a, b)]
    return {"kind": "arc", "from": ends[0], "to": ends[1], "center": [0, 0], "radius": 2, "convex": convex}


@pytest.mark.parametrize("span", [1e-6, 0.5, 3.0, math.pi, 4.0, 6.28])
@pytest.mark.parametrize("convex", [True, False])
def test_arcs_of_any_sweep_end_where_they_should(span, convex):
    segment = arc(0.3, 0.3 + (span if convex else -span), convex=convex)
    assert sweep(segment) == pytest.approx(span)
    assert at_angle(segment, 1.0) == pytest.approx(segment["to"])
    commands = re.findall(r"A2 2 0 (\d) (\d) (\S+) ([^A]+)", drawn(segment))
    assert {c[:2] for c in commands} == {("0", str(int(convex)))}
    assert [float(x) for x in commands[-1][2:]] == pytest.approx(segment["to"], abs=1e-5)


def test_no_drawn_arc_reaches_half_a_turn():
    for k in range(1, 60):
        segment = arc(0.0, k * 0.105, convex=True)
        pieces = drawn(segment).count("A")
        assert sweep(segment) / pieces < math.pi


def test_a_circle_closes():
    hole = {"kind": "circle", "center": [1, 2], "radius": 0.5, "convex": False}
    assert path([[hole]]).startswith("M1.5 2A0.5 0.5 0 0 0")
    assert path([[hole]]).endswith("1.5 2Z")


def test_the_spiral_turns_with_its_part():
    spring = Spiral((0.0, 0.0), 1.0, 3.0, 12.0)
    ends = [re.findall(r"-?[\d.]+(?:e-?\d+)?", spring.path(q)) for q in (0.0, 0.7)]
    inner = [complex(*map(float, e[:2])) for e in ends]
    outer = [complex(*map(float, e[-2:])) for e in ends]
    turned = inner[1] / inner[0]
    assert math.atan2(turned.imag, turned.real) == pytest.approx(0.7, abs=1e-4)
    assert outer[0] == pytest.approx(outer[1])


def test_the_coil_follows_its_part():
    spring = Coil((4.0, 0.0), (1.0, 0.0), 3.0, 0.2)
    for q in (-1.0, 0.0, 1.5):
        numbers = re.findall(r"-?[\d.]+", spring.path(q))
        assert float(numbers[0]) == pytest.approx(1.0)
        assert float(numbers[-2]) == pytest.approx(4.0 + q)


def _slide() -> dict:
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    edges = zip(square, [*square[1:], square[0]], strict=True)
    loop = [{"kind": "line", "from": a, "to": b} for a, b in edges]
    layers = [{"bottom": 0, "top": 1, "loops": [loop]}]
    motion = {"kind": "slide", "direction": [0, 1]}
    part = {"name": 'a"<b', "frame": False, "motion": motion, "layers": layers, "gears": []}
    return {"size": 2, "parts": [part], "springs": [{"part": 'a"<b', "relaxed": 0.5, "constant": 1}]}


def test_poses_get_room():
    part = _slide()["parts"][0]
    assert moved(part, 2.0, (1.0, 1.0)) == (1.0, 3.0)
    assert bounds([part], [{}, {'a"<b': 3.0}]) == (0, 0, 1, 4)


def test_names_are_text_never_markup():
    drawn_ = picture(_slide(), title="<script>")
    assert "<script>" not in drawn_
    assert 'data-part="a&quot;&lt;b"' in drawn_


def test_colours_belong_to_parts():
    frame = {"name": "frame", "frame": True}
    parts = [frame, {"name": "a", "frame": False}, {"name": "b", "frame": False}]
    assert colours(parts) == {"frame": "pf", "a": "p0", "b": "p1"}
