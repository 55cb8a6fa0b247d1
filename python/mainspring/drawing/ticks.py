"""Round numbers for axes: decimals, angles people use, seconds to days."""

import math
from dataclasses import dataclass

_ANGLES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 45, 90, 180, 360, 720, 1800, 3600, 7200)
_CLOCK = (("s", 1.0), ("min", 60.0), ("h", 3600.0), ("d", 86400.0))


@dataclass(frozen=True)
class Axis:
    """A range of values shown, and its marks."""

    low: float
    high: float
    marks: tuple[tuple[float, str], ...]

    def share(self, value: float) -> float:
        """Return where a value lies, 0 at the low end, 1 at the high end."""
        return (value - self.low) / (self.high - self.low)


def minus(text: str) -> str:
    """Return a number's text with a real minus sign."""
    return text.replace("-", "−")


def round_step(span: float, most: int) -> float:
    """Return the smallest 1, 2 or 5 times a power of ten that needs at most so many steps."""
    raw = span / most
    power = 10.0 ** math.floor(math.log10(raw))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= raw * (1 - 1e-9))


def _multiples(low: float, high: float, step: float) -> list[float]:
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [k * step for k in range(first, min(last, first + 1000) + 1)]


def _spread(low: float, high: float) -> tuple[float, float]:
    """Return the range with a little air; a constant gets room around it."""
    if high - low < 1e-9 * max(abs(low), abs(high), 1e-6):
        pad = max(abs(low) * 0.1, 1e-3)
        return low - pad, high + pad
    pad = 0.08 * (high - low)
    return low - pad, high + pad


def lengths(low: float, high: float, most: int = 4) -> Axis:
    """Return an axis of plain numbers."""
    low, high = _spread(low, high)
    return Axis(low, high, length_marks(low, high, most))


def angle_marks(low: float, high: float, most: int = 9) -> tuple[tuple[float, str], ...]:
    """Return round angles within a range of radians, with their text in degrees."""
    span = math.degrees(high - low)
    step = next((a for a in _ANGLES if span / a <= most), None) or round_step(span, most)
    degrees = _multiples(math.degrees(low), math.degrees(high), step)
    return tuple((math.radians(v), minus(f"{v + 0.0:.6g}°")) for v in degrees)


def length_marks(low: float, high: float, most: int = 6) -> tuple[tuple[float, str], ...]:
    """Return round numbers within a range, with their text."""
    step = round_step(high - low, most)
    return tuple((v, minus(f"{v + 0.0:.6g}")) for v in _multiples(low, high, step))


def angles(low: float, high: float, most: int = 5) -> Axis:
    """Return an axis of radians marked in degrees; small motions get room so that noise stays small."""
    low, high = _spread(low, high)
    return Axis(low, high, angle_marks(low, high, most))


def times(low: float, high: float, most: int = 10) -> Axis:
    """Return a time axis in seconds, minutes, hours or days, whichever gives short numbers."""
    unit, seconds = next(((u, s) for u, s in reversed(_CLOCK) if high - low >= 3 * s), _CLOCK[0])
    step = round_step((high - low) / seconds, most) if high > low else 1.0
    marks = [(v * seconds, f"{v:.6g}") for v in _multiples(low / seconds, high / seconds, step)]
    if marks:
        marks[-1] = (marks[-1][0], f"{marks[-1][1]} {unit}")
    return Axis(low, max(high, low + 1e-12), tuple(marks))


_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def decades(deepest: int, step: int = 2) -> Axis:
    """Return a logarithmic axis from 10^deepest to 1, in powers of ten."""
    marks = [
        (float(k), "1" if k == 0 else "10" + str(k).translate(_RAISED)) for k in range(0, deepest - 1, -step)
    ]
    return Axis(float(deepest) - 0.4, 0.4, tuple(marks))
