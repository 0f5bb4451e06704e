"""The error law (19): its exponents, the best eps, and where eps may lie (M-C3)."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import minimize_scalar

from fracparticles.markers import Gaussian, MarkerVelocity, accuracy, shape_function, uniform
from fracstudy.findings import Finding, measured
from fracstudy.orders import fitted_power

_H, _LENGTH = 0.1, math.sqrt(5.0)  # of the markers of a Gaussian, exp(-x^2 / 5) after t = 1


def rows(law: list[str], spacings: list[float]) -> Iterator[dict[str, Any]]:
    """The exponents k and M of each shape function, and its best eps at each distance of the markers."""
    for name in law:
        shape = shape_function(name)
        k, m = shape.moment_order, accuracy.quadrature_order(shape)
        ours = math.nan if math.isnan(m) else accuracy.quadrature_exponent(shape)
        smoothing = accuracy.smoothing_exponent(shape)
        yield {"what": "k of (19)", "S": name, "ours": smoothing, "predicted": k}
        yield {"what": "M of (19)", "S": name, "ours": ours, "predicted": m}
    for name in law:
        for h in spacings:
            shape = shape_function(name)
            plain, robust = accuracy.optimal_support(shape, h)
            predicted = accuracy.predicted_support(shape, h)
            best = {"ours": robust, "plain": plain, "predicted": predicted}
            yield {"what": "best ε", "S": name, "x": h, "at": f"h = {h:g}", **best}


def findings(of: Mapping[str, pd.DataFrame], law: list[str]) -> Iterator[Finding]:
    """What the rows say of (19) and of its optimum, and what is said of eps."""
    k, m = (of[what].dropna(subset=["ours"]).set_index("S") for what in ("k of (19)", "M of (19)"))
    off = {name: (e["ours"] - e["predicted"]).abs() for name, e in (("k_off", k), ("m_off", m))}
    yield measured("M-C3.law", **off, k=k["ours"], m=m["ours"])
    yield from _best(of["best ε"])
    yield from _supports(law)


def _best(optimum: pd.DataFrame) -> Iterator[Finding]:
    finite, smooth = optimum.dropna(subset=["predicted"]), optimum[optimum["predicted"].isna()]
    finite = finite.rename(columns={"x": "h"}).set_index(["S", "h"])
    robust, plain = (finite[column] / finite["predicted"] for column in ("ours", "plain"))
    # The predicted one is a power of h, M / (k + M), so that the factor is to be none.
    of_h = lambda r: fitted_power(r.index.get_level_values("h"), r)
    power, strict = (r.groupby(level="S").agg(of_h).abs() for r in (robust, plain))
    yield measured(
        "M-C3.optimum",
        power=power,
        robust=robust,
        plain=plain,
        smooth=list(smooth["ours"] / smooth["x"]),
        others={"the least error at any ε, where the lattice error happens to vanish": {"power": strict}},
    )  # fmt: skip
    miss = {}
    for (name, h), predicted in finite["predicted"].items():
        k, m = shape_function(name).moment_order, accuracy.quadrature_order(shape_function(name))
        least = minimize_scalar(
            lambda s, k=k, m=m, h=h: np.exp(k * s) + (h * np.exp(-s)) ** m,
            bounds=(np.log(h) - 3.0, 3.0),
            method="bounded",
            options={"xatol": 1e-12},
        )
        miss[name, f"h = {h:g}"] = abs(np.exp(least.x) / predicted - 1.0)
    yield measured("M-C3.formula", miss=max(miss.values()), number=len(miss))


def lattice_error(name: str, epsilon: float, h: float) -> tuple[float, float]:
    """Return the error of F for a Gaussian after t = 1 by markers h apart, and the part due to h; over f(0)."""
    gaussian, z = Gaussian(), np.linspace(-1.0, 1.0, 41)
    reach = 1.5 + shape_function(name).reach * epsilon
    fields = []
    for spacing in (h, epsilon / 100.5):
        n = math.ceil(reach / spacing) + 1
        x, w = uniform(lambda x: gaussian.value(x, 1.0), (-n * spacing, n * spacing), 2 * n)
        velocity = MarkerVelocity(shape_function(name), epsilon, derivatives=0)
        fields.append(velocity.fields(x, w, z)[0])
    ours, fine = fields
    peak = float(gaussian.value(0.0, 1.0))
    whole, part = (np.abs(ours - f).max() for f in (gaussian.value(z, 1.0), fine))
    return float(whole) / peak, float(part) / peak


def _supports(law: list[str]) -> Iterator[Finding]:
    """Where eps may lie between the distance of the markers and the length of f; what makes (6) inexact."""
    epsilons = _H * np.geomspace(0.5, 40.0, 120)
    over_h, under, at_h, at_length, growing = {}, {}, {}, {}, {}
    for name in law:
        error = np.array([lattice_error(name, e, _H)[0] for e in epsilons])
        good = epsilons[error <= max(0.01, error.min())]
        over_h[name], under[name] = good.min() / _H, _LENGTH / good.max()
        at_h[name] = lattice_error(name, 0.9 * _H, _H)[0] / error.min()
        at_length[name] = lattice_error(name, _LENGTH, _H)[0] / error.min()
        pairs = [[lattice_error(name, 0.5, e / r)[1] for e in (0.5, 0.25)] for r in (0.8, 1.1)]
        growing[name] = min(coarse / fine for coarse, fine in pairs)
    yield measured("M-C3.between", at_h=at_h, at_length=at_length)
    yield measured("M-C3.much", over_h=over_h, under=under)
    rough, smooth = (lattice_error(name, 0.5, 0.2)[1] for name in ("S4", "S8"))
    cause = {"(a) ε is finite": lattice_error("S4", 0.5, 0.01)[0]}
    cause |= {"(b) S is not smooth": rough - smooth, "(c) h is finite": rough}
    yield measured("M-C3.inexact", part=cause, s8=smooth)
    yield measured("M-C3.with_h", ratio=growing)
