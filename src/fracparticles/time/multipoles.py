"""How a tail depends on the direction: derivatives of |x|^(-n-gamma) by harmonic polynomials.

A field that is spread about the middle falls like sum_H b_H H(-grad) |x|^(-n-gamma). Each H is a homogeneous harmonic
polynomial of degree l: the monopole, the dipole, and so on. With s = n + gamma

    H(-grad) |x|^(-s) = s (s + 2) .. (s + 2 l - 2) H(x) |x|^(-s-2l),

and its transform is (-i)^l H(k) |k|^gamma / kappa. The moments int H(x) |x|^(2q) u enter the transform of u by

    exp(-i k.x) = sum_H (-i)^l H(k) H(x) / <H, H> sum_q (-1)^q |k|^(2q) |x|^(2q) / prod_{i=1}^q 2 i (n + 2 l + 2 i - 2),

<H, H> = H(grad) H. This holds because (k.x)^l / l! is the kernel that reproduces polynomials in this inner product.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache, reduce
from math import factorial, prod

import numpy as np

from fracparticles.special.images import series_derivatives
from fracparticles.time.exponents import SAME

__all__ = ["HARMONICS", "Harmonic", "Monomial", "Terms", "monomial", "terms_of", "values_of"]

Monomial = tuple[int, ...]
"""The exponent of each coordinate."""


@dataclass(frozen=True)
class Harmonic:
    """A homogeneous harmonic polynomial: exponents and coefficients of its monomials, all of one parity."""

    terms: tuple[tuple[Monomial, float], ...]

    @cached_property
    def degree(self) -> int:
        """l."""
        return sum(self.terms[0][0])

    @cached_property
    def parity(self) -> Monomial:
        """For each coordinate, 1 if H is odd in it and 0 if it is even."""
        return tuple(e % 2 for e in self.terms[0][0])

    def share(self, q: int) -> float:
        """Return the factor of int H(x) |x|^(2q) u in the transform of u, in units of (-i)^l H(k) |k|^(2q)."""
        own = sum(c * c * prod(map(factorial, powers)) for powers, c in self.terms)
        n = len(self.parity) + 2 * self.degree
        return 1.0 / (own * prod(-2.0 * i * (n + 2 * i - 2) for i in range(1, q + 1)))

    def moment(self, q: int) -> dict[Monomial, float]:
        """Return H(x) |x|^(2q) as the coefficients of its monomials."""
        found = dict(self.terms)
        for _ in range(q):
            raised: dict[Monomial, float] = {}
            for powers, c in found.items():
                for d in range(len(powers)):
                    up = (*powers[:d], powers[d] + 2, *powers[d + 1 :])
                    raised[up] = raised.get(up, 0.0) + c
            found = raised
        return found

    def moment_at(self, q: int, x: np.ndarray) -> np.ndarray:
        """Return H(x) |x|^(2q) at points x, shape (n, points)."""
        return np.asarray(sum(c * _product(x, x, e) for e, c in self.moment(q).items()))

    def tail(self, x: np.ndarray, odd: np.ndarray, gamma: float) -> np.ndarray:
        """Return H(-grad) |x|^(-n-gamma) at points x, shape (n, ..).

        The odd powers of a coordinate are x^(2m) `odd`; `odd` is x, except for places where odd functions vanish.
        """
        s = len(x) + gamma
        found = np.square(x).sum(axis=0) ** (-0.5 * s - self.degree)
        if self.degree:
            angular = sum(c * _product(x, odd, e) for e, c in self.terms)
            found *= prod(s + 2.0 * i for i in range(self.degree)) * angular
        return found

    def of_series(self, series: np.ndarray) -> np.ndarray:
        """Return H(-grad) f for f = sum c_{ij..} T_i(8 x_1^2 - 1) T_j(8 x_2^2 - 1) .., with c of shape (.., i, j, ..).

        The result holds coefficients of the same polynomials, times the coordinates in which H is odd.
        """
        dim, total = len(self.parity), np.zeros_like(series)
        for powers, c in self.terms:
            one = (-1.0) ** self.degree * c * series
            for axis, e in enumerate(powers, series.ndim - dim):
                matrix = _derivative(series.shape[-1], e)
                one = np.swapaxes(np.swapaxes(one, axis, -1) @ matrix.T, axis, -1)
            total += one
        return total


def monomial(x: np.ndarray, odd: np.ndarray, exponent: int) -> np.ndarray:
    """Return x^e; an odd power is `odd` times an even power."""
    found = odd if exponent % 2 else np.ones_like(x)
    for _ in range(exponent // 2):
        found = found * x * x
    return found


def _product(x: np.ndarray, odd: np.ndarray, exponents: Monomial) -> np.ndarray:
    """The product of x_d^e over the coordinates; 1 if all exponents are zero."""
    parts = [monomial(x[d], odd[d], e) for d, e in enumerate(exponents) if e]
    return reduce(np.multiply, parts) if parts else np.ones(x.shape[1:])


@lru_cache(maxsize=32)
def _derivative(count: int, times: int) -> np.ndarray:
    """The matrix of `times` derivatives: from the even polynomials to even ones, or to x times even ones."""
    first, second = series_derivatives(count)
    found = np.eye(count)
    for k in range(times):
        found = (second if k % 2 else first) @ found
    return found


def _harmonics(*polynomials: dict[str, float], axes: str) -> tuple[Harmonic, ...]:
    """Return polynomials from the coefficients of their monomials, which are written like "xxy"."""
    return tuple(
        Harmonic(tuple((tuple(map(word.count, axes)), c) for word, c in one.items()))
        for one in polynomials
    )


HARMONICS: dict[int, tuple[Harmonic, ...]] = {
    1: _harmonics({"": 1.0}, {"x": 1.0}, axes="x"),
    2: _harmonics(
        {"": 1.0}, {"x": 1.0}, {"y": 1.0}, {"xx": 1.0, "yy": -1.0}, {"xy": 1.0},
        {"xxx": 1.0, "xyy": -3.0}, {"yyy": 1.0, "xxy": -3.0},
        {"xxxx": 1.0, "xxyy": -6.0, "yyyy": 1.0}, {"xxxy": 1.0, "xyyy": -1.0}, axes="xy",
    ),
    3: _harmonics(
        {"": 1.0}, {"x": 1.0}, {"y": 1.0}, {"z": 1.0}, {"xy": 1.0}, {"yz": 1.0}, {"xz": 1.0},
        {"xx": 1.0, "yy": -1.0}, {"zz": 2.0, "xx": -1.0, "yy": -1.0}, axes="xyz",
    ),
}  # fmt: skip
"""All H up to degree 4 in the plane and 2 in space, by dimension; on the line there are none above degree 1."""


Terms = list[tuple[Harmonic, float]]
"""The H and the gamma of each term of a tail."""


def terms_of(exponents: np.ndarray, dim: int) -> Terms:
    """Return the pairs of H and gamma that fall no faster than the dipole of the last gamma."""
    last = max(exponents, default=0.0) + 1.0
    return [(h, float(g)) for h in HARMONICS[dim] for g in exponents if g + h.degree <= last + SAME]


def values_of(terms: Terms, x: np.ndarray, odd: np.ndarray) -> np.ndarray:
    """Return each H(-grad) |x|^(-n-gamma), shape (terms, ..), at points of shape (n, ..); see `Harmonic.tail`."""
    values = np.empty((len(terms), *x.shape[1:]))
    for row, (harmonic, gamma) in zip(values, terms, strict=True):
        row[:] = harmonic.tail(x, odd, gamma)
    return values
