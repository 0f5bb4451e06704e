"""Figs. 1-4: x exp(-x^2) by 32 markers, uniform and of equal weight, for every x_0 that the figures may mean."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import MarkerVelocity, Ramp, equal_weight, shape_function, uniform
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["study"]

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
_CLEARLY = 0.5  # "much better": an error not above half of the other


def study(inputs: Inputs) -> Result:
    """Measure the relative L2 error of F over [0, x_0].

    Parameters of the scene: `support`, `markers`, `ends` (the range of x_0, from and to, and how many), `tabled` (the
    x_0 of the table), `shown` (that of the figure). An approximation is better if its error is smaller, much better if
    it is at most half; a statement on a figure holds if one x_0, the same for all figures, makes it true of both
    curves.
    """
    parameters = inputs.parameters
    first, last, number = parameters["ends"]
    scanned = np.linspace(first, last, int(number))
    ends = sorted({*np.round(scanned, 6), *map(float, parameters["tabled"])})
    errors = pd.DataFrame([_row(parameters, end) for end in ends]).set_index("x_0")
    table = errors.loc[[float(end) for end in parameters["tabled"]]].reset_index()
    findings = [
        _weights(float(parameters["shown"]), int(parameters["markers"])),
        _alone(parameters),
        *_figures(errors),
    ]
    return Result(table, findings, _series(parameters, errors))


def _markers(loading: str, ramp: Ramp, count: int) -> tuple[np.ndarray, np.ndarray]:
    if loading == "uniform":
        return uniform(ramp.value, (0.0, ramp.end), count)
    return equal_weight(ramp, count)


def _field(
    parameters: Mapping[str, Any], figure: str, loading: str, ramp: Ramp, z: np.ndarray
) -> np.ndarray:
    shape, wider, more = _FIGURES[figure]
    x, weights = _markers(loading, ramp, more * int(parameters["markers"]))
    epsilon = wider * float(parameters["support"])
    return MarkerVelocity(shape_function(shape), epsilon, derivatives=0).fields(x, weights, z)[0]


def _row(parameters: Mapping[str, Any], end: float) -> dict[str, float]:
    ramp, z = Ramp(end), np.linspace(0.0, end, _POINTS)
    exact = ramp.value(z)
    row = {"x_0": float(end)}
    for figure in _FIGURES:
        for loading in _LOADINGS:
            gap = _field(parameters, figure, loading, ramp, z) - exact
            row[f"{figure}, {loading}"] = float(np.linalg.norm(gap) / np.linalg.norm(exact))
    return row


def _figures(errors: pd.DataFrame) -> list[Finding]:
    def ratio(figure: str, other: str, loading: str) -> pd.Series:
        return errors[f"{figure}, {loading}"] / errors[f"{other}, {loading}"]

    # Which x_0 make the three statements on the figures true of the uniform curve, and which of both.
    claims = {
        "M-F2.better": ("Fig. 2", "Fig. 1", 1.0),
        "M-F3.better": ("Fig. 3", "Fig. 2", 1.0),
        "M-F4.better": ("Fig. 4", "Fig. 2", _CLEARLY),
        "M-F4.degrades": ("Fig. 4", "ε larger", 1.0),
        "M-F1.more_markers": ("more markers", "Fig. 2", 1.0),
    }
    true = {
        claim: {loading: ratio(a, b, loading) <= most for loading in _LOADINGS}
        for claim, (a, b, most) in claims.items()
    }
    joint = {
        loading: np.logical_and.reduce([true[f"M-F{n}.better"][loading] for n in (2, 3, 4)])
        for loading in _LOADINGS
    }
    some = joint["uniform"] if joint["uniform"].any() else np.ones(len(errors), dtype=bool)
    findings = []
    for claim, (a, b, _) in claims.items():
        uniform_ratio, equal_ratio = (ratio(a, b, loading) for loading in _LOADINGS)
        both = true[claim]["uniform"] & true[claim]["equal"] & some
        at = errors.index[some][np.argmin(uniform_ratio[some])]
        where = f"x₀ = {at:g}"
        spread = f"{equal_ratio[some].min():.2f} to {equal_ratio[some].max():.2f}"
        findings.append(
            statement(
                claim,
                bool(both.any()),
                f"The error changes by a factor of {uniform_ratio[at]:.2f} at {where} for uniform markers, "
                f"and by {equal_ratio[at]:.2f} for those of equal weight ({spread} over the "
                f"{int(some.sum())} values of x₀ at which uniform markers obey Figs. 2, 3 and 4 together).",
                "It is true of the uniform markers only: those of equal weight are too far apart in the tail for ε, "
                "and a narrower shape function makes the gaps show more.",
            )
        )
    return findings


def _weights(end: float, count: int) -> Finding:
    ramp = Ramp(end)
    total = equal_weight(ramp, count)[1].sum()
    return statement(
        "M-F1.weights",
        bool(np.isclose(1.0, ramp.total)),
        f"Weights of 1/N add up to 1, but the integral of f over [0, {end:g}] is {ramp.total:.6f}, the sum of the "
        f"weights σ/N is {total:.6f}: F would be {1.0 / ramp.total:.3f} times too large.",
        "(11) forgets the σ of (10): W = σ/N with σ = (1 - exp(-x₀²))/2.",
    )


def _alone(parameters: Mapping[str, Any]) -> Finding:
    """Markers farther apart than eps do not feel one another."""
    ramp, count = Ramp(float(parameters["shown"])), int(parameters["markers"])
    x, weights = _markers("uniform", ramp, count)
    velocity = {
        factor: np.abs(
            MarkerVelocity(shape_function("S4"), factor * ramp.end / count)(x, weights)
        ).max()
        for factor in (0.99, 2.0)
    }
    return statement(
        "M-F1.independent",
        velocity[0.99] == 0.0 < velocity[2.0],
        f"The largest velocity (7) of the markers is {velocity[0.99]:g} at ε = 0.99 h and {velocity[2.0]:.2f} at "
        "ε = 2 h (S4).",
        "Markers farther apart than ε feel one another.",
    )


def _series(parameters: Mapping[str, Any], errors: pd.DataFrame) -> pd.DataFrame:
    """Panels "Fig. 1" to "Fig. 4" (exact, uniform, equal at x_0 shown), and "error" against x_0."""
    ramp = Ramp(float(parameters["shown"]))
    z = np.linspace(0.0, ramp.end, _POINTS)
    parts = []
    for figure in ("Fig. 1", "Fig. 2", "Fig. 3", "Fig. 4"):
        curves = {"exact": ramp.value(z)}
        curves |= {name: _field(parameters, figure, name, ramp, z) for name in _LOADINGS}
        parts += [
            pd.DataFrame({"panel": figure, "series": name, "x": z, "y": y})
            for name, y in curves.items()
        ]
        for name in _LOADINGS:
            x = _markers(name, ramp, int(parameters["markers"]))[0]
            parts.append(
                pd.DataFrame({"panel": figure, "series": f"{name} markers", "x": x, "y": 0.0})
            )
        parts += [
            pd.DataFrame(
                {
                    "panel": "error",
                    "series": f"{figure}, {name}",
                    "x": errors.index,
                    "y": errors[f"{figure}, {name}"],
                }
            )
            for name in _LOADINGS
        ]
    return pd.concat(parts, ignore_index=True)
