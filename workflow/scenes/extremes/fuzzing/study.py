"""Fuzzing: what holds of whatever is given, tried on cases that a seed draws."""

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.probe import frame
from scenes.extremes.fuzzing import configuration, domains, fields, flags, functions, problems, runs
from scenes.extremes.fuzzing.harness import OF_MODULE, row

_MODULES = (fields, runs, functions, problems, domains, flags, configuration)
PROPERTIES = [one for module in _MODULES for one in OF_MODULE[module.__name__]]


def study(inputs: Inputs, *, cases: int) -> Result:
    """One row a property: how many of its cases were right, warned of, refused, or bad.

    Of some `cases` in all each property has its share, from seed 0 on.
    """
    shares = sum(one.share for one in PROPERTIES)
    rows = [row(one, max(1, round(cases * one.share / shares))) for one in PROPERTIES]
    counts = pd.DataFrame([counts for _, counts in rows])
    return Result(pd.concat([frame(probe for probe, _ in rows), counts], axis=1))
