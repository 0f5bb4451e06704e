"""Moving particles: sums, remeshing, diffusion velocities, the random walk and markers, where they may go wrong."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from itertools import chain, product

import pandas as pd

from fracparticles.errors import FracparticlesWarning
from fracstudy.inputs import Inputs, Result
from fracstudy.probe import frame
from scenes.extremes.moving_particles import diffusion_velocity, equations, markers, sums, walk

__all__ = ["study"]

_FACTORS = (0.5, 0.8, 0.95, 1.05, 1.2, 1.5)  # of the limit of a step
_SMOOTH = ("S4", "S6", "S8")


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
    probes = chain(
        sums.probes(particles),
        diffusion_velocity.probes(orders, half_width, spacing),
        walk.probes(walkers),
        markers.probes(shapes, markers_in_a_run, supports),
        equations.probes(markers_in_a_run, reynolds),
    )
    errors = pd.concat(
        [
            diffusion_velocity.overlap_errors(half_width, spacing, orders),
            markers.support_errors(markers_in_a_run, supports),
        ]
    )
    return Result(
        frame(probes),
        (),
        pd.concat([_growth(orders), errors.assign(panel="error")], ignore_index=True),
    )


def _growth(orders: Sequence[int]) -> pd.DataFrame:
    rows = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FracparticlesWarning)  # half of them are beyond the limit
        for order, factor in product(orders, _FACTORS):
            rows.append(
                (f"DVM {order}", factor, *diffusion_velocity.growth_of_a_wave(order, factor))
            )
        for name, factor in product(_SMOOTH, _FACTORS):
            rows.append((name, factor, *markers.wave_growth(name, factor)))
    columns = ["series", "x", "y", "predicted"]
    return pd.DataFrame(rows, columns=columns).assign(panel="growth")
