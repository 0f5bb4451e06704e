"""A problem on a bounded domain and its time integration; `domain_rates` has the right-hand side.

On the interval and the disc the diffusion is solved in its modes. So is a source -c u, because its decay would set the
length of the steps. The exponential integrator of `bounded.exponential` takes the rest. On the interval the implicit
one of `bounded.implicit` takes it if there is a velocity, a D that changes in time, or a source with fast rates. On the
square the lattice is not stiff, and the integrators of the whole space serve.
"""

from __future__ import annotations

import hashlib
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.exponential import ExponentialSteps
from fracparticles.bounded.given import RESOLVED
from fracparticles.bounded.implicit import ImplicitSteps
from fracparticles.bounded.modal import ModalDomain
from fracparticles.bounded.modes import Held
from fracparticles.bounded.switching import SwitchingSteps
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.problems.dataset import domain_layout, to_dataset
from fracparticles.problems.domain_rates import DomainRates
from fracparticles.problems.fewer_particles import SPACE_ERROR, Estimates, with_space_error
from fracparticles.problems.finer_particles import errors_of_diffusion, values_of
from fracparticles.problems.integrate import (
    Integration,
    advanced,
    integrate,
    size_to_come,
)
from fracparticles.problems.plane_waves import high_waves, warn_of_growth
from fracparticles.problems.problem import Problem
from fracparticles.problems.rates import probe_source
from fracparticles.problems.sudden import sudden_changes
from fracparticles.problems.tighter_steps import TIME_ERROR, with_time_error
from fracparticles.time.fading import FADED, early_errors
from fracparticles.time.steps import Steps

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["solve_on_domain"]

# The rate of a source times the time of the run: from the first the interval takes implicit steps, and above the second
# the disc refuses the source.
_FAST, _FASTEST = 100.0, 2e4
_LOOKS = 129  # times at which the values outside are looked at
# The value of each estimate above which there is a warning.
_LIMITS = {
    "atol_share": FADED, "space_error": SPACE_ERROR, "time_error": TIME_ERROR, "unresolved_share": 0.02,
}  # fmt: skip


def solve_on_domain(problem: Problem, initial: Any, estimate: bool) -> xr.Dataset:
    """Solve a problem on a bounded domain, see `solve.solve_problem`."""
    u0, origin = _initial(problem, initial)
    _look_at_coefficients(problem)
    probe_source(problem, u0)
    rates = DomainRates(problem)
    warn_of_growth(problem, rates)
    held = _held(problem, rates, u0)
    result = _integrated(problem, rates, u0, held)
    fields = result.u
    found = {
        "unresolved_share": (
            [_in_short_waves(rates, *at) for at in zip(problem.output_times, fields, strict=True)],
            "share of u in waves that the particles do not tell apart",
        ),
        "atol_share": (
            early_errors(
                problem.rtol, (problem.t_initial, *problem.output_times), [u0, *fields],
                rates.source, rates.slowest, lambda t: float(held(t).max()),
            ),
            "errors of early steps, within their tolerance, over the greatest |u|",
        ),
    }  # fmt: skip
    if estimate:
        sampled = initial if callable(initial) else u0
        found = with_space_error(found, problem, sampled, fields, _fields_of, _known)
        found = with_time_error(found, problem, sampled, _fields_of)
    _warn(problem, found)
    return to_dataset(problem, domain_layout(problem), u0, result, found, origin)


def _fields_of(problem: Problem, initial: Any) -> list[np.ndarray]:
    u0 = values_of(problem, initial)
    rates = DomainRates(problem)
    return _integrated(problem, rates, u0, _held(problem, rates, u0)).u


def _known(problem: Problem, initial: Any, fields: list[np.ndarray]) -> list[list[np.ndarray]]:
    return errors_of_diffusion(problem, initial, fields, _fields_of)


def _integrated(problem: Problem, rates: DomainRates, u0: np.ndarray, held: Held) -> Integration:
    """Integrate v, and return u in its place."""
    v0 = u0 - rates.lift(problem.t_initial).base
    if isinstance(rates.domain, ModalDomain):
        result = _in_modes(problem, rates, u0, v0, held)
    else:
        result = integrate(problem, rates, v0.reshape(-1), lambda t: float(held(t).max()))
    at = zip(problem.output_times, result.u, strict=True)
    return replace(result, u=[v.reshape(u0.shape) + rates.lift(t).base for t, v in at])


def _in_short_waves(rates: DomainRates, t: float, u: np.ndarray) -> float:
    domain, v = rates.domain, u - rates.lift(t).base
    unresolved = domain.unresolved(v)
    if isinstance(domain, Disc) and rates.problem.transport:
        unresolved = max(unresolved, high_waves(domain, v))
    size = domain.norm(u)
    return unresolved / size if size else 0.0


