r"""Fractional diffusion in a disc |x| < R, by strengths that rings of particles exchange:

    u_t = D L u + f,    L u(x) = c p.v. int (u(y) - u(x)) |x - y|^(-2-alpha) dy = -(-Laplacian)^(alpha/2) u,

with one of three exteriors:

- "absorbing": u = 0 outside, the restricted fractional Laplacian. All decays at the rate of the first eigenvalue at
  last, Dyda, Kuznetsov & Kwasnicki, J. London Math. Soc. 95 (2017) 500;
- "reflecting": the integral is over the disc only, the regional fractional Laplacian, Guan & Ma, Probab. Theory Relat.
  Fields 134 (2006) 649. The total is conserved;
- "given": u = g outside. A constant stays a constant.

The particles lie on rings that crowd at the edge, at equal angles on each. A discrete Fourier transform in the angle
makes of the operator one symmetric matrix for each wave number (`disc_rings`), whose eigenvectors give the solution
exactly in time. The error is O(N^(alpha-4)) for N rings; a plain lattice has the order one.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.bounded.disc_rings import Rings, exterior_rate
from fracparticles.bounded.exteriors import EXTERIORS
from fracparticles.bounded.plane_resolution import warn_of_the_unseen
from fracparticles.errors import InvalidInput

__all__ = ["Disc"]

_MOST_RINGS = (
    128  # beyond, the innermost digits of 1 - r ~ N^-3 are worth less than the order gains
)
_MOST_ANGLES = 512
_TURN = 0.382  # of a step of the angle, where fields are looked at again: no simple fraction

Field = FloatArray | float | Callable[..., Any]


class Disc:
    """Particles in a disc.

    Parameters
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    radial : int
        Rings, 8 to 128.
    angular : int
        Particles on each, 1 to 512. With 1 all fields are radial.
    exterior : {"absorbing", "reflecting", "given"}
    radius, diffusivity : float
        R and D.
    given : callable, optional
        g(x, y) outside, for the exterior "given" only: bounded, continuous at the edge.

    Attributes
    ----------
    x, y, volumes : array, shape (radial, angular)
        Where the particles are, and their volumes; a field is an array of that shape.

    Raises
    ------
    InvalidInput
        If one of them is not allowed.
    """

    def __init__(
        self,
        alpha: float,
        radial: int = 64,
        angular: int = 32,
        exterior: str = "absorbing",
        *,
        radius: float = 1.0,
        diffusivity: float = 1.0,
        given: Callable[..., Any] | None = None,
    ) -> None:
        self.alpha = check.fractional_order(alpha)
        self.radial = check.whole_number("radial", radial, 8, _MOST_RINGS)
        self.angular = check.whole_number("angular", angular, 1, _MOST_ANGLES)
        self.exterior = check.choice("exterior", exterior, EXTERIORS)
        self.radius = check.scale("radius", radius)
        self.diffusivity = check.scale("diffusivity", diffusivity)
        if (given is None) == (exterior == "given"):
            allowed = "a function g(x, y) for exterior='given', and nothing for others"
            raise InvalidInput("given", given, allowed, "Give one, or choose another exterior.")
        self._rings = Rings.graded(self.radial)
        angle = 2.0 * np.pi / self.angular * np.arange(self.angular)
        self._direction = np.cos(angle), np.sin(angle)
        r = self.radius * self._rings.r[:, None]
        self.x, self.y = (r * one for one in self._direction)
        share = self.radius**2 * 2.0 * np.pi / self.angular * self._rings.volumes
        self.volumes = np.repeat(share[:, None], self.angular, axis=1)
        self._rate = self.diffusivity * self.radius**-self.alpha  # of the unit disc's operator
        self._level, self._inflow = 0.0, None
        if given is not None:
            self._level, self._inflow = self._inflow_of(given)

    def total(self, u: FloatArray) -> float:
        """Return the strength of all particles, int u dx."""
        return float((self.volumes * self._field("u", u)).sum())

    def rate(self, u: Field) -> FloatArray:
        """Return D L u at the particles."""
        modes = self._transformed(self._field("u", u) - self._level)
        root = self._root[:, None]
        out = np.empty_like(modes)
        for wave in range(modes.shape[1]):
            part = modes[:, wave : wave + 1] * root
            out[:, wave : wave + 1] = -(self._matrix(wave) @ part) / root
        if self._inflow is not None:
            out += self._inflow
        return self._rate * self._back(out)

    def evolve(self, initial: Field, time: float, source: Field = 0.0) -> FloatArray:
        """Return u a time after `initial`, exact in time, shape (radial, angular).

        Parameters
        ----------
        initial, source : array, number or callable
            u at time 0, and f: arrays of the shape of `x`, or functions of (x, y).
        time : float
            0 or more.

        Warns
        -----
        AccuracyWarning
            If the particles do not resolve one of these functions.
        """
        t = self._rate * check.not_negative("time", time)
        u = self._transformed(self._field("initial", initial) - self._level)
        f = self._transformed(self._field("source", source)) / self._rate
        if self._inflow is not None:
            f = f + self._inflow
        done = self._combined(u, f, lambda z: np.exp(-z * t), lambda z: _phi(z, t))
        return self._level + self._back(done)

    def stationary(self, source: Field) -> FloatArray:
        """Return the u that does not change, D L u + f = 0; of the exterior "reflecting" the one of total 0.

        Raises
        ------
        InvalidInput
            If the exterior is "reflecting" and the total of the source is not zero, to 1e-3 of that of its size.
        """
        f = self._transformed(self._field("source", source)) / self._rate
        if self.exterior == "reflecting":
            field = self._back(f)
            whole, size = self.total(field), self.total(np.abs(field))
            if abs(whole) > 1e-3 * size:
                allowed = "a source of total 0 for a reflecting exterior"
                shown = f"a total of {whole / size:.3g} of its size"
                raise InvalidInput("source", shown, allowed, "Take off its mean.")
        if self._inflow is not None:
            f = f + self._inflow
        zero = np.zeros_like(f)
        return self._level + self._back(self._combined(zero, f, np.zeros_like, _inverse))

    def eigenvalues(self, count: int) -> FloatArray:
        """Return the least eigenvalues of -D L, in order, each as often as it occurs."""
        count = check.positive_integer("count", count, self.radial * self.angular)
        parts = [self._spectra(wave)[0] for wave in range(self.angular // 2 + 1)]
        alone = {0, self.angular / 2}  # a cosine without a sine
        every = [np.repeat(part, 1 if wave in alone else 2) for wave, part in enumerate(parts)]
        return self._rate * np.sort(np.concatenate(every))[:count]

    # --- one wave number at a time ----------------------------------------------------------------

    @cached_property
    def _root(self) -> FloatArray:
        return np.sqrt(self._rings.volumes)

    @cached_property
    def _given_up(self) -> FloatArray:
        """V_i times the rate at which ring i gives to all others, and to the exterior."""
        lost = self._rings.exchange(self.alpha, 0).sum(axis=1)
        if self.exterior != "reflecting":
            lost = lost + self._rings.volumes * self._rings.outward_rate(self.alpha)
        return lost

    def _matrix(self, wave: int) -> FloatArray:
        """-L of the unit disc for f(r) cos(l theta), symmetric: between the values of V^(1/2) f."""
        rings = self._rings
        w = np.diag(self._given_up + rings.volumes * rings.loss(self.alpha, wave))
        w -= rings.exchange(self.alpha, wave)
        return np.asarray(w / (self._root[:, None] * self._root))

    @cached_property
    def _known(self) -> dict[int, tuple[FloatArray, FloatArray]]:
        return {}

    def _spectra(self, wave: int) -> tuple[FloatArray, FloatArray]:
        if wave not in self._known:
            values, vectors = np.linalg.eigh(self._matrix(wave))
            if wave == 0 and self.exterior == "reflecting":
                # The constant is an eigenvector, and its eigenvalue zero: to all digits, not to those of the largest.
                values[0] = 0.0
                vectors[:, 0] = self._root / np.linalg.norm(self._root)
                vectors[:, 1:] -= np.outer(vectors[:, 0], vectors[:, 0] @ vectors[:, 1:])
            self._known[wave] = values, vectors
        return self._known[wave]

    def _combined(self, u: Any, f: Any, of_u: Any, of_f: Any) -> Any:
        """of_u(A) u + of_f(A) f, A = -L, wave number by wave number."""
        out = np.empty_like(u)
        for wave in range(u.shape[1]):
            values, vectors = self._spectra(wave)
            a, b = (vectors.T @ (self._root * one[:, wave]) for one in (u, f))
            out[:, wave] = vectors @ (of_u(values) * a + of_f(values) * b) / self._root
        return out

    def _inflow_of(self, given: Callable[..., Any]) -> tuple[float, Any]:
        """The mean g_0 of g at the edge, and c int_(|y| > 1) (g(y) - g_0) |x - y|^(-2-alpha) dy wave by wave.

        The latter as the rate to the outside times g - g_0 at the edge, and the rest. Since all else works with
        u - g_0, a constant stays one to the last digit.
        """
        rings = self._rings

        def sampled(r: FloatArray) -> FloatArray:
            return check.sampled(
                "given", given, *(self.radius * r * one for one in self._direction)
            )

        edge = sampled(np.ones((1, 1)))
        level = float(edge.mean())
        far, near = (
            self._transformed(sampled(1.0 / rings.r[:, None]) - level),
            self._transformed(edge - level)[0],
        )
        all_of_it = exterior_rate(rings, self.alpha, 0).sum(axis=1)
        inflow = np.outer(rings.outward_rate(self.alpha) - all_of_it, near)
        for wave in range(near.size):
            inflow[:, wave] += exterior_rate(rings, self.alpha, wave) @ far[:, wave]
        return level, inflow

    # --- fields and their waves in the angle ------------------------------------------------------

    def _field(self, name: str, value: Field) -> FloatArray:
        if not callable(value):
            return check.finite_array(name, value, self.x.shape)
        field = check.sampled(name, value, self.x, self.y)
        between = Rings.between(self.radial)
        angle = 2.0 * np.pi / self.angular * (np.arange(self.angular) + _TURN)
        r = self.radius * between.r[:, None]
        other = check.sampled(name, value, r * np.cos(angle), r * np.sin(angle))
        volumes = 2.0 * np.pi / self.angular * self.radius**2 * between.volumes[:, None]
        warn_of_the_unseen(name, field, self.volumes, other, volumes)
        return field

    def _transformed(self, field: FloatArray) -> Any:
        return np.fft.rfft(field, axis=1)

    def _back(self, modes: Any) -> FloatArray:
        return np.asarray(np.fft.irfft(modes, self.angular, axis=1))


def _phi(z: FloatArray, t: float) -> FloatArray:
    """(1 - exp(-z t)) / z."""
    small = np.abs(z) * t < 1e-300
    return np.where(small, t, -np.expm1(-z * t) / np.where(small, 1.0, z))


def _inverse(z: FloatArray) -> FloatArray:
    """1 / z, and 0 of 0: the constant of a reflecting exterior."""
    return np.where(z == 0.0, 0.0, 1.0 / np.where(z == 0.0, 1.0, z))
