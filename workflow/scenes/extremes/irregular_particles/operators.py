"""The exchange forms on particles anywhere, each as a dense matrix written out from its equation.

KPSE  (34)  (alpha D / eps^alpha) sum_j V_j (u_j - u_i) K_eps(x_j - x_i)
GPSE  (41)  (D / eps^alpha) sum_j V_j (u_j - u_i) E_eps(x_j - x_i)
FPSE  (19), (25)  -(D / eps) sum_j V_j (Q_j + Q_i) eta1_eps(x_i - x_j),  Q_i = -eps^-beta sum_j V_j u_j F_eps(x_i - x_j)
DPSE  (13), (16)  (2 D / eps^2) sum_j V_j (v_j - v_i) Phi_eps(x_j - x_i),  v_i = eps^(1 - beta) sum_j V_j u_j kappa_eps
DD    (10)  (D / eps^alpha) sum_j V_j u_j G_eps(x_i - x_j)
"""

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.pse import cell_volumes
from fracparticles.special import green

FORMS = ("KPSE", "GPSE", "FPSE", "DPSE", "DD")
CONSERVATIVE = ("KPSE", "GPSE", "FPSE", "DPSE")
ALPHA, START = 1.5, 0.5
_STEP = 1e-4  # of a derivative in time, relative


def arranged(
    kind: str, x: np.ndarray, jitter: float, seed: int, right: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions, in order, and the volumes that belong to them: half the way to either neighbour, or all h.

    `jittered`: each of the lattice moved by up to `jitter` h either way; `random`: anywhere; `clustered`: anywhere in
    the middle half, every other one in the middle tenth.
    """
    dice = np.random.default_rng(seed)
    h, half = float(x[1] - x[0]), float(x[-1])
    if kind == "jittered":
        places = x + jitter * h * dice.uniform(-1.0, 1.0, x.size)
    else:
        places = dice.uniform(-half, half, x.size)
        if kind == "clustered":
            places *= np.where(np.arange(x.size) % 2 == 0, 0.1, 0.5)
    places = np.sort(places)
    return places, cell_volumes(places) if right else np.full(x.size, h)


def weight(form: str, r: np.ndarray, epsilon: float) -> np.ndarray:
    """Return what a form weighs u_j - u_i with, per volume: KPSE and GPSE."""
    if form == "GPSE":
        return np.asarray(green(r, epsilon**ALPHA, ALPHA)) / epsilon**ALPHA
    return ALPHA * epsilon ** (-1.0 - ALPHA) * np.asarray(kernel("K", np.abs(r) / epsilon, ALPHA))


def matrix(form: str, x: np.ndarray, volumes: np.ndarray, epsilon: float) -> np.ndarray:
    """Return A of du/dt = A u, D = 1, order II."""
    r = x[:, None] - x

    def summed(name: str) -> np.ndarray:
        odd = name in ("F", "eta1")
        values = np.asarray(kernel(name, (r if odd else np.abs(r)) / epsilon, ALPHA))
        return volumes * values / epsilon

    if form in ("KPSE", "GPSE"):
        return _exchanged(volumes * weight(form, r, epsilon))
    if form == "DD":
        return epsilon**-ALPHA * summed("G")
    if form == "FPSE":
        flux, divergence = -(epsilon ** (1.0 - ALPHA)) * summed("F"), summed("eta1")
        both = divergence @ flux + divergence.sum(axis=1)[:, None] * flux
        return -both / epsilon
    potential = epsilon ** (2.0 - ALPHA) * summed("kappa")
    return 2.0 / epsilon**2 * _exchanged(summed("Phi")) @ potential


def _exchanged(weights: np.ndarray) -> np.ndarray:
    return weights - np.diag(weights.sum(axis=1))


def solution(x: float | np.ndarray) -> np.ndarray:
    """Return the fundamental solution u at the start."""
    return np.asarray(green(x, START, ALPHA))


def rate_of_change(x: np.ndarray) -> np.ndarray:
    """Return du/dt there, -(-Laplacian)^(alpha/2) u, by a central difference in time."""
    later, sooner = (green(x, START * (1.0 + s * _STEP), ALPHA) for s in (1.0, -1.0))
    return np.asarray((later - sooner) / (2.0 * _STEP * START))
