"""One self-contained page: a configuration space beside the machine where the pointer puts it."""

import json
from collections.abc import Iterable
from typing import Any

from mainspring.drawing import picture, space_picture
from mainspring.drawing.feature import kind_told, marked
from mainspring.drawing.palette import variables
from mainspring.drawing.pose import chain
from mainspring.drawing.space import STYLE as MAP_STYLE
from mainspring.drawing.space import Plot, Side, plot, said
from mainspring.drawing.svg import STYLE, colours
from mainspring.machine import Mechanism
from mainspring.report.page import asset
from mainspring.report.push import push
from mainspring.report.sections import section
from mainspring.report.words import coloured, escape, figure, position, table
from mainspring.space import ConfigurationSpace

_POSES = 12
_DIGITS = 6
_MOST_ROWS = 400

_MAP = (
    'id="map" role="application" tabindex="0" aria-roledescription="map of configurations" '
    'aria-describedby="how"'
)
_HINT = (
    '<p class="hint" id="how">Space pushes the first part; the other stays until touched and then yields. '
    "Point at the map, or touch it, to put the machine there; a click holds it. "
    "With the map in focus arrows move (with Shift ten times as far), C goes to the nearest contact, S to "
    "the start, Escape lets go. What is nearest to touching is lit.</p>"
)


def space_page(mechanism: Mechanism, space: ConfigurationSpace) -> str:
    """Return the page of a configuration space as one HTML text that needs nothing else."""
    data = space.drawing_data()
    outlines = data["outlines"]
    colour = colours(outlines["parts"])
    shown = plot(data)
    marks = _Marks(outlines)
    curves = [_curve(c, marks) for c in data["curves"]]
    lines = '<path class="trail" d=""/><path class="toward" d=""/>'
    dot = lines + '<circle class="near" r="4.5"/><circle class="here" r="5.5"/>'
    drawn = space_picture(data, extra=dot, attributes=_MAP)
    film = push(space)
    # Springs would have to follow; in kinematics nothing pulls.
    machine = picture(
        {**outlines, "springs": []}, title=mechanism.name, poses=_poses(data, shown), extra=marks.drawn()
    )
    body = (
        f'<header><p class="eyebrow">{escape(mechanism.name)}</p>{_headline(data, colour)}</header>'
        f'<div class="pair"><figure class="chart">{drawn}</figure>'
        f'<figure class="stage">{machine}</figure></div>{_readout(data, film)}{_HINT}'
        + _components(space, colour)
        + _contacts(space, data)
        + _colophon(space)
    )
    return _document(
        f"{mechanism.name}: {' and '.join(space.parts)}", body, _script_data(data, shown, curves, film)
    )


class _Marks:
    """Features to light, each once."""

    def __init__(self, outlines: dict[str, Any]) -> None:
        self._parts = {part["name"]: part for part in outlines["parts"]}
        self._known: dict[str, int] = {}
        self._paths: list[tuple[str, str]] = []

    def add(self, feature: dict[str, Any]) -> int:
        """Return the number of a feature's mark; -1 for one that is not in the drawing."""
        key = json.dumps(feature, sort_keys=True)
        if key not in self._known:
            path = marked(self._parts, feature)
            self._known[key] = len(self._paths) if path else -1
            if path:
                self._paths.append((feature["part"], path))
        return self._known[key]

    def drawn(self) -> str:
        """Return all marks, hidden, grouped by the part they move with."""
        return "".join(
            f'<g data-part="{escape(part)}"><path class="touch" data-mark="{i}" d="{path}"/></g>'
            for i, (part, path) in enumerate(self._paths)
        )


def _curve(curve: dict[str, Any], marks: _Marks) -> dict[str, Any]:
    """Return what the script needs of a curve: points, marks to light, words true of all its copies."""
    points = [[float(f"{x:.{_DIGITS}g}") for x in p] for p in curve["points"]]
    features = curve["features"]
    return {
        "p": points,
        "m": [marks.add(f) for f in features],
        "t": " and ".join(f"{f['part']}'s {f['kind']}" for f in features),
    }


def _span(side: Side) -> list[float]:
    return [side.low + side.span * k / (_POSES - 1) for k in range(_POSES)]


def _poses(data: dict[str, Any], shown: Plot) -> Iterable[dict[str, float]]:
    """Return poses that leave room for all the map shows."""
    for a in _span(shown.x):
        for b in _span(shown.y):
            yield _pose(data, (a, b))


def _pose(data: dict[str, Any], at: tuple[float, float]) -> dict[str, float]:
    moved = {m["part"]: m["ratio"] * at[m["axis"]] for m in data["moves"]}
    return {**data["others"], **moved}


def _headline(data: dict[str, Any], colour: dict[str, str]) -> str:
    first, *rest = said(data).split(": ", 1)
    lines = [f"<h1>{coloured(first, colour)}</h1>"]
    lines += [f"<p>{coloured(r[:1].upper() + r[1:], colour)}</p>" for r in rest]
    return "".join(lines)


