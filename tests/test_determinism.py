"""Same input, same bytes: for any hash seed, in any order."""

import pytest

from conftest import ESCAPEMENT, command_line


@pytest.mark.parametrize(
    "arguments",
    [
        ("inspect",),
        ("cspace", "ewheel", "lever", "--svg", "s.svg", "--html", "s.html", "--slice", "lever=3deg"),
        ("simulate", "--until", "20", "--out", "run", "--csv"),
        ("predict", "--report", "r.html"),
    ],
    ids=["inspect", "cspace", "simulate", "predict"],
)
def test_bytes_do_not_depend_on_the_hash_seed(tmp_path, arguments):
    made = []
    for seed in ("0", "4711"):
        folder = tmp_path / seed
        folder.mkdir()
        options = (arguments[0], ESCAPEMENT, *arguments[1:], "--json")
        done = command_line(*options, cwd=folder, PYTHONHASHSEED=seed)
        assert done.returncode == 0, done.stderr
        files = {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}
        made.append((done.stdout, files))
    assert made[0] == made[1]
