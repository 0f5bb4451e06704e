"""Every scheme on a lattice in every variant that the paper has."""

from __future__ import annotations

import pytest

from fracparticles.kernels.families import PAPER_ORDERS
from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES

COMBINATIONS = [
    pytest.param((name, order, exterior), id=f"{name}-{order}-{exterior}")
    for name, scheme in SCHEMES.items()
    for order in scheme.orders
    if order in PAPER_ORDERS
    for exterior in scheme.exteriors
]


def combinations_without(*schemes: str, exterior: str | None = None) -> list:
    """The combinations of the other schemes, with one exterior or all."""
    return [
        parameter
        for parameter in COMBINATIONS
        if parameter.values[0][0] not in schemes
        and parameter.values[0][2] == (exterior or parameter.values[0][2])
    ]


def case_of(combination, beta, overlap, n, **other) -> Case:
    """One of them on 2 n + 1 particles of spacing one; GPSE takes the step that its overlap asks for."""
    scheme, order, exterior = combination
    given = {"integrator": "exponential", **({} if scheme == "FD" else {"overlap": overlap})}
    if scheme == "GPSE":
        step = overlap ** (1.0 + beta)
        given = {"dt": step, "t_final": 0.5 + 2.0 * step}
    given.update(other)
    return Case(
        scheme=scheme,
        order=order,
        exterior=exterior,
        beta=beta,
        half_width=float(n),
        spacing=1.0,
        **given,
    )
