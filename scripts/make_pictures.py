"""Draw the pictures of README, documentation and examples: shipped machines, and the motion of one."""

from pathlib import Path

import mainspring as ms
from mainspring.drawing import draw
from mainspring.report import motion_picture

ROOT = Path(__file__).resolve().parent.parent


def machine_picture(model: Path) -> str:
    """Return the drawing of a model, titled with the first line of its README."""
    title = (model.parent / "README.md").read_text(encoding="utf-8").splitlines()[0].lstrip("# ")
    return draw(ms.load(model).compile().outlines(), title=title) + "\n"


def main() -> None:
    """Write NAME.svg beside every model, and the two pictures of the README."""
    models = [p for ending in ("padl", "toml") for p in (ROOT / "examples").glob(f"*/*.{ending}")]
    for model in sorted(p for p in models if p.stem == p.parent.name):
        model.with_suffix(".svg").write_text(machine_picture(model), encoding="utf-8")
    escapement = ROOT / "examples" / "escapement" / "escapement.padl"
    mechanism = ms.load(escapement).compile()
    folder = ROOT / "docs" / "pictures"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "escapement.svg").write_text(machine_picture(escapement), encoding="utf-8")
    motion = motion_picture(mechanism, ms.predict(mechanism))
    (folder / "escapement-motion.svg").write_text(motion + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
