"""The particle schemes: one module each, with the formula, the weights and the Fourier symbol.

A scheme is one class in a module: a `Sum` or an `Exchange`, which only provides its kernel; a `LatticeScheme` with
its own operator and symbol; or a `Scheme` whose particles move. It is found by its file, see `discovery`.
"""

from __future__ import annotations

from fracparticles.schemes.base import Exchange, LatticeScheme, Scheme, Sum
from fracparticles.schemes.discovery import all_schemes, scheme
from fracparticles.schemes.setting import Setting

__all__ = [
    "ALL_SCHEMES",
    "SCHEMES",
    "Exchange",
    "LatticeScheme",
    "Scheme",
    "Setting",
    "Sum",
    "scheme",
]

ALL_SCHEMES: dict[str, Scheme] = all_schemes()

# The schemes that have an operator on a lattice.
SCHEMES: dict[str, LatticeScheme] = {
    name: one for name, one in ALL_SCHEMES.items() if isinstance(one, LatticeScheme)
}
