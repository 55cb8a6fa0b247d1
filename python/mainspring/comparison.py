"""The same question answered with both models of contact."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from mainspring.result import Result, Written, frozen, parse

T = TypeVar("T", bound=Result)

Constants = tuple[float, float, float]


@dataclass(frozen=True)
class Comparison(Written, Generic[T]):
    """Both answers and how far they are apart; `status` is `agree` or `differ`.

    Attributes
    ----------
    rigid, compliant
        What either model says.
    differences
        Where and by how much they differ, compliant less rigid (docs/guide/json.md).
    sentences
        The same in plain words, angles in degrees.
    """

    rigid: T
    compliant: T
    differences: Mapping[str, Any]
    sentences: tuple[str, ...]
    _told: Callable[[bool], str] = field(repr=False)

    def to_json(self, *, timing: bool = False) -> str:
        """Return the JSON object of `--contact both --json`; `timing` adds the seconds each run took."""
        return self._told(True) if timing else self._text

    def _sentences(self) -> Iterable[str]:
        return self.sentences


def comparison_of(told: Callable[[bool], str], rigid: T, compliant: T) -> Comparison[T]:
    """Wrap what the core says of two results; `told(timing)` is its JSON text."""
    text = told(False)
    o = parse(text)
    return Comparison(
        status=o["status"],
        stats=frozen({"rigid": dict(rigid.stats), "compliant": dict(compliant.stats)}),
        _text=text,
        rigid=rigid,
        compliant=compliant,
        differences=frozen(o["differences"]),
        sentences=tuple(o["sentences"]),
        _told=told,
    )
