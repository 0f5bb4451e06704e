"""The parameters of a scheme on a lattice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.kernels.families import kernel
from fracparticles.kernels.tabulated import tabulated
from fracparticles.lattice.sums import SUMMATIONS

__all__ = ["Setting"]


_CHECKS: dict[str, Callable[[str, Any], Any]] = {
    "alpha": lambda _, alpha: check.fractional_order(alpha),
    "order": check.positive_integer,
    "overlap": check.scale,
    "dim": lambda _, dim: check.dimension(dim),
    "n": check.whole_number,
    "spacing": check.scale,
    "diffusivity": check.scale,
    "summation": partial(check.choice, names=tuple(SUMMATIONS)),
    "exterior": partial(check.choice, names=("truncated", "open")),
    "far_terms": partial(check.whole_number, least=1, most=3),
}


@dataclass(frozen=True, kw_only=True)
class Setting:
    """One scheme on one lattice x_i = i h, i = -n .. n in each of `dim` coordinates.

    A Fourier symbol is that of the infinite lattice and depends only on the first five attributes.

    Raises `InvalidInput` if a value is not allowed. `Scheme.check` tells whether a scheme exists for the setting.

    Attributes
    ----------
    alpha : float
        Fractional order, alpha = 1 + beta.
    order : {2, 4, 6, 8, 10, 12}
        Order of the kernels.
    overlap : float
        s = epsilon / h.
    dim : {1, 2, 3}
        Space dimension.
    family : {"printed", "gamma"}, optional
        Family of the kernels, see `kernels.kernel`.
    n : int
        Half the number of lattice intervals; there are N = 2 n + 1 particles in each direction.
    spacing : float
        Particle spacing h; the particle volume is h^dim.
    diffusivity : float
        D of Eq. (2).
    summation : {"fft", "naive"}
        See `lattice.sums`.
    exterior : {"truncated", "open"}
        See `lattice.exterior`.
    far_terms : {1, 2, 3}
        Number of terms that continue the solution in an open exterior, for dim = 1.
    kernel_table : float, optional
        Step, in units of epsilon, of the table in which the kernels are interpolated; left out, the kernels are exact.
    """

    alpha: float
    order: int = 2
    overlap: float = 2.0
    dim: int = 1
    family: str | None = None
    n: int = 0
    spacing: float = 1.0
    diffusivity: float = 1.0
    summation: str = "fft"
    exterior: str = "truncated"
    far_terms: int = 1
    kernel_table: float | None = None

    def __post_init__(self) -> None:
        check.fields(self, **_CHECKS)

    @property
    def size(self) -> int:
        """The number N of particles in each direction."""
        return 2 * self.n + 1

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the lattice."""
        return (self.size,) * self.dim

    @property
    def x(self) -> np.ndarray:
        """The coordinates of the particles along an axis, shape (N,)."""
        return np.arange(-self.n, self.n + 1) * self.spacing

    @property
    def positions(self) -> list[np.ndarray]:
        """The coordinates of the particles, `dim` arrays that broadcast to `shape`."""
        return list(np.meshgrid(*(self.x,) * self.dim, indexing="ij", sparse=True))

    @property
    def is_open(self) -> bool:
        """Whether the solution continues beyond the lattice."""
        return self.exterior == "open"

    @property
    def rate(self) -> float:
        """D / h^alpha, the unit of the operator."""
        return self.diffusivity / self.spacing**self.alpha

    @property
    def kernels(self) -> dict[str, Any]:
        """The kernels, as arguments of `kernels.kernel`."""
        return {"dim": self.dim, "order": self.order, "family": self.family}

    def kernel(self, name: str, r: np.ndarray) -> np.ndarray:
        """Return the values of a kernel, exact or interpolated, at distances in units of epsilon."""
        if self.kernel_table is None:
            return np.asarray(kernel(name, r, self.alpha, **self.kernels))
        table = tabulated(self.kernel_table, self.family)
        return np.asarray(table(name, r, self.alpha, dim=self.dim, order=self.order))
