"""Sections 2.1, 2.3 and 2.4: markers per eps, the error law (19), position errors, and the denominator of (7)."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import FracparticlesError
from fracparticles.markers import Gaussian, MarkerVelocity, Shape, run, shape_function, uniform
from fracparticles.moving.lagrangian import FieldNotPositive
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.lewandowski.marker_runs import LOADINGS, SQUARE, Trace, fixed_grid, load, trace

__all__ = ["optimal_support", "quadrature_exponent", "smoothing_exponent", "study"]

_T_SMOOTH = 1.0  # the Gaussian exp(-x^2) spread until then is what the error law is measured on
_NEAR = ("midpoints", "random")
_PER_UNIT = 6  # values of eps / h between whole numbers
_LITTLE = 0.1  # "much smaller": a tenth at most
_CLOSE = 0.1  # accurate enough: E within a tenth of that of the most markers


def study(inputs: Inputs) -> Result:
    """Measure what Sections 2.1, 2.3 and 2.4 say of the accuracy.

    Parameters of the scene: those of a run (see `marker_runs.trace`), `counts` (numbers of markers), `shapes`,
    `spacings` (of the optimal support parameter), `times` (at which positions are compared), `seeds`, `small_dt`.
    """
    parameters = inputs.parameters
    numbers = _numbers(parameters)
    law = pd.DataFrame([_law(shape_function(name)) for name in parameters["law"]])
    optimum = _optimum(parameters)
    positions = _positions(parameters)
    stops = _stops(parameters)
    findings = [
        *_enough(numbers),
        _law_finding(law),
        _optimum_finding(optimum),
        _in_time(parameters),
        _position_finding(positions),
        _denominator(parameters, stops),
    ]
    table = _table(numbers, law, optimum, positions)
    return Result(
        table, findings, _series(parameters, numbers, law, optimum, positions, stops)
    )  # fmt: skip


# --- markers per eps (M-C2) -----------------------------------------------------------------------


def _numbers(parameters: Mapping[str, Any]) -> pd.DataFrame:
    rows = []
    for shape in parameters["shapes"]:
        for loading in _NEAR:
            for count in parameters["counts"]:
                found = trace(
                    parameters, shape, loading, int(parameters["seed"]), markers=int(count), follow=False
                )  # fmt: skip
                if found.run is None:
                    continue
                per_support = count * float(parameters["support"]) / np.ptp(found.end.x)
                rows.append(
                    {"S": shape, "loading": loading, "N": count, "N per ε": per_support, "E": found.error[-1]}
                )  # fmt: skip
    return pd.DataFrame(rows)


def _enough(numbers: pd.DataFrame) -> list[Finding]:
    def excess(shape: str, loading: str) -> pd.Series:
        part = numbers[(numbers["S"] == shape) & (numbers["loading"] == loading)].set_index(
            "N per ε"
        )["E"]
        return part / part.iloc[-1] - 1.0

    ours = excess("S8", "midpoints")
    enough = ours[ours.index >= 10.0]
    fewer = ours[ours.index < 10.0]
    noisy = numbers[(numbers["S"] == "S4") & (numbers["loading"] == "random")]
    level = numbers[(numbers["S"] == "S4") & (numbers["loading"] == "midpoints")]["E"].iloc[-1]
    falls = [
        bool((np.diff(part["E"]) < 0.0).all()) for _, part in numbers.groupby(["S", "loading"])
    ]
    return [
        statement(
            "M-C2.enough",
            bool((enough <= _CLOSE).all() and len(enough)),
            "With S8 from midpoints E exceeds that of the most markers by "
            + ", ".join(f"{e:.1%} at {n:.1f}" for n, e in enough.iloc[:-1].items())
            + (f" per ε, and {fewer.iloc[-1]:.0%} at {fewer.index[-1]:.1f}" if len(fewer) else "")
            + f". With S4 from random positions E is {noisy['E'].iloc[-1] / level:.1f} times that from midpoints "
            f"even at {noisy['N per ε'].iloc[-1]:.0f} per ε: clusters.",
            "E still falls by more than a tenth beyond that.",
        ),
        statement(
            "M-C2.more",
            all(falls),
            f"E falls with every increase of N in {sum(falls)} of {len(falls)} cases (shape function and loading).",
            "From random positions it does not always: more markers change the noise, the seed of clusters with S4.",
        ),
    ]


# --- the error law (M-C3) -------------------------------------------------------------------------


def _on_lattice(shape: Shape, epsilon: float, h: float, offset: float, z: np.ndarray) -> np.ndarray:
    """F of the spread Gaussian at z, by markers of weight f h at (j + offset) h wherever S_eps reaches."""
    reach = 1.5 + shape.reach * epsilon
    j = np.arange(math.floor(-reach / h) - 1, math.ceil(reach / h) + 2)
    x = (j + offset) * h
    weights = h * Gaussian().value(x, _T_SMOOTH)
    return MarkerVelocity(shape, epsilon, derivatives=0).fields(x, weights, z)[0]


def smoothing_exponent(shape: Shape) -> float:
    """Return k of (19) from two support parameters, with so many markers that only eps^k is left."""
    z, errors = np.linspace(-1.0, 1.0, 41), []
    for epsilon in (0.1, 0.2):
        f = _on_lattice(shape, epsilon, epsilon / 200.5, 0.0, z)
        errors.append(np.abs(f - Gaussian().value(z, _T_SMOOTH)).max())
    return float(np.log2(errors[1] / errors[0]))


def quadrature_exponent(shape: Shape) -> float:
    """Return M of (19): F against that of very many markers, eps / h from 2 to 3 and from 8 to 9.

    The worst of several ratios and offsets is taken: at some ratios the error happens to vanish.
    """
    z, epsilon = np.linspace(-1.0, 1.0, 41), 0.5
    fine = _on_lattice(shape, epsilon, epsilon / 2000.5, 0.0, z)
    worst = []
    for first in (2.0, 8.0):
        errors = [
            np.abs(_on_lattice(shape, epsilon, epsilon / (first + r), offset, z) - fine).max()
            for r in np.linspace(0.0, 1.0, 13)
            for offset in (0.0, 0.25, 0.5, 0.75)
        ]
        worst.append(max(errors))
    return float(np.log2(worst[0] / worst[1]) / 2.0)


def _law(shape: Shape) -> dict[str, Any]:
    finite = shape.smoothness is not None
    return {
        "S": shape.name,
        "k of the moments": shape.moment_order,
        "k": smoothing_exponent(shape),
        "M of the smoothness": shape.smoothness + 1 if shape.smoothness is not None else math.nan,
        "M": quadrature_exponent(shape) if finite else math.nan,
    }


def optimal_support(shape: Shape, h: float) -> tuple[float, float]:
    """Return the eps with the least error of F on a lattice, for markers h apart; and the same over ranges of eps.

    At some eps / h the error of equally spaced markers happens to vanish: the second takes the worst of a range of eps
    as wide as h, and is its middle.
    """
    z = np.linspace(-1.0, 1.0, 97)
    exact = Gaussian().value(z, _T_SMOOTH)
    ratios = np.arange(1.0, 14.0, 1.0 / _PER_UNIT)
    errors = [np.abs(_on_lattice(shape, r * h, h, 0.0, z) - exact).max() for r in ratios]
    worst = np.lib.stride_tricks.sliding_window_view(errors, _PER_UNIT + 1).max(axis=1)
    best, middle = ratios[int(np.argmin(errors))], ratios[int(np.argmin(worst))] + 0.5
    return float(best * h), float(middle * h)


def _optimum(parameters: Mapping[str, Any]) -> pd.DataFrame:
    rows = []
    for name in parameters["law"]:
        shape = shape_function(name)
        for h in map(float, parameters["spacings"]):
            k, formula = shape.moment_order, math.nan
            if shape.smoothness is not None:
                m = shape.smoothness + 1
                formula = (m * h**m / k) ** (1.0 / (k + m))
            best, robust = optimal_support(shape, h)
            rows.append({"S": name, "h": h, "best": best, "optimum": robust, "formula": formula})
    return pd.DataFrame(rows)


def _law_finding(law: pd.DataFrame) -> Finding:
    finite = law.dropna()
    gap_k = (law["k"] - law["k of the moments"]).abs().max()
    gap_m = (finite["M"] - finite["M of the smoothness"]).abs().max()
    return statement(
        "M-C3.law",
        bool(gap_k <= 0.1 and gap_m <= 0.3),
        "Measured on a lattice of markers, k = "
        + ", ".join(f"{row.k:.2f} ({row.S})" for row in law.itertuples())
        + "; M = "
        + ", ".join(f"{row.M:.2f} ({row.S}, predicted {row[4]:.0f})" for row in finite.itertuples())
        + ". With S8, smooth, the error falls faster than any power. The markers are at equal distances.",
        "The exponents are others.",
    )


def _optimum_finding(optimum: pd.DataFrame) -> Finding:
    finite = optimum.dropna()
    plain, ratio = finite["best"] / finite["formula"], finite["optimum"] / finite["formula"]
    smooth = optimum[optimum["formula"].isna()]
    at = smooth["optimum"] / smooth["h"]
    return statement(
        "M-C3.optimum",
        bool(plain.between(0.5, 2.0).all()),
        f"On a lattice of markers the best ε is {plain.min():.2f} to {plain.max():.2f} times the formula for "
        f"{', '.join(finite['S'].unique())}; {ratio.min():.2f} to {ratio.max():.2f} times if the worst over a range of "
        "ε as wide as h counts, since the error happens to vanish at some ε / h. S8 has no M: there it is "
        f"{at.min():.2f} to {at.max():.2f} h.",
        "The best ε is not within a factor of 2 of the formula: it falls where the lattice error happens to vanish, "
        "and the two terms of (19) have different constants, which the formula leaves out.",
    )


def _in_time(parameters: Mapping[str, Any]) -> Finding:
    found = trace(parameters, "S8", "midpoints")
    steps = [int(np.argmin(np.abs(found.t - t))) for t in parameters["times"]]
    e = found.error[steps]
    spread = np.ptp(found.end.x) / np.ptp(found.x0)
    return statement(
        "M-C3.in_time",
        bool(e[-1] > e[0]),
        f"With S8 from midpoints the mean distance grows {spread:.1f} times, and E goes from {e[0]:.4f} at "
        f"t = {found.t[steps[0]]:g} to {e[-1]:.4f} at t = {found.t[steps[-1]]:g}.",
        "The solution gets wider too, and ε matters less for it: E falls (also in Fig. 16) as long as markers stay "
        "closer than ε.",
    )


# --- positions (M-C4) -----------------------------------------------------------------------------


def _positions(parameters: Mapping[str, Any]) -> pd.DataFrame:
    """The parts of (17): f - F at the exact positions, which keep the mass to their left, and e-hat (18)."""
    grid, rows = fixed_grid(parameters), []
    for shape in parameters["shapes"]:
        for loading in _NEAR:
            x, weights = load(loading, int(parameters["markers"]), int(parameters["seed"]))
            mass = SQUARE.cumulative(x)
            velocity = MarkerVelocity(shape_function(shape), float(parameters["support"]))
            then = 0.0
            for t in map(float, parameters["times"]):
                steps = round((t - then) / float(parameters["dt"]))
                x = run(x, weights, velocity, dt=(t - then) / steps, steps=steps).x
                then = t
                at_exact = velocity.fields(SQUARE.quantile(mass, t), weights, grid)[0]
                f, ours = SQUARE.value(grid, t), velocity.fields(x, weights, grid)[0]
                rows.append(
                    {
                        "S": shape,
                        "loading": loading,
                        "t": t,
                        "representation": np.abs(f - at_exact).max(),
                        "position": np.abs(at_exact - ours).max(),
                        "total": np.abs(f - ours).max(),
                    }
                )
    return pd.DataFrame(rows)


def _position_finding(positions: pd.DataFrame) -> Finding:
    ratio = positions["position"] / positions["representation"]
    by = ratio.groupby([positions["loading"], positions["S"]])
    spelled = "; ".join(
        f"{LOADINGS[loading]}, {shape}: {part.min():.1f} to {part.max():.1f}"
        for (loading, shape), part in by
    )
    return statement(
        "M-C4.position",
        bool((ratio <= _LITTLE).all()),
        f"The largest ê is so many times the largest of the other part over t = {positions['t'].min():g} to "
        f"{positions['t'].max():g}: {spelled}.",
        "The positions are wrong by as much as the representation or more: F, which is smoothed, gives the velocity.",
    )


# --- the denominator (M-C5) -----------------------------------------------------------------------


def _stops(parameters: Mapping[str, Any]) -> list[Trace]:
    """The paper's own run with S8 from random positions, at its time step and at a smaller one."""
    seeds = range(int(parameters["seed"]), int(parameters["seed"]) + int(parameters["seeds"]))
    return [
        trace(
            parameters,
            "S8",
            "random",
            seed,
            dt=dt,
            t_final=float(parameters["watched"]),
            follow=False,
        )
        for dt in (float(parameters["dt"]), float(parameters["small_dt"]))
        for seed in seeds
    ]


