"""Check the documentation: every link leads somewhere, every page can be reached, every key is told.

Anchors within pages are checked against their headings, as GitHub forms them.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
_LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)|(?:src|href)=\"([^\"]+)\"")
_FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
_SKIP = {".git", ".venv", "target", "node_modules", "mainspring-demo"}


def pages() -> list[Path]:
    """Return all Markdown pages of the repository."""
    found = ROOT.rglob("*.md")
    return sorted(p for p in found if not _SKIP & set(p.relative_to(ROOT).parts) and not _linked(p))


def _linked(page: Path) -> bool:
    return any(parent.is_symlink() for parent in page.parents if ROOT in parent.parents)


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings."""
    found = set()
    for line in _FENCE.sub("", page.read_text(encoding="utf-8")).splitlines():
        if line.startswith("#"):
            text = re.sub(r"[^\w\- ]", "", line.lstrip("# ").lower())
            found.add(text.strip().replace(" ", "-"))
    return found


def links(page: Path) -> list[str]:
    """Return the local links of a page."""
    text = _FENCE.sub("", page.read_text(encoding="utf-8"))
    found = [a or b for a, b in _LINK.findall(text)]
    return [link for link in found if not re.match(r"[a-z]+:", link)]


def faults(page: Path, reached: set[Path]) -> list[str]:
    """Return what is wrong with a page's links and note which pages they reach."""
    wrong = []
    for link in links(page):
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        if not target.exists():
            wrong.append(f"{page.relative_to(ROOT)}: {link} leads nowhere")
            continue
        reached.add(target)
        if anchor and target.suffix == ".md" and anchor not in anchors(target):
            wrong.append(f"{page.relative_to(ROOT)}: {link} names no heading")
    return wrong


def main() -> int:
    """Print what is wrong; return how the check ended."""
    reached = {ROOT / "README.md"}
    wrong = [fault for page in pages() for fault in faults(page, reached)]
    docs = [p for p in pages() if (ROOT / "docs") in p.parents]
    wrong += [f"{p.relative_to(ROOT)}: no page links here" for p in docs if p not in reached]
    print("\n".join(wrong) or f"documentation: {len(pages())} pages, all links lead somewhere")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
