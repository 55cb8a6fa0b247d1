"""A configuration space as one SVG: free white, blocked grey, contact curves crisp.

Where the map repeats, the stored tile is drawn over the whole turn.
"""

import html
import math
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from mainspring.drawing.feature import told
from mainspring.drawing.palette import variables
from mainspring.drawing.svg import colours
from mainspring.drawing.ticks import angle_marks, length_marks

Data = dict[str, Any]

_FONT = "system-ui,-apple-system,'Segoe UI',Roboto,Arial,sans-serif"
# Copies of the tile see the page's rules without its ancestors: classes of their own, no descent.
STYLE = (
    f".space{{font:13px {_FONT}}}"
    ".cs-blocked{fill:var(--hair)}.cs-free{fill:var(--paper)}"
    ".cs-line{stroke:var(--ink);stroke-width:1.5;fill:none;stroke-linejoin:round;stroke-linecap:round}"
    ".cs-reach{stroke:transparent;stroke-width:9;fill:none}"
    ".cs-contact:hover .cs-line{stroke:var(--accent);stroke-width:3}"
    ".cs-edge{fill:none;stroke:var(--soft)}"
    ".cs-tick{stroke:var(--soft)}.cs-tile{stroke:var(--soft);stroke-width:.6;stroke-dasharray:1.5 4}"
    ".cs-value{fill:var(--soft);font-size:11.5px;font-variant-numeric:tabular-nums}"
    ".cs-name{fill:var(--c);font-weight:600;font-size:14px}.cs-unit{fill:var(--soft);font-weight:400}"
    ".cs-mark{stroke:var(--c);stroke-width:1.1;stroke-dasharray:5 3}"
    ".cs-marked{fill:var(--c);font-size:11.5px;paint-order:stroke;stroke:var(--paper);stroke-width:3}"
    ".cs-start{fill:var(--paper);stroke:var(--ink);stroke-width:1.6}"
)

_WIDTH = 720.0
_LEFT, _TOP, _RIGHT, _BOTTOM = 64.0, 34.0, 22.0, 50.0
_TALLEST, _LOWEST = 640.0, 260.0
_FLAT = 430.0
_CROP = 0.8
_MOST_TILES = 4096
_MOST_BORDERS = 16  # more would hide the map behind lines


@dataclass(frozen=True)
class Side:
    """One axis of the picture: the coordinate's name, the range shown, its copies of the stored tile."""

    name: str
    turns: bool
    low: float
    high: float
    offsets: tuple[float, ...]
    marks: tuple[tuple[float, str], ...]

    @property
    def span(self) -> float:
        """Length of the range shown."""
        return self.high - self.low


@dataclass(frozen=True)
class Plot:
    """Where the map lies in the picture, in pixels, and its two axes."""

    x: Side
    y: Side
    wide: float
    tall: float

    def at(self, point: Iterable[float]) -> tuple[float, float]:
        """Return the place of a configuration in the picture."""
        a, b = point
        return (
            _LEFT + (a - self.x.low) / self.x.span * self.wide,
            _TOP + (self.y.high - b) / self.y.span * self.tall,
        )

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Left, top, width and height of the map."""
        return _LEFT, _TOP, self.wide, self.tall

    @property
    def view(self) -> str:
        """The SVG view box."""
        return f"0 0 {_text(_WIDTH)} {_text(_TOP + self.tall + _BOTTOM)}"


def _text(v: float) -> str:
    return f"{v:.2f}".rstrip("0").rstrip(".") if abs(v) >= 0.005 else "0"


def _side(data: Data, k: int) -> Side:
    axis = data["domain"][k]
    low, high, period = axis["low"], axis["high"], axis["period"]
    repeated = period and axis["repeats"] > 1
    shown = (-math.pi, math.pi) if repeated else _cropped(data, k, low, high)
    offsets = [0.0]
    if period:
        first, last = (
            math.floor((shown[0] - low) / period + 1e-9),
            math.ceil((shown[1] - high) / period - 1e-9),
        )
        offsets = [j * period for j in range(first, last + 1)]
    make = angle_marks if axis["motion"] == "turn" else length_marks
    return Side(axis["coordinate"], axis["motion"] == "turn", *shown, tuple(offsets), make(*shown))


def _cropped(data: Data, k: int, low: float, high: float) -> tuple[float, float]:
    """Return the range with anything free in it and some air, if that is much less than all."""
    values = [min(max(p[k], low), high) for polygon in data["free"] for p in polygon]
    if not values:
        return low, high
    a, b = min(values), max(values)
    air = 0.12 * (b - a)
    a, b = max(low, a - air), min(high, b + air)
    return (a, b) if 0 < b - a < _CROP * (high - low) else (low, high)


def plot(data: Data) -> Plot:
    """Return the picture's layout: equal scales for two angles where that gives a picture."""
    x, y = _side(data, 0), _side(data, 1)
    wide = _WIDTH - _LEFT - _RIGHT
    tall = wide * y.span / x.span if x.turns == y.turns else _FLAT
    if not _LOWEST <= tall <= 1.25 * _TALLEST:
        tall = _FLAT
    return Plot(x, y, wide, min(tall, _TALLEST))


