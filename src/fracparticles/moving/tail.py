r"""The region beyond the end particles: the far field of the solution, like the open exterior of a lattice.

Beyond its ends a set of particles continues as u = c |y|^(-1-alpha), the leading term of (A.2). On either side c
matches the strength of the outermost particles, eight of them or an eighth of all,

    c = sum_j U_j / int |y|^(-1-alpha) dy     over their cells, which end half-way between neighbours.

Up to a distance of 20 smoothing lengths the tail is made of particles, as far apart as the outermost ones are on the
mean, each with the strength of its cell. They count in every sum, and in remeshing, which would otherwise smear the
end. Beyond them, from Y on, the kernel F is its own far field, and the tail adds to the flux

    Q(x) = -D A c int_Y^inf y^(-1-alpha) (y - x)^(-alpha) dy = -D A c Y^(-2 alpha) g(x / Y),
    g(xi) = 2F1(alpha, 2 alpha; 2 alpha + 1; xi) / (2 alpha),     A = Gamma(alpha) sin(pi alpha / 2) / pi,

and likewise on the left. This is not in the paper, whose end particles see nothing beyond and run outward.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import hyp2f1

from fracparticles._compiled import njit
from fracparticles.errors import InvalidInput
from fracparticles.moving.polynomials import fitted, horner
from fracparticles.moving.reliability import cells
from fracparticles.special.tails import tail_constant

__all__ = ["FITTED", "REACH", "Tail", "TailEnd", "TailModel"]

FITTED = 8  # outermost particles to which c is fitted,
_SHARE = 8  # or an eighth of all, if these are fewer,
_FEWEST = 2  # and never fewer than this
_CLOSEST = 1e-3  # smoothing lengths between two particles of the tail, for others that coincide
_HALF_WAY = 0.05  # of the way to the end, to either side of its middle: there the power is compared with the field
REACH = 20.0  # smoothing lengths; there F misses its far field by alpha (alpha + 1) / (4 REACH^2), 0.4 % at most
# Of log(1 - xi): how much more than asked for the table of g covers, so that it is not made anew at every step.
_MARGIN = 0.5


@dataclass(frozen=True)
class TailEnd:
    """The tail on one side, in the coordinate that grows outwards.

    Attributes
    ----------
    beyond : float
        The strength of all that lies beyond the last particle, c last^-alpha / alpha. In small units c underflows.
    last : float
        The last particle.
    start : float
        Y, where the particles of the tail end.
    x, strength : array
        The particles of the tail.
    """

    beyond: float
    last: float
    start: float
    x: np.ndarray
    strength: np.ndarray


@dataclass(frozen=True)
class Tail:
    """Both tails of a set of particles.

    Attributes
    ----------
    left, right : TailEnd
        The left one mirrored.
    """

    left: TailEnd
    right: TailEnd

    def continued(self, x: np.ndarray, strength: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the particles followed by those of both tails."""
        return (
            np.concatenate([x, self.right.x, -self.left.x]),
            np.concatenate([strength, self.right.strength, self.left.strength]),
        )

    def holds(self, z: np.ndarray) -> np.ndarray:
        """Return at which points the particles and those of the tails are all that the kernels of u reach."""
        low, high = self.limits
        return np.asarray((low <= z) & (z <= high))

    @property
    def limits(self) -> tuple[float, float]:
        """The ends of where the tail `holds`, half-way through the particles of either side."""
        left, right = (0.5 * (end.last + end.start) for end in (self.left, self.right))
        return -left, right


