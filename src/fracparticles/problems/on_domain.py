"""A problem on a bounded domain: its right-hand side between particles, and the way through time.

    v' = B(t) v + div(...) of what is held outside - div(a u) + f(x, t, u) - w',    u = w + v,

w has the values outside, v = 0 there, and B is D A, or the exchange with the mean of a pair, or on the interval

    D A v + D' grad^beta v = div(D grad^beta v).

On the interval and the disc B is taken in its modes: those of the greatest D of the run at each place, so that what is
left, like all else, is for the exponential integrator of `bounded.exponential`, and with a velocity, or a D that
changes in time, on the interval for the implicit one of `bounded.implicit`. On the square the lattice is not stiff, and
the integrators of the whole space take it as it is.
"""

from __future__ import annotations

import hashlib
import warnings
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.bounded.exponential import Modes
from fracparticles.bounded.given import Outside
from fracparticles.bounded.implicit import ImplicitSteps
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.modal import ModalDomain
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.problems.dataset import domain_layout, to_dataset
from fracparticles.problems.integrate import Integration, advanced, integrate
from fracparticles.problems.problem import Problem
from fracparticles.problems.rates import over_time, probe_source, reaction_of
from fracparticles.problems.sudden import sudden_changes
from fracparticles.time.steps import Steps

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["DomainRates", "solve_on_domain"]

_LOOKS = 33  # at a diffusivity that depends on time
_KNOWN = 1e12  # of the slowest rate; the modes know 1e15 of it
_SMALL = 1e-8  # a difference of u over u
_FAST, _FASTEST = 100.0, 2e4  # rates of a source times the time of the run
_FADED = 0.01  # of the greatest |u|, the absolute tolerance
_UNRESOLVED = 0.02  # of the norm of v, in modes that the particles do not tell apart


