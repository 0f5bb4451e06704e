"""The fractional orders next to 1 and to 2: densities, kernels, schemes and runs against their limits and mpmath."""

import numpy as np

from fracparticles.special import reduced_green
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import frame, probes_of
from scenes.extremes.ends_of_alpha import densities, kernels, runs, schemes
from scenes.extremes.ends_of_alpha.references import distance

_SHOWN = ("density", "rate", "tail mass")


def study(
    inputs: Inputs, *, betas: list[float], radii: list[float], orders: list[int], dims: list[int]
) -> Result:
    """One row a probe. The series are the relative errors against the distance to the end, a line a function.

    beta as given is not beta as used: alpha = 1 + beta is a double, a multiple of 2.2e-16. All references take alpha as
    the double that it is.
    """
    near = [beta for beta in betas if distance(beta) < 1e-4]
    given = {"betas": betas, "near": near, "radii": radii}
    probes = probes_of(densities, kernels, schemes, runs, orders=orders, dims=dims, **given)
    # The worst of one to three dimensions at r = 1.1; of kernels the worst of orders, families and radii.
    panels, forms = Panels(), kernels.forms_of(orders)
    for beta in betas:
        alpha, panel = 1.0 + beta, "one" if beta < 0.5 else "two"
        limit = float(runs.closed(np.ones(1), 1.0, beta, 1)[0])
        errors = {
            name: max(densities.errors(name, n, alpha, [1.1]) for n in (1, 2, 3)) for name in _SHOWN
        }
        errors |= {
            name: max(kernels.worst(name, beta, 1, form) for form in forms)
            for name in ("K", "G", "kappa")
        }
        errors["limit"] = abs(float(reduced_green(1.0, alpha)) / limit - 1.0)
        errors["evolve"] = runs.evolved(beta, 1, 1)
        for name, error in errors.items():
            panels.add(panel, name, distance(beta), max(error, 1e-17))
    series = panels.frame.sort_values(["panel", "series", "x"], ignore_index=True)
    return Result(frame(probes), (), series)
