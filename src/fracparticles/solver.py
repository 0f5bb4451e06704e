"""Run a case: `prepare` and then `solve` on bare arrays, or `solve` to a data set at once."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fracparticles.case import FUNDAMENTAL, Case
from fracparticles.errors import InvalidInput, NonFiniteSolution, StabilityWarning
from fracparticles.integrators import (
    STEP_POLYNOMIALS,
    applied,
    euler_step,
    exponential,
    power,
    step,
)
from fracparticles.operators import Operator
from fracparticles.propagator import propagator
from fracparticles.schemes import SCHEMES, dvm
from fracparticles.special.arguments import real_array
from fracparticles.special.stable import central_mass, green
from fracparticles.spectrum import spectral_interval

if TYPE_CHECKING:
    import xarray as xr

    from fracparticles.schemes.dvm import ParticleRun

__all__ = [
    "Prepared",
    "Solution",
    "advect",
    "compute",
    "initial_strengths",
    "matrix_of",
    "prepare",
    "relative_l1_error",
    "solve",
]

Initial = str | Path | np.ndarray | Callable[[np.ndarray], np.ndarray]
_LARGEST_MATRIX = 16384  # particles
Advance = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Solution:
    """What a run computes.

    Attributes
    ----------
    case : Case
    x : array, shape (N,)
        Positions along an axis.
    u0, u : array, shape (N,) * dim
        Initial and final strengths on the lattice; for DVM the final field (7) there.
    operator_applications : int
        How often the operator was applied, or the velocity evaluated.
    initial : str
        Where the initial data came from.
    particles : ParticleRun, optional
        For DVM, the particles themselves and what happened to them.
    """

    case: Case
    x: np.ndarray
    u0: np.ndarray
    u: np.ndarray
    operator_applications: int
    initial: str
    particles: ParticleRun | None = None


def solve(case: Case, initial: Initial | None = None) -> xr.Dataset:
    """Run a case.

    Parameters
    ----------
    case : Case
        The run.
    initial : array, callable or path, optional
        Initial strengths of shape `case.shape`, a function of `case.positions` (of x; of x and y; of x, y and z),
        or a NetCDF file that holds u on just these. Without it the run starts from what `case.initial` says, by
        default the fundamental solution at `case.t_initial`.

    Returns
    -------
    xarray.Dataset
        See `dataset.to_dataset`.

    Raises
    ------
    InvalidInput
        If the initial data do not fit the case.
    NonFiniteSolution
        If the run blows up.
    """
    from fracparticles.dataset import to_dataset

    return to_dataset(compute(case, initial))


def compute(case: Case, initial: Initial | None = None) -> Solution:
    """Run a case and return its arrays: `solve` without the data set."""
    u0, origin = initial_strengths(case, initial)
    if case.scheme == "DVM":
        warn_if_unstable(case)
        run = advect(case, u0)
        evaluations = run.history.velocity_evaluations
        return Solution(case, case.x, u0, run.field(case.x), evaluations, origin, run)
    ready = prepare(case)
    u = ready.solve(u0)
    return Solution(case, case.x, u0, u, ready.operator_applications, origin)


def advect(case: Case, u0: np.ndarray) -> ParticleRun:
    """Run DVM, whose particles move, and return them.

    Parameters
    ----------
    case : Case
        Of scheme "DVM".
    u0 : array, shape `case.shape`
        Initial strengths.

    Raises
    ------
    NonFiniteSolution
        If the run blows up.
    """
    try:
        return dvm.run(
            case.x,
            u0,
            spacing=case.particle_spacing,
            alpha=case.alpha,
            order=case.order,
            overlap=case.epsilon_over_h,
            diffusivity=case.diffusivity,
            start=case.t_initial,
            dt=case.time_step,
            steps=case.steps,
            remeshing=case.remeshing or "M4'",
            remesh_above=1.5 if case.remesh_above is None else case.remesh_above,
            threshold=case.threshold or 0.0,
            summation=case.summation,
        )
    except NonFiniteSolution as error:
        raise _named(case, error) from None


def initial_strengths(case: Case, initial: Initial | None = None) -> tuple[np.ndarray, str]:
    """Return the initial strengths on `case.x` and one line on where they come from."""
    source: Initial = case.initial if initial is None else initial
    if isinstance(source, str) and source == FUNDAMENTAL:
        case.refuse_point_mass()
        x = case.x if case.dim == 1 else case.radius
        u0 = np.asarray(green(x, case.diffusivity * case.t_initial, case.alpha, case.dim))
        return u0, f"fundamental solution at t = {case.t_initial:g}"
    if isinstance(source, (str, Path)):
        from fracparticles.dataset import read_strengths

        return read_strengths(Path(source), case), f"file {Path(source).name}"
    given = source(*case.positions) if callable(source) else source
    u0 = np.array(real_array("initial", given))
    if u0.shape != case.shape:
        raise _wrong_shape(u0, case.shape)
    if not np.isfinite(u0).all():
        where = case.x[np.argwhere(~np.isfinite(u0))[0]]
        raise InvalidInput(
            "initial",
            f"not finite at x = {', '.join(f'{part:g}' for part in where)}",
            "finite numbers",
            "Mend the data, or shift a singularity off the lattice.",
        )
    digest = hashlib.sha256(u0.tobytes()).hexdigest()[:16]
    return u0, f"{'callable' if callable(source) else 'array'}, sha256 {digest}"


def _wrong_shape(u0: np.ndarray, shape: tuple[int, ...]) -> InvalidInput:
    return InvalidInput(
        "initial",
        f"array of shape {u0.shape}",
        f"an array of shape {shape}, one strength for each particle of the lattice",
        "Evaluate the data on case.positions.",
    )


def warn_if_unstable(case: Case) -> None:
    """Warn, with the numbers, if the time step lies outside the stability interval.

    A single step of GPSE, the whole run, cannot grow; whoever takes it for its speed does not pay for its limit.
    """
    if case.scheme == "GPSE" and case.steps == 1:
        return
    if case.time_step > case.largest_stable_step:
        warnings.warn(
            f"dt = {case.time_step:.6g} lies outside the stability interval of {case.scheme} with "
            f"{case.method}: at most {case.largest_stable_step:.6g} is stable. The run is computed as it is.",
            StabilityWarning,
            stacklevel=3,
        )


@dataclass(frozen=True)
class Prepared:
    """A case made ready: all that does not depend on the initial data.

    Attributes
    ----------
    case : Case
    operator : Operator
        A; for the convolution in time the whole run.
    operator_applications : int
        How often a solve applies it.
    advance : callable
        From the strengths at `t_initial`, shape (N^dim,), to those at `t_final`.
    shape : tuple of int
        The lattice, (N,) * dim.
    """

    case: Case
    operator: Operator
    operator_applications: int
    advance: Advance
    shape: tuple[int, ...] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "shape", self.case.shape)

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return the strengths at `t_final` from those at `t_initial`, both of the shape of the lattice.

        Raises
        ------
        InvalidInput
            If the strengths are not of that shape.
        NonFiniteSolution
            With the scheme, the step and the time.
        """
        if u0.shape != self.shape:
            raise _wrong_shape(u0, self.shape)
        try:
            if u0.ndim == 1:
                return self.advance(u0)
            return self.advance(u0.reshape(-1)).reshape(u0.shape)
        except NonFiniteSolution as error:
            raise _named(self.case, error) from None

    def as_matrix(self) -> np.ndarray:
        """Return the whole run as one matrix, shape (N^dim, N^dim): u(t_final) = M u(t_initial).

        For many initial data on few particles: up to some hundred a product with M is faster than any sum by FFT. It
        takes N^dim solves.
        """
        return matrix_of(self.solve, self.shape)


