"""Data with kinks and jumps on the line, their exact solution, and runs from them."""

from __future__ import annotations

import warnings

import numpy as np

from fracparticles.errors import AccuracyWarning
from fracparticles.problems import Problem, solve_problem

H = 0.1
SAID = 0.03  # an error that must not be silent

# Each of a width 1: itself and its Fourier transform.
KINKS = {
    "tent": (lambda s: np.maximum(0.0, 1.0 - np.abs(s)), lambda k: np.sinc(0.5 * k / np.pi) ** 2),
    "cusp": (lambda s: np.exp(-np.abs(s)), lambda k: 2.0 / (1.0 + k * k)),
    "box": (lambda s: 1.0 * (np.abs(s) < 0.5), lambda k: np.sinc(0.5 * k / np.pi)),
}


def bell(s):
    return np.exp(-s * s)


def bell_waves(k):
    return np.sqrt(np.pi) * np.exp(-0.25 * k * k)


def solution(transform, x, t, alpha):
    """Return int u^(k) cos(k x) e^(-t k^alpha) dk / pi on a circle so long that its other turns are not felt."""
    length, finer = 200.0, 32
    k = 2.0 * np.pi * np.fft.rfftfreq(round(length * finer / H), H / finer)
    waves = transform(k) * np.exp(-t * k**alpha)
    u = np.fft.fftshift(np.fft.irfft(waves)) * finer / H
    at = (np.arange(u.size) - u.size // 2) * H / finer
    return np.interp(x, at, u)


def solved(initial, **fields):
    """Return the run, and whether there was a warning."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", AccuracyWarning)
        run = solve_problem(Problem(**{"half_width": 10.0, "spacing": H, **fields}), initial)
    return run, bool(caught)


def error(u, exact) -> float:
    """Over the greatest u, as `space_error`."""
    return float(np.abs(u - exact).max() / np.abs(u).max())
