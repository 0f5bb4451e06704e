"""The studies: from run files to tables and findings. A scene of `config/study.yaml` names the one it uses.

A study is a function of `Inputs` that returns a `Result`. It imports what it needs when it is called, so that a
scene pays for nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from fracparticles.errors import InvalidInput
from fracstudy.inputs import Inputs, Result, statement, value

__all__ = ["OWN_PARAMETERS", "STUDIES", "Inputs", "Result", "statement", "study", "value"]

# Name in the configuration -> module of this package; the function has the name of the study.
STUDIES = {
    "methods": "methods",
    "self_convergence": "self_convergence",
    "stability": "stability",
    "mean_radius": "fundamental",
    "kernels": "kernels",
    "reference_case": "reference_case",
    "truncation": "truncation",
    "truncation_claims": "truncation",
    "spacing": "spacing",
    "spacing_claims": "spacing",
    "expansions": "fundamental",
    "fundamental_solution": "fundamental",
    "overlap": "overlap",
    "time_order": "time_order",
    "rejected_dpse": "rejected_dpse",
    "rejected_29": "rejected_29",
    "rejected_riesz": "rejected_riesz",
    "fickian_limit": "fickian",
    "conservation": "conservation",
    "stiff_extreme": "extreme",
    "dvm_particles": "dvm",
    "dvm_remeshing": "dvm_remeshing",
    "dvm_stability": "dvm_stability",
    "random_walk": "random_walk",
    "sph_spline": "sph_spline",
    "sph_operator": "sph",
    "sph_closed_forms": "sph_closed_forms",
    "sph_readings": "sph_readings",
    "sph_convergence": "sph_convergence",
    "note_particles": "pse_note",
    "note_kernels": "pse_note",
    "note_lattice_kernel": "pse_note_lattice",
    "note_error_law": "pse_note_law",
    "note_conservation": "pse_note_conservation",
    "planar_green": "two_dimensional_green",
    "planar_operators": "two_dimensional_operators",
    "planar_profiles": "two_dimensional_profiles",
    "planar_map": "two_dimensions",
    "planar_errors": "two_dimensional_errors",
    "planar_orders": "two_dimensional_orders",
    "planar_mass": "two_dimensional_mass",
    "planar_tables": "two_dimensional_tables",
    "three_dimensions": "three_dimensions",
    "marker_shapes": "marker_shapes",
    "marker_loading": "marker_loading",
    "marker_square": "marker_square",
    "marker_fixed_grid": "marker_clusters",
    "marker_moving_grid": "marker_clusters",
    "marker_error_norm": "marker_clusters",
    "marker_growth": "marker_growth",
    "marker_claims": "marker_claims",
    "marker_nonlinear": "marker_nonlinear",
    "marker_velocities": "marker_velocities",
    "marker_plane": "marker_plane",
    "kernel_orders": "kernel_orders",
    "work_precision": "work_precision",
    "time_to_accuracy": "work_precision",
    "which_method": "which_method",
    "run_time_goals": "which_method",
    "time_integration": "time_integration",
    "time_spent": "time_spent",
    "cost_growth": "cost_growth",
    "reference_times": "run_times",
    "scattered_sums": "run_times",
}

# Parameters that are the study's own although they have the name of a field of a run: by study.
OWN_PARAMETERS = {
    "random_walk": ("dt",),  # the steps of the walkers
    "rejected_riesz": ("half_width", "spacing", "overlap"),  # of the sums that it does itself
}


def study(name: str) -> Callable[[Inputs], Result]:
    """Return the study of that name.

    Raises
    ------
    InvalidInput
        If there is none.
    """
    if name not in STUDIES:
        raise InvalidInput("study", name, f"one of {', '.join(STUDIES)}", "Choose one of these.")
    return getattr(import_module(f"{__name__}.{STUDIES[name]}"), name)
