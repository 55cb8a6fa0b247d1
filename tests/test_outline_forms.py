"""The same outline written otherwise, in TOML: turned round, begun elsewhere, with a side in two pieces."""

from dataclasses import dataclass

import numpy as np
import pytest

import mainspring as ms


@dataclass(frozen=True)
class Side:
    """A side to a point: a line, or an arc about a centre."""

    to: tuple[float, float]
    center: tuple[float, float] | None = None
    left: bool = True


CAM = [
    Side((12.0, -5.0)),
    Side((12.0, 5.0), (12.0, 0.0)),
    Side((-3.0, 9.0)),
    Side((-3.0, 3.0)),
    Side((-3.0, -3.0), (-3.0, 0.0), left=False),
    Side((-3.0, -9.0)),
]
# As modelled it points away from the cam.
FOLLOWER = [
    Side((49.0, -2.0)),
    Side((49.0, 2.0), (49.0, 0.0)),
    Side((31.0, 2.0)),
    Side((31.0, -2.0)),
]


def turned_round(sides: list[Side]) -> list[Side]:
    """Return the loop run through in the other sense."""
    starts = [sides[-1].to] + [side.to for side in sides[:-1]]
    loop = zip(reversed(sides), reversed(starts), strict=True)
    return [Side(start, side.center, not side.left) for side, start in loop]


def begun_elsewhere(sides: list[Side]) -> list[Side]:
    """Return the loop from its third point on."""
    return sides[2:] + sides[:2]


def in_pieces(sides: list[Side]) -> list[Side]:
    """Return the loop with a point in the middle of its first line."""
    (a, b), (c, d) = sides[-1].to, sides[0].to
    assert sides[0].center is None
    return [Side(((a + c) / 2, (b + d) / 2)), *sides]


def path(sides: list[Side]) -> str:
    """Return the loop as a TOML list."""

    def side(s: Side) -> str:
        if s.center is None:
            return f"{{ line = {list(s.to)} }}"
        turn = "left" if s.left else "right"
        return f'{{ arc = {list(s.to)}, center = {list(s.center)}, turn = "{turn}" }}'

    start = f"{{ from = {list(sides[-1].to)} }}"
    return ", ".join([start, *map(side, sides)])


def space(tmp_path, form) -> ms.ConfigurationSpace:
    """Return the space of the two parts, both outlines in this form."""
    model = tmp_path / f"{form.__name__}.toml"
    model.write_text(
        f"""[machine]
name = "forms"
length = "mm"
time = "s"
mass = "g"
[parts.cam]
motion = {{ turns = [0, 0] }}
inertia = 1
z = [0, 1]
outer = {{ path = [{path(form(CAM))}] }}
[parts.follower]
motion = {{ turns = [31, 0] }}
inertia = 1
z = [0, 1]
outer = {{ path = [{path(form(FOLLOWER))}] }}
""",
        encoding="utf-8",
    )
    return ms.configuration_space(ms.load(model).compile(), "cam", "follower")


def as_written(sides: list[Side]) -> list[Side]:
    """Return the loop itself."""
    return sides


@pytest.mark.parametrize("form", [turned_round, begun_elsewhere, in_pieces])
def test_the_space_is_that_of_the_shape(tmp_path, form):
    one, other = space(tmp_path, as_written), space(tmp_path, form)
    assert 8 < len(one.curves) <= len(other.curves)
    assert [c.winding for c in one.components] == [c.winding for c in other.components]
    assert [c.area for c in one.components] == pytest.approx([c.area for c in other.components], rel=1e-9)
    points = np.random.default_rng(4).uniform(-np.pi, np.pi, (4000, 2))
    gaps, others = np.array(one.gap(points).gap), np.array(other.gap(points).gap)
    known = np.isfinite(gaps)
    assert known.sum() > 300
    assert np.array_equal(known, np.isfinite(others))
    assert np.allclose(gaps[known], others[known], atol=1e-9)
    apart = np.array(one.is_free(points)) != np.array(other.is_free(points))
    assert not apart[~known | (np.abs(gaps) > 1e-9)].any()
    assert 0.02 < np.mean(one.is_free(points)) < 0.98
