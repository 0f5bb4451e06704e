r"""The velocity of the diffusion velocity method, Eqs. (44), (45), (19), from the particles: see `dvm`."""

from __future__ import annotations

import numpy as np

from fracparticles.arguments import choice, fractional_order, scale
from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import kernel_transform
from fracparticles.moving.lagrangian import MIDPOINT_LIMIT, quotient_velocity
from fracparticles.moving.scattered import scattered_sum, smooth_kernel
from fracparticles.moving.tail import REACH, TailModel

__all__ = ["EXTERIORS", "DiffusionVelocity"]

EXTERIORS = ("truncated", "open")
_WAVENUMBERS = np.linspace(0.0, 12.0, 2401)


class DiffusionVelocity:
    """v(x_i) of Eq. (44).

    Parameters
    ----------
    alpha : float
        Fractional order, alpha = 1 + beta.
    order : {2, 4}
        Order of the kernels.
    epsilon : float
        Smoothing length.
    diffusivity : float
        D of Eq. (2).
    summation : {"fft", "naive"}
        See `moving.scattered`.
    exterior : {"truncated", "open"}
        Nothing beyond the end particles, or their far field, see `moving.tail`.
    """

    def __init__(
        self,
        alpha: float,
        order: int,
        epsilon: float,
        diffusivity: float = 1.0,
        summation: str = "fft",
        exterior: str = "truncated",
    ) -> None:
        self.alpha, self.order = fractional_order(alpha), order
        self.epsilon = scale("epsilon", epsilon)
        self.diffusivity = scale("diffusivity", diffusivity)
        kernels = [smooth_kernel(name, alpha, order) for name in ("eta", "F")]
        self._sums = scattered_sum(summation, kernels, epsilon)
        self.tail: TailModel | None = None
        if choice("exterior", exterior, EXTERIORS) == "open":
            self.tail = TailModel(alpha, epsilon, diffusivity)

    def field_and_flux(
        self, x: np.ndarray, strength: np.ndarray, z: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return u, Eq. (45), and Q, Eq. (19), at the points z, or at the particles themselves.

        With an open exterior the points must lie among the particles, or half as far beyond them as `tail.REACH`.
        """
        if self.tail is None:
            u, f = self._sums(x, strength, z)
            return u, self._flux(f)
        tail = self.tail(x, strength)
        points = x if z is None else z
        if z is not None and not tail.holds(z).all():
            allowed = (
                f"points among the particles, or up to {0.5 * REACH:g} smoothing lengths beyond"
            )
            raise InvalidInput("z", points, allowed, "Take `field`, or nearer points.")
        u, f = self._sums(*tail.continued(x, strength), z)
        return u[: points.size], self._flux(f[: points.size]) + self.tail.flux(tail, points)

    def field(self, x: np.ndarray, strength: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return u, Eq. (45), at the points z; far beyond the particles of an open exterior it is the far field."""
        if self.tail is None:
            return self._sums(x, strength, z)[0]
        tail = self.tail(x, strength)
        near = tail.holds(z)
        u = np.empty(z.shape)
        u[near] = self._sums(*tail.continued(x, strength), z[near])[0]
        u[~near] = self.tail.far_field(tail, z[~near])
        return u

    def transform(self, k: np.ndarray) -> np.ndarray:
        """Return eta^(k), the Fourier transform of the kernel of the field, for unit smoothing length."""
        return np.asarray(kernel_transform("eta", k, self.alpha, order=self.order))

    @property
    def largest_stable_step(self) -> float:
        """2 epsilon^alpha / (D max k^alpha eta^(k)): no displacement wave grows, aliases neglected."""
        decay = (_WAVENUMBERS**self.alpha * self.transform(_WAVENUMBERS)).max()
        return float(MIDPOINT_LIMIT * self.epsilon**self.alpha / (self.diffusivity * decay))

    def _flux(self, f: np.ndarray) -> np.ndarray:
        return -(self.diffusivity / self.epsilon ** (self.alpha - 1.0)) * f

    def __call__(self, x: np.ndarray, strength: np.ndarray) -> np.ndarray:
        """Return v(x_i), Eq. (44).

        Raises
        ------
        FieldNotPositive
            If u vanishes or changes sign at a particle.
        """
        u, flux = self.field_and_flux(x, strength)
        return quotient_velocity(flux, u, x, self._sums.accuracy)
