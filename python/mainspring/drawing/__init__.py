"""Pictures of the very outlines that contact is computed with: plain data in, SVG text out."""

from mainspring.drawing.svg import draw, picture

__all__ = ["draw", "picture"]
