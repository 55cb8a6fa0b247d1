"""Files appear whole or not at all; standard output carries one thing."""

import contextlib
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import IO

from mainspring.cli.faults import Unwritable


def write_file(path: Path, content: Callable[[IO[bytes]], object]) -> None:
    """Write a file under a temporary name beside its place, then rename it into place."""
    try:
        _write(path, content)
    except OSError as fault:
        raise Unwritable(path, fault) from fault


def _write(path: Path, content: Callable[[IO[bytes]], object]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    number, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    temporary = Path(name)
    try:
        with os.fdopen(number, "wb") as stream:
            content(stream)
        temporary.chmod(0o644)
        temporary.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise


def write_text(path: Path, text: str) -> None:
    """Write a text file whole or not at all."""
    write_file(path, lambda stream: stream.write(text.encode()))


def print_json(text: str) -> None:
    """Print one JSON object."""
    sys.stdout.write(text.rstrip("\n") + "\n")
