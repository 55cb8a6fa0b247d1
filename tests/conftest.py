"""What the tests share: the shipped escapement, run once, and the command line in a process of its own."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import mainspring as ms

ROOT = Path(__file__).resolve().parent.parent
ESCAPEMENT = ROOT / "examples" / "escapement" / "escapement.padl"

# The shipped machines.
MODELS = sorted(p for p in (ROOT / "examples").glob("*/*.*") if p.suffix in (".padl", ".toml"))
MODELS = [p for p in MODELS if p.stem == p.parent.name]

Run = Callable[..., subprocess.CompletedProcess[str]]


def command_line(*arguments: object, cwd: Path | None = None, **environment: str):
    """Run `mainspring` with these arguments and return what it did."""
    return subprocess.run(
        [sys.executable, "-m", "mainspring", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=cwd,
        env={**os.environ, **environment},
        timeout=300,
        check=False,
    )


@pytest.fixture(name="cli")
def _cli(tmp_path: Path):
    return lambda *arguments, **environment: command_line(*arguments, cwd=tmp_path, **environment)


@pytest.fixture(scope="session")
def mechanism() -> ms.Mechanism:
    return ms.load(ESCAPEMENT).compile()


@pytest.fixture(scope="session")
def prediction(mechanism: ms.Mechanism) -> ms.Prediction:
    return ms.predict(mechanism)


@pytest.fixture(scope="session")
def simulation(mechanism: ms.Mechanism) -> ms.Simulation:
    return ms.simulate(mechanism, 37.0)


@pytest.fixture(scope="session")
def inspected(mechanism: ms.Mechanism) -> dict:
    return json.loads(ms.find_pairs(mechanism).to_json())
