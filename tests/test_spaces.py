"""Configuration spaces in Python: closed laws, independent gaps on every curve, questions, refusals."""

import dataclasses
import json
import math

import numpy as np
import pytest

import mainspring as ms
from conftest import ESCAPEMENT, ROOT
from mainspring.drawing.feature import segment_of
from mainspring.drawing.pose import chain

EXAMPLES = ROOT / "examples"
PAIRS = [
    ("escapement", "ewheel", "lever", {}),
    ("escapement", "lever", "bwheel", {}),
    ("rotary-to-reciprocating", "wheel", "arm", {}),
    ("ratchet", "wheel", "pawl", {}),
    ("pawl-on-plate", "frame", "pawl", {}),
    ("ratchet", "pawl", "wheel", {"pawl": (-0.1, 0.5)}),
]


def machine(name: str, **values: float) -> ms.Mechanism:
    return ms.load(EXAMPLES / name / f"{name}.padl").compile(values)


@pytest.fixture(scope="module", params=PAIRS, ids=lambda p: f"{p[1]}-{p[2]}")
def pair(request):
    name, a, b, window = request.param
    mechanism = machine(name)
    return mechanism, ms.configuration_space(mechanism, a, b, window=window)


@pytest.fixture(scope="module")
def rocker():
    return ms.configuration_space(machine("rotary-to-reciprocating"), "wheel", "arm")


@pytest.fixture(scope="module")
def ratchet():
    return ms.configuration_space(machine("ratchet"), "wheel", "pawl")


class Placed:
    """Features in the machine's plane, by formulas that share nothing with the program's own."""

    def __init__(self, mechanism, space):
        self.parts = {p["name"]: p for p in mechanism.outlines()["parts"]}
        data = space.drawing_data()
        self.others = data["others"]
        self.moves = {m["part"]: (m["axis"], m["ratio"]) for m in data["moves"]}

    def place(self, part: str, q, p) -> complex:
        """Return where a point of a part, as modelled, is at a configuration."""
        z = complex(*p)
        for link in reversed(chain(self.parts, part)):
            axis, ratio = self.moves.get(link["name"], (0, 0.0))
            x = ratio * q[axis] if ratio else self.others.get(link["name"], 0.0)
            motion = link["motion"]
            if motion["kind"] == "turn":
                c = complex(*motion["center"])
                z = c + (z - c) * complex(math.cos(x), math.sin(x))
            else:
                z += x * complex(*motion["direction"])
        return z

    def shape(self, feature, q):
        """Return a feature as a line or a circle of the plane."""
        s = segment_of(self.parts, vars(feature))
        if feature.corner:
            return ("round", self.place(feature.part, q, s["from"]), 0.0)
        if s["kind"] == "line":
            return ("line", *(self.place(feature.part, q, s[k]) for k in ("from", "to")))
        return ("round" if s["convex"] else "hollow", self.place(feature.part, q, s["center"]), s["radius"])

    def gap(self, features, q) -> float:
        """Return the signed distance of two features."""
        a, b = (self.shape(f, q) for f in features)
        if a[0] == "line" or (a[0] == "hollow" and b[0] == "round"):
            a, b = b, a
        if b[0] == "line":
            _, start, end = b
            along = (end - start) / abs(end - start)
            return -((a[1] - start) * along.conjugate()).imag - a[2]
        if b[0] == "hollow":
            return b[2] - a[2] - abs(a[1] - b[1])
        return abs(a[1] - b[1]) - a[2] - b[2]


def test_every_curve_is_a_contact_of_its_features(pair):
    mechanism, space = pair
    placed = Placed(mechanism, space)
    size = mechanism.outlines()["size"]
    assert len(space.curves) > 4
    for curve in space.curves:
        at = space.transmission(curve.id, np.linspace(0, 1, 9)).at
        gaps = [placed.gap(curve.features, q) for q in [*at, *curve.points]]
        assert np.abs(gaps).max() < 1e-9 * size, (curve.id, curve.features)


def test_free_on_one_side_and_blocked_on_the_other(pair):
    _, space = pair
    for curve in space.curves:
        upright = curve.slope is None
        ends = np.array(curve.end) - curve.start
        if np.abs(ends[1 if upright else 0]) < 1e-3:
            continue
        middle = space.transmission(curve.id, 0.5).at[0]
        step = np.array([1e-7, 0.0] if upright else [0.0, 1e-7])
        step *= 1 + abs(space.transmission(curve.id, 0.5).ratio[0] if not upright else 0)
        sign = 1 if curve.free == "greater" else -1
        assert space.is_free(middle + sign * step)
        assert not space.is_free(middle - sign * step)


