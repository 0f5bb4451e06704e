"""Claims: what the documents print, against what we find.

A claim is a printed number or a checkable statement (`report/printed/*.yaml`); a finding is what a
study measured for it (`results/findings/*.json`). `ledger` joins the two, one row a claim.

With p the printed number, u one unit of its last printed digit and o ours, a value is

    reproduced                               |o - p| <= u/2   (o rounds to the printed digits),
    reproduced within the print's rounding   |o - p| <= u     (a truncated print, 8.83 for 8.8354),
    deviates                                 otherwise,

and a statement is reproduced or refuted as its verdict says. Either may turn out not testable.
"""

from __future__ import annotations

import json
import math
import os
from collections import Counter
from collections.abc import Iterable
from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from typing import Literal, Self

import yaml
from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    TypeAdapter,
    ValidationError,
    model_validator,
)

from fracparticles.errors import FracparticlesError
from fracparticles.files import write_text

__all__ = [
    "PRINTED_NUMBER",
    "Claim",
    "Finding",
    "LedgerError",
    "Status",
    "judge",
    "judge_value",
    "read_claims",
    "read_findings",
    "refuse_repeats",
    "write_findings",
]

PRINTED_NUMBER = r"^-?[0-9]+(\.[0-9]+)?(e-?[0-9]{1,3})?$"


class LedgerError(FracparticlesError, ValueError):
    """Claims and findings that do not fit together; says which claim and why."""


class Status(StrEnum):
    """What became of a claim, in the words of the ledger."""

    REPRODUCED = "reproduced"
    WITHIN_ROUNDING = "reproduced within the print's rounding"
    DEVIATES = "deviates"
    REFUTED = "refuted"
    NOT_TESTABLE = "not testable"

    @property
    def sign(self) -> str:
        """The sign that stands before the word in a table."""
        return _SIGNS[self]

    @property
    def needs_reason(self) -> bool:
        """Whether the ledger must say why."""
        return self in (Status.DEVIATES, Status.REFUTED, Status.NOT_TESTABLE)


_SIGNS = {
    Status.REPRODUCED: "✓",
    Status.WITHIN_ROUNDING: "≈",
    Status.DEVIATES: "≠",
    Status.REFUTED: "✗",
    Status.NOT_TESTABLE: "?",
}


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class Claim(_Record):
    """One printed number or one checkable statement of a document.

    Parameters
    ----------
    id : str
        The item and what of it, in dots: ``L-T3.DD.beta0.1``.
    item : str
        The figure, table or statement it belongs to: ``L-T3``.
    kind : {"value", "statement"}
        Whether a number or a sentence is claimed.
    what : str
        One plain sentence of what is claimed.
    where : str
        Table, section or equation.
    printed : str, for a value
        The number with exactly the digits of the print.
    statement : str, for a statement
        What the document says.
    """

    id: str = Field(min_length=1)
    item: str = Field(min_length=1)
    kind: Literal["value", "statement"]
    what: str = Field(min_length=1)
    where: str = Field(min_length=1)
    printed: str | None = Field(default=None, pattern=PRINTED_NUMBER)
    statement: str | None = Field(default=None, min_length=1)

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if not self.id.startswith(f"{self.item}."):
            raise ValueError(f"the id {self.id} does not begin with its item {self.item}")
        if (self.kind == "value") != (self.printed is not None):
            raise ValueError(f"{self.id}: a value, and nothing else, has `printed`")
        if (self.kind == "statement") != (self.statement is not None):
            raise ValueError(f"{self.id}: a statement, and nothing else, has `statement`")
        return self

    @property
    def text(self) -> str:
        """What is printed: the digits of a value, the words of a statement."""
        text = self.printed if self.kind == "value" else self.statement
        assert text is not None  # by _is_consistent
        return text


