"""Compliant contact: beside rigid contact on every shipped machine, and what `both` says of the two."""

import json
import re

import numpy as np
import pytest

import mainspring as ms
from conftest import ESCAPEMENT, ROOT
from mainspring.report import page
from test_report import _Balance

DRAWN = (
    "cam-flat-follower",
    "cam-roller-follower",
    "cam-swinging-follower",
    "detent",
    "eccentric-discs",
    "geneva-four",
    "geneva-six",
    "involute-gears",
    "pin-in-slot",
    "ratchet-and-pawl",
    "scotch-yoke",
)
SHIPPED = [
    ("escapement/escapement.padl", None, 37.0),
    ("rotary-to-reciprocating/rotary-to-reciprocating.padl", None, 20.0),
    ("ratchet/ratchet.padl", None, 10.0),
    ("ratchet/ratchet.padl", "ratchet/blocked.sup", 100.0),
    ("pawl-on-plate/pawl-on-plate.padl", None, 20.0),
    ("pawl-on-plate/pawl-on-plate.padl", "pawl-on-plate/blocked.sup", 100.0),
    ("slide/slide.padl", None, 10.0),
    *((f"{name}/{name}.toml", None, 8.0) for name in DRAWN),
]


def _compiled(model: str, supplement: str | None) -> ms.Mechanism:
    examples = ROOT / "examples"
    return ms.load(examples / model, examples / supplement if supplement else None).compile()


def _escapement(tmp_path, wheel="200 20 SPRING -10000 20", balance="20 6 SPRING 90 15") -> ms.Mechanism:
    sup = tmp_path / "changed.sup"
    sup.write_text(f"< LEVER : FRAME > 10 5\n< BWHEEL : FRAME > {balance}\n< EWHEEL : FRAME > {wheel}\n")
    return ms.load(ESCAPEMENT, sup).compile()


@pytest.fixture(scope="module", name="both")
def _both(mechanism: ms.Mechanism) -> ms.Comparison[ms.Simulation]:
    return ms.simulate(mechanism, 37.0, contact="both")


@pytest.fixture(scope="module", name="predicted")
def _predicted(mechanism: ms.Mechanism) -> ms.Comparison[ms.Prediction]:
    return ms.predict(mechanism, contact="both")


@pytest.mark.parametrize(("model", "supplement", "until"), SHIPPED)
def test_every_shipped_machine_runs_and_accounts_for_its_energy(model, supplement, until):
    mechanism = _compiled(model, supplement)
    run = ms.simulate(mechanism, until, contact="compliant")
    rigid = ms.simulate(mechanism, until)
    assert run.status == rigid.status
    assert abs(run.energy.residual) < 1e-5
    assert abs(rigid.energy.residual) < 1e-7
    e = run.energy
    found = e.initial + e.work - e.final - e.contact_stored - e.friction - e.impacts
    assert found / max(e.friction + e.impacts, e.kinetic_max) == pytest.approx(e.residual, abs=1e-9)
    for part, q in run.positions.items():
        moved = np.ptp(rigid.trajectory.q[:, rigid.trajectory.parts.index(part)])
        assert q == pytest.approx(rigid.positions[part], abs=0.02 * moved + 2e-3), part


@pytest.mark.parametrize(("model", "supplement", "until"), SHIPPED)
def test_every_shipped_machine_is_predicted_alike(model, supplement, until):
    del until
    answer = ms.predict(_compiled(model, supplement), contact="both")
    assert answer.status == "agree", answer.sentences
    assert answer.rigid.status == answer.compliant.status
    assert answer.differences["same_outcome"] is True


@pytest.mark.parametrize(("constants", "allowed"), [(None, 1e-3), ((1e8, 1e7, 100.0), 1e-4)])
def test_the_period_is_near_that_of_rigid_contact(mechanism, simulation, constants, allowed):
    run = ms.simulate(mechanism, 37.0, contact="compliant", contact_constants=constants)
    tenth = run.kinetic_energy_minima[9]
    assert tenth == pytest.approx(simulation.kinetic_energy_minima[9], rel=allowed)
    fine = ms.simulate(mechanism, 37.0, contact="compliant", contact_constants=constants, rtol=1e-8)
    assert tenth == pytest.approx(fine.kinetic_energy_minima[9], abs=1e-4)
    assert run.contact == dict(zip("EDM", constants or (1e5, 1e4, 100.0), strict=True))