def test_exchanging_the_parts_transposes_the_space():
    mechanism = machine("escapement")
    one = ms.configuration_space(mechanism, "ewheel", "lever")
    other = ms.configuration_space(mechanism, "lever", "ewheel")
    at = np.random.default_rng(1).uniform(-0.4, 0.4, (40_000, 2))
    free = one.is_free(at)
    np.testing.assert_array_equal(free, other.is_free(at[:, ::-1]))
    assert 0.1 < free.mean() < 0.9
    assert (other.parts, other.domain[1].repeats) == (("lever", "ewheel"), 10)
    np.testing.assert_allclose(one.gap(at).gap[free], other.gap(at[:, ::-1]).gap[free], atol=1e-12)


def test_teeth_repeat_by_another_feature():
    mechanism = machine("escapement")
    space = ms.configuration_space(mechanism, "ewheel", "lever")
    whole = ms.configuration_space(mechanism, "ewheel", "lever", window={"ewheel": (-math.pi, math.pi)})
    assert (space.domain[0].repeats, whole.domain[0].repeats) == (10, 1)
    at = np.random.default_rng(2).uniform((-3.1, -0.3), (3.1, 0.2), (20_000, 2))
    free = space.is_free(at)
    np.testing.assert_array_equal(free, whole.is_free(at))
    here, there = space.gap(at[free]), whole.gap(at[free])
    np.testing.assert_allclose(here.gap, there.gap, atol=1e-9)
    placed = Placed(mechanism, space)
    off = [
        abs(placed.gap(space.named(f), q) - g)
        for q, f, g in zip(at[free][:2000], here.features, here.gap, strict=False)
    ]
    # Where the nearest points are ends of segments the distance is that of corners.
    assert np.mean(np.array(off) < 1e-9) > 0.95
    assert len({f[0] for f in here.features.tolist()}) > 30


def _groove(theta):
    """Return the arm's angle with the pin amid the groove, the half play, and the pin's distance."""
    crank, depth, play = 3.0, 10.0, 0.02
    x, y = crank * np.cos(theta), depth + crank * np.sin(theta)
    reach = np.hypot(x, y)
    return -np.arctan2(x, y) + math.atan2(crank, depth), np.arcsin(0.5 * play / reach), reach


def test_a_pin_in_a_groove_has_the_law_of_its_triangle(rocker):
    h = 0.01
    for theta in np.linspace(-3.1, 3.1, 63):
        middle, half, _ = _groove(theta)
        assert rocker.is_free((theta, middle))
        (low, high) = rocker.play((theta, middle))[1]
        assert (low, high) == pytest.approx((middle - half, middle + half), abs=1e-9)
        found = next(i for i in rocker.slice(wheel=theta) if i.low < middle < i.high)
        assert (found.low, found.high) == pytest.approx((low, high), abs=1e-12)
        assert rocker.gap((theta, middle)).gap == pytest.approx(h, abs=1e-9)


def test_a_pin_in_a_groove_transmits_by_its_law(rocker):
    """The lower side is `φ = −β − asin(h/ρ)`: its derivatives by a power series of the same law."""
    crank, depth, h = 3.0, 10.0, 0.01
    seen = 0
    for theta in np.linspace(-3.0, 3.0, 41):
        middle, _, _ = _groove(theta)
        lower = next(i for i in rocker.slice(wheel=theta) if i.low < middle < i.high).curves[0]
        found = rocker.transmission(lower, at={"wheel": theta})
        s, c = math.sin(theta), math.cos(theta)
        square = crank**2 + depth**2 + 2 * crank * depth * s
        reach, rise = math.sqrt(square), crank * depth * c / math.sqrt(square)
        turn = -(crank * depth * s + crank**2) / square  # dβ/dθ
        ratio = -turn + h * rise / (reach * math.sqrt(square - h * h))
        assert found.ratio[0] == pytest.approx(ratio, abs=1e-9)
        law = _fit(lambda t: _groove(t)[0] - _groove(t)[1], theta)
        assert found.derivatives[0] == pytest.approx(law[2:], abs=2e-6)
        seen += 1
    assert seen == 41


