"""`mainspring predict`: what the machine will do for ever."""

from argparse import Namespace
from pathlib import Path
from typing import TypedDict

import mainspring as ms
from mainspring.cli import opening, output, tables, values
from mainspring.cli.faults import Stopped
from mainspring.cli.progress import watch
from mainspring.comparison import Comparison
from mainspring.prediction import Hypothesis, Prediction

SHOWN = 10  # hypotheses in the table: a screen, not a scroll


def run(options: Namespace) -> None:
    """Predict, write the report if asked for, print the answer."""
    chosen = search(options)
    contact = opening.contact(options)
    mechanism = opening.mechanism(options)
    start = opening.start(options, mechanism)
    with watch("looking for what repeats") as progress:
        result = ms.predict(mechanism, search=options.search, progress=progress, **contact, **start, **chosen)
    opening.warn(ms.find_pairs(mechanism).warnings)
    if options.report:
        from mainspring.report import page

        output.write_text(Path(options.report), page(mechanism, result))
    if options.json:
        output.print_json(result.to_json())
    else:
        if isinstance(result, Comparison):
            print(f"{mechanism.name}: the models {result.status}.")
            print("\n".join(result.sentences))
            for model, found in (("rigid", result.rigid), ("compliant", result.compliant)):
                print(f"\nwith {model} contact")
                account(mechanism, found)
        else:
            account(mechanism, result)
        if options.report:
            print(f"\nreport: {options.report}")
    if progress.stopped:
        raise Stopped


class Search(TypedDict):
    """Algorithm 12's parameters under Python's names."""

    confirm: int
    range_fraction: float
    ignore: int
    time_match: float
    state_match: float
    max_minima: int
    max_time: float


def search(options: Namespace) -> Search:
    """Return Algorithm 12's parameters, checked."""
    return {
        "confirm": values.count(options.confirm, "--confirm", 1),
        "range_fraction": values.positive(options.range_fraction, "--range-fraction"),
        "ignore": values.count(options.ignore, "--ignore", 0),
        "time_match": values.positive(options.time_match, "--time-match"),
        "state_match": values.positive(options.state_match, "--state-match"),
        "max_minima": values.count(options.max_minima, "--max-minima", 1),
        "max_time": values.positive(options.max_time, "--max-time"),
    }


def account(mechanism: "ms.Mechanism", result: Prediction) -> None:
    """Say the answer in sentences, then what changes in a pattern and what was tried."""
    print("\n".join(result.sentences) or result.status)
    motions = {p["name"]: p["motion"]["kind"] for p in mechanism.outlines()["parts"] if p["motion"]}
    if result.pattern:
        rows = (
            (part, *(tables.coordinate(c[k], motions.get(part, "turn")) for k in ("position", "velocity")))
            for part, c in result.pattern.change.items()
        )
        heads = ("part", "change of position", "change of velocity")
        tables.show(f"one pattern, {tables.signed(result.pattern.duration)} s", heads, rows, numeric=(1, 2))
    last = result.hypotheses[-SHOWN:]
    tables.show("hypotheses", ("minima", "formed at", "fell at", "why"), map(hypothesis_row, last))
    if len(result.hypotheses) > SHOWN:
        print(f"and {len(result.hypotheses) - SHOWN} that fell before (all with --json)")
    print(f"\nsimulated {tables.signed(result.simulated_seconds)} s to know this")


def hypothesis_row(h: Hypothesis) -> tuple[str, str, str, str]:
    """Return what was tried and what became of it."""
    fell = "holds" if h.fell is None else f"{tables.signed(h.fell)} s"
    return str(h.minima), f"{tables.signed(h.formed)} s", fell, h.why or ""
