"""Pictures of the very outlines that contact is computed with: plain data in, SVG text out."""

from mainspring.drawing.space import draw_space, space_picture
from mainspring.drawing.svg import draw, picture

__all__ = ["draw", "draw_space", "picture", "space_picture"]
