"""What the probes of rough data have in common: a case of each scheme."""

from collections.abc import Iterator
from typing import Any

import numpy as np

import fracparticles as fp
from fracparticles.run.solver import compute
from fracparticles.schemes import ALL_SCHEMES


def case_of(scheme: str, beta: float, **given: Any) -> fp.Case:
    """Return a case of half-width 10, h = 1/4 and T = 1/2, if nothing else is given; GPSE takes it in one step."""
    kind = ALL_SCHEMES[scheme]
    fields: dict[str, Any] = {"half_width": 10.0, "spacing": 0.25, "t_initial": 0.0, "t_final": 0.5}
    fields |= given
    if kind.moving:
        fields.setdefault("dt", (fields["t_final"] - fields["t_initial"]) / 20.0)
    elif kind.self_timed:
        fields.setdefault("dt", fields["t_final"] - fields["t_initial"])
    else:
        fields.setdefault("integrator", "exponential")
    return fp.Case(scheme=scheme, beta=beta, store="metrics", **fields)


def cases_of(beta: float, schemes: list[str], **given: Any) -> Iterator[fp.Case]:
    """Return such a case of each scheme and each of its exteriors."""
    for scheme in schemes:
        for exterior in ALL_SCHEMES[scheme].exteriors:
            yield case_of(scheme, beta, exterior=exterior, **given)


def run(case: fp.Case, u0: Any) -> np.ndarray:
    """Return the final strengths."""
    return compute(case, u0).u


def deviation(u: np.ndarray, exact: np.ndarray) -> float:
    """Return max |u - exact| / max |exact|, without squares or sums that overflow."""
    size = np.abs(exact).max()
    return float(np.abs(u / size - exact / size).max())


def point(case: fp.Case, place: int | None = None) -> np.ndarray:
    """All strength on one particle, the middle one if none is named: 1 / h^n there."""
    u = np.zeros(case.shape)
    u.flat[u.size // 2 if place is None else place] = 1.0 / case.particle_spacing**case.dim
    return u
