"""Run times of the reduced fundamental solution: ours, and scipy's density of the stable law."""

from collections.abc import Sequence
from functools import partial

import numpy as np

from fracparticles.special import reduced_green
from fracstudy.race.clock import Measurements, forget_tables, measure, one_core, timings_dataset

_FARTHEST = 100.0  # in units of the scale
_VARIABLES = {
    "table_time": ("the first evaluation, which makes the table of alpha, once", "s"),
    "point_time": ("ours, one point of many, minimum", "s"),
    "scipy_time": ("scipy's levy_stable, one point of some, once", "s"),
}


def benchmark(
    alpha: Sequence[float], points: int, points_of_scipy: int, repeats: int
) -> Measurements:
    """Time evaluations at equally spaced points of 0 <= x <= 100, so many at once of ours and of scipy's."""
    from scipy.stats import levy_stable  # here alone: it takes long to import

    one_core()
    many, few = (np.linspace(0.0, _FARTHEST, n) for n in (points, points_of_scipy))
    reduced_green(few, alpha[0])  # compiles what is not compiled yet
    rows = []
    for one in alpha:
        forget_tables()
        first, _ = measure(partial(reduced_green, few, one))
        ours, _ = measure(partial(reduced_green, many, one), repeats)
        theirs, _ = measure(partial(levy_stable.pdf, few, one, 0.0))
        row = {"alpha": one, "table_time": first.minimum, "point_time": ours.minimum / points}
        rows.append({**row, "scipy_time": theirs.minimum / points_of_scipy})
    labels = {"alpha": "fractional order alpha"}
    title = "Run times of the fundamental solution"
    return timings_dataset("order", rows, labels, _VARIABLES, title, {"repeats": repeats})
