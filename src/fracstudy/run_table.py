"""The study of a scene that has none of its own: a plain table of its runs."""

from __future__ import annotations

from fracparticles.run.case import Case
from fracstudy.inputs import Inputs, Result

__all__ = ["study"]

# The columns of every run: parameters, and results by their headings.
_ALWAYS = ("scheme", "order", "beta")
_SHOWN = {
    "relative_l1_error": "relative error",
    "mass_initial": "mass at the start",
    "mass_final": "mass at the end",
    "operator_applications": "operator applications",
}


def study(inputs: Inputs) -> Result:
    """Return one row for each run: scheme, order, beta, other parameters that differ, error (48), masses, applications.

    A figure draws the same rows.
    """
    runs = inputs.scalars
    names = dict.fromkeys([*_ALWAYS, *Case.model_fields, "particle_spacing"])
    differ = [name for name in names if name in runs and runs[name].nunique(dropna=False) > 1]
    lead = [name for name in names if name in _ALWAYS or name in differ]
    shown = [name for name in _SHOWN if name in runs]
    table = runs[[*lead, *shown]].rename(columns=_SHOWN)
    return Result(table, series=table)
