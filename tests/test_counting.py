"""What is counted is told in its right number, and one thing by one number."""

import re

import mainspring as ms
from conftest import ROOT, command_line
from mainspring.counting import impacts, minima, number_of
from mainspring.report import page

RATCHET = ROOT / "examples" / "ratchet"
ROCKER = ROOT / "examples" / "rotary-to-reciprocating" / "rotary-to-reciprocating.padl"


def test_singular_and_plural():
    assert [number_of(n, "step") for n in (0, 1, 2)] == ["0 steps", "1 step", "2 steps"]
    assert minima(1) == "1 minimum of kinetic energy"
    assert minima(2, "prominent_minima") == "2 prominent minima of kinetic energy"
    assert minima(1, "whole_turns") == "1 whole turn"
    assert impacts(1, 1) == "1 impact"
    assert impacts(2, 3) == "2 impacts (at 3 contacts)"


def test_impacts_are_told_by_one_number(tmp_path):
    model, blocked = str(RATCHET / "ratchet.padl"), str(RATCHET / "blocked.sup")
    done = command_line("simulate", model, "--supplement", blocked, "--until", "2", cwd=tmp_path)
    told = {int(n) for n in re.findall(r"(\d+) impacts|impacts (\d+)", done.stdout) for n in n if n}
    run = ms.simulate(ms.load(model, blocked).compile(), 2.0)
    assert told == {run.stats["impacts"]}
    assert f"at {sum(e.kind == 'impact' for e in run.events)} contacts" in done.stdout


def test_what_is_shown_to_hold_is_what_repeats(tmp_path):
    weak = tmp_path / "weak.sup"
    weak.write_text("< WHEEL : FRAME > 60 60 SPRING 10000 1\n< ARM : FRAME > 100 10\n", encoding="utf-8")
    resting = ms.predict(ms.load(ROCKER, weak).compile())
    assert resting.status == "comes_to_rest"
    assert all(h.fell is not None and h.why for h in resting.hypotheses)
    ticking = ms.predict(ms.load(ROOT / "examples" / "escapement" / "escapement.padl").compile())
    assert [h.fell is None for h in ticking.hypotheses] == [False] * (len(ticking.hypotheses) - 1) + [True]


def test_a_driven_machine_has_a_plot_that_shows_something(tmp_path):
    driven = tmp_path / "driven.sup"
    driven.write_text("< WHEEL : FRAME > 60 60\n< ARM : FRAME > 100 10\nSPEED wheel 90\n", encoding="utf-8")
    mechanism = ms.load(ROCKER, driven).compile()
    assert "of its largest" in page(mechanism, ms.simulate(mechanism, 8.0))
    alone = tmp_path / "alone.padl"
    alone.write_text(
        "generic m(m)\na = blo(x=6) at (movx=-3, movy=-0.5) dif cyl()\n"
        "f = cyl(h=3) at (movz=-1)\nattr f : frame = 1\nm = a asb f\n",
        encoding="utf-8",
    )
    driven.write_text("< A : FRAME > 2 0\nSPEED a 90\n", encoding="utf-8")
    mechanism = ms.load(alone, driven).compile()
    assert "<small>constant</small>" in page(mechanism, ms.simulate(mechanism, 8.0))
