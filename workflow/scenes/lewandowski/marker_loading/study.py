"""Figs. 1-4: x exp(-x^2) by 32 markers, uniform and of equal weight, for every x_0 that the figures may mean."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.markers import MarkerVelocity, Ramp, equal_weight, shape_function, uniform
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels

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
_MUCH = 0.5  # "much better": an error not above half of the other
# Claim: the error of the first is at most so many times that of the second.
_BETTER = {
    "M-F2.better": ("Fig. 2", "Fig. 1", 1.0),
    "M-F3.better": ("Fig. 3", "Fig. 2", 1.0),
    "M-F4.better": ("Fig. 4", "Fig. 2", _MUCH),
    "M-F4.degrades": ("Fig. 4", "ε larger", 1.0),
    "M-F1.more_markers": ("more markers", "Fig. 2", 1.0),
}


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

    `ends` is the range of x_0, from and to, and how many, `tabled` those of the table, `shown` that of the figure. An
    approximation is better if its error is smaller, much better if it is at most half; a statement on a figure holds if
    one x_0, the same for all figures, makes it true of both curves.
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
    findings = [_weights(ramp, markers), _alone(ramp, markers), *_better(errors)]
    table = errors.loc[tabled].reset_index()
    return Result(table, inputs.judged(findings), panels.frame)


def _markers(loading: str, ramp: Ramp, count: int) -> tuple[np.ndarray, np.ndarray]:
    if loading == "uniform":
        return uniform(ramp.value, (0.0, ramp.end), count)
    return equal_weight(ramp, count)


def _field(
    figure: str, loading: str, ramp: Ramp, support: float, markers: int, z: np.ndarray
) -> np.ndarray:
    shape, wider, more = _FIGURES[figure]
    x, weights = _markers(loading, ramp, more * markers)
    velocity = MarkerVelocity(shape_function(shape), wider * support, derivatives=0)
    return velocity.fields(x, weights, z)[0]


def _errors(end: float, support: float, markers: int) -> dict[str, float]:
    ramp, z = Ramp(end), np.linspace(0.0, end, _POINTS)
    exact, errors = ramp.value(z), {}
    for figure in _FIGURES:
        for loading in _LOADINGS:
            gap = _field(figure, loading, ramp, support, markers, z) - exact
            errors[f"{figure}, {loading}"] = float(np.linalg.norm(gap) / np.linalg.norm(exact))
    return errors


def _better(errors: pd.DataFrame) -> list[Finding]:
    ratio = {
        claim: [errors[f"{a}, {loading}"] / errors[f"{b}, {loading}"] for loading in _LOADINGS]
        for claim, (a, b, _) in _BETTER.items()
    }
    # Which x_0 make the three statements on the figures true of the uniform curve.
    joint = [ratio[f"M-F{n}.better"][0] <= _BETTER[f"M-F{n}.better"][2] for n in (2, 3, 4)]
    some = np.logical_and.reduce(joint)
    some = some if some.any() else np.ones(len(errors), dtype=bool)
    findings = []
    for claim, (_, _, most) in _BETTER.items():
        even, equal = (values[some] for values in ratio[claim])
        at = even.index[np.argmin(even)]
        findings.append(
            statement(
                claim,
                ((even <= most) & (equal <= most)).any(),
                f"The error changes by a factor of {even[at]:.2f} at x₀ = {at:g} for uniform markers, and by "
                f"{equal[at]:.2f} for those of equal weight ({equal.min():.2f} to {equal.max():.2f} over the "
                f"{len(even)} values of x₀ at which uniform markers obey Figs. 2, 3 and 4 together).",
                "It is true of the uniform markers only: those of equal weight are too far apart in the tail for ε, "
                "and a narrower shape function makes the gaps show more.",
            )
        )
    return findings


def _weights(ramp: Ramp, count: int) -> Finding:
    total = equal_weight(ramp, count)[1].sum()
    return statement(
        "M-F1.weights",
        np.isclose(1.0, ramp.total),
        f"Weights of 1/N add up to 1, but the integral of f over [0, {ramp.end:g}] is {ramp.total:.6f}, the sum of the "
        f"weights σ/N is {total:.6f}: F would be {1.0 / ramp.total:.3f} times too large.",
        "(11) forgets the σ of (10): W = σ/N with σ = (1 - exp(-x₀²))/2.",
    )


def _alone(ramp: Ramp, count: int) -> Finding:
    """Markers farther apart than eps do not feel one another."""
    markers, s4 = _markers("uniform", ramp, count), shape_function("S4")
    apart, near = (
        np.abs(MarkerVelocity(s4, factor * ramp.end / count)(*markers)).max()
        for factor in (0.99, 2.0)
    )
    return statement(
        "M-F1.independent",
        apart == 0.0 < near,
        f"The largest velocity (7) of the markers is {apart:g} at ε = 0.99 h and {near:.2f} at ε = 2 h (S4).",
        "Markers farther apart than ε feel one another.",
    )
