"""What every sum over scattered particles has: its kernels, and the checks of its arrays; see `scattered`."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import KERNELS, PAPER_ORDERS, gaussian_reach, kernel
from fracparticles.kernels.high_order import wavenumber_reach

__all__ = [
    "EDGE",
    "GAUSSIAN_BAND",
    "MARGIN",
    "ScatteredKernel",
    "ScatteredSum",
    "checked_kernels",
    "in_range",
    "smooth_kernel",
]

# exp(-k^2/4), in the transform of every kernel with a Gaussian in it, is 2e-16 at k = 12. From order 6 on a polynomial
# multiplies it: see `wavenumber_reach`.
GAUSSIAN_BAND = 12.0
EDGE = 5.5  # erfc(5.5) / 2 < 1e-14: a cut-off is 1 on one side of this, 0 on the other
MARGIN = 1.125  # the box of a set that grew is made so much wider than the set, so that not every step makes it anew
# The largest strength: divided by an epsilon from 1e-100 to 1e100 and summed, they neither overflow nor lose digits.
_ORDINARY = 1e-150, 1e150


@dataclass(frozen=True)
class ScatteredKernel:
    """A kernel of unit smoothing length.

    Raises `InvalidInput` if the profile is not a function, or one of the others not positive.

    Attributes
    ----------
    profile : callable
        K(r) for an array of signed distances.
    bandwidth : float
        Wavenumber beyond which the transform is zero, to round-off, falling like a Gaussian; infinite if there is none.
    reach : float
        Distance beyond which the kernel is zero, to round-off; infinite if there is none.
    """

    profile: Callable[[np.ndarray], np.ndarray]
    bandwidth: float = math.inf
    reach: float = math.inf

    def __post_init__(self) -> None:
        check.function("profile", self.profile)
        for name in ("bandwidth", "reach"):
            value = getattr(self, name)
            if not (isinstance(value, float) and value == math.inf):
                object.__setattr__(self, name, check.real_between(name, value, 0.0, inside=True))


def smooth_kernel(name: str, alpha: float, order: int = 2) -> ScatteredKernel:
    """Return a kernel of `kernels.families` that is a convolution with the Gaussian of its order: all but E.

    Raises `InvalidInput` if the kernel, its order or alpha does not exist, or the kernel is E.
    """
    check.choice("name", name, [n for n in KERNELS if n != "E"])
    order = check.whole_number("order", order, least=1)

    def profile(r: np.ndarray) -> np.ndarray:
        return np.asarray(kernel(name, r, alpha, order=order))

    profile(np.zeros(1))
    reach = gaussian_reach(order) if math.isinf(KERNELS[name].decay(alpha)) else math.inf
    band = GAUSSIAN_BAND if order in PAPER_ORDERS else wavenumber_reach(order)
    return ScatteredKernel(profile, band, reach)


class ScatteredSum(ABC):
    """What every one of the sums offers.

    `accuracy` bounds the error of a field relative to its largest value; 0 if the error of every value is
    relative to its own terms.

    Parameters
    ----------
    kernels : sequence of ScatteredKernel
    epsilon : float
        Smoothing length.
    """

    accuracy = 0.0

    def __init__(self, kernels: Sequence[ScatteredKernel], epsilon: float) -> None:
        self._kernels, self._epsilon = checked_kernels(kernels), check.scale("epsilon", epsilon)

    def __call__(self, x: np.ndarray, q: np.ndarray, z: np.ndarray | None = None) -> np.ndarray:
        """Return y, shape (kernels, M), a new array: the sums at the points z, or at the particles themselves.

        Raises `InvalidInput` if the arrays do not fit together, a position is not finite, the set is too wide, or the
        sums overflow.
        """
        x, q, z, ordinary = _checked(x, q, z)
        out = np.zeros((len(self._kernels), x.size if z is None else z.size))
        if not (x.size and out.size):
            return out
        if ordinary:
            self._add_to(out, x, q, z)
            return out
        q, exponent = in_range(q)
        self._add_to(out, x, q, z)
        with np.errstate(over="ignore"):
            finite: np.ndarray = check.finite_result("q", np.ldexp(out, exponent))
        return finite

    @abstractmethod
    def _add_to(
        self, out: np.ndarray, x: np.ndarray, q: np.ndarray, z: np.ndarray | None
    ) -> None: ...


def checked_kernels(kernels: Any) -> list[ScatteredKernel]:
    """Return one kernel or more as a list. Raises `InvalidInput` for anything else."""
    listed: Any = check.instance("kernels", kernels, (list, tuple), "a list of kernels")
    if not listed:
        raise InvalidInput("kernels", kernels, "one kernel or more", "Give a list of kernels.")
    return [check.instance("kernels", k, ScatteredKernel) for k in listed]


def in_range(q: np.ndarray) -> tuple[np.ndarray, int]:
    """Return strengths of a size about 1, and the power of 2 that makes those given of them: sums stay the same.

    Those of strengths next to the ends of the range of numbers would overflow, or lose their digits on the way.
    """
    exponent = int(np.frexp(np.abs(q).max(initial=0.0))[1])
    return np.ldexp(q, -exponent), exponent


def _checked(x: Any, q: Any, z: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray | None, bool]:
    """The arrays, and whether the sums of these strengths stay within the range of numbers."""
    x = x if _no_larger(x, check.SIZES[1]) else check.positions("x", x, least=0)
    least, most = _ORDINARY
    ordinary = _no_larger(q, most)
    if not (ordinary and q.shape == x.shape):
        q = check.vector("q", q, x.size, least=0)
    ordinary = ordinary and bool(max(q.max(initial=0.0), -q.min(initial=0.0)) >= least)
    if z is not None:
        z = z if _no_larger(z, check.SIZES[1]) else check.positions("z", z, least=0)
        z = np.ascontiguousarray(z)
    return np.ascontiguousarray(x), np.ascontiguousarray(q), z, ordinary


def _no_larger(values: Any, largest: float) -> bool:
    """Whether it is an array of numbers of one dimension that are no larger; a nan is not."""
    return (
        type(values) is np.ndarray
        and values.dtype == np.float64
        and values.ndim == 1
        and (not values.size or bool(-largest <= values.min() and values.max() <= largest))
    )
