"""Run a machine several times in one process and print the seconds of each and the last result, as JSON.

Run by Mainspring's own Python, which needs nothing but the package.
"""

import argparse
import json

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


def main() -> None:
    """Print the JSON."""
    wanted = arguments()
    mechanism = ms.load(wanted.model, wanted.supplement).compile()
    # Read afterwards: the processor's caches are for one run after the other, as in the peers' processes.
    runs = [
        ms.simulate(mechanism, wanted.until, contact=wanted.contact, rtol=wanted.rtol)
        for _ in range(wanted.runs)
    ]
    found = [json.loads(run.to_json(timing=True)) for run in runs]
    walls = [f["stats"]["wall_seconds"] for f in found]
    print(json.dumps({"walls": walls, "result": found[-1]}))


if __name__ == "__main__":
    main()
