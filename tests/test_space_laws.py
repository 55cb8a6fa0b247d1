"""Configuration spaces of the parametric machines against the laws their kinematics have in closed form."""

import math
from math import acos, asin, atan2, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest

import mainspring as ms
from conftest import ROOT

NEAR = 1e-9


def space_of(name: str, *parts: str, **values: float):
    machine = ms.load(ROOT / "examples" / name / f"{name}.toml")
    known = {p.name: p.value for p in machine.parameters}
    mechanism = machine.compile(**values)
    return ms.configuration_space(mechanism, *parts), {**known, **values}


def interval(space, at: float, value: float):
    """Return the free interval of the second coordinate that holds a value, both in the same turn."""
    low, high = space.play((at, value))[1]
    return low, high


def bounds(space, at: float, value: float):
    """Return the two curves that bound the second coordinate around a value."""
    axis = space.domain[1]
    shifts = [k * axis.period for k in range(-40, 41)] if axis.period else [0.0]
    slice_ = space.slice({space.coordinates[0]: at})
    return next(i.curves for i in slice_ for s in shifts if i.low < value + s < i.high)


def both(space, at: float, value: float):
    """Return ratio and derivatives along the two bounding curves, `(2, 3)`."""
    first = space.domain[0]
    found = []
    for curve in bounds(space, at, value):
        ends = sorted((space.curves[curve].start[0], space.curves[curve].end[0]))
        period = first.period or 0.0
        x = next(x for x in (at, at - period, at + period) if ends[0] <= x <= ends[1])
        t = space.transmission(curve, at={first.coordinate: x})
        found.append([t.ratio[0], *t.derivatives[0]])
    return np.array(found)


GENEVAS = [("geneva-four", {}), ("geneva-six", {}), ("geneva-four", {"a": 60.0, "play": 0.1})]


@pytest.fixture(scope="module", params=GENEVAS, ids=lambda p: f"{p[0]}{sorted(p[1])}")
def geneva(request):
    name, values = request.param
    space, known = space_of(name, "driver", "wheel", **values)
    half = pi / known["slots"]
    return space, known, half, known["a"] * sin(half)


def test_a_geneva_wheel_follows_its_pin(geneva):
    """With ψ the driver's angle from the line of the axes `q = −half − atan2(r sin ψ, a − r cos ψ)` ± play.

    At ψ = 0 the pin is at the slot's round end, whose middle it may leave by half the play.
    """
    space, known, half, crank = geneva
    a, play = known["a"], known["play"]
    reach = 0.9 * (pi / 2 - half)
    for psi in np.linspace(-reach, reach, 37):
        x, y = a - crank * cos(psi), crank * sin(psi)
        middle, slack = -half - atan2(y, x), asin(0.5 * play / hypot(x, y))
        if abs(psi) < 1e-12:
            slack = 2 * asin(0.25 * play / (a - crank))
        low, high = interval(space, pi + psi, middle)
        assert (low, high) == pytest.approx((middle - slack, middle + slack), abs=NEAR)


def test_a_geneva_wheel_has_the_textbook_velocity_and_acceleration(geneva):
    """With λ = r/a, N = 1 + λ² − 2 λ cos ψ: `q' = −λ (cos ψ − λ)/N`, `q'' = λ (1 − λ²) sin ψ/N²`.

    That is the mean of both sides of the slot; either alone has a part due to the play.
    """
    space, _, half, _ = geneva
    ratio = sin(half)
    reach = 0.9 * (pi / 2 - half)
    for psi in np.linspace(-reach, reach, 37):
        n = 1 + ratio**2 - 2 * ratio * cos(psi)
        law = -ratio * (cos(psi) - ratio) / n, ratio * (1 - ratio**2) * sin(psi) / n**2
        middle = -half - atan2(ratio * sin(psi), 1 - ratio * cos(psi))
        found = both(space, pi + psi, middle).mean(axis=0)[:2]
        assert found == pytest.approx(law, abs=NEAR)


def test_a_geneva_wheel_dwells_with_the_play_of_its_hollow(geneva):
    """The hollow's ends, γ off its middle, meet the disc: `cos(γ − q) = (a² + rim² − disc²)/(2 a rim)`."""
    space, known, half, _ = geneva
    a, lock = known["a"], known["lock"]
    rim, disc = a * cos(half), lock - known["slack"]
    gamma = acos((a * a + rim * rim - lock * lock) / (2 * a * rim))
    play = gamma - acos((a * a + rim * rim - disc * disc) / (2 * a * rim))
    for theta in np.linspace(-0.3, 0.3, 13):
        assert interval(space, theta, 0.0) == pytest.approx((-play, play), abs=NEAR)
        assert both(space, theta, 0.0)[:, 0] == pytest.approx((0.0, 0.0), abs=NEAR)
    assert play > 1e-4


