r"""The operator of a domain: its interface, and what follows from it for all domains. See `domain` for the equation.

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
from fracparticles.bounded.given import (
    Lift,
    Outside,
    given_outside,
    lifted_in_time,
)
from fracparticles.bounded.modes import Held, Rest
from fracparticles.called import AXES, Called
from fracparticles.time.steps import Steps, norm
from fracparticles.time.sudden import pulses_at, sudden_times

__all__ = ["LOOKS", "DomainOperator"]

LOOKS = 512  # times at which a source or values outside are looked at for sudden changes
_FAR = 1.1, 1.5, 3.0  # places outside for this, in half-widths from the middle


class DomainOperator(ABC):
    """Particles in a bounded domain. A field is an array of the shape of `volumes`.

    Attributes
    ----------
    alpha, diffusivity : float
    exterior : str
    points : tuple of arrays
        The places of the particles: x, or x and y.
    volumes : array
        The volumes for which they stand.
    """

    alpha: float
    diffusivity: float
    exterior: str
    points: tuple[FloatArray, ...]
    volumes: FloatArray

    balance: float
    """The greatest |int f| over int |f| of a source that counts as balanced between reflecting edges."""

    # --- what a domain defines -----------------------------------------------------------------------

    @abstractmethod
    def applied(self, u: FloatArray) -> FloatArray:
        """Return D A u at the particles, with u = 0 outside."""

    @abstractmethod
    def at_rest(self, load: FloatArray) -> FloatArray:
        """Return the u with D A u + load = 0, u = 0 outside; if nothing leaves, load and u have the total 0."""

    @abstractmethod
    def decayed(self, u: FloatArray, time: float) -> FloatArray:
        """Return exp(time D A) u, u = 0 outside."""

    @abstractmethod
    def steps(self, rest: Rest, tolerance: float, held: Held) -> Steps:
        """Return steps of u' = D A u + rest(t, u), u = 0 outside; the tolerance is relative to u or to `held`."""

    @abstractmethod
    def lifted(self, g: Callable[..., Any]) -> Lift:
        """Return a field w with the values g(places) outside, with D A w and the rest of `Lift`."""

    @abstractmethod
    def carried(
        self, v: FloatArray, base: FloatArray, velocity: Sequence[FloatArray]
    ) -> FloatArray:
        """Return -div(a (v + base)): v vanishes at an edge as u does for u = 0 outside, the base is smooth there."""

    @abstractmethod
    def eigenvalues(self, count: int) -> FloatArray:
        """Return the lowest eigenvalues of -D A in ascending order; the first of reflecting edges is 0."""

    @abstractmethod
    def warn_of_the_unseen(self, name: str, f: Callable[..., Any], values: FloatArray) -> None:
        """Warn if the particles do not resolve f: initial data, a source or a coefficient."""

    @abstractmethod
    def unresolved(self, v: FloatArray) -> float:
        """Return the norm of the part of v, v = 0 outside, in waves that the particles do not tell apart."""

    def spread(self, u: FloatArray, d: FloatArray) -> FloatArray:
        """Return the exchange with a d that varies: a pair has the mean of its d, the loss to the outside d itself.

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
            return check.sampled(field, self._of_places(field, given), *self.points)
        values, shape = check.finite_array(field, given), self.volumes.shape
        each = "a value at each particle of the domain"
        return (
            np.full(shape, values)
            if values.ndim == 0
            else check.of_shape(field, values, shape, each)
        )

    def seen(self, field: str, given: Any) -> FloatArray:
        """Return `values`; warns if they are those of a function that the particles do not resolve."""
        values = self.values(field, given)
        if callable(given):
            self.warn_of_the_unseen(field, self._of_places(field, given), values)
        return values

    def _of_places(self, field: str, given: Callable[..., Any]) -> Called:
        return Called(field, given, AXES[: len(self.points)])

    def lift_in_time(self, g: Outside | None, start: float, span: float) -> Callable[[float], Lift]:
        """Return the lift as a function of the time from `start` to `start + span`; zero if nothing is given."""
        varies, sudden = g is not None and g.varies and span > 0.0, list[float]()
        if g is not None and varies:
            beyond, at = self._beyond(), g.at
            known = pulses_at(at, tuple(x[:1] for x in beyond), start, span)
            sudden = sudden_times(lambda t: at(*beyond, t), start, span, known=known, looks=LOOKS)
        return lifted_in_time(lambda t: self._lift_at(g, t), varies, start, span, sudden)

    def _beyond(self) -> tuple[FloatArray, ...]:
        """Return some places outside, along the axes and the diagonals."""
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
