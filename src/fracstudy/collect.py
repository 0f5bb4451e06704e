"""All runs of the study as one data set: their parameters, their results, and the files that hold the fields.

>>> runs = xr.open_dataset("results/runs.nc").to_dataframe()
>>> kpse = runs.query("scheme == 'KPSE' and order == 4 and beta == 0.5 and exterior == 'open'")
>>> kpse.plot("particle_spacing", "relative_l1_error", loglog=True)
>>> u = xr.open_dataset(kpse.file.iloc[0]).u
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import netCDF4
import pandas as pd
import xarray as xr

from fracparticles.run.dataset import write
from fracstudy.inputs import Inputs

__all__ = ["collect"]

_KEPT = ("Conventions", "source", "references")


def collect(files: Sequence[str], out: Path) -> None:
    """Write one data set of all runs, with the dimension `run`: every scalar of each run, and its file.

    Parameters
    ----------
    files : sequence of str
        The run files.
    out : Path
        The file of the data set. Where a run has no scalar of a name, it holds nan or an empty text.
    """
    frame = Inputs("all runs", runs=files).scalars.rename(columns={"run": "file"})
    names = {"file": "file of the run"}
    for path in frame["file"]:
        if not frame.columns.isin(names).all():
            with netCDF4.Dataset(path) as run:
                names |= {name: run[name].long_name for name in run.variables}
                attributes = {name: run.getncattr(name) for name in _KEPT}
    variables = {}
    for name, column in frame.items():
        about = {"long_name": names[name]}
        if pd.api.types.is_numeric_dtype(column):
            variables[name] = ("run", column.to_numpy(float), {**about, "units": "1"})
        else:
            variables[name] = ("run", column.fillna("").to_numpy(str), about)
    data = xr.Dataset(
        variables,
        attrs={
            **attributes,
            "title": "All runs of the study: parameters, results, and the file of each",
            "history": "fracstudy.collect",
        },
    )
    write(data, out)
