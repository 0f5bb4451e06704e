"""Moving particles: sums, remeshing, diffusion velocities, the random walk and markers, where they may go wrong."""

from collections.abc import Sequence
from itertools import product

from fracparticles.errors import FracparticlesWarning
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import frame, quiet
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
    probes = [
        *sums.probes(particles),
        *velocity_fields.probes(cloud, orders),
        *velocity_limits.probes(cloud, orders),
        *walk.probes(walkers),
        *markers.probes(shapes, markers_in_a_run, supports),
        *equations.probes(markers_in_a_run, reynolds),
    ]
    with quiet(FracparticlesWarning):  # half of the steps are beyond the limit
        for order, factor in product(orders, _FACTORS):
            found, predicted = velocity_limits.growth_of_a_wave(order, factor)
            panels.add("growth", f"DVM {order}", factor, found, predicted=predicted)
        for name, factor in product(markers.SMOOTH, _FACTORS):
            found, predicted = markers.wave_growth(name, factor)
            panels.add("growth", name, factor, found, predicted=predicted)
    velocity_limits.add_overlap_errors(panels, cloud, orders)
    markers.add_support_errors(panels, markers_in_a_run, supports)
    series = panels.frame[["series", "x", "y", "predicted", "panel", "spoke"]]
    return Result(frame(probes), (), series)
