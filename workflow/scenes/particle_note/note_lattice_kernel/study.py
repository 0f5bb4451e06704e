"""The lattice kernel (27) of the lecture note (Sec. 3.1), and the finite differences that discrete moments give."""

from collections.abc import Iterator, Mapping
from fractions import Fraction

import numpy as np
import pandas as pd

from fracparticles import pse
from fracparticles.pse import GAUSSIAN_20, TENT_27, Kernel, lattice_moment, moment, required_moments
from fracparticles.run.orders import observed_order
from fracstudy.errors import EPS, off
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.particle_note.waves import SEED, arranged, rms_error, second_derivative_error

_WANTED = required_moments(2, 2)[2]
_KERNELS: dict[str, Kernel] = {
    "(27)": TENT_27,
    "tent, M₂ = 2": pse.SplineKernel(1),
    "Gaussian (20)": GAUSSIAN_20,
}

_WIDE = 3.0  # eps / h
# Particles off the lattice: numbers, domain, by how much of h.
_NUMBERS, _HALF_WIDTH, _JITTER = (160, 320), 8.0, 0.1
_PERIOD = 64  # the weights of the compact scheme fall like 0.101^|j|


def _both(*right: Fraction | int) -> dict[int, Fraction | int | float]:
    """The weights of a symmetric scheme for f'', from those of f_(i+1), f_(i+2), ..."""
    weights = {j: Fraction(w) for k, w in enumerate(right, start=1) for j in (-k, k)}
    return {**weights, 0: -sum(weights.values(), Fraction(0))}


# The derivative, and the weights of f_(i+j) by j: from textbooks.
SCHEMES: Mapping[str, tuple[int, Mapping[int, Fraction | int | float]]] = {
    "f'', centred, 2nd order": (2, _both(1)),
    "f'', centred, 4th order": (2, _both(Fraction(4, 3), Fraction(-1, 12))),
    "f'', centred, 6th order": (2, _both(Fraction(3, 2), Fraction(-3, 20), Fraction(1, 90))),
    "f'', centred, 8th order": (2, _both(*map(Fraction, ("8/5", "-1/5", "8/315", "-1/560")))),
    "f'', one-sided, 2nd order": (2, {0: 2, 1: -5, 2: 4, 3: -1}),
    "f', upwind": (1, {-1: -1, 0: 1}),
    "f', centred, 2nd order": (1, {-1: Fraction(-1, 2), 1: Fraction(1, 2)}),
    "f', one-sided, 2nd order": (1, {0: Fraction(-3, 2), 1: 2, 2: Fraction(-1, 2)}),
    "fourth derivative, centred": (4, {-2: 1, -1: -4, 0: 6, 1: -4, 2: 1}),
}
_CENTRED = dict(zip((2, 4, 6, 8), SCHEMES, strict=False))


def study(
    inputs: Inputs,
    *,
    claimed_moment: list[int],
    overlap: list[float],
    spacing: list[float],
    accuracy: list[int],
) -> Result:
    """The kernel (27): its moments over the line and on the lattice, and the exchange (26) that it gives.

    On a lattice the sum with a kernel of second moment M^_2 (28) approximates (M^_2 / 2) f'': the table has
    M^_2 / 2 against eps / h. `claimed_moment` is the printed M_2, `accuracy` that of the stencils for f'' on eps = h.
    """
    widest = max(overlap)
    fine = np.linspace(0.5, widest, 20 * int(widest) + 1)
    z, i = np.linspace(-3.0, 3.0, 241), np.arange(-3.0, 4.0)
    columns, panels = {"ε/h": np.array(overlap)}, Panels()
    for name, kernel in _KERNELS.items():
        columns[f"M̂₂/2, {name}"] = lattice_moment(kernel, 2, overlap) / _WANTED
        panels.add("shape", name, z, kernel(z))
        panels.add("points", name, i, kernel(i))
        panels.add("moment", name, fine, lattice_moment(kernel, 2, fine) / _WANTED)
    orders = {}
    for r in accuracy:
        error = [second_derivative_error(pse.construct_stencil(2, r), h, 1.0) for h in spacing]
        orders[r] = float(observed_order(spacing, error)[-1])
        panels.add("error", str(r), spacing, error)
    findings = [
        *_moments(claimed_moment[0] / claimed_moment[1]),
        *_elsewhere(spacing[-2:]),
        _centred(spacing[-2:]),
        *_schemes(orders),
        *_economy(accuracy),
    ]
    return Result(pd.DataFrame(columns), inputs.judged(findings), panels.frame)


def _moments(claimed: float) -> Iterator[Finding]:
    """The shape of (27), its moment over the line and those on the lattice."""
    z = np.linspace(-3.0, 3.0, 601)
    yield measured(
        "P-F2.shape",
        top=TENT_27(0.0),
        excess=TENT_27(z).max() - TENT_27(0.0),
        beyond=np.abs(TENT_27(np.array([-2.0, 2.0, 2.5]))).max(),
        edge=TENT_27(1.0),
        mass=moment(TENT_27, 0),
    )
    second, required = moment(TENT_27, 2), required_moments(2, 2)
    missed = abs(second / _WANTED - 1.0)
    yield measured(
        "P-C4.second_moment", off=abs(second / claimed - 1.0), missed=missed, second=second
    )
    discrete = {f"M̂_{k}": abs(float(lattice_moment(TENT_27, k)) - m) for k, m in required.items()}
    yield measured("P-C4.discrete_moment", off=discrete)


