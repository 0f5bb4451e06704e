"""What a solution says of its accuracy: has it reached the ends of the lattice, does the lattice resolve it.

As `run.reliability`, at each output time:

outside_share
    The share of int |u| beyond the lattice, if u goes on as c |x|^(-n-alpha) from the outermost particles.
far_field_error
    In an open exterior, how far the powers that continue u miss it at particles that they were not made to meet, times
    that share, times the share that travels from the outside well into the lattice during the run.
resolution
    s theta, the overlap (but at least 1.1) times the wavenumber of u in units of 1 / h.
"""

from __future__ import annotations

import warnings

import numpy as np

from fracparticles.errors import AccuracyWarning
from fracparticles.problems.problem import Problem
from fracparticles.run.reliability import LIMITS, outside_share, tail_misfit, wavenumber
from fracparticles.special.stable import central_mass

__all__ = ["estimates", "warn_if_doubtful"]

Estimates = dict[str, tuple[list[float], str]]

_LEAST_SMOOTHING = 1.1  # as there


def estimates(problem: Problem, solutions: list[np.ndarray]) -> Estimates:
    """Return each estimate by name: a value for each output time, the worse of it and t_initial, and what it is.

    Parameters
    ----------
    problem : Problem
    solutions : list of arrays, shape (N, .., N)
        At t_initial and at each output time.
    """
    case = problem.case
    smoothing = max(_LEAST_SMOOTHING, case.resolved_overlap)
    outside = [outside_share(case, u) for u in solutions]
    found = {
        "outside_share": (_since_start(outside), "estimated share of |u| beyond the lattice"),
        "resolution": (
            _since_start([smoothing * wavenumber(u) for u in solutions]),
            "epsilon times the wavenumber of u",
        ),
    }
    if problem.exterior == "open":
        travels = 1.0 - float(
            central_mass(0.5 * case.reach, case.diffusivity * problem.span, case.alpha, case.dim)
        )
        misfits = [
            tail_misfit(case, u) * share * travels if np.any(u) else 0.0
            for u, share in zip(solutions, outside, strict=True)
        ]
        meaning = "estimated relative error of the far field"
        found["far_field_error"] = (_since_start(misfits), meaning)
    return found


def _since_start(values: list[float]) -> list[float]:
    return [float(max(values[0], value)) for value in values[1:]]


def warn_if_doubtful(problem: Problem, found: Estimates) -> None:
    """Warn of each estimate that is too large, with the first output time at which it is.

    Warns
    -----
    AccuracyWarning
    """
    reach = f"|x| <= {problem.half_width:.4g}"
    says = {
        "outside_share": f"the solution has reached the ends of {reach}: about {{:.2g}} of it lies beyond, or has "
        "left. Take a wider lattice, or an earlier end",
        "resolution": f"particles of spacing {problem.case.spacing:.3g} do not resolve the solution: epsilon times its "
        "wavenumber is {:.2g}. Take a smaller spacing",
        "far_field_error": "the far field leaves a relative error of about {:.1g}: the powers that continue u beyond "
        f"{reach} miss it inside. Take a wider lattice",
    }
    times = problem.output_times
    for name, (values, _) in found.items():
        late = [(t, value) for t, value in zip(times, values, strict=True) if value > LIMITS[name]]
        if late:
            t, value = late[0]
            text = f"by t = {t:.4g} {says[name].format(value)}."
            warnings.warn(text, AccuracyWarning, stacklevel=3)
