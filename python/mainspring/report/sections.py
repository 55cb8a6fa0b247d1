"""The parts of the page that are words and tables."""

import math
from collections.abc import Mapping

from mainspring import counting
from mainspring.comparison import Comparison
from mainspring.pairs import Axis, Kinematics, Pair
from mainspring.prediction import Hypothesis, Prediction
from mainspring.report.words import coloured, escape, figure, name, table
from mainspring.result import Result, counted
from mainspring.simulation import Simulation

Colour = Mapping[str, str]


def section(title: str, *pieces: str) -> str:
    """Return a titled section; nothing when it would be empty."""
    inside = "".join(pieces)
    return f"<section><h2>{escape(title)}</h2>{inside}</section>" if inside else ""


def headline(result: Result, colour: Colour) -> str:
    """Return the answer: the first sentence large, the others after it."""
    said = list(result._sentences())
    rest = "".join(f"<p>{coloured(s, colour)}</p>" for s in said[1:])
    return f"<h1>{coloured(said[0], colour)}</h1>{rest}" if said else ""


def _names(parts: tuple[str, ...], colour: Colour) -> str:
    return " – ".join(name(p, colour) for p in parts)


def _axis(axis: Axis | None) -> str:
    if not axis:
        return ""
    point = ", ".join(figure(v, 4) for v in axis.point)
    along = ", ".join(figure(v, 4) for v in axis.direction)
    return f"({point}) along ({along})"


def _pair_row(pair: Pair, colour: Colour) -> tuple[str, str, str, str]:
    kind = escape(pair.kind)
    if pair.shape_kind != pair.kind:
        kind += f"<br><small>by shape {escape(pair.shape_kind)}</small>"
    where = _axis(pair.axis) if pair.ratio is None else f"ratio {figure(pair.ratio)}"
    why = "".join(f"<li>{escape(e)}</li>" for e in counted(pair.evidence))
    return _names(pair.parts, colour), kind, where, f"<ul>{why}</ul>"


def pairs(found: Kinematics, colour: Colour) -> str:
    """Tell which parts constrain each other and why, what nearly did, and what can touch."""
    rows = [_pair_row(p, colour) for p in found.pairs]
    listed = table(("parts", "pair", "axis", "why"), rows) if rows else "<p>No pairs were found.</p>"
    touching = [_names(i, colour) for i in found.interactions]
    can = f"<p>Can ever touch: {', '.join(touching) or 'nothing'}.</p>"
    misses = [(_names(n.parts, colour), escape(n.why)) for n in found.near_misses]
    missed = "<h3>Alike, but no pair</h3>" + table(("parts", "why not"), misses) if misses else ""
    return section("How it can move, and how that was found", can, listed, missed)


def _amount(value: float, turns: bool, per: str) -> str:
    if not turns:
        return figure(value, 5) + per
    return figure(round(math.degrees(value), 3), 6) + "°" + per


def pattern(result: Simulation | Prediction, motions: Mapping[str, str], colour: Colour) -> str:
    """Tell what one pattern changes."""
    if not isinstance(result, Prediction) or not result.pattern:
        return ""
    p = result.pattern
    rows = []
    for part, change in p.change.items():
        turns = motions.get(part) == "turn"
        amounts = (_amount(change["position"], turns, ""), _amount(change["velocity"], turns, "/s"))
        rows.append((name(part, colour), *amounts))
    said = f"<p>Every {figure(p.duration)} s, with {counting.minima(p.minima, p.basis)}:</p>"
    heads = ("part", "position changes by", "velocity changes by")
    return section("What one pattern changes", said, table(heads, rows, (1, 2)))


