"""The ledger: claims and findings side by side, as a table, as CSV and as Markdown."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from fracparticles.files import write_text
from fracstudy.claims import (
    PRINTED_NUMBER,
    Claim,
    Finding,
    LedgerError,
    Status,
    judge,
    refuse_repeats,
)

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "COLUMNS",
    "ledger",
    "ledger_markdown",
    "ours_text",
    "read_ledger",
    "summary_line",
    "write_ledger",
]

COLUMNS = (
    "id",
    "item",
    "what",
    "printed",
    "ours",
    "relative_deviation",
    "status",
    "reason",
    "runs",
)


def ledger(printed: Sequence[Claim], findings: Sequence[Finding]) -> pd.DataFrame:
    """Join claims and findings, one row a claim, in the order of the claims.

    Parameters
    ----------
    printed : sequence of Claim
        What the documents print.
    findings : sequence of Finding
        What we found, exactly one for each claim.

    Returns
    -------
    pandas.DataFrame
        Columns `COLUMNS`. `printed` is text; `ours` is our number for a value and the evidence for
        a statement; `relative_deviation` is nan for statements; `status` is a word of `Status`;
        `runs` are joined by "; ".

    Raises
    ------
    LedgerError
        For a claim without a finding or with two, a finding for an unknown claim, a finding of the
        wrong kind, and a deviation, refutation or untestable claim without a reason. A deviation
        with its reason never raises.
    """
    import pandas as pd

    known = [claim.id for claim in printed]
    refuse_repeats(known, "claimed twice")
    refuse_repeats([finding.claim for finding in findings], "found twice")
    found = {finding.claim: finding for finding in findings}
    if unknown := sorted(found.keys() - set(known)):
        raise LedgerError(f"finding for an unknown claim: {', '.join(unknown)}")
    if missing := [claim for claim in known if claim not in found]:
        raise LedgerError(f"claim without a finding: {', '.join(missing)}")
    rows = [_row(claim, found[claim.id]) for claim in printed]
    return pd.DataFrame(rows, columns=list(COLUMNS)).astype({"relative_deviation": float})


def _row(claim: Claim, finding: Finding) -> dict[str, object]:
    status, ours, deviation = judge(claim, finding)
    # A study gives the reason for the case that its number deviates; one that does not needs none.
    reason = "" if status is Status.REPRODUCED else finding.reason.strip()
    if status.needs_reason and not reason:
        raise LedgerError(f"{claim.id}: the status is {status!s}, and no reason is given")
    values = (
        claim.id, claim.item, claim.what, claim.text, ours, deviation, str(status), reason,
        "; ".join(finding.runs),
    )  # fmt: skip
    return dict(zip(COLUMNS, values, strict=True))


def summary_line(df: pd.DataFrame) -> str:
    """Count the ledger in one line.

    Returns
    -------
    str
        As in "71 claims: 52 reproduced, 9 within the print's rounding, 6 deviate, 4 refuted,
        0 not testable".
    """
    count = Counter(Status(word) for word in df["status"])
    noun = "claim" if len(df) == 1 else "claims"
    return (
        f"{len(df)} {noun}: {count[Status.REPRODUCED]} reproduced, "
        f"{count[Status.WITHIN_ROUNDING]} within the print's rounding, "
        f"{count[Status.DEVIATES]} deviate, {count[Status.REFUTED]} refuted, "
        f"{count[Status.NOT_TESTABLE]} not testable"
    )


def ledger_markdown(df: pd.DataFrame) -> str:
    """Render rows of the ledger as Markdown: a table of the values, then one of the statements.

    Either is left out when it has no rows. The columns are printed, ours, deviation (values only),
    status and reason, after the claim.
    """
    is_value = df["printed"].str.match(PRINTED_NUMBER)
    values = [
        (
            _claim_cell(row),
            row["printed"],
            ours_text(row["printed"], row["ours"]),
            _percent(row["relative_deviation"]),
            _status_cell(row),
            _cell(row["reason"]),
        )
        for row in df[is_value].to_dict("records")
    ]
    statements = [
        (
            _claim_cell(row),
            _cell(row["printed"]),
            _cell(row["ours"]),
            _status_cell(row),
            _cell(row["reason"]),
        )
        for row in df[~is_value].to_dict("records")
    ]
    tables = (
        _table(("claim", "printed", "ours", "deviation", "status", "reason"), values),
        _table(("claim", "printed", "ours", "status", "reason"), statements),
    )
    return "\n".join(table for table in tables if table)


def _table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    if not rows:
        return ""
    numbers = ("printed", "ours", "deviation") if "deviation" in head else ()
    rule = tuple("--:" if name in numbers else ":--" for name in head)
    lines = (head, rule, *rows)
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def _claim_cell(row: dict[str, str]) -> str:
    return f"`{row['id']}`<br>{_cell(row['what'])}"


def _status_cell(row: dict[str, str]) -> str:
    status = Status(row["status"])
    return f"{status.sign} {status}"


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
    for mark in ("\\", "|", "*", "`"):
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
    is_value = df["printed"].str.match(PRINTED_NUMBER) & (df["ours"] != "")
    ours = [float(o) if number else o for o, number in zip(df["ours"], is_value, strict=True)]
    df["ours"] = pd.Series(ours, dtype=object)
    df["relative_deviation"] = [float(deviation or "nan") for deviation in df["relative_deviation"]]
    return df
