"""Errors as the tables of scenes show them."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import ArrayLike

from fracparticles.errors import FracparticlesWarning

__all__ = ["EPS", "off", "power_of_ten", "quiet", "three_digits"]

EPS = float(np.finfo(float).eps)
"""The distance from one to the next number, by which round-off is measured."""

_ROUNDING = 1e-13  # the least error that is shown: less is round-off


def off(found: ArrayLike, exact: ArrayLike, size: float | None = None) -> float:
    """Return max |found - exact| over a size; without one it is the greatest |exact|."""
    exact = np.asarray(exact)
    return float(np.abs(found - exact).max() / (np.abs(exact).max() if size is None else size))


def three_digits(error: float) -> float:
    """Return |error| to three digits; one below 1e-13 is round-off, and shown as 1e-13."""
    return float(f"{max(abs(error), _ROUNDING):.3g}")


def power_of_ten(error: float, least: float = 2.0**-53) -> float:
    """Return the next power of ten above |error|, since only the size of round-off is reproducible."""
    return float(10.0 ** np.ceil(np.log10(max(abs(error), least))))


@contextmanager
def quiet(kind: type[Warning] = FracparticlesWarning) -> Iterator[None]:
    """Silence the warnings of a block which is there for other reasons."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kind)
        yield
