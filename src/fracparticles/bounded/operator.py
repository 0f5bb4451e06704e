r"""What a domain says of its operator, and what follows of that for all of them: see `domain` for the equation.

A u(x) = c int (u(y) - u(x)) |x - y|^(-n-alpha) dy
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from itertools import product
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.bounded.given import Lift, Outside, given_outside, lifted_in_time
from fracparticles.bounded.modes import Held, Rest
from fracparticles.time.steps import Steps, norm
from fracparticles.time.sudden import sudden_times

__all__ = ["LOOKS", "DomainOperator"]

LOOKS = 512  # times, at what depends on it
_FAR = 1.1, 1.5, 3.0  # half-widths from the middle


class DomainOperator(ABC):
    """Particles in a bounded domain. A field is an array of the shape of `volumes`.

    Attributes
    ----------
    alpha, diffusivity : float
    exterior : str
    points : tuple of arrays
        Where the particles are: x, or x and y.
    volumes : array
        What they stand for.
    """

    alpha: float
    diffusivity: float
    exterior: str
    points: tuple[FloatArray, ...]
    volumes: FloatArray

    balance: float
    """Of int |f|, what int f may be where nothing can leave and nothing shall change."""

    # --- what a domain says --------------------------------------------------------------------------

    @abstractmethod
    def applied(self, u: FloatArray) -> FloatArray:
        """Return D A u at the particles, with u = 0 outside."""

    @abstractmethod
    def at_rest(self, load: FloatArray) -> FloatArray:
        """Return u of D A u + load = 0, u = 0 outside; of a load of total 0, that of total 0, if nothing is outside."""

    @abstractmethod
    def decayed(self, u: FloatArray, time: float) -> FloatArray:
        """Return exp(time D A) u, u = 0 outside."""

    @abstractmethod
    def steps(self, rest: Rest, tolerance: float, held: Held) -> Steps:
        """Return what takes steps of u' = D A u + rest(t, u), u = 0 outside, to the size of u or of `held`."""

    @abstractmethod
    def lifted(self, g: Callable[..., Any]) -> Lift:
        """Return a field w with the values g(places) outside, and D A w."""

    @abstractmethod
    def carried(
        self, v: FloatArray, base: FloatArray, velocity: Sequence[FloatArray]
    ) -> FloatArray:
        """Return -div(a (v + base)): v is 0 at an edge as u with u = 0 outside, the base is smooth there."""

    @abstractmethod
    def eigenvalues(self, count: int) -> FloatArray:
        """Return the lowest eigenvalues of -D A in ascending order; the first of reflecting edges is 0."""

    @abstractmethod
    def warn_of_the_unseen(self, name: str, f: Callable[..., Any], values: FloatArray) -> None:
        """Warn if the particles do not resolve f, the initial data or a source."""

    @abstractmethod
    def unresolved(self, v: FloatArray) -> float:
        """Return the norm of what of v, 0 outside, is in the waves that the particles do not tell apart."""

    def spread(self, u: FloatArray, d: FloatArray) -> FloatArray:
        """Return the exchange with a d that varies, the mean of a pair; with the outside by d itself.

        D (C int_Omega (d(x) + d(y)) / 2 (u(y) - u(x)) |x - y|^(-n-alpha) dy - d kappa u)
        = (d A u + A(d u) - u A d + d u A 1) D / 2, A 1 = -kappa.
        """
        one = np.ones(u.shape)
        parts = d * self.applied(u) + self.applied(d * u) - u * self.applied(d)
        return np.asarray(0.5 * (parts + d * u * self.applied(one)))

    # --- what follows --------------------------------------------------------------------------------

    def total(self, u: Any) -> float:
        """Return the strength of all particles, int u dx."""
        return float((self.volumes * self.values("u", u)).sum())

    def norm(self, u: FloatArray) -> float:
        """Return (int u^2 dx)^(1/2)."""
        return norm(np.sqrt(self.volumes) * u)

    def rate(self, u: Any, outside: Any = None) -> FloatArray:
        """Return D A u at the particles."""
        lift = self._lift_at(given_outside(self.exterior, outside, len(self.points)), 0.0)
        return self.applied(self.values("u", u) - lift.base) + lift.load

    def values(self, field: str, given: Any) -> FloatArray:
        """Return a function of places, an array or a number at the particles."""
        if callable(given):
            return check.sampled(field, given, *self.points)
        return np.asarray(check.finite_array(field, given, self.volumes.shape), dtype=float)

    def seen(self, field: str, given: Any) -> FloatArray:
        """Return these values; warns if they are those of a function that the particles do not resolve."""
        values = self.values(field, given)
        if callable(given):
            self.warn_of_the_unseen(field, given, values)
        return values

    def lift_in_time(self, g: Outside | None, start: float, span: float) -> Callable[[float], Lift]:
        """Return w and what it does as a function of the time, zero where nothing is given."""
        varies, sudden = g is not None and g.varies and span > 0.0, list[float]()
        if g is not None and varies:
            beyond, at = self._beyond(), g.at
            sudden = sudden_times(lambda t: at(*beyond, t), start, span, looks=LOOKS)
        return lifted_in_time(lambda t: self._lift_at(g, t), varies, start, span, sudden)

    def _beyond(self) -> tuple[FloatArray, ...]:
        """Some places outside, along the axes and the diagonals."""
        directions = np.array(list(product((-1.0, 0.0, 1.0), repeat=len(self.points))))
        directions = directions[np.abs(directions).max(axis=1) > 0.0]
        ends = [(float(x.min()), float(x.max())) for x in self.points]
        return tuple(
            np.concatenate([0.5 * (a + b) + far * 0.5 * (b - a) * along for far in _FAR])
            for (a, b), along in zip(ends, directions.T, strict=True)
        )

    def _lift_at(self, g: Outside | None, t: float) -> Lift:
        if g is None:
            nothing = np.zeros(self.volumes.shape)
            return Lift(nothing, nothing, nothing, nothing)
        return self.lifted(lambda *place: g.at(*place, t))

    def _mean(self, u: FloatArray) -> float:
        return float((self.volumes * u).sum() / self.volumes.sum())
