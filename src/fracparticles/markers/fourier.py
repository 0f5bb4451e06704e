r"""The marker velocity of S8 with its sums by non-uniform Fourier transforms, O(N log N).

The transform of the m-th derivative of S8, k^m (1 + k^2/4) exp(-k^2/4), is zero to round-off beyond k = 12.5.
F is accurate relative to its maximum (1e-11), not to its own terms as in the sum over neighbours: a marker must not
lie where F is less.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles.markers.shapes import SHAPES
from fracparticles.markers.solver import Flux, MarkerVelocity, diffusion
from fracparticles.moving.lagrangian import quotient_velocity
from fracparticles.moving.scattered import NonuniformFourierSum, ScatteredKernel

__all__ = ["FourierMarkerVelocity"]

_BAND = 12.5


class FourierMarkerVelocity(MarkerVelocity):
    """V(x_j) = flux / F for S8; parameters, results and errors as in `MarkerVelocity`."""

    def __init__(self, epsilon: float, flux: Flux = diffusion, derivatives: int = 1) -> None:
        shape = SHAPES["S8"]
        super().__init__(shape, epsilon, flux, derivatives)
        kernels = [
            ScatteredKernel(shape.kernel(m).profile, bandwidth=_BAND)
            for m in range(derivatives + 1)
        ]
        self._transforms = NonuniformFourierSum(kernels, self.epsilon)

    def fields(self, x: Any, weights: Any, z: Any = None) -> np.ndarray:
        """Return F and its derivatives, shape (derivatives + 1, M), at z or at the markers themselves."""
        return self._scale * self._transforms(x, weights, z)

    def __call__(self, x: Any, weights: Any) -> np.ndarray:
        """Return V at the markers.

        Raises
        ------
        InvalidInput
            As `fields`; or if there are no markers.
        FieldNotPositive
            If F is not positive at a marker, above its accuracy.
        """
        fields = self.fields(x, weights)
        return quotient_velocity(self.flux(x, fields), fields[0], x, self._transforms.accuracy)
