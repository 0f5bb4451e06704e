"""A case made ready for many initial data: kernels, transforms, far field, time series."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import FracparticlesError, InvalidInput, NonFiniteSolution
from fracparticles.graded.field import INTERPOLATED, graded_step
from fracparticles.lattice.operators import LatticeOperator, MatrixOperator
from fracparticles.run.advection import named
from fracparticles.run.case import Case, a_case
from fracparticles.run.initial import bare_strengths, refuse_non_finite
from fracparticles.run.stability import warn_if_unstable
from fracparticles.run.times import parts
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import largest_degree, spectral_interval
from fracparticles.time import (
    STEP_POLYNOMIALS,
    Flow,
    Snapshots,
    exponential_flow,
    exponential_snapshots,
    march,
    power_flow,
    power_snapshots,
    single_pass,
    step,
)
from fracparticles.time.stepping import all_finite
from fracparticles.time.whole_space import WholeSpace

__all__ = ["Prepared", "in_range", "matrix_of", "prepare", "scheme_amplification"]

_LARGEST_MATRIX = 16384  # particles, rows of a matrix of 2 GiB
_NEAR_ONE = 16  # binary digits: strengths whose greatest is nearer to one are not scaled
_RATES = 1e-8, 1e8  # D / h^alpha: outside of these A u may over- or underflow though u does not
Advance = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Prepared:
    """A case made ready: all that does not depend on the initial data.

    It is meant for many bare arrays. Unlike `fp.solve` it makes no estimates; `reliability` makes them from the arrays.
    Threads may share it; they take turns at the operator.

    Attributes
    ----------
    case : Case
    operator : LatticeOperator or None
        A; on graded particles the matrix of the step; None for a run by one pair of transforms.
    operator_applications : int
        How often a solve applies A, unless the data need more pieces, see `time.pieces`.
    advance : callable
        From the strengths at `t_initial`, shape (N^dim,), to those at `t_final`, or at each of the `times`.
    """

    case: Case
    operator: LatticeOperator | None
    operator_applications: int
    advance: Advance

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The lattice, (N,) * dim."""
        return self.case.shape

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return the strengths at `t_final` from those at `t_initial`, both of the shape of the lattice.

        For a case with `times` the result has one more axis, the first, with an entry for each time.

        Raises
        ------
        InvalidInput
            If the strengths have another shape, or are not real, masked, or not finite.
        NonFiniteSolution
            If the solution blows up; names the scheme, the step and the time.
        """
        return self.run(u0)[0]

    def run(self, u0: np.ndarray) -> tuple[np.ndarray, int]:
        """Return the strengths as `solve` does, and how often the operator was applied."""
        u0 = bare_strengths(u0, self.shape)
        return in_range(self._run, u0) if self._scales else self._run(u0)

    @cached_property
    def _scales(self) -> bool:
        """Whether the rate is so far from one that A u may over- or underflow though u does not."""
        return not _RATES[0] < self.case.setting.rate < _RATES[1]

    def _run(self, u0: np.ndarray) -> tuple[np.ndarray, int]:
        applications = self.operator_applications
        flat = u0 if u0.ndim == 1 else u0.reshape(-1)
        try:
            if isinstance(self.advance, Flow | Snapshots):
                u, applications = self.advance.run(flat)
            else:
                u = self.advance(flat)
        except NonFiniteSolution as error:
            # Judged only now: it takes time, and the data are rarely the cause.
            refuse_non_finite(u0, self.case.x)
            raise named(self.case, error) from None
        shape = u0.shape if self.case.times is None else (len(self.case.times), *u0.shape)
        return u.reshape(shape), applications

    def as_matrix(self) -> np.ndarray:
        """Return the whole run as one matrix, shape (N^dim, N^dim): u(t_final) = M u(t_initial).

        It serves many initial data on few particles: up to some hundred of these a product with M is faster than sums
        by FFT. It takes N^dim solves.

        Raises
        ------
        InvalidInput
            If it would take more than 2 GiB, or the case has several output times.
        """
        if self.case.times is not None:
            one = "nothing for one matrix: each output time has its own"
            raise InvalidInput("times", self.case.times, one, "Give t_final.")
        return matrix_of(self.solve, self.shape)


def in_range(
    run: Callable[[np.ndarray], tuple[np.ndarray, int]], u0: np.ndarray
) -> tuple[np.ndarray, int]:
    """Do a linear run on strengths near one, which are those given times a power of two, and scale the result back.

    A u has the unit of u over that of time, and may over- or underflow though u does not. Otherwise all bits are equal.
    """
    exponent = int(np.frexp(np.abs(u0).max())[1])
    if abs(exponent) <= _NEAR_ONE:
        return run(u0)
    u, applications = run(np.ldexp(u0, -exponent))
    with np.errstate(over="ignore"):  # said below
        u = np.ldexp(u, exponent)
    if not all_finite(u.reshape(-1)):
        raise NonFiniteSolution("the particle strengths overflow: change the unit of u")
    return u, applications


def matrix_of(solve: Advance, shape: tuple[int, ...]) -> np.ndarray:
    """Return a linear map of arrays of a shape as a matrix, whose columns are the images of the unit vectors.

    Raises
    ------
    InvalidInput
        If the matrix would take more than 2 GiB.
    """
    size = int(np.prod(shape))
    if size > _LARGEST_MATRIX:
        most = f"at most {_LARGEST_MATRIX} for a matrix"
        raise InvalidInput("particles", size, most, "Use solve for each of the data.")
    columns = [solve(unit).reshape(-1) for unit in np.eye(size).reshape(-1, *shape)]
    return np.ascontiguousarray(np.array(columns).T)


def prepare(case: Case, operator: LatticeOperator | None = None) -> Prepared:
    """Do what does not depend on the initial data: kernels, transforms, far field, time series.

    Parameters
    ----------
    case : Case
        The run; not of DVM, whose particles move.
    operator : LatticeOperator, optional
        The operator of the case, if it exists already.

    Raises
    ------
    InvalidInput
        If the particles move, or the operator has another number of particles.
    NonFiniteSolution
        If the time steps would overflow.
    """
    a_case(case)
    if case.kind.moving:
        resting = "a scheme whose particles stay on the lattice"
        remedy = f"Use solve: the operator of {case.scheme} depends on the solution."
        raise InvalidInput("scheme", case.scheme, resting, remedy)
    runs = parts(case)
    if len(runs) > 1 or runs[0] is not case:
        return _all_outputs(case, [prepare(one) for one in runs])
    if case.is_graded:
        whole = _graded_step(case)
        return Prepared(case, whole, 1, partial(single_pass, whole, 1.0, 0.0))
    if case.evaluation == "convolution":
        return Prepared(case, None, 1, _on_the_whole_space(case))
    if operator is None:
        operator = SCHEMES[case.scheme].operator(case.setting)
    elif check.instance("operator", operator, LatticeOperator).size != case.particles:
        fits = f"an operator of the {case.particles} particles of the case"
        raise InvalidInput("operator", f"one of {operator.size}", fits, "Leave it out.")
    warn_if_unstable(case, operator)
    if case.steps_taken:
        polynomial = STEP_POLYNOMIALS[case.resolved_integrator]
        dt, steps = case.time_step, case.steps
        applications = steps * polynomial.stages
        if case.times is not None:
            through = partial(march, operator, polynomial, case.legs)
            return Prepared(case, operator, applications, through)
        if applications == 1:
            return Prepared(case, operator, 1, partial(single_pass, operator, dt, 1.0))
        return Prepared(
            case, operator, applications, partial(step, operator, polynomial, dt, steps)
        )
    low, high = spectral_interval(case.scheme, case.setting, operator, case.steps)
    most = largest_degree(case.scheme, case.setting, operator)
    try:
        flow = _flow(case, operator, low, high, most)
    except NonFiniteSolution as error:
        raise named(case, error) from None
    except FracparticlesError as error:
        reached = f"a time that can be reached: {error}"
        remedy = "Take a shorter run, or a larger spacing."
        raise InvalidInput("t_final", case.t_final, reached, remedy) from None
    return Prepared(case, operator, flow.operator_applications, flow)


def _flow(
    case: Case, operator: LatticeOperator, low: float, high: float, most: int | None
) -> Flow | Snapshots:
    """Return the run as a function of the operator, or one for each output time."""
    if case.resolved_integrator == "exponential":
        if case.times is None:
            return exponential_flow(operator, case.span, low, high, most)
        spans = [time - case.t_initial for time in case.times]
        return exponential_snapshots(operator, spans, low, high, most)
    polynomial = STEP_POLYNOMIALS[case.resolved_integrator]
    if case.times is None:
        return power_flow(operator, polynomial, case.time_step, case.steps, low, high, most)
    return power_snapshots(operator, polynomial, case.legs, low, high, most)


def _all_outputs(case: Case, ready: list[Prepared]) -> Prepared:
    """Return the run with the output times of several runs from the same strengths."""
    applications = sum(one.operator_applications for one in ready)
    reached = [time for one in ready for time in one.case.times or (one.case.t_final,)]
    order = np.argsort(reached, kind="stable")

    def advance(u0: np.ndarray) -> np.ndarray:
        outputs = [one.solve(u0.reshape(case.shape)).reshape(-1, u0.size) for one in ready]
        return np.concatenate(outputs)[order]

    return Prepared(case, ready[-1].operator, applications, advance)


def _on_the_whole_space(case: Case) -> Advance:
    """Return the run on the infinite lattice, exp(A t) or the steps of GPSE, by one pair of transforms."""
    setting = case.setting
    run = WholeSpace(
        setting.size,
        case.dim,
        case.alpha,
        case.span * setting.rate,
        amplification=scheme_amplification(case),
        terms=setting.far_terms,
    )

    def advance(u0: np.ndarray) -> np.ndarray:
        with np.errstate(invalid="ignore", over="ignore"):  # said below
            u = run.solve(u0.reshape(case.shape)).reshape(-1)
        if not all_finite(u):
            raise NonFiniteSolution("the particle strengths are not finite at the final time")
        return u

    return advance


def scheme_amplification(case: Case, exact: bool = False) -> Callable[[np.ndarray], np.ndarray]:
    """Return the factor of the run for waves of the infinite lattice, as a function of theta; see `WholeSpace`.

    With `exact` it is exp(A t) for any integrator, except for GPSE, whose steps are part of the scheme.
    """
    setting = case.setting
    scaled_time = case.span * setting.rate

    def amplification(theta: np.ndarray) -> np.ndarray:
        symbol = SCHEMES[case.scheme].symbol(theta, setting)
        if case.kind.self_timed or not (exact or case.resolved_integrator == "exponential"):
            return (1.0 + scaled_time / case.steps * symbol) ** case.steps
        return np.exp(scaled_time * symbol)

    return amplification


def _graded_step(case: Case) -> LatticeOperator:
    """Return the run on graded particles, one step, as an operator."""
    assert case.graded_scale is not None
    time = case.diffusivity * case.span
    form = case.graded_form or INTERPOLATED
    return MatrixOperator(
        graded_step(case.particles, case.reach, case.graded_scale, case.alpha, time, form)
    )
