"""Exchange forms on irregular particles: what they conserve, what accuracy they lose, and when they grow."""

from collections.abc import Callable, Iterator, Sequence
from itertools import product

import numpy as np
from scipy.interpolate import CubicSpline

from fracparticles.schemes import Setting
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import EPS, HELD, Kind, Probe, frame, off, probes_of
from scenes.extremes.irregular_particles import companions, theory
from scenes.extremes.irregular_particles.operators import (
    ALPHA,
    CONSERVATIVE,
    FORMS,
    arranged,
    matrix,
    rate_of_change,
    solution,
)

_INNER = 0.5  # of the half-width: where errors are taken
_FINER = 4  # lattice of a reference
_USUAL = 2.0  # epsilon / h


def study(
    inputs: Inputs,
    *,
    particles: int,
    half_width: float,
    overlap: float,
    jitters: Sequence[float],
    seeds: int,
    levels: Sequence[int],
) -> Result:
    """One row a probe. The series: relative errors of du/dt against the jitter, and against h."""
    x = np.linspace(-half_width, half_width, particles)
    probes = [
        *_lattice(overlap),
        *_conserved(x, overlap),
        *probes_of(theory, companions, x=x, overlap=overlap, seeds=seeds),
    ]
    panels = Panels()
    _add_jitter(panels, x, overlap, jitters, seeds)
    _add_spacing(panels, half_width, levels, seeds)
    return Result(frame(probes), (), panels.frame[["series", "x", "y", "right", "panel"]])


def _lattice(overlap: float) -> Iterator[Probe]:
    """On a lattice each form is the scheme of the library, whose sums are transforms."""
    same = Kind("lattice", "the scheme", 1e-12, "dense matrix", HELD)
    for form in FORMS:
        yield same(f"{form}, written out", _off_lattice, form, overlap)


def _off_lattice(form: str, overlap: float) -> float:
    setting = Setting(n=30, spacing=0.1, alpha=ALPHA, overlap=overlap)
    x = 0.1 * np.arange(-30, 31)
    ours = matrix(form, x, np.full(x.size, 0.1), 0.1 * overlap)
    return off(ours, scheme_matrix(form, setting))


def _conserved(x: np.ndarray, overlap: float) -> Iterator[Probe]:
    """sum V du/dt is round-off of its terms, whatever the positions, whatever the volumes; DD has no such luck."""
    # Each term is rounded some times, and the sum of N^2 adds a digit.
    kept = Kind("conservation", "Σ V u kept", 64.0 * EPS, "exact sums", HELD)
    arrangements = (("jittered", 0.1), ("jittered", 0.5), ("random", 0.0), ("clustered", 0.0))
    for form, (kind, jitter), right in product(CONSERVATIVE, arrangements, (True, False)):
        places = f"{kind} {jitter:g}" if jitter else kind
        name = f"{form}, {places}, {theory.volumes(right)}"
        yield kept(name, _lost, form, x, overlap, kind, jitter, right)


def _lost(form: str, x: np.ndarray, overlap: float, kind: str, jitter: float, right: bool) -> float:
    h = float(x[1] - x[0])
    places, volumes = arranged(kind, x, jitter, seed=1)
    if not right:
        volumes = np.random.default_rng(2).exponential(h, x.size)
    a = matrix(form, places, volumes, overlap * h)
    terms = volumes[:, None] * a * solution(places)
    return float(abs(terms.sum()) / np.abs(terms).sum())


Rate = Callable[[np.ndarray], np.ndarray]


def _add_jitter(
    panels: Panels, x: np.ndarray, overlap: float, jitters: Sequence[float], seeds: int
) -> None:
    """What disorder alone costs: against the same form on a lattice four times as fine, with the same epsilon."""
    epsilon = overlap * float(x[1] - x[0])
    fine = np.linspace(x[0], x[-1], _FINER * (x.size - 1) + 1)
    volumes = np.full(fine.size, float(fine[1] - fine[0]))
    for form in FORMS:
        smooth = matrix(form, fine, volumes, epsilon) @ solution(fine)
        reference = CubicSpline(fine, smooth)
        for jitter, right in product(jitters, (True, False)):
            y = _error(form, x, overlap, jitter, right, seeds, reference)
            panels.add("jitter", form, jitter, y, right=right)
    for jitter, right in product(jitters, (True, False)):
        y = theory.predicted("KPSE", x, epsilon, jitter, right)
        panels.add("jitter", "KPSE, predicted", jitter, y, right=right)


def _error(
    form: str, x: np.ndarray, overlap: float, jitter: float, right: bool, seeds: int, exact: Rate
) -> float:
    """The root mean square error of du/dt in |x| < L/2 over that of du/dt, over the seeds."""
    h, missed, size = float(x[1] - x[0]), 0.0, 0.0
    for seed in range(seeds):
        places, volumes = arranged("jittered", x, jitter, seed, right)
        found = matrix(form, places, volumes, overlap * h) @ solution(places)
        inner = np.abs(places) < _INNER * x[-1]
        missed += float(((found - exact(places))[inner] ** 2).sum())
        size += float((rate_of_change(places)[inner] ** 2).sum())
    return float(np.sqrt(missed / size))


def _add_spacing(panels: Panels, half_width: float, levels: Sequence[int], seeds: int) -> None:
    """The whole error of KPSE, epsilon = 2 h."""
    for count, (jitter, right) in product(levels, ((0.0, True), (0.3, True), (0.3, False))):
        x = np.linspace(-half_width, half_width, count)
        y = _error("KPSE", x, _USUAL, jitter, right, seeds, rate_of_change)
        name = f"jitter 0.3, {theory.volumes(right)}" if jitter else "lattice"
        panels.add("spacing", name, float(x[1] - x[0]), y, right=right)
