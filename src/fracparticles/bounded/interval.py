"""Fractional diffusion on an interval (a, b): u_t = D A u + f(x, t), by particles that are graded towards the ends.

With C = `special.tail_constant` and Omega = (a, b), A depends on the exterior:

absorbing
    u = 0 outside, the restricted operator -(-Laplacian)^(alpha/2): C int_Omega (u(y) - u(x)) |x - y|^(-1-alpha) dy -
    kappa u, kappa(x) = C int_outside |x - y|^(-1-alpha) dy.
reflecting
    Nothing crosses the ends, the regional operator: kappa is left out. int u is conserved.
given
    u = g(y, t) outside: C int_outside g |x - y|^(-1-alpha) dy is added to the first.

The integral over Omega is the exchange of `adaptive.exchange` on the map of degree p of `adaptive.maps`. With q weights
of near neighbours, eigenvalues with absorbing ends and int |error| have the order min(2 q + 2 - alpha, p) in 1 / N. The
first is that of the inside, the second that of the ends, where errors are like the distance d of the first particle.
The greatest error is at the ends, like d^(alpha/2): it has the order min(2 q + 2 - alpha, p alpha/2). A lattice of
equal volumes has p = 1. Linear finite elements of equal size have likewise h in the L2 norm, and h^(1/2) in that of the
energy (Acosta & Borthagaray, SIAM J. Numer. Anal. 55 (2017) 472).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
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
from fracparticles.bounded.domain import EXTERIORS
from fracparticles.bounded.given import Lift
from fracparticles.bounded.interval_differences import differences, transported
from fracparticles.bounded.interval_outside import OutsideValues, loss_rates
from fracparticles.bounded.modal import ModalDomain
from fracparticles.bounded.modes import Modes
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.special import tail_constant

__all__ = ["Interval"]

_SHORTEST = 1e-9  # the least time, times the slowest rate; before, unresolved modes matter
_UNRESOLVED = 0.01  # share of int |u|, or int |f|, that the particles may miss
_FINE = 4001  # points at which a coefficient is looked at
_COEFFICIENT = 0.05  # share of the range of a coefficient that the particles may miss
_EACH = 8  # particles for a mode; higher modes are off by more than 0.1 per cent


class Interval(ModalDomain):
    """Particles between two ends, and the problems that can be solved on them.

    Parameters
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    particles : int
        N, from 16 to 4000; 100 give six digits of the first eigenvalue.
    exterior : {"absorbing", "reflecting", "given"}
    ends : (float, float)
        The ends a and b.
    diffusivity : float
        The diffusivity D.
    degree : float
        The degree p of the map; 1 for equal volumes.
    near : int
        The number q of neighbours on either side that have a weight, 0 to 6.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        Positions in ascending order, and V_i.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """

    balance = 1e-8

    def __init__(
        self,
        alpha: float,
        particles: int = 200,
        exterior: str = "absorbing",
        *,
        ends: tuple[float, float] = (-1.0, 1.0),
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
        self._unit = graded_on_interval(particles, degree)
        self.x = self._place(self._unit.x)
        self.volumes = self._half * self._unit.volumes
        self.points = (self.x,)
        # The unit of D A on (-1, 1).
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
        return InverseExchange.of(self._exchange, self._unit.volumes, self._loss, self._inwards)

    @cached_property
    def _inwards(self) -> np.ndarray:
        return np.argsort(np.minimum(self._unit.left, self._unit.right), kind="stable")

    @cached_property
    def _modes(self) -> tuple[FloatArray, FloatArray]:
        return self._inverse.modes()

    @cached_property
    def _outside(self) -> OutsideValues:
        return OutsideValues(self._unit, self.alpha, self._place)

    def matrix(self) -> FloatArray:
        """Return D A, shape (N, N): du/dt = D A u for u = 0 outside."""
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
        # The sign is the same every time: the first value that is not small is positive.
        first = np.argmax(np.abs(vectors) > 0.5 * np.abs(vectors).max(axis=0), axis=0)
        return self._rate * rates, functions * np.sign(vectors[first, range(count)])

    def all_modes(self) -> Modes:
        """Return all modes of -D A; an eigenvalue above 1e15 times the first is known only to be above."""
        return self._scaled(*self._modes, self.volumes)

    def _scaled(self, rates: FloatArray, vectors: FloatArray, volumes: FloatArray) -> Modes:
        root = np.sqrt(volumes)
        return Modes(
            self._rate * rates, lambda u: vectors.T @ (root * u), lambda y: vectors @ y / root
        )

    def applied(self, u: FloatArray) -> FloatArray:
        """Return D A u, with u = 0 outside, from the differences of pairs: a constant has none."""
        gained = (self._exchange * (u - u[:, None])) @ self._unit.volumes
        return np.asarray(self._rate * (gained if self._loss is None else gained - self._loss * u))

    def at_rest(self, load: FloatArray) -> FloatArray:
        """Return the u with D A u + load = 0; for reflecting ends the one of mean zero."""
        return self._inverse.apply(self._unit.volumes * load / self._rate)

    def lifted(self, g: Callable[..., Any]) -> Lift:
        """Return the steady field w for the values g(y) outside; D A w is zero."""
        level, load, flux = self._outside.load(g)
        w, nothing = self._inverse.apply(self._unit.volumes * load), np.zeros(self.x.size)
        flux = self.gradient(w) + self._half ** (1.0 - self.alpha) * flux
        return Lift(level + w, nothing, flux, nothing)

    # --- a diffusivity and a velocity that vary ------------------------------------------------------

    def gradient(self, u: FloatArray) -> FloatArray:
        """Return grad^beta u = (C / alpha) int u(y) sgn(y - x) |x - y|^-alpha dy, with u = 0 outside."""
        inside = (self._odd * (u - u[:, None])) @ self._unit.volumes
        left, right = (d ** (1.0 - self.alpha) for d in (self._unit.left, self._unit.right))
        lost = tail_constant(self.alpha) / self.alpha / (self.alpha - 1.0) * (right - left)
        return np.asarray(self._half ** (1.0 - self.alpha) * (inside - lost * u))

    @cached_property
    def _odd(self) -> FloatArray:
        """The exchange times (x_j - x_i) / alpha, with the same weights of near neighbours."""
        distances = self._unit.distances
        side = np.sign(np.arange(self.x.size) - np.arange(self.x.size)[:, None])
        return np.asarray(self._exchange * distances * side / self.alpha)

    def slope(self, f: FloatArray) -> FloatArray:
        """Return df/dx, by differences of order 8 in the variable of the map; beyond an end f is even."""
        return differences(f) / self.volumes

    def carried(
        self, v: FloatArray, base: FloatArray, velocity: Sequence[FloatArray]
    ) -> FloatArray:
        """Return -(a u)', u = v + base: waves of v grow only where pressed together, see `interval_differences`.

        Where nothing leaves, its sum weighted by V is zero.
        """
        a = np.broadcast_to(velocity[0], v.shape)
        if self.exterior == "reflecting":
            return -differences(a * (v + base), walls=True) / self.volumes
        return -(transported(v, a) + differences(a * base)) / self.volumes

    def spread(self, u: FloatArray, d: FloatArray) -> FloatArray:
        """Return the exchange with the mean of d, by the differences of pairs."""
        gained = (self._exchange * 0.5 * (d[:, None] + d) * (u - u[:, None])) @ self._unit.volumes
        lost = 0.0 if self._loss is None else d * self._loss * u
        return np.asarray(self._rate * (gained - lost))

    def modes_with(self, d: FloatArray, form: str) -> Modes:
        """Return all modes of -D d A (FPSE), an exchange between volumes V / d, or of the negative of `spread`."""
        volumes = self._unit.volumes
        if form == "FPSE":
            kernel, volumes = self._exchange * np.outer(d, d), volumes / d
        else:
            kernel = self._exchange * 0.5 * (d[:, None] + d)
        loss = None if self._loss is None else d * self._loss
        inverse = InverseExchange.of(kernel, volumes, loss, self._inwards)
        return self._scaled(*inverse.modes(), self._half * volumes)

    def warn_of_the_unseen(self, name: str, f: Callable[..., Any], values: FloatArray) -> None:
        """Warn if the particles do not resolve f.

        Initial data are judged by their integral. Straight lines between the particles miss a part of other functions:
        a source is judged by the integral of this part, a coefficient by its greatest value.

        Warns
        -----
        AccuracyWarning
            If the particles miss too large a share.
        """
        named, of, limit = f"the {name}", "of its range", _COEFFICIENT
        if name == "initial":
            named, of, limit = "the initial data", "of int |u|", _UNRESOLVED
            share = unseen_share(f, self.x, values)
        else:
            fine = np.linspace(self.x[0], self.x[-1], _FINE)
            seen = check.sampled(name, f, fine)
            missed = np.abs(seen - np.interp(fine, self.x, values))
            if name == "source":
                of, limit = "of its integral", _UNRESOLVED
                off, size = np.trapezoid(missed, fine), np.trapezoid(np.abs(seen), fine)
            else:
                off, size = missed.max(), max(np.ptp(seen), 1e-6 * np.abs(seen).max())
            share = float(off / size) if size > 0.0 else 0.0
        if share > limit:
            text = f"the particles do not resolve {named}, by {share:.1g} {of}. Take more."
            warnings.warn(text, AccuracyWarning, stacklevel=4)

    def _lasting(self, time: float) -> float:
        time = check.positive_real("time", time)
        rates = self.all_modes().rates
        slowest = rates[0] or rates[1]
        if time * slowest < _SHORTEST:
            allowed = f"{_SHORTEST / slowest:.2g} or more"
            raise InvalidInput("time", time, allowed, "A shorter one is not resolved at the ends.")
        return time
