"""What the page's player needs, as compact JSON."""

import json
from typing import Any

from mainspring.drawing.outline import number
from mainspring.drawing.pose import chain
from mainspring.drawing.spring import shape
from mainspring.report.sampling import Film
from mainspring.report.touching import Touching
from mainspring.simulation import Simulation

_MOST_BLOWS = 4_000


def _motion(part: dict[str, Any]) -> dict[str, Any]:
    motion = part["motion"]
    kind = motion["kind"]
    return {"kind": kind, "at": motion["center" if kind == "turn" else "direction"]}


def _chains(outlines: dict[str, Any]) -> dict[str, list[str]]:
    """Return for every part that moves the parts whose motions it follows, from the frame outwards."""
    parts = {part["name"]: part for part in outlines["parts"]}
    found = {name: [part["name"] for part in chain(parts, name)] for name in parts}
    return {name: names for name, names in found.items() if names}


def _springs(outlines: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the drawn springs with the index the drawing gave them."""
    parts = {part["name"]: part for part in outlines["parts"]}
    found = []
    for index, spring in enumerate(outlines["springs"]):
        form = shape(parts[spring["part"]], spring, outlines["size"])
        if form:
            found.append({"index": index, "part": spring["part"], **form.data()})
    return found


def script_data(outlines: dict[str, Any], film: Film, touching: Touching, run: Simulation) -> str:
    """Return the film as JSON that is safe inside a script element."""
    blows = [e.t for e in run.events if e.kind == "impact"][:_MOST_BLOWS]
    data = {
        "size": outlines["size"],
        "parts": list(film.parts),
        "chains": _chains(outlines),
        "motions": {p["name"]: _motion(p) for p in outlines["parts"] if p["motion"]},
        "springs": _springs(outlines),
        "t": [round(t, 5) for t in film.t.tolist()],
        "q": [[round(x, 5) for x in column] for column in film.q.T.tolist()],
        "k": [float(f"{k:.3g}") for k in film.kinetic.tolist()],
        "touch": touching.moments,
        "blows": [round(t, 5) for t in blows],
        "loop": film.loop,
    }
    return json.dumps(data, separators=(",", ":"), ensure_ascii=False).replace("</", "<\\/")


def touch_marks(touching: Touching) -> str:
    """Return the features that ever touch, as hidden marks grouped by the part they move with."""
    drawn = []
    for index, (part, path) in enumerate(touching.marks):
        safe = part.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
        drawn.append(f'<g data-part="{safe}"><path class="touch" data-mark="{index}" d="{path}"/></g>')
    return "".join(drawn) + '<g class="arrows"></g>'


def arrow_length(size: float) -> str:
    """Return the length of the longest force arrow."""
    return number(0.12 * size)
