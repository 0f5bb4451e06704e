"""Peers on the line: rates of u_t + (a u)_x = (D grad^beta u)_x + f, and a Runge-Kutta method of order 8.

Fourier, on a circle of length 2 L, the products at the points (Trefethen, Spectral Methods in MATLAB, 2000):

    R(u) = F^-1 [i k F(D F^-1(i k |k|^(beta-1) F u) - a u)] + f.

Fractional centred differences (Ortigueira 2006; Celik & Duman, J. Comput. Phys. 231 (2012) 1743), the flux half-way
between the points, u = 0 beyond the lattice:

    q_(i+1/2) = D_(i+1/2) h^(-beta) sum_m g_m (u_(i+1-m) - u_(i-m)) - (a u)_(i+1/2),
    R_i = (q_(i+1/2) - q_(i-1/2)) / h,

sum_m g_m e^(i m theta) = |2 sin(theta/2)|^(beta-1). With D = 1 that is -(2 sin(theta/2) / h)^alpha, of second order.

Rational functions (Christov 1982; Iserles & Webb, J. Fourier Anal. Appl. 26 (2020) 19), x = L tan(theta/2), no end:

    phi_n = (1 + i x/L)^n / (1 - i x/L)^(n+1),   (i k |k|^(p-1) u)_m = i sum_n M_mn u_n,
    M_mn = (-1)^(m+n) int_0^inf e^(-s) L_m(s) L_n(s) (s / 2 L)^p ds, by Gauss' rule for the weight s^p e^(-s), exact.

The diffusion is D div grad^beta u + D' grad^beta u there: the flux itself falls like |x|^(-alpha), which the functions
hold badly, and its derivative worse.
"""

from collections.abc import Callable
from math import gamma

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft
from scipy.integrate import solve_ivp
from scipy.special import eval_laguerre, roots_genlaguerre

from fracstudy.race.contenders.rational import RationalLine

Field = Callable[[np.ndarray], np.ndarray]
Coefficient = Field | None
Rate = Callable[[float, np.ndarray], np.ndarray]


def centred_weights(power: float, count: int) -> np.ndarray:
    """Return g_0 .. g_(count-1) of sum_m g_m e^(i m theta) = |2 sin(theta/2)|^power, power > -1.

    g_m = (-1)^m Gamma(p + 1) / (Gamma(p/2 - m + 1) Gamma(p/2 + m + 1)), by the ratio of neighbours.
    """
    half, m = 0.5 * power, np.arange(count - 1.0)
    first = gamma(power + 1.0) / gamma(half + 1.0) ** 2
    return np.asarray(first * np.cumprod(np.append(1.0, (m - half) / (m + 1.0 + half))))


def pseudo_spectral(
    alpha: float, half_width: float, spacing: float, diffusivity: Coefficient, velocity: Coefficient
) -> tuple[np.ndarray, Rate]:
    """Return the points of the circle and R(t, u) without a source."""
    n = round(half_width / spacing)
    h = half_width / n
    x = h * np.arange(-n, n)
    k = np.pi / half_width * np.arange(n + 1.0)
    derivative = 1j * k
    derivative[-1] = 0.0  # the wave of two points has no slope at them
    gradient = derivative * np.append(0.0, k[1:] ** (alpha - 2.0))
    d = None if diffusivity is None else diffusivity(x)
    a = None if velocity is None else velocity(x)
    laplacian = -(k**alpha)

    def rate(t: float, u: np.ndarray) -> np.ndarray:
        waves = rfft(u)
        total = laplacian * waves
        if d is not None:
            total = derivative * rfft(d * irfft(gradient * waves, 2 * n))
        if a is not None:
            total = total - derivative * rfft(a * u)
        return np.asarray(irfft(total, 2 * n))

    return x, rate


def differences(
    alpha: float,
    half_width: float,
    spacing: float,
    diffusivity: Coefficient,
    velocity: Coefficient,
    upwind: bool = False,
) -> tuple[np.ndarray, Rate]:
    """Return the points of the lattice and R(t, u) without a source; carried is the mean or the upwind value."""
    n = round(half_width / spacing)
    h = half_width / n
    x, middles = h * np.arange(-n, n + 1), h * (np.arange(-n - 1, n + 1) + 0.5)
    length = next_fast_len(2 * middles.size, real=True)
    weights = centred_weights(alpha - 2.0, middles.size)
    circle = np.zeros(length)
    circle[: weights.size] = weights
    circle[: -weights.size : -1] = weights[1:]
    multiplier = rfft(circle) * h ** (1.0 - alpha)
    d = 1.0 if diffusivity is None else diffusivity(middles)
    a = None if velocity is None else velocity(middles)

    def rate(t: float, u: np.ndarray) -> np.ndarray:
        wide = np.concatenate(([0.0], u, [0.0]))
        left, right = wide[:-1], wide[1:]
        flux = d * irfft(multiplier * rfft(right - left, length), length)[: middles.size]
        if a is not None:
            flux -= a * (np.where(a > 0.0, left, right) if upwind else 0.5 * (left + right))
        return np.asarray(np.diff(flux) / h)

    return x, rate


def rational(
    alpha: float, points: int, scale: float, diffusivity: Coefficient, velocity: Coefficient
) -> tuple[np.ndarray, Rate]:
    """Return the points, an even number of them on the whole line, and R(t, u) without a source; `scale` is L."""
    line = RationalLine(points, scale)
    x, waves, values = line.x, line.waves, line.values
    powers = (1.0, alpha - 1.0, alpha)
    derivative, gradient, laplacian = (_power_matrix(p, line.count, scale) for p in powers)
    d = np.ones(points) if diffusivity is None else diffusivity(x)
    a = None if velocity is None else velocity(x)

    slope = values(1j * (derivative @ waves(d - d[-1])))

    def rate(t: float, u: np.ndarray) -> np.ndarray:
        c = waves(u)
        total = slope * values(1j * (gradient @ c)) - d * values(laplacian @ c)
        if a is not None:
            total -= values(1j * (derivative @ waves(a * u)))
        return np.asarray(total)

    return x, rate


def _power_matrix(power: float, count: int, scale: float) -> np.ndarray:
    s, weights = roots_genlaguerre(count, power)
    n = np.arange(count)[:, None]
    functions = (-1.0) ** n * eval_laguerre(n, s) * np.sqrt(weights)
    return np.asarray((0.5 / scale) ** power * functions @ functions.T)


def integrated(
    rate: Rate, u: np.ndarray, times: tuple[float, float], tolerance: float
) -> np.ndarray:
    """Return u at the second time, by scipy's DOP853."""
    atol = tolerance * float(np.abs(u).max())
    run = solve_ivp(rate, times, u, method="DOP853", t_eval=times[1:], rtol=tolerance, atol=atol)
    return np.asarray(run.y[:, -1])
