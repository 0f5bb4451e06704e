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


_LENGTH, _FINER = 200.0, 32  # of the circle, and its cells in a spacing
_K = 2.0 * np.pi * np.fft.rfftfreq(round(_LENGTH * _FINER / H), H / _FINER)


def solution(transform, x, t, alpha):
    """Return int u^(k) cos(k x) e^(-t k^alpha) dk / pi on a circle so long that its other turns are not felt."""
    return _at(
        x, np.fft.fftshift(np.fft.irfft(transform(_K) * np.exp(-t * _K**alpha))) * _FINER / H
    )


def solution_of(f, x, t, alpha):
    """The same of data of which no transform is known, by their means over the cells of that circle."""
    cell = H / _FINER
    places = (np.arange(round(_LENGTH / cell)) - round(_LENGTH / cell) // 2) * cell
    means = np.mean([f(places + part * cell) for part in (np.arange(16) + 0.5) / 16 - 0.5], axis=0)
    return _at(x, np.fft.irfft(np.fft.rfft(means) * np.exp(-t * _K**alpha)))


def _at(x, u):
    return np.interp(x, (np.arange(u.size) - u.size // 2) * H / _FINER, u)


def solved(initial, **fields):
    """Return the run, and whether there was a warning."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", AccuracyWarning)
        run = solve_problem(Problem(**{"half_width": 10.0, "spacing": H, **fields}), initial)
    return run, bool(caught)


def error(u, exact) -> float:
    """Over the greatest u, as `space_error`."""
    return float(np.abs(u - exact).max() / np.abs(u).max())
