"""The whole run-down of the escapement: 277 teeth, until nothing will move again.

A step that ticks for 37 s may jam later. A peer starts at its largest robust step and takes a twentieth less
until the mainspring has run down; the steps that jammed are told.
"""

from dataclasses import dataclass
from math import degrees

import with_mainspring
from measure import mainspring_memory
from peers import Peer

LONG_ENOUGH = 10_000.0
RELAXED, ONE_TOOTH = -10_000.0, 36.0
TRIES = 12
RUNS = 3


@dataclass(frozen=True)
class RunDown:
    """Seconds of the fastest run, simulated seconds, the wheel's angle at the end in degrees."""

    engine: str
    step: float
    seconds: float
    until: float
    wheel: float
    jammed_at: tuple[float, ...] = ()
    memory: float | None = None

    @property
    def ran_down(self) -> bool:
        """Return whether the mainspring is relaxed to within one tooth."""
        return abs(self.wheel - RELAXED) < ONE_TOOTH


def mainspring(contact: str) -> RunDown:
    """Return Mainspring's run, which ends by itself when all is at rest."""
    run = with_mainspring.simulate(contact, until=LONG_ENOUGH, runs=RUNS)
    return RunDown(
        engine=f"{with_mainspring.NAME} {contact}",
        step=with_mainspring.RTOL[contact],
        seconds=min(run.walls),
        until=run.result["t"],
        wheel=degrees(run.result["positions"]["ewheel"]),
        memory=mainspring_memory(contact, LONG_ENOUGH),
    )


def peer(engine: Peer, dt: float, until: float) -> RunDown:
    """Return a peer's run over the same time, at the largest of the tried steps that runs down."""
    jammed: list[float] = []
    for _ in range(TRIES):
        wall, angle = engine.seconds(dt, until)
        found = RunDown(engine.name, dt, wall, until, degrees(angle), tuple(jammed))
        if found.ran_down:
            return found
        jammed.append(dt)
        dt *= 0.95
    return found
