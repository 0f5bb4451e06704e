"""Contests on the line: a diffusivity that varies, and a stable process that is drawn back to the origin."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from fracparticles.problems import Problem, solve_problem
from fracparticles.special import green
from fracparticles.variable.closed_forms import Gaussian
from scenes.run_times.problem_times.contest import OURS, PEER, Contender, Contest, greatest_error
from scenes.run_times.problem_times.line_peers import (
    Rate,
    differences,
    integrated,
    pseudo_spectral,
    rational,
)

__all__ = ["drawn_back", "variable_diffusivity"]

Answer = tuple[int, tuple[np.ndarray, np.ndarray]]
Function = Callable[[np.ndarray], np.ndarray]
Rates = Callable[..., tuple[np.ndarray, Rate]]

_OURS = {f"{form} {order}": (form, order) for form in ("FPSE", "DD") for order in (4, 12)}
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

    def bell(x: np.ndarray) -> np.ndarray:
        return np.exp(-x * x)

    def diffusivity(x: np.ndarray) -> np.ndarray:
        return 1.0 + 0.5 * bell(x)

    fields: dict[str, Any] = {
        "alpha": alpha,
        "diffusivity": diffusivity,
        "source": lambda x, t: source(x, t),
        "t_final": 1.0,
    }
    return _contest(
        fields, bell, lambda x: np.exp(-1.0) * bell(x), (diffusivity, None), _PEERS, source
    )


def drawn_back(alpha: float) -> Contest:
    """u_t = (x u)_x - (-Laplacian)^(alpha/2) u from t = 1 to 2, from the fundamental solution at t = 1.

    It keeps its shape: u = green(x, s), s(t) = 1 / alpha + (1 - 1 / alpha) exp(-alpha (t - 1)).
    """
    last = 1.0 / alpha + (1.0 - 1.0 / alpha) * np.exp(-alpha)
    fields = {"alpha": alpha, "velocity": "-x", "far_terms": 3, "t_initial": 1.0, "t_final": 2.0}
    peers = _PEERS | {"differences, upwind": partial(differences, upwind=True)}
    return _contest(
        fields,
        lambda x: np.asarray(green(x, 1.0, alpha)),
        lambda x: np.asarray(green(x, last, alpha)),
        (None, np.negative),
        peers,
    )


def _contest(
    fields: Mapping[str, Any],
    start: Function,
    end: Function,
    coefficients: tuple[Function | None, Function | None],
    peers: Mapping[str, Rates],
    source: Callable[[np.ndarray, float], np.ndarray] | None = None,
) -> Contest:
    """Set forms of ours, with the fields of the problem, against peers, which take diffusivity, velocity and source."""

    def ours(
        form: str, order: int, half_width: float, spacing: float, rtol: float, overlap: float = 2.0
    ) -> Answer:
        problem = Problem(
            form=form, order=order, half_width=half_width, spacing=spacing, rtol=rtol, overlap=overlap, **fields
        )  # fmt: skip
        run = solve_problem(problem, start)
        return run.x.size, (run.x.values, run.u.values)

    def peer(
        rates: Rates,
        half_width: float,
        spacing: float,
        rtol: float,
    ) -> Answer:
        x, rate = rates(fields["alpha"], half_width, spacing, *coefficients)
        full = rate if source is None else lambda t, u: rate(t, u) + source(x, t)
        times = fields.get("t_initial", 0.0), fields["t_final"]
        return x.size, (x, integrated(full, start(x), times, rtol))

    return Contest(
        greatest_error(end),
        {name: Contender(OURS, partial(ours, *which)) for name, which in _OURS.items()}
        | {name: Contender(PEER, partial(peer, rates)) for name, rates in peers.items()},
    )
