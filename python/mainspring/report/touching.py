"""What touches at each moment: marks to light, bars for the plots, arrows for forces."""

from dataclasses import dataclass, field
from typing import Any

from mainspring.drawing.feature import marked
from mainspring.report.sampling import Film
from mainspring.simulation import Trajectory

_MOST_MOMENTS = 3_500


@dataclass
class Touching:
    """Contacts along a film.

    Attributes
    ----------
    marks
        SVG paths (y up) with the part each moves with: `(part, path)`.
    moments
        For each time of `t` the contacts then: `[marks, x, y, nx, ny, force]` each.
    spans
        By pair of parts, the intervals `[from, to]` in which they touch.
    """

    marks: list[tuple[str, str]] = field(default_factory=list)
    moments: list[list[list[Any]]] = field(default_factory=list)
    spans: dict[tuple[str, ...], list[list[float]]] = field(default_factory=dict)


class Collector:
    """Builds a `Touching` moment by moment."""

    def __init__(self, outlines: dict[str, Any]) -> None:
        self._parts = {part["name"]: part for part in outlines["parts"]}
        self._digits = max(0, 4 - len(str(int(outlines["size"]))))
        self._known: dict[tuple[Any, ...], int] = {}
        self._open: dict[tuple[str, ...], list[float]] = {}
        self.found = Touching()

    def add(self, t: float, contacts: list[dict[str, Any]]) -> None:
        """Take in what touches at the next moment."""
        self.found.moments.append([self._record(c, p) for c in contacts for p in c["points"]])
        now = {tuple(sorted(c["parts"])) for c in contacts}
        for pair in now:
            if pair not in self._open:
                self._open[pair] = [t, t]
                self.found.spans.setdefault(pair, []).append(self._open[pair])
            self._open[pair][1] = t
        for pair in sorted(set(self._open) - now):
            del self._open[pair]

    def _record(self, contact: dict[str, Any], point: list[float]) -> list[Any]:
        marks = sorted({self._mark(f) for f in contact.get("features", ())} - {-1})
        x, y = (round(v, self._digits + 1) for v in point)
        force = contact.get("force")
        arrow = [round(v, 3) for v in contact["normal"]] + [float(f"{force:.4g}")] if force else []
        return [marks, x, y, *arrow]

    def _mark(self, feature: dict[str, Any]) -> int:
        key = tuple(feature.get(k) for k in ("part", "layer", "loop", "edge", "corner"))
        if key not in self._known:
            drawn = marked(self._parts, feature)
            self._known[key] = len(self.found.marks) if drawn else -1
            if drawn:
                self.found.marks.append((feature["part"], drawn))
        return self._known[key]


def touching(outlines: dict[str, Any], motion: Trajectory, film: Film) -> Touching:
    """Ask the motion what touches at every moment of the film (at most 3500 of them)."""
    collector = Collector(outlines)
    stride = -(-len(film.t) // _MOST_MOMENTS)
    last: list[dict[str, Any]] = []
    for index, t in enumerate(film.t.tolist()):
        if index % stride == 0:
            last = motion.contacts(t)
        collector.add(t, last)
    return collector.found
