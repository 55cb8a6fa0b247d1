"""Draw the pictures of README, documentation and examples: machines, their spaces, the motion of one."""

import math
from pathlib import Path

import mainspring as ms
from mainspring.drawing import draw
from mainspring.report import motion_picture

ROOT = Path(__file__).resolve().parent.parent


def machine_picture(model: Path) -> str:
    """Return the drawing of a model, titled with the first line of its README."""
    title = (model.parent / "README.md").read_text(encoding="utf-8").splitlines()[0].lstrip("# ")
    return draw(ms.load(model).compile().outlines(), title=title) + "\n"


# The pairs drawn as NAME-space.svg, with ranges in degrees or lengths where the whole shows too little.
SPACES: dict[str, tuple[str, str, dict[str, tuple[float, float]]]] = {
    "escapement": ("ewheel", "lever", {}),
    "pawl-on-plate": ("frame", "pawl", {"pawl": (-12, 24)}),
    "ratchet": ("wheel", "pawl", {"pawl": (-4, 16)}),
    "rotary-to-reciprocating": ("wheel", "arm", {"arm": (-25, 50)}),
    "cam-flat-follower": ("cam", "follower", {"follower": (-14, 22)}),
    "cam-roller-follower": ("cam", "follower", {"follower": (-14, 22)}),
    "cam-swinging-follower": ("cam", "follower", {"follower": (-40, 30)}),
    "detent": ("wheel", "plunger", {"plunger": (-3, 9)}),
    "eccentric-discs": ("driver", "driven", {"driven": (-60, 60)}),
    "geneva-four": ("driver", "wheel", {}),
    "geneva-six": ("driver", "wheel", {}),
    "involute-gears": ("pinion", "wheel", {"pinion": (-20, 20), "wheel": (-14, 14)}),
    "pin-in-slot": ("crank", "lever", {"lever": (-30, 75)}),
    "ratchet-and-pawl": ("wheel", "pawl", {"pawl": (-20, 40)}),
    "scotch-yoke": ("crank", "yoke", {"yoke": (-60, 20)}),
}


def space_picture(model: Path) -> str:
    """Return the drawing of a machine's configuration space."""
    a, b, shown = SPACES[model.stem]
    mechanism = ms.load(model).compile()
    turns = {
        p["name"] for p in mechanism.outlines()["parts"] if p["motion"] and p["motion"]["kind"] == "turn"
    }
    unit = {name: math.radians(1) if name in turns else 1.0 for name in shown}
    window = {name: (low * unit[name], high * unit[name]) for name, (low, high) in shown.items()}
    return ms.configuration_space(mechanism, a, b, window=window).svg() + "\n"


def main() -> None:
    """Write NAME.svg and NAME-space.svg beside every model, and the pictures of the README."""
    models = [p for ending in ("padl", "toml") for p in (ROOT / "examples").glob(f"*/*.{ending}")]
    for model in sorted(p for p in models if p.stem == p.parent.name):
        model.with_suffix(".svg").write_text(machine_picture(model), encoding="utf-8")
        if model.stem in SPACES:
            drawn = space_picture(model)
            model.with_name(f"{model.stem}-space.svg").write_text(drawn, encoding="utf-8")
    escapement = ROOT / "examples" / "escapement" / "escapement.padl"
    mechanism = ms.load(escapement).compile()
    folder = ROOT / "docs" / "pictures"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "escapement.svg").write_text(machine_picture(escapement), encoding="utf-8")
    (folder / "space.svg").write_text(space_picture(escapement), encoding="utf-8")
    motion = motion_picture(mechanism, ms.predict(mechanism))
    (folder / "escapement-motion.svg").write_text(motion + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
