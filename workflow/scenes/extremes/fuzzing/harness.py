"""Properties that every case of a kind must have, and the cases that a seed draws to try them.

A case is what a hypothesis strategy makes of random bytes, and these come from the name of the property and a seed. So
each case stands for itself: it is the same in whatever order, on whatever machine, and can be drawn again.
"""

import signal
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from inspect import signature
from random import Random
from typing import Any, NamedTuple

from hypothesis import given, settings
from hypothesis.strategies import SearchStrategy, tuples

from fracstudy.probe import BAD, Kind, Probe, Verdict

_BYTES = 8192  # more than any case takes
_TRIES = 100  # a strategy may refuse what it has drawn
_LONGEST = 60.0  # seconds: a case takes some milliseconds


class NotRun(BaseException):
    """A case that is allowed, and would take more time or memory than there is here."""


class Hang(BaseException):
    """A case that takes too long. No `except Exception` of the code under test swallows it."""


class Property(NamedTuple):
    """What must hold of every case that a strategy draws.

    `name`, `expected` and `source` are those of a `Probe`; `holds` takes the case and returns how far it is from what
    must come out, in units of what is allowed; `share` is how many of the cases are of this property, against the
    shares of the others; `must` is that of a `Kind`, but a refusal is never wrong.
    """

    name: str
    expected: str
    source: str
    cases: SearchStrategy[Any]
    holds: Callable[[Any], float]
    share: int = 1
    must: Verdict | None = None


class Outcome(NamedTuple):
    """What came of a case: the verdict, none if it was not run, and in words."""

    verdict: Verdict | None
    words: str


OF_MODULE: dict[str, list[Property]] = defaultdict(list)
"""The properties of each module, in their order."""


def always(
    name: str, expected: str, source: str = "", share: int = 1, must: Verdict | None = None
) -> Callable[[Callable[..., float]], Callable[..., float]]:
    """Make a property of the function below: each of its arguments is drawn from its default, a strategy."""

    def added(holds: Callable[..., float]) -> Callable[..., float]:
        cases = tuples(*(argument.default for argument in signature(holds).parameters.values()))
        whole = Property(name, expected, source, cases, lambda case: holds(*case), share, must)
        OF_MODULE[holds.__module__].append(whole)
        return holds

    return added


def judged(one: Property, case: Callable[[], Any]) -> Outcome:
    """Return what comes of a case; `case` draws it, which may fail, too."""

    def run() -> float:
        with _limited(_LONGEST):
            return one.holds(case())

    try:
        found = Kind(one.name, one.expected, 1.0)("", run)
    except NotRun as why:
        return Outcome(None, str(why))
    except Hang:
        return Outcome(Verdict.FAILED, f"no end after {_LONGEST:g} s")
    excused = one.must in (None, found.verdict) or found.verdict in (Verdict.REFUSED, *BAD)
    return Outcome(found.verdict if excused else Verdict.SILENT, found.found)


def outcome(one: Property, seed: int) -> Outcome:
    """Return what comes of the case that a seed draws."""
    return judged(one, lambda: draw(one, seed))


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
    outcomes = {seed: outcome(one, seed) for seed in range(first, first + count)}
    bad = {seed: found for seed, found in outcomes.items() if found.verdict in BAD}
    for seed, found in bad.items():
        print(f"{one.name!r}, seed {seed}: {found.verdict}: {found.words!a}", flush=True)
    verdicts = [found.verdict for found in outcomes.values()]
    counts = {str(verdict): verdicts.count(verdict) for verdict in Verdict}
    counts = {"cases": count, **counts, "not run": verdicts.count(None)}
    worst = max((v for v in verdicts if v in BAD), key=BAD.index, default=Verdict.HELD)
    words = next((f"seed {seed}: {found.words}" for seed, found in bad.items()), "as expected")
    about = one.name, f"{count} cases", one.expected, one.source, words
    return Probe(*about, float(len(bad)), 0.0, worst or Verdict.HELD), counts