def test_a_geneva_drive_goes_one_slot_a_turn(geneva):
    space, known, half, _ = geneva
    (component,) = space.components
    assert component.winding == ((1, -1),)
    assert component.turns == ((int(known["slots"]), -1),)
    walk = space.walk((0.0, 0.0), driver=2 * pi * known["slots"])
    assert walk.end == "arrived"
    assert walk.stages[-1].end[1] == pytest.approx(-2 * pi, abs=2e-3)
    back = space.way((0.0, 0.0), (2 * pi, -2 * half))
    assert back.exact
    assert not space.way((0.0, 0.0), (2 * pi, 0.0)).exact


def test_a_flat_follower_is_lifted_by_a_sine():
    space, known = space_of("cam-flat-follower", "cam", "follower")
    e = known["e"]
    for theta in np.linspace(-pi, pi, 61)[1:-1]:
        rise = e * sin(theta)
        low = interval(space, theta, rise + 1.0)[0]
        assert low == pytest.approx(rise, abs=NEAR)
        curve = bounds(space, theta, rise + 1.0)[0]
        t = space.transmission(curve, at={"cam": theta})
        law = [e * cos(theta), -e * sin(theta), -e * cos(theta)]
        assert [t.ratio[0], *t.derivatives[0]] == pytest.approx(law, abs=NEAR)
        assert t.pressure_angles[0, 1] == pytest.approx(0.0, abs=NEAR)
    top = next(m for m in space.marks if m.name == "top")
    assert top.value == pytest.approx(
        max(c.points[:, 1].max() for c in space.curves if c.free == "greater"), abs=1e-6
    )


def test_a_roller_follower_is_lifted_as_by_a_connecting_rod():
    """`q = e sin θ + √(l² − e² cos² θ) − √(l² − e²)`, l the sum of the radii: the law of a slider-crank."""
    space, known = space_of("cam-roller-follower", "cam", "follower")
    e, rod = known["e"], known["R"] + known["roller"]
    for theta in np.linspace(-pi, pi, 61)[1:-1]:
        s, c = sin(theta), cos(theta)
        w = sqrt(rod**2 - (e * c) ** 2)
        rise = e * s + w - sqrt(rod**2 - e**2)
        assert interval(space, theta, rise + 0.5)[0] == pytest.approx(rise, abs=NEAR)
        t = space.transmission(bounds(space, theta, rise + 0.5)[0], at={"cam": theta})
        second = -e * s + e**2 * (c * c - s * s) / w - (e * e * s * c) ** 2 / w**3
        assert t.ratio[0] == pytest.approx(e * c + e * e * s * c / w, abs=NEAR)
        assert t.derivatives[0, 0] == pytest.approx(second, abs=NEAR)
        assert t.pressure_angles[0, 1] == pytest.approx(asin(e * abs(c) / rod), abs=NEAR)


def _triangle(theta, e, c, arm, rod):
    """Return the arm's angle that puts its end at `rod` from the disc's centre, over the line of the axes."""
    x, y = e * cos(theta) - c, e * sin(theta)
    d = hypot(x, y)
    return atan2(y, x) % (2 * pi) - acos((d * d + arm * arm - rod * rod) / (2 * d * arm))


@pytest.mark.parametrize(
    ("name", "parts", "names"),
    [
        ("cam-swinging-follower", ("cam", "follower"), ("e", "c", "arm", "R", "roller")),
        ("eccentric-discs", ("driver", "driven"), ("e", "a", "f", "R", "S")),
    ],
)
def test_two_discs_keep_their_centres_apart(name, parts, names):
    """Both laws are that of a four-bar linkage whose rod is the sum of the radii."""
    space, known = space_of(name, *parts)
    e, c, arm, one, other = (known[n] for n in names)
    start = _triangle(0.0, e, c, arm, one + other)
    ends = {}
    for theta in np.linspace(-pi, pi, 61)[1:-1]:
        law = _triangle(theta, e, c, arm, one + other) - start
        found = [v for i in space.slice({parts[0]: theta}) for v in (i.low, i.high)]
        turned = [(v - law + pi) % (2 * pi) - pi for v in found]
        assert min(map(abs, turned)) < NEAR
        ends[theta] = law
    assert max(ends.values()) - min(ends.values()) > 0.2


