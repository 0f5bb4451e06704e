"""The right-hand side of a problem on a bounded domain, between its particles:

    v' = B(t) v + B(t) w - div(a u) + f(x, t, u) - w',    u = w + v.

The field w has the values outside, and v = 0 there. B is D A, or the exchange with the mean of a pair, or on the
interval

    D A v + D' grad^beta v = div(D grad^beta v).

On the interval and the disc B is solved in its modes, those with the greatest D of the run at each place. The rest of B
is beside the modes, like all other terms.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.given import Outside
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.modal import ModalDomain
from fracparticles.bounded.modes import Modes
from fracparticles.bounded.square import Square
from fracparticles.problems.problem import Problem
from fracparticles.problems.rates import over_time, reaction_of
from fracparticles.time.fading import slope_of

__all__ = ["DomainRates"]

_LOOKS = 33  # times at which a diffusivity that depends on time is evaluated
# The relative difference up to which rates of decay count as equal: it is round-off where g is greater than c u.
_UNIFORM = 1e-6
_FADED = 1e-290  # the greatest |u| up to which df/du is taken at u = 0
_KNOWN = 1e12  # times the slowest rate up to which a mode counts as known; the modes reach 1e15


class DomainRates:
    """The right-hand side of a problem on a bounded domain.

    Attributes
    ----------
    evaluations : int
        How often the right-hand side has been evaluated.
    lift : callable
        Returns w and its terms at a time, see `bounded.given.Lift`.
    source : callable or None
        f(t, u) at the particles.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem, self.domain, self.evaluations = problem, problem.bounded_domain, 0
        start, at = problem.t_initial, self.domain.points
        self._varies = bool(problem.diffusion.depends_on - {"t"})
        anywhere = (np.array(0.0),) * problem.dim
        self._d = over_time(problem.diffusion, at if self._varies else anywhere, start=start)
        self._flux = self._varies and problem.form == "FPSE"
        self._swings = "t" in problem.diffusion.depends_on
        self._velocity = [over_time(one, at, start=start) for one in problem.transport]
        self.source = reaction_of(problem)
        self.lift = self.domain.lift_in_time(_outside(problem), start, problem.span)
        self.shape = self.domain.volumes.shape
        linear = (problem.diffusion, *problem.transport)
        self._steady = all("t" not in one.depends_on for one in linear)
        self._matrix: np.ndarray | None = None
        self._kept: tuple[float, tuple[Any, Any, list[Any]]] | None = None

    def __call__(self, t: float, u: np.ndarray) -> np.ndarray:
        """Return dv/dt for a v that is given as `u`, both flat."""
        field = u.reshape(self.shape)
        with np.errstate(over="ignore", invalid="ignore"):
            return np.asarray(self._spread(field, self._now(t)[0]) + self.beside(t, field)).reshape(
                -1
            )

    def beside(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return dv/dt without D A v, or the exchange of v."""
        return self._forcing(t, v) + self._lower(t, v)

    def _forcing(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return the terms of the values outside, and the source."""
        self.evaluations += 1
        now, (d, slope, velocity), domain = self.lift(t), self._now(t), self.domain
        total = d * now.load - now.slope
        if self._flux:
            total = total + slope * now.flux
        elif self._varies and self.problem.exterior == "given":
            total = total + domain.spread(now.base, d) - d * domain.applied(now.base)
        if velocity and self.problem.exterior == "given":
            total = total + domain.carried(0.0 * v, now.base, velocity)
        if self.source is not None:
            total = total + self.source(t, v + now.base)
        return np.asarray(total)

    def _lower(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return the linear terms of lower order than the diffusion."""
        total, (_, slope, velocity) = np.zeros(v.shape), self._now(t)
        if self._flux:
            total += slope * self._line.gradient(v)
        if velocity:
            total += self.domain.carried(v, 0.0 * v, velocity)
        return total

    def _now(self, t: float) -> tuple[Any, Any, list[Any]]:
        """Return D, D' and a at one time; they are kept until the next time, or for all if none depends on it."""
        if self._kept is None or not (self._steady or self._kept[0] == t):
            d = self._d(t)
            slope = self._line.slope(d) if self._flux else None
            self._kept = t, (d, slope, [one(t) for one in self._velocity])
        return self._kept[1]

    @cached_property
    def modes(self) -> Modes:
        """The modes of B with the greatest D of the run."""
        problem, domain = self.problem, self.domain
        assert isinstance(domain, ModalDomain)
        if not self._varies:
            modes = domain.all_modes()
            return modes._replace(rates=float(self._greatest) * modes.rates)
        return domain.modes_with(np.asarray(self._greatest), problem.form)

    def beside_modes(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return dv/dt without the decay of the modes."""
        forcing = self._forcing(t, v)
        if not (self._flux or self._velocity or self._swings):  # nothing linear is beside them
            return forcing
        return forcing + self.modes.back(self._in_modes(t, v))

    def derivative_in_modes(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return the derivative of `beside_modes` by v, between amplitudes of the modes, shape (N, N)."""
        modes = self.modes
        if not self._steady or self._matrix is None:
            columns = (self._in_modes(t, modes.back(e)) for e in np.eye(modes.rates.size))
            self._matrix = np.stack(list(columns), axis=1)
        if self.problem.is_linear:
            return self._matrix
        slope = self.source_slope(t, v)
        columns = (modes.into(slope * modes.back(e)) for e in np.eye(modes.rates.size))
        return self._matrix + np.stack(list(columns), axis=1)

    def source_slope(self, t: float, v: np.ndarray) -> np.ndarray:
        """Return df/du at the particles, by a difference."""
        if self.source is None or self.problem.is_linear:
            return np.zeros(v.shape)
        u = v + self.lift(t).base
        # Where u has faded, a difference by a share of u would be zero over zero.
        return slope_of(self.source, t, u if np.abs(u).max() > _FADED else 0.0 * u)

    def decay(self, v: np.ndarray) -> float:
        """Return c >= 0 of a source -c u + g(x), from its values for u and for -u/2; 0 for any other source."""
        f, t, reaction = self.source, self.problem.t_initial, self.problem.reaction
        if f is None or reaction is None or "t" in reaction.depends_on or self.problem.is_linear:
            return 0.0
        u = v + self.lift(t).base
        with np.errstate(all="ignore"):
            nothing = f(t, 0.0 * u)
            c, half = ((nothing - f(t, part * u)) / (part * u) for part in (1.0, -0.5))
            greatest = float(c.flat[np.abs(u).argmax()])
            off = np.abs(np.stack([c, half])[:, u != 0.0] - greatest).max(initial=0.0)
        return max(0.0, greatest) if off <= _UNIFORM * abs(greatest) else 0.0

    @property
    def only_decays(self) -> bool:
        """Whether u = 0 stays zero: there are no values outside, and the source is zero for u = 0."""
        start = self.problem.t_initial
        made = 0.0 if self.source is None else self.source(start, np.zeros(self.shape))
        return self.problem.exterior != "given" and not np.any(made)

    def growth(self, t: float) -> float:
        """Return the greatest real part of the eigenvalues of the terms linear in v, without the source.

        For the equation itself it is not positive.
        """
        each = (e.reshape(self.shape) for e in np.eye(self.domain.volumes.size))
        columns = (self._spread(e, self._now(t)[0]) + self._lower(t, e) for e in each)
        return float(np.linalg.eigvals(np.stack([c.reshape(-1) for c in columns])).real.max())

    def pressed(self, t: float) -> float:
        """Return max(-div a) / 2 in the plane, which `growth` and the slowest rate of the diffusion do not exceed."""
        assert isinstance(self.domain, Disc | Square)
        return -0.5 * float(self.domain.divergence(self._now(t)[2]).min())

    def slowest(self) -> float:
        """Return the lowest eigenvalue of -D A with the least D of the run."""
        least = min(float(np.min(self._d(t))) for t in self._looks)
        return least * float(self.domain.eigenvalues(1)[0])

    def _in_modes(self, t: float, v: np.ndarray) -> Any:
        """Return the linear terms beside the modes; modes too fast to be known, and their part of D, are left out."""
        modes, part = self.modes, self._lower(t, v)
        if self._swings:
            y = np.where(self._is_known, modes.into(v), 0.0)
            less = self._now(t)[0] - self._greatest
            if self._varies:
                part += self._spread(modes.back(y), less)  # linear in D
        found = np.where(self._is_known, modes.into(part), 0.0)
        if self._swings and not self._varies:  # D is then one factor for all modes
            found -= less / self._greatest * modes.rates * y
        if self.problem.exterior == "reflecting":
            found.flat[0] = 0.0  # the mode of the constant: the total is kept
        return found

    @cached_property
    def _is_known(self) -> np.ndarray:
        rates = self.modes.rates
        return np.asarray(rates < _KNOWN * float(rates[rates > 0.0].min()))

    @cached_property
    def _line(self) -> Interval:
        assert isinstance(self.domain, Interval)
        return self.domain

    @cached_property
    def _greatest(self) -> np.ndarray:
        return np.asarray(np.max([self._d(t) for t in self._looks], axis=0))

    @property
    def _looks(self) -> np.ndarray:
        """Times at which the diffusivity is evaluated."""
        count = _LOOKS if self._swings else 1
        return np.linspace(self.problem.t_initial, self.problem.t_final, count)

    def _spread(self, v: np.ndarray, d: np.ndarray) -> np.ndarray:
        if self._varies and not self._flux:
            return self.domain.spread(v, d)
        return np.asarray(d * self.domain.applied(v))


def _outside(problem: Problem) -> Outside | None:
    g = problem.outside
    if g is None:
        return None

    def at(*place: Any) -> np.ndarray:
        return np.array(g.checked(dict(zip(g.variables, place, strict=True))))

    return Outside(at, "t" in g.depends_on)
