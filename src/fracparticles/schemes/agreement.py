r"""A check that the weights and the transform of a scheme agree. If not, its operator and its symbol are two schemes.

On the infinite lattice

    A(theta) = a_0 + 2 sum_(m > 0) a_m cos(m theta).

Beyond M the weights fall steadily, so that a sum of M terms leaves out at most 2 |a_M| / sin(theta / 2) (Abel). The
kernels of the library have both from one formula. A scheme with its own kernel is checked once for each setting.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.schemes.setting import Setting

__all__ = ["refuse_disagreement"]

Function = Callable[[np.ndarray, Setting], np.ndarray]

_WAVES = np.array([1.0, 2.0, 3.0])  # theta at which the two are compared
_TERMS = 2**11  # M
_WIDEST = 40.0  # overlap up to which M lies in the tail of the kernel
_TOLERANCE = 1e-6  # of the difference, as a share of the sum of |a_m|


def refuse_disagreement(
    name: str, weights: Function, transform: Function, setting: Setting
) -> None:
    """Refuse a scheme on the line whose weights do not have its transform, see the module.

    Raises
    ------
    InvalidInput
        If the two disagree, or if the weights are not finite numbers.
    """
    if setting.dim > 1 or setting.overlap > _WIDEST:
        return
    kernel = Setting(alpha=setting.alpha, overlap=setting.overlap, **setting.kernels)
    _compare(name, weights, transform, kernel)


@lru_cache(maxsize=64)
def _compare(name: str, weights: Function, transform: Function, kernel: Setting) -> None:
    m = np.arange(_TERMS + 1.0)
    each = "a weight for each offset"
    with np.errstate(all="ignore"):
        a = check.of_shape(
            "weights", check.finite_array("weights", weights(m, kernel)), m.shape, each
        )
        claimed = check.finite_array("transform", transform(_WAVES, kernel))
    each = "a value for each wave"
    claimed = check.of_shape("transform", claimed, _WAVES.shape, each)
    sums = a[0] + 2.0 * np.cos(np.outer(_WAVES, m[1:-1])) @ a[1:-1]
    left_out = 2.0 * np.abs(a[-1]) / np.sin(0.5 * _WAVES)
    off = np.abs(sums - claimed) - left_out - _TOLERANCE * (2.0 * np.abs(a).sum() - np.abs(a[0]))
    if (off > 0.0).any():
        worst = int(off.argmax())
        allowed = (
            f"a scheme whose weights have its transform, and at theta = {_WAVES[worst]:g} they sum to "
            f"{sums[worst]:.6g} where it says {claimed[worst]:.6g}"
        )
        raise InvalidInput("scheme", name, allowed, "Mend its values or its transform.")
