"""The machine as one SVG: layers by depth, axes, springs, pitch circles."""

import html
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from mainspring.drawing.outline import Xy, number, path
from mainspring.drawing.palette import colour_class, variables
from mainspring.drawing.pose import Part, bounds, chain, part_points, placed
from mainspring.drawing.spring import shape

STYLE = (
    ".machine path,.machine circle,.machine line{vector-effect:non-scaling-stroke}"
    ".body{fill:color-mix(in srgb,var(--c) 26%,var(--paper));fill-opacity:.86;stroke:var(--c);"
    "stroke-width:1.3;stroke-linejoin:round}"
    ".pf .body{fill:color-mix(in srgb,var(--c) 13%,var(--paper));stroke-width:1}"
    ".plate .body{fill-opacity:.55;stroke-opacity:.55}"
    ".cover .body{fill-opacity:.1;stroke-dasharray:5 4}"
    ".axis{stroke:var(--ink);stroke-width:.8;fill:none}"
    ".slideway{stroke:var(--c);stroke-width:.8;stroke-dasharray:9 3 1.5 3;fill:none}"
    ".pitch{stroke:var(--c);stroke-width:1;stroke-dasharray:9 3 1.5 3;fill:none}"
    ".anchor{stroke:var(--frame);stroke-width:5;stroke-linecap:round}"
    ".spring{stroke:var(--c);stroke-width:1.1;fill:none;stroke-linejoin:round;stroke-linecap:round}"
)


@dataclass(frozen=True)
class Box:
    """The part of the plane a picture shows."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def view(self) -> str:
        """The SVG view box, y down."""
        numbers = (self.left, -self.top, self.right - self.left, self.top - self.bottom)
        return " ".join(map(number, numbers))

    @property
    def aspect(self) -> float:
        """Width over height."""
        return (self.right - self.left) / (self.top - self.bottom)


def frame_box(outlines: dict[str, Any], poses: Iterable[Mapping[str, float]]) -> Box:
    """Return a box around all poses and springs with a margin of three hundredths."""
    parts = {part["name"]: part for part in outlines["parts"]}
    forms = [shape(parts[s["part"]], s, outlines["size"]) for s in outlines["springs"]]
    held = [form.fixed for form in forms if form]
    left, bottom, right, top = bounds(outlines["parts"], poses, held)
    margin = 0.03 * max(right - left, top - bottom, 1e-12)
    return Box(left - margin, bottom - margin, right + margin, top + margin)


def colours(parts: list[Part]) -> dict[str, str]:
    """Return each part's colour class, in the order of the machine's moving parts."""
    moving = [part["name"] for part in parts if not part["frame"]]
    return {p["name"]: colour_class(None if p["frame"] else moving.index(p["name"])) for p in parts}


def _group(parts: list[Part], part: Part, kind: str, q: Mapping[str, float], inside: str) -> str:
    pose = placed({p["name"]: p for p in parts}, part["name"], q)
    attribute = f' transform="{pose}"' if pose else ""
    name = html.escape(part["name"], quote=True)
    return f'<g class="{kind}" data-part="{name}"{attribute}>{inside}</g>'


def _bodies(parts: list[Part], q: Mapping[str, float]) -> str:
    """Draw all layers of all parts from the lowest up."""
    colour = colours(parts)
    order = sorted(
        (layer["bottom"], layer["top"], index, depth)
        for index, part in enumerate(parts)
        for depth, layer in enumerate(part["layers"])
    )
    lowest = order[0][0] if order else 0.0
    moving = [layer["top"] for part in parts if not part["frame"] for layer in part["layers"]]
    cover = min(moving, default=math.inf)
    drawn = []
    for bottom, _, index, depth in order:
        part = parts[index]
        kind = f"part {colour[part['name']]}"
        if part["frame"] and bottom >= cover:
            kind += " cover"
        elif part["frame"] and bottom == lowest:
            kind += " plate"
        body = f'<path class="body" d="{path(part["layers"][depth]["loops"])}"/>'
        drawn.append(_group(parts, part, kind, q, body))
    return "".join(drawn)


def _carried(parts: list[Part], part: Part, q: Mapping[str, float], inside: str) -> str:
    """Put what stays on a part's carrier where the carrier is; nothing to do on the frame."""
    named, carrier = {p["name"]: p for p in parts}, part.get("carrier")
    if not carrier or not chain(named, carrier):
        return inside
    pose = placed(named, carrier, q)
    attribute = f' transform="{pose}"' if pose else ""
    return f'<g data-on="{html.escape(carrier, quote=True)}"{attribute}>{inside}</g>'


def _xy(p: Xy) -> str:
    return f"{number(p[0])} {number(p[1])}"


def _cross(center: list[float], arm: float) -> str:
    x, y = center
    h = f"M{number(x - arm)} {number(y)}H{number(x + arm)}"
    return f'<path class="axis" d="{h}M{number(x)} {number(y - arm)}V{number(y + arm)}"/>'


