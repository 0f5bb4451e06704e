"""What the scenes of the note share: functions and particles that sums are tried on, and how accuracies are drawn."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fracparticles import pse
from fracparticles.pse import GAUSSIAN_20, Kernel, StrengthExchange, cell_volumes, derivative
from fracparticles.special.ends import heat_kernel

SEED = 20  # of particles at random
START = 0.5  # of the heat kernel
CENTRE = 4.0  # errors are measured for |x| < 4: the ends of the domain are no part of the question

# A line for each accuracy r.
LINES: dict[int, dict[str, Any]] = {
    2: {"color": "#0072B2", "linestyle": "-"},
    4: {"color": "#D55E00", "linestyle": "--"},
    6: {"color": "#009E73", "linestyle": "-."},
    8: {"color": "#CC79A7", "linestyle": ":"},
}


def wave(x: np.ndarray, kappa: float = 1.0, order: int = 0) -> np.ndarray:
    """The derivative of cos(kappa x) of that order; its maximum is kappa^order."""
    return kappa**order * np.cos(kappa * x + 0.5 * np.pi * order)


def second_derivative_error(kernel: Kernel, h: float, overlap: float) -> float:
    """The largest error of (21) for cos x at particles of the lattice."""
    epsilon = overlap * h
    x = h * np.round(np.linspace(0.0, 2.0 * np.pi, 17) / h)
    margin = kernel.reach * epsilon
    particles = pse.lattice(-margin, 2.0 * np.pi + margin, h)
    found = derivative(x, wave(x), particles, wave(particles), h, epsilon, kernel, 2)
    return float(np.abs(found - wave(x, order=2)).max())


@dataclass(frozen=True)
class Skewed:
    """(20) times 1 + c (z^3 - 3 z / 2): the same M_1 and M_2, but not symmetric; M_3 is not zero, so that r = 1."""

    amount: float = 0.5
    reach: float = GAUSSIAN_20.reach + 0.5
    breaks: tuple[float, ...] = ()

    def __call__(self, z: ArrayLike) -> np.ndarray:
        """Return eta(z)."""
        z = np.asarray(z, dtype=float)
        return GAUSSIAN_20(z) * (1.0 + self.amount * z * (z * z - 1.5))


def heat_second(x: np.ndarray, t: float) -> np.ndarray:
    """The second derivative of the heat kernel, the solution of (24) with D = 1 from a unit mass at x = 0."""
    return heat_kernel(x, t) * (x * x / (2.0 * t) - 1.0) / (2.0 * t)


def arranged(
    kind: str, n: int, half_width: float, jitter: float = 0.0, seed: int = SEED
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and volumes of n particles in [-L, L].

    `lattice`; `mapped`, the lattice under a smooth map; `jittered`, each moved by up to `jitter` h either way;
    `random`, uniform. The volumes are the cells between the half-way points, for `mapped` the images of the cells.
    """
    h = 2.0 * half_width / n
    edges = np.linspace(-half_width, half_width, n + 1)
    middle = edges[:-1] + 0.5 * h
    if kind == "lattice":
        return middle, np.full(n, h)
    if kind == "mapped":

        def image(x: np.ndarray) -> np.ndarray:
            return x + 0.5 * half_width / np.pi * np.sin(np.pi * x / half_width)

        return image(middle), np.diff(image(edges))
    random = np.random.default_rng(seed)
    if kind == "jittered":
        x = np.sort(middle + jitter * h * random.uniform(-1.0, 1.0, n))
    else:
        x = np.sort(random.uniform(-half_width, half_width, n))
    return x, cell_volumes(x)


def rms_error(exchange: StrengthExchange, x: np.ndarray, v: np.ndarray) -> float:
    """Return the root mean square error of f'' by (26), for the heat kernel at the start, |x| < 4, relative."""
    inside = np.abs(x) < CENTRE
    exact = heat_second(x, START)[inside]
    off = (exchange.apply(v * heat_kernel(x, START)) / v)[inside] - exact
    return np.sqrt((off**2).mean() / (exact**2).mean())
