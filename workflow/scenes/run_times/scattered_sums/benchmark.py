"""Run times of the sums over particles that lie anywhere on the line, as DVM needs them."""

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from fracparticles.moving.scattered import scattered_sum, smooth_kernel
from fracstudy.race.clock import Measurements, measure, one_core, timings_dataset

_BETA = 0.5
_OVERLAP = 2.0  # smoothing length over the mean spacing

_VARIABLES = {
    "transform_time": ("both sums by the non-uniform FFT, one core, minimum", "s"),
    "naive_time": ("both sums over all pairs, one core, minimum", "s"),
    "deviation": ("largest deviation of the two, over the largest value", "1"),
}


def benchmark(
    particles: Sequence[int], naive_particles: float, repeats: int, seconds: float
) -> Measurements:
    """Time field (7) and flux (19) of scattered particles by non-uniform FFT, of few also over all pairs.

    Few are up to `naive_particles`. A timing is repeated `repeats` times, fewer if that takes longer than `seconds`.
    """
    one_core()
    rows = [_measure_one(int(n), naive_particles, repeats, seconds) for n in particles]
    labels = {"particles": "number of particles"}
    title = "Run times of sums over scattered particles"
    return timings_dataset("size", rows, labels, _VARIABLES, title, {"repeats": repeats})


def _measure_one(n: int, naive_particles: float, repeats: int, seconds: float) -> dict[str, Any]:
    kernels = [smooth_kernel(name, 1.0 + _BETA, 2) for name in ("eta", "F")]
    x = np.sort(np.random.default_rng(0).uniform(0.0, 1.0, n))
    q = np.exp(-np.square(6.0 * (x - 0.5))) / n
    fast = scattered_sum("fft", kernels, _OVERLAP / n)
    fast(x, q)  # makes its box, which the particles leave only now and then
    transform, sums = measure(partial(fast, x, q), repeats, seconds)
    row: dict[str, Any] = {"particles": n, "transform_time": transform.minimum}
    if n <= naive_particles:
        naive = scattered_sum("naive", kernels, _OVERLAP / n)
        naive(x[:2], q[:2])  # compiles
        pairs, exact = measure(partial(naive, x, q), repeats, seconds)
        row["naive_time"] = pairs.minimum
        row["deviation"] = (np.abs(sums - exact).max(axis=1) / np.abs(exact).max(axis=1)).max()
    return row
