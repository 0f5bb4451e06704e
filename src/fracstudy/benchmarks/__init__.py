"""The benchmarks: error against run time, run time and memory against size. A block of the configuration names each.

A benchmark is a function that returns an xarray data set of wall times, on a machine that does nothing else meanwhile.
Nothing of it enters the study's runs; studies turn its data into tables and figures.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING

from fracparticles.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["BENCHMARKS", "benchmark"]

# Name in the configuration -> module of this package; the function has the name of the benchmark.
BENCHMARKS = {
    "work_precision": "work_precision",
    "work_precision_plane": "work_precision_plane",
    "time_integration": "time_integration",
    "time_spent": "time_spent",
    "reference": "reference",
    "cost_growth": "cost_growth",
    "scattered": "scattered",
}


def benchmark(name: str) -> Callable[..., xr.Dataset]:
    """Return the benchmark of that name.

    Raises
    ------
    InvalidInput
        If there is none.
    """
    if name not in BENCHMARKS:
        raise InvalidInput(
            "benchmark", name, f"one of {', '.join(BENCHMARKS)}", "Choose one of these."
        )
    return getattr(import_module(f"{__name__}.{BENCHMARKS[name]}"), name)
