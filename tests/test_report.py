"""The page: self-contained, small, safe, and true to the result."""

import html.parser
import json
import math
import re

import pytest

import mainspring as ms
from mainspring.report import motion_picture, page


@pytest.fixture(scope="module", name="text")
def _text(mechanism: ms.Mechanism, prediction: ms.Prediction) -> str:
    return page(mechanism, prediction)


def _film(text: str) -> dict:
    found = re.search(r'<script type="application/json" id="film">(.*?)</script>', text, re.DOTALL)
    assert found
    return json.loads(found[1])


def test_it_needs_no_network(text):
    assert "http" not in text
    assert not re.search(r"(?:src|href)=|@import|url\(|fetch\(|XMLHttp|import\(", text)


def test_it_stays_below_two_megabytes(text):
    assert len(text.encode()) < 2_000_000


class _Balance(html.parser.HTMLParser):
    """Notes elements that are closed in the wrong order."""

    void = frozenset({"meta", "input", "br"})

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.wrong: list[str] = []

    def handle_starttag(self, tag, _attrs):
        if tag not in self.void:
            self.open.append(tag)

    def handle_startendtag(self, _tag, _attrs):
        pass

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


def test_its_elements_are_balanced(text):
    parser = _Balance()
    parser.feed(text)
    assert parser.wrong == []
    assert parser.open == []


def test_the_film_shows_the_motion(text, prediction):
    film = _film(text)
    motion = prediction.simulation.trajectory
    assert film["parts"] == list(motion.parts)
    t, q = film["t"], film["q"]
    assert t == sorted(t)
    assert t[0] == 0.0
    middle = len(t) // 2
    assert [column[middle] for column in q] == pytest.approx(motion.at(t[middle]).q.tolist(), abs=2e-4)
    a, b = film["loop"]
    assert b - a == pytest.approx(prediction.pattern.duration)


def test_what_touches_is_lit(text):
    film = _film(text)
    marks = re.findall(r'data-mark="(\d+)"', text)
    used = {m for moment in film["touch"] for contact in moment for m in contact[0]}
    assert used == set(map(int, marks))
    assert len(film["touch"]) == len(film["t"])


def test_the_sentence_stands_above_the_picture(text, prediction):
    heading = re.search(r"<h1>(.*?)</h1>", text)
    assert heading
    assert re.sub(r"<[^>]+>", "", heading[1]) == prediction.sentences[0]
    assert text.index("<h1>") < text.index('class="machine"')


def test_pictures_have_words(text):
    assert text.count('role="img"><title>') == text.count('role="img"') - text.count('role="img" style')
    assert "turns about" in text


def test_the_motion_picture_is_a_file_of_its_own(mechanism, prediction):
    drawn = motion_picture(mechanism, prediction)
    assert drawn.count('class="curve"') == 4
    assert drawn.count('class="dot"') == len(prediction.simulation.kinetic_energy_minima)
    assert "nan" not in drawn


def test_a_plain_run_has_a_page_too(mechanism, simulation):
    text = page(mechanism, simulation)
    assert _film(text)["loop"] is None
    assert "one pattern" not in re.sub(
        r"<script>.*?</script>|<p class=\"hint\">.*?</p>", "", text, flags=re.S
    )
    assert f"{math.floor(simulation.t)}" in text
