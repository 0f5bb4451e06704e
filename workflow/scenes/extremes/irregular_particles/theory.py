r"""What disorder costs a sum sum_j V_j g(x_j), g(y) = (u(y) - u(x)) w(x - y), and the probes of it.

Places x_j = (j + xi_j) h, xi uniform in [-J, J], so that var xi = J^2 / 3:

- V = h ("wrong"): to first order in xi the error is h^2 sum_j xi_j g'(x_j), rms (J^2/3)^(1/2) h^(3/2) |g'|.
- V half the way to either neighbour ("right"): the trapezoidal rule, whose error is -sum_j d_j^3 g'' / 12 over the gaps
  d_j = (1 + xi_(j+1) - xi_j) h. What is linear in xi telescopes to -h^4/6 sum_j xi_j g'''. Of the rest, 3 a^2 + a^3
  with a = xi_(j+1) - xi_j, neighbours are correlated: rms h^(5/2) |g''| / 12 times the root of var + 2 cov.
- Places at random, V = h: rms h^(1/2) |g|.

|.| is the 2-norm over y. With epsilon in a fixed ratio to h all of them leave an error of du/dt like h^(1 - alpha).
"""

from collections.abc import Iterator
from itertools import product
from math import sqrt

import numpy as np

from fracstudy.probe import HELD, Kind, Probe
from scenes.extremes.irregular_particles.operators import (
    arranged,
    matrix,
    rate_of_change,
    solution,
    weight,
)

How = tuple[str, float, bool]
"""Kind of the places, the jitter of a lattice, and whether the volumes fit."""

_FINE = 8  # points of a reference integral for one particle
_POINTS = 12  # x where |g|, |g'|, .. are taken


def probes(x: np.ndarray, overlap: float, seeds: int) -> Iterator[Probe]:
    """The rms of the random error over the predicted one, less one; and the power of h.

    A set has some ten independent errors, where u varies: of all seeds the rms is known to (20 seeds)^(-1/2), and
    three times that is allowed, which is 0.27 for six; a power of h is that of two.
    """
    close = 3.0 / sqrt(20.0 * seeds)
    predicted_error = Kind("accuracy", "the predicted error", close, "error theory", HELD)
    forms, of_jitter = ("KPSE", "GPSE"), product((0.05, 0.2, 0.5), (True, False))
    how = {f"jitter {j:g} h, {volumes(right)}": ("jittered", j, right) for j, right in of_jitter}
    for form, name in product(forms, how):
        yield predicted_error(f"{form}, {name}", _ratio_off, form, x, overlap, how[name], seeds)
    for form in forms:
        name, anywhere = f"{form}, random places, equal volumes", ("random", 0.0, False)
        yield predicted_error(name, _ratio_off, form, x, overlap, anywhere, seeds)
    power = Kind("order lost", "the predicted power", 2.0 * close, "error theory", HELD)
    for right in (True, False):
        name = f"KPSE, ε = {overlap:g} h, jitter 0.3 h, {volumes(right)}"
        yield power(name, _power_off, x, overlap, right, seeds)


def volumes(right: bool) -> str:
    """Return the words for volumes that fit the places, or do not."""
    return f"{'right' if right else 'wrong'} volumes"


def predicted(form: str, x: np.ndarray, epsilon: float, jitter: float, right: bool) -> float:
    """Return the predicted rms error of du/dt over the rms of du/dt, for |x| < L/2."""
    exact = rate_of_change(np.linspace(-0.5, 0.5, 201) * x[-1])
    error = _rms(form, x, epsilon, ("jittered", jitter, right))
    return error / float(np.sqrt((exact**2).mean()))


def _g(form: str, centre: float, y: np.ndarray, epsilon: float) -> np.ndarray:
    difference = solution(y) - solution(centre)
    return np.asarray(difference * weight(form, centre - y, epsilon))


def _norms(form: str, x: np.ndarray, epsilon: float) -> np.ndarray:
    """The mean over x of the squares of |g|, |g'|, |g''| and |g'''|."""
    fine = np.linspace(x[0], x[-1], 16 * x.size + 1)
    step, total = float(fine[1] - fine[0]), np.zeros(4)
    for centre in np.linspace(-0.5, 0.5, _POINTS) * x[-1]:
        g = _g(form, float(centre), fine, epsilon)
        for k in range(4):
            total[k] += step * float((g * g).sum())
            g = np.gradient(g, step)
    return total / _POINTS


def _rms(form: str, x: np.ndarray, epsilon: float, how: How) -> float:
    (kind, jitter, right), h = how, float(x[1] - x[0])
    values, first, second, third = _norms(form, x, epsilon)
    if kind == "random":
        return float(np.sqrt(h * values))
    if not right:
        return float(np.sqrt(jitter**2 / 3.0 * h**3 * first))
    linear = jitter**2 / 3.0 * h**7 / 36.0 * third
    return float(np.sqrt(_cubes(jitter) / 144.0 * h**5 * second + linear))


def _cubes(jitter: float) -> float:
    """var + 2 cov of 3 a^2 + a^3 for neighbouring gaps, by a rule that is exact for powers of xi up to 11."""
    nodes, weights = np.polynomial.legendre.leggauss(6)
    one, two, three = np.meshgrid(*(jitter * nodes,) * 3, indexing="ij")
    w = np.einsum("i,j,k->ijk", *(0.5 * weights,) * 3)
    here, there = (3.0 * a**2 + a**3 for a in (two - one, three - two))
    here, there = (cube - float((w * cube).sum()) for cube in (here, there))
    return float((w * here * (here + 2.0 * there)).sum())


def _errors(form: str, x: np.ndarray, overlap: float, how: How, seeds: int) -> float:
    """The rms of sum less integral, for |x| < L/2, over the seeds."""
    h = float(x[1] - x[0])
    (kind, jitter, right), epsilon, found = how, overlap * h, []
    fine = np.linspace(x[0] - 0.5 * h, x[-1] + 0.5 * h, _FINE * x.size + 1)
    middle, step = 0.5 * (fine[1:] + fine[:-1]), float(fine[1] - fine[0])
    for seed in range(seeds):
        places, volumes = arranged(kind, x, jitter, seed, right)
        sums = matrix(form, places, volumes, epsilon) @ solution(places)
        inner = np.abs(places) < 0.5 * x[-1]
        integrals = [step * float(_g(form, float(p), middle, epsilon).sum()) for p in places[inner]]
        found.append(sums[inner] - np.array(integrals))
    return float(np.sqrt((np.concatenate(found) ** 2).mean()))


def _ratio_off(form: str, x: np.ndarray, overlap: float, how: How, seeds: int) -> tuple[float, str]:
    measured = _errors(form, x, overlap, how, seeds)
    expected = _rms(form, x, overlap * float(x[1] - x[0]), how)
    return abs(measured / expected - 1.0), f"{measured:.1e}, predicted {expected:.1e}"


def _power_off(x: np.ndarray, overlap: float, right: bool, seeds: int) -> tuple[float, str]:
    measured, expected = [], []
    for count in (x.size, 2 * x.size - 1):
        y = np.linspace(x[0], x[-1], count)
        how = "jittered", 0.3, right
        measured.append(_errors("KPSE", y, overlap, how, seeds))
        expected.append(_rms("KPSE", y, overlap * float(y[1] - y[0]), how))
    found, power = (float(np.log2(sizes[0] / sizes[1])) for sizes in (measured, expected))
    return abs(found - power), f"{found:.1f}, predicted {power:.1f}"