def matrix_of(solve: Advance, shape: tuple[int, ...]) -> np.ndarray:
    """Return a linear map of arrays of that shape as a matrix, column by column: what it makes of the unit vectors.

    Raises
    ------
    InvalidInput
        If the matrix would take more than 2 GiB.
    """
    size = int(np.prod(shape))
    if size > _LARGEST_MATRIX:
        raise InvalidInput(
            "particles",
            size,
            f"at most {_LARGEST_MATRIX} for a matrix",
            "Use solve for each of the data.",
        )
    columns = [solve(unit).reshape(-1) for unit in np.eye(size).reshape(-1, *shape)]
    return np.ascontiguousarray(np.array(columns).T)


def prepare(case: Case, operator: Operator | None = None) -> Prepared:
    """Do what does not depend on the initial data: kernels, transforms, far field, time series.

    Parameters
    ----------
    case : Case
        The run; not of DVM, whose particles move.
    operator : Operator, optional
        The operator of the case, if it is there already.

    Raises
    ------
    InvalidInput
        For DVM.
    NonFiniteSolution
        If the time steps would overflow.
    """
    if case.scheme == "DVM":
        raise InvalidInput(
            "scheme",
            case.scheme,
            "a scheme whose particles stay on the lattice",
            "Use solve: DVM's operator depends on the solution.",
        )
    if case.evaluation == "convolution":
        operator = _lattice_sum(case)
        return Prepared(case, operator, 1, partial(applied, operator))
    if operator is None:
        operator = SCHEMES[case.scheme].operator(case.setting)
    warn_if_unstable(case)
    if case.steps_taken:
        polynomial, dt, steps = STEP_POLYNOMIALS[case.method], case.time_step, case.steps
        applications = steps * polynomial.stages
        if applications == 1:
            return Prepared(case, operator, 1, partial(euler_step, operator, dt))
        return Prepared(
            case, operator, applications, partial(step, operator, polynomial, dt, steps)
        )
    low, high = spectral_interval(case, operator)
    try:
        if case.method == "exponential":
            series = exponential(case.t_final - case.t_initial, low, high)
        else:
            series = power(STEP_POLYNOMIALS[case.method], case.time_step, case.steps, low, high)
    except NonFiniteSolution as error:
        raise _named(case, error) from None
    return Prepared(case, operator, series.degree, partial(series, operator))


