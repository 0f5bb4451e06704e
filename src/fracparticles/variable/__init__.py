"""Operators on the lattice whose diffusivity or whose order varies in space.

`VariableDiffusivity` is div(D(x, t) grad^beta u), `VariableOrder` is -D (-Laplacian)^(alpha(x)/2) u.
"""

from __future__ import annotations

from fracparticles.variable.diffusivity import FORMS, VariableDiffusivity
from fracparticles.variable.order import VariableOrder

__all__ = ["FORMS", "VariableDiffusivity", "VariableOrder"]
