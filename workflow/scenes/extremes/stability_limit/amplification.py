"""Amplification per step, measured from random strengths, against the spectral radius of the step polynomial."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.schemes.stability import stability_limit
from fracparticles.time import STEP_POLYNOMIALS, step
from fracstudy.probe import HELD, Kind, Probe

_STEPS, _LAST = 600, 50  # 1.5^600 does not overflow yet
# Modes next to the greatest decay like 1 / n in the norm: 50 of 600 steps tell the factor to some 1e-3.
_BOUND = 5e-3
_BETA = 0.5


def measured(
    half: int, overlaps: list[float], orders: list[int], factors: list[float]
) -> pd.DataFrame:
    """Return the growth per step of each setting and step, and the spectral radius of p(A dt), from the matrix."""
    rows = []
    for scheme, integrator, setting in _settings(half, overlaps, orders):
        # The table moves the eigenvalues, not the limit of the exact kernels: that is what a user compares dt with.
        of = (setting.order, setting.overlap, setting.dim, setting.family)
        limit = stability_limit(scheme, _BETA, *of)
        if limit == 0.0:
            continue
        p = STEP_POLYNOMIALS[integrator]
        operator = SCHEMES[scheme].operator(setting)
        eigenvalues = np.linalg.eigvals(dense_matrix(operator))
        start = np.random.default_rng(0).standard_normal(operator.size)
        for factor in factors:
            dt = factor * limit * 0.5 * p.stability_interval
            u = step(operator, p, dt, _STEPS - _LAST, start)
            v = step(operator, p, dt, _LAST, u)
            growth = (np.linalg.norm(v) / np.linalg.norm(u)) ** (1.0 / _LAST)
            z, value = eigenvalues * dt, np.ones_like(eigenvalues)
            for k in range(p.stages, 0, -1):  # of open operators the eigenvalues may be a pair
                value = 1.0 + z / k * value
            radius = float(np.abs(value).max())
            rows.append((scheme, integrator, setting, factor, growth, radius))
    columns = ["scheme", "integrator", "setting", "factor", "measured", "predicted"]
    return pd.DataFrame(rows, columns=columns)


def _settings(
    half: int, overlaps: list[float], orders: list[int]
) -> Iterator[tuple[str, str, Setting]]:
    """Orders and overlaps, exteriors, integrators, dimensions, tables: each changed from the one of the paper."""
    line: dict[str, Any] = {"alpha": 1.0 + _BETA, "n": half}
    for scheme in ("DD", "FPSE", "KPSE"):
        for exterior in ("truncated", "open"):
            for order in orders:
                yield scheme, "rk2", Setting(**line, order=order, exterior=exterior)
            for overlap in overlaps:
                yield scheme, "rk2", Setting(**line, overlap=overlap, exterior=exterior)
            yield scheme, "rk2", Setting(**line, kernel_table=0.1, exterior=exterior)
        for integrator in ("euler", "rk4"):
            yield scheme, integrator, Setting(**line)
        if half >= 20:
            yield scheme, "rk2", Setting(alpha=1.0 + _BETA, n=half // 8, dim=2)
            yield scheme, "rk2", Setting(alpha=1.0 + _BETA, n=half // 20, dim=3)
    for scheme in ("DPSE", "FD"):
        yield scheme, "rk2", Setting(**line)


def probes(measured: pd.DataFrame) -> Iterator[Probe]:
    """One probe a setting and step: |v| / |u| over fifty steps, v = p(A dt)^50 u, is the radius to the power of 50."""
    for row in measured.itertuples():
        right = Kind("growth per step", f"{row.predicted:.2f}", _BOUND, "dense matrix", HELD)
        s = row.setting
        name = f"{row.scheme}, order {s.order}, s = {s.overlap:g}"
        name += (f", n = {s.dim}" if s.dim > 1 else "") + (", open" if s.is_open else "")
        name += "" if s.kernel_table is None else ", table"
        yield right(
            f"{name}, {row.integrator}, dt = {row.factor:g} a",
            lambda: (abs(row.measured - row.predicted), f"{row.measured:.2f}"),
        )