def _readout(data: dict[str, Any], film: dict[str, Any] | None) -> str:
    first = escape(data["coordinates"][0])
    play = f'<button id="play" title="push {first} (Space)">▶ push {first}</button>' if film else ""
    buttons = play + (
        '<button id="to-start" title="to the start (S)">start</button>'
        '<button id="to-contact" title="to the nearest contact (C)">nearest contact</button>'
    )
    return (
        f'<div class="controls readout"><output id="where" aria-live="polite">{escape(said(data))}</output>'
        f"{buttons}</div>"
    )


def _winds(space: ConfigurationSpace, generators: Iterable[tuple[int, int]]) -> str:
    """Say how the closed ways within a component wind."""
    names = [f"{axis.coordinate}{' tooth' if axis.repeats > 1 else ''}" for axis in space.domain]
    told_ = []
    for pair in generators:
        steps = [f"{figure(n)} × {name}" for n, name in zip(pair, names, strict=True) if n]
        told_.append(" and ".join(steps))
    return "; ".join(told_) or "does not wind"


def _components(space: ConfigurationSpace, colour: dict[str, str]) -> str:
    motions = [axis.motion for axis in space.domain]
    rows = []
    for c in space.components:
        at = " and ".join(position(v, m) for v, m in zip(c.inside, motions, strict=True))
        edges = sum(len(b.edges) for b in c.boundary)
        rows.append(
            (
                str(c.id),
                escape(str(c.copies)),
                coloured(_winds(space, c.winding), colour),
                f"{len(c.boundary)} of {edges} stretches",
                escape(at),
            )
        )
    inside = " and ".join(space.coordinates)
    heads = ("component", "copies in a turn", "winds", "boundary cycles", f"inside, at {inside}")
    return section("Free space", table(heads, rows, (0, 1), stack=False)) if rows else ""


def _contacts(space: ConfigurationSpace, data: dict[str, Any]) -> str:
    """List the curves by what touches."""
    parts = {p["name"]: p for p in data["outlines"]["parts"]}
    motions = [axis.motion for axis in space.domain]
    rows = []
    for curve in data["curves"][:_MOST_ROWS]:
        ends = (
            " ".join(position(v, m) for v, m in zip(curve[k], motions, strict=True)) for k in ("from", "to")
        )
        slope = " to ".join(figure(v, 3) for v in curve["slope"]) if curve["slope"] else "upright"
        features = (escape(kind_told(parts, f)) for f in curve["features"])
        rows.append((str(curve["id"]), *features, *map(escape, ends), escape(slope)))
    a, b = space.parts
    heads = ("curve", f"feature of {a}", f"feature of {b}", "from", "to", "slope")
    more = len(data["curves"]) - len(rows)
    note = f"<p>And {more} more.</p>" if more else ""
    return section("Contact curves", table(heads, rows, (0,), stack=False) + note) if rows else ""


def _colophon(space: ConfigurationSpace) -> str:
    counts = ", ".join(f"{escape(k.replace('_', ' '))} {escape(v)}" for k, v in space.stats.items())
    return (
        f"<footer><p>Made with {counts}. Angles in degrees, lengths in the file's unit; curves are drawn to "
        "a few ten-thousandths of the map and computed to rounding.</p><p>Made by Mainspring; the outlines "
        "drawn are those the contacts were computed with.</p></footer>"
    )


def _script_data(
    data: dict[str, Any], shown: Plot, curves: list[dict[str, Any]], film: dict[str, Any] | None
) -> str:
    parts = {p["name"]: p for p in data["outlines"]["parts"]}
    chains = {name: [p["name"] for p in chain(parts, name)] for name in parts}
    sides = (shown.x, shown.y)
    made = {
        "box": list(shown.box),
        "axes": [
            {
                "name": side.name,
                "turns": side.turns,
                "view": [side.low, side.high],
                "tile": [axis["low"], axis["high"]],
                "period": axis["period"],
            }
            for side, axis in zip(sides, data["domain"], strict=True)
        ],
        "curves": curves,
        "start": data["start"]["at"],
        "chains": {name: names for name, names in chains.items() if names},
        "motions": {p["name"]: _motion(p) for p in parts.values() if p["motion"]},
        "moves": {m["part"]: [m["axis"], m["ratio"]] for m in data["moves"]},
        "others": data["others"],
        "parts": data["parts"],
        "tiles": data["tiles"],
        "film": film,
    }
    return json.dumps(made, separators=(",", ":"), ensure_ascii=False).replace("</", "<\\/")


def _motion(part: dict[str, Any]) -> dict[str, Any]:
    motion = part["motion"]
    return {"kind": motion["kind"], "at": motion["center" if motion["kind"] == "turn" else "direction"]}


def _document(title: str, body: str, data: str) -> str:
    style = variables() + STYLE + MAP_STYLE + asset("page.css") + asset("space.css")
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{escape(title)} – configuration space</title><style>{style}</style></head>\n"
        f"<body><main>{body}</main>\n"
        f'<script type="application/json" id="space">{data}</script>\n'
        f"<script>{asset('space.js')}</script></body></html>\n"
    )