def _path(shown: Plot, points: Iterable[Iterable[float]]) -> str:
    places = (shown.at(p) for p in points)
    return "M" + "L".join(f"{_text(x)} {_text(y)}" for x, y in places)


def _tile(data: Data, shown: Plot, name: str) -> str:
    """Draw the stored range once: free space, then the curves with their features as titles."""
    parts = {p["name"]: p for p in data["outlines"]["parts"]}
    free = "".join(_path(shown, polygon) + "Z" for polygon in data["free"])
    drawn = [f'<path class="cs-free" d="{free}"/>' if free else ""]
    for curve in data["curves"]:
        d = _path(shown, curve["points"])
        what = html.escape(" – ".join(told(parts, f) for f in curve["features"]))
        drawn.append(
            f'<g class="cs-contact" data-curve="{curve["id"]}"><title>{what}</title>'
            f'<path class="cs-reach" d="{d}"/><path class="cs-line" d="{d}"/></g>'
        )
    return f'<g id="{name}">{"".join(drawn)}</g>'


def _tiles(shown: Plot, name: str) -> str:
    """Place the tile's copies; the stored one first."""
    across, up = shown.wide / shown.x.span, shown.tall / shown.y.span
    drawn = []
    for a in shown.x.offsets:
        for b in shown.y.offsets[: _MOST_TILES // max(1, len(shown.x.offsets))]:
            place = f'x="{_text(a * across)}" y="{_text(-b * up)}"'
            drawn.append(f'<use href="#{name}" {place}/>')
    return "".join(drawn)


def _borders(data: Data, shown: Plot) -> str:
    """Draw thin lines between repeated tiles."""
    left, top, wide, tall = shown.box
    drawn = []
    for k, side in enumerate((shown.x, shown.y)):
        axis = data["domain"][k]
        for offset in side.offsets if 1 < axis["repeats"] <= _MOST_BORDERS else ():
            edge = axis["low"] + offset
            if not side.low < edge < side.high:
                continue
            x, y = shown.at((edge, shown.y.low) if k == 0 else (shown.x.low, edge))
            d = (
                f"M{_text(x)} {_text(top)}v{_text(tall)}"
                if k == 0
                else f"M{_text(left)} {_text(y)}h{_text(wide)}"
            )
            drawn.append(f'<path class="cs-tile" d="{d}"/>')
    return "".join(drawn)


def _axes(data: Data, shown: Plot) -> str:
    left, top, wide, tall = shown.box
    bottom = top + tall
    drawn = [f'<rect class="cs-edge" x="{left}" y="{top}" width="{_text(wide)}" height="{_text(tall)}"/>']
    for value, text in shown.x.marks:
        x = _text(shown.at((value, shown.y.low))[0])
        drawn.append(f'<path class="cs-tick" d="M{x} {_text(bottom)}v5"/>')
        drawn.append(
            f'<text class="cs-value" x="{x}" y="{_text(bottom + 18)}" text-anchor="middle">{text}</text>'
        )
    for value, text in shown.y.marks:
        y = shown.at((shown.x.low, value))[1]
        drawn.append(f'<path class="cs-tick" d="M{left} {_text(y)}h-5"/>')
        drawn.append(
            f'<text class="cs-value" x="{left - 8}" y="{_text(y + 4)}" text-anchor="end">{text}</text>'
        )
    colour = colours(data["outlines"]["parts"])
    named = ((shown.x, left + wide, bottom + 38, "end"), (shown.y, 8.0, 20.0, "start"))
    drawn += [_name(side, colour, x, y, anchor) for side, x, y, anchor in named]
    return "".join(drawn)


def _name(side: Side, colour: dict[str, str], x: float, y: float, anchor: str) -> str:
    how = "turned by" if side.turns else "moved by"
    text = f'{html.escape(side.name)} <tspan class="cs-unit">{how}</tspan>'
    place = f'x="{_text(x)}" y="{_text(y)}" text-anchor="{anchor}"'
    return f'<g class="{colour[side.name]}"><text class="cs-name" {place}>{text}</text></g>'


def _marks(data: Data, shown: Plot) -> str:
    """Draw named values as labelled lines, and the start as a ring."""
    left, top, wide, tall = shown.box
    colour = colours(data["outlines"]["parts"])
    drawn = []
    for mark in data["marks"]:
        upright = mark["coordinate"] == shown.x.name
        side = shown.x if upright else shown.y
        value = _seen(mark["value"], side)
        if value is None:
            continue
        x, y = shown.at((value, shown.y.high) if upright else (shown.x.low, value))
        d = (
            f"M{_text(x)} {_text(top)}v{_text(tall)}"
            if upright
            else f"M{_text(left)} {_text(y)}h{_text(wide)}"
        )
        place = (x + 4, top + 14) if upright else (left + 6, y - 4)
        drawn.append(
            f'<g class="{colour[mark["coordinate"]]}"><path class="cs-mark" d="{d}"/><text class="cs-marked" '
            f'x="{_text(place[0])}" y="{_text(place[1])}">{html.escape(mark["name"])}</text></g>'
        )
    at = data["start"]["at"]
    if shown.x.low <= at[0] <= shown.x.high and shown.y.low <= at[1] <= shown.y.high:
        x, y = shown.at(at)
        drawn.append(
            f'<circle class="cs-start" cx="{_text(x)}" cy="{_text(y)}" r="4"><title>start</title></circle>'
        )
    return "".join(drawn)


def _seen(value: float, side: Side) -> float | None:
    """Return where in the range shown a value lies, for a turning part in whichever turn; None outside."""
    turns = range(-2, 3) if side.turns else (0,)
    values = (value + 2 * math.pi * k for k in turns)
    return next((v for v in values if side.low <= v <= side.high), None)


def said(data: Data) -> str:
    """Say in words what the picture shows."""
    a, b = data["parts"]
    count = sum(c["copies"] for c in data["components"])
    what = "one free component" if count == 1 else f"{count} free components" if count else "nothing free"
    again = [
        f"it repeats {d['repeats']} times in a turn of {d['coordinate']}"
        for d in data["domain"]
        if d["repeats"] > 1
    ]
    held = [f"{name} held at {value:.4g}" for name, value in data["held"].items()]
    rest = "; ".join([f"{len(data['curves'])} contact curves", *again, *held])
    return f"Where {a} and {b} are free of each other (white) and blocked (grey): {what}, {rest}."


def space_picture(data: Data, *, extra: str = "", style: str = "", attributes: str = 'role="img"') -> str:
    """Return the map as an SVG element.

    Parameters
    ----------
    data
        As `ConfigurationSpace.drawing_data()` gives it.
    extra
        More elements, drawn on top in the picture's pixels.
    style
        CSS to carry inside, for a file of its own; without it the element belongs into a page.
    attributes
        Of the element, beside its class and view box.
    """
    shown = plot(data)
    a, b = (html.escape(p) for p in data["parts"])
    mark = zlib.crc32(repr((data["parts"], data["domain"], data["stats"], bool(style))).encode())
    tile, clip = f"tile-{mark:08x}", f"clip-{mark:08x}"
    left, top, wide, tall = shown.box
    area = f'x="{left}" y="{top}" width="{_text(wide)}" height="{_text(tall)}"'
    css = f"<style>{style}</style>" if style else ""
    space = 'xmlns="http://www.w3.org/2000/svg" ' if style else ""
    return (
        f'<svg {space}class="space" viewBox="{shown.view}" {attributes}>'
        f"<title>Configuration space of {a} and {b}</title><desc>{html.escape(said(data))}</desc>{css}"
        f'<defs><clipPath id="{clip}"><rect {area}/></clipPath>{_tile(data, shown, tile)}</defs>'
        f'<rect class="cs-blocked" {area}/><g clip-path="url(#{clip})">{_tiles(shown, tile)}'
        f"{_borders(data, shown)}{_marks(data, shown)}{extra}</g>{_axes(data, shown)}</svg>"
    )


def draw_space(data: Data) -> str:
    """Return the map as a file of its own, in light and in dark."""
    backdrop = "svg.space{background:var(--paper)}"
    return space_picture(data, style=variables("svg.space") + STYLE + backdrop)
