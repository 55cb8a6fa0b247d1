"""Error of the period against time, both in powers of ten, as an SVG for light and dark pages."""

from dataclasses import dataclass
from html import escape
from math import ceil, floor, log10

from measure import Point, Row

WIDTH, HEIGHT = 720, 470
LEFT, RIGHT, TOP, BOTTOM = 74, 26, 62, 52
# The colours of the program's own drawings (python/mainspring/drawing/palette.py).
COLOURS = {
    "mainspring rigid": ("#1769aa", "#62b0ee"),
    "mainspring compliant": ("#0b7a5e", "#45c8a0"),
    "mujoco": ("#8f6000", "#f0b640"),
    "pymunk": ("#7d4fa8", "#bb9be6"),
}
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Axis:
    """A logarithmic axis: decades from `low` to `high`, on the paper from `start` to `end`."""

    low: int
    high: int
    start: float
    end: float

    def at(self, value: float) -> float:
        """Return the place of a value; smaller values than the axis has stand at its end."""
        share = (log10(max(value, 10.0**self.low)) - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)


def axis(values: list[float], start: float, end: float) -> Axis:
    """Return the axis of whole decades that holds the values and labels beside them."""
    return Axis(floor(log10(min(values) / 2)), ceil(log10(max(values) * 2)), start, end)


def duration(seconds: float) -> str:
    """Return seconds in the unit that fits."""
    return f"{seconds * 1e3:g} ms" if seconds < 1 else f"{seconds:g} s"


def power(exponent: int) -> str:
    """Return a power of ten as people write it."""
    return f"10{str(exponent).translate(RAISED)}"


def text(x: float, y: float, words: str, kind: str = "soft", anchor: str = "start") -> str:
    """Return a piece of text."""
    return f'<text class="{kind}" x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(words)}</text>'


def style() -> str:
    """Return the style of both schemes."""
    light, dark = ("".join(f"--c{i}:{pair[k]};" for i, pair in enumerate(COLOURS.values())) for k in (0, 1))
    return (
        f"<style>:root{{--paper:#ffffff;--ink:#1b1e22;--soft:#646a72;--hair:#d9dce0;{light}}}"
        "@media (prefers-color-scheme:dark){:root{--paper:#14161a;--ink:#e8eaed;--soft:#9aa1aa;"
        f"--hair:#33383f;{dark}}}}}"
        "text{font:12px system-ui,sans-serif;fill:var(--soft)}"
        ".head{font-size:16px;font-weight:600;fill:var(--ink)}"
        ".name{font-size:13px;font-weight:600;fill:var(--c)}.hair{stroke:var(--hair)}.line{fill:none;stroke:var(--c);"
        "stroke-width:1.6}.dot{fill:var(--paper);stroke:var(--c);stroke-width:1.6}.own{fill:var(--c)}</style>"
    )


def grid(x: Axis, y: Axis) -> list[str]:
    """Return hair lines at the decades, with their names."""
    found = []
    for k in range(x.low, x.high + 1):
        at = x.at(10.0**k)
        found.append(f'<path class="hair" d="M{at:.1f} {y.start:.1f}V{y.end:.1f}"/>')
        found.append(text(at, y.start + 18, duration(10.0**k), anchor="middle"))
    for k in range(y.low, y.high + 1, 2):
        at = y.at(10.0**k)
        found.append(f'<path class="hair" d="M{x.start:.1f} {at:.1f}H{x.end:.1f}"/>')
        found.append(text(x.start - 8, at + 4, f"{power(k)} s", anchor="end"))
    return found


def label(row: Row, point: Point) -> str:
    """Return the words at a point: the step or the tolerance."""
    if row.engine == "mainspring":
        told = tolerance(point.step)
        return f"rtol {told}" if point.step == row.step else told
    return f"{point.step * 1e3:.2g} ms"


def tolerance(step: float) -> str:
    """Return a tolerance as a power of ten, with its factor if it is none."""
    exponent = floor(log10(step) + 1e-9)
    factor = round(step / 10.0**exponent)
    return power(exponent) if factor == 1 else f"{factor}·{power(exponent)}"


def placed(row: Row, side: int, a: float, b: float) -> tuple[float, float, str]:
    """Return where a label stands: beside Mainspring's steep lines, above or below the peers' flat ones."""
    if row.engine == "mainspring":
        return a + side * 9, b + 4, "start" if side > 0 else "end"
    return a, b + (19 if side > 0 else -10), "middle"


def name(row: Row, side: int, places: list[tuple[float, float]]) -> str:
    """Return the engine's name: over Mainspring's lines, at the far end of the peers'."""
    if row.engine == "mainspring":
        a, b = places[0]
        anchor = "start" if side > 0 or a < LEFT + 130 else "end"
        return text(a + (6 if anchor == "end" else -6), b - 13, row.label, "name", anchor)
    a, b = places[-1]
    return text(a + 10, b + 4, row.label, "name")


def curve(row: Row, x: Axis, y: Axis, side: int) -> list[str]:
    """Return an engine's line with its name and labelled points; the one of the table is filled."""
    number = list(COLOURS).index(row.label)
    places = [(x.at(p.seconds), y.at(max(p.error, row.doubt))) for p in row.points]
    line = " ".join(f"{a:.1f},{b:.1f}" for a, b in places)
    found = [f'<g style="--c:var(--c{number})"><polyline class="line" points="{line}"/>']
    for p, (a, b) in zip(row.points, places, strict=True):
        kind = "dot own" if p.step == row.step else "dot"
        found.append(f'<circle class="{kind}" cx="{a:.1f}" cy="{b:.1f}" r="4"/>')
        u, v, anchor = placed(row, side, a, b)
        found.append(text(u, v, label(row, p), anchor=anchor))
    return [*found, name(row, side, places), "</g>"]


def picture(rows: list[Row]) -> str:
    """Return the picture."""
    points = [p for row in rows for p in row.points]
    x = axis([p.seconds for p in points], LEFT, WIDTH - RIGHT)
    y = axis([max(p.error, 1e-14) for p in points], HEIGHT - BOTTOM, TOP)
    title = "Error of the escapement's period against the time 37 s of it take"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img"',
        f' aria-label="{title}">',
        style(),
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="var(--paper)"/>',
        text(LEFT, 24, title, "head"),
        text(
            LEFT,
            44,
            "against each engine's own limit, at least that limit's doubt; filled: the setting of the table",
        ),
        *grid(x, y),
        text(WIDTH - RIGHT, HEIGHT - 12, "wall time of the engine's own stepping, one thread", anchor="end"),
    ]
    for row in rows:
        parts += curve(row, x, y, side=-1 if row.label in ("mainspring rigid", "pymunk") else 1)
    return "\n".join([*parts, "</svg>\n"])
