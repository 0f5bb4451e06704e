"""Fig. 1: the kernels of the schemes, and what the paper says of their shape."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from fracparticles.kernels.families import kernel
from fracstudy.findings import Finding, measured
from fracstudy.inputs import ORDERS, Inputs, Result
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
    curves = [
        {
            "panel": panel,
            "kernel": name,
            "order": order,
            "beta": b,
            "x": x,
            "y": _values(name, x, b, order),
        }
        for panel, x in _PANELS.items()
        for name, order in _SHOWN
        for b in beta
    ]
    findings = [*_figure(table, r, beta), *_of_f(beta), *_of_g(beta), *formulas(beta)]
    series = pd.concat(map(pd.DataFrame, curves), ignore_index=True)
    return Result(table, inputs.judged(findings), series)


def _values(name: str, r: np.ndarray, beta: float, order: int = 2, dim: int = 1) -> np.ndarray:
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


def _figure(table: pd.DataFrame, r: np.ndarray, betas: Sequence[float]) -> list[Finding]:
    """What the paper says of the kernels of Fig. 1; n = 1."""
    by = {key: part.set_index("beta") for key, part in table.groupby(["kernel", "order"])}
    kappa, green, k_two, k_four = (
        by[key] for key in (("κ", "II"), ("L", "II"), ("K", "II"), ("K", "IV"))
    )
    off = {key: part["tail exponent"] - part["expected exponent"] for key, part in by.items()}

    def rise(name: str, order: int = 2) -> pd.Series:
        """The largest step from a radius to the next, over the value before it: below zero if it only falls."""
        steps = [(v[1:] / v[:-1] - 1.0).max() for v in (_values(name, r, b, order) for b in betas)]
        return pd.Series(steps, kappa.index)

    at_zero = kappa["at r = 0"]
    slopes = [
        pd.Series([abs(_values("kappa", x, b) / at_zero[b] - 1.0) / x for b in betas], kappa.index)
        for x in _SMALL
    ]
    return [
        measured(
            "L-F1.kappa_monotone",
            rise=rise("kappa"),
            others={_MEANT: {"rise": rise("kappa", 4)}},
        ),
        measured("L-F1.kappa_flat", slope=slopes[1], ratio=slopes[1] / slopes[0]),
        measured(
            "L-F1.kappa_decay",
            difference=off["κ", "II"],
            others={_MEANT: {"difference": off["κ", "IV"]}},
        ),
        measured("L-F1.green_positive", least=green["least value"]),
        measured("L-F1.green_monotone", rise=rise("E"), exponent=green["tail exponent"]),
        measured("L-F1.K_positive.II", least=k_two["least value"]),
        measured("L-F1.K_positive.IV", least=k_four["least value"], place=k_four["at r"]),
        measured(
            "L-F1.K_decay",
            difference=off["K", "II"],
            others={_MEANT: {"difference": off["K", "IV"]}},
        ),
    ]


def _of_f(betas: Sequence[float]) -> list[Finding]:
    """What Sec. 3.2.2 says of F, n = 1: odd, a single minimum, the tail."""
    index = pd.Index(betas, name="beta")

    def extrema(order: int) -> pd.Series:
        turns = [np.diff(np.sign(np.diff(_values("F", _NEAR, b, order)))) for b in betas]
        return pd.Series([np.count_nonzero(t) for t in turns], index)

    values = [_values("F", _NEAR, b) for b in betas]
    odd = [
        np.abs(_values("F", -_NEAR, b) + f).max() / np.abs(f).max()
        for b, f in zip(betas, values, strict=True)
    ]
    place = pd.Series([_NEAR[f.argmin()] for f in values], index)
    off = pd.Series([tail_exponent("F", 1.0 + b, 2) + b + 1.0 for b in betas], index)
    return [
        measured("L-KERNELS.F_odd", odd=pd.Series(odd, index)),
        measured(
            "L-KERNELS.F_single_minimum",
            extrema=extrema(2),
            place=place,
            others={_MEANT: {"extrema": extrema(4)}},
        ),
        measured("L-KERNELS.F_decay", difference=off),
    ]


def _of_g(betas: Sequence[float]) -> list[Finding]:
    """What Sec. 3.1 says of G, in one to three dimensions."""
    index = pd.MultiIndex.from_product([_DIMS, betas], names=["n", "beta"])

    def both(order: int) -> tuple[pd.Series, pd.Series, pd.Series]:
        values = [_values("G", _NEAR, b, order, n) for n, b in index]
        places = [_NEAR[g.argmax()] for g in values]
        return tuple(
            pd.Series(part, index)
            for part in ([g[0] for g in values], places, [g.max() for g in values])
        )

    (origin, place, top), four = both(2), both(4)
    off = [tail_exponent("G", 1.0 + b, 2, n) + n + 1.0 + b for n, b in index]
    return [
        measured("L-KERNELS.G_origin", origin=origin, others={_MEANT: {"origin": four[0]}}),
        measured(
            "L-KERNELS.G_maximum",
            place=place,
            top=top,
            others={_MEANT: {"place": four[1], "top": four[2]}},
        ),
        measured("L-KERNELS.G_decay", difference=pd.Series(off, index)),
    ]
