"""`mainspring cite`: the sources a result rests on."""

import json
from argparse import Namespace
from pathlib import Path
from typing import Any

from mainspring.cli import output
from mainspring.cli.faults import Usage

_MOST_BYTES = 64 * 1024 * 1024

GELSEY = "Gelsey, A. (1995). Automated reasoning about machines. Artificial Intelligence 74(1), 1-53."
SOURCES: dict[str, tuple[tuple[str, str], ...]] = {
    "inspect": (
        (GELSEY, "input language (Figs. 12, 13), pairs and subsystems (Algorithms 1-7)"),
        (
            "Brown, C. M. (1982). PADL-2: A technical summary. "
            "IEEE Computer Graphics and Applications 2(2), 69-84.",
            "the language of solids",
        ),
        ("Reuleaux, F. (1876). The Kinematics of Machinery. Macmillan, London.", "kinematic pairs"),
    ),
    "cspace": (
        (
            "Kyung, M.-H., Sacks, E. Parameter synthesis of higher kinematic pairs. Purdue University.",
            "configuration spaces of higher pairs, contact curves",
        ),
    ),
    "simulate": (
        (GELSEY, "rigid contact (Appendix A, equations corrected)"),
        (
            "Gauss, C. F. (1829). Über ein neues allgemeines Grundgesetz der Mechanik. "
            "Journal für die reine und angewandte Mathematik 4, 232-235.",
            "accelerations under contact",
        ),
        (
            "Moreau, J. J. (1988). Unilateral contact and dry friction in finite freedom dynamics. "
            "In: Nonsmooth Mechanics and Applications, CISM 302, 1-82. Springer, Vienna.",
            "impacts as projections",
        ),
        (
            "Lawson, C. L., Hanson, R. J. (1974). Solving Least Squares Problems. Prentice-Hall, ch. 23.",
            "the small convex problems of contact",
        ),
    ),
    "compliant": (
        (GELSEY, "compliant contact (Sec. 2.2.1, Eqs. 4, 5, corrected)"),
        (
            "Steinebach, G. (2023). Construction of Rosenbrock-Wanner method Rodas5P and numerical "
            "benchmarks within the Julia Differential Equations package. BIT Numerical Mathematics 63:27.",
            "the stiff solver of compliant contact",
        ),
    ),
    "predict": ((GELSEY, "patterns of motion (Algorithm 12, corrected)"),),
}
_BUILDS_ON = {
    "inspect": ("inspect",),
    "cspace": ("inspect", "cspace"),
    "simulate": ("inspect", "simulate"),
    "predict": ("inspect", "simulate", "predict"),
}


def run(options: Namespace) -> None:
    """Print the sources of one result, or of all."""
    kind, steps = "predict", tuple(SOURCES)
    if options.result:
        result = _read(Path(options.result))
        kind = kind_of(result)
        steps = steps_of(kind, result)
    found = [{"source": s, "used_for": why} for step in steps for s, why in SOURCES[step]]
    if options.json:
        output.print_json(json.dumps({"kind": kind, "sources": found}, ensure_ascii=False))
        return
    for entry in found:
        print(f"{entry['source']}\n    for: {entry['used_for']}")


def _read(path: Path) -> Any:  # noqa: ANN401
    if path.stat().st_size > _MOST_BYTES:
        raise Usage(f"{path}: larger than 64 MiB; expected a JSON result of this program")
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as fault:
        raise Usage(f"{path}: not JSON; expected a result of this program") from fault


def steps_of(kind: str, result: dict[str, Any]) -> tuple[str, ...]:
    """Return what a result of a kind rests on."""
    steps = _BUILDS_ON[kind]
    if "differences" in result:
        return (*steps, "compliant")
    if "contact" not in result or kind == "inspect":
        return steps
    return tuple("compliant" if step == "simulate" else step for step in steps)


def kind_of(result: Any) -> str:  # noqa: ANN401
    """Return which command made a result, by its keys."""
    keys = set(result) if isinstance(result, dict) else set()
    if {"differences", "rigid"} <= keys:
        return kind_of(result["rigid"])
    for kind, key in (
        ("predict", "hypotheses"),
        ("predict", "prediction"),
        ("simulate", "events"),
        ("cspace", "curves"),
        ("inspect", "pairs"),
    ):
        if key in keys:
            return kind
    raise Usage("no result of this program; expected one of inspect, cspace, simulate, predict or demo")
