"""The ledger as text: counted in a line, as Markdown, as CSV."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from fracparticles.files import write_text
from fracstudy.ledger import COLUMNS
from fracstudy.verdicts import LedgerError, Status

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "ledger_markdown",
    "ours_text",
    "read_ledger",
    "sentence_status",
    "short_markdown",
    "summary_line",
    "write_ledger",
]


def sentence_status(statuses: Iterable[str]) -> Status:
    """Return the verdict on a sentence from the verdicts on its statements.

    Statements that cannot be tested are left out, unless there are no others. A sentence is true in part if some of its
    statements hold and some do not.
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
        The rows to count. A sentence counts if one of its statements does, with the verdict on the whole sentence.

    Returns
    -------
    str
        As in "66 printed numbers: 36 reproduced, 12 within the print's rounding, 18 deviate; 180 sentences: 140
        reproduced, 20 true in part, 12 refuted, 7 misprints, 1 not testable".
    """
    values, sentences = _split(df, shown)
    counts = {
        "printed number": Counter(Status(row["status"]) for row in values),
        "sentence": Counter(whole for whole, _ in sentences),
    }
    parts = []
    for noun, count in counts.items():
        if total := count.total():
            each = ", ".join(f"{count[s]} {_counted(s, count[s])}" for s in Status if count[s])
            parts.append(f"{total} {noun}{'s' if total > 1 else ''}: {each}")
    return "; ".join(parts) or "no claims"


def _counted(status: Status, count: int) -> str:
    """The verdict as a word after a number."""
    if status is Status.DEVIATES:
        return "deviates" if count == 1 else "deviate"
    plural = "s" if status is Status.MISPRINT and count > 1 else ""
    return str(status).removeprefix("reproduced ") + plural


_Row = dict[str, Any]
_Columns = Mapping[str, Callable[[_Row], str]]  # heading: the text of a cell from a row


def _split(
    df: pd.DataFrame, shown: pd.Series | None
) -> tuple[list[_Row], list[tuple[Status, list[_Row]]]]:
    """The rows of printed numbers, and the rows of each sentence with the verdict on the whole sentence."""
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
    """Render the ledger as Markdown: a table of the values, then one of the sentences and their statements.

    Either is left out when it has no rows.

    Parameters
    ----------
    df : DataFrame
        The ledger.
    shown : Series of bool, optional
        The rows to show; a sentence keeps the verdict on the whole sentence.
    """
    of_values = {
        "claim": _named,
        **_NUMBERS,
        "verdict": _verdict,
        "remarks": lambda row: _joined(row["reason"], row["note"]),
    }
    of_statements = {
        "statement": _named,
        "ours": lambda row: _cell(row["ours"]),
        "criterion": lambda row: _joined(row["criterion"], _margin(row["margin"])),
        "verdict": _verdict,
        "remarks": lambda row: _joined(*_remarks(row)),
    }
    return _tables(df, shown, of_values, of_statements)


def short_markdown(df: pd.DataFrame, shown: pd.Series, ledger: str) -> str:
    """Render rows of the ledger for a page: printed, ours, verdict, and a link to the whole row.

    Parameters
    ----------
    df : DataFrame
        The ledger.
    shown : Series of bool
        The rows to show.
    ledger : str
        The path of the whole ledger, relative to the page.
    """

    def verdict(row: _Row) -> str:
        return f"[{_verdict(row)}]({ledger}#{row['id']})"

    def measured(row: _Row) -> str:
        return _joined(*dict.fromkeys((row["what"], row["ours"])))

    of_values = {"claim": lambda row: _cell(row["what"]), **_NUMBERS, "verdict": verdict}
    return _tables(df, shown, of_values, {"measured": measured, "verdict": verdict})


def _tables(
    df: pd.DataFrame, shown: pd.Series | None, of_values: _Columns, of_statements: _Columns
) -> str:
    values, sentences = _split(df, shown)
    statements = [
        {**row, "quoted": _quoted(row, whole) if row is rows[0] else "″"}
        for whole, rows in sentences
        for row in rows
    ]
    quoted: _Columns = {"as printed": lambda row: row["quoted"], **of_statements}
    return "\n".join(filter(None, (_table(of_values, values), _table(quoted, statements))))


def _table(columns: _Columns, rows: Sequence[_Row]) -> str:
    if not rows:
        return ""
    numbers = _NUMBERS if "deviation" in columns else ()
    rule = ("--:" if name in numbers else ":--" for name in columns)
    lines = (columns, rule, *([cell(row) for cell in columns.values()] for row in rows))
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def _named(row: _Row) -> str:
    """The claim in words, below its id, to which pages link."""
    return f'<a id="{row["id"]}"></a>`{row["id"]}`<br>{_cell(row["what"])}'


def _quoted(row: _Row, whole: Status) -> str:
    """The sentence, and the verdict on the whole of it if the statement beside it has another verdict."""
    quote = f"“{_cell(row['printed'])}” ({_cell(row['where'])})"
    return quote if whole == row["status"] else f"{quote}<br>as a whole: {_status(whole)}"


def _remarks(row: _Row) -> Iterator[str]:
    yield row["reason"]
    yield f"Holds for {row['holds_for']}." if row["holds_for"] else ""
    yield f"Not for {row['fails_for']}." if row["fails_for"] else ""
    yield f"Close call: {row['close_call']}." if row["close_call"] else ""
    yield f"Criterion changed: {row['changed']}" if row["changed"] else ""
    yield row["note"]


def _verdict(row: _Row) -> str:
    return _status(row["status"])


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


_NUMBERS: _Columns = {
    "printed": lambda row: row["printed"],
    "ours": lambda row: ours_text(row["printed"], row["ours"]),
    "deviation": lambda row: _percent(row["relative_deviation"]),
}


def write_ledger(
    df: pd.DataFrame, csv_path: str | os.PathLike[str], md_path: str | os.PathLike[str]
) -> None:
    """Write the ledger as CSV and as Markdown; each file is written whole or not at all."""
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
