"""Help and errors start quickly: counted in modules, not in seconds."""

import subprocess
import sys

import pytest

COUNT = "import sys; sys.argv = {argv!r}\n"
COUNT += "from mainspring.cli import main\n"
COUNT += "try: main()\n"
COUNT += "except SystemExit: pass\n"
COUNT += "print(sorted(m.split('.')[0] for m in sys.modules), len(sys.modules), sep='|')"


def _modules(*argv: str) -> tuple[str, int]:
    program = COUNT.format(argv=["mainspring", *argv])
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    names, count = done.stdout.splitlines()[-1].rsplit("|", 1)
    return names, int(count)


@pytest.mark.parametrize("argv", [("--help",), ("simulate", "--help"), ("fly",)])
def test_help_loads_nothing_heavy(argv):
    names, count = _modules(*argv)
    assert all(f"'{heavy}'" not in names for heavy in ("numpy", "rich", "json"))
    assert count < 150
