"""The motion of a mechanism over a stretch of time."""

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mainspring import _core, counting
from mainspring.comparison import Comparison, Constants, comparison_of
from mainspring.machine import Mechanism
from mainspring.result import Result, frozen, pairs_of, parse

Floats = NDArray[np.float64]


class State(NamedTuple):
    """Positions `q` and velocities `v`, each `(parts,)` or `(n, parts)`; radians or the file's length."""

    q: Floats
    v: Floats


@dataclass(frozen=True)
class Trajectory:
    """A motion, known at every instant.

    Attributes
    ----------
    parts
        The moving parts: the order of the columns.
    t
        Accepted step and event times, `(n,)`.
    q, v
        Positions and velocities there, `(n, parts)`; after the blow at an impact.
    """

    parts: tuple[str, ...]
    _run: _core.Run = field(repr=False)

    @cached_property
    def t(self) -> Floats:
        """Accepted step and event times, `(n,)`."""
        return self._run.times()

    @cached_property
    def _states(self) -> State:
        return State(*self._run.sample(self.t))

    @property
    def q(self) -> Floats:
        """Positions at the times `t`, `(n, parts)`, in radians or the file's length."""
        return self._states.q

    @property
    def v(self) -> Floats:
        """Velocities at the times `t`, `(n, parts)`; after the blow at an impact."""
        return self._states.v

    def at(self, t: ArrayLike) -> State:
        """Evaluate the motion at any times within the run, to the accuracy of the run itself.

        Contacts that are closed stay so to `rtol` (1e-7 at the loosest) times the machine's size.

        Parameters
        ----------
        t
            One time or `(m,)` times, from 0 to the end of the run (later, too, where it ended at rest).

        Returns
        -------
        State
            `q` and `v`, `(parts,)` for one time, `(m, parts)` for several.

        Raises
        ------
        ValueError
            For a time at which the motion is not known.
        """
        times = np.atleast_1d(np.asarray(t, dtype=np.float64))
        q, v = self._run.sample(times)
        return State(q, v) if np.ndim(t) else State(q[0], v[0])

    def kinetic_energy(self, t: Floats) -> Floats:
        """Return the kinetic energy of everything that moves at the times `t`, `(n,)`."""
        return self._run.kinetic_energy(np.asarray(t, dtype=np.float64))

    def contacts(self, t: float) -> list[dict[str, Any]]:
        """Return what touches at an instant: parts, points, normal and force (docs/guide/json.md)."""
        found: list[dict[str, Any]] = json.loads(self._run.contacts_at(float(t)))
        return found


@dataclass(frozen=True)
class Event:
    """An `impact`, `close` or `release` of a contact; `impulse` in mass units times velocity units.

    `stop` is `lower` or `upper` for the stop of a joint, else None.
    """

    t: float
    kind: str
    parts: tuple[str, ...]
    impulse: float | None
    moving_together: tuple[tuple[str, ...], ...]
    stop: str | None = None


@dataclass(frozen=True)
class Energy:
    """The energy account of a run; losses positive.

    `work` is what drives and constant torques did; with compliant contact `impacts` is what contacts took,
    and `contact_stored` what overlaps hold at the end; `residual` is (initial + work - final -
    contact_stored - friction - impacts) / max(friction + impacts, kinetic_max).
    """

    initial: float
    final: float
    work: float
    friction: float
    impacts: float
    kinetic_max: float
    residual: float
    contact_stored: float = 0.0


_ENDED = {
    "complete": "Ran for {} s.",
    "at_rest": "Came to rest after {} s and stays there.",
    "step_limit": "Met the limit of steps after {} s.",
    "jammed": "After {} s a drive runs against parts that cannot give way.",
    "too_deep": "After {} s parts overlap by more than compliant contact can stand for.",
    "stopped": "Was stopped after {} s.",
}


@dataclass(frozen=True)
class Simulation(Result):
    """A simulated stretch.

    `status` is `complete`, `at_rest`, `jammed`, `too_deep`, `step_limit` or `stopped`.

    Attributes
    ----------
    advice
        What to do when it ended early; else None.
    t
        Where it ended.
    positions, velocities
        The state there, by part; radians or the file's length.
    kinetic_energy_minima
        Times of the minima that Algorithm 12 of Gelsey 1995 would count.
    events
        What happened at contacts, in order.
    forces
        When asked for: for each instant at which something changed, `t` and `contacts` just after it,
        as `Trajectory.contacts` gives them; else None.
    contact
        Constants E, D, M of compliant contact; None with rigid contact.
    """

    advice: str | None
    t: float
    positions: Mapping[str, float]
    velocities: Mapping[str, float]
    kinetic_energy_minima: tuple[float, ...]
    energy: Energy
    contact: Mapping[str, float] | None
    trajectory: Trajectory

    # The long lists are read when asked for: a run takes less time than they do.
    @property
    def events(self) -> tuple[Event, ...]:
        """What happened at contacts, in order."""
        return self._lists[0]

    @property
    def forces(self) -> tuple[Mapping[str, Any], ...] | None:
        """Contact forces where something changed, or None if they were not asked for."""
        return self._lists[1]

    @cached_property
    def _lists(self) -> tuple[tuple[Event, ...], tuple[Mapping[str, Any], ...] | None]:
        o = parse(self._text)
        forces = tuple(map(frozen, o["forces"])) if "forces" in o else None
        return tuple(map(_event_of, o["events"])), forces

    @cached_property
    def _text(self) -> str:
        return self.trajectory._run.json(False)

    def _sentences(self) -> Iterable[str]:
        yield _ENDED.get(self.status, self.status).format(f"{self.t:.6g}")
        changes = sum(e.kind != "impact" for e in self.events)
        struck = counting.impacts(self.stats["impacts"], len(self.events) - changes)
        yield (
            f"{struck}, {counting.number_of(changes, 'contact change')}; "
            f"the energy account closes to {abs(self.energy.residual):.0e}."
        )

    def to_json(self, *, timing: bool = False) -> str:
        """Return the JSON object of `mainspring simulate --json`; `timing` adds the seconds it took."""
        return self.trajectory._run.json(True) if timing else self._text


