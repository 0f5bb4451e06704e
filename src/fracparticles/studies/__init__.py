"""The studies: from run files to tables and findings. A scene of `config/study.yaml` names the one it uses.

A study is a function of `Inputs` that returns a `Result`. It imports what it needs when it is called, so that a
scene pays for nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from fracparticles.errors import InvalidInput
from fracparticles.studies.common import Inputs, Result, statement, value

__all__ = ["STUDIES", "Inputs", "Result", "statement", "study", "value"]

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
    "rejected_dpse": "rejected",
    "rejected_29": "rejected",
    "rejected_riesz": "rejected",
    "fickian_limit": "fickian",
    "conservation": "conservation",
    "stiff_extreme": "extreme",
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
