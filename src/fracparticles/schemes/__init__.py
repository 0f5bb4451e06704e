"""The particle schemes: one module each, with the formula, the operator and the Fourier symbol.

A scheme module offers what `base.Scheme` lists. On a lattice x_i = i h all schemes have the form

    du_i/dt = (D / h^alpha) sum_j a_{i-j} u_j + boundary terms,

with weights a_m that depend on alpha, the order and the overlap s = epsilon / h alone. Its Fourier symbol is
A(theta) = (D / h^alpha) symbol(theta), theta = k h. The particles of DVM move: it has neither operator nor symbol.
"""

from __future__ import annotations

from fracparticles.errors import InvalidInput
from fracparticles.schemes import dd, dpse, dvm, fd, fpse, gpse, kpse, pse29, riesz
from fracparticles.schemes.base import Method, Scheme, Setting

__all__ = ["METHODS", "SCHEMES", "Method", "Scheme", "Setting", "scheme"]

SCHEMES: dict[str, Scheme] = {
    module.NAME: module for module in (dd, dpse, fpse, kpse, gpse, fd, pse29, riesz)
}

METHODS: dict[str, Method] = {**SCHEMES, dvm.NAME: dvm}


def scheme(name: str) -> Scheme:
    """Return the scheme of that name, one with an operator on a lattice.

    Raises
    ------
    InvalidInput
        If there is none.
    """
    try:
        return SCHEMES[name]
    except (KeyError, TypeError):
        raise InvalidInput(
            "scheme", name, f"one of {', '.join(SCHEMES)}", "Choose one of these names."
        ) from None
