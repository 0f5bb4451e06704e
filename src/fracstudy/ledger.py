"""The ledger: what is printed and what we measured, judged, side by side; as a table, as CSV and as Markdown."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from fracparticles.files import write_text
from fracstudy.claims import (
    LedgerError,
    Sentence,
    Statement,
    Value,
    read_conventions,
    refuse_repeats,
)
from fracstudy.criteria import Condition, Convention, Judged, Status, judge_value, judged
from fracstudy.findings import Finding, filled

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "COLUMNS",
    "judge",
    "ledger",
    "ledger_markdown",
    "ours_text",
    "read_ledger",
    "sentence_status",
    "short_markdown",
    "summary_line",
    "write_ledger",
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
    """Judge what is printed by what was found, one row a value or statement, in the order of the print.

    Parameters
    ----------
    printed : sequence of Value or Sentence
        What the documents print.
    findings : sequence of Finding
        What we measured, exactly one for each value and statement that can be tested.
    conventions : mapping, optional
        What words mean; by default those of the project.
    smoke : bool
        Whether the grids are too coarse, which is then the reason of every verdict that has none.

    Returns
    -------
    pandas.DataFrame
        Columns `COLUMNS`, all text but: `ours`, our number for a value and the evidence for a statement; `margin`, the
        worst measured number over its threshold; and `relative_deviation`, nan for statements. `sentence` is empty for
        a value.

    Raises
    ------
    LedgerError
        For a claim without a finding or with two, a finding for an unknown claim, a number that a condition or a text
        asks for and the finding lacks, and a verdict that needs a reason and has none.
    """
    import pandas as pd

    conventions = read_conventions() if conventions is None else conventions
    claims = [claim for record in printed for claim in _claims(record)]
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
        for claim in _claims(record)
    ]
    numbers = {"ours": object, "margin": float, "relative_deviation": float}
    return pd.DataFrame(rows, columns=list(COLUMNS)).astype(numbers)


def _claims(record: Value | Sentence) -> Sequence[Value | Statement]:
    return [record] if isinstance(record, Value) else record.statements


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
        "sentence": "" if isinstance(record, Value) else record.sentence,
        "id": claim.id,
        "item": claim.item,
        "where": record.where,
        "printed": record.printed if isinstance(record, Value) else record.words,
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
    """The measured numbers, each after what it is."""
    shown = (f"{c.means}: {_shown(finding.numbers[c.of])}" for c in conditions)
    return "; ".join(dict.fromkeys(shown)) + "."


def _shown(number: Any) -> str:
    """A number, a few, or the ends of many, by case if they have one."""
    if isinstance(number, Mapping):
        pairs = [(m, f"{m:.3g} ({case})") for case, m in number.items()]
    else:
        pairs = [(m, f"{m:.3g}") for m in (number if isinstance(number, list) else [number])]
    if len(pairs) <= _FEW:
        return ", ".join(words for _, words in pairs)
    (_, least), (_, greatest) = (end(pairs, key=lambda pair: pair[0]) for end in (min, max))
    return f"{least} to {greatest}, {len(pairs)} {'cases' if isinstance(number, Mapping) else 'numbers'}"


def sentence_status(statuses: Iterable[str]) -> Status:
    """Return the one verdict on a sentence from those on the statements that it makes.

    What cannot be tested is left out unless nothing else is said. A sentence is true in part if some of it holds and
    some does not.
    """
    found = {Status(status) for status in statuses}
    tested = found - {Status.NOT_TESTABLE} or found
    if len(tested) == 1:
        return tested.pop()
    return Status.MISPRINT if tested == {Status.REPRODUCED, Status.MISPRINT} else Status.PART


def summary_line(df: pd.DataFrame, shown: pd.Series | None = None) -> str:
    """Count the ledger in one line: the printed numbers, and the sentences, each with one verdict.

    Parameters
    ----------
    df : DataFrame
        The ledger.
    shown : Series of bool, optional
        The rows to count; a sentence counts if one of its statements does, with the verdict on the whole of it.

    Returns
    -------
    str
        As in "66 printed numbers: 36 reproduced, 12 within the print's rounding, 18 deviate; 180 sentences: 140
        reproduced, 20 true in part, 12 refuted, 7 misprints, 1 not testable".
    """
    values, sentences = _split(df, shown)
    counts = (
        ("printed number", Counter(Status(row["status"]) for row in values)),
        ("sentence", Counter(whole for whole, _ in sentences)),
    )
    words = {
        Status.REPRODUCED: ("reproduced", "reproduced"),
        Status.WITHIN_ROUNDING: ("within the print's rounding",) * 2,
        Status.PART: ("true in part", "true in part"),
        Status.DEVIATES: ("deviates", "deviate"),
        Status.REFUTED: ("refuted", "refuted"),
        Status.MISPRINT: ("misprint", "misprints"),
        Status.NOT_TESTABLE: ("not testable", "not testable"),
    }
    parts = []
    for noun, count in counts:
        if total := count.total():
            each = ", ".join(
                f"{count[s]} {word[count[s] > 1]}" for s, word in words.items() if count[s]
            )
            parts.append(f"{total} {noun}{'s' if total > 1 else ''}: {each}")
    return "; ".join(parts) or "no claims"


_Row = dict[str, Any]


def _split(
    df: pd.DataFrame, shown: pd.Series | None
) -> tuple[list[_Row], list[tuple[Status, list[_Row]]]]:
    """The rows of printed numbers, and those of each sentence with the verdict on the whole of it."""
    statuses: dict[str, list[str]] = {}
    for sentence, status in zip(df["sentence"], df["status"], strict=True):
        statuses.setdefault(sentence, []).append(status)
    values: list[_Row] = []
    sentences: dict[str, list[_Row]] = {name: [] for name in statuses if name}
    for row in (df if shown is None else df[shown]).to_dict("records"):
        (sentences[row["sentence"]] if row["sentence"] else values).append(row)
    judged_whole = ((sentence_status(statuses[name]), rows) for name, rows in sentences.items())
    return values, [(whole, rows) for whole, rows in judged_whole if rows]


def ledger_markdown(df: pd.DataFrame, shown: pd.Series | None = None) -> str:
    """Render the ledger as Markdown: a table of the values, then one of the sentences and what they say.

    Either is left out when it has no rows.

    Parameters
    ----------
    df : DataFrame
        The ledger.
    shown : Series of bool, optional
        The rows to show; a sentence keeps the verdict on the whole of it.
    """
    values, sentences = _split(df, shown)
    of_values = [
        (
            _named(row),
            row["printed"],
            ours_text(row["printed"], row["ours"]),
            _percent(row["relative_deviation"]),
            _status(row["status"]),
            _joined(row["reason"], row["note"]),
        )
        for row in values
    ]
    of_sentences = [
        (
            _quoted(row, whole) if row is rows[0] else "″",
            _named(row),
            _cell(row["ours"]),
            _joined(row["criterion"], _margin(row["margin"])),
            _status(row["status"]),
            _joined(*_remarks(row)),
        )
        for whole, rows in sentences
        for row in rows
    ]
    tables = (
        _table(("claim", "printed", "ours", "deviation", "verdict", "remarks"), of_values),
        _table(
            ("as printed", "statement", "ours", "criterion", "verdict", "remarks"), of_sentences
        ),
    )
    return "\n".join(table for table in tables if table)


def short_markdown(df: pd.DataFrame, shown: pd.Series, ledger: str) -> str:
    """Render rows of the ledger for a page: printed, ours, verdict, and a link to the whole row.

    Parameters
    ----------
    df : DataFrame
        The ledger.
    shown : Series of bool
        The rows to show.
    ledger : str
        Where the whole ledger is, relative to the page.
    """
    values, sentences = _split(df, shown)

    def verdict(row: _Row) -> str:
        return f"[{_status(row['status'])}]({ledger}#{row['id']})"

    of_values = [
        (
            _cell(row["what"]),
            row["printed"],
            ours_text(row["printed"], row["ours"]),
            _percent(row["relative_deviation"]),
            verdict(row),
        )
        for row in values
    ]
    of_sentences = [
        (
            _quoted(row, whole) if row is rows[0] else "″",
            _joined(*dict.fromkeys((row["what"], row["ours"]))),
            verdict(row),
        )
        for whole, rows in sentences
        for row in rows
    ]
    tables = (
        _table(("claim", "printed", "ours", "deviation", "verdict"), of_values),
        _table(("as printed", "measured", "verdict"), of_sentences),
    )
    return "\n".join(table for table in tables if table)


def _named(row: _Row) -> str:
    """The claim in words, below its id, to which pages link."""
    return f'<a id="{row["id"]}"></a>`{row["id"]}`<br>{_cell(row["what"])}'


def _quoted(row: _Row, whole: Status) -> str:
    """The sentence, and the verdict on the whole of it where that is another than that on the statement beside it."""
    quote = f"“{_cell(row['printed'])}” ({_cell(row['where'])})"
    return quote if whole == row["status"] else f"{quote}<br>as a whole: {_status(whole)}"


def _remarks(row: _Row) -> Iterator[str]:
    yield row["reason"]
    yield f"Holds for {row['holds_for']}." if row["holds_for"] else ""
    yield f"Not for {row['fails_for']}." if row["fails_for"] else ""
    yield f"Close call: {row['close_call']}." if row["close_call"] else ""
    yield f"Criterion changed: {row['changed']}" if row["changed"] else ""
    yield row["note"]


def _table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    if not rows:
        return ""
    numbers = ("printed", "ours", "deviation") if "deviation" in head else ()
    rule = tuple("--:" if name in numbers else ":--" for name in head)
    lines = (head, rule, *rows)
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def _status(word: str) -> str:
    status = Status(word)
    return f"{status.sign} {status}"


def _margin(margin: float) -> str:
    return "" if math.isnan(margin) else f"margin {margin:.3g}"


def _joined(*parts: str) -> str:
    return "<br>".join(_cell(part) for part in parts if part)


def ours_text(printed: str, ours: float | str) -> str:
    """Our number with two digits more than the print, or our evidence as it is."""
    if isinstance(ours, str):
        return ours
    mantissa, _, exponent = printed.partition("e")
    decimals = len(mantissa.partition(".")[2]) + 2
    if not exponent:
        return f"{ours:.{decimals}f}"
    return f"{ours / 10.0 ** int(exponent):.{decimals}f}e{exponent}"


def _percent(deviation: float) -> str:
    return "" if math.isnan(deviation) else f"{100 * deviation:+.3g} %".replace("+0 %", "0 %")


def _cell(text: str) -> str:
    """Text that a Markdown table shows as it is, on one line."""
    for mark in "\\|*_`[":
        text = text.replace(mark, f"\\{mark}")
    return " ".join(text.replace("&", "&amp;").replace("<", "&lt;").split())


def write_ledger(
    df: pd.DataFrame, csv_path: str | os.PathLike[str], md_path: str | os.PathLike[str]
) -> None:
    """Write the ledger as CSV and as Markdown, each whole or not at all."""
    write_text(csv_path, df.to_csv(index=False, lineterminator="\n"))
    write_text(md_path, f"{summary_line(df)}\n\n{ledger_markdown(df)}")


def read_ledger(csv_path: str | os.PathLike[str]) -> pd.DataFrame:
    """Read back what `write_ledger` wrote as CSV.

    Raises
    ------
    LedgerError
        If the columns are not those of a ledger.
    """
    import pandas as pd

    df = pd.read_csv(csv_path, dtype=str, keep_default_na=False, encoding="utf-8")
    if tuple(df.columns) != COLUMNS:
        raise LedgerError(f"{csv_path}: the columns are {[*df.columns]}, not those of a ledger")
    is_value = (df["sentence"] == "") & (df["ours"] != "")
    ours = [float(o) if number else o for o, number in zip(df["ours"], is_value, strict=True)]
    df["ours"] = pd.Series(ours, dtype=object)
    for name in ("margin", "relative_deviation"):
        df[name] = [float(number or "nan") for number in df[name]]
    return df
