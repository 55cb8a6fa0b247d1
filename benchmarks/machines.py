"""The shipped machines of Gelsey 1995, Fig. 22: steps and time with both models beside the paper's.

The paper's times are of a Sparcstation 10, its shapes and forces are known for the escapement only: the
figures tell how many steps each model takes for motion of the same kind, not how fast a program is.
"""

from dataclasses import dataclass

import with_mainspring

RUNS = 15
ROCKER = "examples/rotary-to-reciprocating/rotary-to-reciprocating.padl"
RATCHET = "examples/ratchet/ratchet.padl"
BLOCKED = "examples/ratchet/blocked.sup"


@dataclass(frozen=True)
class Paper:
    """Steps, seconds and simulated seconds of one row of Fig. 22."""

    steps: int
    seconds: float
    until: float


@dataclass(frozen=True)
class Machine:
    """A shipped machine and the paper's rows, by our name of the contact model."""

    name: str
    model: str
    supplement: str | None
    until: float
    paper: dict[str, Paper]


MACHINES = (
    Machine(
        "escapement",
        with_mainspring.ESCAPEMENT,
        None,
        37.0,
        {"rigid": Paper(836, 1.3, 37), "compliant": Paper(3942, 49.2, 37)},
    ),
    Machine(
        "rotary to reciprocating",
        ROCKER,
        None,
        20.0,
        {"rigid": Paper(333, 0.176, 20), "compliant": Paper(2119, 2.5, 20)},
    ),
    Machine(
        "ratchet, clockwise",
        RATCHET,
        None,
        10.0,
        {"rigid": Paper(65, 0.086, 1.9), "compliant": Paper(594, 0.82, 10)},
    ),
    Machine(
        "ratchet, counterclockwise",
        RATCHET,
        BLOCKED,
        100.0,
        {"rigid": Paper(1089, 1.3, 100), "compliant": Paper(7928, 16.7, 100)},
    ),
)


@dataclass(frozen=True)
class Found:
    """One machine with one model: simulated seconds until the end or rest, work, seconds of the fastest."""

    name: str
    contact: str
    status: str
    until: float
    steps: int
    seconds: float
    residual: float
    paper: Paper


def measured(machine: Machine, contact: str) -> Found:
    """Run a machine with a model."""
    run = with_mainspring.simulate(
        contact, until=machine.until, runs=RUNS, model=machine.model, supplement=machine.supplement
    )
    result = run.result
    return Found(
        machine.name,
        contact,
        result["status"],
        result["t"],
        result["stats"]["steps"],
        min(run.walls),
        result["energy"]["residual"],
        machine.paper[contact],
    )
