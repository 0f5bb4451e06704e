"""What acts on particles beside a constant diffusion, with exact solutions: on blobs of widths 0.01 and 1, 50 apart.

- velocity -x: stable densities, the time (1 - exp(-alpha t)) / alpha older and exp(-t) times as wide;
- a source, f = -u + 10 u (exp(-t) B - u): exp(-t) B, B the blobs without it;
- a diffusivity D = 1 + 1 / (2 (1 + x^2)), by the exchange, and a source that lets 1 / (1 + x^2) stay.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles.special import green
from fracparticles.variable.closed_forms import Cauchy, exchange_limit

__all__ = ["ACTS", "Exact"]

Exact = Callable[[np.ndarray, float], np.ndarray]
Act = Callable[[float], tuple[Exact, dict[str, Any]]]

_NARROW, _DISTANCE = 0.01, 50.0
_WINDOW = {"window": (-0.4 * _DISTANCE, 1.6 * _DISTANCE)}


def _drawn_together(alpha: float) -> tuple[Exact, dict[str, Any]]:
    def exact(x: np.ndarray, t: float) -> np.ndarray:
        past, shrunk = -np.expm1(-alpha * t) / alpha, np.exp(-alpha * t)
        wide = green(x - _DISTANCE * np.exp(-t), shrunk + past, alpha)
        return np.asarray(0.5 * green(x, _NARROW**alpha * shrunk + past, alpha) + 0.5 * wide)

    return exact, {**_WINDOW, "velocity": lambda x, t: -x}


def _competing(alpha: float) -> tuple[Exact, dict[str, Any]]:
    def exact(x: np.ndarray, t: float) -> np.ndarray:
        both = green(x, _NARROW**alpha + t, alpha) + green(x - _DISTANCE, 1.0 + t, alpha)
        return np.asarray(0.5 * np.exp(-t) * both)

    return exact, {**_WINDOW, "source": lambda x, t, u: u * (10.0 * (exact(x, t) - u) - 1.0)}


def _varying(alpha: float) -> tuple[Exact, dict[str, Any]]:
    return lambda x, t: Cauchy.value([x]), {
        "window": (-10.0, 10.0),
        "diffusivity": lambda x: 1.0 + 0.5 * Cauchy.value([x]),
        "source": lambda x, t, u: -exchange_limit(x, alpha, 0.5),
    }


ACTS: dict[str, Act] = {
    "velocity -x": _drawn_together,
    "source f(x, t, u)": _competing,
    "diffusivity D(x)": _varying,
}
