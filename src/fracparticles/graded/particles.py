"""One Green step on graded particles: GPSE over the whole time, on particles that stand for unequal volumes.

Eqs. (38)-(41) do not require a lattice. With epsilon^alpha = D T, so that one step covers the whole time, and
particles x_j of volumes V_j, Eq. (41) is

    u_i(T) = u_i + sum_j V_j (u_j - u_i) E_epsilon(x_i - x_j).                   (exchange)

It approximates u(x, T) = int E_epsilon(x - y) u(y, 0) dy. The plain sum of this is

    u_i(T) = sum_j V_j u_j E_epsilon(x_i - x_j).                                 (quadrature)

Particles that are dense in the middle and ever wider apart towards the ends,

    x_j = L sinh(s_j),   V_j = L cosh(s_j) ds,   s_j equally spaced,

reach far with few of them, and need no model of the exterior. The quadrature is the trapezoidal rule in s: its error
falls faster than any power of ds where the volumes resolve E, about V_j < epsilon. Far out they do not. There the
exchange is right to leading order, since particle i keeps what no neighbour takes, and it conserves sum V u. The
quadrature instead gives a particle V E(0) times its own strength, far more than it has. A step is a product with an N
x N matrix. For tens of particles or some hundred it is faster than any sum by FFT.

Volumes that do not fit the positions can make a particle give away more than twice what it has. Then the exchange
amplifies. It is symmetric in the scalar product of V, so that its largest factor is between s - 1 and 2 s - 1, with s
the largest sum of the weights of a particle's neighbours.
"""

from __future__ import annotations

import warnings

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import AccuracyWarning, InvalidInput, StabilityWarning
from fracparticles.special import green

__all__ = ["FORMS", "MOST", "graded_particles", "green_step", "refuse_many"]

FORMS = ("exchange", "quadrature")
MOST = 10001  # particles: the matrix then takes 800 MB
_LARGEST = 1e150  # the largest position or volume that `green_step` takes
_DENSE = 64  # particles up to which all eigenvalues are computed
_GROWS = 1e-6  # an amplification that exceeds 1 by more is warned of
_TOO_MUCH = 1.25  # the most that the quadrature may make of a constant 1


def graded_particles(count: int, reach: float, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the positions x_j = L sinh(s_j) in ascending order, and their volumes; both of shape (count,).

    Parameters
    ----------
    count : int
        N, odd: one particle is at x = 0.
    reach : float
        The outermost particles are at -reach and reach.
    scale : float
        L: within it the particles are nearly equally spaced. If reach is far below L, all of them are.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    count = check.positive_integer("count", count)
    if count < 3 or count % 2 == 0:
        raise InvalidInput("count", count, "an odd number > 1", "Add one particle.")
    reach, scale = check.scale("reach", reach), check.scale("scale", scale)
    step = 2.0 * np.arcsinh(reach / scale) / (count - 1)
    s = (np.arange(count) - count // 2) * step
    return scale * np.sinh(s), scale * np.cosh(s) * step


def refuse_many(field: str, count: int) -> None:
    """Refuse more particles than a dense matrix should hold.

    Raises
    ------
    InvalidInput
        If there are more than `MOST`.
    """
    if count > MOST:
        most = f"at most {MOST} particles in a dense matrix"
        raise InvalidInput(field, count, most, "Take fewer particles.")


def green_step(
    x: np.ndarray, volumes: np.ndarray, alpha: float, time: float, form: str = "exchange"
) -> np.ndarray:
    """Return the matrix M of one step, u(T) = M u(0), shape (N, N).

    Parameters
    ----------
    x, volumes : array, shape (N,)
        The positions of the particles, anywhere on the line, and their volumes.
    alpha : float
        Fractional order, 1 < alpha < 2.
    time : float
        D T.
    form : {"exchange", "quadrature"}
        The exchange keeps sum V u to round-off, however far volumes and smoothing length are apart: its diagonal is
        1 less the weights of all other particles. The particle's own weight, V E(0), never enters.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.

    Warns
    -----
    StabilityWarning
        If the exchange amplifies.
    AccuracyWarning
        If the quadrature makes a constant more than a quarter larger somewhere.
    """
    check.choice("form", form, FORMS)
    alpha, time = check.fractional_order(alpha), check.positive_real("time", time)
    x = check.within("x", check.vector("x", x, least=0), -_LARGEST, _LARGEST)
    volumes = check.vector("volumes", volumes, x.size)
    volumes = check.within("volumes", volumes, 0.0, _LARGEST, inside=True)
    refuse_many("x", x.size)
    matrix = volumes * np.asarray(green(x[:, None] - x, time, alpha))
    if form == "exchange":
        np.fill_diagonal(matrix, 0.0)
        weights = matrix.sum(axis=1)
        np.fill_diagonal(matrix, 1.0 - weights)
        _warn_of_growth(matrix, volumes, float(weights.max(initial=0.0)))
    else:
        _warn_of_excess(matrix.sum(axis=1))
    return matrix


def _warn_of_growth(matrix: np.ndarray, volumes: np.ndarray, most: float) -> None:
    factor = most - 1.0
    if 1.0 < most <= 2.0 + _GROWS:
        factor = -_least_eigenvalue(matrix, np.sqrt(volumes))
    if factor > 1.0 + _GROWS:
        warnings.warn(
            f"the exchange amplifies, by the factor {factor:.4g} or more in a step: some particle gives away "
            f"{most:.3g} times what it has. Take volumes that belong to the positions, or a longer time.",
            StabilityWarning,
            stacklevel=3,
        )


def _least_eigenvalue(matrix: np.ndarray, root: np.ndarray) -> float:
    """Return the least eigenvalue of a matrix that the square roots of the volumes make symmetric."""
    n = root.size
    if n <= _DENSE:
        return float(np.linalg.eigvalsh(matrix * root[:, None] / root).min())
    # Imported here, since that takes a tenth of a second.
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    symmetric = LinearOperator((n, n), lambda u: root * (matrix @ (u / root)), dtype=float)
    start = np.cos(2.4 * np.arange(n))  # anything that is not a constant, the same every time
    try:
        return float(eigsh(symmetric, 1, which="SA", v0=start, tol=1e-6)[0][0])
    except ArpackNoConvergence as error:
        return float(error.eigenvalues.min(initial=0.0))


def _warn_of_excess(constant: np.ndarray) -> None:
    if constant.max(initial=0.0) > _TOO_MUCH:
        warnings.warn(
            f"the quadrature makes {constant.max():.3g} of a constant of 1: volumes are too large for the Green's "
            "function, or do not belong to the positions. Take the form 'exchange', or more particles.",
            AccuracyWarning,
            stacklevel=3,
        )