def test_a_scotch_yoke_follows_a_cosine():
    space, known = space_of("scotch-yoke", "crank", "yoke")
    r, play = known["r"], known["play"]
    for theta in np.linspace(-pi, pi, 61)[1:-1]:
        middle = r * cos(theta) - r
        low, high = interval(space, theta, middle)
        assert (low, high) == pytest.approx((middle - play / 2, middle + play / 2), abs=NEAR)
        law = [-r * sin(theta), -r * cos(theta), r * sin(theta)]
        assert both(space, theta, middle) == pytest.approx(np.array([law, law]), abs=1e-8)
    inside = space.components[space.component((0.0, 0.0))]
    assert inside.winding == ((1, 0),)
    assert inside.area == pytest.approx(2 * pi * play, rel=1e-4)


def test_a_pin_in_a_slot_returns_quickly():
    """`q = atan2(h + r sin θ, r cos θ) − atan2(h, r) ± asin(play/2ρ)`."""
    space, known = space_of("pin-in-slot", "crank", "lever")
    r, h, play = known["r"], known["h"], known["play"]
    for theta in np.linspace(-pi, pi, 61)[1:-1]:
        x, y = r * cos(theta), h + r * sin(theta)
        middle, slack = atan2(y, x) - atan2(h, r), asin(0.5 * play / hypot(x, y))
        low, high = interval(space, theta, middle)
        assert (low, high) == pytest.approx((middle - slack, middle + slack), abs=NEAR)
        ratio = (r * r + r * h * sin(theta)) / (x * x + y * y)
        assert both(space, theta, middle).mean(axis=0)[0] == pytest.approx(ratio, abs=NEAR)


def test_a_detent_is_lifted_out_of_its_notch():
    """At the bottom the ball lies in the notch, half a place further on the rim."""
    space, known = space_of("detent", "wheel", "plunger")
    rim, notch, ball = known["rim"], known["notch"], known["ball"]
    for theta in np.linspace(-0.024, 0.024, 17):
        law = rim * cos(theta) - sqrt((notch - ball) ** 2 - (rim * sin(theta)) ** 2) - (rim - notch + ball)
        assert interval(space, theta, law + 1.0)[0] == pytest.approx(law, abs=NEAR)
    for place in range(6):
        half = pi / known["places"] + place * 2 * pi / known["places"]
        assert interval(space, half, notch + 1.0)[0] == pytest.approx(notch, abs=NEAR)
    assert {m.name: m.value for m in space.marks} == pytest.approx({"place": pi / 3, "out": notch})


def test_involute_gears_keep_their_ratio():
    """Flanks of six arcs keep the ratio of involutes to a thousandth, corners to three; teeth are counted."""
    space, known = space_of("involute-gears", "pinion", "wheel")
    ratio = -known["z1"] / known["z2"]
    assert len(space.curves) == 30
    for curve in space.curves:
        t = space.transmission(curve.id, np.linspace(0, 1, 33))
        flanks = {f.kind for f in curve.features} == {"arc"}
        np.testing.assert_allclose(t.ratio, ratio, rtol=1e-3 if flanks else 3e-3)
    (component,) = space.components
    assert (component.winding, component.copies) == (((1, -1),), 10)
    assert component.turns == ((3, -2),)
    play = np.array([np.diff(interval(space, x, ratio * x))[0] for x in np.linspace(-3, 3, 101)])
    wanted = known["backlash"] / (known["module"] * known["z2"] / 2)
    np.testing.assert_allclose(play, wanted, rtol=0.05)


MACHINES = {
    "geneva-four": ("driver", "wheel"),
    "geneva-six": ("driver", "wheel"),
    "cam-flat-follower": ("cam", "follower"),
    "cam-roller-follower": ("cam", "follower"),
    "cam-swinging-follower": ("cam", "follower"),
    "detent": ("wheel", "plunger"),
    "eccentric-discs": ("driver", "driven"),
    "involute-gears": ("pinion", "wheel"),
    "pin-in-slot": ("crank", "lever"),
    "ratchet-and-pawl": ("wheel", "pawl"),
    "scotch-yoke": ("crank", "yoke"),
}


@pytest.mark.parametrize("name", MACHINES)
def test_curves_are_contacts_and_their_slopes_are_told(name):
    space, _ = space_of(name, *MACHINES[name])
    scale = np.array([d.high - d.low for d in space.domain])
    for curve in space.curves:
        t = space.transmission(curve.id, np.linspace(0.02, 0.98, 9))
        gaps = space.gap(t.at).gap
        assert np.nanmax(np.abs(gaps)) < 1e-7
        if curve.slope:
            slack = 1e-2 * (1 + np.abs(t.ratio).max())
            assert curve.slope[0] - slack < t.ratio.min()
            assert t.ratio.max() < curve.slope[1] + slack
        inside = np.abs(curve.points - t.at[4]) / scale
        assert inside.max(axis=1).min() < 0.51
    assert math.isfinite(space.components[0].area)
