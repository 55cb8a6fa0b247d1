"""One row of the table: how long an engine took, and how far its period is from its own limit."""

import statistics
from dataclasses import dataclass
from types import ModuleType

import numpy as np

import with_mainspring
from motion import period, reversals, ticks

RUNS = 31


@dataclass(frozen=True)
class Row:
    """Times in seconds; `step` is the time step, or the tolerance where the engine chooses its steps."""

    engine: str
    version: str
    setting: str
    step: float
    steps: int
    gap_evaluations: int | None
    median: float
    fastest: float
    period: float
    limit: float

    @property
    def error(self) -> float:
        """Return the relative error of the period against the engine's own refined limit."""
        return abs(self.period / self.limit - 1)


def robust_step(engine: ModuleType) -> float:
    """Return the largest step below which every tested step ticks; success is not monotone in the step."""
    best = 0.0
    for dt in engine.STEPS:
        if not ticks(engine.simulate(dt)[0]):
            break
        best = dt
    if best == 0.0:
        raise SystemExit(f"{engine.NAME} does not tick at its smallest step")
    return best


def stepped(engine: ModuleType) -> Row:
    """Return the row of an engine with a fixed step."""
    dt = robust_step(engine)
    runs = [engine.simulate(dt) for _ in range(RUNS)]
    walls = [wall for _, wall, _ in runs]
    return Row(
        engine=engine.NAME,
        version=engine.version(),
        setting=engine.SETTING,
        step=dt,
        steps=runs[0][2],
        gap_evaluations=None,
        median=statistics.median(walls),
        fastest=min(walls),
        period=period(reversals(runs[0][0])),
        limit=period(reversals(engine.simulate(engine.REFINED)[0])),
    )


def mainspring() -> Row:
    """Return Mainspring's row."""
    runs = [with_mainspring.simulate(with_mainspring.RTOL) for _ in range(RUNS)]
    walls = [wall for _, wall, _ in runs]
    minima, _, stats = runs[0]
    refined = with_mainspring.simulate(with_mainspring.REFINED)[0]
    return Row(
        engine=with_mainspring.NAME,
        version=with_mainspring.version(),
        setting="rtol, rigid contact",
        step=with_mainspring.RTOL,
        steps=stats["steps"],
        gap_evaluations=stats["gap_evaluations"],
        median=statistics.median(walls),
        fastest=min(walls),
        period=period(np.array(minima)),
        limit=period(np.array(refined)),
    )
