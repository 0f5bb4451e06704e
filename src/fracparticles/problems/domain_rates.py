"""The right-hand side of a problem on a bounded domain, between its particles:

    v' = B(t) v + div(...) of what is held outside - div(a u) + f(x, t, u) - w',    u = w + v,

w has the values outside, v = 0 there, and B is D A, or the exchange with the mean of a pair, or on the interval

    D A v + D' grad^beta v = div(D grad^beta v).

On the interval and the disc B is taken in its modes: those of the greatest D of the run at each place; what is left of
it is beside them, like all else.
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
from fracparticles.problems.problem import Problem
from fracparticles.problems.rates import over_time, reaction_of
from fracparticles.time.fading import slope_of

__all__ = ["DomainRates"]

_LOOKS = 33  # at a diffusivity that depends on time
_UNIFORM = 1e-6  # of a rate, its round-off where g is greater
_FADED = 1e-290
_KNOWN = 1e12  # of the slowest rate; the modes know 1e15 of it


class DomainRates:
    """The right-hand side of a problem on a bounded domain.

    Attributes
    ----------
    evaluations : int
        How often it has been asked for.
    lift : callable
        w and what it does, by time.
    source : callable or None
        f(t, u).
    """

    def __init__(self, problem: Problem) -> None:
        self.problem, self.domain, self.evaluations = problem, problem.bounded_domain, 0
        start, at = problem.t_initial, self.domain.points
        self._varies = bool(problem.diffusion.depends_on - {"t"})
        anywhere = (np.array(0.0),) * problem.dim
        self._d = over_time(problem.diffusion, at if self._varies else anywhere, start=start)
        self._flux = self._varies and problem.form == "FPSE"
        self._velocity = [over_time(one, at, start=start) for one in problem.transport]
        self.source = reaction_of(problem)
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
        if self.source is not None:
            total = total + self.source(t, v + now.base)
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
        # A difference of a share of what has faded would be nothing over nothing.
        return slope_of(self.source, t, u if np.abs(u).max() > _FADED else 0.0 * u)

    def decay(self, v: np.ndarray) -> float:
        """Return c >= 0 of a source -c u + g(x), by what it makes of u and of -u/2; 0 of any other."""
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
        """Whether nothing makes u where there is none: no value outside, and a source that is zero for u = 0."""
        start = self.problem.t_initial
        made = 0.0 if self.source is None else self.source(start, np.zeros(self.shape))
        return self.problem.exterior != "given" and not np.any(made)

    def growth(self, t: float) -> float:
        """Return the greatest real part of an eigenvalue of what is linear in v, without the source.

        That of the equation is not positive.
        """
        each = (e.reshape(self.shape) for e in np.eye(self.domain.volumes.size))
        columns = (self._spread(e, self._now(t)[0]) + self._lower(t, e) for e in each)
        return float(np.linalg.eigvals(np.stack([c.reshape(-1) for c in columns])).real.max())

    def pressed(self, t: float) -> float:
        """Return max(-div a) / 2 on a disc, which `growth` and the slowest rate of the diffusion do not exceed."""
        assert isinstance(self.domain, Disc)
        return -0.5 * float(self.domain.divergence(self._now(t)[2]).min())

    def slowest(self) -> float:
        """Return the lowest eigenvalue of -D A with the least D of the run."""
        least = min(float(np.min(self._d(t))) for t in self._looks)
        return least * float(self.domain.eigenvalues(1)[0])

    def _in_modes(self, t: float, v: np.ndarray) -> Any:
        """What is linear beside the modes; of those so fast that they are not known nothing, and nothing of their D."""
        modes, part = self.modes, self._lower(t, v)
        y = np.where(self._is_known, modes.into(v), 0.0)
        less = self._now(t)[0] - self._greatest
        if self._varies and "t" in self.problem.diffusion.depends_on:
            part += self._spread(modes.back(y), less)  # linear in D
        found = np.where(self._is_known, modes.into(part), 0.0)
        if not self._varies:  # in the modes it is a factor
            found -= less / self._greatest * modes.rates * y
        if self.problem.exterior == "reflecting":
            found.flat[0] = 0.0  # of the constant: the total
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
        """Times at which a diffusivity may differ."""
        count = _LOOKS if "t" in self.problem.diffusion.depends_on else 1
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
