"""The formulas of Sections 2, 3 and Appendix B, each held against quadrature of what it stands for."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from math import gamma, pi, sqrt

import numpy as np
import pandas as pd
from scipy.integrate import quad
from scipy.special import hyp1f1

from fracparticles.kernels.families import kernel
from fracparticles.special.stable import green
from fracstudy.errors import off
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import ORDERS
from scenes.lucchesi.lucchesi_figure_1 import integrals
from scenes.lucchesi.lucchesi_figure_1.integrals import from_transform, moment, printed_kernel

_RADII = np.linspace(0.1, 3.0, 30)
_DIMS = (1, 2, 3)
_KERNELS = {"kappa": "(B.11)", "F": "(B.12)", "G": "(B.13)"}  # with the equation of their transform
_CONVOLUTIONS = {"kappa": "(B.15)", "F": "(B.16)", "G": "(B.17)"}
_EPSILON = 0.5  # at which powers of epsilon are told from one another
_FAR, _SMALL = 1e5, 1e-3
_STEP = 1e-2  # of the differences of sixth order, exact to 1e-12 for functions of scale 1
_SIXTH = {1: 45.0 / 60.0, 2: -9.0 / 60.0, 3: 1.0 / 60.0}


def _slope(f: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """df/dr at the radii."""
    pairs = (c * (f(_RADII + k * _STEP) - f(_RADII - k * _STEP)) for k, c in _SIXTH.items())
    return sum(pairs) / _STEP


def formulas(betas: Sequence[float]) -> list[Finding]:
    """Measure how far each formula is from what it stands for, by dimension and beta."""

    def by_case(quantity: Callable[[int, float], float]) -> pd.Series:
        return each(lambda n, beta: quantity(n, 1.0 + beta), n=_DIMS, beta=betas)

    gradients = {
        f"order {name}, n = {n}": max(_gradient(n, 1.0 + b, order) for b in betas)
        for (order, name), n in product(ORDERS.items(), _DIMS)
    }
    return [
        measured("L-FORMULAS.4", from_4=by_case(_laplacian), from_2=by_case(_divergence)),
        measured("L-FORMULAS.5", difference=by_case(_laplacian_of_potential)),
        measured("L-FORMULAS.28", integral=by_case(_integral_of_g)),
        measured("L-FORMULAS.37", difference=each(_semigroup, beta=betas)),
        measured(
            "L-FORMULAS.33",
            printed=by_case(_limit_of_k),
            with_power=by_case(lambda n, alpha: _SMALL**-alpha * _limit_of_k(n, alpha)),
        ),
        measured("L-KERNELS.c", difference=by_case(_constant)),
        measured("L-KERNELS.gradient", difference=gradients),
        measured(
            "L-KERNELS.stretched",
            printed=by_case(lambda n, alpha: _kappa_exponent(n, alpha) + alpha - 1.0),
            intended=by_case(lambda n, alpha: _kappa_exponent(n, alpha) + n + alpha - 2.0),
        ),
        *_gaussians(),
        *_appendix([1.0 + b for b in betas]),
    ]


def _riesz_constant(alpha: float, n: int) -> float:
    """The factor of the integral of (2); that of (4) is alpha times it."""
    half = 0.5 * n
    return 2.0 ** (alpha - 1.0) * gamma(0.5 * (n + alpha)) / (pi**half * gamma(1.0 - 0.5 * alpha))


def _of_transform(alpha: float, n: int) -> float:
    """The fractional Laplacian (B.1) of exp(-|x|^2) at the origin."""
    return -(pi ** (0.5 * n)) / (2.0 * pi) ** n * moment(alpha, n, 0.25)


def _radial_integral(integrand: Callable[[float], float]) -> float:
    halves = ((0.0, 1.0), (1.0, np.inf))
    return sum(quad(integrand, *ends, epsabs=0.0, epsrel=1e-12)[0] for ends in halves)


def _laplacian(n: int, alpha: float) -> float:
    """(4) of exp(-|x|^2) at the origin against that of the transform (B.1)."""
    integral = _radial_integral(lambda r: np.expm1(-r * r) * r ** (-1.0 - alpha))
    ours = alpha * _riesz_constant(alpha, n) * integrals.sphere(n) * integral
    return abs(ours / _of_transform(alpha, n) - 1.0)


def _divergence(n: int, alpha: float) -> float:
    """-div Q of (2) with D = 1, the derivatives taken of u under the integral, against that of the transform (B.1)."""
    integral = _radial_integral(lambda r: -2.0 * r ** (1.0 - alpha) * np.exp(-r * r))
    return abs(
        _riesz_constant(alpha, n) * integrals.sphere(n) * integral / _of_transform(alpha, n) - 1.0
    )


def _laplacian_of_potential(n: int, alpha: float) -> float:
    """The Laplacian of the potential, f' + (n - 1) f / r with f the slope of (14), against G of (11)."""
    f = printed_kernel("F", _RADII, alpha, n)
    laplacian = _slope(lambda r: printed_kernel("F", r, alpha, n)) + (n - 1.0) * f / _RADII
    return off(laplacian, printed_kernel("G", _RADII, alpha, n))


