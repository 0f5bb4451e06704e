"""A probe: something that may go wrong is run, and its result is judged.

A result is right if it is within a bound of a value known from elsewhere. If it is not, there must be a warning.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from enum import StrEnum
from functools import partial
from inspect import isgeneratorfunction
from types import ModuleType
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import FracparticlesError, FracparticlesWarning, reason_of
from fracstudy.errors import EPS, off, quiet
from fracstudy.scene import call

__all__ = [
    "BAD",
    "EPS",
    "HELD",
    "REFUSED",
    "WARNED",
    "Kind",
    "Probe",
    "Verdict",
    "frame",
    "off",
    "overheard",
    "probes_of",
    "quiet",
]


class Verdict(StrEnum):
    """The verdict on a probe."""

    HELD = "held"
    """Right, within the bound."""
    WARNED = "warned"
    """Beyond the bound, with a warning of ours."""
    REFUSED = "refused"
    """Ended by an error of ours, in one line."""
    SILENT = "silent"
    """Beyond the bound without a word."""
    FAILED = "failed"
    """Ended by any other error, or otherwise than it must."""


BAD = (Verdict.SILENT, Verdict.FAILED)
HELD, WARNED, REFUSED = Verdict.HELD, Verdict.WARNED, Verdict.REFUSED


@dataclass(frozen=True)
class Probe:
    """A probe that has been made: one row of a table.

    Attributes
    ----------
    kind : str
        The part of the family to which it belongs, in a word or two.
    case : str
        The action, in words.
    expected : str
        The right result, in words.
    source : str
        The source of the right result: "closed form", "mpmath", "dense matrix", "scipy" and the like; empty if the code
        is only compared with itself.
    found : str
        The result, or the message of the error or of the first warning.
    deviation, bound : float
        The distance from the right result, and the largest one allowed; nan if there is no number.
    verdict : Verdict
    """

    kind: str
    case: str
    expected: str
    source: str
    found: str
    deviation: float
    bound: float
    verdict: Verdict


@dataclass(frozen=True)
class Kind:
    """The attributes that several probes share. A call makes one of these probes.

    Attributes
    ----------
    kind, expected, source : str
        See `Probe`.
    bound : float
        The greatest deviation allowed.
    must : Verdict, optional
        The only verdict that is accepted: `HELD` if nothing excuses a wrong number, `WARNED` if growth is expected and
        must be warned of, `REFUSED` for input without a meaning. With `WARNED` the deviation is that from the predicted
        growth, and must be within the bound.
    """

    kind: str
    expected: str = "refused"
    bound: float = 0.0
    source: str = ""
    must: Verdict | None = None

    def __call__(self, case: str, run: Callable[..., Any], *arguments: Any, **other: Any) -> Probe:
        """Run something that may go wrong, and judge it.

        Parameters
        ----------
        case : str
            The action, in words.
        run : callable
            It is called with the arguments, and returns the deviation from the right result, a number of at least zero.
            It may return the result in words with it. If it must be refused, it may return anything.
        **other
            Attributes of this kind that differ for this probe.

        Returns
        -------
        Probe
        """
        return replace(self, **other)._judged(case, partial(run, *arguments))

    def _judged(self, case: str, run: Callable[[], Any]) -> Probe:
        bound, must = self.bound, self.must
        deviation, words = np.nan, ""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                result = run()
            except FracparticlesError as error:
                verdict = Verdict.REFUSED if "\n" not in str(error) else Verdict.FAILED
                words = str(error)
            except Exception as error:
                verdict, words = Verdict.FAILED, f"{type(error).__name__}: {reason_of(error)}"
            else:
                if must is Verdict.REFUSED:
                    verdict, words = Verdict.FAILED, "accepted"
                else:
                    deviation, words = result if isinstance(result, tuple) else (result, "")
                    # nan is not right
                    verdict = Verdict.HELD if deviation <= bound else Verdict.SILENT
        spoken = [str(w.message) for w in caught if issubclass(w.category, FracparticlesWarning)]
        stray = [f"{w.category.__name__}: {w.message}" for w in caught if _stray(w.category)]
        if verdict is Verdict.SILENT and spoken:
            verdict, words = Verdict.WARNED, words or spoken[0]
        if must is Verdict.WARNED and verdict is Verdict.HELD and spoken:
            verdict = Verdict.WARNED
        elif must is Verdict.WARNED and verdict is Verdict.WARNED:
            verdict = Verdict.FAILED  # the growth is not the predicted one
        if must is not None and verdict is not must and verdict is not Verdict.SILENT:
            verdict = Verdict.FAILED
        if stray and verdict is not Verdict.FAILED:
            verdict, words = Verdict.FAILED, stray[0]
        found = words or f"{deviation:.1e}"
        return Probe(self.kind, case, self.expected, self.source, found, deviation, bound, verdict)

    def of(self, cases: Mapping[str, Callable[[], Any]]) -> Iterator[Probe]:
        """Make a probe of each case, by its name."""
        for case, run in cases.items():
            yield self(case, run)

    def over(
        self, run: Callable[..., Any], cases: Mapping[str, tuple[Any, ...]], **other: Any
    ) -> Iterator[Probe]:
        """Make a probe of each case, by its name: the same run with other arguments."""
        for case, arguments in cases.items():
            yield self(case, run, *arguments, **other)


def _stray(category: type[Warning]) -> bool:
    """Whether a warning is numpy's, of an overflow or a division by zero that the library did not notice."""
    return issubclass(category, RuntimeWarning)


def probes_of(*modules: ModuleType, **given: Any) -> Iterator[Probe]:
    """Make the probes of modules: each generator makes a family, and is called with the values that it takes."""
    for module in modules:
        for name, family in list(vars(module).items()):
            own = isgeneratorfunction(family) and family.__module__ == module.__name__
            if own and not name.startswith("_"):
                yield from call(family, **given)


def frame(probes: Iterable[Probe]) -> pd.DataFrame:
    """Return a table with one row for each probe."""
    return pd.DataFrame([asdict(one) for one in probes])


@contextmanager
def overheard() -> Iterator[list[str]]:
    """Collect our warnings in a block in a list, which is filled at its end; they are then issued again."""
    words: list[str] = []
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            yield words
    finally:
        words += [str(w.message) for w in caught if issubclass(w.category, FracparticlesWarning)]
        for one in caught:
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
