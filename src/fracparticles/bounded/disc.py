r"""Fractional diffusion in a disc |x| < R, by strengths that rings of particles exchange:

    u_t = D L u + f,    L u(x) = c p.v. int (u(y) - u(x)) |x - y|^(-2-alpha) dy = -(-Laplacian)^(alpha/2) u,

with one of three exteriors:

- "absorbing": u = 0 outside, the restricted fractional Laplacian. At last u decays at the rate of the first eigenvalue,
  Dyda, Kuznetsov & Kwasnicki, J. London Math. Soc. 95 (2017) 500;
- "reflecting": the integral is over the disc only, the regional fractional Laplacian, Guan & Ma, Probab. Theory Relat.
  Fields 134 (2006) 649. The total is conserved;
- "given": u = g outside. A constant stays a constant.

The particles lie on rings that crowd at the edge, at equal angles on each. A discrete Fourier transform in the angle
turns the operator into one symmetric matrix for each wave number (`disc_rings`). Its eigenvectors give the solution
exactly in time. The error is O(N^(alpha-4)) for N rings; a plain lattice has the order one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.bounded.disc_rings import Rings, exterior_rate
from fracparticles.bounded.disc_transport import DiscTransport
from fracparticles.bounded.domain import EXTERIORS
from fracparticles.bounded.given import Lift
from fracparticles.bounded.modal import ModalDomain
from fracparticles.bounded.modes import Modes
from fracparticles.bounded.plane_resolution import warn_of_the_unseen

__all__ = ["Disc"]

# With more, the round-off of the least 1 - r ~ N^-3 costs more than the order gains.
_MOST_RINGS = 128
_MOST_ANGLES = 512
_TURN = 0.382  # share of a step of the angle by which fields are looked at again: irregular


class Disc(ModalDomain):
    """Particles in a disc.

    Parameters
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    rings : int
        How many, 8 to 128.
    angles : int
        Particles on each ring, 1 to 512. With 1 all fields are radial.
    exterior : {"absorbing", "reflecting", "given"}
    radius, diffusivity : float
        R and D.

    Attributes
    ----------
    x, y, volumes : array, shape (rings, angles)
        The places of the particles, and their volumes; a field is an array of that shape.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """

    balance = 1e-3

    def __init__(
        self,
        alpha: float,
        rings: int = 64,
        angles: int = 32,
        exterior: str = "absorbing",
        *,
        radius: float = 1.0,
        diffusivity: float = 1.0,
    ) -> None:
        self.alpha = check.fractional_order(alpha)
        self.rings = check.whole_number("rings", rings, 8, _MOST_RINGS)
        self.angles = check.whole_number("angles", angles, 1, _MOST_ANGLES)
        self.exterior = check.choice("exterior", exterior, EXTERIORS)
        self.radius = check.scale("radius", radius)
        self.diffusivity = check.scale("diffusivity", diffusivity)
        self._rings = Rings.graded(self.rings)
        angle = 2.0 * np.pi / self.angles * np.arange(self.angles)
        self._direction = np.cos(angle), np.sin(angle)
        r = self.radius * self._rings.r[:, None]
        self.x, self.y = self.points = tuple(r * one for one in self._direction)
        share = self.radius**2 * 2.0 * np.pi / self.angles * self._rings.volumes
        self.volumes = np.repeat(share[:, None], self.angles, axis=1)
        self._rate = self.diffusivity * self.radius**-self.alpha  # D A over that of the unit disc

    def applied(self, u: FloatArray) -> FloatArray:
        """Return D A u, with u = 0 outside."""
        root = self._root[:, None]
        out = _products(self._matrices, (root * self._transformed(u)).T).T
        return -self._rate * self._back(out / root)

    def at_rest(self, load: FloatArray) -> FloatArray:
        """Return the u with D A u + load = 0; for a reflecting exterior the one of total 0."""
        modes = self.all_modes()
        z = modes.rates
        held = np.where(z == 0.0, 0.0, 1.0 / np.where(z == 0.0, 1.0, z))  # zero for the constant
        return modes.back(held * modes.into(load))

    def lifted(self, g: Callable[..., Any]) -> Lift:
        """Return w, the mean of g at the edge and the steady field for the rest of g; D A w is zero."""
        level, inflow = self._inflow_of(g)
        held = self.at_rest(self._rate * self._back(inflow))
        nothing = np.zeros(held.shape)
        return Lift(level + held, nothing, nothing, nothing)

    # --- a diffusivity and a velocity that vary ------------------------------------------------------

    def carried(
        self, v: FloatArray, base: FloatArray, velocity: Sequence[FloatArray]
    ) -> FloatArray:
        """Return -div(a u), u = v + base: except for div a it is skew in v, see `disc_transport`.

        Where nothing leaves, the total is kept.
        """
        along = self._polar(velocity)
        moved = self._transport.carried(v, *along)
        if base.any():
            moved += self._transport.of_smooth(base, *along)
        return moved / self.radius

    def divergence(self, velocity: Sequence[FloatArray]) -> FloatArray:
        """Return div a as `carried` takes it."""
        return self._transport.divergence(*self._polar(velocity)) / self.radius

    def _polar(self, velocity: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
        """Return a_r and a_theta."""
        a_x, a_y = (np.broadcast_to(one, self.volumes.shape) for one in velocity)
        cos, sin = self._direction
        return a_x * cos + a_y * sin, a_y * cos - a_x * sin

    @cached_property
    def _transport(self) -> DiscTransport:
        return DiscTransport(self._rings, self.exterior == "reflecting")

    def modes_with(self, d: FloatArray, form: str) -> Modes:
        """Return all modes of the negative of `spread`, from one symmetric matrix between all particles."""
        root = np.sqrt(self._rings.volumes)
        block = np.fft.irfft(self._matrices * np.outer(root, root), self.angles, axis=0)
        angle = np.arange(self.angles)
        # V_i A between the particles (i, a) and (j, b) on the rings i, j.
        whole = block[(angle[:, None] - angle) % self.angles].transpose(2, 0, 3, 1)
        size = self.rings * self.angles
        exchange, d = -whole.reshape(size, size), d.reshape(-1)
        np.fill_diagonal(exchange, 0.0)
        exchange *= 0.5 * (d[:, None] + d)
        volumes = np.repeat(self._rings.volumes, self.angles)
        given_up = exchange.sum(axis=1)
        if self.exterior != "reflecting":
            given_up += d * volumes * np.repeat(self._rings.outward_rate(self.alpha), self.angles)
        root = np.sqrt(volumes)
        rates, vectors = np.linalg.eigh((np.diag(given_up) - exchange) / np.outer(root, root))
        if self.exterior == "reflecting":
            _with_the_constant(rates, vectors, root)
        scale = np.sqrt(self.volumes.reshape(-1))

        def back(y: Any) -> FloatArray:
            return np.asarray((vectors @ y / scale).reshape(self.volumes.shape))

        return Modes(self._rate * rates, lambda u: vectors.T @ (scale * u.reshape(-1)), back)

    def eigenvalues(self, count: int) -> FloatArray:
        """Return the least eigenvalues of -D L, in order, each as often as it occurs."""
        count = check.positive_integer("count", count, self.rings * self.angles)
        parts = self._spectra[0]
        alone = {0, self.angles / 2}  # a cosine without a sine
        every = [np.repeat(part, 1 if wave in alone else 2) for wave, part in enumerate(parts)]
        return self._rate * np.sort(np.concatenate(every))[:count]

    # --- one wave number at a time ----------------------------------------------------------------

    @cached_property
    def _root(self) -> FloatArray:
        return np.sqrt(self._rings.volumes)

    @cached_property
    def _given_up(self) -> FloatArray:
        """V_i times the rate at which ring i gives to all other rings and to the exterior."""
        lost = self._rings.exchange(self.alpha, 0).sum(axis=1)
        if self.exterior != "reflecting":
            lost = lost + self._rings.volumes * self._rings.outward_rate(self.alpha)
        return lost

    def _form(self, wave: int) -> FloatArray:
        """-V L of the unit disc for f(r) cos(l theta), symmetric."""
        rings = self._rings
        w = np.diag(self._given_up + rings.volumes * rings.loss(self.alpha, wave))
        return np.asarray(w - rings.exchange(self.alpha, wave))

    @cached_property
    def _matrices(self) -> FloatArray:
        """`_form` between the values of V^(1/2) f, for each wave number."""
        forms = np.array([self._form(wave) for wave in range(self.angles // 2 + 1)])
        return np.asarray(forms / np.outer(self._root, self._root))

    @cached_property
    def _spectra(self) -> tuple[FloatArray, FloatArray]:
        """Eigenvalues and orthonormal vectors of each wave number, shapes (waves, N) and (waves, N, N)."""
        values, vectors = np.linalg.eigh(self._matrices)
        if self.exterior == "reflecting":
            _with_the_constant(values[0], vectors[0], self._root)
        return values, vectors

    def all_modes(self) -> Modes:
        """Return all modes of -D A, by wave number."""
        values, vectors = self._spectra
        waves = np.arange(len(values))
        # int u^2 is the sum of |y|^2. A cosine and its sine share one amplitude, and each has half of 2 pi r V.
        both = np.where((waves == 0) | (2 * waves == self.angles), 1.0, 2.0)
        size = np.sqrt(self.volumes[:, 0] / self.angles * both[:, None])  # (waves, N)

        def into(u: FloatArray) -> Any:
            return _products(vectors.transpose(0, 2, 1), size * self._transformed(u).T)

        def back(y: Any) -> FloatArray:
            return self._back((_products(vectors, y) / size).T)

        return Modes(self._rate * values, into, back)

    def _inflow_of(self, g: Callable[..., Any]) -> tuple[float, Any]:
        """Return the mean g_0 of g at the edge, and c int_(|y| > 1) (g(y) - g_0) |x - y|^(-2-alpha) dy wave by wave.

        The integral has two parts: the rate to the outside times g - g_0 at the edge, and the rest. Since everything
        else works with u - g_0, a constant stays one to the last digit.
        """
        rings = self._rings

        def sampled(r: FloatArray) -> FloatArray:
            return check.sampled("outside", g, *(self.radius * r * one for one in self._direction))

        edge = sampled(np.ones((1, 1)))
        level = float(edge.mean())
        far, near = (
            self._transformed(sampled(1.0 / rings.r[:, None]) - level),
            self._transformed(edge - level)[0],
        )
        beyond_rings, rates = self._from_outside
        return level, np.outer(beyond_rings, near) + _products(rates, far.T).T

    @cached_property
    def _from_outside(self) -> tuple[FloatArray, FloatArray]:
        """The rate to the outside beyond the rings there, and the rates to these rings for each wave number."""
        waves = range(self.angles // 2 + 1)
        rates = np.array([exterior_rate(self._rings, self.alpha, wave) for wave in waves])
        return self._rings.outward_rate(self.alpha) - rates[0].sum(axis=1), rates

    # --- fields and their waves in the angle ------------------------------------------------------

    def warn_of_the_unseen(self, name: str, f: Callable[..., Any], values: FloatArray) -> None:
        """Warn if the particles do not resolve f."""
        between = Rings.between(self.rings)
        angle = 2.0 * np.pi / self.angles * (np.arange(self.angles) + _TURN)
        r = self.radius * between.r[:, None]
        other = check.sampled(name, f, r * np.cos(angle), r * np.sin(angle))
        volumes = 2.0 * np.pi / self.angles * self.radius**2 * between.volumes[:, None]
        warn_of_the_unseen(name, values, self.volumes, other, volumes)

    def _transformed(self, field: FloatArray) -> Any:
        return np.fft.rfft(field, axis=1)

    def _back(self, modes: Any) -> FloatArray:
        return np.asarray(np.fft.irfft(modes, self.angles, axis=1))


def _products(matrices: FloatArray, vectors: Any) -> Any:
    """Return the real matrix of each wave number times its complex vector, shapes (waves, N, N) and (waves, N)."""
    parts = np.ascontiguousarray(vectors, dtype=complex)[..., None].view(float)
    return (matrices @ parts).view(complex)[..., 0]


def _with_the_constant(rates: FloatArray, vectors: FloatArray, root: FloatArray) -> None:
    """Put the constant in place of the first vector, and zero for its rate: exactly, not to the round-off of others."""
    rates[0] = 0.0
    vectors[:, 0] = root / np.linalg.norm(root)
    vectors[:, 1:] -= np.outer(vectors[:, 0], vectors[:, 0] @ vectors[:, 1:])
