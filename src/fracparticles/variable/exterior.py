"""The region beyond the lattice, where the tail of the solution need not be that of a constant operator.

u_j = a_1 (n / |j|)^p + .. is continued as in `lattice.exterior` and `lattice.exterior_box`, with a separate exponent
p at either end of the line: a solution of variable order falls like |x|^(-1-alpha) with the local alpha. In the plane,
the flux gains for each mode of the continuation a sum over a lattice four times as wide. The region beyond it is left
out: its contribution is 4^(-2 p) of that of the modes, up to a constant.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fracparticles.arguments import pair, real_between
from fracparticles.errors import InvalidInput
from fracparticles.lattice.exterior import LineFarField, far_field
from fracparticles.lattice.sums import BOX_SUMMATIONS
from fracparticles.schemes.setting import Setting

__all__ = ["PlaneGradientFarField", "line_far_field", "tails_of"]

Tails = tuple[float, float]

_WIDER = 4  # half-widths up to which the modes of the far field are summed


def tails_of(setting: Setting, tail: object, default: Tails) -> Tails:
    """Return the exponents p of the tail at the left and the right end; one number stands for both.

    Raises
    ------
    InvalidInput
        If an exponent is not between n and n + 6, n the dimension; if the exterior is truncated; or if the two differ
        in the plane.
    """
    if tail is None:
        return default
    if not setting.is_open:
        raise InvalidInput(
            "tail", tail, "nothing for exterior='truncated'", "Leave it out, or open the exterior."
        )
    given = (tail, tail) if np.ndim(tail) == 0 else pair("tail", tail)  # type: ignore[arg-type]
    dim = float(setting.dim)
    left, right = (real_between("tail", one, dim, dim + 6.0, inside=True) for one in given)
    if setting.dim > 1 and left != right:
        raise InvalidInput("tail", tail, "one number in the plane", "Give one exponent.")
    return left, right


def line_far_field(
    weight: Callable[[np.ndarray], np.ndarray],
    decay: float,
    setting: Setting,
    tails: Tails,
    parity: int = 1,
    pad: int = 0,
) -> LineFarField:
    """Return the exterior sums on the line, see `lattice.exterior.far_field`, each end with its own tail."""
    left, right = (
        far_field(weight, decay, p - 1.0, setting.n, parity, pad, setting.far_terms) for p in tails
    )
    return LineFarField(right.depth, right.right, left.left)


class PlaneGradientFarField:
    """The part of the exterior of a square in a sum with an odd vector kernel, sum_k a_k S_k with a = fit u_boundary.

    Parameters
    ----------
    weights : callable
        From a number of offsets 0 .. M - 1 to the weights of each component, a list of arrays of shape (M, M).
    setting : Setting
        A setting in the plane.
    pad : int
        The number of points beyond the faces at which the sum is wanted.
    tail : float
        p of u ~ |x|^-p.

    Raises
    ------
    InvalidInput
        If the lattice is a single particle.
    """

    def __init__(
        self, weights: Callable[[int], list[np.ndarray]], setting: Setting, pad: int, tail: float
    ) -> None:
        n, dim = setting.n, setting.dim
        if n < 1:
            raise InvalidInput(
                "n", n, "at least 1", "Take more particles, or exterior='truncated'."
            )
        wide, targets = max(_WIDER * n, n + 2 * pad), setting.size + 2 * pad
        line = np.arange(-wide, wide + 1.0) / n
        j = np.meshgrid(*(line,) * dim, indexing="ij", sparse=True)
        square = np.asarray(sum(np.square(part) for part in j))
        square[(wide,) * dim] = np.inf
        first = square ** (-0.5 * tail)
        within = (slice(wide - n, wide + n + 1),) * dim
        faces = np.ones(setting.shape, dtype=bool)
        faces[(slice(1, -1),) * dim] = False
        self._boundary = np.flatnonzero(faces)
        convolve = BOX_SUMMATIONS["fft"](
            weights(wide + n + pad + 1), range(dim), 2 * wide + 1, targets
        )
        edge = np.empty((dim + 2, self._boundary.size))
        self._sums = np.empty((dim + 2, dim, *(targets,) * dim))
        factors = [1.0, square ** (0.5 * (dim - tail)), *(part / square for part in j)]
        for k, factor in enumerate(factors):
            mode = first * factor
            edge[k] = mode[within].reshape(-1)[self._boundary]
            mode[within] = 0.0
            self._sums[k] = convolve(mode)
        self._fit = np.linalg.solve(edge @ edge.T, edge)

    def add(self, u: np.ndarray, y: np.ndarray) -> None:
        """Add the contribution of the exterior to y, shape (components, points, points)."""
        amplitudes = self._fit @ u.reshape(-1)[self._boundary]
        y += np.tensordot(amplitudes, self._sums, 1)