def _event_of(e: Mapping[str, Any]) -> Event:
    together = tuple(map(tuple, e["moving_together"]))
    return Event(e["t"], e["kind"], tuple(e["parts"]), e["impulse"], together, e.get("stop"))


def result_of(run: _core.Run) -> Simulation:
    """Wrap a run of the core."""
    o = parse(run.brief_json())
    return Simulation(
        status=o["status"],
        stats=frozen(o["stats"]),
        advice=o["advice"],
        t=o["t"],
        positions=frozen(o["positions"]),
        velocities=frozen(o["velocities"]),
        kinetic_energy_minima=tuple(o["kinetic_energy_minima"]),
        energy=Energy(**o["energy"]),
        contact=frozen(o["contact"]) if "contact" in o else None,
        trajectory=Trajectory(tuple(run.parts), run),
    )


@overload
def simulate(
    mechanism: Mechanism,
    until: float,
    *,
    contact: Literal["rigid", "compliant"] = "rigid",
    contact_constants: Constants | None = None,
    rtol: float | None = None,
    positions: Mapping[str, float] | None = None,
    velocities: Mapping[str, float] | None = None,
    forces: bool = False,
    max_steps: int | None = None,
    search: Literal["direct", "map"] = "direct",
    progress: Callable[[float], bool] | None = None,
) -> Simulation: ...
@overload
def simulate(
    mechanism: Mechanism,
    until: float,
    *,
    contact: Literal["both"],
    contact_constants: Constants | None = None,
    rtol: float | None = None,
    positions: Mapping[str, float] | None = None,
    velocities: Mapping[str, float] | None = None,
    forces: bool = False,
    max_steps: int | None = None,
    search: Literal["direct", "map"] = "direct",
    progress: Callable[[float], bool] | None = None,
) -> Comparison[Simulation]: ...
def simulate(
    mechanism: Mechanism,
    until: float,
    *,
    contact: str = "rigid",
    contact_constants: Constants | None = None,
    rtol: float | None = None,
    positions: Mapping[str, float] | None = None,
    velocities: Mapping[str, float] | None = None,
    forces: bool = False,
    max_steps: int | None = None,
    search: Literal["direct", "map"] = "direct",
    progress: Callable[[float], bool] | None = None,
) -> Simulation | Comparison[Simulation]:
    """Run a mechanism from t = 0 to `until`.

    Parameters
    ----------
    until
        End of the run, above 0, in the file's time unit.
    contact
        Contact model: `rigid`; `compliant`; or `both`, one after the other, with where they differ.
    contact_constants
        E, D, M of compliant contact; None: the supplement's, else the paper's.
    rtol
        Relative tolerance of states and of contact times, from 1e-13 to 1e-2; None: 1e-8 for rigid contact,
        1.5e-6 for compliant contact.
    positions, velocities
        Initial state by part, in radians or the file's length; the others as the supplement says.
    forces
        Record contact impulses and forces.
    max_steps
        Give up after so many steps, with status `step_limit`; None: the core's own limit.
    search
        Where contacts that may close next come from: `direct`, trees of features asked whenever needed; or
        `map`, boxes of each pair's configuration space, made once on the way. The motion is the same to the
        last bit.
    progress
        Called now and then with the time reached; returning False stops the run (`stopped`).

    Raises
    ------
    InputError
        For an unknown part, an option out of its range, or a machine that lacks what a run needs.

    Notes
    -----
    Rigid contact: docs/theory/contact-law.md; Gelsey 1995, Appendix A, corrected. Compliant contact:
    docs/theory/compliant-contact.md; Gelsey 1995, Sec. 2.2.1, corrected.
    """

    def run(model: str) -> Simulation:
        made = mechanism._inner.simulate(
            float(until),
            contact=model,
            contact_constants=contact_constants,
            rtol=None if rtol is None else float(rtol),
            positions=pairs_of(positions),
            velocities=pairs_of(velocities),
            forces=forces,
            max_steps=max_steps,
            search=search,
            progress=progress,
        )
        return result_of(made)

    if contact != "both":
        return run(contact)
    rigid, compliant = run("rigid"), run("compliant")
    a, b = rigid.trajectory._run, compliant.trajectory._run
    return comparison_of(lambda timing: _core.compare_runs(a, b, timing), rigid, compliant)
