"""The results as tables in Markdown, and the claims with whether they hold."""

from collections.abc import Sequence
from dataclasses import dataclass

from machines import Found
from measure import Row
from rundown import RunDown

Line = tuple[str, ...]


@dataclass(frozen=True)
class Claim:
    """A bound that must hold."""

    words: str
    found: str
    holds: bool


def table(head: Line, lines: Sequence[Line]) -> str:
    """Return a table, padded so that it reads well on a terminal; only the first column is text."""
    widths = [max(len(line[k]) for line in (head, *lines)) for k in range(len(head))]

    def padded(line: Line) -> str:
        cells = [
            c.ljust(w) if k == 0 else c.rjust(w) for k, (c, w) in enumerate(zip(line, widths, strict=True))
        ]
        return "| " + " | ".join(cells) + " |"

    rule = "| " + " | ".join("-" * w if k == 0 else "-" * (w - 1) + ":" for k, w in enumerate(widths)) + " |"
    return "\n".join([padded(head), rule, *map(padded, lines)])


def step(row: Row) -> str:
    """Return the step or the tolerance with its unit."""
    return f"rtol {row.step:g}" if row.engine == "mainspring" else f"dt {row.step * 1e3:.3g} ms"


def faster_peer(rows: list[Row]) -> Row:
    """Return the peer with the fastest run."""
    return min((row for row in rows if row.contact == "soft"), key=lambda row: row.fastest)


def escapement(rows: list[Row]) -> str:
    """Return the table of 37 s of the escapement."""
    base = faster_peer(rows).fastest
    head = ("engine", "step", "steps", "median ms", "fastest ms", "times the faster peer's speed")
    head += ("period s", "own limit s", "error s", "memory MiB")
    return table(
        head,
        [
            (
                f"{r.label} {r.version}",
                step(r),
                f"{r.steps}",
                f"{r.median * 1e3:.2f}",
                f"{r.fastest * 1e3:.2f}",
                f"{base / r.fastest:.1f}",
                f"{r.period:.7f}",
                f"{r.limit:.7f} ± {r.doubt:.0e}",
                f"{r.error:.1e}",
                f"{r.memory:.0f}",
            )
            for r in rows
        ],
    )


def short(rows: list[Row]) -> str:
    """Return the table for the README."""
    base = faster_peer(rows).fastest
    head = ("engine", "step", "time", "speed", "error of the period")
    return table(
        head,
        [
            (
                r.label,
                step(r),
                f"{r.fastest * 1e3:.3g} ms",
                f"{base / r.fastest:.2g} ×",
                f"{r.error:.0e} s",
            )
            for r in rows
        ],
    )


def run_downs(found: list[RunDown]) -> str:
    """Return the table of the run-down."""
    base = min(r.seconds for r in found if r.memory is None)
    head = (
        "engine",
        "step",
        "time s",
        "times the faster peer's speed",
        "wheel at the end",
        "steps that jammed",
        "memory MiB",
    )
    return table(
        head,
        [
            (
                r.engine,
                f"rtol {r.step:g}" if r.memory else f"dt {r.step * 1e3:.3g} ms",
                f"{r.seconds:.3f}",
                f"{base / r.seconds:.1f}",
                f"{r.wheel:.2f}°",
                ", ".join(f"{h * 1e3:.3g} ms" for h in r.jammed_at) or "none",
                f"{r.memory:.0f}" if r.memory else "",
            )
            for r in found
        ],
    )


def machines(found: list[Found]) -> str:
    """Return the table of the machines of Fig. 22."""
    head = ("machine and contact model", "simulated s", "steps", "time ms", "ms a step", "energy residual")
    head += ("paper: simulated s", "steps", "time s")
    return table(
        head,
        [
            (
                f"{f.name}, {f.contact}",
                f"{f.until:.4g}{' (at rest)' if f.status == 'at_rest' else ''}",
                f"{f.steps}",
                f"{f.seconds * 1e3:.2f}",
                f"{f.seconds * 1e3 / f.steps:.3f}",
                f"{f.residual:.0e}",
                f"{f.paper.until:g}",
                f"{f.paper.steps}",
                f"{f.paper.seconds:g}",
            )
            for f in found
        ],
    )


def claims(rows: list[Row], downs: list[RunDown]) -> list[Claim]:
    """Return what must hold, with what was found."""
    base = faster_peer(rows).fastest
    bounds = {"rigid": (30.0, 1e-6), "compliant": (1.0, 1e-4)}
    found = []
    for row in (r for r in rows if r.contact in bounds):
        speed, error = bounds[row.contact]
        ratio = base / row.fastest
        found.append(
            Claim(
                f"{row.contact}: at least {speed:g} times as fast as the faster peer",
                f"{ratio:.1f}",
                ratio >= speed,
            )
        )
        found.append(
            Claim(
                f"{row.contact}: error of the period below {error:g} s",
                f"{row.error:.1e} s",
                row.error < error,
            )
        )
    by_contact = {row.contact: row.period for row in rows}
    if "compliant" in by_contact:
        off = abs(by_contact["compliant"] / by_contact["rigid"] - 1)
        found.append(Claim("compliant: period within 0.1 % of rigid", f"{off * 100:.4f} %", off < 1e-3))
    most = max([r.memory for r in rows if r.contact in bounds] + [r.memory for r in downs if r.memory])
    return [*found, Claim("memory below 120 MiB", f"{most:.0f} MiB", most < 120)]


def claims_table(found: list[Claim]) -> str:
    """Return the claims as a table."""
    return table(
        ("must hold", "found", "holds"), [(c.words, c.found, "yes" if c.holds else "no") for c in found]
    )