def _lattice_sum(case: Case) -> Operator:
    """Return the run on the infinite lattice as one lattice sum: exp(A t), or the steps of GPSE."""
    setting = case.setting
    family = {} if setting.family is None else {"family": setting.family}
    scaled_time = (case.t_final - case.t_initial) * setting.rate

    def amplification(theta: np.ndarray) -> np.ndarray:
        symbol = SCHEMES[case.scheme].symbol(
            theta, case.alpha, setting.order, setting.overlap, **family
        )
        if case.method == "exponential":
            return np.exp(scaled_time * symbol)
        return (1.0 + scaled_time / case.steps * symbol) ** case.steps

    return propagator(
        amplification, case.alpha, scaled_time, setting.n, setting.exterior, setting.far_terms
    )


def _named(case: Case, error: NonFiniteSolution) -> NonFiniteSolution:
    return NonFiniteSolution(f"{case.scheme} (order {case.order}): {error}")


def relative_l1_error(case: Case, u: np.ndarray) -> float:
    """Return the error against the fundamental solution, Eqs. (48), (59), over |x| <= `case.error_radius`.

    sum_i V_i |u_i - G(x_i, t_f)| / int |G(x, t_f)| dx, the integral in closed form.
    """
    radius = np.abs(case.x) if case.dim == 1 else case.radius
    inside = radius <= case.error_radius * (1.0 + 1e-12)
    time = case.diffusivity * case.t_final
    exact = green(radius[inside], time, case.alpha, case.dim)
    deviation = case.particle_spacing**case.dim * np.abs(u[inside] - exact).sum()
    return float(deviation / central_mass(case.error_radius, time, case.alpha, case.dim))