def _gradient(n: int, alpha: float, order: int) -> float:
    wide = None if order == 2 else 0.5
    slope = _slope(lambda r: printed_kernel("kappa", r, alpha, n, wide))
    return off(slope, printed_kernel("F", _RADII, alpha, n, wide))


def _integral_of_g(n: int, alpha: float) -> float:
    """int G dV over the ball of radius 1e5, over int |G| dV: G = div F, and G changes sign once, where F is least."""
    r = np.linspace(0.3, 2.0, 1001)
    outflow = r ** (n - 1) * np.asarray(kernel("F", r, alpha, n))
    return _FAR ** (n - 1) * float(kernel("F", _FAR, alpha, n)) / (2.0 * outflow.min())


def _semigroup(beta: float) -> float:
    """The convolution of (37) at x = 0 against the solution there, t = 0.5 and Delta t = 1."""
    u = partial(green, alpha=1.0 + beta)
    integral = _radial_integral(lambda y: 2.0 * float(u(y, 0.5)) * float(u(y, 1.0)))
    return abs(integral / float(u(0.0, 1.5)) - 1.0)


def _constant(n: int, alpha: float) -> float:
    """How far c / alpha is from 1, c that makes c K(r) r^(n + alpha) the constant of (4) far out."""
    tail = float(kernel("K", _FAR, alpha, n)) * _FAR ** (n + alpha)
    return abs(_riesz_constant(alpha, n) / tail - 1.0)


def _limit_of_k(n: int, alpha: float) -> float:
    """The left side of (33) over the right one at |y - x| = 1 and a small epsilon."""
    k = alpha * _SMALL**-n * float(kernel("K", 1.0 / _SMALL, alpha, n))
    return k / (alpha * _riesz_constant(alpha, n))


def _kappa_exponent(n: int, alpha: float) -> float:
    """The exponent of the tail of kappa; as printed it is that of |r|^-beta, as meant 1 - n - beta."""
    near, far = np.asarray(kernel("kappa", np.array([_FAR, 10.0 * _FAR]), alpha, n))
    return float(np.log10(far / near))


# --- the Gaussians, and Appendix B ----------------------------------------------------------------


def _at_origin(name: str, n: int, epsilon: float) -> float:
    """What a kernel makes of a Gaussian field, at the origin, over the exact value.

    (6) of exp(-|x|^2) with eta of (8) or (9); and the divergence of x exp(-|x|^2), which is n, with eta^1 of (23), of
    (24), or of (24) with n + 4 for 5, in the integral of (22).
    """
    a, unit = 1.0 + epsilon**2, pi ** (-0.5 * n)
    narrow = unit * moment(0.0, n, a)
    if name == "(8)":
        return narrow
    if name == "(9)":
        return 2.0 * narrow - (2.0 * pi) ** (-0.5 * n) * moment(0.0, n, a - 0.5)
    second = unit * moment(2.0, n, a)
    if name == "(23)":
        return 2.0 * second / n
    constant = 5.0 if name == "(24)" else n + 4.0
    return (constant * second - 2.0 * unit * moment(4.0, n, a)) / n


def _observed(name: str, order: float) -> pd.Series:
    """How far the order of `_at_origin` in epsilon is from that of the paper, by dimension."""

    def away(n: int) -> float:
        coarse, fine = (abs(_at_origin(name, n, epsilon) - 1.0) for epsilon in (0.1, 0.05))
        return abs(np.log2(coarse / fine) - order)

    return each(away, n=_DIMS)


