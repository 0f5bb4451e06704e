"""How accurate our evaluation of the fundamental solution is, and scipy's."""

import numpy as np
import pandas as pd

from fracparticles.special import reduced_green
from fracstudy.errors import power_of_ten
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels


def study(inputs: Inputs, *, reference: str) -> Result:
    """Compare `reduced_green` and scipy's `levy_stable` with reference values of 25 digits.

    `reference` is a CSV file with alpha, x and density; tools/make_stable_reference.py writes it. Their run times
    are those of the scene `special_functions`.
    """
    from scipy.stats import levy_stable

    rows, panels = [], Panels()
    for alpha, points in pd.read_csv(reference).groupby("alpha"):
        x, exact = points["x"].to_numpy(), points["density"].to_numpy()
        ours = np.abs(reduced_green(x, alpha) / exact - 1.0)
        theirs = np.abs(levy_stable.pdf(x, alpha, 0.0) / exact - 1.0)
        row = {
            "alpha": alpha,
            "points": x.size,
            "ours, error below": power_of_ten(ours.max()),
            "scipy, largest error": theirs.max(),
            "scipy's, at x": x[theirs.argmax()],
            "scipy, median error": np.median(theirs),
        }
        rows.append(row)
        for name, error in (("ours", ours), ("scipy", theirs)):
            panels.add(alpha=alpha, series=name, x=x, y=error)
    return Result(pd.DataFrame(rows), series=panels.frame)
