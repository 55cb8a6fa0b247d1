"""What spaces may be asked for: geared parts by their own angles, refusals with their reason."""

import math
from pathlib import Path

import numpy as np
import pytest

import mainspring as ms

GEARS = """generic m(m)
e0 = cyl(d=4, h=1)
g0 = e0 dif (cyl(d=0.5, h=1))
e1 = cyl(d=2, h=1) at (movx=2.9)
bar = blo(x=3, y=0.4, z=1) at (movy=-0.2, degz=80, movx=2.9, movz=1)
g1 = (e1 un bar) dif (cyl(d=0.5, h=2) at (movx=2.9))
arm = cyl(d=1.2, h=1) un (blo(x=3.4, y=0.5, z=1) at (movy=-0.3, degz=170))
c = (arm dif (cyl(d=0.5, h=1))) at (movx=8, movz=1)
base = blo(x=14, y=6, z=1) at (movx=-3, movy=-3, movz=-2)
pin = cyl(d=0.5, h=4) at (movz=-1)
frame = base un pin un (pin at (movx=2.9)) un (pin at (movx=8))
attr frame : frame = 1
attr e0 : gear = 1
attr e1 : gear = 1
m = g0 asb g1 asb c asb frame
"""


def test_a_geared_part_has_its_own_angle(tmp_path: Path):
    """The space of a gear is that of the same part alone, though its coordinate is the other gear's."""
    (tmp_path / "geared.padl").write_text(GEARS)
    alone = GEARS.replace("e0 = cyl(d=4, h=1)\n", "").replace("g0 = e0 dif (cyl(d=0.5, h=1))\n", "")
    alone = alone.replace("attr e0 : gear = 1\nattr e1 : gear = 1\n", "").replace("g0 asb ", "")
    (tmp_path / "alone.padl").write_text(alone)
    mechanisms = [ms.load(tmp_path / f"{name}.padl").compile() for name in ("geared", "alone")]
    geared, plain = (ms.configuration_space(m, "g1", "c") for m in mechanisms)
    assert ms.find_pairs(mechanisms[0]).subsystems[0].ratios == (1.0, -2.0)
    assert [a.coordinate for a in geared.domain] == ["g1", "c"]
    at = np.random.default_rng(5).uniform(-4, 4, (20_000, 2))
    np.testing.assert_array_equal(geared.is_free(at), plain.is_free(at))
    np.testing.assert_allclose(geared.gap(at).gap, plain.gap(at).gap, atol=1e-9)
    for theta in np.linspace(-3, 3, 25):
        one, two = geared.slice(g1=theta), plain.slice(g1=theta)
        found, wanted = ([v for i in slice_ for v in (i.low, i.high)] for slice_ in (one, two))
        assert found == pytest.approx(wanted, abs=1e-9)
    for curve in geared.curves:
        found = geared.transmission(curve.id, [0.2, 0.6])
        for k in range(2):
            near = min(plain.curves, key=lambda c: np.abs(c.points - found.at[k]).sum(axis=1).min())
            (a, _), (b, _) = near.start, near.end
            if not (b - a) * 1e-6 < found.at[k, 0] - a < (b - a) * (1 - 1e-6):
                continue
            same = plain.transmission(near.id, at={"g1": found.at[k, 0]})
            if same.at[0] == pytest.approx(found.at[k], abs=1e-9):
                assert found.ratio[k] == pytest.approx(same.ratio[0], rel=1e-7)
                assert found.derivatives[k] == pytest.approx(same.derivatives[0], rel=1e-6)
    root = ms.configuration_space(mechanisms[0], "g1", "c", coordinates=("g0", "c"))
    np.testing.assert_array_equal(root.is_free(at * [0.5, 1]), geared.is_free(at * [-1, 1]))


REFUSED = [
    (("ewheel", "leever"), {}, r"no part `leever`; expected one of ewheel, lever, bwheel, frame"),
    (("lever", "Lever"), {}, "named twice"),
    (("frame", "lever"), {}, "one joint only"),
    (
        ("ewheel", "lever"),
        {"window": {"bwheel": (0, 1)}},
        "no coordinate of this space; expected ewheel or lever",
    ),
    (("ewheel", "lever"), {"window": {"lever": (1, 0)}}, "expected its end above its start"),
    (("ewheel", "lever"), {"window": {"lever": (0, 7)}}, "wider than one turn"),
    (("ewheel", "lever"), {"held": {"lever": 0.1}}, "is a coordinate of this space"),
    (("ewheel", "lever"), {"held": {"frame": 0.1}}, "no joint to hold"),
    (("ewheel", "lever"), {"held": {"bwheel": math.inf}}, "expected a finite number"),
    (("ewheel", "lever"), {"coordinates": ("ewheel", "bwheel")}, "does not move ewheel against lever"),
    (("ewheel", "lever"), {"coordinates": ("ewheel", "frame")}, "no joint of its own"),
    (("ewheel", "lever"), {"coordinates": ("lever", "lever")}, "belong to one subsystem"),
]


@pytest.mark.parametrize(("parts", "options", "why"), REFUSED, ids=lambda v: str(v)[:30])
def test_what_has_no_space_is_refused_with_a_reason(mechanism, parts, options, why):
    with pytest.raises(ms.InputError, match=why) as fault:
        ms.configuration_space(mechanism, *parts, **options)
    assert str(fault.value).count("\n") == 0
    assert ":1:1: error: " in str(fault.value)
    assert "; expected " in str(fault.value)


def test_gears_of_one_train_have_no_space(tmp_path: Path):
    (tmp_path / "geared.padl").write_text(GEARS)
    geared = ms.load(tmp_path / "geared.padl").compile()
    with pytest.raises(ms.InputError, match="belong to one subsystem"):
        ms.configuration_space(geared, "g0", "g1")
