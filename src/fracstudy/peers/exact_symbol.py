"""The limit: the exact symbol on a periodic box, one pair of Fourier transforms from 0 to t; on the line and the plane.

    u^_k(t) = exp(-t |k|^alpha) u^_k(0),    k = pi m / D,  m = -N/2 .. N/2 in each coordinate.

Exact in time and, for what the lattice resolves, in space. What is left is the period 2 D: every particle has images,
and the initial data beyond D are missing.
"""

from __future__ import annotations

from dataclasses import dataclass
from threading import Lock

import numpy as np
import pyfftw

from fracparticles.lattice.fourier import transform_length
from fracstudy.peers.base import Peer, PlaneSolver, Task, half_intervals

__all__ = ["PEER", "BoxSolver"]

_PLAN = ("FFTW_ESTIMATE",)  # the same plan every time, as in `lattice.fourier`


@dataclass(frozen=True)
class BoxSolver:
    """The method made ready, see `base.Solver`. Threads may share it: they take turns at its work arrays.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        x_i = -D + i h, i = 0 .. N - 1, and h.
    rate, decay : array, shape (N,) * (dim - 1) + (N / 2 + 1,)
        -|k|^alpha and exp(-t |k|^alpha).
    forward, backward : pyfftw.FFTW
        The transforms.
    """

    x: np.ndarray
    volumes: np.ndarray
    rate: np.ndarray
    decay: np.ndarray
    forward: pyfftw.FFTW
    backward: pyfftw.FFTW
    lock: Lock

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return -(-Laplacian)^(alpha/2) u of the periodic u."""
        return self._multiplied(u, self.rate)

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return u at the time prepared for."""
        return self._multiplied(u0, self.decay)

    def _multiplied(self, u: np.ndarray, symbol: np.ndarray) -> np.ndarray:
        with self.lock:
            np.copyto(self.forward.input_array, u)
            self.forward.execute()
            np.multiply(self.forward.output_array, symbol, out=self.forward.output_array)
            self.backward.execute()
            return self.backward.output_array / u.size


def _box(task: Task, dim: int) -> BoxSolver:
    """A spacing asked for is lowered to a number of points that transforms fast; a number is even."""
    points = 2 * half_intervals(task, points=0)
    if task.spacing is not None:
        points = transform_length(points)
    h, axes = 2.0 * task.half_width / points, tuple(range(dim))
    real = pyfftw.empty_aligned((points,) * dim)
    spectrum = pyfftw.empty_aligned((points,) * (dim - 1) + (points // 2 + 1,), dtype=complex)
    destroy = (*_PLAN, "FFTW_DESTROY_INPUT")
    last = np.arange(points // 2 + 1) * (np.pi / task.half_width)
    all_waves = np.fft.fftfreq(points, 1.0 / points) * (np.pi / task.half_width)
    waves = np.meshgrid(*[all_waves] * (dim - 1), last, indexing="ij", sparse=True)
    rate = np.sqrt(sum(np.square(k) for k in waves)) ** task.alpha
    return BoxSolver(
        x=(np.arange(points) - points // 2) * h,
        volumes=np.full(points, h),
        rate=-rate,
        decay=np.exp(-task.time * rate),
        forward=pyfftw.FFTW(real, spectrum, axes=axes, flags=_PLAN),
        backward=pyfftw.FFTW(spectrum, real, axes, "FFTW_BACKWARD", destroy),
        lock=Lock(),
    )


def _plane(task: Task) -> PlaneSolver:
    box = _box(task, dim=2)
    return PlaneSolver(box.x, float(box.volumes[0] ** 2), box.solve)


PEER = Peer(
    name="exact-symbol",
    label="exact symbol, periodic (limit)",
    reference="u^(k, t) = exp(-t |k|^alpha) u^(k, 0)",
    place=6,
    colour="#000000",
    marker="*",
    exteriors=("periodic",),
    propagations=("exact",),
    make=lambda task: _box(task, dim=1),
    make_plane=_plane,
    group="limit",
)
