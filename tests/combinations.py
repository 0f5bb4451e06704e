"""Every scheme on a lattice in every variant that the paper has."""

from __future__ import annotations

import pytest

from fracparticles.kernels.families import PAPER_ORDERS
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
