"""The same question answered with both models of contact."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from mainspring.result import Result, frozen, parse

T = TypeVar("T", bound=Result)

Constants = tuple[float, float, float]


@dataclass(frozen=True)
class Comparison(Result, Generic[T]):
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

    def _sentences(self) -> Iterable[str]:
        return self.sentences


def comparison_of(text: str, rigid: T, compliant: T) -> Comparison[T]:
    """Wrap what the core says of two results."""
    o = parse(text)
    return Comparison(
        status=o["status"],
        stats=frozen({"rigid": dict(rigid.stats), "compliant": dict(compliant.stats)}),
        _text=text,
        rigid=rigid,
        compliant=compliant,
        differences=frozen(o["differences"]),
        sentences=tuple(o["sentences"]),
    )