@pytest.mark.parametrize(
    "changed",
    [
        {"balance": "20 6 SPRING 90 25"},
        {"balance": "20 6 SPRING 90 50"},
        {"balance": "30 6 SPRING 90 15"},
        {"balance": "60 6 SPRING 90 15"},
        {"wheel": "200 20 SPRING -10000 6"},
        {"wheel": "200 20 SPRING -10000 30"},
    ],
)
def test_changed_machines_repeat_alike(tmp_path, changed):
    answer = ms.predict(_escapement(tmp_path, **changed), contact="both")
    assert answer.status == "agree"
    assert answer.rigid.status == "repeats"
    assert abs(answer.differences["duration"]["relative"]) < 5e-3
    assert answer.compliant.pattern.change["ewheel"]["position"] == pytest.approx(-np.pi / 5, abs=1e-3)


def test_near_the_edge_of_starting_the_models_part(tmp_path):
    mechanism = _escapement(tmp_path, balance="20 6 SPRING 90 10.65")
    answer = ms.predict(mechanism, contact="both", max_time=1000.0)
    assert (answer.rigid.status, answer.compliant.status) == ("comes_to_rest", "repeats")
    assert answer.status == "differ"
    assert "depends on how contact is modelled" in answer.sentences[0]
    assert answer.differences["rest"]["compliant"] is None
    run = ms.simulate(mechanism, 100.0, contact="both")
    assert run.status == "differ"
    assert run.differences["statuses"] == {"rigid": "at_rest", "compliant": "complete"}
    assert any(s["contact"] == "rigid" for s in run.differences["stalls"])
    assert any("stand still with rigid contact" in s or "stands still with rigid" in s for s in run.sentences)


def test_both_tells_where_and_by_how_much(both):
    assert both.status == "agree"
    assert both.rigid.contact is None
    assert both.compliant.energy.contact_stored > 0
    d = both.differences
    keys = ["same_outcome", "statuses", "until", "positions", "apart_from", "minima", "stalls", "constants"]
    assert list(d) == keys
    assert d["minima"]["compared"] == 10
    pairs = zip(both.rigid.kinetic_energy_minima, both.compliant.kinetic_energy_minima, strict=True)
    greatest = max((b - a for a, b in pairs), key=abs)
    assert d["minima"]["greatest"] == pytest.approx(greatest)
    wheel = d["positions"]["ewheel"]
    at = [r.trajectory.at(wheel["at"]).q[0] for r in (both.rigid, both.compliant)]
    assert at[1] - at[0] == pytest.approx(wheel["greatest"])
    told = (ROOT / "docs" / "guide" / "json.md").read_text(encoding="utf-8")
    assert [k for k in [*keys, "greatest", "contact_stored", "compared"] if f"`{k}`" not in told] == []


def test_keys_of_compliant_results(both, predicted):
    found = json.loads(both.to_json())
    assert list(found) == ["status", "rigid", "compliant", "differences", "sentences"]
    assert list(found["compliant"])[-2:] == ["contact", "stats"]
    account = ["initial", "final", "work", "friction", "impacts", "contact_stored", "kinetic_max", "residual"]
    assert list(found["compliant"]["energy"]) == account
    assert "contact" not in found["rigid"]
    differences = json.loads(predicted.to_json())["differences"]
    assert list(differences) == ["same_outcome", "statuses", "duration", "change", "rest", "constants"]
    assert list(differences["duration"]) == ["rigid", "compliant", "relative"]


def test_the_same_run_gives_the_same_bytes(mechanism):
    runs = [ms.simulate(mechanism, 8.0, contact="both").to_json() for _ in range(2)]
    assert runs[0] == runs[1]


def test_bytes_do_not_depend_on_the_hash_seed(cli):
    asked = ("predict", ESCAPEMENT, "--contact", "both", "--json")
    assert cli(*asked, PYTHONHASHSEED="1").stdout == cli(*asked, PYTHONHASHSEED="77").stdout


def test_a_result_cites_the_solver_it_rests_on(cli, tmp_path):
    for contact, cited in (("rigid", False), ("compliant", True), ("both", True)):
        done = cli("simulate", ESCAPEMENT, "--until", "1", "--contact", contact, "--json")
        (tmp_path / "r.json").write_text(done.stdout, encoding="utf-8")
        said = cli("cite", "r.json").stdout
        assert ("Steinebach" in said) is cited
        assert ("Moreau" in said) is (contact != "compliant")


