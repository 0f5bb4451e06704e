"""Moving particles: sums, remeshing, diffusion velocities, the random walk and markers, where they may go wrong."""

from collections.abc import Callable, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import frame, overheard, probes_of, quiet
from scenes.extremes.moving_particles import (
    equations,
    markers,
    sums,
    velocity_fields,
    velocity_limits,
    walk,
)
from scenes.extremes.moving_particles.cloud import Cloud

_FACTORS = (0.5, 0.8, 0.95, 1.05, 1.2, 1.5)  # of the limit of a step


def study(
    inputs: Inputs,
    *,
    particles: int,
    orders: Sequence[int],
    half_width: float,
    spacing: float,
    walkers: int,
    shapes: Sequence[str],
    markers_in_a_run: int,
    supports: Sequence[float],
    reynolds: Sequence[float],
) -> Result:
    """One row a probe.

    The series: what a step multiplies the fastest wave by, measured and predicted; and errors of runs against the
    overlap or support, with whether they spoke.
    """
    cloud, panels = Cloud(half_width, spacing), Panels()
    given = {"orders": orders, "walkers": walkers, "shapes": shapes, "count": markers_in_a_run}
    given |= {"cloud": cloud, "supports": supports, "reynolds": reynolds}
    modules = (velocity_fields, velocity_limits, walk, markers, equations)
    probes = [*probes_of(sums, **sums.particles_of(particles)), *probes_of(*modules, **given)]
    waves: list[tuple[str, Callable[..., tuple[float, float]], Sequence[Any]]] = [
        ("DVM {}", velocity_limits.wave_growth, orders),
        ("{}", markers.wave_growth, markers.SMOOTH),
    ]
    runs: list[tuple[str, Callable[..., float], Sequence[Any], Sequence[float]]] = [
        ("DVM {}", partial(velocity_limits.case_error, cloud), orders, velocity_limits.OVERLAPS),
        ("{}", partial(markers.support_error, markers_in_a_run), markers.SUPPORTED, supports),
    ]
    with quiet():  # half of the steps are beyond the limit
        for name, growth, kinds in waves:
            for kind, factor in product(kinds, _FACTORS):
                found, predicted = growth(kind, factor)
                panels.add("growth", name.format(kind), factor, found, predicted=predicted)
        for name, error, kinds, ratios in runs:
            for kind, ratio in product(kinds, ratios):
                with overheard() as words:
                    try:
                        y = error(kind, ratio)
                    except ArithmeticError:  # refused
                        y = np.nan
                panels.add("error", name.format(kind), ratio, y, spoke=bool(words))
    return Result(
        frame(probes), (), panels.frame[["series", "x", "y", "predicted", "panel", "spoke"]]
    )
