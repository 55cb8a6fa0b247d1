"""Machines as people edit them, and mechanisms as algorithms take them."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike, fspath
from typing import Any

from mainspring import _core
from mainspring.drawing import draw
from mainspring.result import frozen, pairs_of
from mainspring.result import parse as parse_json


@dataclass(frozen=True)
class Parameter:
    """A numeric definition of the model file, in the file's units.

    Attributes
    ----------
    name
        As first written in the file.
    value
        Its value as written; None where it depends on parameters that cannot be evaluated.
    range
        `(low, high)` when the file states one.
    whole
        Only whole numbers are allowed.
    unit, meaning
        As a TOML file states them; None where it does not.
    """

    name: str
    value: float | None
    range: tuple[float, float] | None
    whole: bool = False
    unit: str | None = None
    meaning: str | None = None


@dataclass(frozen=True)
class Mechanism:
    """A machine at fixed parameters, analysed; what `find_pairs`, `simulate` and `predict` take.

    Attributes
    ----------
    name
        The machine's name.
    set
        The parameters that were set, by name; the others have the file's values.
    """

    name: str
    set: Mapping[str, float]
    _inner: _core.Mechanism = field(repr=False)

    def outlines(self) -> dict[str, Any]:
        """Return the planar outlines that contact is computed with (lines and true arcs).

        The keys are those of `drawing` in docs/guide/json.md; lengths in the file's unit.
        """
        return parse_json(self._inner.drawing_json())

    def _repr_html_(self) -> str:
        """Draw the machine in a notebook."""
        return draw(self.outlines(), title=self.name)


@dataclass(frozen=True)
class Machine:
    """What a model file and its supplement say.

    Attributes
    ----------
    name
        The generic's name in the file.
    parameters
        Its numeric definitions in the order of the text.
    """

    name: str
    parameters: tuple[Parameter, ...]
    _inner: _core.Machine = field(repr=False)

    def compile(
        self,
        parameters: Mapping[str, float] | None = None,
        /,
        *,
        pair_clearance: float = 0.0,
        keep_axial: bool = False,
        **values: float,
    ) -> Mechanism:
        """Evaluate the shapes at these parameters and find out how the parts can move.

        Parameters
        ----------
        parameters, **values
            Parameters by name, in the file's units (degrees for angles); the others keep their value.
        pair_clearance
            Largest difference of radii, in the file's length, at which shaft and hole still pair.
        keep_axial
            Keep the axial freedom of cylindrical pairs that nothing ever pushes along.

        Raises
        ------
        InputError
            For an unknown name, a value outside its range, or shapes that make no machine.
        """
        values = {**(parameters or {}), **values}
        core = self._inner.compile(pairs_of(values), float(pair_clearance), bool(keep_axial))
        return Mechanism(self.name, frozen(values), core)

    def with_parameters(self, parameters: Mapping[str, float] | None = None, /, **values: float) -> "Machine":
        """Return the machine with these values written into its text (TOML machines only)."""
        return parse(self.to_toml(parameters, **values), f"{self.name}.toml")

    def to_toml(self, parameters: Mapping[str, float] | None = None, /, **values: float) -> str:
        """Return the machine's text with these values in it; comments and all else stay as they are.

        Raises
        ------
        InputError
            For a machine in PADL, an unknown name, a value outside its range.
        """
        return self._inner.text_with(pairs_of({**(parameters or {}), **values}))

    def save(
        self, path: str | PathLike[str], parameters: Mapping[str, float] | None = None, /, **values: float
    ) -> None:
        """Write `to_toml` to a file, whole or not at all."""
        self._inner.save(fspath(path), pairs_of({**(parameters or {}), **values}))

    def _repr_html_(self) -> str:
        """Draw the machine as written in a notebook."""
        return self.compile()._repr_html_()


def load(model: str | PathLike[str], supplement: str | PathLike[str] | None = None) -> Machine:
    """Read a machine: a model (`*.padl`) and its supplement (`*.sup`), or one TOML file (`*.toml`).

    Parameters
    ----------
    model
        Path of the model; its ending says which language it is in.
    supplement
        Path of the supplement; None looks for the model's name with the ending `.sup` beside it.

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what was expected.

    Notes
    -----
    The language of PADL is that of Gelsey 1995, Figs. 12 and 13 (docs/guide/padl.md); for TOML see
    docs/guide/toml.md.
    """
    return _machine(_core.load(fspath(model), None if supplement is None else fspath(supplement)))


def parse(text: str, name: str = "machine.toml") -> Machine:
    """Read a machine from a text; the ending of `name`, which errors show, says which language it is in."""
    return _machine(_core.parse(text, name))


def _machine(core: _core.Machine) -> Machine:
    def parameter(p: dict[str, Any]) -> Parameter:
        interval = tuple(p["range"]) if p["range"] else None
        return Parameter(p["name"], p["value"], interval, p["whole"], p["unit"], p["meaning"])

    return Machine(core.name, tuple(map(parameter, json.loads(core.parameters_json()))), core)
