"""Reports: they only read results. One self-contained page, and pictures for documents."""

from mainspring.report.figure import motion_picture
from mainspring.report.page import page
from mainspring.report.space_page import space_page

__all__ = ["motion_picture", "page", "space_page"]
