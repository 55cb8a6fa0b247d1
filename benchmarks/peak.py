"""Run one engine once in this fresh process and print the most memory it held, in MiB, on standard error.

python peak.py mainspring simulate MODEL --until 37     the command line, by its own Python
python peak.py with_mujoco STEP UNTIL                   a peer, by the benchmarks' Python
"""

import contextlib
import importlib
import os
import resource
import runpy
import sys
from pathlib import Path


def peak() -> float:
    """Return the largest resident size of this process so far, in MiB.

    Linux tells it in VmHWM; `ru_maxrss` there also counts what the parent held when it started this process.
    """
    status = Path("/proc/self/status")
    if status.exists():
        lines = status.read_text(encoding="utf-8").splitlines()
        return int(next(line for line in lines if line.startswith("VmHWM")).split()[1]) / 1024
    units = 1024 * 1024 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / units


def run(name: str, rest: list[str]) -> None:
    """Do the work, printing nothing."""
    with Path(os.devnull).open("w", encoding="utf-8") as nowhere, contextlib.redirect_stdout(nowhere):
        if name == "mainspring":
            sys.argv = [name, *rest]
            with contextlib.suppress(SystemExit):
                runpy.run_module(name, run_name="__main__")
        else:
            importlib.import_module(name).simulate(*map(float, rest))


if __name__ == "__main__":
    run(sys.argv[1], sys.argv[2:])
    print(f"{peak():.1f}", file=sys.stderr)
