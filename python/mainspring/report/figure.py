"""The motion as one picture for documents: stacked plots over one time axis, words beside the lines."""

import html

from mainspring.drawing.palette import variables
from mainspring.drawing.svg import colours
from mainspring.drawing.ticks import Axis
from mainspring.machine import Mechanism
from mainspring.prediction import Prediction
from mainspring.report.plots import Curve, curves, energy_curve, line, time_axis
from mainspring.report.sampling import film
from mainspring.simulation import Simulation

_WIDTH, _ROW, _GAP = 900, 92, 22
_LEFT, _RIGHT, _TOP, _BOTTOM = 58, 16, 26, 30
_FONT = "system-ui,-apple-system,'Segoe UI',Roboto,Arial,sans-serif"
_STYLE = (
    f"svg.motion{{background:var(--paper);font:13px {_FONT}}}"
    ".grid{stroke:var(--hair)}.curve{stroke:var(--c);fill:none;stroke-width:1.8;stroke-linejoin:round}"
    ".tick{fill:var(--soft);font-size:11.5px}.label{fill:var(--c);font-weight:600}"
    ".pk{--c:var(--ink)}.pk .curve{stroke-width:1.2}.dot{fill:var(--ink)}.band{fill:var(--ink);opacity:.055}"
)


def _row(curve: Curve, path: str, top: float, dots: str) -> str:
    wide = _WIDTH - _LEFT - _RIGHT
    marks = []
    for value, text in curve.axis.marks:
        y = _ROW * (1 - curve.axis.share(value))
        marks.append(f'<path class="grid" d="M0 {y:.1f}H{wide}"/>')
        marks.append(f'<text class="tick" x="-8" y="{y + 4:.1f}" text-anchor="end">{text}</text>')
    title = f'<text class="label" x="6" y="-6">{html.escape(curve.title)}</text>'
    return (
        f'<g class="{curve.kind}" transform="translate({_LEFT} {top:.1f})">{"".join(marks)}'
        f'<path class="curve" d="{path}"/>{dots}{title}</g>'
    )


def _times(time: Axis, top: float) -> str:
    wide = _WIDTH - _LEFT - _RIGHT
    texts = (
        f'<text class="tick" x="{_LEFT + wide * time.share(v):.1f}" y="{top:.1f}" '
        f'text-anchor="middle">{text}</text>'
        for v, text in time.marks
    )
    return "".join(texts)


def motion_picture(mechanism: Mechanism, result: Simulation | Prediction) -> str:
    """Return positions and kinetic energy against time as an SVG file, in light and in dark.

    The plots are those of Gelsey 1995, Fig. 2; one pattern is shaded once there is one.
    """
    run = result.simulation if isinstance(result, Prediction) else result
    outlines = mechanism.outlines()
    shown = film(result)
    motions = {p["name"]: p["motion"]["kind"] for p in outlines["parts"] if p["motion"]}
    time, wide = time_axis(shown), _WIDTH - _LEFT - _RIGHT
    rows = [*curves(shown, motions, colours(outlines["parts"])), energy_curve(shown)]
    drawn = []
    for index, curve in enumerate(rows):
        top = _TOP + index * (_ROW + _GAP)
        path = line(shown.t, curve.values, time, curve.axis, wide, _ROW)
        dots = "".join(
            f'<circle class="dot" cx="{wide * time.share(t):.1f}" cy="{_ROW - 3}" r="3"/>'
            for t in (run.kinetic_energy_minima if curve.kind == "pk" else ())
        )
        drawn.append(_row(curve, path, top, dots))
    bottom = _TOP + len(rows) * (_ROW + _GAP)
    band = ""
    if shown.loop:
        a, b = (_LEFT + wide * time.share(t) for t in shown.loop)
        band = f'<rect class="band" x="{a:.1f}" y="8" width="{b - a:.1f}" height="{bottom - 18:.1f}" rx="4"/>'
    height = bottom + _BOTTOM - _GAP
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="motion" viewBox="0 0 {_WIDTH} {height}" role="img">'
        f"<title>{html.escape(mechanism.name)}: positions and kinetic energy against time</title>"
        f"<style>{variables('svg.motion')}{_STYLE}</style>{band}{''.join(drawn)}{_times(time, bottom)}</svg>"
    )