def _warn(problem: Problem, found: Estimates) -> None:
    """Warn of each estimate that is too large, at its first output time; of short waves only without `space_error`."""
    says = {
        "atol_share": "u has fallen, and the steps are accurate to {:.2g} of what is left at an output time. Take a "
        "smaller rtol, or atol, or an earlier end.",
        "space_error": "the particles leave an error of about {:.1g} of u, as diffusion of the data on more of "
        "them and runs on half and a quarter say. Take more, or smoother data and coefficients.",
        "time_error": "the steps in time leave an error of about {:.1g} of u, as runs with a tenth of the tolerance "
        "say. Take a smaller rtol, or an earlier end.",
        "unresolved_share": "the particles do not resolve the solution: {:.2g} of it is in waves that they do not tell "
        "apart. Take more.",
    }
    del says["unresolved_share" if "space_error" in found else "space_error"]
    for name, text in says.items():
        if name not in found:
            continue
        for t, value in zip(problem.output_times, found[name][0], strict=True):
            if value > _LIMITS[name]:
                warnings.warn(f"by t = {t:.4g} {text.format(value)}", AccuracyWarning, stacklevel=4)
                break


def _held(problem: Problem, rates: DomainRates, u0: np.ndarray) -> Held:
    """Return the size of the values outside, or that of `atol`; without `atol`, what is little beside all that comes.

    The values outside are interpolated up to a share of the greatest: where they are less, this error is not followed.
    """
    if problem.atol:
        least = problem.atol / problem.rtol
    else:
        v0 = u0 - rates.lift(problem.t_initial).base
        swings = problem.outside is not None and "t" in problem.outside.depends_on
        times = np.linspace(problem.t_initial, problem.t_final, _LOOKS if swings else 0)
        outside = max((float(np.abs(rates.lift(t).base).max()) for t in times), default=0.0)
        least = size_to_come(problem, rates, v0.reshape(-1))
        least = max(least, RESOLVED / problem.rtol * outside)
    return lambda t: np.maximum(least, np.abs(rates.lift(t).base))


def _in_modes(
    problem: Problem, rates: DomainRates, u0: np.ndarray, v0: np.ndarray, held: Held
) -> Integration:
    modes, decay = rates.modes, rates.decay(v0)

    def beside(t: float, v: np.ndarray) -> np.ndarray:
        return rates.beside_modes(t, v) + decay * v

    decaying = modes._replace(rates=modes.rates + decay)
    explicit = ExponentialSteps(decaying, beside, problem.rtol, held)
    slope = rates.source_slope(problem.t_initial, v0) + decay
    fastest = problem.span * float(np.abs(slope).max())
    if fastest > _FASTEST and problem.domain == "disc":
        shown = f"a rate of {fastest / problem.span:.3g}"
        what = f"a source whose rates times the time of the run are below {_FASTEST:g} on the disc"
        raise InvalidInput("source", shown, what, "End before, or take the square.")
    moves = bool(problem.transport or "t" in problem.diffusion.depends_on or fastest > _FAST)
    # A decay -c u alone is a factor exp(-c t): implicit steps would follow u until it underflows.
    last = decay if problem.domain == "interval" and moves and rates.only_decays else 0.0

    def implicit() -> ImplicitSteps:
        return ImplicitSteps(
            modes,
            lambda t, v: rates.beside_modes(t, v) + last * v,
            lambda t, v: rates.derivative_in_modes(t, v) + last * np.eye(v.size),
            problem.rtol,
            held,
        )

    steps: Steps = explicit
    if problem.domain == "interval":
        steps = implicit() if moves else SwitchingSteps(explicit, implicit)
    outputs = [
        np.exp(-last * (t - problem.t_initial)) * v
        for t, v in zip(
            problem.output_times,
            advanced(problem, steps, v0, sudden_changes(problem, u0)),
            strict=True,
        )
    ]
    method = "radau" if steps.largest else "exponential"
    return Integration(
        outputs, method, steps.accepted, steps.rejected, rates.evaluations,
        problem.span * float(modes.rates.max()),
    )  # fmt: skip


def _look_at_coefficients(problem: Problem) -> None:
    """Warn if the particles do not resolve a coefficient that varies in space, at three moments."""
    every = [problem.diffusion, *problem.transport]
    if problem.reaction is not None and problem.is_linear:
        every.append(problem.reaction)
    for one in every:
        if not one.depends_on - {"t"}:
            continue
        for share in (0.0, 0.5, 1.0) if "t" in one.depends_on else (0.0,):
            now = {"t": np.array(problem.t_initial + share * problem.span), "u": np.array(0.0)}
            level = float(np.abs(one({**problem.places, **now})).max())

            def at(
                *place: np.ndarray, one: Any = one, now: Any = now, level: float = level
            ) -> np.ndarray:
                # int |..| is compared: lifted by its greatest value, a coefficient has no kinks there.
                lifted = 0.0 if one.field == "source" else level
                return one({**dict(zip(("x", "y"), place, strict=False)), **now}) + lifted

            problem.bounded_domain.seen(one.field, at)


def _initial(problem: Problem, initial: Any) -> tuple[np.ndarray, str]:
    """Return the initial strengths, and where they come from."""
    domain = problem.bounded_domain
    if initial is None or isinstance(initial, str | bytes):
        what = "a function of the place, a number or an array: a bounded domain has no fundamental solution"
        raise InvalidInput("initial", initial, what, "Pass one of these.")
    if hasattr(initial, "coords"):
        what = f"a bare array of shape {domain.volumes.shape}, whose order is that of bounded_domain.points"
        raise InvalidInput("initial", type(initial).__name__, what, "Pass its values.")
    u0 = np.array(domain.seen("initial", initial))
    digest = hashlib.sha256(u0.tobytes()).hexdigest()[:16]
    return u0, f"{'callable' if callable(initial) else 'array'}, sha256 {digest}"
