"""Contact features in the drawing: as a path to light, and in words."""

from collections.abc import Mapping
from typing import Any

from mainspring.drawing.outline import Segment, edge_path, number, start
from mainspring.drawing.pose import Part


def segment_of(parts: Mapping[str, Part], feature: Mapping[str, Any]) -> Segment | None:
    """Return the drawn segment of a feature, or nothing if it is not in the drawing."""
    try:
        loops = parts[feature["part"]]["layers"][feature["layer"]]["loops"]
        found: Segment = loops[feature["loop"]][feature["edge"]]
    except (KeyError, IndexError, TypeError):
        return None
    return found


def marked(parts: Mapping[str, Part], feature: Mapping[str, Any]) -> str:
    """Return a feature's path (y up, as modelled), or nothing if it is not in the drawing."""
    segment = segment_of(parts, feature)
    if segment is None:
        return ""
    if not feature["corner"]:
        return edge_path(segment)
    x, y = start(segment)
    return f"M{number(x)} {number(y)}h0"


def _place(p: Any) -> str:  # noqa: ANN401
    return "(" + ", ".join(f"{v + 0.0:.3g}".replace("-", "−") for v in p) + ")"


def told(parts: Mapping[str, Part], feature: Mapping[str, Any]) -> str:
    """Say which feature it is: its part, its kind, and where it is as modelled."""
    return f"{feature['part']} {kind_told(parts, feature)}"


def kind_told(parts: Mapping[str, Part], feature: Mapping[str, Any]) -> str:
    """Say which feature of its part it is: its kind, and where it is as modelled."""
    segment = segment_of(parts, feature)
    if segment is None:
        return str(feature.get("kind", "feature"))
    if feature["corner"]:
        return f"corner {_place(start(segment))}"
    if segment["kind"] == "line":
        return f"edge {_place(segment['from'])} to {_place(segment['to'])}"
    kind = "arc" if segment["convex"] else "hollow arc"
    return f"{kind} about {_place(segment['center'])}, radius {segment['radius']:.3g}"
