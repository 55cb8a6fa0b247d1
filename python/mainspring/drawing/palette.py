"""One colour, one part: the same in the drawing, the plots and the text, in light and in dark.

The hues stay apart under the common kinds of colour blindness (after Okabe and Ito's set), are dark
enough for text on the page, and leave red to touching features alone.
"""

LIGHT = ("#1769aa", "#8f6000", "#0b7a5e", "#7d4fa8", "#5f6b1f", "#a3486f", "#2b7f93", "#6b5344")
DARK = ("#62b0ee", "#f0b640", "#45c8a0", "#bb9be6", "#b9c55a", "#ea94b8", "#67c6da", "#c4a893")

_LIGHT = {
    "paper": "#ffffff",
    "ink": "#1b1e22",
    "soft": "#646a72",
    "hair": "#d9dce0",
    "wash": "#f4f5f7",
    "frame": "#8b9198",
    "accent": "#d4183d",
}
_DARK = {
    "paper": "#14161a",
    "ink": "#e8eaed",
    "soft": "#9aa1aa",
    "hair": "#33383f",
    "wash": "#1d2025",
    "frame": "#7c838c",
    "accent": "#ff4f6d",
}


def _rules(colours: tuple[str, ...], named: dict[str, str]) -> str:
    rules = [f"--{name}:{value}" for name, value in named.items()]
    rules += [f"--p{i}:{value}" for i, value in enumerate(colours)]
    return ";".join(rules)


def variables(scope: str = ":root") -> str:
    """Return the CSS variables of both schemes, chosen by the reader's system."""
    classes = "".join(f".p{i}{{--c:var(--p{i})}}" for i in range(len(LIGHT)))
    light = f"{scope}{{color-scheme:light dark;{_rules(LIGHT, _LIGHT)}}}"
    dark = f"@media screen and (prefers-color-scheme:dark){{{scope}{{{_rules(DARK, _DARK)}}}}}"
    return f"{light}{dark}{classes}.pf{{--c:var(--frame)}}"


def colour_class(index: int | None) -> str:
    """Return the CSS class of the moving part with this index; None is the frame."""
    return "pf" if index is None else f"p{index % len(LIGHT)}"
