"""The inputs and the results of every study."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from fracparticles.errors import FracparticlesError
from fracparticles.files import intact, write_text
from fracstudy.findings import Finding

if TYPE_CHECKING:
    import xarray as xr

__all__ = [
    "NUMERALS",
    "ORDERS",
    "Inputs",
    "Result",
    "write_table",
]

ORDERS = {2: "II", 4: "IV"}
"""The orders of the paper, as it writes them."""
NUMERALS = {**ORDERS, 6: "VI", 8: "VIII", 10: "X", 12: "XII"}
"""All orders of kernels, written like these."""


@dataclass(frozen=True)
class Inputs:
    """The inputs that a scene gives to its study.

    Attributes
    ----------
    scene : str
        Name of the scene.
    items : sequence of str
        The items of the documents that it judges.
    runs : sequence of str
        The run files of the scene, in the order of its configuration.
    tables : mapping
        Tables of other scenes that this one reads, by scene.
    benchmarks : mapping
        The data of benchmarks that it reads, by scene, one row for each measurement; the machine is in `attrs`.
    printed : mapping
        The printed numbers of its items by claim.
    """

    scene: str
    items: Sequence[str] = ()
    runs: Sequence[str] = ()
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    benchmarks: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    printed: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def scalars(self) -> pd.DataFrame:
        """One row for each run: every scalar of its file, and the path of the file as `run`."""
        import netCDF4

        rows = []
        for path in self.runs:
            with netCDF4.Dataset(intact(Path(path))) as file:
                # Nothing is masked or scaled, and checking it for each number takes as long as all the rest.
                file.set_auto_maskandscale(False)
                row = {
                    name: _plain(variable.getValue())
                    for name, variable in file.variables.items()
                    if not variable.dimensions
                }
            rows.append({**row, "run": path})
        return pd.DataFrame(rows)

    def open(self, **selection: Any) -> xr.Dataset:
        """Return the one run whose scalars have the values selected.

        Raises
        ------
        FracparticlesError
            If there is not exactly one.
        """
        from fracparticles.run.dataset import read_run

        found = self.select(**selection)
        if len(found) != 1:
            raise FracparticlesError(
                f"{self.scene}: {len(found)} runs with {selection}; the scene's configuration must hold one"
            )
        return read_run(found["run"].iloc[0])

    def select(self, **selection: Any) -> pd.DataFrame:
        """Return the rows of `scalars` with the values selected; numbers are compared to 6 digits."""
        found = self.scalars
        for name, wanted in selection.items():
            column = found[name]
            if isinstance(wanted, str):
                found = found[column == wanted]
            else:
                found = found[np.isclose(column.astype(float), wanted, rtol=1e-6, atol=0.0)]
        return found

    def judged(self, findings: Iterable[Finding]) -> list[Finding]:
        """Return the findings on claims of the scene's items."""
        return [finding for finding in findings if finding.claim.split(".")[0] in self.items]


@dataclass(frozen=True)
class Result:
    """The results of a study.

    Attributes
    ----------
    table : DataFrame
        The scene's table, as people read it.
    findings : sequence of Finding
        One for each claim that the scene judges.
    series : DataFrame, optional
        The data of the scene's figure in long form: panel, series, x, y and other columns that the figure needs.
    """

    table: pd.DataFrame
    findings: Sequence[Finding] = ()
    series: pd.DataFrame | None = None


def write_table(table: pd.DataFrame, csv: Path, md: Path | None = None) -> None:
    """Write a table as CSV with full precision and, if `md` is given, as Markdown with four digits and | escaped."""
    write_text(csv, table.to_csv(index=False, lineterminator="\n") if len(table.columns) else "\n")
    if md is not None:
        shown = table.map(_shown).astype(object).where(table.notna(), None)
        shown = shown.rename(columns=_shown)
        text = shown.to_markdown(index=False, floatfmt=".4g", missingval="")
        write_text(md, f"{text}\n")


def _shown(cell: Any) -> Any:
    if isinstance(cell, str):
        return cell.replace("|", r"\|")
    return cell + 0.0 if isinstance(cell, float) else cell  # no -0


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else value
