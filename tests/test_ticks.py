"""Axes: round marks, degrees people use, seconds to days."""

import math

import pytest

from mainspring.drawing import ticks


@pytest.mark.parametrize("span", [1e-9, 1e-3, 0.7, 12.0, 4000.0, 1e9])
@pytest.mark.parametrize("offset", [0.0, -3.0, 1e6])
def test_marks_are_few_and_inside(span, offset):
    for axis in (ticks.lengths(offset, offset + span), ticks.angles(offset, offset + span)):
        assert len(axis.marks) <= 6
        assert all(axis.low <= value <= axis.high for value, _ in axis.marks)


def test_angles_are_multiples_people_use():
    axis = ticks.angles(-math.pi / 2, math.pi / 2)
    assert [text for _, text in axis.marks] == ["−90°", "−45°", "0°", "45°", "90°"]


@pytest.mark.parametrize(("end", "unit"), [(37.0, "s"), (600.0, "min"), (20_000.0, "h"), (1e6, "d")])
def test_times_use_the_unit_that_fits(end, unit):
    axis = ticks.times(0.0, end)
    assert axis.marks[-1][1].endswith(f" {unit}")
    assert 3 <= len(axis.marks) <= 12


def test_a_constant_gets_room():
    axis = ticks.lengths(5.0, 5.0)
    assert axis.low < 5.0 < axis.high
