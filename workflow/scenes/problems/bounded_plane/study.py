"""A disc against closed forms and a spectral method, a square by refinement, and the box of truncated schemes."""

from collections.abc import Sequence
from math import gamma
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.disc_polynomials import AbsorbingDisc
from fracparticles.bounded.square import Square
from fracparticles.schemes.setting import Setting
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.errors import power_of_ten
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import observed
from fracstudy.panels import Panels


def study(
    inputs: Inputs,
    *,
    alphas: list[float],
    rings: list[int],
    sides: list[int],
    finest: int,
    box: list[int],
    times: list[float],
) -> Result:
    """A row for each number: part, case, alpha, count, ours, exact, error and its observed order."""
    panels = Panels()
    rows: list[dict[str, Any]] = []
    for alpha in alphas:
        rows += _disc(alpha, rings, panels)
        rows += _square(alpha, sides, finest, panels)
        rows += _totals(alpha)
    middle = alphas[len(alphas) // 2]
    rows += _decay(middle, rings[-1], times, panels)
    rows += _truncated(middle, box, finest, panels)
    return Result(pd.DataFrame(rows), (), panels.frame)


def _levels(
    part: str, case: str, alpha: float, counts: Sequence[int], ours: Sequence[float], exact: Any
) -> list[dict[str, Any]]:
    errors = np.abs(np.asarray(ours) - exact)
    orders = observed([1.0 / n for n in counts], errors.tolist())
    same = {"part": part, "case": case, "alpha": alpha}
    return [
        {**same, "count": n, "ours": o, "exact": exact, "error": e, "observed order": s}
        for n, o, e, s in zip(counts, ours, errors, orders, strict=True)
    ]


def _disc(alpha: float, rings: list[int], panels: Panels) -> list[dict[str, Any]]:
    """Getoor's solution of -(-Laplacian)^(alpha/2) u + 1 = 0, in the mean, and the first eigenvalue."""
    size = 2.0**alpha * gamma(1.0 + 0.5 * alpha) ** 2
    first = float(AbsorbingDisc(alpha).eigenvalues[0])
    errors, eigenvalues = [], []
    for n in rings:
        one = Disc(alpha, n, 1)
        exact = np.maximum(1.0 - one.x**2 - one.y**2, 0.0) ** (0.5 * alpha)
        errors.append(one.total(np.abs(one.stationary(size) - exact)) / one.total(exact))
        eigenvalues.append(float(one.eigenvalues(1)[0]))
    panels.add("getoor", f"{alpha:g}", rings, errors, order=4.0 - alpha)
    relative = [abs(v / first - 1.0) for v in eigenvalues]
    panels.add("disc", f"{alpha:g}", rings, relative, order=4.0 - alpha)
    return [
        *_levels("Getoor, mean error", "disc", alpha, rings, errors, 0.0),
        *_levels("first eigenvalue", "disc", alpha, rings, eigenvalues, first),
    ]


def _square(alpha: float, sides: list[int], finest: int, panels: Panels) -> list[dict[str, Any]]:
    """The first eigenvalue against that of the finest fitted lattice, with the lattice fitted and plain."""
    reference = float(Square(alpha, finest).eigenvalues(1)[0])
    rows = []
    for case, fitted in (("square, fitted", True), ("square, plain", False)):
        found = [float(Square(alpha, n, fitted=fitted).eigenvalues(1)[0]) for n in sides]
        relative = [abs(v / reference - 1.0) for v in found]
        panels.add(case, f"{alpha:g}", sides, relative, order=4.0 - alpha if fitted else 1.0)
        rows += _levels("first eigenvalue", case, alpha, sides, found, reference)
    return rows


def _totals(alpha: float) -> list[dict[str, Any]]:
    """How far the total of a reflecting run drifts, of its size."""
    rows = []
    for case, one in (
        ("disc", Disc(alpha, 32, 16, "reflecting")),
        ("square", Square(alpha, 32, "reflecting")),
    ):
        u = np.exp(-8.0 * ((one.x - 0.5) ** 2 + one.y**2))
        drift = abs(one.total(one.evolve(u, 1.0)) / one.total(u) - 1.0)
        row = {"part": "drift of the total, reflecting", "case": case, "alpha": alpha}
        rows.append({**row, "exact": 0.0, "error": power_of_ten(drift)})
    return rows


def _decay(alpha: float, rings: int, times: list[float], panels: Panels) -> list[dict[str, Any]]:
    """u(0, t) from (1 - r^2)^(alpha/2): rings of particles, and the spectral method."""
    one, spectral = Disc(alpha, rings, 1), AbsorbingDisc(alpha)
    start = (1.0 - one.x**2 - one.y**2) ** (0.5 * alpha)
    r = np.hypot(one.x, one.y)[:1, 0]
    ours = [float(one.evolve(start, t)[0, 0]) for t in times]
    exact = [float(spectral.evolve(np.ones_like, t, r)[0]) for t in times]
    panels.add("decay", "rings of particles", times, ours, exact=exact)
    same = {"part": "decay", "case": "disc", "alpha": alpha, "count": rings}
    return [
        {**same, "at": t, "ours": a, "exact": b, "error": abs(a - b)}
        for t, a, b in zip(times, ours, exact, strict=True)
    ]


def _truncated(alpha: float, box: list[int], finest: int, panels: Panels) -> list[dict[str, Any]]:
    """The decay of the longest wave in the truncated box of a scheme, beside the absorbing and the reflecting square.

    2 n + 1 particles of spacing h lie in a box of half-width (n + 1/2) h = 1. A scheme that takes what is outside for
    zero loses strength, like the absorbing square; one that sums the exchange of its particles only keeps it, and what
    decays is like the second eigenvalue of the reflecting square. The wave is the eigenvector that is most like a half
    wave: the smoothed operator of DD lets the shortest waves decay more slowly still.
    """
    exact = {
        "absorbing": float(Square(alpha, finest).eigenvalues(1)[0]),
        "reflecting": float(Square(alpha, finest, "reflecting").eigenvalues(2)[1]),
    }
    rows = []
    for name, exterior in (("DD", "absorbing"), ("KPSE", "reflecting")):
        found = []
        for n in box:
            setting = Setting(alpha=alpha, dim=2, n=n, spacing=2.0 / (2 * n + 1))
            matrix = scheme_matrix(name, setting).T
            kept = float(np.abs(matrix.sum(axis=0)).max())
            found.append(_longest(-matrix, n, even=exterior == "absorbing"))
            row = {"part": "greatest rate of a constant", "case": name, "alpha": alpha, "count": n}
            rows.append({**row, "ours": power_of_ten(kept) if kept < 1e-9 else kept})
        rows += _levels("decay of the longest wave", name, alpha, box, found, exact[exterior])
        panels.add("truncated", name, [1.0 / n for n in box], found, exact=exact[exterior])
    return rows


def _longest(matrix: np.ndarray, n: int, even: bool) -> float:
    """The eigenvalue of the vector that is most like cos(pi x / 2) cos(pi y / 2), or like sin(pi x / 2)."""
    x = np.pi / (2 * n + 1) * np.arange(-n, n + 1.0)
    wave = np.outer(np.cos(x), np.cos(x)) if even else np.outer(np.sin(x), np.ones_like(x))
    values, vectors = np.linalg.eigh(matrix)
    return float(values[np.argmax(np.abs(wave.reshape(-1) @ vectors))])