def differences(
    both: Comparison[Simulation] | Comparison[Prediction], motions: Mapping[str, str], colour: Colour
) -> str:
    """Tell where and by how much two models of contact differ."""
    d = both.differences
    said = (
        "<p>Dashed beside the curves: the same with compliant contact. "
        "Differences are compliant less rigid.</p>"
    )
    constants = ", ".join(f"{k} {figure(v)}" for k, v in d["constants"].items())
    law = f"<p>Compliant contact: {constants}.</p>"

    def amount(part: str, value: float) -> str:
        return _amount(value, motions.get(part) == "turn", "")

    if "positions" in d:
        heads = ("part", "greatest difference", "at", "where the compared stretch ends")
        rows = [
            (name(p, colour), amount(p, x["greatest"]), f"{figure(x['at'])} s", amount(p, x["end"]))
            for p, x in d["positions"].items()
        ]
        return section("Where the models of contact differ", said, table(heads, rows, (1, 2, 3)), law)
    if not d["change"]:
        return section("Where the models of contact differ", said, law)
    lasts = d["duration"]
    compared = (
        f"<p>One pattern lasts {figure(lasts['rigid'], 8)} s with rigid contact and "
        f"{figure(lasts['compliant'], 8)} s with compliant contact.</p>"
    )
    changes = [(name(p, colour), amount(p, x)) for p, x in d["change"].items()]
    listed = table(("part", "change in one pattern differs by"), changes, (1,))
    return section("Where the models of contact differ", said, compared, listed, law)


def _hypothesis_row(h: Hypothesis) -> tuple[str, str, str, str]:
    fell = "holds" if h.fell is None else f"{figure(h.fell)} s"
    return str(h.minima), f"{figure(h.formed)} s", fell, escape(h.why or "")


def hypotheses(result: Simulation | Prediction) -> str:
    """Tell which patterns were tried."""
    if not isinstance(result, Prediction) or not result.hypotheses:
        return ""
    rows = [_hypothesis_row(h) for h in result.hypotheses]
    return section("What was tried", table(("minima", "formed at", "fell at", "why"), rows, (0, 1, 2)))


def _bar(amount: float, whole: float) -> str:
    if whole <= 0:
        return ""
    width = 100 * min(1.0, max(0.0, amount / whole))
    return f'<span class="share"><i style="width:{width:.2f}%"></i></span> {width:.1f}&nbsp;%'


def energy(run: Simulation) -> str:
    """Return the energy account: what was there, where it went, how well it closes."""
    e = run.energy
    lost = e.friction + e.impacts
    rows = [
        ("at the start", figure(e.initial, 8), ""),
        *([("done by drives and torques", figure(e.work, 8), "")] if e.work else []),
        ("lost to friction", figure(e.friction, 8), _bar(e.friction, lost)),
        (
            "lost in contacts" if run.contact else "lost at impacts",
            figure(e.impacts, 8),
            _bar(e.impacts, lost),
        ),
        *([("stored in contacts", figure(e.contact_stored, 8), "")] if run.contact else []),
        ("at the end", figure(e.final, 8), ""),
    ]
    closes = (
        f"<p>The account closes to {figure(abs(e.residual), 2)} of what was lost or at most in motion.</p>"
    )
    title = "Where the energy went, with compliant contact" if run.contact else "Where the energy went"
    return section(title, table(("", "energy", "of the losses"), rows, (1,)), closes)


def warnings(found: Kinematics) -> str:
    """Repeat what the analysis warned of."""
    lines = "".join(f"<li>{escape(w)}</li>" for w in found.warnings)
    return section("Warnings", f"<ul>{lines}</ul>") if lines else ""


def _made(run: Simulation) -> str:
    counts = ", ".join(f"{escape(k.replace('_', ' '))} {escape(v)}" for k, v in run.stats.items())
    model = "Compliant contact" if run.contact else "Rigid contact"
    return f"{model}, {figure(run.t)} s simulated: {counts}. "


def colophon(found: Kinematics, run: Simulation, other: Simulation | None = None) -> str:
    """Say how the page was made: work counted, units, sources."""
    named = ", ".join(f"{escape(k)} {escape(v)}" for k, v in found.units.items() if v and k != "angle")
    units = f"Units: {named}" if named else "Lengths, masses and times are in the file's own units"
    return (
        f"<footer><p>{_made(run)}{_made(other) if other else ''}"
        f"{units}; angles in degrees.</p>"
        "<p>Method: A. Gelsey, Automated reasoning about machines, Artificial Intelligence 74 (1995) 1–53, "
        "with corrections. Made by Mainspring; the outlines drawn are those the contacts were "
        "computed with.</p></footer>"
    )
