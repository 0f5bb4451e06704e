"""The messages of a call of the workflow in the terminal.

At the start they say what exists already; at the end, the verdicts in a line, the slowest jobs, and where to look.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path

from fracstudy.ledger_text import read_ledger, summary_line

__all__ = ["already", "shortly", "slowest", "summary"]


def shortly(names: Iterable[str], most: int = 5) -> str:
    """Return names in one line; if there are many, only the first ones and the number of the others."""
    shown = sorted(names)
    more = len(shown) - most
    return ", ".join(shown) if more <= 1 else f"{', '.join(shown[:most])} and {more} more"


def slowest(metadata: Path, since: float, count: int = 5) -> list[tuple[float, str]]:
    """Return the rules whose jobs took longest since a time, with their seconds, from Snakemake's notes on each file.

    Parameters
    ----------
    metadata : Path
        The folder of the notes, one file in JSON for each output.
    since : float
        In seconds since the epoch; jobs that ended before are not of this call.
    count : int
        The number of rules.
    """
    jobs: dict[str, float] = {}
    for path in metadata.rglob("*"):
        if path.is_file():
            try:
                record = json.loads(path.read_text("utf-8"))
                started, ended, rule = record["starttime"], record["endtime"], record["rule"]
            except (ValueError, KeyError, OSError):
                continue  # a note that is being written, or one of another version
            if ended and ended >= since:
                jobs[rule] = max(jobs.get(rule, 0.0), ended - started)
    return sorted(((took, rule) for rule, took in jobs.items()), reverse=True)[:count]


def summary(claims: Path, pages: Iterable[Path], jobs: Iterable[tuple[float, str]]) -> str:
    """Return the summary of a call, with a line for each part that exists."""
    lines = [summary_line(read_ledger(claims)) + "."] if claims.is_file() else []
    slow = ", ".join(f"{rule.removeprefix('make_')} {took:.0f} s" for took, rule in jobs)
    lines += [f"What took longest: {slow}."] if slow else []
    there = ", ".join(str(page) for page in pages if page.exists())
    lines += [f"Where to look: {there}."] if there else []
    return "\n".join(lines)


def already(where: Path, kinds: Mapping[str, Iterable[Iterable[Path]]]) -> str:
    """Return the contents of a folder of results before a call, with one count for each kind of thing.

    Parameters
    ----------
    where : Path
        The folder.
    kinds : mapping
        The things of each kind, each as its files.
    """
    counts = []
    for kind, things in kinds.items():
        there = [all(file.exists() for file in files) for files in things]
        counts.append(f"{sum(there)} of {len(there)} {kind}")
    return f"Already in {where}: {', '.join(counts)}; what is up to date is not made again."
