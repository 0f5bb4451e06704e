"""The progress of a run in a line on a terminal. It is not shown in the first seconds, and never in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic

__all__ = ["on_terminal"]

_FIRST = 2.0  # seconds of silence: most runs are over by then
_BETWEEN = 0.2  # seconds between two updates of the line


@contextmanager
def on_terminal(what: str) -> Iterator[Callable[[float], None] | None]:
    """Yield a function to call with the share that is done, or None without a terminal. At the end the line goes."""
    if not sys.stderr.isatty():
        yield None
        return
    line = _Line(what)
    try:
        yield line
    finally:
        line.stop()


class _Line:
    """The line. It appears after some seconds, and rich is imported only then."""

    def __init__(self, what: str) -> None:
        self._what, self._next, self._stop = what, monotonic() + _FIRST, lambda: None
        self._show: Callable[[float], None] | None = None

    def __call__(self, share: float) -> None:
        if share >= 1.0:
            self.stop()  # warnings may follow, each on a line of its own
        now = monotonic()
        if now < self._next or share >= 1.0:
            return
        self._next = now + _BETWEEN
        if self._show is None:
            self._begin()
        assert self._show is not None
        self._show(share)

    def _begin(self) -> None:
        from rich.console import Console
        from rich.progress import Progress

        bar = Progress(console=Console(stderr=True), transient=True, redirect_stderr=False)
        task = bar.add_task(self._what, total=1.0)
        bar.start()
        self._show, self._stop = (lambda share: bar.update(task, completed=share)), bar.stop

    def stop(self) -> None:
        """Remove the line."""
        self._stop()
