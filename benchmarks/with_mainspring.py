"""Mainspring, called as a user calls it: one command, a fresh process for every run."""

import json
import subprocess
from pathlib import Path
from typing import Any

from scene import UNTIL

NAME = "mainspring"
RTOL = 1e-8
REFINED = 1e-12
ROOT = Path(__file__).resolve().parent.parent
PROGRAM = Path(".venv/bin/mainspring")
MODEL = Path("examples/escapement/escapement.padl")


def call(*arguments: str) -> str:
    """Return what the program prints; raises if it was not built or fails."""
    if not (ROOT / PROGRAM).exists():
        raise SystemExit(f"{PROGRAM} is missing: run `make build` first")
    command = [str(ROOT / PROGRAM), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout


def version() -> str:
    """Return the program's version."""
    return call("--version").split()[-1]


def simulate(rtol: float) -> tuple[list[float], float, dict[str, Any]]:
    """Return the kinetic-energy minima, the wall seconds of the integration alone, and the counts of work."""
    options = ("--until", f"{UNTIL:g}", "--rtol", f"{rtol:g}", "--json", "--timing")
    result = json.loads(call("simulate", str(MODEL), *options))
    stats = result["stats"]
    return result["kinetic_energy_minima"], stats["wall_seconds"], stats
