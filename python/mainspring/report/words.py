"""Small pieces of HTML: part names in their colours, tables, numbers."""

import html
import math
import re
from collections.abc import Iterable, Mapping, Sequence

from mainspring.drawing.ticks import minus


def escape(text: object) -> str:
    """Return text made safe for HTML."""
    return html.escape(str(text), quote=True)


def name(part: str, colour: Mapping[str, str]) -> str:
    """Return a part's name in its colour."""
    return f'<b class="name {colour.get(part, "pf")}">{escape(part)}</b>'


def coloured(sentence: str, colour: Mapping[str, str]) -> str:
    """Return a sentence with every part's name in its colour."""
    if not colour:
        return escape(sentence)
    longest_first = sorted(colour, key=len, reverse=True)
    pattern = re.compile(r"\b(" + "|".join(re.escape(n) for n in longest_first) + r")\b")
    pieces = pattern.split(sentence)
    return "".join(name(p, colour) if i % 2 else escape(p) for i, p in enumerate(pieces))


def figure(value: float, digits: int = 6) -> str:
    """Return a number with a real minus sign and at most so many significant digits."""
    return minus(f"{value + 0.0:.{digits}g}")


def position(value: float, motion: str) -> str:
    """Return a joint position in degrees or the file's length, to about a hundredth of a degree."""
    return f"{figure(round(math.degrees(value), 2))}°" if motion == "turn" else figure(value, 5)


def table(
    heads: Sequence[str], rows: Iterable[Sequence[str]], numeric: Iterable[int] = (), *, stack: bool = True
) -> str:
    """Return a table; cells are HTML already, `numeric` columns are set right.

    Tables of more than three columns stack their cells on narrow screens, or scroll without `stack`.
    """
    right = set(numeric)
    kinds = [' class="n"' if i in right else "" for i in range(len(heads))]
    head = "".join(f'<th scope="col"{k}>{escape(h)}</th>' for h, k in zip(heads, kinds, strict=True))
    body = "".join(
        "<tr>" + "".join(f"<td{k}>{c}</td>" for c, k in zip(row, kinds, strict=True)) + "</tr>"
        for row in rows
    )
    kind = ' class="stack"' if stack and len(heads) > 3 else ""
    return (
        f'<div class="scroll"><table{kind}><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'
    )
