"""Particle methods for fractional diffusion.

>>> import fracparticles as fp
>>> case = fp.Case(scheme="KPSE", order=4, beta=0.5, truncation=20.0, spacing=0.05, dt=2.0e-4, exterior="open")
>>> run = fp.solve(case)
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

__version__ = "0.1.0"

# Name -> module. Imported at first use: a caller of `green` pays for neither numba kernels nor xarray.
_HOME = {
    "AccuracyWarning": "errors",
    "Case": "run.case",
    "Disc": "bounded.disc",
    "FracparticlesError": "errors",
    "FracparticlesWarning": "errors",
    "Interval": "bounded.interval",
    "InvalidInput": "errors",
    "NonFiniteSolution": "errors",
    "StabilityWarning": "errors",
    "Problem": "problems.problem",
    "Square": "bounded.square",
    "Units": "run.units",
    "WholeSpace": "time.whole_space",
    "ErrorEstimate": "run.estimate",
    "estimate_error": "run.estimate",
    "evolve": "time.whole_space",
    "evolve_long": "time.widening",
    "follow": "adaptive.follow",
    "graded_particles": "graded.particles",
    "green": "special.stable",
    "green_flux": "special.stable",
    "green_rate": "special.stable",
    "green_slope": "special.stable",
    "green_step": "graded.particles",
    "green_step_of_field": "graded.field",
    "kernel": "kernels.families",
    "mean_radius": "special.stable",
    "measured": "data.measured",
    "prepare": "run.solver",
    "read_run": "run.dataset",
    "solve": "run.solve",
    "solve_problem": "problems.solve",
    "stability_limit": "schemes.stability",
    "suggest": "run.suggest",
    "write": "run.dataset",
}

__all__ = ["__version__", *_HOME]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        # With these two, Python adds "Did you mean ...?".
        said = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(said, name=name, obj=sys.modules[__name__])
    value = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
