"""What holds of operators that vary in space, of intervals, and of particles that follow the solution."""

# ruff: noqa: B008  an argument of a property is drawn from its default

import math
from typing import Any

import numpy as np
from hypothesis import strategies as st
from scipy.special import eval_jacobi, gamma

import fracparticles as fp
from fracparticles.adaptive.follow import follow
from fracparticles.bounded.interval import Interval
from fracparticles.schemes.setting import Setting
from fracparticles.variable import FORMS, VariableDiffusivity, VariableOrder
from fracstudy.probe import HELD
from scenes.extremes.fuzzing.harness import always
from scenes.extremes.fuzzing.strategies import among, between

_FORMS = st.sampled_from(tuple(FORMS))
_ALPHAS = st.one_of(between(1.05, 1.95), among(1.01, 1.99))
_SEEDS = st.integers(0, 10**6)
_DEGREES = among(1.0, 2.0, 4.0, 8.0)


# --- operators whose coefficients vary -------------------------------------------------------------------


def _kernel(name: str, z: np.ndarray, s: Setting) -> np.ndarray:
    return np.asarray(fp.kernel(name, z / (s.overlap * s.spacing), s.alpha, 1, s.order))


@always("variable diffusivity", "the sums one by one", "naive sums", 2)
def _diffusivity(
    form=_FORMS,
    alpha=between(1.05, 1.95),
    n=st.integers(4, 20),
    order=among(2, 4),
    size=among(1.0, 1e-12, 1e12),
):
    """The sums of the three forms, one by one, on a truncated lattice."""
    s = Setting(alpha=alpha, n=n, spacing=0.25, order=order, overlap=2.0)
    operator, h, e = VariableDiffusivity(form, s), 0.25, 0.5
    (points,) = operator.points
    x = h * np.arange(-n, n + 1.0)
    d = lambda x: size * (1.0 + 0.8 * np.tanh(x) + 0.1 * np.cos(3.0 * x))
    u, z = np.exp(-((x - 0.4) ** 2)), x[:, None] - x
    flux = -h / e**alpha * _kernel("F", z, s) @ u  # grad^beta u is minus this
    if form == "FPSE":
        q, pairs = d(x) * flux, _kernel("eta1", z, s)
        exact = -h / e**2 * (pairs @ q + q * pairs.sum(axis=1))
    elif form == "exchange":
        pairs = 0.5 * (d(x)[:, None] + d(x)) * (u - u[:, None]) * _kernel("K", z, s)
        exact = alpha * h / e ** (1.0 + alpha) * pairs.sum(axis=1)
    else:
        m = {2: (0.5,), 4: (2.0 / 3.0, -1.0 / 12.0)}[order]
        slope = sum(c * (d(x + k * h) - d(x - k * h)) / h for k, c in enumerate(m, 1))
        exact = h / e ** (1.0 + alpha) * d(x) * (_kernel("G", z, s) @ u) - slope * flux
    found = operator.apply(u, d(points))
    return float(np.abs(found - exact).max()) / (1e-9 * size * (h**-alpha))


@always("variable order", "each row's own sum", "naive sums", must=HELD)
def _order(
    low=between(1.02, 1.5), high=between(1.5, 1.98), n=st.integers(4, 12), order=among(2, 4)
):
    """Each row is that of a constant order, by its own sum."""
    s = Setting(alpha=1.5, n=n, spacing=0.25, order=order, overlap=2.0)
    x = 0.25 * np.arange(-n, n + 1.0)
    alpha = 0.5 * (low + high) + 0.5 * (high - low) * np.tanh(x)
    u = np.exp(-((x - 0.4) ** 2))
    exact = [
        0.25 / 0.5 ** (1.0 + a) * fp.kernel("G", (at - x) / 0.5, a, 1, order) @ u
        for at, a in zip(x.tolist(), alpha.tolist(), strict=True)
    ]
    return float(np.abs(VariableOrder(s, alpha).apply(u) - exact).max()) / (1e-9 * 0.25**-high)


# --- intervals --------------------------------------------------------------------------------------------


