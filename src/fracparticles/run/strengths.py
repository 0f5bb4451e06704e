"""The strengths of DVM's particles on the lattice, since Eqs. (48), (49) need values on common points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fracparticles.moving.remeshing import remesh
from fracparticles.moving.tail import TailModel

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["lattice_strengths"]


def lattice_strengths(run: xr.Dataset, name: str | None = None) -> np.ndarray:
    """Return U_p / h on the lattice x of a run, shape (N,), after one last remeshing of its particles.

    The field (7), which the run holds as u, is the other way to have values on common points.

    Parameters
    ----------
    run : Dataset
        A run of DVM that stores its field.
    name : str, optional
        Interpolation function; the run's own if left out.

    Raises
    ------
    InvalidInput
        If there is no such function: a run without remeshing has none of its own.
    """
    h, x = float(run["particle_spacing"]), run["x"].values
    wanted = str(run["remeshing"].values) if name is None else name
    particles = run["particle_position"].values, run["particle_strength"].values
    if str(run["exterior"].values) == "open":
        # Particles beyond the ends contribute to the outermost lattice points.
        beyond = TailModel(1.0 + float(run["beta"]), float(run["overlap"]) * h)
        particles = beyond.continued(*particles)
    z, strength = remesh(*particles, h, wanted)
    total = np.zeros(x.size)
    place = np.rint((z - x[0]) / h).astype(int)
    inside = (place >= 0) & (place < x.size)
    total[place[inside]] = strength[inside]
    return total / h
