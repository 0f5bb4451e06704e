"""The diffusion velocity where a field is weak, of both signs, or remeshed; and where particles meet."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from fracparticles.moving import dvm
from fracparticles.special.ends import heat_kernel
from fracparticles.special.tails import tail_constant
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe, off
from scenes.extremes.moving_particles.cloud import ALPHA, START, TIME, WORD, Cloud

# The sums state 1e-11 of the peak; a velocity is a quotient of two of them, and u at the ends is 1e-3 of it.
_SAME = 1e-7
_REMESHINGS = ("M4'", "Lambda3")


def weak(cloud: Cloud) -> Iterator[Probe]:
    """A field below the round-off of the sums at the ends, beta near one; pairs, or a threshold, carry it."""
    wide, refused = Cloud(20.0, 2.0 * cloud.h), Kind("weak field", must=REFUSED)
    error = partial(wide.error, heat_kernel, alpha=2.0 - 1e-9)
    case = "β = 1 - 1e-9, tail 1e-14 of the peak"
    yield refused(f"{case}, transforms", error)
    right = Kind("weak field", "the Gaussian", wide.smoothing(2.0), "closed form", HELD)
    yield right(f"{case}, pairs", partial(error, summation="naive", remeshing="none"))
    yield right(f"{case}, threshold 1e-8", partial(error, threshold=1e-8))
    same = Kind("weak field", "the same particles", _SAME, "scaling")
    for unit in (1e-30, 1e30):
        yield same(f"lengths times {unit:g}, times times {unit:g}^α", _other_units, cloud, unit)
    left_out = Kind("weak field", "left out", must=HELD)
    yield left_out("strengths of zero at the ends", _kept, cloud, 0.0)
    yield refused("strengths of 1e-320 at the ends", _kept, cloud, 1e-320)
    yield refused("strengths that all underflow", lambda: cloud.run(1e-320 * cloud.u()))


def _other_units(cloud: Cloud, unit: float) -> float:
    plain = cloud.run(exterior="open", steps=20)
    times = {"dt": TIME / 20 * unit**ALPHA, "start": START * unit**ALPHA}
    how: dict[str, Any] = {"spacing": unit * cloud.h, "alpha": ALPHA, "exterior": "open", **times}
    other = dvm.run(unit * cloud.x, cloud.u() / unit, steps=20, **how)
    return off(other.x / unit, plain.x, cloud.h)


def _kept(cloud: Cloud, ends: float) -> float:
    u = cloud.u()
    u[:3] = u[-3:] = ends
    return float(cloud.run(u, time=0.01, remeshing="none").x.size - (cloud.x.size - 6))


def signs(cloud: Cloud) -> Iterator[Probe]:
    """A velocity Q / u has no meaning where u is zero, and does not know the sign of u."""
    yield Kind("sign", "the same paths, bit for bit", must=HELD)(
        "a field that is negative everywhere",
        lambda: off(cloud.run(-cloud.u()).x, cloud.run().x, 1.0),
    )
    dipole, step = np.sin(cloud.x) * cloud.u(), np.where(np.abs(cloud.x) < 1.0, 1.0, 0.0)
    yield from Kind("sign", must=REFUSED).of(
        {
            "a field of both signs": lambda: cloud.run(dipole),
            "zero but for the middle, order IV": lambda: cloud.run(step, order=4),
        }
    )
    # The flux of what is cut off at a distance r is A r^(1-alpha) / (alpha - 1); that of the other end goes against it.
    a = tail_constant(ALPHA) / ALPHA
    bound = TIME * a * (0.5 * cloud.half_width) ** (1.0 - ALPHA) / (ALPHA - 1.0)
    still = Kind("sign", "no motion but for the ends", float(bound), "closed form")
    yield still("a uniform field between its ends", _uniform_moves, cloud)


def _uniform_moves(cloud: Cloud) -> float:
    run = cloud.run(np.ones(cloud.x.size), remeshing="none")
    middle = np.abs(cloud.x) < 0.5 * cloud.half_width
    return float(np.abs(run.x - cloud.x)[middle].max())


def crossing(cloud: Cloud) -> Iterator[Probe]:
    """Particles in any order, in one place, or nearly; and those that cross since the step is too large."""
    shuffled = np.random.default_rng(3).permutation(cloud.x.size)
    twice = np.repeat(np.arange(cloud.x.size), 2)
    same = Kind("crossing", "the same paths", _SAME, "the plain run")
    cases = {
        "particles in any order": (cloud, shuffled, 0.0),
        "particles each in two halves, in one place": (cloud, twice, 0.0),
        "particles each in two halves, 1e-14 apart": (cloud, twice, 1e-14),
    }
    yield from same.over(_same_paths, cases)
    yield Kind("crossing", *WORD)("steps of three times the limit", lambda: cloud.error(factor=3.0))


def _same_paths(cloud: Cloud, places: np.ndarray, shift: float) -> float:
    how: dict[str, Any] = {"remeshing": "none", "steps": 10}
    x = cloud.x[places] + shift * (np.arange(places.size) % 2)
    other = cloud.run((cloud.u() / np.bincount(places))[places], x=x, **how)
    return off(other.x, cloud.run(**how).x[places], cloud.h)


def remeshed(cloud: Cloud, orders: Sequence[int]) -> Iterator[Probe]:
    """Remeshing at every step, when asked for, and never, onto either exterior."""
    source = "fundamental solution"
    right = Kind("remeshing runs", "the solution", cloud.smoothing(), source, HELD)
    when = {"every step": 1.0 + 1e-9, "by itself": None, "gaps of 5 h": 5.0}
    for order, exterior in product(orders, dvm.EXTERIORS):
        error = partial(cloud.error, order=order, exterior=exterior)
        for name, (often, above) in product(_REMESHINGS, when.items()):
            case = f"order {order}, {exterior}, {name}, {often}"
            yield right(case, partial(error, remeshing=name, remesh_above=above))
        yield right(f"order {order}, {exterior}, never", partial(error, remeshing="none"))
    # Each of some fifty remeshings rounds every strength some ten times.
    found = Kind("remeshing runs", "every strength is found", 500.0 * EPS, "exact sums")
    for name in _REMESHINGS:
        yield found(f"{name}, extended lattice", _unaccounted, cloud, name)


def _unaccounted(cloud: Cloud, name: str) -> float:
    often: dict[str, Any] = {"remeshing": name, "remesh_above": 1.0 + 1e-9, "factor": 0.1}
    run = cloud.run(**often, lattice="extended", threshold=1e-4)
    found = math.fsum(run.strength) + run.history.eliminated_strength
    return abs(found / math.fsum(cloud.h * cloud.u()) - 1.0)
