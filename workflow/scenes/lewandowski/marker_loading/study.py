"""Figs. 1-4: x exp(-x^2) by 32 markers, uniform and of equal weight, for every x_0 that the figures may mean."""

from collections.abc import Iterator
from itertools import product

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES, MarkerVelocity, equal_weight, shape_function, uniform
from fracparticles.markers.profiles import Ramp
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

_POINTS = 801
# Figure: shape function, factor of the support parameter, factor of the number of markers.
_FIGURES = {
    "Fig. 1": ("S3", 1, 1),
    "Fig. 2": ("S4", 1, 1),
    "Fig. 3": ("S6", 1, 1),
    "Fig. 4": ("S4", 2, 1),
    "ε larger": ("S4", 4, 1),
    "more markers": ("S4", 1, 4),
}
_LOADINGS = ("uniform", "equal")
_CALLED = {"uniform": "uniform", "equal": "nonuniform"}  # as the captions of the figures call them
# Claim: the error of the first over that of the second.
_BETTER = {
    "M-F2.better": ("Fig. 2", "Fig. 1"),
    "M-F3.better": ("Fig. 3", "Fig. 2"),
    "M-F4.better": ("Fig. 4", "Fig. 2"),
    "M-F4.degrades": ("ε larger", "Fig. 4"),
}
Markers = tuple[np.ndarray, np.ndarray]


def study(
    inputs: Inputs,
    *,
    support: float,
    markers: int,
    ends: list[float],
    tabled: list[float],
    shown: float,
) -> Result:
    """Measure the relative L2 error of F over [0, x_0].

    `ends` is the range of x_0, from and to, and how many, `tabled` those of the table, `shown` that of the figure. The
    paper does not print x_0: its statements are judged at the one that serves them best for uniform markers.
    """
    first, last, number = ends
    scanned = sorted({*np.round(np.linspace(first, last, int(number)), 6), *tabled})
    errors = pd.DataFrame({end: _errors(end, support, markers) for end in scanned}).T
    errors.index.name = "x_0"
    ramp, panels = Ramp(shown), Panels()
    z = np.linspace(0.0, ramp.end, _POINTS)
    for figure in ("Fig. 1", "Fig. 2", "Fig. 3", "Fig. 4"):
        panels.add(figure, "exact", z, ramp.value(z))
        for loading in _LOADINGS:
            panels.add(figure, loading, z, _field(figure, loading, ramp, support, markers, z))
            x, _ = _markers(loading, ramp, markers)
            panels.add(figure, f"{loading} markers", x, 0.0)
            both = f"{figure}, {loading}"
            panels.add("error", both, errors.index, errors[both].to_numpy())
    ratios = {claim: _ratio(errors, *figures) for claim, figures in _BETTER.items()}
    best = sum(np.log(ratios[f"M-F{n}.better"]["uniform"]) for n in (2, 3, 4)).idxmin()
    findings = [
        *(_better(claim, ratio, best, tabled, support, markers) for claim, ratio in ratios.items()),
        *_equal_weight(ramp, markers),
        *_apart(ramp, markers),
        *_more(Ramp(best), support, markers),
        _of_loading(errors.loc[best]),
    ]
    table = errors.loc[tabled].reset_index()
    return Result(table, inputs.judged(findings), panels.frame)


def _markers(loading: str, ramp: Ramp, count: int) -> Markers:
    if loading == "uniform":
        return uniform(ramp.value, (0.0, ramp.end), count)
    return equal_weight(ramp, count)


def _f(shape: str, epsilon: float, markers: Markers, z: np.ndarray) -> np.ndarray:
    """F at z (8)."""
    return MarkerVelocity(shape_function(shape), epsilon, derivatives=0).fields(*markers, z)[0]


def _field(
    figure: str, loading: str, ramp: Ramp, support: float, markers: int, z: np.ndarray
) -> np.ndarray:
    shape, wider, more = _FIGURES[figure]
    return _f(shape, wider * support, _markers(loading, ramp, more * markers), z)


def _errors(end: float, support: float, markers: int) -> dict[str, float]:
    ramp, z = Ramp(end), np.linspace(0.0, end, _POINTS)
    exact, errors = ramp.value(z), {}
    for case in product(_FIGURES, _LOADINGS):
        gap = _field(*case, ramp, support, markers, z) - exact
        errors[", ".join(case)] = float(np.linalg.norm(gap) / np.linalg.norm(exact))
    return errors


def _ratio(errors: pd.DataFrame, first: str, second: str) -> pd.DataFrame:
    """The error of one figure over that of another, by x_0 and loading."""
    ratio = {_CALLED[s]: errors[f"{first}, {s}"] / errors[f"{second}, {s}"] for s in _LOADINGS}
    return pd.DataFrame(ratio)


