"""Properties of the matrix of an operator: eigenvalues, symmetry, normality, and how its powers grow (Sec. 4.4)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

__all__ = ["Spectrum", "norms_of_powers", "spectrum"]


class Spectrum(NamedTuple):
    """Eigenvalues and symmetry of a real matrix A.

    Attributes
    ----------
    particles : int
        The number N of its rows.
    lowest, highest : float
        Least and greatest real part of its eigenvalues.
    imaginary : float
        Greatest |imaginary part| of its eigenvalues.
    asymmetry : float
        |A - A^T| / |A|, Frobenius norms.
    departure : float
        |A A^T - A^T A| / |A|^2, the departure from normality.
    """

    particles: int
    lowest: float
    highest: float
    imaginary: float
    asymmetry: float
    departure: float


def spectrum(a: np.ndarray) -> Spectrum:
    """Return the `Spectrum` of a matrix, shape (N, N), all eigenvalues computed."""
    eigenvalues = np.linalg.eigvals(a)
    size = np.linalg.norm(a)
    return Spectrum(
        len(a),
        float(eigenvalues.real.min()),
        float(eigenvalues.real.max()),
        float(np.abs(eigenvalues.imag).max()),
        float(np.linalg.norm(a - a.T) / size),
        float(np.linalg.norm(a @ a.T - a.T @ a) / size**2),
    )


def norms_of_powers(a: np.ndarray, squarings: int, every: int) -> list[float]:
    """Return |A^n|, the Euclidean norm, for n = 2^k with k = 0, `every`, 2 `every`, .. up to `squarings`.

    It is computed by repeated squaring, in which round-off grows to about n times 1e-16 of A^n.
    """
    norms = []
    for k in range(squarings + 1):
        if k % every == 0:
            norms.append(float(np.linalg.norm(a, 2)))
        a = a @ a
    return norms
