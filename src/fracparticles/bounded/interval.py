"""Fractional diffusion on an interval (a, b): u_t = D A u + f(x, t), by particles that are graded towards the ends.

With C = `special.tail_constant` and Omega = (a, b), the exterior says what A is:

absorbing
    u = 0 outside, the restricted operator -(-Laplacian)^(alpha/2): C int_Omega (u(y) - u(x)) |x - y|^(-1-alpha) dy -
    kappa u, kappa(x) = C int_outside |x - y|^(-1-alpha) dy.
reflecting
    Nothing crosses the ends, the regional operator: kappa is left out. int u is conserved.
given
    u = g(y, t) outside, C int_outside g |x - y|^(-1-alpha) dy is added to the first.

The integral over Omega is the exchange of `adaptive.exchange` on the map of degree p of `adaptive.maps`. With q weights
of near neighbours, eigenvalues with absorbing ends and int |error| have the order min(2 q + 2 - alpha, p) in 1 / N: the
first from inside, the second from the ends, like the distance d of the first particle. The greatest error is that at
the ends, like d^(alpha/2): of the order min(2 q + 2 - alpha, p alpha/2).
A lattice of equal volumes has p = 1, as linear finite elements of equal size have h in the L2 norm and h^(1/2) in that
of the energy (Acosta & Borthagaray, SIAM J. Numer. Anal. 55 (2017) 472).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.adaptive.exchange import exchange_matrix, rate_matrix
from fracparticles.adaptive.inverse import InverseExchange
from fracparticles.adaptive.maps import graded_on_interval
from fracparticles.adaptive.samples import unseen_share
from fracparticles.adaptive.weights import MOST_NEAR
from fracparticles.arguments import FloatArray
from fracparticles.bounded.exteriors import EXTERIORS
from fracparticles.bounded.interval_outside import OutsideValues, given_outside, loss_rates
from fracparticles.bounded.interval_time import forced_modes, slopes_in_time
from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution

__all__ = ["Interval"]

_Load = Callable[[float], FloatArray]

_SHORTEST = 1e-9  # time times the slowest rate: before, modes matter that are not told apart
_UNRESOLVED = 0.01  # of int |u|, what initial data may hold that the particles do not see
_EACH = 8  # particles for a mode; higher ones are off by more than 0.1 per cent
_BALANCE = 1e-8  # of int |f|, what int f may be where nothing can leave


class Interval:
    """Particles between two ends, and the problems that can be solved on them.

    Parameters
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    particles : int
        N, from 16 to 4000; 100 give six digits of the first eigenvalue.
    ends : (float, float)
        a and b.
    exterior : {"absorbing", "reflecting", "given"}
    diffusivity : float
        D.
    degree : float
        p of the map; 1 for equal volumes.
    near : int
        q, how many neighbours on either side have a weight, 0 to 6.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        Positions in ascending order, and V_i.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """

    def __init__(
        self,
        *,
        alpha: float,
        particles: int = 200,
        ends: tuple[float, float] = (-1.0, 1.0),
        exterior: str = "absorbing",
        diffusivity: float = 1.0,
        degree: float = 8.0,
        near: int = 3,
    ) -> None:
        self.alpha = check.fractional_order(alpha)
        low, high = check.pair("ends", ends, rising=True)
        self.exterior = check.choice("exterior", exterior, EXTERIORS)
        self.diffusivity = check.scale("diffusivity", diffusivity)
        self.near = check.whole_number("near", near, 0, MOST_NEAR)
        self._middle, self._half = 0.5 * (low + high), 0.5 * (high - low)
        if not self._middle + self._half * (1.0 - 1e-6) < high:
            raise InvalidInput("ends", ends, "ends that are told apart", "Move the origin.")
        self._unit = graded_on_interval(particles, degree)
        self.x = self._place(self._unit.x)
        self.volumes = self._half * self._unit.volumes
        # D A in the unit of (-1, 1).
        self._rate = self.diffusivity * self._half**-self.alpha

    def _place(self, unit: FloatArray) -> FloatArray:
        return self._middle + self._half * unit

    @cached_property
    def _exchange(self) -> FloatArray:
        return exchange_matrix(self._unit, self.alpha, self.near)

    @cached_property
    def _loss(self) -> FloatArray | None:
        return None if self.exterior == "reflecting" else loss_rates(self._unit, self.alpha)

    @cached_property
    def _inverse(self) -> InverseExchange:
        unit = self._unit
        inwards = np.argsort(np.minimum(unit.left, unit.right), kind="stable")
        return InverseExchange.of(self._exchange, unit.volumes, self._loss, inwards)

    @cached_property
    def _modes(self) -> tuple[FloatArray, FloatArray]:
        return self._inverse.modes()

    @cached_property
    def _outside(self) -> OutsideValues:
        return OutsideValues(self._unit, self.alpha, self._place)

    def matrix(self) -> FloatArray:
        """Return D A, shape (N, N): du/dt = D A u, for what is inside."""
        return self._rate * rate_matrix(self._exchange, self._unit.volumes, self._loss)

    def eigenvalues(self, count: int = 1) -> FloatArray:
        """Return the lowest eigenvalues of -D A in ascending order, shape (count,); the first of reflecting ends is 0.

        Raises
        ------
        InvalidInput
            If there are not eight particles for each.
        """
        return self.modes(count)[0]

    def modes(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Return the lowest eigenvalues, and the eigenfunctions at the particles, shape (N, count), sum V u^2 = 1.

        Raises
        ------
        InvalidInput
            If there are not eight particles for each.
        """
        count = check.positive_integer("count", count, len(self.x) // _EACH)
        rates, vectors = self._inverse.modes(count)
        functions = vectors / np.sqrt(self.volumes)[:, None]
        # One sign each time: the first that is not small is positive.
        first = np.argmax(np.abs(vectors) > 0.5 * np.abs(vectors).max(axis=0), axis=0)
        return self._rate * rates, functions * np.sign(vectors[first, range(count)])

    def starting(self, initial: Any) -> FloatArray:
        """Return u(x, 0) at the particles; warns if they do not resolve it."""
        start = self.values("initial", initial)
        if callable(initial) and (share := unseen_share(initial, self.x, start)) > _UNRESOLVED:
            text = f"the particles do not resolve the initial data, by {share:.1g} of int |u|. Take more."
            warnings.warn(text, AccuracyWarning, stacklevel=3)
        return start

    def all_modes(self) -> tuple[FloatArray, FloatArray]:
        """Return all eigenvalues of -D A, those above 1e15 times the first as that, and orthonormal V^(1/2) u."""
        return self._rate * self._modes[0], self._modes[1]

    def held(self, outside: Any) -> FloatArray:
        """Return what values g(y) outside alone hold in place, zero where nothing is given."""
        g, nothing = given_outside(self.exterior, outside, timed=False), np.zeros(self.x.size)
        return nothing if g is None else self._steady(nothing, g, 0.0)

    def stationary(self, source: Any = 0.0, outside: Any = None) -> FloatArray:
        """Return u of D A u + f = 0, shape (N,); of reflecting ends that of mean zero.

        Parameters
        ----------
        source : callable, array or number
            f(x), or its values.
        outside : callable or number, optional
            g(y), where the exterior is given.

        Raises
        ------
        InvalidInput
            If they are not finite, `outside` is missing or superfluous, or f makes what reflecting ends keep.
        """
        g = given_outside(self.exterior, outside, timed=False)
        f = self._source(source, timed=False)(0.0)
        if self.exterior == "reflecting":
            total, size = self.volumes @ f, self.volumes @ np.abs(f)
            if abs(total) > _BALANCE * size:
                allowed = "a source of integral zero, where nothing leaves"
                raise InvalidInput("source", f"int f = {total:g}", allowed, "Take its mean off.")
        return self._steady(f / self._rate, g, 0.0)

    def evolve(
        self,
        initial: Any,
        time: float,
        source: Any = None,
        outside: Any = None,
        tolerance: float = 1e-10,
    ) -> FloatArray:
        """Return u at the particles, shape (N,), a time after `initial`.

        Parameters
        ----------
        initial : callable, array or number
            u(x, 0), or its values at the particles.
        time : float
            Positive.
        source : callable, array or number, optional
            f(x, t), or values that do not change.
        outside : callable or number, optional
            g(y, t), where the exterior is given.
        tolerance : float
            Of the integral in time over what depends on it, relative to u.

        Raises
        ------
        InvalidInput
            If they are not finite, `outside` is missing or superfluous, or the time is too short for the particles.
        NonFiniteSolution
            If the source or g varies too fast in time, or numbers overflow.

        Warns
        -----
        AccuracyWarning
            If the particles do not resolve `initial`, or what is outside.
        """
        time = check.positive_real("time", time)
        tolerance = check.real_between("tolerance", tolerance, 1e-13, 1e-2)
        g = given_outside(self.exterior, outside, timed=True)
        f = self._source(0.0 if source is None else source, timed=True)
        start = self.starting(initial)
        rates = self._rate * self._modes[0]
        slowest = rates[0] or rates[1]
        if time * slowest < _SHORTEST:
            allowed = f"{_SHORTEST / slowest:.2g} or more"
            raise InvalidInput("time", time, allowed, "A shorter one is not resolved at the ends.")
        with np.errstate(over="ignore", invalid="ignore"):
            changes = callable(source) or callable(outside) or self.exterior == "reflecting"
            u = (self._moved if changes else self._relaxed)(start, rates, f, g, time, tolerance)
        if not np.isfinite(u).all():
            text = f"u is not finite at t = {time:g}: data or source are near the largest number. Take other units."
            raise NonFiniteSolution(text)
        return u

    def _relaxed(
        self, start: FloatArray, rates: FloatArray, f: _Load, g: Any, time: float, tolerance: float
    ) -> FloatArray:
        """Return what is left of the distance from the stationary solution, and that: nothing depends on time."""
        root, vectors = np.sqrt(self.volumes), self._modes[1]
        steady = self._steady(f(0.0) / self._rate, g, 0.0)
        y = np.exp(-rates * time) * (vectors.T @ (root * (start - steady)))
        return np.asarray(steady + vectors @ y / root)

    def _moved(
        self, start: FloatArray, rates: FloatArray, f: _Load, g: Any, time: float, tolerance: float
    ) -> FloatArray:
        """Return w + v: w(t) is what the values outside alone would hold in place, v_t = A v + f - w_t is bounded."""
        root, vectors = np.sqrt(self.volumes), self._modes[1]

        def held(t: float) -> FloatArray:
            return np.zeros(len(root)) if g is None else self._steady(np.zeros(len(root)), g, t)

        def forcing(times: FloatArray) -> FloatArray:
            loads = np.array([f(t) for t in times])
            if g is not None:
                loads -= slopes_in_time(times, np.array([held(t) for t in times]))
            return np.asarray((loads * root) @ vectors)

        y = vectors.T @ (root * (start - held(0.0)))
        y = forced_modes(rates, y, forcing, time, tolerance)
        return np.asarray(held(time) + vectors @ y / root)

    def _steady(self, load: FloatArray, g: Any, t: float) -> FloatArray:
        """u of A u + load + b = 0 in the unit of (-1, 1)."""
        if g is not None:
            load = load + self._outside.load(g, t)
        return self._inverse.apply(self._unit.volumes * load)

    def values(self, field: str, given: Any) -> FloatArray:
        """Return a function, an array or a number at the particles, shape (N,)."""
        if callable(given):
            return check.sampled(field, given, self.x)
        return np.asarray(check.finite_array(field, given, self.x.shape), dtype=float)

    def _source(self, source: Any, *, timed: bool) -> Callable[[float], FloatArray]:
        if callable(source) and timed:
            return lambda t: self.values("source", lambda x: source(x, t))
        values = self.values("source", source)
        return lambda t: values
