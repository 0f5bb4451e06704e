"""The order of a scheme between two lattices that are computed here, not in runs."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from fracparticles.run.case import Case
from fracparticles.run.orders import observed_order
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute


def order_of_runs(spacing: Sequence[float] | np.ndarray, **grid: Any) -> float:
    """Return the observed order of the error (48) of a case between the first two of its spacings."""
    cases = [Case(**grid, spacing=h) for h in spacing]
    errors = [relative_l1_error(case, compute(case).u) for case in cases]
    return float(observed_order([case.particle_spacing for case in cases], errors)[0])
