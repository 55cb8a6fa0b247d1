"""Numbers and assignments as written on the command line: plain decimals, degrees for turning parts."""

import math
import re
from collections.abc import Iterable, Mapping

from mainspring.cli.faults import Usage

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_MOST_CHARACTERS = 60


def number(text: str, option: str) -> float:
    """Return a finite decimal number."""
    fits = len(text) <= _MOST_CHARACTERS and _NUMBER.fullmatch(text)
    value = float(text) if fits else math.nan
    if not math.isfinite(value):
        raise Usage(
            f"{option} {shortened(text)}: not a number; expected a finite decimal such as 12.5 or 1e-3"
        )
    return value


def positive(text: str, option: str) -> float:
    """Return a number above zero."""
    value = number(text, option)
    if value <= 0:
        raise Usage(f"{option} {shortened(text)}: out of range; expected a number above 0")
    return value


def at_least_zero(text: str, option: str) -> float:
    """Return a number that is not negative."""
    value = number(text, option)
    if value < 0:
        raise Usage(f"{option} {shortened(text)}: out of range; expected 0 or a positive number")
    return value


def constants(text: str, option: str) -> tuple[float, float, float]:
    """Return the three constants E, D, M of compliant contact."""
    pieces = text.split(",")
    if len(pieces) != 3:
        raise Usage(f"{option} {shortened(text)}: not three numbers; expected E,D,M such as 1e5,1e4,100")
    e, d, m = (number(piece.strip(), option) for piece in pieces)
    return e, d, m


def count(text: str, option: str, least: int) -> int:
    """Return a whole number between `least` and a million."""
    if not re.fullmatch(r"\d{1,7}", text, re.ASCII) or not least <= int(text) <= 1_000_000:
        raise Usage(
            f"{option} {shortened(text)}: no such count; expected a whole number from {least} to 1000000"
        )
    return int(text)


def shortened(text: str) -> str:
    """Return user text for a message: one line, printable, not long."""
    clean = "".join(c if c.isprintable() else "?" for c in text)
    return clean if len(clean) <= _MOST_CHARACTERS else clean[: _MOST_CHARACTERS - 1] + "…"


def split(text: str, option: str) -> tuple[str, str]:
    """Return the two sides of NAME=VALUE."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip() or not value.strip():
        raise Usage(f"{option} {shortened(text)}: no assignment; expected NAME=VALUE")
    return name.strip(), value.strip()


def settings(texts: Iterable[str]) -> dict[str, float]:
    """Return the parameters of all `--set`; a name given twice is an error."""
    found: dict[str, float] = {}
    for text in texts:
        name, value = split(text, "--set")
        if name.lower() in {n.lower() for n in found}:
            raise Usage(f"--set {shortened(text)}: {name} is set twice; expected one value")
        found[name] = number(value, f"--set {shortened(name)}")
    return found


def coordinates(
    texts: Iterable[str], option: str, motions: dict[str, str], also: Mapping[str, str] | None = None
) -> dict[str, float]:
    """Return joint positions or velocities by part, in radians or the file's length.

    Parameters
    ----------
    texts
        As given, `PART=10deg`, `PART=5deg/s` or, for sliding parts, `PART=2.5`.
    option
        `--position` or `--velocity`.
    motions
        By part, `turn` or `slide`.
    also
        Further names, in lower case, each with its part; a part's own name goes first.
    """
    found: dict[str, float] = {}
    names = {**(also or {}), **{name.lower(): name for name in motions}}
    for text in texts:
        part, value = split(text, option)
        if part.lower() not in names:
            known = ", ".join(motions) or "none"
            raise Usage(
                f"{option} {shortened(text)}: no moving part {shortened(part)}; expected one of: {known}"
            )
        name = names[part.lower()]
        if name in found:
            raise Usage(f"{option} {shortened(text)}: {name} is given twice; expected one value")
        found[name] = _coordinate(value, text, option, motions[name])
    return found


def _coordinate(value: str, text: str, option: str, motion: str) -> float:
    per = "/s" if option == "--velocity" else ""
    ending = f"deg{per}"
    if motion == "slide":
        if value.endswith(ending):
            raise Usage(f"{option} {shortened(text)}: this part slides; expected a plain length")
        return number(value.removesuffix(per) if per else value, option)
    if not value.endswith(ending):
        raise Usage(f"{option} {shortened(text)}: this part turns; expected degrees, such as 10{ending}")
    return math.radians(number(value.removesuffix(ending).strip(), option))
