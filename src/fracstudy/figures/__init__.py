"""The figures: from a scene's series to axes. A scene of `config/study.yaml` names the one it uses.

A figure is a function of the scene's series, its table and its parameters that returns a matplotlib Figure.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any

from fracparticles.errors import InvalidInput

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["FIGURES", "figure"]

Drawing = Callable[["pd.DataFrame", "pd.DataFrame", dict[str, Any]], "Figure"]

# Name in the configuration -> module of this package; the function has the name of the figure.
FIGURES = {
    "kernels": "kernels",
    "reference_case": "reference_case",
    "truncation": "errors",
    "spacing": "errors",
    "truncation_overview": "errors",
    "stability": "stability",
    "expansions": "fundamental",
    "fundamental_solution": "fundamental",
    "overlap": "overlap",
    "time_order": "time_order",
    "rejected_dpse": "rejected",
    "rejected_29": "rejected",
    "rejected_riesz": "rejected",
    "fickian_limit": "fickian",
    "conservation": "conservation",
    "stiff_extreme": "extreme",
    "dvm_particles": "dvm",
    "dvm_remeshing": "dvm",
    "dvm_stability": "dvm",
    "random_walk": "random_walk",
    "sph_spline": "sph",
    "sph_operator": "sph",
    "sph_convergence": "sph",
    "note_particles": "pse_note",
    "note_kernels": "pse_note",
    "note_lattice_kernel": "pse_note",
    "note_error_law": "pse_note",
    "note_conservation": "pse_note",
    "planar_green": "two_dimensions",
    "planar_operators": "two_dimensions",
    "planar_profiles": "two_dimensions",
    "planar_map": "two_dimensional_map",
    "planar_errors": "two_dimensional_errors",
    "planar_tables": "two_dimensional_errors",
    "three_dimensions": "three_dimensions",
    "marker_shapes": "marker_initial",
    "marker_loading": "marker_initial",
    "marker_square": "marker_diffusion",
    "marker_fixed_grid": "marker_diffusion",
    "marker_moving_grid": "marker_diffusion",
    "marker_error_norm": "marker_diffusion",
    "marker_growth": "marker_diffusion",
    "marker_claims": "marker_diffusion",
    "marker_nonlinear": "marker_nonlinear",
    "marker_velocities": "marker_velocities",
    "marker_plane": "marker_plane",
    "kernel_orders": "kernel_orders",
    "work_precision": "work_precision",
    "time_to_accuracy": "work_precision",
    "time_integration": "time_integration",
    "time_spent": "time_spent",
    "cost_growth": "cost_growth",
}


def figure(name: str) -> Drawing:
    """Return the drawing function of that name.

    Raises
    ------
    InvalidInput
        If there is none.
    """
    if name not in FIGURES:
        raise InvalidInput("figure", name, f"one of {', '.join(FIGURES)}", "Choose one of these.")
    return getattr(import_module(f"{__name__}.{FIGURES[name]}"), name)
