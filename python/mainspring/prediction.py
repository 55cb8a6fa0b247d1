"""What a mechanism will do for ever (Gelsey 1995, Algorithm 12)."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, overload

from mainspring import _core
from mainspring.comparison import Comparison, Constants, comparison_of
from mainspring.machine import Mechanism
from mainspring.result import Written, frozen, pairs_of, parse
from mainspring.simulation import Simulation, result_of

MAX_MINIMA = 1000
MAX_TIME = 100_000.0


@dataclass(frozen=True)
class Pattern:
    """What repeats: `minima` M, `duration` D, `change` of every coordinate by part.

    `change[part]` has `position` and `velocity`, in radians or the file's length. `basis` tells which
    points of the motion were compared: `kinetic_energy_minima`, `prominent_minima` or `whole_turns`.
    """

    minima: int
    duration: float
    change: Mapping[str, Mapping[str, float]]
    basis: str


@dataclass(frozen=True)
class Hypothesis:
    """A pattern that was tried: its number of minima, when it was formed, when and why it fell."""

    minima: int
    formed: float
    fell: float | None
    why: str | None


@dataclass(frozen=True)
class Prediction(Written):
    """What will happen; `status` is `repeats`, `comes_to_rest`, `no_pattern` or `stopped`.

    Attributes
    ----------
    reason
        Why there is no pattern: `constant_kinetic_energy`, `max_minima`, `max_time`,
        `step_limit`, `jammed` (a drive against what cannot give way), `too_deep` (overlaps beyond what
        compliant contact can stand for); else None.
    pattern
        None unless it repeats.
    starts
        Where the last instance of the pattern, or the rest, starts: `t`, `positions`, `velocities`.
    rest
        If it comes to rest: `t`, `jammed` (a spring still drives it), `held_by` (contacts); else None.
    simulated_seconds
        How much of the motion had to be simulated to know.
    hypotheses
        Everything that was tried, in order.
    sentences
        The answer in plain words, angles in degrees.
    simulation
        The simulated stretch that the answer rests on.
    """

    reason: str | None
    pattern: Pattern | None
    starts: Mapping[str, Any] | None
    rest: Mapping[str, Any] | None
    simulated_seconds: float
    hypotheses: tuple[Hypothesis, ...]
    sentences: tuple[str, ...]
    simulation: Simulation

    def _sentences(self) -> Iterable[str]:
        return self.sentences


def _pattern(o: dict[str, Any] | None) -> Pattern | None:
    if not o:
        return None
    change = frozen({part: frozen(values) for part, values in o["change"].items()})
    return Pattern(o["minima"], o["duration"], change, o["basis"])


def prediction_of(core: _core.Prediction) -> Prediction:
    """Wrap a prediction of the core."""
    text = core.json()
    o = parse(text)
    simulation = result_of(core.run())
    return Prediction(
        status=o["status"],
        stats=frozen(o["stats"]),
        _text=text,
        reason=o["reason"],
        pattern=_pattern(o["pattern"]),
        starts=frozen(o["starts"]) if o["starts"] else None,
        rest=frozen(o["rest"]) if o["rest"] else None,
        simulated_seconds=o["simulated_seconds"],
        hypotheses=tuple(Hypothesis(h["minima"], h["formed"], h["fell"], h["why"]) for h in o["hypotheses"]),
        sentences=tuple(o["sentences"]),
        simulation=simulation,
    )


@overload
def predict(
    mechanism: Mechanism,
    *,
    contact: Literal["rigid", "compliant"] = "rigid",
    contact_constants: Constants | None = None,
    rtol: float | None = None,
    positions: Mapping[str, float] | None = None,
    velocities: Mapping[str, float] | None = None,
    confirm: int = 2,
    range_fraction: float = 1e-5,
    ignore: int = 4,
    time_match: float = 0.01,
    state_match: float = 0.02,
    max_minima: int = MAX_MINIMA,
    max_time: float = MAX_TIME,
    search: Literal["direct", "map"] = "direct",
    progress: Callable[[float], bool] | None = None,
) -> Prediction: ...
@overload
def predict(
    mechanism: Mechanism,
    *,
    contact: Literal["both"],
    contact_constants: Constants | None = None,
    rtol: float | None = None,
    positions: Mapping[str, float] | None = None,
    velocities: Mapping[str, float] | None = None,
    confirm: int = 2,
    range_fraction: float = 1e-5,
    ignore: int = 4,
    time_match: float = 0.01,
    state_match: float = 0.02,
    max_minima: int = MAX_MINIMA,
    max_time: float = MAX_TIME,
    search: Literal["direct", "map"] = "direct",
    progress: Callable[[float], bool] | None = None,
) -> Comparison[Prediction]: ...
def predict(
    mechanism: Mechanism,
    *,
    contact: str = "rigid",
    contact_constants: Constants | None = None,
    rtol: float | None = None,
    positions: Mapping[str, float] | None = None,
    velocities: Mapping[str, float] | None = None,
    confirm: int = 2,
    range_fraction: float = 1e-5,
    ignore: int = 4,
    time_match: float = 0.01,
    state_match: float = 0.02,
    max_minima: int = MAX_MINIMA,
    max_time: float = MAX_TIME,
    search: Literal["direct", "map"] = "direct",
    progress: Callable[[float], bool] | None = None,
) -> Prediction | Comparison[Prediction]:
    """Simulate just long enough to know what repeats, or that nothing does.

    Parameters
    ----------
    contact, contact_constants, rtol, positions, velocities, search, progress
        As for `simulate`.
    confirm
        P_confirm: a pattern must hold for so many more repetitions.
    range_fraction
        P_range_fraction: minima count below this fraction of the largest kinetic energy so far.
    ignore
        P_ignore: so many first minima are start-up and do not count.
    time_match
        P_t_match: allowed difference of durations, relative to the pattern's.
    state_match
        P_s_v_match: allowed difference of changes, relative to the range within one pattern.
    max_minima, max_time
        Give up there, with status `no_pattern`.

    Raises
    ------
    InputError
        As for `simulate`; fractions lie above 0 and up to 1.

    Notes
    -----
    Gelsey 1995, Algorithm 12, with the corrections told in docs/theory/patterns.md.
    """

    def run(model: str) -> tuple[_core.Prediction, Prediction]:
        core = mechanism._inner.predict(
            contact=model,
            contact_constants=contact_constants,
            rtol=None if rtol is None else float(rtol),
            positions=pairs_of(positions),
            velocities=pairs_of(velocities),
            p_confirm=confirm,
            p_range_fraction=range_fraction,
            p_ignore=ignore,
            p_t_match=time_match,
            p_s_v_match=state_match,
            max_minima=max_minima,
            max_time=float(max_time),
            search=search,
            progress=progress,
        )
        return core, prediction_of(core)

    if contact != "both":
        return run(contact)[1]
    (a, rigid), (b, compliant) = run("rigid"), run("compliant")
    return comparison_of(lambda _: _core.compare_predictions(a, b), rigid, compliant)