class DomainRates:
    """The right-hand side of a problem on a bounded domain.

    Attributes
    ----------
    evaluations : int
        How often it has been asked for.
    lift : callable
        w and what it does, by time.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem, self.domain, self.evaluations = problem, problem.bounded_domain, 0
        start, at = problem.t_initial, self.domain.points
        self._varies = bool(problem.diffusion.depends_on - {"t"})
        anywhere = (np.array(0.0),) * problem.dim
        self._d = over_time(problem.diffusion, at if self._varies else anywhere, start=start)
        self._flux = self._varies and problem.form == "FPSE"
        self._velocity = [over_time(one, at, start=start) for one in problem.transport]
        self._source = reaction_of(problem)
        self.lift = self.domain.lift_in_time(_outside(problem), start, problem.span)
        self.shape = self.domain.volumes.shape
        linear = (problem.diffusion, *problem.transport)
        self._steady_matrix = all("t" not in one.depends_on for one in linear)
        self._matrix: np.ndarray | None = None
        self._kept: tuple[float, tuple[Any, Any, list[Any]]] | None = None

    def __call__(self, t: float, u: np.ndarray) -> np.ndarray:
        """Return dv/dt for v = u, flat as that."""
        field = u.reshape(self.shape)
        with np.errstate(over="ignore", invalid="ignore"):
            return np.asarray(self._spread(field, self._now(t)[0]) + self.beside(t, field)).reshape(
                -1
            )

    def beside(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return dv/dt without D A v, or the exchange of v."""
        return self._forcing(t, v) + self._lower(t, v)

    def _forcing(self, t: float, v: np.ndarray) -> np.ndarray:
        """What is held outside, and the source."""
        self.evaluations += 1
        now, (d, slope, velocity), domain = self.lift(t), self._now(t), self.domain
        total = d * now.load - now.slope
        if self._flux:
            total = total + slope * now.flux
        elif self._varies and self.problem.exterior == "given":
            total = total + domain.spread(now.base, d) - d * domain.applied(now.base)
        if velocity and self.problem.exterior == "given":
            total = total + domain.carried(0.0 * v, now.base, velocity)
        if self._source is not None:
            total = total + self._source(t, v + now.base)
        return np.asarray(total)

    def _lower(self, t: float, v: np.ndarray) -> np.ndarray:
        """The linear parts of lower order than the diffusion."""
        total, (_, slope, velocity) = np.zeros(v.shape), self._now(t)
        if self._flux:
            total += slope * self._line.gradient(v)
        if velocity:
            total += self.domain.carried(v, 0.0 * v, velocity)
        return total

    def _now(self, t: float) -> tuple[Any, Any, list[Any]]:
        """D, D' and a at one time, kept until another is asked for."""
        if self._kept is None or self._kept[0] != t:
            d = self._d(t)
            slope = self._line.slope(d) if self._flux else None
            self._kept = t, (d, slope, [one(t) for one in self._velocity])
        return self._kept[1]

    @cached_property
    def modes(self) -> Modes:
        """Those of the greatest D of the run."""
        problem, domain = self.problem, self.domain
        assert isinstance(domain, ModalDomain)
        if not self._varies:
            modes = domain.all_modes()
            return modes._replace(rates=float(self._greatest) * modes.rates)
        return domain.modes_with(np.asarray(self._greatest), problem.form)

    def beside_modes(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return dv/dt without what is in the modes."""
        return self._forcing(t, v) + self.modes.back(self._in_modes(t, v))

    def derivative_in_modes(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return the derivative of what is beside the modes, between their amplitudes, shape (N, N)."""
        modes = self.modes
        if not self._steady_matrix or self._matrix is None:
            columns = (self._in_modes(t, modes.back(e)) for e in np.eye(modes.rates.size))
            self._matrix = np.stack(list(columns), axis=1) * (modes.rates < self._known)
        if self.problem.is_linear:
            return self._matrix
        slope = self.source_slope(t, v)
        columns = (modes.into(slope * modes.back(e)) for e in np.eye(modes.rates.size))
        return self._matrix + np.stack(list(columns), axis=1)

    def source_slope(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return df/du at the particles, by a difference."""
        if self._source is None or self.problem.is_linear:
            return np.zeros(v.shape)
        u = v + self.lift(t).base
        small = _SMALL * max(float(np.abs(u).max()), _SMALL)
        return np.asarray((self._source(t, u + small) - self._source(t, u)) / small)

    def _in_modes(self, t: float, v: np.ndarray) -> Any:
        """What is linear beside the modes, left out of those so fast that no more is known of their rates."""
        part = self._lower(t, v)
        if "t" in self.problem.diffusion.depends_on:
            part += self._spread(v, self._now(t)[0] - self._greatest)  # linear in D
        known = np.where(self.modes.rates < self._known, self.modes.into(part), 0.0)
        if self.problem.exterior == "reflecting":
            known.flat[0] = 0.0  # of the constant: the total
        return known

    @cached_property
    def _known(self) -> float:
        rates = self.modes.rates
        return _KNOWN * float(rates[rates > 0.0].min())

    @cached_property
    def _line(self) -> Interval:
        assert isinstance(self.domain, Interval)
        return self.domain

    @cached_property
    def _greatest(self) -> np.ndarray:
        if "t" not in self.problem.diffusion.depends_on:
            return self._d(self.problem.t_initial)
        looks = np.linspace(self.problem.t_initial, self.problem.t_final, _LOOKS)
        return np.asarray(np.max([self._d(t) for t in looks], axis=0))

    def _spread(self, v: np.ndarray, d: np.ndarray) -> np.ndarray:
        if self._varies and not self._flux:
            return self.domain.spread(v, d)
        return np.asarray(d * self.domain.applied(v))


def solve_on_domain(problem: Problem, initial: Any) -> xr.Dataset:
    """Solve a problem on a bounded domain, see `solve.solve_problem`."""
    u0, origin = _initial(problem, initial)
    _look_at_coefficients(problem)
    probe_source(problem, u0)
    rates = DomainRates(problem)
    v0 = u0 - rates.lift(problem.t_initial).base
    if isinstance(rates.domain, ModalDomain):
        result = _in_modes(problem, rates, u0, v0)
    else:
        held = float(np.abs(u0 - v0).max())
        result = integrate(problem, rates, v0.reshape(-1), held)
    fields = [one.reshape(u0.shape) for one in result.u]
    shares = []
    for t, v in zip(problem.output_times, fields, strict=True):
        waves = rates.domain.unresolved(v)
        v += rates.lift(t).base
        shares.append(waves / max(rates.domain.norm(v), 1e-300))
    # The steps are accurate to this, whatever becomes of u.
    atol = problem.atol or problem.rtol * float(np.abs(u0).max())
    faded = [atol / max(float(np.abs(v).max()), 1e-300) for v in fields]
    found = {
        "unresolved_share": (shares, "share of u in waves that the particles do not tell apart"),
        "atol_share": (faded, "absolute tolerance over the greatest |u|"),
    }
    if max(faded) > _FADED:
        text = f"the steps are accurate to {atol:.2g}, {max(faded):.2g} of the greatest |u| at an output time."
        remedy = "Take a smaller rtol, or atol, or an earlier end."
        warnings.warn(f"{text} {remedy}", AccuracyWarning, stacklevel=3)
    for t, share in zip(problem.output_times, shares, strict=True):
        if share > _UNRESOLVED:
            text = f"by t = {t:.4g} the particles do not resolve the solution: {share:.2g} of it is in waves that they"
            warnings.warn(f"{text} do not tell apart. Take more.", AccuracyWarning, stacklevel=3)
            break
    return to_dataset(problem, domain_layout(problem), u0, result, found, origin)


def _in_modes(problem: Problem, rates: DomainRates, u0: np.ndarray, v0: np.ndarray) -> Integration:
    domain, modes = rates.domain, rates.modes
    assert isinstance(domain, ModalDomain)
    size = u0
    if problem.atol is not None:
        size = np.full(u0.shape, problem.atol / problem.rtol)
    steps: Steps = domain.steps_with(modes, rates.beside_modes, problem.rtol, size)
    method = "exponential"
    fastest = problem.span * float(np.abs(rates.source_slope(problem.t_initial, v0)).max())
    if fastest > _FASTEST and problem.domain == "disc":
        shown = f"a rate of {fastest / problem.span:.3g}"
        what = f"a source whose rates times the time of the run are below {_FASTEST:g} on the disc"
        raise InvalidInput("source", shown, what, "End before, or take the square.")
    moves = problem.transport or "t" in problem.diffusion.depends_on or fastest > _FAST
    if moves and problem.domain == "interval":
        least = float(np.linalg.norm(modes.into(size)))
        steps = ImplicitSteps(
            modes, rates.beside_modes, rates.derivative_in_modes, problem.rtol, least
        )
        method = "radau"
    outputs = advanced(problem, steps, v0, sudden_changes(problem, u0))
    return Integration(
        outputs, method, steps.accepted, steps.rejected, rates.evaluations,
        problem.span * float(modes.rates.max()),
    )  # fmt: skip


def _outside(problem: Problem) -> Outside | None:
    g = problem.outside
    if g is None:
        return None

    def at(*place: Any) -> np.ndarray:
        return np.array(g.checked(dict(zip(g.variables, place, strict=True))))

    return Outside(at, "t" in g.depends_on)


def _look_at_coefficients(problem: Problem) -> None:
    """Warn if the particles do not resolve what varies in space, in three moments."""
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
                # What is compared is int |..|, whose kinks are no matter.
                lifted = 0.0 if one.field == "source" else level
                return one({**dict(zip(("x", "y"), place, strict=False)), **now}) + lifted

            problem.bounded_domain.seen(one.field, at)


def _initial(problem: Problem, initial: Any) -> tuple[np.ndarray, str]:
    """The initial strengths, and where they come from."""
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
