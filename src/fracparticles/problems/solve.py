"""Solve a problem of one's own: one call does everything."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.problems.dataset import lattice_layout, to_dataset
from fracparticles.problems.fewer_particles import with_space_error
from fracparticles.problems.frozen import frozen_errors
from fracparticles.problems.integrate import integrate
from fracparticles.problems.on_domain import solve_on_domain
from fracparticles.problems.problem import Problem
from fracparticles.problems.rates import Rates, probe_source
from fracparticles.problems.reliability import estimates, warn_if_doubtful
from fracparticles.problems.tighter_steps import with_time_error
from fracparticles.run.initial import Initial, initial_strengths, of_places
from fracparticles.run.units import Units, units_of, with_units

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["solve_problem"]


def solve_problem(
    problem: Problem,
    initial: Initial | None = None,
    *,
    estimate: bool = True,
    units: Units | None = None,
) -> xr.Dataset:
    """Solve a problem, and estimate the errors of the solution.

    Parameters
    ----------
    problem : Problem
    initial : array, labelled data, callable or path, optional
        Initial strengths, as in `solve`: an array of shape `problem.case.shape`, or a function of x, or of x and y. On
        a bounded domain only these two, and the array has the shape of `problem.bounded_domain.volumes`. If left out,
        the fundamental solution at `t_initial`, for a problem with a constant order and diffusivity.
    estimate : bool
        Whether to solve on fewer particles as well, for `space_error`, the error that the particles leave, see
        `fewer_particles`; and there with smaller steps, for `time_error`, the error that the steps leave, see
        `tighter_steps`. It takes once or twice as long again, and on a bounded domain up to half a second more, or
        three times as long with a D that depends on place and time.
    units : Units, optional
        Names of the units of the numbers, for the attributes of the result; left out, those that the data name.

    Returns
    -------
    xarray.Dataset
        See `dataset.to_dataset`.

    Raises
    ------
    InvalidInput
        If the initial data do not fit, or a coefficient is wrong somewhere.
    NonFiniteSolution
        If the solution grows without bound; says when.

    Warns
    -----
    AccuracyWarning
        If the solution has reached the ends of the lattice; if the lattice does not resolve the solution, the initial
        data or a coefficient; if the steps in time leave an error; or if the solution is of the size of `atol`.

    Notes
    -----
    Before the run, coefficients that depend on t are evaluated at 1025 times, or at 65 and more if a function is valid
    only at all particles; a text, or a function that takes many times at once, also at a million times at two places.
    The steps end where they jump. A pulse that is on between two of these times is not seen: let one of `times` be in
    it.

    Examples
    --------
    >>> problem = Problem(alpha=1.5, velocity="-x", half_width=50.0, spacing=0.1, t_initial=1.0, t_final=2.0)
    >>> u = solve_problem(problem).u
    """
    remedy = "Make one: fp.Problem(alpha=1.5, ...). A fp.Case is for fp.solve."
    problem = check.instance("problem", problem, Problem, "a fp.Problem", remedy)
    estimate, units = check.flag("estimate", estimate), units_of(initial, units)
    if problem.is_bounded:
        return with_units(solve_on_domain(problem, initial, estimate), units)
    plain = problem.order_coefficient.constant is not None and problem.diffusion.constant
    if initial is None and not plain:
        given = "data of your own: there is no fundamental solution with these coefficients"
        raise InvalidInput("initial", None, given, "Pass an array, or a function.")
    initial = None if initial is None else of_places(initial, problem.dim)
    # So t_initial counts as given, even if it is the default.
    case = problem.case.model_copy(update={"t_initial": problem.t_initial})
    u0, origin = initial_strengths(case, initial)
    probe_source(problem, u0)
    result = integrate(problem, Rates(problem), u0.reshape(-1))
    fields = [one.reshape(u0.shape) for one in result.u]
    found = estimates(problem, [u0, *fields], initial)
    sampled = initial is None or callable(initial)
    if estimate:
        found = with_space_error(
            found, problem, initial if sampled else u0, fields, _fields_of, _known
        )
        found = with_time_error(found, problem, initial if sampled else u0, _fields_of)
    warn_if_doubtful(problem, found)
    data = to_dataset(problem, lattice_layout(problem), u0, result, found, origin)
    return with_units(data, units)


def _fields_of(problem: Problem, initial: Initial | None) -> list[np.ndarray]:
    u0, _ = initial_strengths(problem.case, initial)
    return [u.reshape(u0.shape) for u in integrate(problem, Rates(problem), u0.reshape(-1)).u]


def _known(
    problem: Problem, initial: Initial | None, fields: list[np.ndarray]
) -> list[list[np.ndarray]]:
    return frozen_errors(problem, initial, initial_strengths(problem.case, initial)[0], fields)
