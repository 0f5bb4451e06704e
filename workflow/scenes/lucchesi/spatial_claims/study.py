"""What Sec. 4.3 concludes from Figs. 3b, 4b and 5b, all beta together, and Sec. 6 of the domain that this takes."""

from collections.abc import Iterator
from functools import partial

import numpy as np
import pandas as pd

from fracparticles.errors import AccuracyWarning
from fracparticles.kernels.families import kernel
from fracstudy.errors import quiet
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.orders import orders_of
from scenes.lucchesi.levels import order_of_runs
from scenes.lucchesi.spacing.study import settled

_FAR = 6.0  # epsilon: what is farther away is not nearby


def study(inputs: Inputs, *, short: float, spacing: list[float], at_beta: float) -> Result:
    """Give the orders and the plateaus of the tables of the three figures.

    The order IV on a `short` domain, a truncation factor C, is computed here at one beta, `at_beta`, between two
    values of the `spacing`.
    """
    table = pd.concat(inputs.tables.values(), ignore_index=True)
    table = table.sort_values("h", ascending=False)
    parts = table.groupby(["scheme", "order", "beta"])
    summary = pd.DataFrame(_summary(part, *key) for key, part in parts)
    return Result(summary, [*_findings(summary, short, spacing, at_beta)])


def _summary(part: pd.DataFrame, scheme: str, order: str, beta: float) -> dict[str, object]:
    finest = part.iloc[-1]
    truncated, exact = finest["error, truncated"], finest["error, truncated, exact in time"]
    return {
        "scheme": scheme,
        "order": order,
        "beta": beta,
        "observed order, open": settled(part, "open"),
        "error at the smallest h": truncated,
        "error, exact in time": exact,
        "error, open exterior, finest h": finest["error, open exterior"],
        "share of the time step": abs(truncated - exact) / truncated,
    }


def _findings(
    summary: pd.DataFrame, short: float, spacing: list[float], beta: float
) -> Iterator[Finding]:
    by_order = summary.set_index(["order", "scheme", "beta"]).sort_index()
    observed = by_order["observed order, open"]
    away = (observed - orders_of(by_order.index)).abs()
    for order, name in ORDERS.items():
        yield measured(f"L-C7.O_h{order}", away=away[name], observed=observed[name])
    yield measured("L-C7.rate", away=away.groupby(["scheme", "order"]).max())
    orders = {s: _order_on(s, short, spacing, beta) for s in ("DD", "FPSE", "KPSE")}
    off, large = {s: abs(p - 4.0) for s, p in orders.items()}, away["IV"].xs(beta, level="beta")
    yield measured("L-C7.large_domain", short=off, large=large, orders=orders, C=short)
    betas = sorted(observed.index.unique("beta"))
    # F and eta^1 are the gradients of kappa and eta, which fall without a turn.
    flux, divergence = (each(partial(_far_share, name), beta=betas) for name in ("kappa", "eta"))
    yield measured("L-C7.passes", flux=flux, divergence=divergence)
    kpse = by_order.loc["IV", "KPSE"]
    yield measured(
        "L-C8.cause",
        share=kpse["share of the time step"],
        gain=kpse["error at the smallest h"] / kpse["error, open exterior, finest h"],
    )


def _far_share(name: str, beta: float) -> float:
    """The share of the gradient of a kernel that falls, order II, beyond 6 epsilon."""
    near, far = np.asarray(kernel(name, np.array([0.0, _FAR]), 1.0 + beta))
    return float(far / near)


def _order_on(scheme: str, truncation: float, spacing: list[float], beta: float) -> float:
    """The observed order of the error (48) at order IV, exact in time, on a truncated lattice."""
    grid = {"scheme": scheme, "order": 4, "beta": beta, "truncation": truncation}
    with quiet(AccuracyWarning):  # of the short domain, which is the point
        return order_of_runs(spacing, integrator="exponential", **grid)
