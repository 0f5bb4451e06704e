r"""What an interval, a disc and a square have in common: particles, and the equation that is solved on them,

    u_t = D A u + f(x, t, u),    A u(x) = c int (u(y) - u(x)) |x - y|^(-n-alpha) dy,

with one of three exteriors:

absorbing
    u = 0 outside: the restricted operator -(-Laplacian)^(alpha/2).
reflecting
    Nothing is outside: the integral is over the domain alone, the regional operator (Guan & Ma, Probab. Theory Relat.
    Fields 134 (2006) 649), which conserves.
given
    u = g outside, taken off as in `given`.

A domain says what A is between its particles, what holds a load in place, and how what is left decays. Where nothing
depends on time, u is the steady field and what is left of the distance from it; else steps are taken.
"""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from itertools import pairwise, product
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.bounded.exponential import Rest
from fracparticles.bounded.given import Lift, Outside, given_outside, lifted_in_time, takes
from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution
from fracparticles.time.steps import Steps
from fracparticles.time.sudden import sudden_times

__all__ = ["EXTERIORS", "Domain"]

_LOOKS, _FEW = 512, 9  # times, at what depends on it; in a piece of them
_FADED = 0.01  # of u, the tolerance
_FAR = 1.1, 1.5, 3.0  # half-widths from the middle

EXTERIORS = ("absorbing", "reflecting", "given")
"""What may be outside."""


