"""Run a machine several times in one process and print the seconds of each and the last result, as JSON.

Run by Mainspring's own Python, which needs nothing but the package.
"""

import argparse
import json
from typing import Any

import mainspring as ms


def arguments() -> argparse.Namespace:
    """Return what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("model")
    parser.add_argument("--supplement")
    parser.add_argument("--contact", default="rigid")
    parser.add_argument("--rtol", type=float, default=1e-8)
    parser.add_argument("--until", type=float, required=True)
    parser.add_argument("--runs", type=int, default=1)
    return parser.parse_args()


def result(mechanism: ms.Mechanism, wanted: argparse.Namespace) -> dict[str, Any]:
    """Return one run's JSON with its seconds."""
    run = ms.simulate(mechanism, wanted.until, contact=wanted.contact, rtol=wanted.rtol)
    found: dict[str, Any] = json.loads(run.to_json(timing=True))
    return found


def main() -> None:
    """Print the JSON."""
    wanted = arguments()
    mechanism = ms.load(wanted.model, wanted.supplement).compile()
    found = [result(mechanism, wanted) for _ in range(wanted.runs)]
    walls = [f["stats"]["wall_seconds"] for f in found]
    print(json.dumps({"walls": walls, "result": found[-1]}))


if __name__ == "__main__":
    main()
