"""Every shipped machine reproduces the numbers beside it, each with its source."""

import json
import tomllib

import pytest

import mainspring as ms
from conftest import ROOT


def _name(folder, case) -> str:
    told = (folder.name, case.get("supplement"), case["command"], ".".join(map(str, case["path"])))
    said = (*told, *(f"{k}={v}" for k, v in case.get("set", {}).items()), case.get("until"))
    return "-".join(str(s) for s in said if s is not None)


FOLDERS = sorted(p.parent for p in (ROOT / "examples").glob("*/expected.toml"))
EXPECTED = [
    pytest.param(folder, case, id=_name(folder, case))
    for folder in FOLDERS
    for case in tomllib.loads((folder / "expected.toml").read_text(encoding="utf-8"))["expect"]
]
_answers: dict[tuple, dict] = {}


def _model(folder):
    native = folder / f"{folder.name}.toml"
    return native if native.exists() else folder / f"{folder.name}.padl"


def _answer(folder, case) -> dict:
    changed = case.get("set", {})
    key = (folder.name, case.get("supplement"), case["command"], case.get("until"), *changed.items())
    key += (*case.get("parts", ()), *case.get("slice", {}).items())
    if key not in _answers:
        supplement = folder / case["supplement"] if "supplement" in case else None
        mechanism = ms.load(_model(folder), supplement).compile(changed)
        made = {
            "inspect": lambda: ms.find_pairs(mechanism),
            "simulate": lambda: ms.simulate(mechanism, case["until"]),
            "predict": lambda: ms.predict(mechanism),
            "cspace": lambda: ms.configuration_space(mechanism, *case["parts"]),
        }[case["command"]]()
        _answers[key] = json.loads(made.to_json())
        if "slice" in case:
            _answers[key]["slices"] = [i._asdict() for i in made.slice(case["slice"])]
    return _answers[key]


@pytest.mark.parametrize(("folder", "case"), EXPECTED)
def test_expected(folder, case):
    found = _answer(folder, case)
    for step in case["path"]:
        found = found[step]
    assert case["source"]
    if "length" in case:
        assert len(found) == case["length"]
    elif "tolerance" in case:
        assert found == pytest.approx(case["value"], abs=case["tolerance"])
    else:
        assert found == case["value"]


def test_every_machine_says_what_it_is_and_must_do():
    for folder in sorted(p for p in (ROOT / "examples").iterdir() if p.is_dir()):
        assert (folder / "README.md").read_text(encoding="utf-8").startswith("# ")
        assert folder in FOLDERS
        assert (folder / f"{folder.name}.svg").exists()