def _fit(law, at, radius=0.4, order=40):
    """Return derivatives 0 to 3 of an analytic function, by its Chebyshev series."""
    series = np.polynomial.Chebyshev.interpolate(law, order, domain=[at - radius, at + radius])
    return [float(series.deriv(k)(at)) if k else float(series(at)) for k in range(4)]


def test_a_nose_on_the_floor_of_a_notch(ratchet):
    """With the wheel at θ: `n·(P + R(q) v) = floor + nose`, n the floor's normal."""
    pivot, nose, floor = complex(-4.5, 8.0), 0.25, 4.4
    arm = complex(-0.25, 4.65) - pivot
    for theta in np.linspace(-0.25, -0.002, 40):
        normal = complex(-math.sin(theta), math.cos(theta))
        level = floor + nose - (normal.conjugate() * pivot).real
        base = np.angle(normal) - np.angle(arm)
        reach = abs(arm)
        roots = [base + s * math.acos(level / reach) for s in (1, -1)]
        lowest = min(roots, key=lambda q: abs((q + math.pi) % (2 * math.pi) - math.pi))
        low = min(ratchet.slice(wheel=theta), key=lambda i: abs(i.low)).low
        assert low == pytest.approx((lowest + math.pi) % (2 * math.pi) - math.pi, abs=1e-9)


def test_pressure_angles_follow_from_point_and_normal(rocker):
    found = rocker.transmission(rocker.slice(wheel=0.3)[0].curves[0], np.linspace(0.05, 0.95, 7))
    centers = (np.zeros(2), np.array([0.0, -10.0]))
    for k, center in enumerate(centers):
        velocity = (found.point - center)[:, ::-1] * [-1, 1]
        along = np.abs((velocity * found.normal).sum(axis=1)) / np.linalg.norm(velocity, axis=1)
        np.testing.assert_allclose(found.pressure_angles[:, k], np.arccos(along), atol=1e-9)


def test_pushing_the_wheel_lifts_the_pawl_or_jams(ratchet):
    lifted = ratchet.walk((-0.01, 0.005), wheel=-2 * math.pi)
    assert lifted.end == "arrived"
    top = max(points[:, 1].max() for points in (c.points for c in ratchet.curves) if points[0, 1] < 0.2)
    assert lifted.stages[-1].end == pytest.approx((-2 * math.pi, top), abs=1e-3)
    jammed = ratchet.walk((-0.05, 0.03), wheel=1.0)
    assert jammed.end == "jammed"
    assert jammed.stages[-1].end == pytest.approx((0.0, 0.0), abs=1e-6)
    assert jammed.stages[0].curve is None
    assert [f.part for f in jammed.stages[-1].features] == ["wheel", "pawl"]
    assert ratchet.walk((0.0, -0.3), wheel=1.0) is None


def test_the_tooth_that_lifts_is_the_one_that_is_there(ratchet):
    mechanism = machine("ratchet")
    placed = Placed(mechanism, ratchet)
    for turn in range(12):
        walk = ratchet.walk((turn * math.pi / 6 - 0.05, 0.03), wheel=turn * math.pi / 6 - 0.4)
        stage = next(s for s in walk.stages if s.curve is not None)
        assert placed.gap(stage.features, stage.start) == pytest.approx(0.0, abs=1e-7)


def test_ways_wind_and_components_are_told(ratchet, rocker):
    way = ratchet.way((-0.01, 0.005), (-0.01 + math.pi / 6, 0.005))
    assert way.points[0] == pytest.approx((-0.01, 0.005))
    assert way.exact
    assert ratchet.components[0].winding == ((1, 0),)
    inner, outer = (rocker.component((0.0, q)) for q in (0.0, 1.0))
    assert {inner, outer} == {0, 1}
    assert rocker.way((0.0, 0.0), (0.0, 1.0)) is None
    assert rocker.way((0.0, 0.0), (2 * math.pi, 0.0)).exact
    at = np.array([(0.0, 0.0), (0.0, 1.0), (0.0, 0.1)])
    assert rocker.component(at).tolist() == [inner, outer, -1]
    assert rocker.component((0.0, 0.1)) is None


