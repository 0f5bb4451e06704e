"""The diffusion velocity at its limits: of steps, of the overlap, of the lattice, of the order, of few particles."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from fracparticles.moving import dvm
from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.stability import stability_limit, worst_wave
from fracparticles.special.ends import cauchy, heat_kernel
from fracparticles.special.stable import green
from fracparticles.special.tails import tail_constant
from fracstudy.probe import HELD, REFUSED, WARNED, Kind, Probe, off
from scenes.extremes.moving_particles.cloud import ALPHA, FACTORS, START, TIME, WORD, Cloud, missed

_HALF, _STEPS = 300, 3  # particles on either side of a wave, steps
_XI = 1e-5  # its height in spacings
OVERLAPS = (0.25, 0.4, 0.5, 0.6, 0.8, 1.0, 2.0, 4.0, 20.0)


def growth(orders: Sequence[int]) -> Iterator[Probe]:
    """A displacement wave on a uniform field: 1 + z + z^2/2 a step, z = dt A(k) of DD; beyond the limit it is told."""
    for order, factor in product(orders, FACTORS):
        # The ends stretch the middle by 2 A r^-alpha t, and z = -2 dt / a changes by as much.
        dt = factor * stability_limit("DD", ALPHA - 1.0, order)
        stretch = 2.0 * tail_constant(ALPHA) / ALPHA * _HALF**-ALPHA * _STEPS * dt
        bound = 2.0 * factor * abs(2.0 * factor - 1.0) * stretch
        must = WARNED if factor > 1.0 else HELD
        grows = Kind("step", "grows by 1 + z + z²/2", bound, "Fourier symbol", must)
        yield grows(f"order {order}, dt = {factor:g} a", missed, wave_growth, order, factor)


def wave_growth(order: int, factor: float) -> tuple[float, float]:
    """Return what a step of `factor` times the limit multiplies the fastest wave by, and the prediction."""
    setting = Setting(alpha=ALPHA, order=order)
    theta = worst_wave("DD", setting)
    dt = factor * stability_limit("DD", ALPHA - 1.0, order)
    x = np.arange(-_HALF, _HALF + 1.0)
    wave = np.cos(theta * x)

    how: dict[str, Any] = {"spacing": 1.0, "alpha": ALPHA, "order": order, "remeshing": "none"}
    ends = [
        dvm.run(at, np.ones(x.size), dt=dt, steps=_STEPS, **how).x for at in (x + _XI * wave, x)
    ]
    change = (ends[0] - ends[1]) / _XI
    middle = np.abs(x) < _HALF / 6.0
    ratio = float(change[middle] @ wave[middle] / (wave[middle] @ wave[middle]))
    z = dt * float(SCHEMES["DD"].symbol(np.array([theta]), setting)[0])
    return float(np.copysign(abs(ratio) ** (1.0 / _STEPS), ratio)), 1.0 + z + 0.5 * z * z


def overlaps(cloud: Cloud, orders: Sequence[int]) -> Iterator[Probe]:
    """Smoothing lengths from a quarter of the spacing to twenty times: wrong by more than 5 % only with a word."""
    word = Kind("overlap", *WORD)
    for order, overlap in product(orders, OVERLAPS):
        yield word(f"order {order}, ε = {overlap:g} h", case_error, cloud, order, overlap)


def case_error(cloud: Cloud, order: int, overlap: float) -> float:
    """Return the error (48) of a run of the public function, which says more than `dvm.run`."""
    grid = {"beta": ALPHA - 1.0, "half_width": cloud.half_width, "spacing": cloud.h}
    times = {"t_initial": START, "t_final": START + TIME}
    limit = stability_limit("DD", ALPHA - 1.0, order, overlap)
    dt = 0.5 * max(limit, 0.01) * cloud.h**ALPHA
    run = compute(Case(scheme="DVM", **grid, **times, dt=dt, order=order, overlap=overlap))
    return float(relative_l1_error(run.case, run.u))


def ends(cloud: Cloud) -> Iterator[Probe]:
    """Lattices too narrow, thresholds too large, data off the centre: wrong by more than 5 % only with a word."""
    word = Kind("ends", *WORD)
    for exterior, threshold in product(dvm.EXTERIORS, (1e-300, 1e-6, 1e-3, 0.02, 0.2, 0.9)):
        run = partial(cloud.error, exterior=exterior, threshold=threshold)
        yield word(f"{exterior}, threshold {threshold:g}", run)
    for exterior, width, time in product(dvm.EXTERIORS, (1.0, 2.0, 5.0), (0.5, 10.0)):
        run = partial(Cloud(width, cloud.h).error, exterior=exterior, time=time)
        yield word(f"{exterior}, |x| < {width:g}, T = {time:g}", run)
    places = {"at 0.3 of the half-width": 3.0 * 0.1, "at 0.8 of the half-width": 8.0 * 0.1}
    for where, share in (places | {"beyond the lattice": 3.0}).items():
        yield word(f"open, data {where}", _off_centre, cloud, share * cloud.half_width)


def _off_centre(cloud: Cloud, centre: float) -> float:
    run = cloud.run(np.asarray(green(cloud.x - centre, START, ALPHA)), exterior="open")
    z = np.linspace(-0.9, 0.9, 101) * cloud.half_width
    return off(run.field(z), green(z - centre, START + TIME, ALPHA))


def orders_of_the_equation(cloud: Cloud) -> Iterator[Probe]:
    """Orders next to 1 and 2 against the Cauchy and the Gaussian density; between, 1 - alpha of the difference."""
    for exterior, alpha in product(dvm.EXTERIORS, (1.0 + 1e-9, 1.001, 1.999, 2.0 - 1e-9)):
        nearest, beta = round(alpha), alpha - 1.0
        bound = cloud.smoothing(float(nearest)) + 2.0 * abs(alpha - nearest)
        # Transforms end at 1e-11 of the peak, where the Gaussian is below.
        narrow = Cloud(min(cloud.half_width, 6.0), cloud.h) if nearest == 2 else cloud
        exact = heat_kernel if nearest == 2 else cauchy
        written = f"{beta:.0e}" if beta < 0.5 else f"1 - {1.0 - beta:.0e}"
        run = partial(narrow.error, exact, alpha=alpha, exterior=exterior, steps=20)
        right = Kind("order", "the limit", bound, "closed form", HELD)
        yield right(f"{exterior}, β = {written}", run)


def few(cloud: Cloud) -> Iterator[Probe]:
    """One particle does not move, two move apart alike; the tails of an open exterior ask for sixteen."""
    alike = Kind("few", "move apart alike", 1e-12, "symmetry")
    yield alike("one particle", _few_moved, cloud, 1, expected="stays")
    yield alike("two particles", _few_moved, cloud, 2)
    refused = Kind("few", must=REFUSED)
    yield refused("15 particles, open", _few_moved, cloud, 15, "open")
    yield alike("17 particles, open", _few_moved, cloud, 17, "open", bound=1e-10)


def _few_moved(cloud: Cloud, count: int, exterior: str | None = None) -> float:
    x = cloud.h * (np.arange(count) - 0.5 * (count - 1))
    how: dict[str, Any] = {} if exterior is None else {"exterior": exterior}
    run = cloud.run(np.ones(count), x=x, steps=3, time=0.01, remeshing="none", **how)
    return float(np.abs(run.x + run.x[::-1]).max())
