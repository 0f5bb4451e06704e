r"""The gamma kernel family, of any even order 2m: its regularisation is an incomplete gamma function.

The Gaussian (8) has the transform exp(-z), z = k^2 / 4. Multiplied by the first m terms of exp(z) it stays near 1:

    eta^(k) = e^-z sum_{j<m} z^j / j! = Q(m, z) = 1 - z^m / m! + ...,

so that every kernel built from it is of order 2m. m = 1 is the order II of the paper. The order IV of the paper (9) is
of another kernel family, except for (24), which is the gradient of m = 2. In space z^j is a power of the Laplacian, and
with M(a, b, x) = 1F1(a; b; -x)

    eta = pi^(-n/2) e^-x L_{m-1}^(n/2)(x),                x = r^2,
    G   = -Gamma_{n,0}(alpha) W_m((n+alpha)/2, n/2, x),   W_m(a, b, x) = sum_{j<m} (a)_j / j! M(a + j, b, x),

and likewise kappa, F and K, see `kernels.rules`. W_m is evaluated as

    W_m(a, b, x) = sum_k p_k(x) q_k,   q_k = sum_{j<m} (a)_j / j! (b-a-j)_k / (b)_k,   p_k = e^-x x^k / k!  (near),
    W_m(a, b, x) ~ Gamma(b) / Gamma(b-a) x^-a [1 - (-1)^m sum_{l>=m} C(l-1, m-1) (a)_l (a-b+1)_l / (l! x^l)]  (far).

The near form is Kummer's transformation of each M. The weights p_k are those of a Poisson distribution, positive with
sum 1, so that the errors of W_m are rounding errors of q_k. The far form is DLMF 13.7.2 for each M. Its term l gets the
factor sum_{j<m} (-1)^j C(l, j) = (-1)^(m-1) C(l-1, m-1), so that nothing cancels. l = 0 is the only term before l = m,
and is the exact r^(-n-alpha) of the fractional Laplacian, the same for every order.

The errors were measured against mpmath for all orders, dimensions and 1.001 <= alpha <= 1.9999. The absolute error is
below 5e-15 of the largest |kernel|, half of it from the fit of the table. Pointwise it is below 2e-13 of
sum_j |(a)_j / j! M(a + j, b, x)|, so that digits are lost next to the zeros only. Beyond r = 9 the relative error is
6e-15. A higher order does not raise these: the terms of W_m are largest at r = 0, where all are positive. (The series
in powers of x would lose e^(2x).)
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.special import binom, gamma, gammaincc, gammainccinv, poch, rgamma

from fracparticles._compiled import njit
from fracparticles.arguments import FloatArray, elementwise
from fracparticles.kernels.rules import KernelFamily
from fracparticles.special import chebyshev
from fracparticles.special.hypergeometric import WIDTH, poisson_weights

__all__ = ["GAMMA", "NAMES", "ORDERS", "kernel", "kernel_transform", "wavenumber_reach"]

ORDERS = (2, 4, 6, 8, 10, 12)
_ZERO = 750.0  # x from which exp(-x) times any of the polynomials is zero
_FAR = 80.0  # x from which 48 terms of the asymptotic series leave 1e-19 at order 12
_TERMS = 48  # of the asymptotic series


class _Table(NamedTuple):
    """W_m(a, b, .) for one (a, b, m): the near coefficients, and the prefactor, the power and the series far away."""

    near: FloatArray
    prefactor: float
    a: float
    m: int
    far: FloatArray


@lru_cache(maxsize=256)
def _table(c: float, b: float, m: int) -> _Table:
    """Return the table of W_m(b - c, b, .); c = b - a keeps its digits as alpha nears 2."""
    a = b - c
    weights = poisson_weights(int(_FAR / WIDTH))
    k, j = np.arange(weights.shape[0] - 1)[:, None], np.arange(m)
    # (c-j)_k / (b)_k. k - j is computed first, so that c and c + 1 are exact factors.
    ratios = np.vstack([np.ones(m), np.cumprod(((k - j) + c) / (b + k), axis=0)])
    q = ratios @ (poch(a, j) / gamma(j + 1.0))
    samples = (q @ weights).reshape(-1, chebyshev.DEGREE + 1)
    terms = np.arange(m, _TERMS)
    far = poch(a, terms) * poch(1.0 - c, terms) / gamma(terms + 1.0) * binom(terms - 1, m - 1)
    return _Table(
        near=chebyshev.fit(samples),
        # 1 / Gamma(c) by two steps of the recurrence, which keep all digits where c is close to 0 or -1.
        prefactor=float(gamma(b) * c * (c + 1.0) * rgamma(c + 2.0)),
        a=a,
        m=m,
        far=-((-1.0) ** m) * far,
    )


@njit()
def _evaluate(x: FloatArray, table: _Table, out: FloatArray) -> None:
    for i in range(x.size):
        if x[i] < _FAR:
            out[i] = chebyshev.horner(x[i] / WIDTH, table.near)
            continue
        power, correction = x[i] ** -table.m, 0.0
        for k in range(table.far.size):
            term = table.far[k] * power
            correction += term
            if abs(term) < 1e-17:
                break
            power /= x[i]
        out[i] = table.prefactor * x[i] ** -table.a * (1.0 + correction)


# --- the kernel family ----------------------------------------------------------------------------


def _laguerre_gaussian(r: FloatArray, n: int, m: int, upper: float) -> FloatArray:
    """pi^(-n/2) e^-x L_{m-1}^(upper)(x), x = r^2, by the three-term recurrence (DLMF 18.9.1)."""
    x = np.minimum(r * r, _ZERO)
    before, value = np.zeros_like(x), np.ones_like(x)
    for k in range(m - 1):
        next_value = ((2 * k + 1 + upper - x) * value - (k + upper) * before) / (k + 1)
        before, value = value, next_value
    return np.exp(-x) * value / math.pi ** (0.5 * n)


class _Gamma(KernelFamily):
    orders = ORDERS

    def m(self, c: float, b: float, r: FloatArray, order: int) -> FloatArray:
        """W_m(b - c, b, r^2)."""
        return np.asarray(elementwise(_evaluate, r * r, _table(c, b, int(order) // 2)))

    def eta(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """pi^(-n/2) e^-x L_{m-1}^(n/2)(x): the moments of order 2 to 2m - 2 vanish."""
        return _laguerre_gaussian(r, n, int(order) // 2, 0.5 * n)

    def phi(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """2 pi^(-n/2) e^-x L_{m-1}^(n/2+1)(x), as (17)."""
        return 2.0 * _laguerre_gaussian(r, n, int(order) // 2, 0.5 * n + 1.0)

    def eta1(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """d eta/dr = -r Phi: (23), and for m = 2 (24)."""
        return -r * self.phi(r, alpha, n, order)

    def eta_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """Q(m, k^2/4) = e^-z sum_{j<m} z^j / j!,  z = k^2/4."""
        return np.asarray(gammaincc(int(order) // 2, 0.25 * k * k))

    def eta1_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """k eta^(k), for every n."""
        return k * self.eta_hat(k, alpha, n, order)

    def k_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """int_k^inf k^(alpha-1) eta^ dk = 2^(alpha-1) sum_{j<m} Gamma(s + j, k^2/4) / j!,  s = alpha/2.

        For every n; Gamma(s, x) is the upper incomplete gamma function.
        K^(0) = (2^alpha / alpha) Gamma(m + s) / (m-1)!.
        """
        s, z = 0.5 * alpha, np.minimum(0.25 * k * k, _ZERO)
        # Gamma(s + 1, z) = s Gamma(s, z) + z^s e^-z: no term is negative.
        upper, power = gamma(s) * gammaincc(s, z), z**s * np.exp(-z)
        total = upper
        for j in range(1, int(order) // 2):
            upper = (s + j - 1.0) * upper + power
            power = power * z
            total = total + upper / math.factorial(j)
        return 2.0 ** (alpha - 1.0) * total

    def phi_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """2 sum_{j<m} Q(j + 1, k^2/4): K^ for alpha = 2."""
        return self.k_hat(k, 2.0, n, order)


GAMMA = _Gamma()
NAMES = GAMMA.names
kernel, kernel_transform = GAMMA.kernel, GAMMA.kernel_transform


def wavenumber_reach(order: int, smallest: float = 1e-22) -> float:
    """Return the wavenumber beyond which eta^ = Q(m, k^2/4) < smallest; other transforms are a power of k times eta^.

    Raises `InvalidInput` if the order is not one of `ORDERS`.
    """
    GAMMA.check_order(order)
    return 2.0 * math.sqrt(float(gammainccinv(int(order) // 2, smallest)))