@always("an interval, stationary", "Jacobi polynomials, to 1e-3", "closed form", 2, HELD)
def _jacobi(
    alpha=_ALPHAS,
    particles=st.integers(60, 150),
    middle=among(0.0, 3.0, -2e3),
    half=among(1.0, 0.25, 2.0**10),
    seed=_SEEDS,
):
    """(1 - x^2)^(alpha/2) P_n, of which the operator makes -Gamma(alpha + n + 1) / n! P_n (Dyda et al. 2017)."""
    shares, s = np.random.default_rng(seed).uniform(-1.0, 1.0, 5), 0.5 * alpha
    line = Interval(alpha=alpha, particles=particles, ends=(middle - half, middle + half))

    def polynomials(x: np.ndarray, weights: Any) -> np.ndarray:
        y = np.clip((x - middle) / half, -1.0, 1.0)
        terms = enumerate(zip(shares, weights, strict=True))
        return np.asarray(sum(c * w * eval_jacobi(n, s, s, y) for n, (c, w) in terms))

    rates = [gamma(alpha + n + 1.0) / math.factorial(n) for n in range(5)]
    found = line.stationary(lambda x: half**-alpha * polynomials(x, rates))
    y = np.clip((line.x - middle) / half, -1.0, 1.0)
    exact = (1.0 - y * y) ** s * polynomials(line.x, np.ones(5))
    return float(np.abs(found - exact).max()) / (1e-3 * float(np.abs(shares).sum()))


@always("an interval, its run", "in parts, units and total the same")
def _interval(
    exterior=among("absorbing", "reflecting", "given"),
    alpha=between(1.05, 1.95),
    degree=_DEGREES,
    time=between(0.05, 2.0),
    w=between(0.5, 8.0),
):
    """In two parts, and in other units, it is the same; where nothing crosses the ends the total gains the source."""

    def after(time, start=None, since=0.0, unit=1.0):
        """An interval with a source and perhaps values outside, that vary in time, and u; lengths in a unit."""
        line = Interval(
            alpha=alpha, particles=60, exterior=exterior, degree=degree, ends=(-unit, unit),
            diffusivity=unit**alpha,
        )  # fmt: skip
        bell = lambda x: np.exp(-((x / unit) ** 2))
        source = lambda x, t: np.exp(-2.0 * (x / unit - 0.2) ** 2) * np.sin(w * (t + since))
        far = lambda y, t: np.cos(w * (t + since)) / (1.0 + (y / unit) ** 2)
        outside = far if exterior == "given" else None
        data = bell if start is None else start
        return line, line.evolve(data, time, source=source, outside=outside)

    line, u = after(time)
    _, half = after(0.4 * time)
    _, parts = after(0.6 * time, half, 0.4 * time)
    _, scaled = after(time, unit=2.0**20)
    apart = max(float(np.abs(u - other).max()) for other in (parts, scaled))
    apart = apart / (1e-7 * float(np.abs(u).max()))
    if exterior != "reflecting":
        return apart
    before = float(line.volumes @ np.exp(-(line.x**2)))
    source = float(line.volumes @ np.exp(-2.0 * (line.x - 0.2) ** 2))
    gained = source * (1.0 - math.cos(w * time)) / w
    lost = abs(float(line.volumes @ u) - before - gained)
    return max(apart, lost / (1e-8 * (before + abs(gained))))


@always("an interval, a constant", "it stays", "closed form", must=HELD)
def _constant(
    alpha=_ALPHAS, degree=_DEGREES, time=between(1e-3, 10.0), value=among(1.0, -3.0, 1e-200, 1e200)
):
    """A constant inside and outside stays."""
    line = Interval(alpha=alpha, particles=40, exterior="given", degree=degree)
    return float(np.abs(line.evolve(value, time, outside=value) / value - 1.0).max()) / 1e-9


# --- particles that follow -----------------------------------------------------------------------------------


@always("particles that follow", "the sum of two, or a warning", "closed form")
def _followed(
    alpha=between(1.05, 1.95),
    narrow=among(0.03, 0.3, 2.0),
    place=between(-6.0, 6.0),
    share=among(1.0, 0.1, -0.5),
    time=among(1e-3, 0.1, 3.0),
):
    """Two fundamental solutions of other widths: to a thousandth of int |u|, or a warning."""

    def exact(x: np.ndarray, t: float) -> np.ndarray:
        other = fp.green(x - place, t + narrow**alpha, alpha)
        return np.asarray(fp.green(x, t + 1.0, alpha) + share * other)

    (found,) = follow(
        lambda x: exact(x, 0.0), time, alpha=alpha, window=(-10.0, 10.0), where=(place,)
    )
    v, e = found.particles.volumes, exact(found.particles.x, time)
    return float(v @ np.abs(found.u - e) / (v @ np.abs(e))) / 1e-3


# --- all ------------------------------------------------------------------------------------------------------
