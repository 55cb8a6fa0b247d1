"""Patterns go on only where the shapes that meet are the same: like teeth, and one of them missing."""

import math

import pytest

import mainspring as ms
from conftest import ROOT

RATCHET = (ROOT / "examples" / "ratchet-and-pawl" / "ratchet-and-pawl.toml").read_text()


def _wheel(missing: int | None) -> str:
    """Return the ratchet with its twelve teeth written one by one, but for the missing one."""
    rows = []
    for k in range(12):
        if k != missing:
            rows.append(f'["-tip*sin({30 * k})", "tip*cos({30 * k})"]')
        rows.append(f'["-root*sin({30 * k + 30})", "root*cos({30 * k + 30})"]')
    lines = "".join(f"  {{ line = {row} }},\n" for row in rows)
    before, _, rest = RATCHET.partition("[parts.wheel.outer]")
    after = rest[rest.index("[parts.wheel.inner]") :]
    teeth = f'[parts.wheel.outer]\npath = [\n  {{ from = [0, "root"] }},\n{lines}]\n\n'
    kept = [line for line in before.splitlines() if not line.startswith(("teeth =", "marks ="))]
    return "\n".join(kept) + "\n" + teeth + after


@pytest.mark.parametrize(("missing", "change"), [(None, 30), (4, 360), (9, 360)])
def test_a_missing_tooth_makes_the_pattern_a_whole_turn(tmp_path, missing, change):
    path = tmp_path / "wheel.toml"
    path.write_text(_wheel(missing))
    mechanism = ms.load(path).compile()
    answer = ms.predict(mechanism)
    assert answer.status == "repeats"
    pattern = answer.pattern
    assert pattern.change["wheel"]["position"] == pytest.approx(math.radians(change), abs=1e-3)
    # A long run goes on as told.
    first = answer.starts["t"]
    motion = ms.simulate(mechanism, first + 8 * pattern.duration).trajectory
    q, _ = motion.at([first + k * pattern.duration for k in range(9)])
    wheel = q[:, motion.parts.index("wheel")]
    for k in range(9):
        expected = k * pattern.change["wheel"]["position"]
        assert wheel[k] - wheel[0] == pytest.approx(expected, rel=0.01, abs=1e-3)


def test_a_hypothesis_tells_where_its_shape_is_not_the_same(tmp_path):
    path = tmp_path / "wheel.toml"
    path.write_text(_wheel(4))
    hypotheses = ms.predict(ms.load(path).compile()).hypotheses
    whys = [h.why for h in hypotheses if h.why]
    assert any(why.startswith("wheel moves on by") and "shape is not the same" in why for why in whys)
