"""The ledger: a table of the printed claims, our measurements, and the verdicts, side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from fracstudy.claims import Sentence, Statement, Value
from fracstudy.criteria import Condition, Convention, Judged, judged
from fracstudy.findings import Finding, filled
from fracstudy.printed import read_conventions, refuse_repeats
from fracstudy.verdicts import LedgerError, Status, judge_value

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "COLUMNS",
    "judge",
    "ledger",
]

COLUMNS = (
    "sentence",
    "id",
    "item",
    "where",
    "printed",
    "what",
    "ours",
    "criterion",
    "margin",
    "relative_deviation",
    "status",
    "holds_for",
    "fails_for",
    "close_call",
    "reason",
    "note",
    "changed",
    "made_by",
    "runs",
)
_TOO_COARSE = "The grids of the smoke run are too coarse to judge this."
_FEW = 6  # cases that are listed one by one


def ledger(
    printed: Sequence[Value | Sentence],
    findings: Sequence[Finding],
    conventions: Mapping[str, Convention] | None = None,
    smoke: bool = False,
) -> pd.DataFrame:
    """Judge the printed claims by the findings, one row for each value or statement, in the order of the print.

    Parameters
    ----------
    printed : sequence of Value or Sentence
        The claims that the documents print.
    findings : sequence of Finding
        Our measurements, exactly one for each value and statement that can be tested.
    conventions : mapping, optional
        The meanings of words; by default those of the project.
    smoke : bool
        Whether the grids are too coarse. This is then the reason of every verdict that has no other.

    Returns
    -------
    pandas.DataFrame
        Columns `COLUMNS`, all text except three: `ours`, our number for a value and the evidence for a statement;
        `margin`, the worst measured number over its threshold; and `relative_deviation`, nan for statements. `sentence`
        is empty for a value.

    Raises
    ------
    LedgerError
        If a claim has no finding or two, a finding belongs to no claim, a finding lacks a number that a condition or a
        text asks for, or a verdict needs a reason and has none.
    """
    import pandas as pd

    conventions = read_conventions() if conventions is None else conventions
    claims = [claim for record in printed for claim in record.claims]
    refuse_repeats([claim.id for claim in claims], "claimed twice")
    refuse_repeats([finding.claim for finding in findings], "found twice")
    found = {finding.claim: finding for finding in findings}
    if unknown := sorted(found.keys() - {claim.id for claim in claims}):
        raise LedgerError(f"finding for an unknown claim: {', '.join(unknown)}")
    untested = {claim.id for claim in claims if getattr(claim, "untestable", "")}
    if missing := [c.id for c in claims if c.id not in found and c.id not in untested]:
        raise LedgerError(f"claim without a finding: {', '.join(missing)}")
    rows = [
        _row(record, claim, found.get(claim.id, Finding(claim=claim.id)), conventions, smoke)
        for record in printed
        for claim in record.claims
    ]
    numbers = {"ours": object, "margin": float, "relative_deviation": float}
    return pd.DataFrame(rows, columns=list(COLUMNS)).astype(numbers)


def _row(
    record: Value | Sentence,
    claim: Value | Statement,
    finding: Finding,
    conventions: Mapping[str, Convention],
    smoke: bool,
) -> dict[str, Any]:
    def text(template: str) -> str:
        try:
            return filled(template, finding)
        except LedgerError:
            if smoke:
                return _TOO_COARSE
            raise

    if isinstance(claim, Value):
        verdict = _judged_value(claim, finding)
    else:
        verdict = _judged_statement(claim, finding, conventions, text)
    status = Status(verdict["status"])
    reason = ""
    if status is not Status.REPRODUCED:
        reason = verdict.get("reason") or text(claim.reason)
    if status.needs_reason and not reason:
        if not smoke:
            raise LedgerError(f"{claim.id}: the status is {status!s}, and no reason is given")
        reason = _TOO_COARSE
    return {
        **dict.fromkeys(COLUMNS, ""),
        "sentence": record.name,
        "id": claim.id,
        "item": claim.item,
        "where": record.where,
        "printed": record.words,
        "what": claim.what,
        "margin": math.nan,
        "relative_deviation": math.nan,
        **verdict,
        "reason": reason,
        "note": text(claim.note),
        "made_by": "; ".join(claim.by or record.by),
        "runs": "; ".join(finding.runs),
    }


def judge(
    claim: Value | Statement,
    finding: Finding,
    conventions: Mapping[str, Convention] | None = None,
) -> Status:
    """Return the verdict on a claim alone."""
    if isinstance(claim, Value):
        ours = finding.numbers.get("ours")
        return Status.NOT_TESTABLE if ours is None else judge_value(claim.printed, ours)
    if claim.untestable:
        return Status.NOT_TESTABLE
    conventions = read_conventions() if conventions is None else conventions
    return _judged(claim, finding.numbers, conventions).status


def _judged(
    claim: Statement, numbers: Mapping[str, Any], conventions: Mapping[str, Convention]
) -> Judged:
    try:
        return judged(
            claim.holds, numbers, conventions, claim.intended.holds if claim.intended else ()
        )
    except LedgerError as error:
        raise LedgerError(f"{claim.id}: {error}") from None


def _judged_value(claim: Value, finding: Finding) -> dict[str, Any]:
    status = judge(claim, finding)
    if status is Status.NOT_TESTABLE:
        return {"status": str(status)}
    ours, printed = finding.numbers["ours"], float(claim.printed)
    deviation = (ours - printed) / printed if printed else math.nan
    return {"status": str(status), "ours": ours, "relative_deviation": deviation}


def _judged_statement(
    claim: Statement,
    finding: Finding,
    conventions: Mapping[str, Convention],
    text: Callable[[str], str],
) -> dict[str, Any]:
    if claim.untestable:
        return {
            "status": str(Status.NOT_TESTABLE),
            "ours": text(claim.evidence),
            "reason": text(claim.untestable),
            "changed": text(claim.changed),
        }
    own = _judged(claim, finding.numbers, conventions)
    close = list(own.close)
    for reading, others in finding.others.items():
        other = _judged(claim, finding.numbers | others, conventions).status
        close += [f"{other} with {reading}"] if other != own.status else []
    conditions, criterion = claim.holds, _in_words(claim.holds, conventions)
    if claim.intended and own.status is Status.MISPRINT:
        conditions = [*claim.holds, *claim.intended.holds]
        meant = _in_words(claim.intended.holds, conventions)
        criterion = f"as printed, {criterion}; as meant ({claim.intended.what}), {meant}"
    part = own.status is Status.PART
    return {
        "status": str(own.status),
        "ours": text(claim.evidence) or _numbers(conditions, finding),
        "criterion": criterion,
        "margin": own.margin,
        "holds_for": "; ".join(own.where) if part else "",
        "fails_for": "; ".join(own.where_not) if part else "",
        "close_call": "; ".join(close),
        "changed": text(claim.changed),
    }


def _in_words(conditions: Iterable[Condition], conventions: Mapping[str, Convention]) -> str:
    return "; ".join(f"{c.means}: {c.in_words(conventions)}" for c in conditions)


def _numbers(conditions: Iterable[Condition], finding: Finding) -> str:
    """The measured numbers, each after its meaning."""
    shown = (f"{c.means}: {_shown(finding.numbers[c.of])}" for c in conditions)
    return "; ".join(dict.fromkeys(shown)) + "."


def _shown(number: Any) -> str:
    """A number, a few numbers, or the least and the greatest of many, with their cases if they have them."""
    if isinstance(number, Mapping):
        pairs = [(m, f"{m:.3g} ({case})") for case, m in number.items()]
    else:
        pairs = [(m, f"{m:.3g}") for m in (number if isinstance(number, list) else [number])]
    if len(pairs) <= _FEW:
        return ", ".join(words for _, words in pairs)
    (_, least), (_, greatest) = (end(pairs, key=lambda pair: pair[0]) for end in (min, max))
    return f"{least} to {greatest}, {len(pairs)} {'cases' if isinstance(number, Mapping) else 'numbers'}"
