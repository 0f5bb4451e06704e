"""Properties that every case of a kind must have, and the cases that a seed draws to try them.

A case is what a hypothesis strategy makes of random bytes, and these come from the name of the property and a seed. So
each case stands for itself: it is the same in whatever order, on whatever machine, and can be drawn again.
"""

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from random import Random
from typing import Any

from hypothesis import given, settings
from hypothesis.strategies import SearchStrategy, tuples

from fracstudy.probe import BAD, Kind, Probe, Verdict

_BYTES = 8192  # more than any case takes
_TRIES = 100  # a strategy may refuse what it has drawn
_LONGEST = 60.0  # seconds: a case takes some milliseconds


_Drawn = tuple[SearchStrategy[Any], Callable[..., float]]


class NotRun(BaseException):
    """A case that is allowed, and would take more time or memory than there is here."""


class Hang(BaseException):
    """A case that takes too long. No `except Exception` of the code under test swallows it."""


@dataclass(frozen=True)
class Property:
    """What must hold of every case that a strategy draws.

    Attributes
    ----------
    name, expected, source : str
        See `Probe`.
    cases : SearchStrategy
        What draws a case.
    holds : callable
        Takes the case and returns how far it is from what must come out, in units of what is allowed.
    share : int
        How many of the cases are of this property, against the shares of the others.
    must : Verdict, optional
        See `probe`; a refusal is never wrong.
    """

    name: str
    expected: str
    source: str
    cases: SearchStrategy[Any]
    holds: Callable[[Any], float]
    share: int = 1
    must: Verdict | None = None


class Properties(list[Property]):
    """Those of a file, each said above the function that holds."""

    def add(
        self,
        name: str,
        expected: str,
        source: str = "",
        share: int = 1,
        must: Verdict | None = None,
    ) -> Callable[[_Drawn], Callable[..., float]]:
        """Return what makes a property of a function that is `drawn`; see `Property`."""

        def added(of: _Drawn) -> Callable[..., float]:
            cases, holds = of
            whole = Property(name, expected, source, cases, lambda case: holds(*case), share, must)
            self.append(whole)
            return holds

        return added


def drawn(*arguments: SearchStrategy[Any]) -> Callable[[Callable[..., float]], _Drawn]:
    """Say what the arguments of a property are drawn from."""
    return lambda holds: (tuples(*arguments), holds)


@dataclass(frozen=True)
class Outcome:
    """What came of a case: the verdict, none if it was not run, and in words."""

    seed: int
    verdict: Verdict | None
    words: str


def judged(one: Property, case: Callable[[], Any]) -> Outcome:
    """Return what comes of a case; `case` draws it, which may fail, too."""

    def run() -> float:
        with _limited(_LONGEST):
            return one.holds(case())

    try:
        found = Kind(one.name, one.expected, 1.0)("", run)
    except NotRun as why:
        return Outcome(0, None, str(why))
    except Hang:
        return Outcome(0, Verdict.FAILED, f"no end after {_LONGEST:g} s")
    excused = one.must in (None, found.verdict) or found.verdict in (Verdict.REFUSED, *BAD)
    return Outcome(0, found.verdict if excused else Verdict.SILENT, found.found)


def outcome(one: Property, seed: int) -> Outcome:
    """Return what comes of the case that a seed draws."""
    found = judged(one, lambda: draw(one, seed))
    return Outcome(seed, found.verdict, found.words)


def draw(one: Property, seed: int) -> Any:
    """Return the case that a seed draws."""
    drawn, target = _target(one)
    drawn.clear()
    for attempt in range(_TRIES):
        target(Random(f"{one.name}:{seed}:{attempt}").randbytes(_BYTES))
        if drawn:
            return drawn.pop()
    raise RuntimeError(f"{one.name}: the strategy draws nothing from seed {seed}")


@cache
def _target(one: Property) -> tuple[list[Any], Callable[[bytes], Any]]:
    """Return a list, and a function that puts into it what the strategy makes of bytes, or nothing if it refuses."""
    drawn: list[Any] = []

    @settings(database=None)
    @given(one.cases)
    def keep(case: Any) -> None:
        drawn.append(case)

    return drawn, keep.hypothesis.fuzz_one_input  # type: ignore[attr-defined]


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    """Raise `Hang` in the block if it takes longer."""

    def stop(*_: object) -> None:
        raise Hang

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def row(one: Property, count: int, first: int = 0) -> tuple[Probe, dict[str, int]]:
    """Return what comes of the cases of `count` seeds, as one probe and as counts.

    The seeds of what is bad are printed; `again` draws such a case once more.
    """
    outcomes = [outcome(one, seed) for seed in range(first, first + count)]
    bad = [found for found in outcomes if found.verdict in BAD]
    for found in bad:
        print(f"{one.name!r}, seed {found.seed}: {found.verdict}: {found.words!a}", flush=True)
    counts = {
        str(verdict): sum(found.verdict is verdict for found in outcomes) for verdict in Verdict
    }
    counts = {"cases": count, **counts, "not run": sum(found.verdict is None for found in outcomes)}
    worst = max(
        (found.verdict for found in bad if found.verdict), key=BAD.index, default=Verdict.HELD
    )
    words = f"seed {bad[0].seed}: {bad[0].words}" if bad else "as expected"
    case = f"{count} cases"
    return (
        Probe(one.name, case, one.expected, one.source, words, float(len(bad)), 0.0, worst),
        counts,
    )
