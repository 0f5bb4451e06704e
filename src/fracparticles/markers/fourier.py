r"""The marker velocity of S8 with its sums by non-uniform Fourier transforms, O(N log N).

The transform of the m-th derivative of S8, k^m (1 + k^2/4) exp(-k^2/4), is zero to round-off beyond k = 12.5.
F is accurate relative to its maximum (1e-11), not relative to its own terms as in the sum over neighbours: no marker
may lie where F is below that.
"""

from __future__ import annotations

from fracparticles.markers.shapes import SHAPES
from fracparticles.markers.solver import Flux, MarkerVelocity, diffusion
from fracparticles.moving.scattered import NonuniformFourierSum, ScatteredKernel

__all__ = ["FourierMarkerVelocity"]

_BAND = 12.5


class FourierMarkerVelocity(MarkerVelocity):
    """V(x_j) = flux / F for S8; parameters, results and errors as in `MarkerVelocity`."""

    def __init__(self, epsilon: float, flux: Flux = diffusion, derivatives: int = 1) -> None:
        shape = SHAPES["S8"]
        super().__init__(shape, epsilon, flux, derivatives)
        profiles = [shape.kernel(m).profile for m in range(derivatives + 1)]
        kernels = [ScatteredKernel(profile, bandwidth=_BAND) for profile in profiles]
        self._sums = NonuniformFourierSum(kernels, self.epsilon)

    def field_alone(self, epsilon: float) -> FourierMarkerVelocity:
        """See `MarkerVelocity`."""
        return FourierMarkerVelocity(epsilon, self.flux, 0)
