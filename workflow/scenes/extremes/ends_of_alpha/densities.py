"""Probes of the fundamental solution and what is derived from it."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import mpmath as mp

from fracparticles import special
from fracstudy.probe import HELD, Kind, Probe
from scenes.extremes.ends_of_alpha import references
from scenes.extremes.ends_of_alpha.references import distance, relative, written

_FAR = 1e6
# Documented: 1e-13, 1e-12 for what has a derivative.
_BOUNDS = {"slope": 1e-12, "rate": 1e-12}


def _exact(name: str, n: int, alpha: float, r: float) -> tuple[mp.mpf, mp.mpf]:
    """The value at t = 1, and what its error is relative to: of the rate, which has a zero, the parts."""
    value = references.density(n, alpha, r)
    if name == "density":
        return value, value
    if name == "flux":
        return r * value / mp.mpf(alpha), value
    if name in ("central mass", "tail mass"):
        inside = references.mass_inside(n, alpha, r)
        return (inside, inside) if name == "central mass" else (1 - inside, 1 - inside)
    slope = -2 * mp.pi * r * references.density(n + 2, alpha, r)  # Phi_n' = -2 pi r Phi_(n+2)
    if name == "slope":
        return slope, abs(slope)
    return -(n * value + r * slope) / mp.mpf(alpha), n * value / mp.mpf(alpha)


FUNCTIONS = {
    "density": special.green,
    "slope": special.green_slope,
    "flux": special.green_flux,
    "rate": special.green_rate,
    "central mass": special.central_mass,
    "tail mass": special.tail_mass,
}


def errors(name: str, n: int, alpha: float, radii: list[float]) -> float:
    """Return the greatest relative error of a function at some radii, t = 1."""
    parts = [(FUNCTIONS[name](r, 1.0, alpha, n), *_exact(name, n, alpha, r)) for r in radii]
    return max(float(abs(found - value) / abs(size)) for found, value, size in parts)


def probes(betas: list[float], radii: list[float], dims: list[int]) -> Iterator[Probe]:
    """Each function in each dimension; the far tail at r = 10^6; the numbers that belong to alpha.

    The second correction of the limits leaves some 100 distance^3, below round-off; far out it is the series.
    """
    for beta in betas:
        alpha = 1.0 + beta
        exact = distance(beta) > 1e-4  # the quadrature costs a second a value: one radius
        expected = "the Fourier integral" if exact else "limit and corrections"
        right = Kind("density", expected, source=references.source_of(alpha), must=HELD)
        at = [1.1] if exact else radii
        for name, n in product(FUNCTIONS, dims):
            bound = _BOUNDS.get(name, 1e-13)
            words = f"{name}, n = {n}, {written(beta)}"
            yield right(words, errors, name, n, alpha, at, bound=bound)
        yield from _far(beta, dims)
        yield from _numbers(beta)


def _far(beta: float, dims: list[int]) -> Iterator[Probe]:
    alpha = 1.0 + beta
    right = Kind("far tail", "three terms of the far series", 1e-13, "series, mpmath", HELD)
    functions = {
        "density": (special.green, references.tail_density),
        "tail mass": (special.tail_mass, references.tail_mass),
    }
    for n, (name, (function, series)) in product(dims, functions.items()):
        yield right(
            f"{name}, n = {n}, r = 1e6, {written(beta)}",
            lambda: relative(function(_FAR, 1.0, alpha, n), series(n, alpha, _FAR)),
        )


def _numbers(beta: float) -> Iterator[Probe]:
    """R_alpha (A.3) = (2/pi) Gamma(1 - 1/alpha), the constant of the tail, and Phi_n(0)."""
    alpha = 1.0 + beta
    with mp.workdps(40):
        a = mp.mpf(alpha)
        cases: dict[str, Any] = {
            "mean radius": (special.mean_radius, 2 / mp.pi * mp.gamma(1 - 1 / a)),
            "tail constant": (
                special.tail_constant,
                mp.gamma(1 + a) * mp.sin(mp.pi * a / 2) / mp.pi,
            ),
            "peak": (lambda alpha: special.green(0.0, 1.0, alpha), mp.gamma(1 + 1 / a) / mp.pi),
        }
    right = Kind("number", "its closed form", 1e-14, "closed form, mpmath", HELD)
    for name, (function, exact) in cases.items():
        yield right(f"{name}, {written(beta)}", lambda: relative(function(alpha), exact))
