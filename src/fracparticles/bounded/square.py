r"""Fractional diffusion in a square |x|, |y| < R, by strengths that the particles of a lattice exchange:

    u_t = D L u + f,    L u(x) = c p.v. int (u(y) - u(x)) |x - y|^(-2-alpha) dy = -(-Laplacian)^(alpha/2) u,

with one of three exteriors:

- "absorbing": u = 0 outside, the restricted operator. The lattice is fitted to the edges, see `square_lattice`. The
  order is 6 - alpha inside and 1 + alpha at the edges. A lattice that is not fitted has the order one, like
  linear finite elements on a uniform mesh (Acosta & Borthagaray, SIAM J. Numer. Anal. 55 (2017) 472);
- "reflecting": the integral is over the square only, the regional operator. The total is conserved. The order is 2;
- "given": u = g outside. With v = u - g, which is zero there, v_t = D L v + D L g + f; a constant stays a constant. L g
  is computed on a wider lattice, with quadratures beyond (`square_outside`), so g has to be smooth across the edge.

The N^2 particles lie at the middles of square cells, h = 2 R / N, and their sums are fast Fourier transforms. Time is
exact, by Chebyshev series; steady fields are found by conjugate gradients.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from scipy.fft import dctn, dstn, idctn, idstn
from scipy.sparse.linalg import LinearOperator, cg, eigsh

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.bounded.domain import EXTERIORS, Domain
from fracparticles.bounded.given import Lift
from fracparticles.bounded.modes import Held, Rest
from fracparticles.bounded.plane_resolution import warn_of_the_unseen
from fracparticles.bounded.square_lattice import (
    edge_exchange,
    edge_fit,
    edge_volumes,
    rate_of_all,
    weights,
)
from fracparticles.bounded.square_outside import Outside, outward_rate
from fracparticles.bounded.square_transport import SquareTransport
from fracparticles.errors import FracparticlesError
from fracparticles.lattice.box import BoxConvolution
from fracparticles.lattice.operators import ConvolutionOperator
from fracparticles.time.pieces import exponential_flow
from fracparticles.time.steps import EighthOrderStep, Steps, norm

__all__ = ["Square"]

_MOST = 512  # particles along a side
_SOLVED = 1e-12  # the relative residual of a steady field
_MOST_STEPS = 20000  # steps of conjugate gradients


class Square(Domain):
    """Particles in a square.

    Parameters
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    particles : int
        N, particles along a side, 8 to 512.
    exterior : {"absorbing", "reflecting", "given"}
    half_width, diffusivity : float
        R and D.
    fitted : bool
        Whether the lattice is fitted to the edges; False to compare.

    Attributes
    ----------
    x, y, volumes : array, shape (N, N)
        The places of the particles, x along the first axis, and their volumes; a field is an array of that shape.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """

    balance = 1e-6

    def __init__(
        self,
        alpha: float,
        particles: int = 64,
        exterior: str = "absorbing",
        *,
        half_width: float = 1.0,
        diffusivity: float = 1.0,
        fitted: bool = True,
    ) -> None:
        self.alpha = check.fractional_order(alpha)
        self.particles = check.whole_number("particles", particles, 8, _MOST)
        self.exterior = check.choice("exterior", exterior, EXTERIORS)
        self.half_width = check.scale("half_width", half_width)
        self.diffusivity = check.scale("diffusivity", diffusivity)
        fitted = check.flag("fitted", fitted)
        h = self._spacing = 2.0 * self.half_width / self.particles
        # The unit of the operator: it is that of a lattice of spacing one.
        self._rate = self.diffusivity * h**-self.alpha
        middle = h * (np.arange(self.particles) - 0.5 * (self.particles - 1))
        self.x, self.y = self.points = tuple(np.meshgrid(middle, middle, indexing="ij"))
        line = np.ones(self.particles)
        if fitted and exterior != "reflecting":
            line = edge_volumes(self.alpha, self.particles)
            line = line * line[::-1]
        self._line = line
        volumes = np.multiply.outer(line, line)
        self.volumes = h * h * volumes
        # Between the values of V^(1/2) u the operator is symmetric.
        self._root = np.sqrt(volumes).reshape(-1)
        shape = (self.particles, self.particles)
        self._sums = BoxConvolution(
            [weights(self.alpha, self.particles)], [None], self.particles, self.particles
        )
        if exterior == "reflecting" or not fitted:
            lost = self._sums(np.ones(shape))[0].copy()
            if exterior != "reflecting":
                lost += outward_rate(self.x / h, self.y / h, 0.5 * self.particles, self.alpha)
        else:
            fit = edge_fit(self.alpha, self.particles)
            fit = fit + fit[::-1]
            lost = rate_of_all(self.alpha) + np.add.outer(fit, fit)
        self._lost = lost.reshape(-1)
        self._along = np.zeros((self.particles, 1))
        if fitted and exterior == "reflecting":
            along = edge_exchange(self.alpha, self.particles)
            self._along = (along + along[::-1])[:, None]
        self._operator = ConvolutionOperator(self._convolved, -self._lost, None, dim=2)

    def applied(self, u: FloatArray) -> FloatArray:
        """Return D A u, with u = 0 outside."""
        return self._rate * self._outer(self._operator.apply(self._inner(u)))

    def at_rest(self, load: FloatArray) -> FloatArray:
        """Return the u with D A u + load = 0; for a reflecting exterior the one of total 0."""
        return self._outer(self._at_rest(self._inner(load) / self._rate))

    def decayed(self, u: FloatArray, time: float) -> FloatArray:
        """Return exp(time D A) u, by Chebyshev series; raises `FracparticlesError` if that takes too many sums."""
        t = self._rate * time
        if t == 0.0:
            return u
        v = self._inner(u)
        mean = v.mean() if self.exterior == "reflecting" else 0.0
        v = exponential_flow(self._operator, t, -2.0 * float(self._lost.max()), 0.0)(v - mean)
        if self.exterior == "reflecting":
            v = v - v.mean()  # round-off
        return self._outer(v + mean)

    def steps(self, rest: Rest, tolerance: float, held: Held) -> Steps:
        """Return steps of order 8 of u' = D A u + rest(t, u)."""

        def least(t: float, u: FloatArray) -> float:
            return tolerance * max(float(np.abs(u).max()), float(np.abs(held(t)).max()))

        return EighthOrderStep(lambda t, u: self.applied(u) + rest(t, u), tolerance, least)

    def lifted(self, g: Callable[..., Any]) -> Lift:
        """Return g itself, which goes on smoothly inside, and D A g."""
        base = check.sampled("outside", g, self.x, self.y)
        nothing = np.zeros(base.shape)
        return Lift(base, self._rate * self._rate_of_smooth(g), nothing, nothing)

    def carried(
        self, v: FloatArray, base: FloatArray, velocity: Sequence[FloatArray]
    ) -> FloatArray:
        """Return -div(a u), u = v + base: waves of v grow only where pressed together, see `square_transport`.

        Where nothing leaves, the total is kept.
        """
        every = [np.broadcast_to(one, self.volumes.shape) for one in velocity]
        moved = self._transport.carried(v, *every)
        if base.any():
            moved += self._transport.of_smooth(base, *every)
        return moved / self._spacing

    def divergence(self, velocity: Sequence[FloatArray]) -> FloatArray:
        """Return div a as `carried` takes it."""
        every = (np.broadcast_to(one, self.volumes.shape) for one in velocity)
        return self._transport.divergence(*every) / self._spacing

    @cached_property
    def _transport(self) -> SquareTransport:
        return SquareTransport(self.alpha, self._line, self.exterior == "reflecting")

    def eigenvalues(self, count: int) -> FloatArray:
        """Return the least eigenvalues of -D L, in order, each as often as it occurs: up to 20 of them."""
        count = check.positive_integer("count", count, 20)
        size = self.particles**2
        idle = self.exterior == "reflecting"  # the constant
        if idle and count == 1:
            return np.zeros(1)
        inverse = LinearOperator((size, size), matvec=self._at_rest, dtype=float)
        operator = LinearOperator(
            (size, size), matvec=lambda v: -self._operator.apply(v), dtype=float
        )
        start = np.random.default_rng(0).standard_normal(size)  # it has a part of every symmetry
        wanted = count - int(idle)
        found = eigsh(
            operator,
            wanted,
            sigma=0.0,
            OPinv=inverse,
            v0=start - start.mean() * idle,
            return_eigenvectors=False,
        )
        return self._rate * np.concatenate([np.zeros(count - wanted), np.sort(found)])

    def unresolved(self, v: FloatArray) -> float:
        """Return the norm of v in sines, or cosines, of more than half a wave for two particles."""
        waves = (dctn if self.exterior == "reflecting" else dstn)(v, type=2, norm="ortho")
        waves[: self.particles // 2, : self.particles // 2] = 0.0
        return norm(waves) * 2.0 * self.half_width / self.particles

    # --- between V^(1/2) u and u ------------------------------------------------------------------

    def _convolved(self, v: FloatArray) -> FloatArray:
        field = (self._root * v).reshape(self.particles, self.particles)
        out = self._sums(field)[0]
        if self.exterior == "reflecting":
            for u, y in ((field, out), (field.T, out.T)):  # lines along either pair of edges
                passed = self._along * np.diff(u, axis=1)
                y[:, :-1] += passed
                y[:, 1:] -= passed
        return self._root * out.reshape(-1)

    def _inner(self, u: FloatArray) -> FloatArray:
        return self._root * u.reshape(-1)

    def _outer(self, v: FloatArray) -> FloatArray:
        return (v / self._root).reshape(self.particles, self.particles)

    def _at_rest(self, f: FloatArray) -> FloatArray:
        """Return the v with L v + f = 0, by conjugate gradients; for a reflecting exterior the one of total 0."""
        idle, f = self.exterior == "reflecting", f.reshape(-1)
        if idle:
            f = f - f.mean()
        if not f.any():
            return np.zeros_like(f)
        minus = LinearOperator(
            (f.size, f.size), matvec=lambda v: -self._operator.apply(v), dtype=float
        )
        scaled = LinearOperator((f.size, f.size), matvec=self._nearly_inverse, dtype=float)
        v, state = cg(minus, f, rtol=_SOLVED, maxiter=_MOST_STEPS, M=scaled)
        if state:
            raise FracparticlesError(
                f"no steady field after {_MOST_STEPS} steps of conjugate gradients"
            )
        return np.asarray(v - v.mean() if idle else v)

    def _nearly_inverse(self, f: FloatArray) -> FloatArray:
        """Apply the inverse of the spectral power of the Laplacian, by sines or cosines: -L is equivalent to it."""
        idle = self.exterior == "reflecting"
        there, back = (dctn, idctn) if idle else (dstn, idstn)
        k = np.pi / self.particles * (np.arange(self.particles) + float(not idle))
        symbol = np.add.outer(k * k, k * k) ** (0.5 * self.alpha)
        symbol[0, 0] = symbol[0, 0] or np.inf
        u = self._outer(f)
        return self._inner(back(there(u, type=2) / symbol, type=2))

    # --- fields -----------------------------------------------------------------------------------

    def warn_of_the_unseen(self, name: str, f: Callable[..., Any], values: FloatArray) -> None:
        """Warn if the particles do not resolve f."""
        # The corners of the cells; those at the edges count for a half.
        line = np.linspace(-self.half_width, self.half_width, self.particles + 1)
        part = np.full(self.particles + 1, 2.0 * self.half_width / self.particles)
        part[[0, -1]] *= 0.5
        corners = check.sampled(name, f, *np.meshgrid(line, line, indexing="ij"))
        cell = np.full(values.shape, (2.0 * self.half_width / self.particles) ** 2)
        warn_of_the_unseen(name, values, cell, corners, np.multiply.outer(part, part))

    def _rate_of_smooth(self, g: Callable[..., Any]) -> FloatArray:
        """Return L g in the square, in the unit of the lattice, by a lattice twice as wide and the mean beyond."""
        n, h, margin = self.particles, 2.0 * self.half_width / self.particles, self._margin
        wide = h * (np.arange(n + 2 * margin) - 0.5 * (n + 2 * margin - 1))
        values = check.sampled("outside", g, *np.meshgrid(wide, wide, indexing="ij"))
        own = values[margin : margin + n, margin : margin + n]
        sums, sums_of_one, beyond = self._of_smooth
        # The level is taken off first: a constant is one to the last digit.
        level = float(own.mean())
        gained = sums(values - level)[0] - (own - level) * sums_of_one
        mean = beyond.mean(lambda x, y: g(h * x, h * y))
        return np.asarray(gained + beyond.rate * (mean - own))

    @property
    def _margin(self) -> int:
        """Cells that the wider lattice has beyond each edge."""
        return self.particles // 2

    @cached_property
    def _of_smooth(self) -> tuple[BoxConvolution, FloatArray, Outside]:
        """The sums on the wider lattice, the sums of one, and the means beyond."""
        n, h, margin = self.particles, 2.0 * self.half_width / self.particles, self._margin
        sums = BoxConvolution([weights(self.alpha, n + margin)], [None], n + 2 * margin, n)
        of_one = sums(np.ones((n + 2 * margin,) * 2))[0].copy()
        return sums, of_one, Outside(self.x / h, self.y / h, 0.5 * n + margin, self.alpha)
