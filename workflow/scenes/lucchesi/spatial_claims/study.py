"""What Sec. 4.3 concludes from Figs. 3b, 4b and 5b, all beta together, and Sec. 6 of the domain that this takes."""

import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import AccuracyWarning
from fracparticles.kernels.families import kernel
from fracparticles.run.case import Case
from fracparticles.run.orders import observed_order
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute
from fracstudy.findings import Finding, measured
from fracstudy.inputs import ORDERS, Inputs, Result
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
    power = by_order.index.get_level_values("order").map({name: p for p, name in ORDERS.items()})
    observed = by_order["observed order, open"]
    away = (observed - power).abs()
    for order, name in ORDERS.items():
        yield measured(f"L-C7.O_h{order}", away=away[name], observed=observed[name])
    yield measured("L-C7.rate", away=away.groupby(["scheme", "order"]).max())
    orders = {s: _order_on(s, short, spacing, beta) for s in ("DD", "FPSE", "KPSE")}
    yield measured(
        "L-C7.large_domain",
        short={s: abs(p - 4.0) for s, p in orders.items()},
        large=away["IV"].xs(beta, level="beta"),
        orders=orders,
        C=short,
    )
    yield measured("L-C7.passes", **_far_shares(sorted(observed.index.unique("beta"))))
    kpse = by_order.loc["IV", "KPSE"]
    yield measured(
        "L-C8.cause",
        share=kpse["share of the time step"],
        gain=kpse["error at the smallest h"] / kpse["error, open exterior, finest h"],
    )


def _far_shares(betas: list[float]) -> dict[str, Any]:
    """The share of the kernels of FPSE's two sums, F and eta^1, that lies beyond 6 epsilon, order II.

    They are the gradients of kappa and eta, which fall without a turn, so that these give the integrals.
    """

    def share(name: str, beta: float) -> float:
        near, far = np.asarray(kernel(name, np.array([0.0, _FAR]), 1.0 + beta))
        return float(far / near)

    kernels = {"flux": "kappa", "divergence": "eta"}
    return {
        of: {f"beta = {beta:g}": share(name, beta) for beta in betas}
        for of, name in kernels.items()
    }


def _order_on(scheme: str, truncation: float, spacing: list[float], beta: float) -> float:
    """The observed order of the error (48) at order IV, exact in time, on a truncated lattice."""
    grid = {"scheme": scheme, "order": 4, "beta": beta, "truncation": truncation}
    cases = [Case(**grid, spacing=h, integrator="exponential") for h in spacing]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # of the short domain, which is the point
        errors = [relative_l1_error(case, compute(case).u) for case in cases]
    return float(observed_order(np.array([case.particle_spacing for case in cases]), errors)[0])
