"""What is measured of every engine on 37 s of the escapement, with one shape for all of them.

The error is the distance of the engine's period from its own limit: contacts differ (soft in the peers), and
so do the limits. The limit is the period at the finest of the engine's steps or tolerances; its doubt is the
distance from that at the second finest. Richardson's extrapolation is not used: the peers' periods do not
fall on a line.
"""

import statistics
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import with_mainspring
from motion import period, reversals
from peers import Peer
from scene import UNTIL

HERE = Path(__file__).resolve().parent
ROUNDS = 12  # rounds in which every engine is timed, so that other work on the machine disturbs all alike
RUNS = 4  # runs of a peer in a round
OWN_RUNS = 15  # of Mainspring, which are shorter


@dataclass(frozen=True)
class Point:
    """One step or tolerance: seconds of the fastest run, and the error of the period in seconds."""

    step: float
    seconds: float
    error: float


@dataclass
class Row:
    """One engine at its setting; times in seconds, memory in MiB."""

    engine: str
    version: str
    contact: str
    setting: str
    step: float
    steps: int
    period: float
    limit: float
    doubt: float
    memory: float
    walls: list[float] = field(default_factory=list)
    points: list[Point] = field(default_factory=list)

    @property
    def label(self) -> str:
        """Return the engine with what tells its rows apart."""
        return f"{self.engine} {self.contact}" if self.engine == with_mainspring.NAME else self.engine

    @property
    def error(self) -> float:
        """Return the distance of the period from the engine's own limit, in seconds."""
        return abs(self.period - self.limit)

    @property
    def fastest(self) -> float:
        """Return the fastest run."""
        return min(self.walls)

    @property
    def median(self) -> float:
        """Return the run in the middle."""
        return statistics.median(self.walls)


def memory(python: str, *arguments: str) -> float:
    """Return the most memory that an engine holds in a fresh process, in MiB."""
    command = [python, str(HERE / "peak.py"), *arguments]
    done = subprocess.run(command, check=True, capture_output=True, text=True, cwd=HERE)
    return float(done.stderr.split()[-1])


def mainspring(contact: str) -> Row:
    """Return Mainspring's row with a contact model, without times."""
    fine, next_fine = (with_mainspring.simulate(contact, rtol) for rtol in with_mainspring.REFINED[contact])
    run = with_mainspring.simulate(contact)
    return Row(
        engine=with_mainspring.NAME,
        version=with_mainspring.version(),
        contact=contact,
        setting="relative tolerance",
        step=with_mainspring.RTOL[contact],
        steps=run.result["stats"]["steps"],
        period=run.period,
        limit=fine.period,
        doubt=abs(fine.period - next_fine.period),
        memory=mainspring_memory(contact, UNTIL),
    )


def mainspring_memory(contact: str, until: float) -> float:
    """Return the most memory that the command holds."""
    model = str(with_mainspring.ROOT / with_mainspring.ESCAPEMENT)
    options = (f"--contact={contact}", f"--until={until!r}", "--json")
    return memory(str(with_mainspring.PYTHON), "mainspring", "simulate", model, *options)


def peer(engine: Peer, dt: float) -> Row:
    """Return a peer's row at a step, without times."""
    fine, next_fine = (period(reversals(engine.motion(h))) for h in engine.fine)
    return Row(
        engine=engine.name,
        version=engine.version,
        contact="soft",
        setting=engine.setting,
        step=dt,
        steps=round(UNTIL / dt),
        period=period(reversals(engine.motion(dt))),
        limit=fine,
        doubt=abs(fine - next_fine),
        memory=memory(sys.executable, engine.module, repr(dt), repr(UNTIL), *engine.more),
    )


def clock(rows: list[Row], engines: list[Peer]) -> None:
    """Time all rows, round by round; `engines` are those of the rows that are peers, in order."""
    own = [row for row in rows if row.engine == with_mainspring.NAME]
    others = [row for row in rows if row.engine != with_mainspring.NAME]
    for _ in range(ROUNDS):
        for row in own:
            row.walls += with_mainspring.simulate(row.contact, runs=OWN_RUNS).walls
        for row, engine in zip(others, engines, strict=True):
            row.walls += [engine.seconds(row.step, UNTIL)[0] for _ in range(RUNS)]


def mainspring_curve(row: Row) -> None:
    """Add time and error at other tolerances."""
    for rtol in with_mainspring.RTOLS[row.contact]:
        run = with_mainspring.simulate(row.contact, rtol, runs=OWN_RUNS)
        walls = run.walls + (row.walls if rtol == row.step else [])
        row.points.append(Point(rtol, min(walls), abs(run.period - row.limit)))


def peer_curve(row: Row, engine: Peer) -> None:
    """Add time and error at ever halved steps."""
    for k in range(5):
        dt = row.step / 2**k
        walls = [engine.seconds(dt, UNTIL)[0] for _ in range(3)] if k else row.walls
        row.points.append(Point(dt, min(walls), abs(period(reversals(engine.motion(dt))) - row.limit)))
