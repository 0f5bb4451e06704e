"""The limit of Eqs. (54)-(56): what grows beyond it, what does not below it, and who says so."""

from itertools import product

import numpy as np

from fracparticles.schemes.stability import stability_limit
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import frame, probes_of
from scenes.extremes.stability_limit import amplification, growth, limits, normality

SHOWN = tuple(product(("DD", "FPSE", "KPSE"), (2, 4, 8)))


def study(
    inputs: Inputs,
    *,
    half: int,
    overlaps: list[float],
    orders: list[int],
    factors: list[float],
    map_betas: list[float],
    map_overlaps: list[float],
) -> Result:
    """One row a probe; lattices have 2 `half` + 1 particles, steps are `factors` times the limit.

    For the figure, the limit on a grid of `map_betas` and `map_overlaps`, and the growth per step, measured and
    predicted.
    """
    measured = amplification.measured(half, overlaps, orders, factors)
    given = {"measured": measured, "half": half, "factors": factors}
    modules = (amplification, growth, limits, normality)
    probes = probes_of(*modules, orders=orders, overlaps=overlaps, **given)
    panels = Panels()
    for scheme, order in SHOWN:
        for beta in map_betas:
            a = [stability_limit(scheme, beta, order, s) for s in map_overlaps]
            panels.add("map", f"{scheme} {order}", map_overlaps, np.array(a), beta=beta)
    for (factor, integrator), part in measured.groupby(["factor", "integrator"]):
        more = {"factor": factor, "beta": np.nan}
        panels.add("growth", integrator, part["predicted"], part["measured"].to_numpy(), **more)
    return Result(frame(probes), (), panels.frame)
