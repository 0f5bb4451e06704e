"""Criteria as data: what is measured, the threshold, and what follows.

A condition compares one number with a threshold. The number may depend on a case (a scheme, a fractional order); the
statement then holds in some cases and not in others. With m the number and t the threshold:

    at_most t, below t     m <= t, m < t     margin m / t
    at_least t, above t    m >= t, m > t     margin m / t
    near c, within t       |m - c| <= t      margin |m - c| / t

A verdict is a close call if it changes when a threshold is 1.5 times as large or as small. The thresholds of "below"
and "above" are not tested for that: they stand for what has an exact border, such as a sign.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from fracstudy.verdicts import LedgerError, Status

__all__ = [
    "CLOSE",
    "CONVENTIONS",
    "Condition",
    "Convention",
    "Judged",
    "judged",
]

CONVENTIONS = Path(__file__).parents[2] / "report/printed/conventions.yaml"
"""What the words of the documents are taken to mean."""
CLOSE = 1.5
"""A verdict that changes when the threshold changes by this factor is a close call."""
_KINDS = ("at_most", "at_least", "below", "above", "within")
_LOWER = ("at_least", "above")  # bounds from below
_EXACT = ("below", "above")  # no choice of ours


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


class Convention(_Record):
    """What a word is taken to mean, in every row in which it stands.

    Attributes
    ----------
    means : str
        In words, and why.
    at_most, at_least : float
        The threshold, one of the two.
    """

    means: str = Field(min_length=1)
    at_most: float | None = None
    at_least: float | None = None

    @model_validator(mode="after")
    def _has_one_threshold(self) -> Self:
        if (self.at_most is None) == (self.at_least is None):
            raise ValueError("one of at_most and at_least")
        return self

    @property
    def threshold(self) -> tuple[str, float]:
        """The kind of the threshold and its value."""
        return _threshold(self)


class Condition(_Record):
    """One number against one threshold.

    Attributes
    ----------
    of : str
        The name of the number that the study measures.
    means : str
        What it is, in words.
    at_most, at_least, below, above, near, within : float
        The threshold: one of the first four, or `near` and `within`.
    word : str
        Instead of a threshold: the word of the document whose convention gives it.
    why : str
        Why this threshold; needed unless a word gives it.
    """

    of: str = Field(min_length=1)
    means: str = Field(min_length=1)
    at_most: float | None = None
    at_least: float | None = None
    below: float | None = None
    above: float | None = None
    near: float | None = None
    within: float | None = Field(default=None, gt=0.0)
    word: str | None = None
    why: str = ""

    @model_validator(mode="after")
    def _has_one_threshold(self) -> Self:
        given = [kind for kind in (*_KINDS, "word") if getattr(self, kind) is not None]
        if len(given) != 1:
            found = " and ".join(given) or "none"
            raise ValueError(f"{self.of}: one of {', '.join(_KINDS)} or word, not {found}")
        if (self.near is None) != (self.within is None):
            raise ValueError(f"{self.of}: `near` and `within` go together")
        if bool(self.why) == (self.word is not None):
            raise ValueError(
                f"{self.of}: `why` says where a threshold comes from; a word has its convention"
            )
        return self

    def threshold(self, conventions: Mapping[str, Convention]) -> tuple[str, float]:
        """Return the kind of the threshold and its value."""
        if self.word is None:
            return _threshold(self)
        if self.word not in conventions:
            raise LedgerError(f"no convention says what {self.word!r} means")
        return conventions[self.word].threshold

    def in_words(self, conventions: Mapping[str, Convention], factor: float = 1.0) -> str:
        """Return the criterion as people read it, with its word or its why: "at least 2 (several)".

        With its threshold times a factor it is a criterion that nobody set, and has neither.
        """
        kind, threshold = self.threshold(conventions)
        t = f"{factor * threshold:{'g' if factor == 1.0 else '.3g'}}"
        text = f"{self.near:g} ± {t}" if kind == "within" else f"{kind.replace('_', ' ')} {t}"
        source = self.word.replace("_", " ") if self.word else self.why
        return f"{text} ({source})" if factor == 1.0 else text

    def holds(self, m: float, conventions: Mapping[str, Convention], factor: float = 1.0) -> bool:
        """Whether the number meets the threshold, times a factor."""
        kind, t = self.threshold(conventions)
        t *= factor
        if kind == "within":
            return abs(m - self._centre) <= t
        return {"at_most": m <= t, "at_least": m >= t, "below": m < t, "above": m > t}[kind]

    def margin(self, m: float, conventions: Mapping[str, Convention]) -> float:
        """Return the number over its threshold; nan where the threshold is not positive."""
        kind, t = self.threshold(conventions)
        distance = abs(m - self._centre) if kind == "within" else m
        return distance / t if t > 0.0 else math.nan

    @property
    def _centre(self) -> float:
        assert self.near is not None
        return self.near


def _threshold(of: Condition | Convention) -> tuple[str, float]:
    """The one that is given; records without are refused when they are made."""
    ((kind, t),) = ((k, t) for k in _KINDS if (t := getattr(of, k, None)) is not None)
    return kind, t


@dataclass(frozen=True)
class Judged:
    """A verdict on a statement.

    Attributes
    ----------
    status : Status
        REPRODUCED where all conditions hold in all cases, REFUTED where in none, PART otherwise; MISPRINT where they
        do not all hold, and all those of the statement as it was meant do.
    where, where_not : list of str
        The cases in which all conditions hold, and the others.
    margin : float
        The margin, over the cases and conditions, that is nearest to failing or fails by most; nan if there is none.
    close : list of str
        The verdicts that a threshold 1.5 times as large or as small would give, where they are others.
    """

    status: Status
    where: list[str]
    where_not: list[str]
    margin: float
    close: list[str]


def judged(
    conditions: Sequence[Condition],
    numbers: Mapping[str, Any],
    conventions: Mapping[str, Convention],
    intended: Sequence[Condition] = (),
) -> Judged:
    """Hold numbers against conditions, and against those of the statement as it was meant, if it is misprinted.

    Raises
    ------
    LedgerError
        For a number that is not there or is none, and a word without a convention.
    """

    def verdict(factors: Mapping[Condition, float]) -> tuple[Status, list[str], list[str]]:
        status, where, where_not = _outcome(conditions, numbers, conventions, factors)
        if status is not Status.REPRODUCED and intended:
            meant, _, _ = _outcome(intended, numbers, conventions, factors)
            status = Status.MISPRINT if meant is Status.REPRODUCED else status
        return status, where, where_not

    status, where, where_not = verdict({})
    close = [
        f"{other} with {condition.in_words(conventions, factor)} for {condition.means}"
        for condition in dict.fromkeys((*conditions, *intended))
        if condition.threshold(conventions)[0] not in _EXACT
        for factor in (1.0 / CLOSE, CLOSE)
        if (other := verdict({condition: factor})[0]) != status
    ]
    decisive = intended if status is Status.MISPRINT else conditions
    return Judged(status, where, where_not, _worst(decisive, numbers, conventions), close)


def _outcome(
    conditions: Iterable[Condition],
    numbers: Mapping[str, Any],
    conventions: Mapping[str, Convention],
    factors: Mapping[Condition, float],
) -> tuple[Status, list[str], list[str]]:
    """A case holds where every condition on it holds, and every condition that is the same in all cases."""
    held: dict[str, bool] = {}
    always = True
    for condition in conditions:
        for case, m in _cases(condition, numbers):
            holds = condition.holds(m, conventions, factors.get(condition, 1.0))
            if case is None:
                always = always and holds
            else:
                held[case] = held.get(case, True) and holds
    where = [case for case, holds in held.items() if holds and always]
    where_not = [case for case in held if case not in where]
    if always and not where_not:
        return Status.REPRODUCED, where, where_not
    return (Status.PART if where else Status.REFUTED), where, where_not


def _worst(
    conditions: Iterable[Condition],
    numbers: Mapping[str, Any],
    conventions: Mapping[str, Convention],
) -> float:
    def strain(kind: str, margin: float) -> float:
        """How far a threshold is used up, more than 1 where it fails, for both sides alike."""
        if kind not in _LOWER:
            return margin
        return 1.0 / margin if margin > 0.0 else math.inf

    margins = [
        (strain(condition.threshold(conventions)[0], margin), margin)
        for condition in conditions
        for _, m in _cases(condition, numbers)
        if not math.isnan(margin := condition.margin(m, conventions))
    ]
    return max(margins, default=(0.0, math.nan))[1]


def _cases(condition: Condition, numbers: Mapping[str, Any]) -> Iterator[tuple[str | None, float]]:
    """Each number with the name of its case; several without names are of no case, and all must hold."""
    name = condition.of
    if name not in numbers:
        raise LedgerError(f"{name} was not measured; measured: {', '.join(numbers) or 'none'}")
    number = numbers[name]
    if isinstance(number, Mapping):
        pairs: list[tuple[str | None, Any]] = list(number.items())
    else:
        pairs = [(None, m) for m in (number if isinstance(number, list) else [number])]
    if not pairs or not all(isinstance(m, int | float) for _, m in pairs):
        raise LedgerError(f"{name} is {number!r}, which no threshold can be held against")
    yield from pairs