def _slideway(part: Part, size: float) -> str:
    dx, dy = part["motion"]["direction"]
    found = part_points(part)
    x, y = sum(p[0] for p in found) / len(found), sum(p[1] for p in found) / len(found)
    ends = [number(v) for v in (x - dx * size / 3, y - dy * size / 3, x + dx * size / 3, y + dy * size / 3)]
    return f'<path class="slideway" d="M{ends[0]} {ends[1]}L{ends[2]} {ends[3]}"/>'


def _axes(parts: list[Part], q: Mapping[str, float], size: float) -> str:
    colour = colours(parts)
    drawn = []
    for part in (p for p in parts if p["motion"]):
        if part["motion"]["kind"] == "turn":
            drawn.append(_carried(parts, part, q, _cross(part["motion"]["center"], 0.022 * size)))
        elif part_points(part):
            way = f'<g class="{colour[part["name"]]}">{_slideway(part, size)}</g>'
            drawn.append(_carried(parts, part, q, way))
    return "".join(drawn)


def _gears(parts: list[Part], q: Mapping[str, float]) -> str:
    colour = colours(parts)
    drawn = []
    for part in parts:
        for gear in part["gears"]:
            (x, y), r = gear["center"], gear["radius"]
            ring = f'<circle class="pitch" cx="{number(x)}" cy="{number(y)}" r="{number(r)}"/>'
            tick = f'<path class="pitch" d="M{number(x + 0.9 * r)} {number(y)}H{number(x + r)}"/>'
            drawn.append(_group(parts, part, f"part {colour[part['name']]}", q, ring + tick))
    return "".join(drawn)


def _springs(outlines: dict[str, Any], q: Mapping[str, float]) -> str:
    parts = {part["name"]: part for part in outlines["parts"]}
    colour = colours(outlines["parts"])
    drawn = []
    for index, spring in enumerate(outlines["springs"]):
        name = spring["part"]
        form = shape(parts[name], spring, outlines["size"])
        if form:
            curve = form.path(q.get(name, 0.0))
            part = html.escape(name, quote=True)
            kind = f'class="spring {colour[name]}" data-part="{part}" data-spring="{index}"'
            held = f'<path {kind} d="{curve}"/><path class="anchor" d="M{_xy(form.fixed)}h0"/>'
            drawn.append(_carried(outlines["parts"], parts[name], q, held))
    return "".join(drawn)


def described(outlines: dict[str, Any]) -> str:
    """Say in words what the drawing shows."""
    said = []
    for part in outlines["parts"]:
        motion = part["motion"]
        how = "is the frame" if part["frame"] else "has no pair with the frame"
        if motion and motion["kind"] == "turn":
            how = "turns about ({:.4g}, {:.4g})".format(*motion["center"])
        elif motion:
            how = "slides along ({:.4g}, {:.4g})".format(*motion["direction"])
        carrier = part.get("carrier")
        if motion and carrier and any(p["name"] == carrier and not p["frame"] for p in outlines["parts"]):
            how += f" on {carrier}"
        unseen = "" if part["layers"] else " and has no outline in this plane"
        said.append(f"{part['name']} {how}{unseen}")
    return "; ".join(said) + "."


def picture(
    outlines: dict[str, Any],
    *,
    title: str,
    poses: Iterable[Mapping[str, float]] = ({},),
    at: Mapping[str, float] | None = None,
    extra: str = "",
    style: str = "",
) -> str:
    """Return the drawing as an SVG element.

    Parameters
    ----------
    outlines
        As `Mechanism.outlines()` gives them.
    poses
        Joint positions that the picture must leave room for.
    at
        The joint positions shown.
    extra
        More elements, drawn on top in the machine's coordinates (y up).
    style
        CSS to carry inside, for a file of its own; without it the element belongs into a page.
    """
    parts, q = outlines["parts"], at or {}
    box = frame_box(outlines, [*poses, q])
    inside = _bodies(parts, q) + _gears(parts, q) + _springs(outlines, q) + _axes(parts, q, outlines["size"])
    css = f"<style>{style}</style>" if style else ""
    space = 'xmlns="http://www.w3.org/2000/svg" ' if style else ""
    return (
        f'<svg {space}class="machine" viewBox="{box.view}" role="img" '
        f'style="aspect-ratio:{number(box.aspect)}"><title>{html.escape(title)}</title>'
        f"<desc>{html.escape(described(outlines))}</desc>{css}"
        f'<g transform="scale(1 -1)">{inside}{extra}</g></svg>'
    )


def draw(outlines: dict[str, Any], *, title: str, at: Mapping[str, float] | None = None) -> str:
    """Return the drawing as a file of its own, in light and in dark."""
    backdrop = "svg.machine{background:var(--paper);max-height:90vh}"
    style = variables("svg.machine") + STYLE + backdrop
    return picture(outlines, title=title, at=at, style=style)
