"""Particle strength exchange (26) on particles anywhere (Sec. 3): what it conserves, and what irregularity costs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from fracparticles.pse import (
    GAUSSIAN_20,
    Kernel,
    StrengthExchange,
    cell_volumes,
    construct,
    construct_laplacian,
    moment,
)
from fracparticles.run.orders import observed_order
from fracparticles.time import STEP_POLYNOMIALS, step
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["arranged", "study"]

_EPS = float(np.finfo(float).eps)
_START = 0.5
_SEED = 20
_CENTRE = 4.0  # errors are measured for |x| < 4: the ends of the domain are no part of the question
_RK4 = STEP_POLYNOMIALS["rk4"]
_LOST = "ΣQ(T) / ΣQ(0) - 1"
_BOUND = "round-off, bound"
# Arrangement and power of h in eps; the last has eps = overlap h on the coarsest level and widens it from there.
_RULES = (("lattice", 1.0), ("mapped", 1.0), ("jittered", 1.0), ("jittered", 0.5))


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


def heat(x: np.ndarray, t: float) -> np.ndarray:
    """The solution of (24) with D = 1 that starts from a unit mass at x = 0."""
    return np.exp(-x * x / (4.0 * t)) / np.sqrt(4.0 * np.pi * t)


def heat_second(x: np.ndarray, t: float) -> np.ndarray:
    """Its second derivative."""
    return heat(x, t) * (x * x / (2.0 * t) - 1.0) / (2.0 * t)


def arranged(
    kind: str, n: int, half_width: float, jitter: float = 0.0, seed: int = _SEED
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


def study(
    inputs: Inputs,
    *,
    particles: int,
    half_width: float,
    jitter: float,
    overlap: float,
    time: float,
    numbers: list[int],
    seeds: int,
) -> Result:
    """Diffusion of a unit mass by (26) on a lattice and on irregular particles, with kernels symmetric and not.

    The strength is called conserved if |sum Q(t) / sum Q(0) - 1| stays below 4 eps log2(N) rate T: what round-off
    adds up to in a sum of N rates over the time T, as `rate` bounds the rates. The skewed kernel meets the same
    conditions on M_1 and M_2 and must change it by a thousand times that on irregular particles. Accuracy: the
    relative error of f'' (root mean square) and of f(x, T) (sum) for |x| < 4, averaged over random seeds.
    """
    n, domain = particles, (half_width, jitter)
    epsilon = overlap * 2.0 * half_width / n
    kernels: dict[str, Kernel] = {
        "Gaussian (20)": GAUSSIAN_20,
        "order 4": construct(2, 4),
        "skewed (20)": Skewed(),
    }
    rows: list[dict[str, Any]] = []
    parts = []
    for kind in ("lattice", "mapped", "jittered", "random"):
        x, v = arranged(kind, n, *domain)
        for name, kernel in kernels.items():
            exchange = StrengthExchange(x, v, epsilon, kernel)
            row, history, q = _run(exchange, v * heat(x, _START), time)
            row["error of f(x, T)"] = _solution_error(x, v, q, time)
            rows.append({"particles": kind, "kernel": name, **row})
            parts.append(history.assign(panel="mass", kind=kind, series=name))
            if name == "Gaussian (20)" and kind == "random":
                parts.append(pd.DataFrame({"panel": "solution", "x": x, "y": q / v, "volume": v}))
    x = np.linspace(-5.0, 5.0, 301)
    parts.append(pd.DataFrame({"panel": "exact", "x": x, "y": heat(x, _START + time)}))
    others = [_any_volumes(n, half_width, epsilon), _two_dimensions(n)]
    for (kind, name), exchange, q in others:
        rows.append({"particles": kind, "kernel": name, **_run(exchange, q, time)[0]})
    table = pd.DataFrame(rows)
    accuracy = _accuracy(domain, overlap, time, numbers, seeds)
    findings = list(_findings(table, accuracy)) if inputs.items else []
    return Result(table, findings, pd.concat([*parts, accuracy], ignore_index=True))


def _run(
    exchange: StrengthExchange, q: np.ndarray, time: float
) -> tuple[dict[str, Any], pd.DataFrame, np.ndarray]:
    """Integrate to the time T by RK4 in ten parts; the change of the total strength after each."""
    parts = 10
    steps = int(np.ceil(exchange.rate * time / parts / (0.8 * _RK4.stability_interval)))
    start, change = q.sum(), [0.0]
    rate = exchange.apply(q)
    imbalance = abs(rate.sum()) / np.abs(rate).sum()
    for _ in range(parts):
        q = step(exchange, _RK4, time / parts / steps, steps, q)
        change.append(float(q.sum() / start - 1.0))
    row = {
        "T": time,
        "|Σ dQ/dt| / Σ |dQ/dt| at t = 0": float(imbalance),
        _LOST: change[-1],
        _BOUND: 4.0 * _EPS * np.log2(exchange.size) * exchange.rate * time,
    }
    times = np.linspace(0.0, time, parts + 1)
    return row, pd.DataFrame({"x": times, "y": np.abs(change)}), q


def _solution_error(x: np.ndarray, v: np.ndarray, q: np.ndarray, time: float) -> float:
    inside = np.abs(x) < _CENTRE
    final = (v * heat(x, _START + time))[inside]
    return float(np.abs(q[inside] - final).sum() / final.sum())


_Case = tuple[tuple[str, str], StrengthExchange, np.ndarray]


def _any_volumes(n: int, half_width: float, epsilon: float) -> _Case:
    """Positions and volumes that have nothing to do with each other: no diffusion, but conserved all the same."""
    random = np.random.default_rng(_SEED)
    x = random.uniform(-half_width, half_width, n)
    v = random.exponential(2.0 * half_width / n, n)
    exchange = StrengthExchange(x, v, epsilon, GAUSSIAN_20)
    return ("random, any volumes", "Gaussian (20)"), exchange, random.normal(1.0, 1.0, n)


def _two_dimensions(n: int) -> _Case:
    """Uniform random particles in a square of side 4, equal volumes, the Laplacian of order 2."""
    x = np.random.default_rng(_SEED).uniform(-2.0, 2.0, (n, 2))
    volume = 16.0 / n
    exchange = StrengthExchange(x, volume, 2.0 * np.sqrt(volume), construct_laplacian(2, 2))
    strength = volume * np.exp(-((x - 0.5) ** 2).sum(axis=1))
    return ("random, 2-D", "Laplacian, r = 2"), exchange, strength


def _accuracy(
    domain: tuple[float, float], overlap: float, time: float, numbers: list[int], seeds: int
) -> pd.DataFrame:
    """Errors of f'' and of the solution against h, by the arrangement and the rule for eps."""
    rows = []
    coarsest = 2.0 * domain[0] / min(numbers)
    for (kind, power), n in product(_RULES, numbers):
        h = 2.0 * domain[0] / n
        epsilon = overlap * coarsest * (h / coarsest) ** power
        errors = []
        for seed in range(seeds if kind == "jittered" else 1):
            x, v = arranged(kind, n, *domain, seed)
            inside = np.abs(x) < _CENTRE
            exchange = StrengthExchange(x, v, epsilon, GAUSSIAN_20)
            q = v * heat(x, _START)
            exact = heat_second(x, _START)[inside]
            off = (exchange.apply(q) / v)[inside] - exact
            steps = int(np.ceil(exchange.rate * time / (0.8 * _RK4.stability_interval)))
            q = step(exchange, _RK4, time / steps, steps, q)
            operator = np.sqrt((off**2).mean() / (exact**2).mean())
            errors.append((operator, _solution_error(x, v, q, time)))
        for panel, error in zip(
            ("operator", "solution error"), zip(*errors, strict=True), strict=True
        ):
            rows.append({"panel": panel, "kind": kind, "power": power, "x": h, "y": np.mean(error)})
    return pd.DataFrame(rows)


def _order(accuracy: pd.DataFrame, panel: str, kind: str, power: float = 1.0) -> float:
    """The order in h over all levels."""
    part = accuracy.set_index(["panel", "kind", "power"]).sort_index().loc[(panel, kind, power)]
    ends = part.sort_values("x").iloc[[-1, 0]]
    return float(observed_order(ends["x"], ends["y"])[0])


def _findings(table: pd.DataFrame, accuracy: pd.DataFrame) -> Iterator[Finding]:
    skewed = table["kernel"].str.startswith("skewed")
    part = table[_LOST].abs() / table[_BOUND]
    irregular = skewed & (table["particles"] != "lattice")
    lost, kept = table.loc[irregular, _LOST].abs(), table.loc[~skewed, _LOST].abs()
    skew = Skewed()
    yield statement(
        "P-C3.conservative",
        (part[~skewed] < 1.0).all() and (part[irregular] > 1000.0).all(),
        f"Symmetric kernels, {len(kept)} cases (lattice, mapped, jittered, random, random with any volumes, 2-D): "
        f"|sum Q(T) / sum Q(0) - 1| <= {kept.max():.1g}, at most {part[~skewed].max():.2g} of the bound of round-off. "
        f"A kernel with M_1 = {abs(moment(skew, 1)):.1g} and M_2 = {moment(skew, 2):g} that is not symmetric changes "
        f"it by {lost.min():.1g} to {lost.max():.1g} on irregular particles.",
        "The total strength changes with a symmetric kernel, or does not with the other.",
    )
    names = ("lattice, eps = 2 h", "smooth map", "jittered, eps = 2 h", "jittered, eps ~ h^(1/2)")
    orders = [_order(accuracy, "operator", kind, power) for kind, power in _RULES]
    listed = ", ".join(f"{name}: {order:.2f}" for name, order in zip(names, orders, strict=True))
    yield statement(
        "P-C3.arbitrary_positions",
        all(order > 1.5 for order in orders),
        f"Power of h in the error of f'' by (26), root mean square: {listed}. The last is the power "
        f"{2.0 * orders[-1]:.2f} of eps. The solution on jittered particles with eps = 2 h: "
        f"{_order(accuracy, 'solution error', 'jittered'):.2f}.",
        "Moments over the line do not see where the particles are: on irregular ones the error of quadrature "
        "has a random part of the order (h/eps)^(5/2) / eps. The second order in eps comes back only if eps / h "
        "grows; on a smooth map of a lattice it is not lost.",
    )
