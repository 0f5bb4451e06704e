"""The two-dimensional problem of Sec. 5: what its scenes share."""

import netCDF4
import numpy as np
import pandas as pd

from fracstudy.style import Axes, log_log, name_ticks

DISC = 5.0  # radius of the disc of (59)


def particles_per_side(runs: pd.DataFrame) -> pd.Series:
    """Return N, the number of particles along a side, of each run."""
    return (2.0 * runs["half_width"] / runs["particle_spacing"]).round().astype(int) + 1


def stored_field(run: str) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Return x along an axis, |x| and the strengths at all particles of a run, None if it does not store them."""
    with netCDF4.Dataset(run) as file:
        if "u" not in file.variables:
            return None
        x, u = np.asarray(file["x"][:]), np.asarray(file["u"][:])
    return x, np.abs(x) if u.ndim == 1 else np.hypot(x[:, None], x[None, :]), u


def spacing_axes(ax: Axes, h: pd.Series) -> None:
    """Make both axes logarithmic, with the particle spacing on x and a tick at each of its values."""
    log_log(ax, xlabel="particle spacing $h$", xlim=(h.min() / 1.25, h.max() * 1.25))
    name_ticks(ax, sorted(h.unique()), form=".3f")
    ax.minorticks_off()