class Domain(ABC):
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
    def steps(self, rest: Rest, tolerance: float, start: FloatArray) -> Steps:
        """Return what takes steps of u' = D A u + rest(t, u), u = 0 outside, from fields of the size of `start`."""

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

    # --- what all of them do -------------------------------------------------------------------------

    def total(self, u: Any) -> float:
        """Return the strength of all particles, int u dx."""
        return float((self.volumes * self.values("u", u)).sum())

    def norm(self, u: FloatArray) -> float:
        """Return (int u^2 dx)^(1/2)."""
        return float(np.sqrt((self.volumes * u * u).sum()))

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

    def stationary(self, source: Any = 0.0, outside: Any = None) -> FloatArray:
        """Return u of D A u + f = 0; of reflecting edges the one of total 0.

        Parameters
        ----------
        source : callable, array or number
            f of the places, or its values.
        outside : callable or number, optional
            g of places, where the exterior is given.

        Raises
        ------
        InvalidInput
            If they are not finite, `outside` is missing or superfluous, or f makes what reflecting edges keep.

        Warns
        -----
        AccuracyWarning
            If the particles do not resolve what is given.
        """
        lift = self._lift_at(given_outside(self.exterior, outside, len(self.points)), 0.0)
        f = self.seen("source", source)
        if self.exterior == "reflecting":
            whole, size = self.total(f), self.total(np.abs(f))
            if abs(whole) > self.balance * size:
                shown = f"int f = {whole:.3g}"
                allowed = "a source of total 0, where nothing leaves"
                raise InvalidInput("source", shown, allowed, "Take its mean off.")
            f = f - self._mean(f)
        return lift.base + self.at_rest(f + lift.load)

    def evolve(
        self,
        initial: Any,
        time: float,
        source: Any = None,
        outside: Any = None,
        tolerance: float = 1e-10,
    ) -> FloatArray:
        """Return u at the particles a time after `initial`: exact in time, if nothing depends on it.

        Parameters
        ----------
        initial : callable, array or number
            u at the time 0: a function of places, or its values at the particles.
        time : float
        source : callable, array or number, optional
            f of places and time, or of places alone, or values that do not change.
        outside : callable or number, optional
            g of places and time, or of places alone, where the exterior is given.
        tolerance : float
            Of each step in time, relative to u, if something depends on it.

        Raises
        ------
        InvalidInput
            If they are not finite, `outside` is missing or superfluous, or the time is not what it may be.
        NonFiniteSolution
            If g varies too fast in time, or numbers overflow.

        Warns
        -----
        AccuracyWarning
            If the particles do not resolve what is given.
        """
        dim = len(self.points)
        time = self._lasting(time)
        tolerance = check.real_between("tolerance", tolerance, 1e-13, 1e-2)
        g = given_outside(self.exterior, outside, dim)
        if callable(source) and takes(source, dim + 1):

            def forced(t: float, u: FloatArray) -> FloatArray:
                return self.values("source", lambda *place: source(*place, t))

            start = self.seen("initial", initial)
            return self._moved(start, time, forced, g, tolerance)
        f = self.seen("source", 0.0 if source is None else source)
        start = self.seen("initial", initial)
        if g is not None and g.varies:
            return self._moved(start, time, lambda t, u: f, g, tolerance)
        with np.errstate(over="ignore", invalid="ignore"):
            return self._finite(self._relaxed(start, time, f, g), time)

    def react(
        self,
        initial: Any,
        time: float,
        source: Callable[..., Any],
        outside: Any = None,
        tolerance: float = 1e-8,
    ) -> FloatArray:
        """Return u at the particles a time after `initial`, with a source f of places, time and u.

        Raises
        ------
        InvalidInput
            If an argument is not what it may be.
        NonFiniteSolution
            If u becomes infinite, or the steps too short or too many; says when.
        """
        check.function("source", source)
        time = self._lasting(check.positive_real("time", time))
        tolerance = check.real_between("tolerance", tolerance, 1e-12, 1e-2)
        g = given_outside(self.exterior, outside, len(self.points))
        start = self.seen("initial", initial)

        def reaction(t: float, u: FloatArray) -> FloatArray:
            with np.errstate(over="ignore", invalid="ignore"):
                f = np.asarray(source(*self.points, t, u), dtype=float)
            return np.broadcast_to(f, u.shape)

        self.values("source", lambda *place: source(*place, 0.0, start) + 0.0 * place[0])
        return self._moved(start, time, reaction, g, tolerance)

    # --- how -----------------------------------------------------------------------------------------

    def _relaxed(
        self, start: FloatArray, time: float, f: FloatArray, g: Outside | None
    ) -> FloatArray:
        """The steady field, and what is left of the distance from it; the mean of f, where nothing leaves, adds up."""
        lift = self._lift_at(g, 0.0)
        mean = self._mean(f) if self.exterior == "reflecting" else 0.0
        steady = self.at_rest(f - mean + lift.load)
        left = self.decayed(start - lift.base - steady, time)
        return np.asarray(lift.base + steady + time * mean + left)

    def _moved(
        self, start: FloatArray, time: float, f: Rest, g: Outside | None, tolerance: float
    ) -> FloatArray:
        lift = self.lift_in_time(g, 0.0, time)

        def rest(t: float, v: FloatArray) -> FloatArray:
            now = lift(t)
            return f(t, v + now.base) + now.load - now.slope

        if time == 0.0:
            return start
        sudden = sudden_times(lambda t: f(t, start).reshape(-1), 0.0, time, looks=_LOOKS)
        pieces, size = list(pairwise((0.0, *sudden, time))), start
        if not start.any():  # what the source may make of it
            made = sum(
                (b - a) * max(float(np.abs(rest(t, start)).max()) for t in np.linspace(a, b, _FEW))
                for a, b in pieces
            )
            size = np.full(start.shape, made or 1.0)
        v, steps = start - lift(0.0).base, self.steps(rest, tolerance, size)
        for before, after in pieces:
            v = steps.advance(v, after - before, before)
            steps.forget()
        u = self._finite(lift(time).base + v, time)
        if (share := tolerance * float(np.abs(size).max() / (np.abs(u).max() or 1.0))) > _FADED:
            warnings.warn(
                f"the steps are accurate to the tolerance times what u was, and that is {share:.2g} of what it is. "
                "Take a smaller tolerance, or go in shorter times.",
                AccuracyWarning,
                stacklevel=3,
            )
        return u

    def lift_in_time(self, g: Outside | None, start: float, span: float) -> Callable[[float], Lift]:
        """Return w and what it does as a function of the time, zero where nothing is given."""
        varies, sudden = g is not None and g.varies and span > 0.0, list[float]()
        if g is not None and varies:
            beyond, at = self._beyond(), g.at
            sudden = sudden_times(lambda t: at(*beyond, t), start, span, looks=_LOOKS)
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

    def _lasting(self, time: float) -> float:
        return check.not_negative("time", time)

    def _finite(self, u: FloatArray, time: float) -> FloatArray:
        if not np.isfinite(u).all():
            text = f"u is not finite at t = {time:g}: data or source are near the largest number. Take other units."
            raise NonFiniteSolution(text)
        return u
