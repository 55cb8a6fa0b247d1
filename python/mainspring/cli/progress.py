"""Progress on standard error when that is a terminal; Ctrl-C stops a run between two steps."""

import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

_QUIET_SECONDS = 0.4
_REFRESH_SECONDS = 0.1


class Watch:
    """What the core calls with the time reached, or the share; says whether to go on."""

    def __init__(self, doing: str, until: float | None, *, share: bool) -> None:
        self.stopped = False
        self._doing, self._until, self._share = doing, until, share
        self._next = time.monotonic() + _QUIET_SECONDS
        self._bar: tuple[Progress, TaskID] | None = None

    def __call__(self, t: float) -> bool:
        """Show what is reached, at most ten times a second."""
        now = time.monotonic()
        if now >= self._next and sys.stderr.isatty():
            self._next = now + _REFRESH_SECONDS
            self._show(t)
        return not self.stopped

    def _show(self, t: float) -> None:
        bar, task = self._bar or self._open()
        reached = f"{100 * t:.0f} %" if self._share else f"t = {t:.4g} s"
        bar.update(task, completed=t, description=f"{self._doing}, {reached}")
        bar.refresh()

    def _open(self) -> "tuple[Progress, TaskID]":
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

        columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
        bar = Progress(*columns, console=Console(stderr=True), transient=True, auto_refresh=False)
        self._bar = (bar, bar.add_task(self._doing, total=self._until))
        bar.start()
        return self._bar

    def stop(self, _signal: int, _frame: FrameType | None) -> None:
        """Ask the run to stop; a second Ctrl-C stops at once."""
        if self.stopped:
            raise KeyboardInterrupt
        self.stopped = True

    def close(self) -> None:
        """Take the bar away."""
        if self._bar:
            self._bar[0].stop()


@contextmanager
def watch(doing: str, until: float | None = None, *, share: bool = False) -> Iterator[Watch]:
    """Show progress, a time or the `share` that is done, and catch Ctrl-C while a run lasts."""
    watcher = Watch(doing, until, share=share)
    restore: Callable[[], object] = _catch(watcher)
    try:
        yield watcher
    finally:
        restore()
        watcher.close()


def _catch(watcher: Watch) -> Callable[[], object]:
    try:
        before = signal.signal(signal.SIGINT, watcher.stop)
    except ValueError:  # not the main thread: someone else handles signals
        return lambda: None
    return lambda: signal.signal(signal.SIGINT, before)
