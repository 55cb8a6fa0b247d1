"""Time the escapement of Gelsey 1995, Fig. 12: 37 simulated seconds on one thread.

Prints the median and the fastest of many runs, of the integration alone and of the whole call from Python,
and the counts of work, which are the same every time.
"""

import json
import statistics
import time
from pathlib import Path

import mainspring as ms

MODEL = Path(__file__).resolve().parent.parent / "examples" / "escapement" / "escapement.padl"
UNTIL = 37.0
RUNS = 101
TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)


def timed(mechanism: ms.Mechanism, rtol: float) -> tuple[float, float, dict[str, int]]:
    """Return seconds of the integration alone, of the whole call, and the counts of work."""
    start = time.perf_counter()
    run = ms.simulate(mechanism, UNTIL, rtol=rtol)
    whole = time.perf_counter() - start
    alone = json.loads(run.to_json(timing=True))["stats"]["wall_seconds"]
    return alone, whole, dict(run.stats)


def report(mechanism: ms.Mechanism, rtol: float) -> None:
    """Print one line for a tolerance."""
    runs = [timed(mechanism, rtol) for _ in range(RUNS)]
    alone, whole = ([r[k] * 1e3 for r in runs] for k in (0, 1))
    stats = runs[-1][2]
    print(
        f"{rtol:8.0e} {statistics.median(alone):10.3f} {min(alone):9.3f} {statistics.median(whole):9.3f} "
        f"{stats['steps']:8d} {stats['gap_evaluations']:10d} {stats['impacts']:8d}"
    )


def main() -> None:
    """Print the table."""
    mechanism = ms.load(MODEL).compile()
    print(f"{UNTIL:g} s of the escapement, {RUNS} runs on one thread, times in ms")
    print("    rtol     median   fastest  from Py    steps  gap evals  impacts")
    for rtol in TOLERANCES:
        report(mechanism, rtol)


if __name__ == "__main__":
    main()
