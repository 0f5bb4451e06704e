"""Criteria as data: a measured number, its threshold, and the verdict.

A condition compares one number with a threshold. The number may depend on a case (a scheme, a fractional order); the
statement then holds in some cases and not in others. With m the number and t the threshold:

    at_most t, below t     m <= t, m < t     margin m / t
    at_least t, above t    m >= t, m > t     margin m / t
    near c, within t       |m - c| <= t      margin |m - c| / t

A verdict is a close call if it changes when a threshold is multiplied or divided by 1.5. The thresholds of "below" and
"above" are not tested for this: they are exact borders, such as zero for a sign.
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
"""The file of the meanings of the documents' words."""
CLOSE = 1.5
"""A verdict that changes when the threshold changes by this factor is a close call."""
_KINDS = ("at_most", "at_least", "below", "above", "within")
_LOWER = ("at_least", "above")  # bounds from below
_EXACT = ("below", "above")  # exact borders, not chosen by us


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


class Convention(_Record):
    """The meaning of a word, in every row in which it occurs.

    Attributes
    ----------
    means : str
        The meaning in words, and the reason for it.
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
        Its meaning in words.
    at_most, at_least, below, above, near, within : float
        The threshold: one of the first four, or `near` and `within`.
    word : str
        Instead of a threshold, the word of the document whose convention gives it.
    why : str
        The reason for this threshold; needed unless a word gives it.
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
        """Return the criterion in words, with the word or the reason behind it: "at least 2 (several)".

        If the threshold is multiplied by a factor, there is no word or reason behind it, and none is shown.
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
    """The kind and the value of the threshold that is given; records without one are refused when they are made."""
    ((kind, t),) = ((k, t) for k in _KINDS if (t := getattr(of, k, None)) is not None)
    return kind, t


@dataclass(frozen=True)
class Judged:
    """A verdict on a statement.

    Attributes
    ----------
    status : Status
        REPRODUCED if all conditions hold in all cases, REFUTED if they hold in none, PART otherwise. MISPRINT if they
        do not all hold, and all conditions of the statement as it was meant do.
    where, where_not : list of str
        The cases in which all conditions hold, and the others.
    margin : float
        The margin, among the cases and conditions, that is nearest to failing or fails by most; nan if there is none.
    close : list of str
        The other verdicts that a threshold multiplied or divided by 1.5 would give.
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
    """Judge numbers by conditions, and if the statement may be misprinted, by those of the statement as it was meant.

    Raises
    ------
    LedgerError
        If a number is missing or is not a number, or a word has no convention.
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
    """A statement holds in a case if every condition on this case holds, and every condition without cases."""
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
        """The used share of a threshold, more than 1 where it fails, for bounds from above and below alike."""
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
    """Each number with the name of its case; several numbers without names have no case, and all must hold."""
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
