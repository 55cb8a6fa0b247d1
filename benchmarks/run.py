"""Simulate 37 s of the escapement with Mainspring, MuJoCo and pymunk, on one thread, in one run.

Each peer runs at the largest step below which every tested step ticks. Its clock counts its own
stepping only: MuJoCo's rollout in C, pymunk's `step` called from Python; Mainspring's counts the
integration alone, each time in a fresh process. Periods are compared with each engine's own limit at
a fine step or tolerance, because contacts differ: soft in the peers, rigid in Mainspring. The ratio is
that of the fastest runs, which other work on the machine disturbs least; its load is told beside it.

Prints a table; writes results/escapement.json and results/escapement.md.
"""

import json
import os
import platform
from dataclasses import asdict
from pathlib import Path

import numpy as np

import with_mujoco
import with_pymunk
from measure import RUNS, Row, mainspring, stepped
from scene import UNTIL

RESULTS = Path(__file__).resolve().parent / "results"
Machine = dict[str, str | int | float | None]
HEAD = (
    "engine",
    "setting",
    "step",
    "steps",
    "median ms",
    "fastest ms",
    "times as long",
    "period s",
    "off its limit",
)


def processor() -> str:
    """Return the processor's model, as Linux tells it, else as Python does."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def machine() -> Machine:
    """Return what the times depend on; no name of the host."""
    return {
        "processor": processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numpy": np.__version__,
        "load": round(os.getloadavg()[0], 1),
    }


def cells(row: Row, base: Row) -> tuple[str, ...]:
    """Return one line of the table."""
    return (
        f"{row.engine} {row.version}",
        row.setting,
        f"{row.step:g}",
        f"{row.steps}",
        f"{row.median * 1e3:.3f}",
        f"{row.fastest * 1e3:.3f}",
        f"{row.fastest / base.fastest:.1f}",
        f"{row.period:.6f}",
        f"{row.error:.1e}",
    )


def table(rows: list[Row]) -> str:
    """Return the table in Markdown, padded so that it reads well on a terminal."""
    lines = [HEAD, *(cells(row, rows[0]) for row in rows)]
    widths = [max(len(line[k]) for line in lines) for k in range(len(HEAD))]
    text = ["| " + " | ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)) + " |" for line in lines]
    rule = "| " + " | ".join("-" * w for w in widths) + " |"
    return "\n".join([text[0], rule, *text[1:]])


def write(rows: list[Row], text: str, where: Machine) -> None:
    """Write both files, whole."""
    found = [asdict(row) | {"error": row.error, "ratio": row.fastest / rows[0].fastest} for row in rows]
    RESULTS.mkdir(exist_ok=True)
    data = json.dumps({"until": UNTIL, "runs": RUNS, "machine": where, "rows": found}, indent=2)
    (RESULTS / "escapement.json").write_text(data + "\n", encoding="utf-8")
    about = ", ".join(f"{key} {value}" for key, value in where.items())
    notes = str(__doc__).split("\n\n", 1)[1].split("\n\nPrints", 1)[0]
    page = f"# {UNTIL:g} s of the escapement\n\n{text}\n\n{notes}\n\nMedian of {RUNS} runs; {about}.\n"
    (RESULTS / "escapement.md").write_text(page, encoding="utf-8")


def main() -> None:
    """Measure, print, write."""
    where = machine()
    rows = [mainspring(), stepped(with_mujoco), stepped(with_pymunk)]
    text = table(rows)
    write(rows, text, where)
    print(f"{UNTIL:g} s of the escapement, one thread, median of {RUNS} runs\n\n{text}")
    evaluations = rows[0].gap_evaluations
    print(f"\nMainspring evaluated {evaluations} gaps. Written: benchmarks/results/escapement.json and .md")


if __name__ == "__main__":
    main()
