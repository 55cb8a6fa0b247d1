"""`mainspring cspace`: where two parts are free, where blocked, what touches."""

import json
from argparse import Namespace
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import mainspring as ms
from mainspring.cli import opening, output, tables, values
from mainspring.cli.faults import Usage
from mainspring.cli.progress import watch
from mainspring.cli.values import shortened
from mainspring.drawing.feature import kind_told, told
from mainspring.space import ConfigurationSpace
from mainspring.space_parts import Feature

SHOWN = 12  # curves in the table: a screen, not a scroll


def run(options: Namespace) -> None:
    """Make the map, draw it if asked for, print it with the answers to `--at` and `--slice`."""
    mechanism = opening.mechanism(options)
    parts = mechanism.outlines()["parts"]
    motions = {p["name"]: p["motion"]["kind"] for p in parts if p["motion"]}
    with watch("mapping", 1.0, share=True) as progress:
        space = ms.configuration_space(
            mechanism,
            options.a,
            options.b,
            coordinates=_coordinates(options.coordinates),
            window=_windows(options.window, motions),
            held=values.coordinates(options.hold, "--hold", motions),
            progress=progress,
        )
    own = {axis.coordinate: axis.motion for axis in space.domain}
    points = [_point(text, own) for text in options.at]
    slices = [_slice(text, own) for text in options.slice]
    opening.warn(ms.find_pairs(mechanism).warnings)
    written = _write(options, mechanism, space)
    if options.json:
        output.print_json(_json(space, points, slices))
        return
    words = _Words(space, {p["name"]: p for p in parts})
    account(space, words)
    for point in points:
        _tell_point(space, point, words)
    for name, value in slices:
        _tell_slice(space, name, value, words)
    for path in written:
        print(f"\nwrote {path}")


def _coordinates(text: str | None) -> tuple[str, str] | None:
    if text is None:
        return None
    names = [name.strip() for name in text.split(",")]
    if len(names) != 2 or not all(names):
        raise Usage(f"--coordinates {shortened(text)}: no two names; expected PART,PART")
    return names[0], names[1]


def _windows(texts: Iterable[str], motions: dict[str, str]) -> dict[str, tuple[float, float]]:
    found: dict[str, tuple[float, float]] = {}
    for text in texts:
        name, value = values.split(text, "--window")
        low, colon, high = value.partition(":")
        if not colon:
            raise Usage(
                f"--window {shortened(text)}: no range; expected PART=LOW:HIGH, such as lever=-10deg:20deg"
            )
        ends = [values.coordinates([f"{name}={v}"], "--window", motions) for v in (low, high)]
        part = next(iter(ends[0]))
        if ends[0][part] >= ends[1][part]:
            raise Usage(f"--window {shortened(text)}: no range; expected its end above its start")
        if part in found:
            raise Usage(f"--window {shortened(text)}: {part} is given twice; expected one range")
        found[part] = (ends[0][part], ends[1][part])
    return found


def _point(text: str, own: dict[str, str]) -> tuple[float, float]:
    found = values.coordinates(text.split(","), "--at", own, _by_place(own))
    if len(found) != 2:
        missing = next(name for name in own if name not in found)
        raise Usage(f"--at {shortened(text)}: no value of {missing}; expected both coordinates")
    a, b = (found[name] for name in own)
    return a, b


def _slice(text: str, own: dict[str, str]) -> tuple[str, float]:
    return next(iter(values.coordinates([text], "--slice", own, _by_place(own)).items()))


def _by_place(own: dict[str, str]) -> dict[str, str]:
    """Return the names `a` and `b` of the two coordinates."""
    return dict(zip("ab", own, strict=True))


def _write(options: Namespace, mechanism: "ms.Mechanism", space: ConfigurationSpace) -> list[str]:
    written = []
    if options.svg:
        output.write_text(Path(options.svg), space.svg() + "\n")
        written.append(options.svg)
    if options.html:
        from mainspring.report import space_page

        output.write_text(Path(options.html), space_page(mechanism, space))
        written.append(options.html)
    return written


def _json(
    space: ConfigurationSpace, points: list[tuple[float, float]], slices: list[tuple[str, float]]
) -> str:
    """Return the space's own text, with the answers added at its end."""
    more: dict[str, Any] = {}
    if points:
        more["at"] = [_answer(space, point) for point in points]
    if slices:
        more["slices"] = [
            {"coordinate": n, "value": v, "intervals": [i._asdict() for i in space.slice({n: v})]}
            for n, v in slices
        ]
    added = json.dumps(more, ensure_ascii=False)[1:-1]
    return space.to_json()[:-1] + (f",{added}" if added else "") + "}"


def _answer(space: ConfigurationSpace, point: tuple[float, float]) -> dict[str, Any]:
    gap = space.gap(point)
    features = _named(space, gap.features)
    return {
        "at": list(point),
        "free": space.is_free(point),
        "component": space.component(point),
        "gap": gap.gap if features else None,
        "features": [vars(f) for f in features],
    }


def _named(space: ConfigurationSpace, indices: tuple[int, int]) -> list[Feature]:
    if min(indices) < 0:
        return []
    return list(space.named(indices))