class Finding(_Record):
    """What a study found for one claim.

    Parameters
    ----------
    claim : str
        Id of the claim.
    ours : float, optional
        Our number for a value; None where it could not be had (then not testable).
    verdict : bool, optional
        Whether a statement holds; None where it cannot be tested. Left out for values.
    evidence : str
        One sentence with our figures; statements only.
    reason : str
        Why it deviates, is refuted or cannot be tested; kept only if it does or is.
    runs : tuple of str
        Relative paths of the runs behind it.
    """

    claim: str = Field(min_length=1)
    ours: float | None = Field(default=None, allow_inf_nan=False)
    verdict: bool | None = None
    evidence: str = ""
    reason: str = ""
    runs: tuple[str, ...] = Field(default=(), strict=False)

    @property
    def has_verdict(self) -> bool:
        """Whether a verdict was given, be it None: what tells a statement's finding."""
        return "verdict" in self.model_fields_set


def read_claims(*paths: str | os.PathLike[str]) -> list[Claim]:
    """Read the claims of documents, each from its YAML file.

    Raises
    ------
    LedgerError
        If a file is not a list of valid claims, or an id occurs twice.
    """
    claims: list[Claim] = []
    for path in map(Path, paths):
        try:
            found = yaml.safe_load(path.read_text("utf-8"))
            claims += TypeAdapter(list[Claim]).validate_python(found)
        except (yaml.YAMLError, ValidationError) as error:
            raise LedgerError(f"{path}: {error}") from error
        refuse_repeats([claim.id for claim in claims], f"{path}: claimed twice")
    return claims


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
    """Write the findings of a scene as a JSON list, with the fields that were given."""
    records = [finding.model_dump(mode="json", exclude_unset=True) for finding in findings]
    write_text(path, json.dumps(records, indent=2, ensure_ascii=False) + "\n")


def unit_of_last_digit(printed: str) -> Fraction:
    """One unit of the last printed digit: 1/100 for 8.83, 1/10000 for 1.11e-2."""
    mantissa, _, exponent = printed.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return Fraction(10) ** (int(exponent or 0) - decimals)


def judge_value(printed: str, ours: float) -> Status:
    """Hold our number against the printed digits, in exact arithmetic.

    Parameters
    ----------
    printed : str
        The number as printed.
    ours : float
        Our number, finite.

    Returns
    -------
    Status
        REPRODUCED up to half a unit of the last printed digit, WITHIN_ROUNDING up to one unit,
        DEVIATES beyond.
    """
    units = abs(Fraction(ours) - Fraction(printed)) / unit_of_last_digit(printed)
    if units <= Fraction(1, 2):
        return Status.REPRODUCED
    return Status.WITHIN_ROUNDING if units <= 1 else Status.DEVIATES


def relative_deviation(printed: str, ours: float) -> float:
    """(ours - printed)/printed; nan where 0 is printed."""
    p = float(printed)
    return (ours - p) / p if p else math.nan


def judge(claim: Claim, finding: Finding) -> tuple[Status, float | str, float]:
    """Return the status of a claim, our number or evidence, and the relative deviation."""
    if claim.kind == "value":
        return _judge_number(claim, finding)
    return _judge_statement(claim, finding)


def _judge_number(claim: Claim, finding: Finding) -> tuple[Status, float | str, float]:
    if finding.has_verdict:
        raise LedgerError(f"{claim.id}: a value has a number of ours, not a verdict")
    if finding.evidence:
        raise LedgerError(f"{claim.id}: evidence is for statements; a value explains by its reason")
    if finding.ours is None:
        return Status.NOT_TESTABLE, "", math.nan
    status = judge_value(claim.text, finding.ours)
    return status, finding.ours, relative_deviation(claim.text, finding.ours)


def _judge_statement(claim: Claim, finding: Finding) -> tuple[Status, float | str, float]:
    if not finding.has_verdict:
        raise LedgerError(f"{claim.id}: a statement needs a verdict: true, false or null")
    if finding.ours is not None:
        raise LedgerError(f"{claim.id}: a statement has no number of ours; put it in the evidence")
    if not finding.evidence.strip():
        raise LedgerError(f"{claim.id}: a statement needs evidence, one sentence with our figures")
    words = {True: Status.REPRODUCED, False: Status.REFUTED, None: Status.NOT_TESTABLE}
    return words[finding.verdict], finding.evidence.strip(), math.nan


def refuse_repeats(ids: Iterable[str], complaint: str) -> None:
    """Raise LedgerError, with the complaint and the names, if some come twice."""
    if repeated := sorted(name for name, count in Counter(ids).items() if count > 1):
        raise LedgerError(f"{complaint}: {', '.join(repeated)}")
