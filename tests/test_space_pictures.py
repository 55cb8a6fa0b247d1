"""Pictures of configuration spaces: what is white is free, curves have names, the page needs nothing else."""

import html.parser
import json
import math
import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

import mainspring as ms
from conftest import ESCAPEMENT, ROOT
from mainspring.drawing.space import plot
from mainspring.report import space_page
from mainspring.report.push import push

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def wheel():
    return ms.configuration_space(ms.load(ESCAPEMENT).compile(), "ewheel", "lever")


@pytest.fixture(scope="module")
def page(wheel):
    return space_page(ms.load(ESCAPEMENT).compile(), wheel)


def _inside(polygons, at):
    """Count how often the polygons go round a point."""
    total = 0
    for polygon in polygons:
        d = np.array(polygon) - at
        angle = np.arctan2(d[:, 1], d[:, 0])
        turn = (np.diff(np.append(angle, angle[0])) + math.pi) % (2 * math.pi) - math.pi
        total += round(turn.sum() / (2 * math.pi))
    return total


@pytest.mark.parametrize(
    ("name", "a", "b"),
    [
        ("escapement", "ewheel", "lever"),
        ("escapement", "lever", "bwheel"),
        ("rotary-to-reciprocating", "wheel", "arm"),
        ("pawl-on-plate", "frame", "pawl"),
        ("ratchet", "pawl", "wheel"),
    ],
)
def test_what_is_white_is_free(name, a, b):
    mechanism = ms.load(ROOT / "examples" / name / f"{name}.padl").compile()
    space = ms.configuration_space(mechanism, a, b)
    data = space.drawing_data()
    (x, y) = space.domain
    at = np.random.default_rng(6).uniform((x.low, y.low), (x.high, y.high), (1500, 2))
    edges = np.concatenate([c.points for c in space.curves])
    scale = (x.high - x.low, y.high - y.low)
    clear = [np.abs((edges - p) / scale).max(axis=1).min() > 2e-3 for p in at]
    white = [_inside(data["free"], p) for p in at[clear]]
    assert set(white) <= {0, 1}
    wrong = np.array(white, dtype=bool) != space.is_free(at[clear])
    # Long straight curves have few points: only what is really within a chord's slack may differ.
    assert wrong.mean() < 2e-3


def test_the_file_is_well_formed_and_names_its_curves(wheel):
    root = ElementTree.fromstring(wheel.svg())
    assert root.find(f"{SVG}title").text == "Configuration space of ewheel and lever"
    assert "one free component" in root.find(f"{SVG}desc").text
    titles = [g.find(f"{SVG}title").text for g in root.iter(f"{SVG}g") if g.get("class") == "cs-contact"]
    assert len(titles) == len(wheel.curves)
    assert all("ewheel " in t and " – lever " in t for t in titles)
    labels = [t.text for t in root.iter(f"{SVG}text")]
    assert {"−180°", "0°", "180°", "5°"} <= set(labels)
    assert "nan" not in wheel.svg()
    assert wheel.svg() == wheel.svg()


def test_the_tile_is_drawn_over_the_whole_turn(wheel):
    shown = plot(wheel.drawing_data())
    assert (shown.x.low, shown.x.high) == (-math.pi, math.pi)
    assert len(shown.x.offsets) == 11
    assert wheel.svg().count("<use ") == 11
    assert shown.y.span < 1.0, "the lever's range is cropped to where anything is free"
    low, high = np.array([p for f in wheel.drawing_data()["free"] for p in f])[:, 1][[0, -1]]
    assert shown.y.low < min(low, high) <= max(low, high) < shown.y.high


def test_marks_are_lines_with_names():
    pair = ms.configuration_space(ms.load(ESCAPEMENT).compile(), "ewheel", "lever")
    data = pair.drawing_data()
    data["marks"] = [{"coordinate": "lever", "name": "release & <go>", "value": 0.1}]
    from mainspring.drawing import draw_space

    drawn = draw_space(data)
    assert "release &amp; &lt;go&gt;" in drawn
    assert drawn.count('class="cs-mark"') == 1


class _Balance(html.parser.HTMLParser):
    """Notes elements that are closed in the wrong order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.wrong: list[str] = []

    def handle_starttag(self, tag, _attrs):
        """Note an element that opens."""
        if tag != "meta":
            self.open.append(tag)

    def handle_startendtag(self, _tag, _attrs):
        """Pass over an element that closes itself."""

    def handle_endtag(self, tag):
        """Compare an element that closes with the last that opened."""
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


def test_the_page_needs_nothing_else(page):
    text = re.sub(r'xmlns="[^"]*"', "", page)
    assert not re.search(r"(?:src|href)=\"[^#]|@import|url\((?!#)|fetch\(|XMLHttp|import\(|https?:", text)
    parser = _Balance()
    parser.feed(page)
    assert (parser.open, parser.wrong) == ([], [])
    assert len(page.encode()) < 500_000


def test_the_page_knows_what_lights(page, wheel):
    data = json.loads(re.search(r'id="space">(.*?)</script>', page, re.S)[1])
    marks = [int(m) for m in re.findall(r'data-mark="(\d+)"', page)]
    assert marks == list(range(len(marks)))
    assert {m for c in data["curves"] for m in c["m"]} == set(marks)
    assert {"ewheel's corner and lever's edge", "ewheel's edge and lever's corner"} <= {
        c["t"] for c in data["curves"]
    }
    assert [len(c["p"]) for c in data["curves"]] == [len(c.points) for c in wheel.curves]
    assert data["moves"] == {"ewheel": [0, 1.0], "lever": [1, 1.0]}
    assert data["tiles"][0]["part"] == "ewheel"
    assert data["tiles"][1] is None
    assert data["tiles"][0]["angle"] == pytest.approx(-math.pi / 5)


def test_the_film_is_the_walk(page, wheel):
    film = json.loads(re.search(r'id="space">(.*?)</script>', page, re.S)[1])["film"]
    walk = wheel.walk(wheel.start, ewheel=2 * math.pi)
    assert film["end"] == walk.end == "arrived"
    assert film["points"][0] == list(wheel.start)
    assert film["points"][-1] == pytest.approx(walk.stages[-1].end, abs=1e-4)
    steps = np.diff(np.array(film["points"]), axis=0)
    assert (steps[:, 0] >= -1e-9).all()
    gaps = wheel.gap(np.array(film["points"])).gap
    assert np.nanmin(gaps) > -1e-3, "the way lies in free space and on its walls, to the digits drawn"


def test_a_start_in_a_corner_is_left_by_a_hair():
    mechanism = ms.load(ROOT / "examples" / "ratchet" / "ratchet.padl").compile()
    space = ms.configuration_space(mechanism, "wheel", "pawl")
    # On which side of the corner the start lies is left to rounding.
    assert abs(space.gap([space.start]).gap[0]) < 1e-9
    film = push(space)
    assert film["end"] == "arrived"
    assert film["points"][0] == pytest.approx(space.start, abs=0.05)
    assert film["points"][-1][0] == pytest.approx(-2 * math.pi, abs=0.05)


def test_the_page_is_reached_by_keyboard_and_told_in_words(page):
    assert 'tabindex="0"' in page
    assert 'aria-live="polite"' in page
    assert "ewheel corner (−3.2, 5.4)" in page
