"""Contests on the line: a diffusivity that varies, and a stable process that is drawn back to the origin."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

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

_OURS = {f"{form} {order}": (form, order) for form in ("FPSE", "DD") for order in (4, 12)}


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

    def ours(
        form: str, order: int, half_width: float, spacing: float, rtol: float, overlap: float = 2.0
    ) -> Answer:
        problem = Problem(
            alpha=alpha, form=form, order=order, half_width=half_width, spacing=spacing, rtol=rtol, overlap=overlap,
            diffusivity=diffusivity, source=lambda x, t: source(x, t), t_final=1.0,
        )  # fmt: skip
        run = solve_problem(problem, bell)
        return run.x.size, (run.x.values, run.u.values)

    def peer(
        rates: Callable[..., tuple[np.ndarray, Rate]],
        half_width: float,
        spacing: float,
        rtol: float,
    ) -> Answer:
        x, rate = rates(alpha, half_width, spacing, diffusivity, None)
        return _run(x, lambda t, u: rate(t, u) + source(x, t), bell, (0.0, 1.0), rtol)

    return Contest(
        greatest_error(lambda x: np.exp(-1.0) * bell(x)),
        {
            **{name: Contender(OURS, partial(ours, *which)) for name, which in _OURS.items()},
            "Fourier, circle": Contender(PEER, partial(peer, pseudo_spectral)),
            "rational functions": Contender(PEER, partial(peer, rational)),
            "differences": Contender(PEER, partial(peer, differences)),
        },
    )


def drawn_back(alpha: float) -> Contest:
    """u_t = (x u)_x - (-Laplacian)^(alpha/2) u from t = 1 to 2, from the fundamental solution at t = 1.

    It keeps its shape: u = green(x, s), s(t) = 1 / alpha + (1 - 1 / alpha) exp(-alpha (t - 1)).
    """
    last = 1.0 / alpha + (1.0 - 1.0 / alpha) * np.exp(-alpha)

    def start(x: np.ndarray) -> np.ndarray:
        return np.asarray(green(x, 1.0, alpha))

    def ours(
        form: str, order: int, half_width: float, spacing: float, rtol: float, overlap: float = 2.0
    ) -> Answer:
        problem = Problem(
            alpha=alpha, form=form, order=order, half_width=half_width, spacing=spacing, rtol=rtol, overlap=overlap,
            velocity="-x", far_terms=3, t_initial=1.0, t_final=2.0,
        )  # fmt: skip
        run = solve_problem(problem, start)
        return run.x.size, (run.x.values, run.u.values)

    def peer(
        rates: Callable[..., tuple[np.ndarray, Rate]],
        half_width: float,
        spacing: float,
        rtol: float,
    ) -> Answer:
        x, rate = rates(alpha, half_width, spacing, None, np.negative)
        return _run(x, rate, start, (1.0, 2.0), rtol)

    return Contest(
        greatest_error(lambda x: np.asarray(green(x, last, alpha))),
        {
            **{name: Contender(OURS, partial(ours, *which)) for name, which in _OURS.items()},
            "Fourier, circle": Contender(PEER, partial(peer, pseudo_spectral)),
            "rational functions": Contender(PEER, partial(peer, rational)),
            "differences": Contender(PEER, partial(peer, differences)),
            "differences, upwind": Contender(
                PEER, partial(peer, partial(differences, upwind=True))
            ),
        },
    )


def _run(
    x: np.ndarray,
    rate: Rate,
    start: Callable[[np.ndarray], np.ndarray],
    times: tuple[float, float],
    rtol: float,
) -> Answer:
    return x.size, (x, integrated(rate, start(x), times, rtol))
