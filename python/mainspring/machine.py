"""Machines as people edit them, and mechanisms as algorithms take them."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike, fspath
from typing import Any

from mainspring import _core
from mainspring.drawing import draw
from mainspring.result import frozen, pairs_of, parse


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
    """

    name: str
    value: float | None
    range: tuple[float, float] | None


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
        return parse(self._inner.drawing_json())

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

    def _repr_html_(self) -> str:
        """Draw the machine as written in a notebook."""
        return self.compile()._repr_html_()


def load(model: str | PathLike[str], supplement: str | PathLike[str] | None = None) -> Machine:
    """Read a model file (`*.padl`) and its supplement (`*.sup`).

    Parameters
    ----------
    model
        Path of the model.
    supplement
        Path of the supplement; None looks for the model's name with the ending `.sup` beside it.

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what was expected.

    Notes
    -----
    The language is that of Gelsey 1995, Figs. 12 and 13 (docs/guide/padl.md).
    """
    core = _core.load(fspath(model), None if supplement is None else fspath(supplement))
    found = [
        Parameter(p["name"], p["value"], tuple(p["range"]) if p["range"] else None)
        for p in json.loads(core.parameters_json())
    ]
    return Machine(core.name, tuple(found), core)