def _denominator(parameters: Mapping[str, Any], stops: list[Trace]) -> Finding:
    half = len(stops) // 2
    counts = [sum(found.run is None for found in part) for part in (stops[:half], stops[half:])]
    stopped = next((found.stopped for found in stops[half:] if found.run is None), "")
    example = f' ("{stopped.split(": a velocity")[0]}")' if stopped else ""
    x, weights = uniform(Gaussian().value, (-5.0, 5.0), 100)
    shape = shape_function("S8")
    positive, tail = _first_stop(shape, x, weights), ""
    if positive:
        tail = f" exp(-x²) by 100 uniform markers in [-5, 5], ε = 1: {positive.split(': a velocity')[0]}."  # fmt: skip
    least = math.sqrt(2.5)
    depth = float(-shape(least) / shape(0.0))
    return statement(
        "M-C5.denominator",
        not (any(counts) or positive),
        f"S8 is negative for |x| > sqrt(3/2) ε, {depth:.4f} S(0) deep. With S8 from random positions {counts[0]} of "
        f"{half} runs stop at dt = {float(parameters['dt']):g}, and {counts[1]} at "
        f"dt = {float(parameters['small_dt']):g}{example}.{tail}",
        "W_j S(0) is positive, but the other terms need not be: it holds for S >= 0 only, not for S8.",
    )


