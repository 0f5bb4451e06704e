"""Contests on the line: a diffusivity that varies, and a stable process that is drawn back to the origin."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from fracparticles.special import green
from fracparticles.variable.closed_forms import Gaussian
from scenes.run_times.problem_times.contest import Contest, Points, greatest_error, on_lattices
from scenes.run_times.problem_times.line_peers import (
    Field,
    Rate,
    differences,
    integrated,
    pseudo_spectral,
    rational,
)

Rates = Callable[..., tuple[np.ndarray, Rate]]

_PEERS: dict[str, Rates] = {
    "Fourier, circle": pseudo_spectral,
    "rational functions": rational,
    "differences": differences,
}


class _Source:
    """f of u = exp(-t - x^2) and D = 1 + exp(-x^2) / 2; what depends on x is kept for each lattice, for all alike."""

    def __init__(self, alpha: float) -> None:
        self._alpha = alpha
        self._kept: dict[tuple[int, float], np.ndarray] = {}

    def __call__(self, x: np.ndarray, t: float | np.ndarray) -> np.ndarray:
        key = x.size, float(x.flat[0])
        if key not in self._kept:
            bell = Gaussian.value([x])
            spread = Gaussian.flux_divergence([x], self._alpha, 1.0 + 0.5 * bell, [-x * bell])
            self._kept[key] = -(bell + spread)
        return np.asarray(np.exp(-t) * self._kept[key])


def variable_diffusivity(alpha: float) -> Contest:
    """u_t = (D grad^beta u)_x + f to t = 1, D = 1 + exp(-x^2) / 2, u = exp(-t - x^2)."""
    source = _Source(alpha)
    bell = lambda x: np.exp(-x * x)
    diffusivity = lambda x: 1.0 + 0.5 * bell(x)
    fields: dict[str, Any] = {"alpha": alpha, "t_final": 1.0, "diffusivity": diffusivity}
    # By its signature a source says of what it is a function.
    fields["source"] = lambda x, t: source(x, t)
    peers = _peers(_PEERS, fields, bell, (diffusivity, None), source)
    error = greatest_error(lambda x: np.exp(-1.0) * bell(x))
    return Contest(error, on_lattices(["FPSE", "DD"], bell, **fields), peers)


def drawn_back(alpha: float) -> Contest:
    """u_t = (x u)_x - (-Laplacian)^(alpha/2) u from t = 1 to 2, from the fundamental solution at t = 1.

    It keeps its shape: u = green(x, s), s(t) = 1 / alpha + (1 - 1 / alpha) exp(-alpha (t - 1)).
    """
    last = 1.0 / alpha + (1.0 - 1.0 / alpha) * np.exp(-alpha)

    def stable(age: float) -> Field:
        return lambda x: np.asarray(green(x, age, alpha))

    fields: dict[str, Any] = {"alpha": alpha, "velocity": "-x", "far_terms": 3}
    fields |= {"t_initial": 1.0, "t_final": 2.0}
    every = _PEERS | {"differences, upwind": partial(differences, upwind=True)}
    peers = _peers(every, fields, stable(1.0), (None, np.negative))
    ours = on_lattices(["FPSE", "DD"], stable(1.0), **fields)
    return Contest(greatest_error(stable(last)), ours, peers)


def _peers(
    every: Mapping[str, Rates],
    fields: Mapping[str, Any],
    start: Field,
    coefficients: tuple[Field | None, Field | None],
    source: Callable[[np.ndarray, float], np.ndarray] | None = None,
) -> dict[str, Callable[..., tuple[int, Points]]]:
    """Who solves with these rates, of diffusivity, velocity and source."""

    def solve(rates: Rates, half_width: float, spacing: float, rtol: float) -> tuple[int, Points]:
        x, rate = rates(fields["alpha"], half_width, spacing, *coefficients)
        full = rate if source is None else lambda t, u: rate(t, u) + source(x, t)
        times = fields.get("t_initial", 0.0), fields["t_final"]
        return x.size, (x, integrated(full, start(x), times, rtol))

    return {name: partial(solve, rates) for name, rates in every.items()}
