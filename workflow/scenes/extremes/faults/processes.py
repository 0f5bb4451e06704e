"""Processes that are stopped, and the counts of what came of many."""

import os
import signal
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress

import numpy as np

Ended = tuple[int, str]
"""Exit status, or minus the signal that ended it, and what it printed."""
_LONGEST = 120  # seconds; a process that takes longer hangs


def forked(work: Callable[[], int]) -> Ended:
    """Do something in a process of its own that has all imported already, and return how it ended."""
    return ended(begun(work))


def begun(work: Callable[[], int]) -> tuple[int, int]:
    """Begin it, and return the process and a pipe with what it prints."""
    read, write = os.pipe()
    process = os.fork()
    if process == 0:
        status = 99
        try:
            signal.alarm(_LONGEST)
            signal.signal(signal.SIGINT, signal.default_int_handler)
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            os.dup2(write, 1)
            os.dup2(write, 2)
            sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w", buffering=1)
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # until it is at work
            os.write(write, b"!")
            status = work()
        except BaseException as error:
            print(f"{type(error).__name__}: {error}", file=sys.stderr)
        finally:
            with suppress(OSError):
                sys.stdout.flush()
            os._exit(status)
    os.close(write)
    os.read(read, 1)  # it works
    return process, read


def ended(begun: tuple[int, int], after: float | None = None, by: int = signal.SIGKILL) -> Ended:
    """Wait for its end, and if asked for send it a signal before."""
    process, read = begun
    if after is not None:
        time.sleep(after)
        with suppress(ProcessLookupError):
            os.kill(process, by)
    with os.fdopen(read, errors="replace") as pipe:
        text = pipe.read()
    _, status = os.waitpid(process, 0)
    return os.waitstatus_to_exitcode(status), text


def moments(count: int, seed: int) -> Sequence[float]:
    """Return moments of a run as shares of its time; one of six comes after its end."""
    return np.random.default_rng(seed).uniform(0.0, 1.2, count).tolist()


def counted(good: Iterable[bool]) -> tuple[float, str]:
    """Return how many were not good, and what that says: "100 of 100"."""
    every = list(good)
    return float(len(every) - sum(every)), f"{sum(every)} of {len(every)}"
