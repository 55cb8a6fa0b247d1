"""`mainspring examples`: the machines that come with the program."""

import json
import shutil
import tempfile
from argparse import Namespace
from pathlib import Path

from mainspring.cli import output, tables
from mainspring.cli.faults import Usage
from mainspring.cli.values import shortened

_ROOT = Path(__file__).resolve().parent.parent / "examples"


def run(options: Namespace) -> None:
    """List the machines, or copy one out."""
    if options.name is None:
        _list(options.json)
        return
    if options.directory is None:
        raise Usage(
            f"no folder to copy to; expected one that is new, as in: mainspring examples {options.name} DIR"
        )
    files = copy(options.name, Path(options.directory))
    if options.json:
        answer = {"example": options.name, "directory": options.directory, "files": files}
        output.print_json(json.dumps(answer, ensure_ascii=False))
    else:
        print(f"{options.name} is in {options.directory}: {', '.join(files)}")


def names() -> list[str]:
    """Return the names of the shipped machines, sorted."""
    return sorted(p.name for p in _ROOT.iterdir() if (p / f"{p.name}.toml").exists() or any(p.glob("*.padl")))


def folder(name: str) -> Path:
    """Return the folder of a shipped machine."""
    if name not in names():
        raise Usage(f"no example {shortened(name)}; expected one of: {', '.join(names())}")
    return _ROOT / name


def _title(name: str) -> str:
    readme = folder(name) / "README.md"
    first = readme.read_text(encoding="utf-8").splitlines()[:1] if readme.exists() else []
    return first[0].lstrip("# ") if first else ""


def _files(where: Path) -> list[str]:
    return sorted(str(p.relative_to(where)) for p in where.rglob("*") if p.is_file())


def _list(as_json: bool) -> None:
    if as_json:
        found = [{"name": n, "title": _title(n), "files": _files(folder(n))} for n in names()]
        output.print_json(json.dumps({"examples": found}, ensure_ascii=False))
        return
    print("Copy one out with: mainspring examples NAME DIR")
    tables.show("machines", ("name", "what it is"), ((n, _title(n)) for n in names()))


def copy(name: str, target: Path) -> list[str]:
    """Copy a machine into a new folder, whole or not at all; return the files' names."""
    source = folder(name)
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise Usage(f"{target}: is there already; expected a new or empty folder")
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=target.parent, prefix=f".{target.name}.") as scratch:
        made = Path(scratch) / "copy"
        shutil.copytree(source, made)
        made.replace(target)
    return _files(target)