def _gaussians() -> Iterator[Finding]:
    """Mass and order of eta, the order of eta^1, and Phi."""

    def eta(r: np.ndarray, n: int) -> np.ndarray:
        return np.exp(-r * r) / pi ** (0.5 * n)

    def phi(n: int) -> float:
        return off(-_slope(partial(eta, n=n)) / _RADII, 2.0 * eta(_RADII, n))

    def of_order_iv(n: int) -> float:
        ours = 2.0 * eta(_RADII, n) - 2.0 ** (-0.5 * n) * eta(_RADII / sqrt(2.0), n)
        return off(ours, np.asarray(kernel("eta", _RADII, 1.5, n, 4)))

    pairs = product(("(8)", "(9)"), _DIMS)
    mass = {f"{name}, n = {n}": abs(_at_origin(name, n, 0.0) - 1.0) for name, n in pairs}
    yield measured("L-KERNELS.unit_mass", difference=mass)
    yield measured("L-KERNELS.eta_second_order", difference=_observed("(8)", 2.0))
    yield measured("L-KERNELS.eta_fourth_order", difference=_observed("(9)", 4.0))
    yield measured("L-FORMULAS.23", difference=_observed("(23)", 2.0))
    fourth = {"difference": _observed("(24)", 4.0), "intended": _observed("n + 4", 4.0)}
    yield measured("L-FORMULAS.24", **fourth)
    yield measured("L-FORMULAS.17", difference=each(phi, n=_DIMS))
    yield measured("L-FORMULAS.9", difference=each(of_order_iv, n=_DIMS))


def _appendix(alphas: Sequence[float]) -> Iterator[Finding]:
    """(B.5), (B.6), the kernels against their transforms, and the powers of epsilon that go with them."""

    def worst(name: str, order: int, wide: float | None = None) -> float:
        """Of a printed kernel from the inverse transform, the worst over n and beta."""
        return max(
            off(printed_kernel(name, _RADII, *of, wide), from_transform(name, _RADII, *of, order))
            for of in product(alphas, _DIMS)
        )

    two = {"(14)": "kappa", "(20)": "F", "(11)": "G"}
    four = {"15": "kappa", "21": "F", "12": "G"}
    yield measured("L-FORMULAS.B5", difference=each(partial(_general, slope=False), n=_DIMS))
    yield measured("L-FORMULAS.B6", difference=each(partial(_general, slope=True), n=_DIMS))
    inverse = {name: worst(kind, 2) for name, kind in two.items()}
    yield measured("L-FORMULAS.inverse", difference=inverse)
    meant = {name: worst(kind, 4, 0.5) for name, kind in four.items()}
    for name, difference in meant.items():
        yield measured(f"L-FORMULAS.{name}", difference=difference)
    yield measured(
        "L-FORMULAS.B18",
        difference={f"({name})": worst(kind, 4, sqrt(0.5)) for name, kind in four.items()},
        intended={f"({name})": difference for name, difference in meant.items()},
    )
    middle = alphas[len(alphas) // 2]
    yield _powers("L-FORMULAS.B11_B13", _KERNELS, middle)
    yield _powers("L-FORMULAS.B15_B17", _CONVOLUTIONS, middle)


def _general(n: int, slope: bool) -> float:
    """The right side of (B.5), or of (B.6), against quadrature of the left one."""
    mu, a, b = 0.5, 0.7, 1.3
    top, below = 0.5 * (mu + n) + slope, 0.5 * n + slope
    value = pi ** (0.5 * n) * a**-top * gamma(top) / gamma(below)
    value = value * hyp1f1(top, below, -((b * _RADII) ** 2) / (4.0 * a))
    # int y |y|^mu exp(-a |y|^2 + i b x.y) dV = -i times the gradient of the integral without y; 2! is a factor below.
    value = -0.5 * b * _RADII * value if slope else value
    return off(value, integrals.gaussian_integral(mu, b * _RADII, n, a, slope))


def _powers(claim: str, equations: Mapping[str, str], alpha: float) -> Finding:
    """The kernel of width epsilon times epsilon^-n, over what it stands for; its difference with the right power."""
    right = {"kappa": 2.0 - alpha, "F": 1.0 - alpha, "G": -alpha}
    printed, intended = {}, {}
    for (name, equation), n in product(equations.items(), _DIMS):
        x, case = np.array([_EPSILON]), f"{equation}, n = {n}"
        exact = from_transform(name, x, alpha, n, epsilon=_EPSILON)
        scaled = _EPSILON**-n * printed_kernel(name, x / _EPSILON, alpha, n)
        printed[case] = float((_EPSILON**-n * scaled / exact)[0])
        intended[case] = off(_EPSILON ** right[name] * scaled, exact)
    return measured(claim, printed=printed, intended=intended)