class _Words:
    """Positions and features of a space in words."""

    def __init__(self, space: ConfigurationSpace, parts: dict[str, Any]) -> None:
        self._motions = [axis.motion for axis in space.domain]
        self._names = space.coordinates
        self._parts = parts

    def place(self, point: Iterable[float]) -> str:
        """Return a configuration: name and position of both coordinates."""
        texts = (
            f"{n} {tables.coordinate(v, m)}"
            for n, v, m in zip(self._names, point, self._motions, strict=True)
        )
        return ", ".join(texts)

    def pair(self, point: Iterable[float]) -> str:
        """Return a configuration without names."""
        both = (tables.coordinate(v, m) for v, m in zip(point, self._motions, strict=True))
        return "(" + ", ".join(both) + ")"

    def one(self, value: float, axis: int) -> str:
        """Return a position of one coordinate."""
        return tables.coordinate(value, self._motions[axis])

    def other(self, name: str, value: float) -> str:
        """Return a position of a joint that is held."""
        return tables.coordinate(value, self._parts[name]["motion"]["kind"])

    def feature(self, feature: Feature) -> str:
        """Return which feature it is."""
        return told(self._parts, vars(feature))

    def kind(self, feature: Feature) -> str:
        """Return which feature of its part it is."""
        return kind_told(self._parts, vars(feature))

    def slope(self, slope: tuple[float, float] | None) -> str:
        """Return a range of slopes."""
        return " to ".join(tables.signed(v, 3) for v in slope) if slope else "upright"


def account(space: ConfigurationSpace, words: _Words) -> None:
    """Say what the map shows, then its components and curves."""
    print("\n".join(space._sentences()))
    for k, axis in enumerate(space.domain):
        again = (
            f", {axis.repeats} times in a turn" if axis.repeats > 1 else ", all round" if axis.period else ""
        )
        ends = f"from {words.one(axis.low, k)} to {words.one(axis.high, k)}"
        print(f"{axis.coordinate} {axis.motion}s {ends}{again}.")
    for name, angle in space.held.items():
        print(f"{name} is held at {words.other(name, angle)}.")
    for mark in space.marks:
        value = words.one(mark.value, space.coordinates.index(mark.coordinate))
        print(f"{mark.name} of {mark.coordinate}: {value}.")
    print("The start: " + _state(space, space.start, words))
    rows = (
        (str(c.id), str(c.copies), winds(space, c.winding), str(len(c.boundary)), words.pair(c.inside))
        for c in space.components
    )
    heads = ("component", "copies", "winds", "boundary cycles", "inside")
    tables.show("free space", heads, rows, numeric=(0, 1, 3))
    curves = ((str(c.id), words.slope(c.slope), *map(words.kind, c.features)) for c in space.curves[:SHOWN])
    a, b = space.parts
    tables.show("contact curves", ("curve", "slope", f"feature of {a}", f"of {b}"), curves, numeric=(0,))
    if len(space.curves) > SHOWN:
        print(f"and {len(space.curves) - SHOWN} more (all with --json)")
    print("\nwork: " + ", ".join(f"{k} {v}" for k, v in space.stats.items()))


def winds(space: ConfigurationSpace, generators: Iterable[tuple[int, int]]) -> str:
    """Say how the closed ways within a component wind."""
    names = [f"{a.coordinate}'s teeth" if a.repeats > 1 else a.coordinate for a in space.domain]
    said = (
        " and ".join(f"{tables.signed(n)} × {name}" for n, name in zip(pair, names, strict=True) if n)
        for pair in generators
    )
    return "; ".join(said) or "does not wind"


def _state(space: ConfigurationSpace, point: tuple[float, float], words: _Words) -> str:
    """Say whether a configuration is free, in which component, and what is nearest."""
    gap, component = space.gap(point), space.component(point)
    state = "blocked or in contact" if component is None else f"free, component {component}"
    if any(not a.period and not a.low <= v <= a.high for a, v in zip(space.domain, point, strict=True)):
        state = "outside the map"
    features = _named(space, gap.features)
    nearest = (
        f"; gap {tables.signed(gap.gap)}, {' – '.join(map(words.feature, features))}" if features else ""
    )
    return f"{words.place(point)}: {state}{nearest}."


def _tell_point(space: ConfigurationSpace, point: tuple[float, float], words: _Words) -> None:
    print("\n" + _state(space, point, words))
    play = space.play(point)
    for k, (low, high) in enumerate(play or ()):
        name = space.coordinates[k]
        if low == float("-inf"):
            print(f"  {name} can turn all round.")
        else:
            print(f"  {name} can move from {words.one(low, k)} to {words.one(high, k)}.")


def _tell_slice(space: ConfigurationSpace, name: str, value: float, words: _Words) -> None:
    k = space.coordinates.index(name)
    other = space.coordinates[1 - k]
    found = space.slice({name: value})

    rows = (
        (words.one(i.low, 1 - k), words.one(i.high, 1 - k), str(i.component), *map(_curve, i.curves))
        for i in found
    )
    again = space.domain[1 - k]
    note = f", within {words.one(again.period, 1 - k)}" if again.period and again.repeats > 1 else ""
    title = f"{other} is free at {name} {words.one(value, k)}{note}"
    heads = ("from", "to", "component", "bounded below by", "above by")
    if not found:
        print(f"\n{other} is nowhere free at {name} {words.one(value, k)}.")
    tables.show(title, heads, rows, numeric=(0, 1, 2))


def _curve(number: int | None) -> str:
    return "limit" if number is None else f"curve {number}"