def test_arrays_of_any_layout_and_single_points(ratchet):
    at = np.random.default_rng(3).uniform(-3, 3, (5000, 2))
    free = ratchet.is_free(at)
    assert (free.dtype, free.shape) == (np.dtype(bool), (5000,))
    np.testing.assert_array_equal(free, ratchet.is_free(np.asfortranarray(at)))
    np.testing.assert_array_equal(free, ratchet.is_free(at.tolist()))
    np.testing.assert_array_equal(free[::7], ratchet.is_free(at[::7]))
    assert [ratchet.is_free(p) for p in at[:50]] == free[:50].tolist()
    assert ratchet.is_free(np.empty((0, 2))).shape == (0,)
    gaps = ratchet.gap(at)
    assert (gaps.gap[free] > 0).all()
    assert np.nanmax(gaps.gap[~free]) <= 1e-8
    assert not ratchet.is_free((math.nan, 0.0))
    for bad in (1.0, (1.0,), np.zeros((3, 3)), np.zeros((2, 2, 2))):
        with pytest.raises(ValueError, match="expected"):
            ratchet.is_free(bad)


def test_json_and_attributes_agree(pair):
    _, space = pair
    o = json.loads(space.to_json())
    assert o["parts"] == list(space.parts)
    assert len(o["curves"]) == len(space.curves) == space.stats["curves"]
    assert [c["id"] for c in o["components"]] == [c.id for c in space.components]
    for c in space.components:
        assert space.component(c.inside) == c.id
        used = [e.curve for cycle in c.boundary for e in cycle.edges if e.curve is not None]
        assert set(used) <= {curve.id for curve in space.curves}
        for cycle in c.boundary:
            for before, after in zip(cycle.edges, cycle.edges[1:], strict=False):
                assert before.end == pytest.approx(after.start, abs=1e-7)
    with pytest.raises(dataclasses.FrozenInstanceError):
        space.status = "other"
    with pytest.raises(TypeError):
        space.stats["curves"] = 0
    with pytest.raises(ValueError, match="read-only"):
        space.curves[0].points[0, 0] = 1.0
    assert space._repr_html_().startswith("<svg")


def test_held_joints_move_the_map():
    """The pawl against the rim with the plate held: nothing changes but by the plate's angle."""
    mechanism = machine("pawl-on-plate")
    space = ms.configuration_space(mechanism, "pawl", "frame")
    assert space.coordinates == ("pawl", "plate")
    flipped = ms.configuration_space(mechanism, "frame", "pawl", coordinates=("pawl", "plate"))
    at = np.random.default_rng(4).uniform(-3, 3, (2000, 2))
    np.testing.assert_array_equal(space.is_free(at), flipped.is_free(at))


def test_coordinates_go_by_place_unless_parts_bear_the_names(ratchet):
    assert ratchet.slice(a=0.1) == ratchet.slice(wheel=0.1)
    assert ratchet.slice(b=0.1) == ratchet.slice(pawl=0.1)
    assert ratchet.walk((0, 0), a=0.3) == ratchet.walk((0, 0), wheel=0.3)
    bars = ms.Builder("bars")
    for name, x in (("b", -1.6), ("a", 1.6)):
        edges = [ms.Line((x + 1.5, -0.2)), ms.Line((x + 1.5, 0.2)), ms.Line((x - 1.5, 0.2)), ms.Close()]
        outline = ms.Path((x - 1.5, -0.2), edges)
        bars.part(name, inertia=1, motion=ms.Turns((x + 0.3, 0)), outer=[outline])
    space = ms.configuration_space(bars.build().compile(), "b", "a")
    assert space.slice(b=0.5) == space.slice({"B": 0.5})
    assert space.slice(a=0.5) == space.slice({"A": 0.5})
    assert space.slice(a=0.5) != space.slice(b=0.5)


def test_questions_out_of_range_say_so(ratchet):
    for ask in (
        lambda: ratchet.slice(),
        lambda: ratchet.slice(wheel=1.0, pawl=2.0),
        lambda: ratchet.slice(lever=1.0),
        lambda: ratchet.walk((0.1, 0.2)),
        lambda: ratchet.walk((-0.05, 0.03), wheel=math.inf),
        lambda: ratchet.slice(wheel=math.nan),
        lambda: ratchet.transmission(99),
        lambda: ratchet.transmission(0, 1.5),
        lambda: ratchet.transmission(0, at={"pawl": 0.0}),
        lambda: ratchet.play(np.zeros((2, 2))),
    ):
        with pytest.raises(ValueError, match="expected"):
            ask()


def test_the_same_bytes_every_time():
    made = {
        ms.configuration_space(ms.load(ESCAPEMENT).compile(), "ewheel", "lever").to_json() for _ in range(3)
    }
    assert len(made) == 1
