"""Measure Mainspring beside MuJoCo and pymunk, on one thread, in one run; print, and write results/.

Needs both contact models; `--contact rigid` measures one alone.
"""

import argparse
import json
import os
import platform
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np

import machines
import measure
import page
import peers
import picture
import rundown
import with_mainspring
from scene import UNTIL

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results"
README = HERE.parent / "README.md"
QUOTE = re.compile(r"(<!-- begin: make bench -->\n).*?(<!-- end: make bench -->)", re.DOTALL)
NOTES = f"""\
**Peers** run at the largest step below which every tested step ticks over {UNTIL:g} s (from 0.5 ms by
quarters of a millisecond, from 4 ms by tenths, from 5 ms by fiftieths), one tooth for each two swings.
They are told which pieces can touch, Mainspring is not. MuJoCo: hinges with springs and dampers, centre
of mass a little off the hinge with the same inertia about it, `solref` of four steps, spheres for pin
and posts. pymunk: pivots, damped rotary springs, no friction, the faster of 10 and 50 iterations.

**Times** are of each engine's own stepping: MuJoCo's rollout in C, pymunk's `step` in a loop,
Mainspring's integration. All engines are timed in {measure.ROUNDS} rounds, so that other work on the
machine disturbs all alike; speeds compare the fastest runs.

**Errors** are distances of the period (mean of three patterns, from the third reversal to the ninth)
from the engine's own limit, because contacts differ: soft in the peers, rigid or compliant in
Mainspring. The limit is the period at the finest step or tolerance (MuJoCo 25 µs, pymunk 50 µs,
Mainspring 1e-13 rigid, 1e-11 compliant), its doubt the distance from that at twice the step or ten
times the tolerance.

**Memory** is the largest resident size of a fresh process, Python and all libraries included.

**The paper's** figures are of Gelsey 1995, Fig. 22, on a Sparcstation 10; shapes and forces of all but
the escapement are ours."""


def arguments() -> argparse.Namespace:
    """Return what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--contact", choices=("rigid", "both"), default="both")
    return parser.parse_args()


def processor() -> str:
    """Return the processor's model, as Linux tells it, else as Python does."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def load() -> float:
    """Return how many processes wanted to run during the last minute."""
    return round(os.getloadavg()[0], 1)


def place() -> dict[str, str | int | float | None]:
    """Return what the times depend on; no name of the host."""
    return {
        "processor": processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numpy": np.__version__,
        "load before": load(),
    }


def models(wanted: str) -> list[str]:
    """Return the contact models to measure; ends the run if the program lacks one."""
    found = ["rigid"] if wanted == "rigid" else ["rigid", "compliant"]
    for contact in found:
        if not with_mainspring.has(contact):
            raise SystemExit(
                f"this mainspring has no {contact} contact (`mainspring simulate --help` does not list it); "
                "`--contact rigid` measures the other alone"
            )
    return found


def quote(text: str) -> None:
    """Put the short table into the README, between its marks."""
    old = README.read_text(encoding="utf-8")
    if not QUOTE.search(old):
        raise SystemExit(f"{README.name} has no place for the results")
    README.write_text(QUOTE.sub(lambda m: f"{m[1]}{text}\n{m[2]}", old), encoding="utf-8")


def main() -> None:
    """Measure, print, write."""
    wanted = models(arguments().contact)
    where = place()
    print(f"load before: {where['load before']} on {where['cores']} cores")
    chosen = peers.chosen()
    engines = [engine for engine, _ in chosen]
    rows = [measure.mainspring(c) for c in wanted] + [measure.peer(*c) for c in chosen]
    measure.clock(rows, engines)
    for row in rows[: len(wanted)]:
        measure.mainspring_curve(row)
    for row, engine in zip(rows[len(wanted) :], engines, strict=True):
        measure.peer_curve(row, engine)
    downs = [rundown.mainspring(c) for c in wanted]
    downs += [rundown.peer(*c, downs[0].until) for c in chosen]
    others = [machines.measured(m, c) for m in machines.MACHINES for c in wanted]
    where["load after"] = load()
    write(rows, downs, others, where)


def write(
    rows: list[measure.Row],
    downs: list[rundown.RunDown],
    others: list[machines.Found],
    where: dict[str, str | int | float | None],
) -> None:
    """Print the page; write it, the numbers and the picture; quote the short table."""
    claims = page.claims(rows, downs)
    about = ", ".join(f"{key} {value}" for key, value in where.items())
    text = "\n\n".join(
        [
            "# Measured in one run",
            f"{about}.",
            f"## {UNTIL:g} s of the escapement",
            page.escapement(rows),
            "![Error of the period against time](escapement.svg)",
            f"## The whole run-down, {downs[0].until:.0f} s",
            page.run_downs(downs),
            "## Machines of Gelsey 1995, Fig. 22",
            page.machines(others),
            "## What must hold",
            page.claims_table(claims),
            "## How",
            NOTES,
        ]
    )
    data = {
        "until": UNTIL,
        "machine": where,
        "escapement": [
            asdict(r) | {"error": r.error, "fastest": r.fastest, "median": r.median} for r in rows
        ],
        "run_down": [asdict(r) | {"ran_down": r.ran_down} for r in downs],
        "machines": [asdict(f) for f in others],
        "claims": [asdict(c) for c in claims],
    }
    RESULTS.mkdir(exist_ok=True)
    (RESULTS / "README.md").write_text(text + "\n", encoding="utf-8")
    (RESULTS / "results.json").write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    (RESULTS / "escapement.svg").write_text(picture.picture(rows), encoding="utf-8")
    quote(page.short(rows))
    print(
        f"\n{text}\n\nwritten: README.md, results.json, escapement.svg in benchmarks/results, and README.md"
    )


if __name__ == "__main__":
    main()