def _better(
    claim: str, ratio: pd.DataFrame, best: float, tabled: list[float], support: float, count: int
) -> Finding:
    others = {f"x_0 = {end:g}": {"ratio": ratio.loc[end]} for end in tabled}
    far = _in_gaps(_BETTER[claim][0], Ramp(best), support, count)
    return measured(
        claim, ratio=ratio.loc[best], x0=best, least=ratio.min(), far=far, others=others
    )


def _of_loading(errors: pd.Series) -> Finding:
    """How much the loading changes the error of each figure."""
    figures = ("Fig. 1", "Fig. 2", "Fig. 3", "Fig. 4")
    ratio = {f: errors[f"{f}, equal"] / errors[f"{f}, uniform"] for f in figures}
    change = {figure: abs(r - 1.0) for figure, r in ratio.items()}
    return measured("M-F1.loading", change=change, ratio=ratio, x0=errors.name)


def _in_gaps(figure: str, ramp: Ramp, support: float, count: int) -> float:
    """The share of the squared error of markers of equal weight where they are farther apart than eps."""
    z, (x, _) = np.linspace(0.0, ramp.end, _POINTS), _markers("equal", ramp, count)
    error = (_field(figure, "equal", ramp, support, count, z) - ramp.value(z)) ** 2
    wide = np.interp(z, 0.5 * (x[1:] + x[:-1]), np.diff(x)) > support
    return float(error[wide].sum() / error.sum())


def _equal_weight(ramp: Ramp, count: int) -> Iterator[Finding]:
    """The positions and the weights of (11) beside those of (10)."""
    x, weights = equal_weight(ramp, count)
    part = (np.arange(1, count + 1) - 0.5) / count
    printed = np.sqrt(-np.log(1.0 - part * (1.0 - np.exp(-(ramp.end**2)))))
    yield measured("M-F1.positions", miss=np.abs(printed - x).max())
    even, total = _markers("uniform", ramp, count)[1].sum(), ramp.total
    yield measured("M-F1.uniform", miss=abs(even / total - 1.0))
    right = abs(weights.sum() / total - 1.0)
    away = {"miss": abs(1.0 / total - 1.0), "right": right}
    yield measured("M-F1.weights", **away, factor=1.0 / total, end=ramp.end)


def _apart(ramp: Ramp, count: int) -> Iterator[Finding]:
    """Uniform markers farther apart than eps: whether they feel one another, and what F is."""
    markers, h = _markers("uniform", ramp, count), ramp.end / count

    def fastest(name: str, epsilon: float) -> float:
        return float(np.abs(MarkerVelocity(shape_function(name), epsilon)(*markers)).max())

    finite = [name for name, s in SHAPES.items() if s.finite and s.smoothness]
    yield measured(
        "M-F1.independent",
        apart={name: fastest(name, 0.99 * h) for name in finite},
        near={name: fastest(name, 2.0 * h) for name in finite},
        infinite=fastest("S8", 0.99 * h),
    )
    x = markers[0]
    inside = (x > 0.2 * ramp.end) & (x < 0.6 * ramp.end)
    exact = (2.0 * x - 1.0 / x)[inside]  # -f_x / f

    def miss(name: str) -> float:
        ours = MarkerVelocity(shape_function(name), 0.9 * h)(*markers)[inside]
        return float(np.linalg.norm(ours - exact) / np.linalg.norm(exact))

    yield measured("M-F1.larger", error={name: miss(name) for name in (*finite, "S8")})


def _more(ramp: Ramp, support: float, count: int) -> Iterator[Finding]:
    """Four times as many markers, everywhere or in the first third only."""
    z = np.linspace(0.0, ramp.end, _POINTS)
    shapes = {figure: _FIGURES[figure][0] for figure in ("Fig. 1", "Fig. 2", "Fig. 3")}

    def rough(shape: str, loading: str, times: int) -> float:
        """The total variation of F - f."""
        f = _f(shape, support, _markers(loading, ramp, times * count), z)
        return float(np.abs(np.diff(f - ramp.value(z))).sum())

    def smoother(times: int) -> dict[str, float]:
        return {
            f"{figure}, {_CALLED[s]}": rough(shape, s, times) / rough(shape, s, 1)
            for (figure, shape), s in product(shapes.items(), _LOADINGS)
        }

    others = {"twice as many": {"ratio": smoother(2)}}
    yield measured("M-F1.more_markers", ratio=smoother(4), x0=ramp.end, others=others)
    third = ramp.end / 3.0
    even = _markers("uniform", ramp, 3 * (count // 3))
    left = uniform(ramp.value, (0.0, third), 4 * (count // 3))
    more = tuple(np.concatenate([a, b[even[0] > third]]) for a, b in zip(left, even, strict=True))
    inside = z[(z > 2.0 * support) & (z < third - 2.0 * support)]

    def error(shape: str, markers: Markers) -> float:
        return float(np.linalg.norm(_f(shape, support, markers, inside) - ramp.value(inside)))

    gain = {s: error(s, (more[0], more[1])) / error(s, even) for s in shapes.values()}
    yield measured("M-F1.locally", ratio=gain)