def _first_stop(shape: Shape, x: np.ndarray, weights: np.ndarray) -> str:
    try:
        run(x, weights, MarkerVelocity(shape, 1.0), dt=1e-3, steps=1)
    except FieldNotPositive as error:
        return str(error)
    except FracparticlesError:
        raise
    return ""


# --- table and series -----------------------------------------------------------------------------


def _table(
    numbers: pd.DataFrame, law: pd.DataFrame, optimum: pd.DataFrame, positions: pd.DataFrame
) -> pd.DataFrame:
    """One row a measurement: what, shape function, loading, at, ours, predicted or compared with."""
    rows: list[dict[str, Any]] = []
    for row in law.to_dict("records"):
        rows += [
            {"what": "k of (19)", "S": row["S"], "ours": row["k"], "predicted": row["k of the moments"]},
            {"what": "M of (19)", "S": row["S"], "ours": row["M"], "predicted": row["M of the smoothness"]},
        ]  # fmt: skip
    rows += [
        {"what": "best ε", "S": r["S"], "at": f"h = {r['h']:g}", "ours": r["optimum"], "predicted": r["formula"]}
        for r in optimum.to_dict("records")
    ]  # fmt: skip
    rows += [
        {
            "what": "E", "S": r["S"], "loading": LOADINGS[r["loading"]],
            "at": f"{r['N per ε']:.1f} markers per ε", "ours": r["E"],
        }
        for r in numbers.to_dict("records")
    ]  # fmt: skip
    last = positions[positions["t"] == positions["t"].max()]
    for r in last.to_dict("records"):
        at = {"S": r["S"], "loading": LOADINGS[r["loading"]], "at": f"t = {r['t']:g}"}
        rows += [
            {"what": "representation error", **at, "ours": r["representation"]},
            {"what": "position error", **at, "ours": r["position"]},
        ]
    table = pd.DataFrame(rows, columns=["what", "S", "loading", "at", "ours", "predicted"])
    return table.dropna(subset=["ours"])


