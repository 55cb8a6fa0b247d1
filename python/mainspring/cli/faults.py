"""The ways a command ends early."""

from pathlib import Path


class Usage(Exception):
    """The command line itself is wrong; the text says what was expected."""


class Stopped(Exception):
    """Ctrl-C: what was finished has been kept."""


class Unwritable(Exception):
    """A file cannot be written; the text is the line to print."""

    def __init__(self, path: Path, fault: OSError) -> None:
        reason = fault.strerror or fault
        super().__init__(
            f"{path}:1:1: error: the file cannot be written ({reason}); expected a place for a new file"
        )
