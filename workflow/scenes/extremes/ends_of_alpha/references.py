"""Values of the fundamental solution at the ends of alpha that know nothing of the library.

Every radial integral of the study is

    R(n, b, alpha; r) = S_n / (2 pi)^n int_0^inf k^(n-1) exp(-k^alpha) 0F1(b; -k^2 r^2 / 4) dk,

S_n = 2 pi^(n/2) / Gamma(n/2): the density for b = n/2, the mass inside the ball over its volume for b = n/2 + 1. With
k^(s-1) in place of k^(n-1) and alpha = 1 and 2 the integral is in closed form

    Gamma(s) 2F1(s/2, (s+1)/2; b; -r^2)    and    Gamma(s/2) 1F1(s/2; b; -r^2/4) / 2,

and, with L = ln k,

    exp(-k^(1+d)) = exp(-k)   (1 - d k L   + (d L)^2 (k^2 - k) / 2   + ..),
    exp(-k^(2-d)) = exp(-k^2) (1 + d k^2 L + (d L)^2 (k^4 - k^2) / 2 + ..),

so that the corrections are derivatives in s, at s = n + 1, n + 2 and n + 4.
"""

from functools import cache
from typing import Any

import mpmath as mp

_NEAR = 1e-5  # distance to an end within which the limit and its corrections are the reference
_LAST = 60  # of the quadrature: exp(-60) is 1e-26


def source_of(alpha: float) -> str:
    """Return where the reference is from."""
    if alpha - 1.0 < _NEAR:
        return "Cauchy and two corrections, mpmath"
    return "Gauss and two corrections, mpmath" if 2.0 - alpha < _NEAR else "mpmath quadrature"


@cache
def _radial(n: int, two_b: int, alpha: float, r: float) -> mp.mpf:
    with mp.workdps(30):
        b, r, a = mp.mpf(two_b) / 2, mp.mpf(r), mp.mpf(alpha)
        surface = 2 * mp.pi ** (mp.mpf(n) / 2) / mp.gamma(mp.mpf(n) / 2) / (2 * mp.pi) ** n

        def cauchy(s):
            return mp.gamma(s) * mp.hyp2f1(s / 2, (s + 1) / 2, b, -(r**2))

        def gauss(s):
            return mp.gamma(s / 2) * mp.hyp1f1(s / 2, b, -(r**2) / 4) / 2

        if alpha - 1.0 < _NEAR:
            d = a - 1
            second = mp.diff(cauchy, n + 2, 2) - mp.diff(cauchy, n + 1, 2)
            return surface * (cauchy(mp.mpf(n)) - d * mp.diff(cauchy, n + 1) + d**2 / 2 * second)
        if 2.0 - alpha < _NEAR:
            d = 2 - a
            second = mp.diff(gauss, n + 4, 2) - mp.diff(gauss, n + 2, 2)
            return surface * (gauss(mp.mpf(n)) + d * mp.diff(gauss, n + 2) + d**2 / 2 * second)

        def integrand(k):
            return k ** (n - 1) * mp.exp(-(k**a)) * mp.hyp0f1(b, -((k * r) ** 2) / 4)

        near = [0, mp.mpf(1) / 64, mp.mpf(1) / 8, mp.mpf(1) / 2]
        ends = [*near, 1, 2, 3, 5, 8, 12, 18, 26, 40, _LAST]
        return surface * mp.quad(integrand, ends)


def density(n: int, alpha: float, r: float) -> mp.mpf:
    """Return Phi_n(r), n = 1 to 5."""
    return _radial(n, n, alpha, r)


def mass_inside(n: int, alpha: float, r: float) -> mp.mpf:
    """Return the mass inside the ball of radius r."""
    volume = mp.pi ** (mp.mpf(n) / 2) / mp.gamma(mp.mpf(n) / 2 + 1) * mp.mpf(r) ** n
    return volume * _radial(n, n + 2, alpha, r)


def tail_density(n: int, alpha: float, r: float, terms: int = 3) -> mp.mpf:
    """Return the first terms of the far series: what is left is r^(-3 alpha) of it, at r = 10^6 less than 10^-18."""
    return mp.fsum(_terms(n, alpha, r, terms))


def tail_mass(n: int, alpha: float, r: float, terms: int = 3) -> mp.mpf:
    """Return the mass outside the ball, from the same."""
    surface = 2 * mp.pi ** (mp.mpf(n) / 2) / mp.gamma(mp.mpf(n) / 2)
    parts = _terms(n, alpha, r, terms)
    return (
        surface
        * mp.mpf(r) ** n
        * mp.fsum(part / (mp.mpf(alpha) * m) for m, part in enumerate(parts, 1))
    )


def _terms(n: int, alpha: float, r: float, terms: int) -> list[mp.mpf]:
    """Gamma(1 + am) / m! sin(pi am / 2) (-1)^(m+1) Gamma((am+n)/2) / Gamma((am+1)/2) / pi^((n+1)/2) r^(-am-n)."""
    with mp.workdps(40):
        a, r = mp.mpf(alpha), mp.mpf(r)
        return [
            (-1) ** (m + 1)
            * mp.gamma(1 + a * m)
            / mp.factorial(m)
            * mp.sin(mp.pi * a * m / 2)
            * mp.gamma((a * m + n) / 2)
            / mp.gamma((a * m + 1) / 2)
            / mp.pi ** (mp.mpf(n + 1) / 2)
            * r ** (-a * m - n)
            for m in range(1, terms + 1)
        ]


def distance(beta: float) -> float:
    """Return the distance of alpha = 1 + beta, as the double that it is, to the nearer end."""
    alpha = 1.0 + beta
    return min(alpha - 1.0, 2.0 - alpha)


def written(beta: float) -> str:
    """Return beta, or 1 minus it where it is above a half, with one digit."""
    return f"beta = {beta:.0e}" if beta < 0.5 else f"beta = 1 - {2.0 - (1.0 + beta):.0e}"


def relative(found: Any, exact: Any) -> float:
    """Return |found / exact - 1|."""
    return float(abs(mp.mpf(found) / exact - 1))
