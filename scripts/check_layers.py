"""Check that every crate depends only on crates to its left in the path of the data.

The order is that of docs/architecture.md. The order of the Python modules is kept by import-linter, which
cannot see compiled modules; that only the results touch the core is checked here.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ALLOWED: dict[str, set[str]] = {
    "mainspring-geometry": set(),
    "mainspring-model": {"mainspring-geometry"},
    "mainspring-mechanism": {"mainspring-geometry", "mainspring-model"},
    "mainspring-cspace": {"mainspring-geometry", "mainspring-model", "mainspring-mechanism"},
    "mainspring-dynamics": {"mainspring-geometry", "mainspring-model", "mainspring-mechanism"},
    "mainspring-behavior": {
        "mainspring-geometry",
        "mainspring-model",
        "mainspring-mechanism",
        "mainspring-dynamics",
    },
    "mainspring": {
        "mainspring-geometry",
        "mainspring-model",
        "mainspring-mechanism",
        "mainspring-cspace",
        "mainspring-dynamics",
        "mainspring-behavior",
    },
    "mainspring-python": {"mainspring"},
    # The fuzzer stands at the end of the path and may see all of it.
    "mainspring-fuzz": {
        "mainspring-geometry",
        "mainspring-model",
        "mainspring-mechanism",
        "mainspring-dynamics",
        "mainspring-behavior",
        "mainspring",
    },
}


def crates() -> list[dict[str, object]]:
    """Return the workspace's packages as cargo describes them."""
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1", "--offline"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    packages: list[dict[str, object]] = json.loads(text)["packages"]
    return packages


def faults() -> list[str]:
    """Return one sentence for each dependency that points the wrong way."""
    found = []
    for package in crates():
        name = str(package["name"])
        if name not in ALLOWED:
            found.append(f"crate {name} has no place in the order of layers")
            continue
        dependencies = package["dependencies"]
        assert isinstance(dependencies, list)
        used = {d["name"] for d in dependencies if d["name"].startswith("mainspring")}
        found += [f"{name} must not depend on {bad}" for bad in sorted(used - ALLOWED[name] - {name})]
    return found


def leaks() -> list[str]:
    """Return one sentence for each module of the command line or the reports that imports the core."""
    package = Path(__file__).resolve().parent.parent / "python" / "mainspring"
    modules = [p for room in ("cli", "report", "drawing") for p in sorted((package / room).glob("*.py"))]
    return [
        f"{module.relative_to(package)} must not import the compiled core"
        for module in modules
        if re.search(r"^\s*(from|import) .*\b_core\b", module.read_text(encoding="utf-8"), re.MULTILINE)
    ]


if __name__ == "__main__":
    problems = faults() + leaks()
    print("\n".join(problems) or "layers: in order")
    sys.exit(bool(problems))