def _series(
    parameters: Mapping[str, Any], numbers: pd.DataFrame, law: pd.DataFrame, optimum: pd.DataFrame,
    positions: pd.DataFrame, stops: list[Trace],
) -> pd.DataFrame:  # fmt: skip
    """Panels "numbers", "optimum", "formula", "representation", "position" and "denominator"."""
    parts = [
        pd.DataFrame(
            {"panel": panel, "series": frame["S"], "loading": frame.get("loading"), "x": frame[x], "y": frame[y]}
        )
        for panel, frame, x, y in (
            ("numbers", numbers, "N per ε", "E"),
            ("optimum", optimum, "h", "optimum"),
            ("formula", optimum, "h", "formula"),
            ("representation", positions, "t", "representation"),
            ("position", positions, "t", "position"),
        )
    ]  # fmt: skip
    failed = next((found for found in stops if found.run is None), None)
    if failed is not None:
        parts += _last_field(parameters, failed)
    return pd.concat(parts, ignore_index=True)


def _last_field(parameters: Mapping[str, Any], failed: Trace) -> list[pd.DataFrame]:
    """F on a grid, and at the markers, half a step after the last one that a stopped run could take."""
    velocity = MarkerVelocity(shape_function(failed.shape), float(parameters["support"]))
    last: list[tuple[float, np.ndarray]] = []

    def observe(t: float, x: np.ndarray, w: np.ndarray) -> None:
        last[:] = [(t, x)]

    steps = round(float(parameters["watched"]) / failed.dt)
    with contextlib.suppress(FieldNotPositive):
        run(failed.x0, failed.weights, velocity, dt=failed.dt, steps=steps, observe=observe)
    t, x = last[0]
    if (velocity.fields(x, failed.weights)[0] > 0.0).all():
        x = x + 0.5 * failed.dt * velocity(x, failed.weights)
    half = 1.15 * float(np.abs(x).max())
    grid = np.linspace(-half, half, 801)
    return [
        pd.DataFrame({"panel": "denominator", "series": name, "x": at, "y": y, "t": t})
        for name, at, y in (
            ("F", grid, velocity.fields(x, failed.weights, grid)[0]),
            ("markers", x, velocity.fields(x, failed.weights)[0]),
        )
    ]