def _elsewhere(spacing: list[float]) -> Iterator[Finding]:
    """(27) with another radius, and on particles that lie a little off the lattice, on two spacings."""
    wide = [second_derivative_error(TENT_27, 0.125 * h, _WIDE) for h in spacing]
    yield measured(
        "P-C4.lattice_only",
        error=wide[-1],
        power=observed_order(spacing, wide)[-1],
        factor=float(lattice_moment(TENT_27, 2, _WIDE)) / _WANTED,
        limit=moment(TENT_27, 2) / _WANTED,
    )
    errors = []
    for n in _NUMBERS:
        x, v = arranged("jittered", n, _HALF_WIDTH, _JITTER)
        exchange = pse.StrengthExchange(x, v, 2.0 * _HALF_WIDTH / n, TENT_27)
        errors.append(rms_error(exchange, x, v))
    power = observed_order(1.0 / np.array(_NUMBERS), errors)[-1]
    yield measured("P-C4.regular_only", error=errors[-1], power=power, jitter=_JITTER)


def _centred(spacing: list[float]) -> Finding:
    """The rows of (26) with (27) inside the lattice, times h^2, against (1, -2, 1)."""
    h, n = 0.125, 41  # distances without round-off
    matrix = pse.StrengthExchange(h * np.arange(n), h, h, TENT_27).matrix.toarray()[1:-1] * h * h
    centred = sum(c * np.eye(n - 2, n, j) for j, c in enumerate((1.0, -2.0, 1.0)))
    error = [second_derivative_error(TENT_27, h, 1.0) for h in spacing]
    power, difference = float(observed_order(spacing, error)[0]), np.abs(matrix - centred).max()
    numbers = {"difference": difference, "off": abs(power - 2.0), "power": power}
    return measured("P-C4.centred_differences", **numbers)


def _compact() -> dict[int, float]:
    """The weights of f''_(i-1) + 10 f''_i + f''_(i+1) = 12 (f_(i-1) - 2 f_i + f_(i+1)) / h^2, solved for f''."""
    theta = 2.0 * np.pi * np.fft.fftfreq(_PERIOD)
    symbol = -24.0 * (1.0 - np.cos(theta)) / (10.0 + 2.0 * np.cos(theta))
    weights = np.fft.ifft(symbol).real
    return {j: weights[j] for j in range(-_PERIOD // 2 + 1, _PERIOD // 2)}


def _schemes(orders: dict[int, float]) -> Iterator[Finding]:
    """Difference schemes as sums (18) with a kernel of their weights, and the stencils of the discrete moments."""
    h, n = 0.125, 4 * _PERIOD
    particles, f = h * np.arange(n), np.random.default_rng(SEED).normal(size=n)
    inside = slice(_PERIOD, -_PERIOD)
    difference = {}
    for name, (beta, weights) in {**SCHEMES, "f'', compact, 4th order": (2, _compact())}.items():
        reach = max(map(abs, weights))
        # (18) has eta at x_i - x_p: the weight of f(x_i + j h) is eta(-j).
        kernel = pse.Stencil(tuple(Fraction(weights.get(-j, 0)) for j in range(-reach, reach + 1)))
        ours = pse.derivative(particles[inside], f[inside], particles, f, h, h, kernel, beta)
        scheme = np.zeros(n)
        for j, weight in weights.items():
            scheme += float(weight) * np.roll(f, -j) / h**beta
        difference[name] = off(ours, scheme[inside], np.abs(scheme).max())
    yield measured("P-C4.any_stencil", difference=difference)
    coefficient = {}
    for r in orders:
        found = enumerate(pse.construct_stencil(2, r).values, start=-r // 2)
        weights = SCHEMES[_CENTRED[r]][1]
        coefficient[f"r = {r}"] = max(abs(float(eta - weights[j])) for j, eta in found if j)
    away = {f"r = {r}": abs(power - r) for r, power in orders.items()}
    yield measured("P-C4.from_moments", coefficient=coefficient, off=away)


def _economy(accuracy: list[int]) -> Iterator[Finding]:
    """The residual of a stencil with one point less a side, and the neighbours of a particle with (20) and (27)."""
    misfit = {f"r = {r}": _misfit_of_narrower_stencil(r) for r in accuracy}
    yield measured("P-C4.smallest", misfit=misfit)

    def neighbours(kernel: Kernel, overlap: float) -> int:
        i = np.arange(-100.0, 101.0)
        return int(np.count_nonzero(kernel(i / overlap) > EPS * kernel(0.0))) - 1

    few, many = neighbours(TENT_27, 1.0), neighbours(GAUSSIAN_20, 2.0)
    close = {"the Gaussian at eps = h": {"ratio": neighbours(GAUSSIAN_20, 1.0) / few}}
    yield measured("P-C4.cheaper", ratio=many / few, few=few, many=many, others=close)


def _misfit_of_narrower_stencil(accuracy: int) -> float:
    """The least residual of the conditions (28) for f'' with one point less a side, over |M_2| = 2."""
    required = required_moments(2, accuracy)
    conditions = [k for k in required if k % 2 == 0]
    right = np.array([float(required[k]) for k in conditions])
    points = np.arange(1.0, len(conditions))
    matrix = 2.0 * points ** np.array(conditions)[:, None]
    solution = np.linalg.lstsq(matrix, right)[0] if points.size else np.zeros(0)
    return float(np.linalg.norm(matrix @ solution - right) / np.linalg.norm(right))
