"""What all results share: a status, counts of work, the JSON text they were made from."""

import html
import json
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any


@dataclass(frozen=True)
class Result(ABC):
    """A frozen answer.

    Attributes
    ----------
    status
        One word that says how the computation ended; each function documents its own.
    stats
        Counts of the work done, by name. Never times: equal input gives equal bytes.
    """

    status: str
    stats: Mapping[str, Any]

    @abstractmethod
    def to_json(self) -> str:
        """Return the whole result as one JSON object, as the command line prints with `--json`.

        Keys and their order are stable (docs/guide/json.md); radians and the file's units.
        """

    def _sentences(self) -> Iterable[str]:
        """Say the result in plain sentences."""
        return (self.status.replace("_", " "),)

    def _repr_html_(self) -> str:
        """Show sentences, then counts, in a notebook."""
        said = "".join(f"<p><strong>{html.escape(s)}</strong></p>" for s in self._sentences())
        counts = ", ".join(f"{html.escape(k)}&nbsp;{v}" for k, v in self.stats.items())
        return f"<div>{said}<p><small>{counts}</small></p></div>"


@dataclass(frozen=True)
class Written(Result):
    """A frozen answer read from its JSON text."""

    _text: str = field(repr=False)

    def to_json(self) -> str:
        """Return the whole result as one JSON object, as the command line prints with `--json`.

        Keys and their order are stable (docs/guide/json.md); radians and the file's units.
        """
        return self._text


def parse(text: str) -> dict[str, Any]:
    """Return the JSON object of a result."""
    value = json.loads(text)
    assert isinstance(value, dict)
    return value


def frozen(values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a read-only copy that keeps the order."""
    return MappingProxyType(dict(values))


def counted(lines: Iterable[str]) -> list[str]:
    """Return each different line once, in order, and how often it came."""
    times: dict[str, int] = {}
    for line in lines:
        times[line] = times.get(line, 0) + 1
    return [line if n == 1 else f"{line} ({n} times)" for line, n in times.items()]


def pairs_of(values: Mapping[str, float] | None) -> list[tuple[str, float]]:
    """Return names and numbers as the core takes them."""
    return [(name, float(value)) for name, value in (values or {}).items()]
