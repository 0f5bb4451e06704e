"""Stiff problems and matrices that are not normal."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.linalg import expm

from fracparticles.schemes import Setting
from scenes.beyond.stiff_extreme.checks import (
    SAME,
    SCHEMES_SHOWN,
    Base,
    Check,
    computed,
    matrix_of,
    stable_step,
)

__all__ = ["CHECKS"]


def _stiff_exponential(base: Base) -> Iterator[Check]:
    """A lattice on which RK2 needs a million steps: the series of exp(A T) against the modes of A."""
    fields = {"beta": 0.9, "half_width": 0.2, "spacing": 1e-3, "integrator": "exponential"}
    for scheme in SCHEMES_SHOWN:
        span = 1e6 * stable_step(scheme, **{**fields, "integrator": "rk2"})
        run = computed(_rough, scheme=scheme, **fields, t_final=0.5 + span)
        values, modes = np.linalg.eig(matrix_of(run.case.setting, scheme))
        exact = (modes @ (np.exp(values * span) * np.linalg.solve(modes, run.u0))).real
        difference = float(np.abs(run.u - exact).max() / np.abs(run.u0).max())
        yield (
            f"{scheme}, beta = 0.9, h = 10^-3, T = 10^6 steps of RK2 at its limit",
            f"exp(A T) from the {values.size} modes, 0 <= |u| <= {np.abs(exact).max():.3g}",
            f"difference {difference:.1e}, {run.operator_applications} operator applications",
            # eps |A| T = 4e-10, times the condition of FPSE's modes, some hundred
            difference < 1e-7,
        )


def _rough(x: np.ndarray) -> np.ndarray:
    return np.random.default_rng(2).uniform(0.0, 1.0, x.size)


def _transient_growth(base: Base) -> Iterator[Check]:
    """|exp(A t)| in the Euclidean norm: at most 1 for symmetric A; for FPSE at most the condition of its modes."""
    times = np.geomspace(0.01, 1e6, 60)
    for scheme in SCHEMES_SHOWN:
        matrix = matrix_of(Setting(n=50, spacing=1.0, alpha=1.0 + base["beta"]), scheme)
        values, modes = np.linalg.eig(matrix)
        greatest, condition = float(values.real.max()), float(np.linalg.cond(modes))
        most = max(float(np.linalg.norm(expm(t * matrix), 2)) for t in times)
        if scheme == "FPSE":
            bound = f"above 1, at most {condition:.0f}, the condition of the modes"
            holds = 1.0 + SAME < most <= condition
        else:
            bound, holds = "at most 1", most <= 1.0 + SAME
        yield (
            f"{scheme}, 101 particles, t D up to 10^6 h^alpha",
            f"no eigenvalue above zero; |exp(A t)| {bound}",
            f"greatest eigenvalue {greatest:.0e}, |exp(A t)| at most {most:.6g}",
            greatest < SAME and holds,
        )


CHECKS: dict[str, Callable[[Base], Iterator[Check]]] = {
    "stiff": _stiff_exponential,
    "transient growth": _transient_growth,
}
