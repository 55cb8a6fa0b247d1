"""Bad input and usage: exit code 2, one line on standard error, nothing on standard output, no file."""

import re

import pytest

from conftest import ESCAPEMENT

BAD_USAGE = [
    (),
    ("fly",),
    ("simulate", ESCAPEMENT),
    ("simulate", ESCAPEMENT, "--until", "0"),
    ("simulate", ESCAPEMENT, "--until", "nan"),
    ("simulate", ESCAPEMENT, "--until", "1_0"),
    ("simulate", ESCAPEMENT, "--until", "1e999"),
    ("simulate", ESCAPEMENT, "--until", "9" * 100_000),
    ("simulate", ESCAPEMENT, "--until", "1", "--contact", "soft"),
    ("simulate", ESCAPEMENT, "--until", "1", "--csv"),
    ("simulate", ESCAPEMENT, "--until", "1", "--rtol", "-1"),
    ("simulate", ESCAPEMENT, "--until", "1", "--rtol", "1e-20"),
    ("simulate", ESCAPEMENT, "--until", "1", "--rtol", "0.5"),
    ("simulate", ESCAPEMENT, "--until", "1", "--keep-axial"),
    ("simulate", ESCAPEMENT, "--until", "1", "--position", "lever=4"),
    ("simulate", ESCAPEMENT, "--until", "1", "--position", "lever=4deg/s"),
    ("simulate", ESCAPEMENT, "--until", "1", "--velocity", "lever=4deg"),
    ("simulate", ESCAPEMENT, "--until", "1", "--position", "frame=4deg"),
    ("simulate", ESCAPEMENT, "--until", "1", "--position", "pawl=4deg"),
    ("simulate", ESCAPEMENT, "--until", "1", "--position", "lever=1deg", "--position", "LEVER=2deg"),
    ("inspect", ESCAPEMENT, "--set", "gap"),
    ("inspect", ESCAPEMENT, "--set", "gap=36", "--set", "GAP=36"),
    ("inspect", ESCAPEMENT, "--pair-clearance", "-1"),
    ("inspect", ESCAPEMENT, "--sv", "x.svg"),
    ("predict", ESCAPEMENT, "--confirm", "0"),
    ("predict", ESCAPEMENT, "--confirm", "two"),
    ("predict", ESCAPEMENT, "--range-fraction", "0"),
    ("predict", ESCAPEMENT, "--time-match", "2"),
    ("examples", "carriage", "x"),
    ("examples", "escapement"),
    ("cite", ESCAPEMENT),
]


def _refused(done, tmp_path):
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1, done.stderr
    assert "Traceback" not in done.stderr
    assert "error: " in done.stderr
    by_the_parser = "--help)" in done.stderr
    assert by_the_parser or "; expected " in done.stderr, done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("arguments", BAD_USAGE, ids=lambda a: " ".join(map(str, a[2:]))[:40] or str(a[:1]))
def test_bad_usage_is_one_clear_line(cli, tmp_path, arguments):
    _refused(cli(*arguments), tmp_path)


@pytest.mark.parametrize("setting", ["gap=99", "tooth_count=3", "gap=29.999"])
def test_bad_parameters_name_the_file(cli, tmp_path, setting):
    done = cli("inspect", ESCAPEMENT, "--set", setting)
    _refused(done, tmp_path)
    assert setting.split("=")[0] in done.stderr


BAD_TEXT = {
    "undefined": b"generic m(m)\nm = a asb b\n",
    "binary": bytes(range(256)),
    "empty": b"",
    "unclosed": b"generic m(a, b)\na = (blo(x=1)\n",
    "latin": "généric".encode("latin-1"),
    "number": b"generic m(m)\na = 1_0\n",
    "code": b"__import__('os').system('touch owned')\n",
}


@pytest.mark.parametrize("name", BAD_TEXT)
def test_bad_models_name_file_line_and_column(cli, tmp_path, name):
    model = tmp_path / "bad.padl"
    model.write_bytes(BAD_TEXT[name])
    done = cli("inspect", model, "--json", "--svg", "bad.svg")
    assert done.returncode == 2
    assert done.stdout == ""
    assert re.fullmatch(r".*bad\.padl:\d+:\d+: error: [^\n]+\n", done.stderr), done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["bad.padl"]


def test_a_missing_file_is_one_line(cli, tmp_path):
    done = cli("inspect", "nowhere.padl")
    _refused(done, tmp_path)
    assert done.stderr.startswith("nowhere.padl:")


def test_nothing_is_left_when_a_file_cannot_be_written(cli, tmp_path):
    (tmp_path / "wall").write_text("a file, no folder")
    done = cli("simulate", ESCAPEMENT, "--until", "1", "--out", "wall")
    assert done.returncode == 2
    assert done.stdout == ""
    assert re.fullmatch(r"wall/result\.json:1:1: error: [^\n]+; expected [^\n]+\n", done.stderr), done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["wall"]


def test_what_is_no_prism_is_named_and_nothing_else(cli, tmp_path):
    text = ESCAPEMENT.read_text()
    arm = "(blo(x=1,y=8) at (movx=-.5,movy=8))"
    assert arm in text
    (tmp_path / "cone.padl").write_text(text.replace(arm, "(con(d=1,h=8) at (degx=-90,movy=8,movz=0.5))"))
    (tmp_path / "cone.sup").write_text(ESCAPEMENT.with_suffix(".sup").read_text())
    done = cli("simulate", "cone.padl", "--until", "1")
    assert (done.returncode, done.stdout) == (2, "")
    assert re.fullmatch(
        r"cone\.padl:30:\d+: error: [^\n]*lever \(con\)[^\n]*; expected [^\n]+\n", done.stderr
    )
    seen = cli("inspect", "cone.padl")
    assert seen.returncode == 0
    warned = seen.stderr.splitlines()
    assert warned
    assert all(re.fullmatch(r"cone\.(padl|sup):\d+:\d+: warning: .+", line) for line in warned), warned


def test_examples_never_overwrites(cli, tmp_path):
    (tmp_path / "clock").mkdir()
    (tmp_path / "clock" / "mine.txt").write_text("mine")
    assert cli("examples", "escapement", "clock").returncode == 2
    assert [p.name for p in (tmp_path / "clock").iterdir()] == ["mine.txt"]
