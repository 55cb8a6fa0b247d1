"""Draw how the cost of a configuration space grows, from the table of the example `growth` on standard input.

The table is passed on to standard output; the picture and the figures go into results/.
"""

import json
import re
import sys
from itertools import groupby
from math import log
from pathlib import Path

from picture import BOTTOM, HEIGHT, LEFT, RIGHT, TOP, WIDTH, Axis, axis, duration, style, text

RESULTS = Path(__file__).resolve().parent / "results"
ROW = re.compile(r"\s*([a-z][a-z, ]*?)\s+(\d+)\s+([\d.]+) ms\s+\d+ cells")
TITLE = "Time of a configuration space against the segments of either part"
# Two parts of a thousand segments each are to take no longer (seconds).
WANTED = (1000, 10.0)
# Colours of `style`; further lines are dashed.
COLOURED = 4
# Between lines of text (pixels).
APART = 15.0

Row = tuple[str, int, float]


def rows(table: list[str]) -> list[Row]:
    """Return kind, segments and seconds of every line that tells them."""
    found = [ROW.match(line) for line in table]
    return [(m[1], int(m[2]), 1e-3 * float(m[3])) for m in found if m]


def exponent(points: list[tuple[int, float]]) -> float:
    """Return the power of n with which the time grew over the last three sizes."""
    (n, first), (m, last) = points[max(0, len(points) - 3)], points[-1]
    return log(last / first) / log(m / n)


def grid(x: Axis, y: Axis) -> list[str]:
    """Return hair lines at the decades, with their names."""
    found = []
    for k in range(x.low, x.high + 1):
        at = x.at(10.0**k)
        found.append(f'<path class="hair" d="M{at:.1f} {y.start:.1f}V{y.end:.1f}"/>')
        found.append(text(at, y.start + 18, f"{10**k}", anchor="middle"))
    for k in range(y.low, y.high + 1):
        at = y.at(10.0**k)
        found.append(f'<path class="hair" d="M{x.start:.1f} {at:.1f}H{x.end:.1f}"/>')
        found.append(text(x.start - 8, at + 4, duration(10.0**k), anchor="end"))
    return found


def line(number: int, points: list[tuple[int, float]], x: Axis, y: Axis) -> list[str]:
    """Return the line of one kind of outlines."""
    places = [(x.at(n), y.at(seconds)) for n, seconds in points]
    through = " ".join(f"{a:.1f},{b:.1f}" for a, b in places)
    dashes = "" if number < COLOURED else ' stroke-dasharray="5 4"'
    found = [f'<g style="--c:var(--c{number % COLOURED})">']
    found.append(f'<polyline class="line" points="{through}"{dashes}/>')
    found += [f'<circle class="dot own" cx="{a:.1f}" cy="{b:.1f}" r="3"/>' for a, b in places]
    return [*found, "</g>"]


def names(lines: list[tuple[str, list[tuple[int, float]]]], x: Axis, y: Axis) -> list[str]:
    """Return the names of the lines: at the margin, apart enough to read; of shorter ones at their ends."""
    ends = sorted((y.at(points[-1][1]), number) for number, (_, points) in enumerate(lines))
    found, free = [], 0.0
    for at, number in ends:
        kind, points = lines[number]
        power = f"{kind}, n^{exponent(points):.1f}" if len(points) > 1 else kind
        end = x.at(points[-1][0])
        if end < x.end:
            words = text(end - 8, at - 8, power, "name", "end")
        else:
            free = max(at + 4, free)
            words = text(end + 14, free, power, "name")
            free += APART
        found.append(f'<g style="--c:var(--c{number % COLOURED})">{words}</g>')
    return found


def picture(table: list[Row]) -> str:
    """Return the picture."""
    x = Axis(1, 3, LEFT, WIDTH - RIGHT - 150)
    y = axis([seconds for *_, seconds in table], HEIGHT - BOTTOM, TOP)
    a, b = x.at(WANTED[0]), y.at(WANTED[1])
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img"',
        f' aria-label="{TITLE}">',
        style(),
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="var(--paper)"/>',
        text(LEFT, 24, TITLE, "head"),
        text(LEFT, 44, "powers over the last three sizes; ring: what two parts of 1,000 segments may take"),
        *grid(x, y),
        text(x.end, HEIGHT - 12, "lines and arcs of either part; one thread", anchor="end"),
        f'<circle cx="{a:.1f}" cy="{b:.1f}" r="8" fill="none" stroke="var(--ink)" stroke-width="1.6"/>',
    ]
    lines = [(kind, [row[1:] for row in group]) for kind, group in groupby(table, key=lambda row: row[0])]
    for number, (_, points) in enumerate(lines):
        parts += line(number, points, x, y)
    return "\n".join([*parts, *names(lines, x, y), "</svg>\n"])


def main() -> None:
    """Pass the table on, then write picture and figures."""
    table = []
    for line in sys.stdin:
        sys.stdout.write(line)
        sys.stdout.flush()
        table.append(line)
    found = sorted(rows(table), key=lambda row: row[:2])
    told = [{"outlines": kind, "segments": n, "seconds": seconds} for kind, n, seconds in found]
    (RESULTS / "growth.json").write_text(json.dumps(told, indent=1) + "\n")
    (RESULTS / "growth.svg").write_text(picture(found))


if __name__ == "__main__":
    main()