class TailModel:
    """The tails of any set of particles.

    Parameters
    ----------
    alpha : float
        Fractional order.
    epsilon : float
        Smoothing length.
    diffusivity : float
        D of Eq. (2).
    """

    def __init__(self, alpha: float, epsilon: float, diffusivity: float = 1.0) -> None:
        self.alpha, self.epsilon = alpha, epsilon
        self._factor = diffusivity * tail_constant(alpha) / alpha
        self._table = 0.0, 0.0, (np.zeros(8), np.zeros(8))

    def __call__(self, x: np.ndarray, strength: np.ndarray) -> Tail:
        """Return the tails of these particles, given in any order.

        Raises
        ------
        InvalidInput
            If there are too few particles, or the origin does not lie among them.
        """
        fitted_to = min(FITTED, x.size // _SHARE)
        if fitted_to < _FEWEST:
            allowed = f"'truncated' for fewer than {_SHARE * _FEWEST} particles"
            remedy = "Take more particles, or a smaller threshold."
            raise InvalidInput("exterior", "open", allowed, remedy)
        if not (x[1:] >= x[:-1]).all():
            order = np.argsort(x, kind="stable")
            x, strength = x[order], strength[order]
        count = fitted_to + 1
        left = self._end(-x[:count][::-1], strength[:count][::-1])
        return Tail(left, self._end(x[-count:], strength[-count:]))

    def _end(self, x: np.ndarray, strength: np.ndarray) -> TailEnd:
        last, inner = float(x[-1]), 0.5 * float(x[0] + x[1])
        if not inner > 0.0:
            allowed = "'truncated' unless the particles surround the origin"
            remedy = "Move the data there, or take 'truncated'."
            raise InvalidInput("exterior", "open", allowed, remedy)
        gap = max((last - float(x[0])) / (x.size - 1), _CLOSEST * self.epsilon)
        edges = last + gap * np.arange(0.5, math.ceil(REACH * self.epsilon / gap) + 1.0)
        shares = (
            edges / last
        ) ** -self.alpha  # beyond each edge, of what lies beyond the last particle
        beyond = float(strength[1:].sum()) / ((inner / last) ** -self.alpha - float(shares[0]))
        strengths = beyond * (shares[:-1] - shares[1:])
        places = 0.5 * (edges[:-1] + edges[1:])
        return TailEnd(beyond, last, float(edges[-1]), places, strengths)

    def misfit(self, x: np.ndarray, strength: np.ndarray) -> float:
        """Return the error of the total due to the tails: their strength times the misfit of their power law.

        The misfit of an end, at most 1, is that of c |y|^(-1-alpha) on the field half-way from the origin to the end.
        Errors as for a call.
        """
        tail = self(x, strength)
        width, wrong = cells(x), 0.0
        for end, side in ((tail.left, -1.0), (tail.right, 1.0)):
            there = np.abs(side * x / end.last - 0.5) < _HALF_WAY
            field = float(strength[there].sum() / width[there].sum()) if there.any() else np.inf
            power = self._field(end, 0.5)
            wrong += abs(end.beyond) * min(abs(field / power - 1.0) if power else 0.0, 1.0)
        return float(wrong / np.abs(strength).sum())

    def continued(self, x: np.ndarray, strength: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the particles followed by those of both tails."""
        return self(x, strength).continued(x, strength)

    def far_field(self, tail: Tail, z: np.ndarray) -> np.ndarray:
        """Return c |z|^(-1-alpha) at points beyond the particles."""
        left, right = (self._field(end, np.abs(z) / end.last) for end in (tail.left, tail.right))
        return np.where(z > 0.0, right, left)

    def _field(self, end: TailEnd, part: float | np.ndarray) -> Any:
        """Return c |y|^(-1-alpha) at parts of the way from the origin to the last particle."""
        return self.alpha * end.beyond / end.last * part ** (-1.0 - self.alpha)

    def flux(self, tail: Tail, z: np.ndarray) -> np.ndarray:
        """Return what the tails from Y on add to the flux at points that the tail `holds`."""
        low, high = tail.limits
        out = np.zeros(z.size)
        for end, sign, nearest, farthest in (
            (tail.left, -1.0, -low, -high),
            (tail.right, 1.0, high, low),
        ):
            middle, half, polynomials = self._g(farthest / end.start, nearest / end.start)
            t = np.log(1.0 - (sign / end.start) * z)
            beyond = self.alpha * end.beyond * (end.last / end.start) ** self.alpha  # c Y^-alpha
            factor = -sign * self._factor * beyond * end.start**-self.alpha
            _add(t, middle, 1.0 / half, *polynomials, factor, out)
        return out

    def _g(self, low: float, high: float) -> tuple[float, float, tuple[np.ndarray, np.ndarray]]:
        """g from low to high, a polynomial in t = log(1 - xi), exact to 1e-6 or much better: of (t - middle) / half."""
        first, last = math.log(1.0 - high), math.log(1.0 - low)
        middle, half, polynomials = self._table
        if not (middle - half <= first and last <= middle + half):
            middle, half = 0.5 * (first + last), 0.5 * (last - first) + _MARGIN
            polynomials = fitted(lambda y: self._exact(middle + half * y))
            self._table = middle, half, polynomials
        return self._table

    def _exact(self, t: np.ndarray) -> np.ndarray:
        """2F1(alpha, 2 alpha; 2 alpha + 1; xi) / (2 alpha), after Euler's transformation."""
        a = self.alpha
        smooth = hyp2f1(1.0 + a, 1.0, 2.0 * a + 1.0, -np.expm1(t))
        return np.asarray(np.exp((1.0 - a) * t) * smooth / (2.0 * a))


@njit(error_model="numpy", fastmath={"contract"})
def _add(t, middle, scale, even, odd, factor, out):
    for i in range(t.size):
        y = scale * (t[i] - middle)
        out[i] += factor * (horner(even, y * y) + y * horner(odd, y * y))
