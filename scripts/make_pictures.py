"""Draw the pictures of README and documentation: the shipped escapement and its motion."""

from pathlib import Path

import mainspring as ms
from mainspring.drawing import draw
from mainspring.report import motion_picture

ROOT = Path(__file__).resolve().parent.parent


def main() -> None:
    """Write escapement.svg and escapement-motion.svg."""
    mechanism = ms.load(ROOT / "examples" / "escapement" / "escapement.padl").compile()
    folder = ROOT / "docs" / "pictures"
    folder.mkdir(parents=True, exist_ok=True)
    drawing = draw(mechanism.outlines(), title="The escapement of Gelsey 1995, Fig. 12")
    (folder / "escapement.svg").write_text(drawing + "\n", encoding="utf-8")
    motion = motion_picture(mechanism, ms.predict(mechanism))
    (folder / "escapement-motion.svg").write_text(motion + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
