"""The study of a scene that has none of its own: a plain table of its runs."""

from __future__ import annotations

from fracstudy.inputs import Inputs, Result

__all__ = ["study"]

# What is shown of every run; the parameters that differ between the runs come before.
_SHOWN = {
    "relative_l1_error": "relative error",
    "mass_initial": "mass at the start",
    "mass_final": "mass at the end",
    "operator_applications": "operator applications",
}


def study(inputs: Inputs) -> Result:
    """Return one row a run: the parameters that differ, the error (48), the masses, the operator applications."""
    runs = inputs.scalars
    shown = [name for name in _SHOWN if name in runs]
    differ = [
        name
        for name in runs
        if name not in (*shown, "run") and runs[name].nunique(dropna=False) > 1
    ]
    constant = [name for name in ("scheme", "order", "beta") if name not in differ]
    return Result(runs[[*constant, *differ, *shown]].rename(columns=_SHOWN))
