"""Reports: they only read results. One self-contained page, and pictures for documents."""

from mainspring.report.figure import motion_picture
from mainspring.report.page import page

__all__ = ["motion_picture", "page"]
