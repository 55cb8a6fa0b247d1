"""All commands and their options, without importing anything heavy: `--help` stays quick."""

import argparse
from typing import NoReturn

from mainspring import __version__


class Parser(argparse.ArgumentParser):
    """A parser that reports a usage error in one line with exit code 2."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong and where help is."""
        self.exit(2, f"{self.prog}: error: {message} (see {self.prog} --help)\n")


Commands = argparse._SubParsersAction  # the type argparse gives no public name


def _command(commands: "Commands[Parser]", name: str, help_: str, example: str, module: str = "") -> Parser:
    made: Parser = commands.add_parser(
        name,
        help=help_,
        description=help_[0].upper() + help_[1:] + ".",
        epilog=f"example:\n  {example}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    made.set_defaults(command=name, module=module or name)
    return made


def _machine(command: Parser) -> None:
    """Add what every command on a machine takes."""
    command.add_argument("model", metavar="MODEL", help="model file (*.padl or *.toml)")
    add = command.add_argument_group("the machine").add_argument
    add("--supplement", metavar="FILE", help="supplement file (default: MODEL's name with .sup, beside it)")
    add("--set", metavar="NAME=VALUE", action="append", default=[], help="set a parameter; repeatable")
    add(
        "--pair-clearance", metavar="LENGTH", default="0", help="pair a shaft with a hole wider by up to this"
    )
    add("--keep-axial", action="store_true", help="keep axial freedoms that nothing pushes along")


def _json(command: Parser) -> None:
    command.add_argument(
        "--json", action="store_true", help="print one JSON object (radians) and nothing else"
    )


def _start(command: Parser) -> None:
    """Add what every command that runs a machine takes."""
    add = command.add_argument_group("the run").add_argument
    add(
        "--contact",
        choices=["rigid", "compliant", "both"],
        default="rigid",
        help="contact model; both: where the two differ (default: rigid)",
    )
    add(
        "--contact-constants",
        metavar="E,D,M",
        help="constants of compliant contact (default: the supplement's CONTACT, else 1e5,1e4,100)",
    )
    add("--rtol", metavar="R", help="relative tolerance (default: 1e-8 rigid, 1.5e-6 compliant)")
    add("--position", metavar="PART=10deg", action="append", default=[], help="start position; repeatable")
    add("--velocity", metavar="PART=5deg/s", action="append", default=[], help="start velocity; repeatable")


def _inspect(commands: "Commands[Parser]") -> None:
    example = "mainspring inspect examples/escapement/escapement.padl --svg escapement.svg"
    command = _command(commands, "inspect", "tell how the parts can move and touch, and why", example)
    _machine(command)
    command.add_argument("--svg", metavar="FILE", help="draw the machine with its axes")
    _json(command)


def _cspace(commands: "Commands[Parser]") -> None:
    example = "mainspring cspace escapement.padl ewheel lever --at ewheel=4deg,lever=2deg --html space.html"
    command = _command(
        commands, "cspace", "map where two parts are free and where they block each other", example
    )
    _machine(command)
    command.add_argument("a", metavar="A", help="a part")
    command.add_argument("b", metavar="B", help="another part, or the frame")
    add = command.add_argument_group("the map").add_argument
    add(
        "--coordinates",
        metavar="P,Q",
        help="parts whose joints are the coordinates (default: A's and B's own)",
    )
    add(
        "--window",
        metavar="PART=LOW:HIGH",
        action="append",
        default=[],
        help="range of a coordinate (default: a turn, or all that can touch)",
    )
    add(
        "--hold",
        metavar="PART=10deg",
        action="append",
        default=[],
        help="position of another joint that moves A or B (default: as at the start)",
    )
    add = command.add_argument_group("questions and pictures").add_argument
    add(
        "--at",
        metavar="A=10deg,B=5deg",
        action="append",
        default=[],
        help="free there? what is nearest? repeatable",
    )
    add(
        "--slice",
        metavar="A=10deg",
        action="append",
        default=[],
        help="free intervals of B there; repeatable",
    )
    add("--svg", metavar="FILE", help="draw the map")
    add("--html", metavar="FILE", help="write a page with the map beside the machine")
    _json(command)


def _simulate(commands: "Commands[Parser]") -> None:
    example = "mainspring simulate escapement.padl --until 37 --position bwheel=-20deg --out run"
    command = _command(commands, "simulate", "run the machine for a stretch of time", example)
    _machine(command)
    _start(command)
    command.add_argument(
        "--until", metavar="T", required=True, help="end of the run, in the file's time unit"
    )
    _search(command)
    add = command.add_argument_group("what to keep").add_argument
    add("--forces", action="store_true", help="ask for contact impulses and forces")
    add("--out", metavar="DIR", help="write result.json and trajectory.npz there")
    add("--csv", action="store_true", help="write trajectory.csv too (needs --out)")
    add("--timing", action="store_true", help="add the seconds the integration took")
    add("--report", metavar="FILE", help="write a self-contained page with animation and plots")
    _json(command)


def _search(command: Parser) -> None:
    command.add_argument(
        "--search",
        choices=["direct", "map"],
        default="direct",
        help="contacts from trees of features or from maps of each pair: the same motion (default: direct)",
    )


def _predict(commands: "Commands[Parser]") -> None:
    example = "mainspring predict escapement.padl --set gap=36 --report escapement.html"
    command = _command(commands, "predict", "say what the machine will do for ever", example)
    _machine(command)
    _start(command)
    _search(command)
    add = command.add_argument_group("the search for a pattern (Gelsey 1995, Algorithm 12)").add_argument
    add("--confirm", metavar="N", default="2", help="repetitions that must confirm it (default: 2)")
    add(
        "--range-fraction",
        metavar="F",
        default="1e-5",
        help="minima count below this part of the largest energy (default: 1e-5)",
    )
    add("--ignore", metavar="N", default="4", help="first minima to leave out (default: 4)")
    add("--time-match", metavar="F", default="0.01", help="allowed difference of durations (default: 0.01)")
    add("--state-match", metavar="F", default="0.02", help="allowed difference of changes (default: 0.02)")
    add("--max-minima", metavar="N", default="1000", help="give up after so many minima (default: 1000)")
    add("--max-time", metavar="T", default="100000", help="give up at this time (default: 100000)")
    command.add_argument(
        "--report", metavar="FILE", help="write a self-contained page with animation and plots"
    )
    _json(command)


def _demo(commands: "Commands[Parser]") -> None:
    command = _command(
        commands, "demo", "run the clock escapement from its shapes to what it will do", "mainspring demo"
    )
    command.add_argument(
        "--out",
        metavar="DIR",
        default="mainspring-demo",
        help="where report.html goes (default: mainspring-demo)",
    )
    _json(command)


def _examples(commands: "Commands[Parser]") -> None:
    command = _command(
        commands,
        "examples",
        "list the shipped machines, or copy one out",
        "mainspring examples escapement my-clock",
        module="shipped",
    )
    command.add_argument("name", metavar="NAME", nargs="?", help="the machine to copy")
    command.add_argument("directory", metavar="DIR", nargs="?", help="a new folder for it")
    _json(command)


def _cite(commands: "Commands[Parser]") -> None:
    example = "mainspring cite run/result.json"
    command = _command(commands, "cite", "print the sources of a result", example)
    command.add_argument("result", metavar="RESULT", nargs="?", help="a JSON result (default: all sources)")
    _json(command)


def parser() -> Parser:
    """Return the parser of the whole command line."""
    top = Parser(
        prog="mainspring",
        description="From the shapes of a machine to how it moves and what it will do.",
        epilog="example:\n  mainspring demo",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    top.add_argument("--version", action="version", version=f"mainspring {__version__}")
    commands = top.add_subparsers(metavar="COMMAND", title="commands", required=True, parser_class=Parser)
    for add in (_demo, _inspect, _cspace, _simulate, _predict, _examples, _cite):
        add(commands)
    return top
