"""Eigenvalues, numerical range and transient growth of operators that are not normal."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
from scipy.linalg import eigh, expm

from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix, eigenvalue_bounds, scheme_matrix
from fracparticles.schemes.stability import stability_limit
from fracstudy.probe import EPS, HELD, Kind, Probe
from scenes.extremes.dense import step

_TIMES = np.geomspace(1e-2, 1e6, 17)
_STEPS = 2 ** np.arange(15)


def eigenvalues(half: int, orders: list[int], overlaps: list[float]) -> Iterator[Probe]:
    """The bounds that stepping and series stand on hold all eigenvalues, of all orders, exteriors, tables.

    A defective eigenvalue of A is split by the root of the round-off: that much is allowed.
    """
    bound = 10.0 * float(np.sqrt(EPS))
    right = Kind("eigenvalues", "within the bounds", bound, "dense matrix", HELD)
    tables = [*((s, None) for s in overlaps), (3.3, 0.3)]
    every = product(("DD", "FPSE", "KPSE"), ("truncated", "open"), orders, tables)
    for scheme, exterior, order, (s, table) in every:
        if exterior == "open" and half < 4.0 * s:  # too narrow
            continue
        fields: dict[str, Any] = {"overlap": s, "exterior": exterior, "kernel_table": table}
        setting = Setting(alpha=1.98, n=half, order=order, **fields)
        name = f"{scheme}, order {order}, s = {s:g}, {exterior}{', table' if table else ''}"
        yield right(name, _beyond, scheme, setting)


def _beyond(scheme: str, setting: Setting) -> tuple[float, str]:
    operator = SCHEMES[scheme].operator(setting)
    low, high = eigenvalue_bounds(scheme, setting, operator)
    values = np.linalg.eigvals(dense_matrix(operator)).real
    over = max(low - values.min(), values.max() - high) / (high - low)
    words = "within" if over <= 0.0 else "at the bound" if over < 1e-6 else f"{over:.0e} beyond"
    return max(0.0, float(over)), words


def transient_growth(half: int) -> Iterator[Probe]:
    """|exp(A t)| and |p(A dt)^n| in the Euclidean norm: at most one if A is normal, else the condition of the modes.

    The numerical range reaches to the greatest eigenvalue w of (A + A^T) / 2: for short times |exp(A t)| ~ exp(w t).
    """
    for scheme, exterior, order in product(("DD", "FPSE", "KPSE"), ("truncated", "open"), (2, 4)):
        setting = Setting(alpha=1.5, n=min(half, 40), order=order, exterior=exterior)
        name = f"{scheme}, order {order}, {exterior}"
        matrix = scheme_matrix(scheme, setting)
        reach = float(eigh(0.5 * (matrix + matrix.T), eigvals_only=True)[-1])
        normal = exterior == "truncated" and scheme != "FPSE"
        condition = 1.0 if normal else float(np.linalg.cond(np.linalg.eig(matrix)[1]))
        expected = "at most 1" if normal else "at most the condition of the modes"
        # Of the zero eigenvalue round-off makes eps |A|, over t up to 1e6.
        bounded = Kind("transient growth", expected, 1e-8, must=HELD)
        flow = lambda: _worst([expm(t * matrix) for t in _TIMES], condition, reach)
        yield bounded(f"{name}, exp(A t)", flow, source="scipy")
        p = step(matrix, 0.99 * stability_limit(scheme, 0.5, order), "rk2")
        power = np.linalg.matrix_power
        steps = lambda: _worst([power(p, int(n)) for n in _STEPS], condition, reach)
        yield bounded(f"{name}, p(A dt)^n, rk2, dt = 0.99 a", steps, source="dense matrix")
        # The next term of the exponential, t |A|^2 / 2, against |A|.
        rate = Kind("numerical range", f"log |exp(A t)| / t = {reach:.0e}", 1e-3, "scipy", HELD)
        short = 1e-3 / np.abs(matrix).sum(axis=1).max()
        yield rate(f"{name}, t -> 0", _rate, matrix, reach, short)


def _worst(matrices: list[np.ndarray], condition: float, reach: float) -> tuple[float, str]:
    most = max(float(np.linalg.norm(one, 2)) for one in matrices)
    return max(0.0, most / condition - 1.0), f"at most {most:.1f}, w = {reach:.0e}"


def _rate(matrix: np.ndarray, reach: float, t: float) -> tuple[float, str]:
    size = float(np.abs(matrix).sum(axis=1).max())
    rate = float(np.log(np.linalg.norm(expm(t * matrix), 2)) / t)
    return abs(rate - reach) / size, f"{rate:.0e}"
