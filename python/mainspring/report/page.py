"""One self-contained page: the answer in a sentence, the machine in motion, the numbers behind it."""

from importlib.resources import files

from mainspring.comparison import Comparison
from mainspring.drawing import picture
from mainspring.drawing.palette import variables
from mainspring.drawing.svg import STYLE, colours
from mainspring.machine import Mechanism
from mainspring.pairs import find_pairs
from mainspring.prediction import Prediction
from mainspring.report import plots, sections
from mainspring.report.data import script_data, touch_marks
from mainspring.report.sampling import Film, beside_film, film
from mainspring.report.touching import Touching, touching
from mainspring.report.words import escape, name
from mainspring.simulation import Simulation

_MOST_POSES = 40

Either = Simulation | Prediction
Shown = Either | Comparison[Simulation] | Comparison[Prediction]


def asset(file: str) -> str:
    """Return a file that pages carry inside."""
    return (files("mainspring.report") / "assets" / file).read_text(encoding="utf-8")


def _poses(shown: Film) -> list[dict[str, float]]:
    """Return poses that span the motion, to leave room for it."""
    stride = max(1, len(shown.t) // _MOST_POSES)
    return [dict(zip(shown.parts, row, strict=True)) for row in shown.q[::stride].tolist()]


def _run(result: Either) -> Simulation:
    return result.simulation if isinstance(result, Prediction) else result


def _plots(
    shown: Film,
    run: Simulation,
    other: Simulation | None,
    touched: Touching,
    motions: dict[str, str],
    colour: dict[str, str],
) -> str:
    time = plots.time_axis(shown)
    beside = beside_film(shown, other) if other else None
    panels = [plots.panel(c, shown, time) for c in plots.curves(shown, motions, colour, beside)]
    minima = list(run.kinetic_energy_minima)
    note = f" <small>{plots.energy_note(shown, len(minima))}</small>"
    panels.append(plots.panel(plots.energy_curve(shown), shown, time, minima, note))
    for pair, spans in sorted(touched.spans.items()):
        blows = [e.t for e in run.events if e.kind == "impact" and tuple(sorted(e.parts)) == pair]
        label = " touches ".join(name(p, colour) for p in pair)
        panels.append(plots.lane(" and ".join(pair), label, spans, blows[:2000], time))
    band = ""
    if shown.loop:
        a, b = (time.share(t) for t in shown.loop)
        band = f'<div class="band" style="--a:{a:.5f};--b:{b:.5f}"><span>one pattern</span></div>'
    cursor = '<div class="cursor" aria-hidden="true"></div>'
    return f'<div class="plots" id="plots">{band}{"".join(panels)}{plots.time_labels(time)}{cursor}</div>'


def _controls(shown: Film) -> str:
    end = float(shown.t[-1])
    loop = '<label><input type="checkbox" id="loop" checked> loop one pattern</label>' if shown.loop else ""
    return (
        '<div class="controls" role="group" aria-label="animation">'
        '<button id="back" aria-label="one step back" title="step back (←)">‹</button>'
        '<button id="play" aria-label="play" title="play or pause (Space)">▶</button>'
        '<button id="forth" aria-label="one step forth" title="step forth (→)">›</button>'
        f'<input id="scrub" type="range" min="0" max="{end:.6g}" step="any" value="0" aria-label="time">'
        '<output id="clock" aria-live="off">0.00 s</output>'
        '<label>speed <select id="speed"></select></label>'
        f"{loop}</div>"
    )


_HINT = (
    '<p class="hint">Space plays, arrows step (with Shift to the next blow), digits set the speed, '
    "L loops one pattern. Drag across the plots to move the machine; what touches is lit, and at rest arrows "
    "show contact forces where they are known.</p>"
)


def page(mechanism: Mechanism, result: Shown) -> str:
    """Return the report of a run or a prediction as one HTML text that needs nothing else.

    Parameters
    ----------
    mechanism
        The mechanism that was run.
    result
        What `simulate` or `predict` returned for it. Of two models of contact the page shows the motion with
        rigid contact, dashed beside it that with compliant contact.
    """
    both = result if isinstance(result, Comparison) else None
    main: Either = result.rigid if isinstance(result, Comparison) else result
    other = _run(both.compliant) if both else None
    run = _run(main)
    outlines, found = mechanism.outlines(), find_pairs(mechanism)
    colour = colours(outlines["parts"])
    motions = {p["name"]: p["motion"]["kind"] for p in outlines["parts"] if p["motion"]}
    shown = film(main)
    touched = touching(outlines, run.trajectory, shown)
    title = f"{mechanism.name} in motion"
    drawing = picture(outlines, title=title, poses=_poses(shown), extra=touch_marks(touched))
    machine = f'<figure class="stage">{drawing}{_controls(shown)}</figure>'
    body = (
        f'<header><p class="eyebrow">{escape(mechanism.name)}</p>{sections.headline(result, colour)}</header>'
        f'<div class="motion">{machine}{_plots(shown, run, other, touched, motions, colour)}</div>{_HINT}'
        + sections.warnings(found)
        + (sections.differences(both, motions, colour) if both else "")
        + sections.pattern(main, motions, colour)
        + sections.pairs(found, colour)
        + sections.energy(run)
        + (sections.energy(other) if other else "")
        + sections.hypotheses(main)
        + sections.colophon(found, run, other)
    )
    data = script_data(outlines, shown, touched, run)
    return _document(mechanism.name, body, data)


def _document(title: str, body: str, data: str) -> str:
    style = variables() + STYLE + asset("page.css")
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{escape(title)} – what it will do</title><style>{style}</style></head>\n"
        f"<body><main>{body}</main>\n"
        f'<script type="application/json" id="film">{data}</script>\n'
        f"<script>{asset('player.js')}</script></body></html>\n"
    )
