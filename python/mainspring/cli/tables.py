"""Tables for people: aligned columns, no boxes, colour only on a terminal."""

import math
import shutil
import sys
from collections.abc import Iterable, Sequence
from typing import Literal

_NARROWEST = 60
_WIDEST = 140


def show(
    title: str, heads: Sequence[str], rows: Iterable[Sequence[str]], numeric: Sequence[int] = ()
) -> None:
    """Print one table under its title, `numeric` columns to the right; nothing when there are no rows."""
    from rich.console import Console
    from rich.table import Table

    found = [list(row) for row in rows]
    if not found:
        return
    width = max(_NARROWEST, min(_WIDEST, shutil.get_terminal_size((110, 40)).columns))
    console = Console(file=sys.stdout, width=width, highlight=False, emoji=False, markup=False)
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim", title_justify="left")
    for index, head in enumerate(heads):
        last = index == len(heads) - 1
        side: Literal["left", "right"] = "right" if index in numeric else "left"
        table.add_column(head, overflow="fold", no_wrap=not last, min_width=len(head), justify=side)
    for row in found:
        table.add_row(*row)
    console.print()
    console.print(title, style="bold")
    console.print(table)


def degrees(radians: float, digits: int = 6) -> str:
    """Return an angle in degrees, to a ten-thousandth at best, with a real minus sign."""
    return f"{signed(round(math.degrees(radians), 4), digits)}°"


def signed(value: float, digits: int = 6) -> str:
    """Return a number with so many significant digits and a real minus sign."""
    text = f"{value + 0.0:.{digits}g}"
    return ("0" if text in ("-0", "0") else text).replace("-", "−")


def coordinate(value: float, motion: str) -> str:
    """Return a joint position in degrees or the file's length."""
    return degrees(value) if motion == "turn" else signed(value)
