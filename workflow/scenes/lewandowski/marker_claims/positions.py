"""The parts of (17): f - F at the exact positions, which keep the mass to their left, and e-hat (18) (M-C4)."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import MarkerVelocity, run, shape_function
from fracstudy.findings import Finding, measured
from scenes.lewandowski.square_profile import LOADINGS, SQUARE, SquareRuns, load


def rows(
    square: SquareRuns, shape: str, loading: str, seed: int, times: list[float]
) -> Iterator[dict[str, Any]]:
    """The two parts at each time."""
    x, weights = load(loading, square.markers, seed)
    mass, z, then = SQUARE.cumulative(x), square.z, 0.0
    velocity = MarkerVelocity(shape_function(shape), square.support)
    for t in times:
        steps = round((t - then) / square.dt)
        x = run(x, weights, velocity, dt=(t - then) / steps, steps=steps).x
        then = t
        at_exact = velocity.fields(SQUARE.quantile(mass, t), weights, z)[0]
        f, ours = SQUARE.value(z, t), velocity.fields(x, weights, z)[0]
        row = {"S": shape, "loading": LOADINGS[loading], "x": t, "at": f"t = {t:g}"}
        whole = {"extent": np.ptp(x), "E": np.linalg.norm(f - ours)}
        yield {"what": "representation error", **row, "ours": np.abs(f - at_exact).max(), **whole}
        yield {"what": "position error", **row, "ours": np.abs(at_exact - ours).max()}


def findings(position: pd.DataFrame, representation: pd.DataFrame) -> Iterator[Finding]:
    """What the paper says of the parts, and of their growth."""
    ratio = position["ours"].to_numpy() / representation["ours"]
    ratio = ratio.groupby([representation["S"], representation["loading"]])
    yield measured("M-C4.position", ratio=dict(ratio.max()), least=dict(ratio.min()))
    parts = dict(iter(representation.groupby(["S", "loading"])))
    extent, ours, whole = (
        {start: part[column].iloc[-1] / part[column].iloc[0] for start, part in parts.items()}
        for column in ("extent", "ours", "E")
    )
    falls = {start: int((np.diff(part["extent"]) <= 0.0).sum()) for start, part in parts.items()}
    yield measured("M-C2.domain", ratio=extent, falls=falls)
    yield measured("M-C3.spreads", ratio=extent)
    times = representation["x"]
    peaks = SQUARE.value(0.0, float(times.min())) / SQUARE.value(0.0, float(times.max()))
    of_peak = {start: float(peaks) * growth for start, growth in ours.items()}
    others = {"errors relative to f(0, t)": {"ratio": of_peak}}
    yield measured("M-C3.in_time", ratio=ours, whole=whole, others=others)
