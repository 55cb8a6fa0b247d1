"""The command line: one verb per question.

Standard output carries the answer and nothing else; standard error carries progress, warnings and
errors. Exit codes: 0 done, 2 bad input or usage, 130 stopped by Ctrl-C with what is finished kept.
"""

import importlib
import sys

from mainspring.cli.arguments import parser
from mainspring.cli.faults import Stopped, Unwritable, Usage


def main(argv: list[str] | None = None) -> int:
    """Run one command and return its exit code."""
    options = parser().parse_args(argv)
    try:
        command = importlib.import_module(f"mainspring.cli.{options.module}")
        command.run(options)
        sys.stdout.flush()
    except Usage as fault:
        return _fail(f"mainspring {options.command}: error: {fault}")
    except Unwritable as fault:
        return _fail(str(fault))
    except Stopped:
        return 130
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except OSError as fault:
        what = (
            f"the file cannot be used ({fault.strerror or fault}); expected one that can be read and written"
        )
        return _fail(f"{fault.filename or 'mainspring'}:1:1: error: {what}")
    except ValueError as fault:
        return _input_error(fault)
    return 0


def _input_error(fault: ValueError) -> int:
    """Print the core's own error line; anything else is a bug and keeps its trace."""
    from mainspring import InputError

    if not isinstance(fault, InputError):
        raise fault
    return _fail(str(fault))


def _fail(line: str) -> int:
    print(line, file=sys.stderr)
    return 2
