"""The machine on which run times were measured, in a line."""

from __future__ import annotations

import pandas as pd

__all__ = ["machine_note"]


def machine_note(frame: pd.DataFrame) -> str:
    """Return the processor, the threads and the repeats of a benchmark's data in a line."""
    facts = frame.attrs
    return f"{facts['cpu']}, one core; minimum of up to {_solves(frame)} repeats"


def _solves(frame: pd.DataFrame) -> int:
    """The greatest number of repeats; it is a column where it varies, and an attribute otherwise."""
    return int(frame["solves"].max()) if "solves" in frame else int(frame.attrs["repeats"])
