"""What README and results say was measured is one measurement."""

import json
import re
from xml.etree import ElementTree

import pytest

from conftest import ROOT

FOLDER = ROOT / "benchmarks" / "results"
MEASURED = json.loads((FOLDER / "results.json").read_text(encoding="utf-8"))
QUOTE = re.compile(r"<!-- begin: make bench -->\n(.*?)<!-- end: make bench -->", re.DOTALL)


def _quoted() -> list[list[str]]:
    block = QUOTE.search((ROOT / "README.md").read_text(encoding="utf-8"))
    lines = block[1].strip().splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_readme_quotes_the_results():
    peer = min(r["fastest"] for r in MEASURED["escapement"] if r["contact"] == "soft")
    rows = MEASURED["escapement"]
    assert [line[2:] for line in _quoted()] == [
        [f"{r['fastest'] * 1e3:.3g} ms", f"{peer / r['fastest']:.2g} ×", f"{r['error']:.0e} s"] for r in rows
    ]


def test_every_engine_is_measured_against_its_own_limit():
    engines = {r["engine"] for r in MEASURED["escapement"]}
    assert engines == {"mainspring", "mujoco", "pymunk"}
    for row in MEASURED["escapement"]:
        assert row["error"] == pytest.approx(abs(row["period"] - row["limit"]))
        assert row["steps"] > 0
        assert row["memory"] > 0
        assert min(row["walls"]) == row["fastest"]


def test_the_peers_tick_like_the_machine():
    limits = [r["limit"] for r in MEASURED["escapement"]]
    assert max(limits) - min(limits) < 1e-3 * min(limits)
    assert all(r["ran_down"] for r in MEASURED["run_down"])


def test_the_picture_names_every_engine():
    words = "".join(ElementTree.parse(FOLDER / "escapement.svg").getroot().itertext())
    assert all(r["engine"] in words for r in MEASURED["escapement"])
