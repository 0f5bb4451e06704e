"""Findings: the numbers that a study measures for the claims of its scene (`results/findings/<scene>.json`).

A study measures, and the criterion of the claim judges. Texts look the numbers up: if `ratio` depends on the scheme,
``{ratio:.2f}`` gives "3.13 (KPSE), 1.47 (DD)", ``{ratio[KPSE]:.2f}`` one of them, and ``{ratio.least:.2f}`` and
``{ratio.greatest:.2f}`` the least and the greatest.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from fracparticles.files import write_text
from fracstudy.printed import refuse_repeats
from fracstudy.verdicts import LedgerError

__all__ = ["Finding", "each", "filled", "measured", "read_findings", "write_findings"]


class Finding(BaseModel):
    """The measurements of a study for one claim.

    Attributes
    ----------
    claim : str
        Id of the claim.
    numbers : dict
        By name: a number, several, numbers by case, or a word. The number of a value is called `ours`; it is left out
        if it could not be measured.
    others : dict
        The same numbers in other readings that the print leaves open (another seed, another loading), by reading.
    runs : list of str
        Relative paths of the runs behind the numbers.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    claim: str = Field(min_length=1)
    numbers: dict[str, Any] = {}
    others: dict[str, dict[str, Any]] = {}
    runs: list[str] = []


def measured(
    claim: str,
    *,
    runs: Iterable[str] = (),
    others: Mapping[str, Mapping[str, Any]] | None = None,
    **numbers: Any,
) -> Finding:
    """Return the finding for a claim, with numbers as those of Python.

    Parameters
    ----------
    claim : str
        Id of the claim.
    runs : iterable of str, optional
        The runs behind it.
    others : mapping, optional
        The numbers in other readings, by the name of the reading.
    **numbers
        Each is a number, a truth value, a word, an array or list of numbers, or a mapping or Series of numbers by case.
        The name of a case is its key, with the parts of a tuple joined. If a Series names its index, numbers in the key
        are shown with these names: "KPSE, beta = 0.1".

    Raises
    ------
    LedgerError
        If a number is not finite, a list or mapping is empty, two cases have one name, or another reading has a number
        that is not among the numbers.
    """
    for reading, of_reading in (others or {}).items():
        if unknown := sorted(of_reading.keys() - numbers.keys()):
            raise LedgerError(f"{claim}: {reading} gives {', '.join(unknown)}, no number of it")
    return Finding(
        claim=claim,
        numbers={name: _plain(claim, name, number) for name, number in numbers.items()},
        others={
            reading: {name: _plain(claim, name, number) for name, number in of_reading.items()}
            for reading, of_reading in (others or {}).items()
        },
        runs=list(runs),
    )


def each(quantity: Callable[..., Any], **cases: Iterable[Any]) -> pd.Series:
    """Return a quantity for each case, or each combination of cases: `each(f, n=(1, 2), beta=betas)` for f(n, beta).

    The index of the Series has the names of the arguments, as `measured` takes it.
    """
    choices = [list(values) for values in cases.values()]
    values = [quantity(*case) for case in product(*choices)]
    if len(choices) == 1:
        return pd.Series(values, pd.Index(choices[0], name=next(iter(cases))))
    return pd.Series(values, pd.MultiIndex.from_product(choices, names=list(cases)))


def _plain(claim: str, name: str, number: Any) -> Any:
    if isinstance(number, str):
        return number
    if isinstance(number, pd.Series | Mapping):
        names = number.index.names if isinstance(number, pd.Series) else ()
        cases = [(_case(key, names), m) for key, m in number.items()]
        refuse_repeats([case for case, _ in cases], f"{claim}: cases of {name} with one name")
        found: Any = {case: _plain(claim, name, m) for case, m in cases}
    elif np.ndim(number):
        found = [_plain(claim, name, m) for m in number]
    else:
        return _scalar(claim, name, number)
    if not found:
        raise LedgerError(f"{claim}: {name} has no numbers")
    return found


def _scalar(claim: str, name: str, number: Any) -> int | float:
    if isinstance(number, bool | np.bool_ | int | np.integer):
        return int(number)
    try:
        plain = float(number)
    except TypeError:
        plain = math.nan
    if not math.isfinite(plain):
        raise LedgerError(f"{claim}: {name} is {number}; a finding is made of finite numbers")
    return plain


def _case(key: Any, names: Iterable[Any]) -> str:
    parts = key if isinstance(key, tuple) else (key,)
    labels = [*names] or [None] * len(parts)
    return ", ".join(
        str(part) if label is None or isinstance(part, str) else f"{label} = {part:g}"
        for part, label in zip(parts, labels, strict=True)
    )


class _Several:
    """Numbers of which a text may show all, one, the least or the greatest."""

    def __init__(self, numbers: Mapping[str, Any] | Sequence[Any]) -> None:
        self._numbers = numbers
        values = numbers.values() if isinstance(numbers, Mapping) else numbers
        self.least, self.greatest, self.count = min(values), max(values), len(numbers)

    def __getitem__(self, key: int | str) -> Any:
        if isinstance(self._numbers, Mapping):
            return self._numbers[str(key)]
        return self._numbers[int(key)]

    def __format__(self, form: str) -> str:
        if isinstance(self._numbers, Mapping):
            return ", ".join(f"{m:{form}} ({case})" for case, m in self._numbers.items())
        return ", ".join(f"{m:{form}}" for m in self._numbers)


def filled(text: str, finding: Finding) -> str:
    """Return the text with the numbers of a finding in it.

    Raises
    ------
    LedgerError
        If it asks for a number that is missing, or in a form in which the number cannot be shown.
    """
    try:
        shown = {
            name: _Several(number) if isinstance(number, dict | list) else number
            for name, number in finding.numbers.items()
        }
        return text.format(**shown).strip()
    except (KeyError, IndexError, AttributeError, ValueError, TypeError) as error:
        known = ", ".join(finding.numbers) or "none"
        raise LedgerError(f"{finding.claim}: {error!r} in {text!r}; measured: {known}") from None


def read_findings(paths: Iterable[str | os.PathLike[str]]) -> list[Finding]:
    """Read the findings of several scenes, each a JSON list.

    Raises
    ------
    LedgerError
        If a file is not a list of valid findings.
    """
    findings: list[Finding] = []
    for path in map(Path, paths):
        try:
            findings += TypeAdapter(list[Finding]).validate_json(path.read_text("utf-8"))
        except ValidationError as error:
            raise LedgerError(f"{path}: {error}") from error
    return findings


def write_findings(findings: Iterable[Finding], path: str | os.PathLike[str]) -> None:
    """Write the findings of a scene as a JSON list."""
    records = [finding.model_dump(mode="json", exclude_defaults=True) for finding in findings]
    write_text(path, json.dumps(records, indent=1, ensure_ascii=False) + "\n")
