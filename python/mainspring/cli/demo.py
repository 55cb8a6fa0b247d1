"""`mainspring demo`: the clock escapement, from its shapes to what it will do."""

import json
from argparse import Namespace
from pathlib import Path

import mainspring as ms
from mainspring.cli import opening, output, tables
from mainspring.cli.faults import Stopped
from mainspring.cli.inspect import sentences
from mainspring.cli.progress import watch
from mainspring.cli.shipped import folder


def run(options: Namespace) -> None:
    """Predict the escapement, write its report, tell about both."""
    from mainspring.report import page

    mechanism = ms.load(folder("escapement") / "escapement.padl").compile()
    found = ms.find_pairs(mechanism)
    opening.warn(found.warnings)
    with watch("running the escapement") as progress:
        result = ms.predict(mechanism, progress=progress)
    path = Path(options.out) / "report.html"
    output.write_text(path, page(mechanism, result))
    if options.json:
        answer = {"report": str(path), "inspect": json.loads(found.to_json())}
        answer["prediction"] = json.loads(result.to_json())
        output.print_json(json.dumps(answer, ensure_ascii=False))
    else:
        account(found, result)
        print(f"\nreport: {path}  (open it in a browser)")
    if progress.stopped:
        raise Stopped


def account(found: "ms.Kinematics", result: "ms.Prediction") -> None:
    """Tell the story in plain sentences."""
    run = result.simulation
    print("A clock escapement, from the shapes of its parts and a handful of numbers.\n")
    print("How it moves:  " + "\n               ".join(sentences(found)))
    print("What it does:  " + "\n               ".join(result.sentences))
    print(
        f"What it cost:  {tables.signed(run.t)} s simulated in {run.stats['steps']} steps and "
        f"{run.stats['gap_evaluations']} gap evaluations.\n"
        f"               The energy account closes to {abs(run.energy.residual):.0e}."
    )