def test_forces_are_those_of_the_law(mechanism):
    run = ms.simulate(mechanism, 3.0, contact="compliant", forces=True)
    pressed = [c for f in run.forces for c in f["contacts"] if c["force"] > 0]
    assert pressed
    at_rest = run.trajectory.contacts(1.0)
    assert {tuple(sorted(c["parts"])) for c in at_rest} == {("ewheel", "lever"), ("frame", "lever")}
    rigid = ms.simulate(mechanism, 3.0).trajectory.contacts(1.0)
    by_pair = {tuple(sorted(c["parts"])): c["force"] for c in rigid}
    for contact in at_rest:
        assert contact["force"] == pytest.approx(by_pair[tuple(sorted(contact["parts"]))], rel=5e-3)


def test_constants_come_from_the_supplement_or_the_option(tmp_path):
    sup = tmp_path / "soft.sup"
    text = (ROOT / "examples" / "slide" / "slide.sup").read_text(encoding="utf-8")
    sup.write_text(text + "\nCONTACT 5e4 2e3 50\n")
    mechanism = ms.load(ROOT / "examples" / "slide" / "slide.padl", sup).compile()
    assert dict(ms.simulate(mechanism, 1.0, contact="compliant").contact) == {"E": 5e4, "D": 2e3, "M": 50.0}
    stiff = ms.simulate(mechanism, 1.0, contact="compliant", contact_constants=(1e6, 0.0, 0.0))
    assert dict(stiff.contact) == {"E": 1e6, "D": 0.0, "M": 0.0}


@pytest.mark.parametrize(
    "constants", [(0.0, 1.0, 1.0), (1e5, -1.0, 1.0), (np.nan, 1.0, 1.0), (1e5, np.inf, 1.0)]
)
def test_constants_that_make_no_force_are_refused(mechanism, constants):
    with pytest.raises(ms.InputError, match=r"^--contact-constants:1:1: error: .*; expected "):
        ms.simulate(mechanism, 1.0, contact="compliant", contact_constants=constants)


def test_the_page_of_both_shows_both(mechanism, both, predicted):
    for result in (both, predicted):
        text = page(mechanism, result)
        parser = _Balance()
        parser.feed(text)
        assert (parser.wrong, parser.open) == ([], [])
        assert text.count('class="curve beside"') == 3
        assert "Where the models of contact differ" in text
        assert "with compliant contact" in text
        heading = re.search(r"<h1>(.*?)</h1>", text)
        assert re.sub(r"<[^>]+>", "", heading[1]) == result.sentences[0]
        assert len(text.encode()) < 2_000_000


def test_the_command_line_runs_either_and_both(cli, tmp_path):
    asked = ("simulate", ESCAPEMENT, "--until", "5")
    one = cli(*asked, "--contact", "compliant", "--contact-constants", "2e5,1e4,100", "--json")
    assert json.loads(one.stdout)["contact"] == {"E": 2e5, "D": 1e4, "M": 100.0}
    two = cli(*asked, "--contact", "both", "--json", "--timing", "--out", "run", "--csv")
    found = json.loads(two.stdout)
    assert found["compliant"]["stats"]["wall_seconds"] > 0
    written = sorted(p.name for p in (tmp_path / "run").iterdir())
    names = [f"trajectory-{m}.{e}" for m in ("compliant", "rigid") for e in ("csv", "npz")]
    assert written == ["result.json", *names]
    said = cli(*asked, "--contact", "both").stdout
    assert "the models agree" in said
    assert "stored in contacts" in said
    assert "with compliant contact" in cli("predict", ESCAPEMENT, "--contact", "both").stdout


@pytest.mark.parametrize("told", ["1e5,1e4", "1e5,1e4,x", "1,2,3,4", "-1,0,0"])
def test_constants_on_the_command_line_are_checked(cli, told):
    done = cli(
        "simulate", ESCAPEMENT, "--until", "1", "--contact", "compliant", f"--contact-constants={told}"
    )
    assert done.returncode == 2
    assert done.stdout == ""
    assert "--contact-constants" in done.stderr
    assert done.stderr.count("\n") == 1
