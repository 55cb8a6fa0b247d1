"""The ways a command ends early."""


class Usage(Exception):
    """The command line itself is wrong; the text says what was expected."""


class Stopped(Exception):
    """Ctrl-C: what was finished has been kept."""
