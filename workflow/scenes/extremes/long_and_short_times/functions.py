"""Probes of the fundamental solution over 150 decades of time."""

from collections.abc import Callable, Iterator
from itertools import product

import numpy as np

import fracparticles as fp
from fracparticles.special import central_mass, tail_mass
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe, off
from scenes.extremes.long_and_short_times.profile import profile, rate, tail_constant

_RADII = np.array([0.0, 0.3, 1.0, 3.0, 10.0, 1e3, 1e6])
_NEAR = _RADII[:5]


def _rounded(t: float) -> float:
    """What t^(1/alpha), and back, may cost: its exponent has a rounding, times ln t."""
    return 8.0 * EPS * (1.0 + abs(np.log(t)))


def _profile(alpha: float, n: int, t: float) -> float:
    scale = t ** (1.0 / alpha)
    ours = np.asarray(fp.green(_RADII * scale, t, alpha, n)) * scale**n
    exact = profile(_RADII, alpha, n)
    size = np.where(_RADII > 20.0, exact, exact[0])
    return float((np.abs(ours - exact) / size).max())


def _rate(alpha: float, n: int, t: float) -> float:
    scale = t ** (1.0 / alpha)
    ours = np.asarray(fp.green_rate(_NEAR * scale, t, alpha, n)) * scale**n * t
    return off(ours, rate(_NEAR, alpha, n))


def _flux(alpha: float, n: int, t: float) -> float:
    """Q = r G / (alpha t)."""
    scale = t ** (1.0 / alpha)
    ours = np.asarray(fp.green_flux(_NEAR * scale, t, alpha, n)) * scale ** (n - 1) * t
    return off(ours, _NEAR * profile(_NEAR, alpha, n) / alpha)


def _exponent(alpha: float, n: int, t: float) -> float:
    """From r = 1e9 to 1e10; the second term is below 1e-9."""
    scale = t ** (1.0 / alpha)
    near, far = np.asarray(fp.green(np.array([1e9, 1e10]) * scale, t, alpha, n))
    return float(abs(np.log10(near / far) - (n + alpha)))


def _constant(alpha: float, n: int, t: float) -> float:
    """The mass beyond r = 1e9 t^(1/alpha) is S_n c r^-alpha / alpha."""
    surface = {1: 2.0, 2: 2.0 * np.pi, 3: 4.0 * np.pi}[n]
    ours = float(tail_mass(1e9 * t ** (1.0 / alpha), t, alpha, n))
    return abs(ours / (surface * tail_constant(alpha, n) * 1e9**-alpha / alpha) - 1.0)


def _mass(alpha: float, n: int, t: float) -> float:
    radii = _RADII * t ** (1.0 / alpha)
    return off(central_mass(radii, t, alpha, n) + tail_mass(radii, t, alpha, n), 1.0)


_WHAT: dict[str, tuple[Callable[..., float], str, str, float]] = {
    "profile": (_profile, "t^(-n/alpha) Phi(r)", "quadrature of exp(-k^alpha), series", 5e-13),
    "rate": (_rate, "the integral of -k^alpha exp(-k^alpha)", "quadrature", 5e-13),
    "flux": (_flux, "r Phi / alpha t", "quadrature", 5e-13),
    "tail exponent": (_exponent, "-n - alpha", "series", 1e-8),
    "tail mass": (_constant, "the first term of the tail", "series", 1e-8),
    "mass": (_mass, "inside and outside are one", "", 1e-13),
}


def probes(betas: list[float], times: list[float], dims: list[int]) -> Iterator[Probe]:
    """Each against the profile at t = 1, scaled. In space t = 1e-75 makes rates of 1e280, which are numbers yet."""
    for beta, t, n, (name, what) in product(betas, times, dims, _WHAT.items()):
        function, expected, source, bound = what
        right = Kind("fundamental solution", expected, bound + _rounded(t), source, HELD)
        case = f"{name}, n = {n}, beta = {beta:g}, t = {t:.0e}"
        yield right(case, function, 1.0 + beta, n, t)
    refused = Kind("fundamental solution", "refused: above 1e308", must=REFUSED)
    for t in (1e-305, 5e-324):
        yield refused(f"peak, n = 3, beta = 0.1, t = {t:.0e}", fp.green, 0.0, t, 1.1, 3)
