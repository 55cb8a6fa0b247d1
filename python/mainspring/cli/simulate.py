"""`mainspring simulate`: the motion over a stretch of time."""

import json
from argparse import Namespace
from collections.abc import Mapping
from pathlib import Path

import mainspring as ms
from mainspring import counting
from mainspring.cli import opening, output, tables, values
from mainspring.cli.faults import Stopped, Usage
from mainspring.cli.progress import watch
from mainspring.comparison import Comparison
from mainspring.simulation import Simulation

Found = Simulation | Comparison[Simulation]


def run(options: Namespace) -> None:
    """Run the machine, write what was asked for, print the result."""
    until = values.positive(options.until, "--until")
    contact = opening.contact(options)
    if options.csv and not options.out:
        raise Usage("--csv: no folder for trajectory.csv; expected --out DIR as well")
    mechanism = opening.mechanism(options)
    start = opening.start(options, mechanism)
    with watch("simulating", until) as progress:
        result = ms.simulate(
            mechanism,
            until,
            forces=options.forces,
            search=options.search,
            progress=progress,
            **contact,
            **start,
        )
    opening.warn(ms.find_pairs(mechanism).warnings)
    _keep(options, mechanism, result)
    if progress.stopped:
        raise Stopped


def _keep(options: Namespace, mechanism: "ms.Mechanism", result: Found) -> None:
    text = result.to_json(timing=options.timing)
    written = write(Path(options.out), text, result, options.csv) if options.out else []
    if options.report:
        from mainspring.report import page

        output.write_text(Path(options.report), page(mechanism, result))
        written.append(options.report)
    if options.json:
        output.print_json(text)
    else:
        if isinstance(result, Comparison):
            both(mechanism, result)
        else:
            account(mechanism, result, json.loads(text)["stats"])
        for path in written:
            print(f"wrote {path}")


def write(folder: Path, text: str, result: Found, csv: bool) -> list[str]:
    """Write result.json, trajectory.npz and on request trajectory.csv; return their paths.

    With both models of contact there is a trajectory of each.
    """
    output.write_text(folder / "result.json", text + "\n")
    names = ["result.json"]
    if isinstance(result, Comparison):
        names += _trajectory(folder, "trajectory-rigid", result.rigid, csv)
        names += _trajectory(folder, "trajectory-compliant", result.compliant, csv)
    else:
        names += _trajectory(folder, "trajectory", result, csv)
    return [str(folder / name) for name in names]


def _trajectory(folder: Path, name: str, result: Simulation, csv: bool) -> list[str]:
    import numpy as np

    motion = result.trajectory
    parts = np.array(motion.parts, dtype=np.str_)
    output.write_file(
        folder / f"{name}.npz", lambda s: np.savez(s, t=motion.t, q=motion.q, v=motion.v, parts=parts)
    )
    if not csv:
        return [f"{name}.npz"]
    output.write_text(folder / f"{name}.csv", _csv(result))
    return [f"{name}.npz", f"{name}.csv"]


def _csv(result: Simulation) -> str:
    motion = result.trajectory
    head = ["t"] + [f"{p}.{k}" for k in ("position", "velocity") for p in motion.parts]
    lines = [",".join(head)]
    for t, q, v in zip(motion.t.tolist(), motion.q.tolist(), motion.v.tolist(), strict=True):
        lines.append(",".join(map(repr, [t, *q, *v])))
    return "\n".join(lines) + "\n"


_ENDED = {
    "complete": "ran to the end asked for",
    "at_rest": "came to rest and stays there",
    "jammed": "is jammed: a drive runs against parts that cannot give way",
    "too_deep": "ended: parts overlap by more than compliant contact can stand for; raise its constant E",
    "step_limit": "gave up at the limit of steps; ask for a shorter time or a larger --rtol",
    "stopped": "was stopped; what follows is what was finished",
}


def account(mechanism: "ms.Mechanism", result: Simulation, stats: Mapping[str, float]) -> None:
    """Say how it ended, then the final state, the energy account and the work it took."""
    motions = {p["name"]: p["motion"]["kind"] for p in mechanism.outlines()["parts"] if p["motion"]}
    ended = _ENDED.get(result.status, result.status)
    changes = sum(e.kind != "impact" for e in result.events)
    print(f"{mechanism.name}: the run {ended}, t = {tables.signed(result.t, 8)} s.")
    struck = counting.impacts(result.stats["impacts"], len(result.events) - changes)
    told = counting.number_of(changes, "contact change")
    print(f"{struck}, {told}, {counting.minima(len(result.kinetic_energy_minima))}.")
    rows = (
        (
            p,
            tables.coordinate(q, motions.get(p, "turn")),
            tables.coordinate(result.velocities[p], motions.get(p, "turn")) + "/s",
        )
        for p, q in result.positions.items()
    )
    tables.show("at the end", ("part", "position", "velocity"), rows, numeric=(1, 2))
    tables.show("energy", ("account", "amount"), energy_rows(result), numeric=(1,))
    counts = (f"{k} {v:.3g}" if isinstance(v, float) else f"{k} {v}" for k, v in stats.items())
    print("\nwork: " + ", ".join(counts))


def both(mechanism: "ms.Mechanism", result: Comparison[Simulation]) -> None:
    """Say where the models differ, then by how much, and both energy accounts."""
    print(f"{mechanism.name}: the models {result.status}.")
    print("\n".join(result.sentences))
    motions = {p["name"]: p["motion"]["kind"] for p in mechanism.outlines()["parts"] if p["motion"]}
    rows = []
    for part, d in result.differences["positions"].items():
        kind = motions.get(part, "turn")
        ends = (tables.coordinate(r.positions[part], kind) for r in (result.rigid, result.compliant))
        rows.append((part, *ends, tables.coordinate(d["greatest"], kind), tables.signed(d["at"]) + " s"))
    heads = ("part", "rigid, at its end", "compliant", "greatest difference", "at")
    tables.show("positions", heads, rows, numeric=(1, 2, 3, 4))
    accounts = zip(energy_rows(result.rigid, True), energy_rows(result.compliant, True), strict=True)
    shown = ((a[0], a[1], b[1]) for a, b in accounts)
    tables.show("energy", ("account", "rigid", "compliant"), shown, numeric=(1, 2))


def energy_rows(result: Simulation, every: bool = False) -> list[tuple[str, str]]:
    """Return the energy account as rows of words and amounts; `every` keeps rows of nothing."""
    e = result.energy
    stored = ("stored in contacts", tables.signed(e.contact_stored, 8))
    return [
        ("at the start", tables.signed(e.initial, 8)),
        *([("done by drives and torques", tables.signed(e.work, 8))] if e.work or every else []),
        ("lost to friction", tables.signed(e.friction, 8)),
        ("lost in contacts" if result.contact else "lost at impacts", tables.signed(e.impacts, 8)),
        *([stored] if result.contact or every else []),
        ("at the end", tables.signed(e.final, 8)),
        ("residual, relative", tables.signed(e.residual, 2)),
    ]
