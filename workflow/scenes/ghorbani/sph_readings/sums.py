"""The SPH operators as dense sums, with the choices that the paper's text leaves open as parameters."""

from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np
from scipy.special import gamma

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.cubic_spline import spline_integral
from fracparticles.sph.derivatives import correction, gradient, second_derivative
from scenes.ghorbani.operators import SLOPES


@dataclass(frozen=True)
class Reading:
    """The choices behind the printed digits; each default is the one that gives them."""

    # The power of x_i - x_j for j > i: complex, of the absolute distance, or no term.
    ahead: Literal["complex", "absolute", "none"] = "complex"
    real: bool = False  # whether the norms take the real part only
    # Whether the gradient is divided by L, multiplied (as (18), (19) print), or left as it is.
    correction: Literal["divided", "multiplied", "none"] = "divided"
    virtual: bool = True  # whether gradients have virtual particles
    exact: bool = False  # whether f' and f'' are the analytical ones
    eta: Literal["h^2", "1/h^2"] = "h^2"  # eta of (37) is 0.0001 times this
    singular: bool = False  # whether the sums are (23), (25), (26), without their infinite term
    halved: bool = False  # whether the particles at the two ends have half volumes
    first: bool = False  # whether x = 0 is judged for the RL derivative
    # The integrand of (20): the average of f' (21), f' at the auxiliary particle, or the average of f' times the power.
    midpoint: Literal["average", "itself", "product"] = "average"
    last: bool = False  # whether a particle is beyond x_N, as the N terms of (20) ask for


def approximate(
    line: ParticleLine,
    name: str,
    operator: str,
    alpha: np.ndarray,
    modified: bool,
    reading: Reading,
) -> np.ndarray:
    """Return an operator of `FUNCTIONS[name]`, sin or cos, by dense sums; alpha is on all particles.

    With the default reading this is the function of `fracparticles.sph.operators`, written another way.
    """
    f, here = FUNCTIONS[name].value(line.x_all), line.inside
    if operator == "rl_integral":
        z, order, at_end, integrand = line.x, alpha[here], f[here][0], f[here]
        slope = _slope(line, f, name, reading)
    elif operator == "caputo":
        z, order, integrand = line.x, 1.0 - alpha[here], _slope(line, f, name, reading)
        at_end, slope = integrand[0], _curvature(line, f, reading)
    else:  # f(0) = 0 for sin, the only case
        z, order, at_end, integrand = line.x_all, 1.0 - alpha, 0.0, f[here]
        slope = _slope(line, f, name, reading)
    if reading.singular:
        inner = _integral(line, z, integrand, order - 1.0, modified, reading) / gamma(order)
    else:
        sums = _integral(line, z, slope, order, modified, reading)
        boundary = at_end * line.x**order if z.size == line.count else 0.0
        inner = (boundary + sums) / gamma(1.0 + order)
    return _slope(line, inner, None, reading) if operator == "rl_derivative" else inner


def _slope(line: ParticleLine, f: np.ndarray, name: str | None, reading: Reading) -> np.ndarray:
    """f' on the real particles; exact only for a function with a name."""
    if reading.exact and name is not None:
        return SLOPES[name](line.x)
    x, f = (line.x_all, f) if reading.virtual else (line.x, f[line.inside])
    uncorrected = gradient(line.x, x, line.spacing, f, line.smoothing, corrected=False)
    return uncorrected * _factor(line, x, reading)


def _curvature(line: ParticleLine, f: np.ndarray, reading: Reading) -> np.ndarray:
    here, h = f[line.inside], line.smoothing
    if reading.exact:
        return -(pi**2) * here
    x, f = (line.x_all, f) if reading.virtual else (line.x, here)
    eta = 1e-4 * (h * h if reading.eta == "h^2" else 1.0 / (h * h))
    uncorrected = second_derivative(line.x, here, x, line.spacing, f, h, eta, corrected=False)
    return uncorrected * _factor(line, x, reading)


def _factor(line: ParticleLine, x: np.ndarray, reading: Reading) -> np.ndarray:
    value = correction(line.x, x, line.spacing, line.smoothing)
    return value ** {"divided": -1, "multiplied": 1, "none": 0}[reading.correction]


def _integral(
    line: ParticleLine,
    z: np.ndarray,
    f: np.ndarray,
    power: np.ndarray,
    modified: bool,
    reading: Reading,
) -> np.ndarray:
    """sum_j V_j f_j (z - x_j)^p W~(z - x_j) at the points z, of f on the real particles."""
    s, h = line.spacing, line.smoothing
    if not modified:
        strengths = s * f
        if reading.halved:
            strengths[[0, -1]] *= 0.5
        distance = z[:, None] - line.x
        terms = _powers(distance, power, reading) * spline_integral(distance, h)
        return terms @ strengths
    if reading.last:  # f at x_{N+1} by continuing the last difference
        f = np.append(f, 2.0 * f[-1] - f[-2])
    x = line.a + s * np.arange(f.size)
    middle = 0.5 * (x[:-1] + x[1:])
    smoothed = spline_integral(z[:, None] - middle, h)
    if reading.midpoint == "product":
        products = _powers(z[:, None] - x, power, reading) * f
        return 0.5 * s * np.sum((products[:, :-1] + products[:, 1:]) * smoothed, axis=1)
    average = 0.5 * (f[:-1] + f[1:])
    if reading.midpoint == "itself":  # cubic interpolation
        average[1:-1] = (9.0 * (f[1:-2] + f[2:-1]) - f[:-3] - f[3:]) / 16.0
    return (_powers(z[:, None] - middle, power, reading) * smoothed) @ (s * average)


def _powers(distance: np.ndarray, power: np.ndarray, reading: Reading) -> np.ndarray:
    """distance^power, power by rows; 0 where both the distance is 0 and the power negative."""
    size = np.abs(distance)
    with np.errstate(divide="ignore"):
        values = np.where(size > 0.0, size ** power[:, None], 0.0)
    phase = np.full(power.shape, {"complex": 1.0, "absolute": 1.0, "none": 0.0}[reading.ahead] + 0j)
    if reading.ahead == "complex":
        phase *= np.exp(1j * pi * power)
    return np.where(distance < 0.0, phase[:, None], 1.0) * values
