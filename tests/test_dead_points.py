"""A driven part whose lever arm is zero at an instant presses on soon after."""

from pathlib import Path

import pytest

import mainspring as ms

DETENT = Path(__file__).parents[1] / "examples" / "detent" / "detent.toml"


@pytest.mark.parametrize("speed", [30, -30])
def test_a_driven_wheel_lifts_the_plunger_from_the_bottom_of_a_notch(speed):
    text = DETENT.read_text(encoding="utf-8")
    driven = text.replace('velocity = "push"', f"drive = {{ speed = {speed} }}")
    assert driven != text
    mechanism = ms.parse(driven, "detent.toml").compile()
    reached = [ms.simulate(mechanism, t).positions["plunger"] for t in (0.5, 1.0, 2.0)]
    assert reached == pytest.approx([3.0, 3.0, 0.0], abs=1e-6)  # on the rim, on the rim, in the next notch
