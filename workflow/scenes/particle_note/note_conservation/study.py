"""Particle strength exchange (26) on particles anywhere (Sec. 3): what it conserves, and what irregularity costs."""

from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles import pse
from fracparticles.pse import GAUSSIAN_20, Kernel, StrengthExchange, construct, moment
from fracparticles.pse import derivative as derivative_by_sum
from fracparticles.run.orders import observed_order
from fracparticles.special.ends import heat_kernel
from fracparticles.time import STEP_POLYNOMIALS, step
from fracstudy.errors import EPS, off
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import fitted_power
from fracstudy.panels import Panels
from scenes.particle_note.waves import (
    CENTRE,
    SEED,
    START,
    Skewed,
    arranged,
    rms_error,
    second_derivative_error,
)

_ACCURACIES = (2, 4, 6)
_WIDE = 0.4  # the power of h in eps with which the second order in eps is met on particles anywhere
_MORE = 4  # times as many seeds
_RK4 = STEP_POLYNOMIALS["rk4"]
_LOST = "ΣQ(T) / ΣQ(0) - 1"
_BOUND = "round-off, bound"
_KINDS = ("lattice", "mapped", "jittered", "random")
# Arrangement and power of h in eps; the last has eps = overlap h on the coarsest level and widens it from there.
_RULES = (("lattice", 1.0), ("mapped", 1.0), ("jittered", 1.0), ("jittered", 0.5))


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

    The bound of round-off in |sum Q(t) / sum Q(0) - 1| is 4 eps log2(N) rate T: what it adds up to in a sum of N rates
    over the time T, as `rate` bounds the rates. The skewed kernel meets the same conditions on M_1 and M_2. Accuracy:
    the relative error of f'' (root mean square) and of f(x, T) (sum) for |x| < 4, averaged over random seeds.
    """
    n, domain = particles, (half_width, jitter)
    epsilon = overlap * 2.0 * half_width / n
    kernels: dict[str, Kernel] = {
        "Gaussian (20)": GAUSSIAN_20,
        "order 4": construct(2, 4),
        "skewed (20)": Skewed(),
    }
    rows: list[dict[str, Any]] = []
    panels = Panels()
    for kind in _KINDS:
        x, v = arranged(kind, n, *domain)
        for name, kernel in kernels.items():
            exchange = StrengthExchange(x, v, epsilon, kernel)
            row, history, q = _run(exchange, v * heat_kernel(x, START), time)
            row["error of f(x, T)"] = _solution_error(x, v, q, time)
            rows.append({"particles": kind, "kernel": name, **row})
            panels.add(**history, panel="mass", kind=kind, series=name)
            if name == "Gaussian (20)" and kind == "random":
                panels.add("solution", x=x, y=q / v, volume=v)
    x = np.linspace(-5.0, 5.0, 301)
    panels.add("exact", x=x, y=heat_kernel(x, START + time))
    for (kind, name), exchange, q in (_any_volumes(n, half_width, epsilon), _two_dimensions(n)):
        rows.append({"particles": kind, "kernel": name, **_run(exchange, q, time)[0]})
    table = pd.DataFrame(rows)
    accuracy = _accuracy(domain, overlap, time, numbers, seeds)
    findings = [
        _conserved(table),
        _same_as_21(n, domain, epsilon),
        _high_order(numbers, half_width, overlap),
        _anywhere(accuracy, domain, overlap, numbers, seeds),
    ]
    panels.add(**accuracy)
    return Result(table, inputs.judged(findings), panels.frame)


def _run(
    exchange: StrengthExchange, q: np.ndarray, time: float
) -> tuple[dict[str, Any], dict[str, np.ndarray], np.ndarray]:
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
        _BOUND: 4.0 * EPS * np.log2(exchange.size) * exchange.rate * time,
    }
    times = np.linspace(0.0, time, parts + 1)
    return row, {"x": times, "y": np.abs(change)}, q


def _solution_error(x: np.ndarray, v: np.ndarray, q: np.ndarray, time: float) -> float:
    inside = np.abs(x) < CENTRE
    final = (v * heat_kernel(x, START + time))[inside]
    return float(np.abs(q[inside] - final).sum() / final.sum())


_Case = tuple[tuple[str, str], StrengthExchange, np.ndarray]


def _any_volumes(n: int, half_width: float, epsilon: float) -> _Case:
    """Positions and volumes that have nothing to do with each other: no diffusion, but conserved all the same."""
    random = np.random.default_rng(SEED)
    x = random.uniform(-half_width, half_width, n)
    v = random.exponential(2.0 * half_width / n, n)
    exchange = StrengthExchange(x, v, epsilon, GAUSSIAN_20)
    return ("random, any volumes", "Gaussian (20)"), exchange, random.normal(1.0, 1.0, n)


def _two_dimensions(n: int) -> _Case:
    """Uniform random particles in a square of side 4, equal volumes, the Laplacian of order 2."""
    x = np.random.default_rng(SEED).uniform(-2.0, 2.0, (n, 2))
    volume = 16.0 / n
    exchange = StrengthExchange(x, volume, 2.0 * np.sqrt(volume), pse.construct_laplacian(2, 2))
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
            x, v, exchange, operator = _tried(kind, n, domain, seed, epsilon)
            steps = int(np.ceil(exchange.rate * time / (0.8 * _RK4.stability_interval)))
            q = step(exchange, _RK4, time / steps, steps, v * heat_kernel(x, START))
            errors.append((operator, _solution_error(x, v, q, time)))
        where = {"kind": kind, "power": power, "x": h}
        for panel, error in zip(("operator", "solution error"), np.transpose(errors), strict=True):
            rows.append({"panel": panel, **where, "y": np.mean(error)})
    return pd.DataFrame(rows)


def _tried(
    kind: str, n: int, domain: tuple[float, float], seed: int, epsilon: float
) -> tuple[np.ndarray, np.ndarray, StrengthExchange, float]:
    """Particles, their volumes, the exchange with (20), and its root mean square error of f'' for |x| < 4."""
    x, v = arranged(kind, n, *domain, seed)
    exchange = StrengthExchange(x, v, epsilon, GAUSSIAN_20)
    return x, v, exchange, rms_error(exchange, x, v)


def _conserved(table: pd.DataFrame) -> Finding:
    """The change of the total strength over the bound of round-off, and that by the skewed kernel."""
    skewed, skew = table["kernel"].str.startswith("skewed"), Skewed()
    share = (table[_LOST].abs() / table[_BOUND]).rename(None)
    share.index = pd.MultiIndex.from_frame(table[["particles", "kernel"]], names=[None, None])
    irregular = skewed & (table["particles"] != "lattice")
    lost, kept = (table.loc[rows, _LOST].abs() for rows in (irregular, ~skewed))
    return measured(
        "P-C3.conservative",
        share=share[~skewed.to_numpy()],
        skewed_share=share[irregular.to_numpy()].min(),
        kept=kept.max(),
        lost=dict(zip(table.loc[irregular, "particles"], lost, strict=True)),
        first=abs(moment(skew, 1)),
        second=moment(skew, 2),
    )


def _same_as_21(n: int, domain: tuple[float, float], epsilon: float) -> Finding:
    """(26) against V_i D times (21) with f = Q / V, on irregular particles."""
    deviation = {}
    for kind in _KINDS:
        x, v = arranged(kind, n, *domain)
        f = heat_kernel(x, START)
        direct = v * derivative_by_sum(x, f, x, f, v, epsilon, GAUSSIAN_20, 2)
        exchanged = StrengthExchange(x, v, epsilon, GAUSSIAN_20).apply(v * f)
        deviation[kind] = off(exchanged, direct)
    return measured("P-C3.from_21", deviation=deviation)


def _high_order(numbers: list[int], half_width: float, overlap: float) -> Finding:
    """The order of (21) with kernels of more accuracy, on the two coarsest lattices, where there is no round-off."""
    spacing = 2.0 * half_width / np.array(sorted(numbers)[:2])
    power = {}
    for r in _ACCURACIES:
        error = [second_derivative_error(construct(2, r), h, overlap) for h in spacing]
        power[f"r = {r}"] = abs(float(observed_order(spacing, error)[-1]) - r)
    return measured("P-C3.high_order", deviation=power)


def _anywhere(
    accuracy: pd.DataFrame,
    domain: tuple[float, float],
    overlap: float,
    numbers: list[int],
    seeds: int,
) -> Finding:
    """The power of eps in the error of f'': two less it.

    With eps as h^p the quadrature's part (h/eps)^(5/2) / eps falls as eps^2 or faster for p up to 5/11; p is 2/5 here.
    """
    fixed, wide = f"ε = {overlap:g} h", "ε ∝ h^(2/5)"
    names = {"lattice": "lattice", "mapped": "smooth map", "jittered": "jittered"}
    order = partial(_order, accuracy)
    power = {f"{name}, {fixed}": order("operator", kind) for kind, name in names.items()}
    coarsest = 2.0 * domain[0] / min(numbers)
    # Errors on random particles with wide kernels differ the most from seed to seed.
    for kind, rule, tries in (("random", fixed, 1), ("jittered", wide, 1), ("random", wide, _MORE)):
        h = np.array([domain[0] / n for n in numbers])  # twice as fine as those of the table
        widened = 1.5 * overlap * coarsest * (h / coarsest) ** _WIDE
        radii = overlap * h if rule == fixed else widened
        error = [
            np.mean([_tried(kind, 2 * n, domain, s, e)[-1] for s in range(tries * seeds)])
            for n, e in zip(numbers, radii, strict=True)
        ]
        power[f"{kind}, {rule}"] = fitted_power(radii, error)
    short = {case: 2.0 - p for case, p in power.items()}
    solution = order("solution error", "jittered")
    return measured("P-C3.arbitrary_positions", short=short, power=power, solution=solution)


def _order(accuracy: pd.DataFrame, panel: str, kind: str, power: float = 1.0) -> float:
    """The order in h over all levels."""
    part = accuracy.set_index(["panel", "kind", "power"]).sort_index().loc[(panel, kind, power)]
    ends = part.sort_values("x").iloc[[-1, 0]]
    return float(observed_order(ends["x"], ends["y"])[0])
