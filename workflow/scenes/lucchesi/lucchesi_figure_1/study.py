"""Fig. 1: the kernels of the schemes, and what the paper says of their shape."""

from collections.abc import Iterator
from itertools import product

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from fracparticles.kernels.families import kernel
from fracstudy.errors import off
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.panels import Panels
from scenes.lucchesi.lucchesi_figure_1.formulas import formulas

_NEAREST, _FARTHEST = 1e-4, 1e6
_TAIL = (1e5, 1e6)  # the exponent is taken between these; what it lacks there is of order 1e-10
_SMALL = np.array([1e-2, 1e-3])  # where the slope at 0 is taken
_SHOWN = [("kappa", 2), ("kappa", 4), ("E", 2), ("K", 2), ("K", 4)]
_NAMES = {"kappa": "κ", "E": "L", "K": "K"}
_DIMS = (1, 2, 3)
_MEANT = "the kernel of order IV"  # where a sentence does not say which order it means
# The radii of the panels: evenly spaced in log r, and around the change of sign of K.
_PANELS = {"kernel": np.geomspace(0.03, 100.0, 141), "near": np.linspace(0.0, 6.0, 241)}
_NEAR = np.linspace(0.0, 20.0, 4001)  # all extrema lie here


def tail_exponent(name: str, alpha: float, order: int, dim: int = 1) -> float:
    """Return d log|K| / d log r far out."""
    near, far = np.abs(kernel(name, np.array(_TAIL), alpha, dim, order))
    return float(np.log(far / near) / np.log(_TAIL[1] / _TAIL[0]))


def study(inputs: Inputs, *, beta: list[float], points: int) -> Result:
    """Sample kappa, L_alpha^0 and K, and measure sign, monotonicity and tails, of F and G as well.

    `points` is the number of radii from 1e-4 to 1e6, spaced evenly in log r, besides r = 0.
    """
    r = np.concatenate([[0.0], np.geomspace(_NEAREST, _FARTHEST, points)])
    table = pd.DataFrame(_row(name, order, b, r) for name, order in _SHOWN for b in beta)
    panels = Panels()
    for (panel, x), (name, order), b in product(_PANELS.items(), _SHOWN, beta):
        where = {"panel": panel, "kernel": name, "order": order, "beta": b}
        panels.add(**where, x=x, y=_values(name, x, b, order))
    findings = [*_figure(table, r, beta), *_of_f(beta), *_of_g(beta), *formulas(beta)]
    return Result(table, inputs.judged(findings), panels.frame)


def _values(name: str, r: ArrayLike, beta: float, order: int = 2, dim: int = 1) -> np.ndarray:
    return np.asarray(kernel(name, r, 1.0 + beta, dim, order))


def _row(name: str, order: int, beta: float, r: np.ndarray) -> dict[str, object]:
    values = _values(name, r, beta, order)
    lowest = int(values.argmin())
    negative = r[values < 0.0]
    return {
        "kernel": _NAMES[name],
        "order": ORDERS[order],
        "beta": beta,
        "at r = 0": values[0],
        "least value": values[lowest],
        "at r": r[lowest],
        "negative from r": negative.min() if negative.size else np.nan,
        "to r": negative.max() if negative.size else np.nan,
        "decreasing": "yes" if (np.diff(values) < 0.0).all() else "no",
        "tail exponent": tail_exponent(name, 1.0 + beta, order),
        "expected exponent": -beta if name == "kappa" else -2.0 - beta,
    }


def _figure(table: pd.DataFrame, r: np.ndarray, betas: list[float]) -> Iterator[Finding]:
    """What the paper says of the kernels of Fig. 1; n = 1."""
    by = {key: part.set_index("beta") for key, part in table.groupby(["kernel", "order"])}
    green, k_two, k_four = by["L", "II"], by["K", "II"], by["K", "IV"]

    def rise(name: str, order: int = 2) -> pd.Series:
        """The largest step from a radius to the next, over the value before it: below zero if it only falls."""
        values = each(lambda b: _values(name, r, b, order), beta=betas)
        return values.map(lambda v: (v[1:] / v[:-1] - 1.0).max())

    def slope(x: float) -> pd.Series:
        """That of kappa from 0 to x, over kappa(0)."""
        at_zero = by["κ", "II"]["at r = 0"]
        return each(lambda b: abs(_values("kappa", x, b) / at_zero[b] - 1.0) / x, beta=betas)

    def decay(claim: str, name: str) -> Finding:
        both = (by[name, order] for order in ORDERS.values())
        two, four = (part["tail exponent"] - part["expected exponent"] for part in both)
        return measured(claim, difference=two, others={_MEANT: {"difference": four}})

    rises = {_MEANT: {"rise": rise("kappa", 4)}}
    yield measured("L-F1.kappa_monotone", rise=rise("kappa"), others=rises)
    coarse, fine = map(slope, _SMALL)
    yield measured("L-F1.kappa_flat", slope=fine, ratio=fine / coarse)
    yield decay("L-F1.kappa_decay", "κ")
    yield measured("L-F1.green_positive", least=green["least value"])
    yield measured("L-F1.green_monotone", rise=rise("E"), exponent=green["tail exponent"])
    yield measured("L-F1.K_positive.II", least=k_two["least value"])
    yield measured("L-F1.K_positive.IV", least=k_four["least value"], place=k_four["at r"])
    yield decay("L-F1.K_decay", "K")


def _of_f(betas: list[float]) -> Iterator[Finding]:
    """What Sec. 3.2.2 says of F, n = 1: odd, a single minimum, the tail."""

    def odd(b: float) -> float:
        return off(-_values("F", -_NEAR, b), _values("F", _NEAR, b))

    def extrema(order: int) -> pd.Series:
        values = each(lambda b: _values("F", _NEAR, b, order), beta=betas)
        return values.map(lambda f: np.count_nonzero(np.diff(np.sign(np.diff(f)))))

    yield measured("L-KERNELS.F_odd", odd=each(odd, beta=betas))
    yield measured(
        "L-KERNELS.F_single_minimum",
        extrema=extrema(2),
        place=each(lambda b: _NEAR[_values("F", _NEAR, b).argmin()], beta=betas),
        others={_MEANT: {"extrema": extrema(4)}},
    )
    difference = each(lambda b: tail_exponent("F", 1.0 + b, 2) + b + 1.0, beta=betas)
    yield measured("L-KERNELS.F_decay", difference=difference)


def _of_g(betas: list[float]) -> Iterator[Finding]:
    """What Sec. 3.1 says of G, in one to three dimensions."""

    def values(order: int) -> pd.Series:
        return each(lambda n, b: _values("G", _NEAR, b, order, n), n=_DIMS, beta=betas)

    def maximum(values: pd.Series) -> dict[str, pd.Series]:
        return {"place": values.map(lambda g: _NEAR[g.argmax()]), "top": values.map(np.max)}

    def origin(values: pd.Series) -> dict[str, pd.Series]:
        return {"origin": values.map(lambda g: g[0])}

    two, four = values(2), values(4)
    difference = each(
        lambda n, b: tail_exponent("G", 1.0 + b, 2, n) + n + 1.0 + b, n=_DIMS, beta=betas
    )
    yield measured("L-KERNELS.G_origin", others={_MEANT: origin(four)}, **origin(two))
    yield measured("L-KERNELS.G_maximum", others={_MEANT: maximum(four)}, **maximum(two))
    yield measured("L-KERNELS.G_decay", difference=difference)
