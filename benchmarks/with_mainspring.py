"""Mainspring in its own environment: repeated runs in one process, as the peers are run."""

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motion import period
from scene import UNTIL

NAME = "mainspring"
# The tolerances that each model of contact has by default.
RTOL = {"rigid": 1e-8, "compliant": 1.5e-6}
# The tolerances of the picture, and the two that the limit and its doubt are taken from.
RTOLS = {
    "rigid": (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11),
    "compliant": (1e-4, 3e-5, 1.5e-6, 1e-6, 1e-7, 1e-8, 1e-9),
}
REFINED = {"rigid": (1e-13, 1e-12), "compliant": (1e-11, 1e-10)}
ROOT = Path(__file__).resolve().parent.parent
PROGRAM = Path(".venv/bin/mainspring")
PYTHON = ROOT / ".venv/bin/python"
ESCAPEMENT = "examples/escapement/escapement.padl"


@dataclass(frozen=True)
class Runs:
    """Repeated runs of one setting: seconds of the integration alone, and the result, the same every time."""

    walls: list[float]
    result: dict[str, Any]

    @property
    def period(self) -> float:
        """Return the mean duration of a pattern, told by the kinetic-energy minima."""
        return period(np.array(self.result["kinetic_energy_minima"]))


def version() -> str:
    """Return the program's version."""
    if not (ROOT / PROGRAM).exists():
        raise SystemExit(f"{PROGRAM} is missing: run `make build` first")
    return call(str(ROOT / PROGRAM), "--version").split()[-1]


def call(*command: str) -> str:
    """Return what a command prints; ends the run with what it said if it fails."""
    done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command[1:])}:\n{done.stderr.strip()}")
    return done.stdout


def has(contact: str) -> bool:
    """Return whether the program knows a contact model."""
    return contact in call(str(ROOT / PROGRAM), "simulate", "--help")


def simulate(
    contact: str,
    rtol: float | None = None,
    until: float = UNTIL,
    runs: int = 1,
    model: str = ESCAPEMENT,
    supplement: str | None = None,
) -> Runs:
    """Run a machine several times in a fresh process."""
    rtol = RTOL[contact] if rtol is None else rtol
    wanted = (f"--contact={contact}", f"--rtol={rtol!r}", f"--until={until!r}", f"--runs={runs}")
    more = () if supplement is None else (f"--supplement={supplement}",)
    answer = json.loads(call(str(PYTHON), "benchmarks/repeat.py", model, *wanted, *more))
    return Runs(answer["walls"], answer["result"])
