"""The scenes of the lecture note, on tiny grids."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from fracparticles.pse import (
    GAUSSIAN_20,
    SplineKernel,
    StrengthExchange,
    lattice_moment,
    moment,
    regularised,
)
from fracparticles.special.ends import heat_kernel
from fracstudy.inputs import Inputs
from fracstudy.ledger import judge
from fracstudy.printed import read_claims
from fracstudy.verdicts import Status
from scene_functions import figure, scenes, study
from scenes.particle_note.note_lattice_kernel.study import SCHEMES
from scenes.particle_note.waves import Skewed, arranged, heat_second, wave
from sweeps import few

PRINTED = Path(__file__).resolve().parents[3] / "report/printed/particle_note"
CLAIMS = {claim.id: claim for claim in read_claims(PRINTED)}
SCENES = {
    "note_particles": {"spacing": 0.25, "half_width": 8.0, "overlap": [0.5, 1.0], "shown": 1.0},
    "note_kernels": {
        "derivative": [1, 2],
        "accuracy": [2, 4],
        "shown": [1, 2],
        "spacing": [0.1, 0.05],
        "overlap": 2.0,
    },
    "note_lattice_kernel": {
        "claimed_moment": [8, 3],
        "overlap": [1.0, 2.0],
        "spacing": [0.4, 0.2],
        "accuracy": [2, 4],
    },
    "note_error_law": {
        "derivative": [0, 1, 3],
        "accuracy": [2, 4],
        "epsilon": [0.4, 0.2],
        "degree": [1, 3],
        "radius": 0.2,
        "overlap": [6.0, 101],
        "coarse": 0.7,
        "ratio": [2.0, 0.5],
        "spacing": [0.2, 0.1],
        "radii": [0.1, 3.2, 12],
    },
    "note_conservation": {
        "particles": 100,
        "half_width": 8.0,
        "jitter": 0.3,
        "overlap": 2.0,
        "time": 0.2,
        "numbers": [80, 320],
        "seeds": 2,
    },
}
# What does not hold, on grids of any size.
EXCEPTIONS = {
    "P-F1.kernel": Status.MISPRINT,
    "P-F1.sifting": Status.MISPRINT,
    "P-C1.regularisation_norm": Status.MISPRINT,
    "P-C1.quadrature_norm": Status.PART,
    "P-C1.law": Status.PART,
    "P-C3.arbitrary_positions": Status.PART,
}


@pytest.fixture(scope="module")
def results():
    items = {name: scenes()[name].items for name in SCENES}
    return {name: study(name)(Inputs(name, items[name]), **given) for name, given in SCENES.items()}


@pytest.fixture(scope="module")
def found(results):
    findings = [finding for result in results.values() for finding in result.findings]
    assert sorted(finding.claim for finding in findings) == sorted(CLAIMS)
    return {finding.claim: finding for finding in findings}


def test_the_verdicts_hold_on_small_grids_too(found):
    statuses = {key: judge(CLAIMS[key], finding) for key, finding in found.items()}
    exceptions = {key: s for key, s in statuses.items() if s is not Status.REPRODUCED}
    assert exceptions == EXCEPTIONS


def test_the_bound_of_quadrature_is_broken_by_low_powers_of_x(found):
    """The sum sees M^_2 for M_2: for x^2 it is off by M^_2 - 2, though the m-th derivative is zero for m > 2."""
    residual = found["P-C1.quadrature_norm"].numbers["residual"]
    off = abs(lattice_moment(SplineKernel(3), 2, 1.5) - 2.0)
    assert residual["m = 2"] < 1e-12
    assert residual["m = 4"] >= off > 0.01


def test_the_schemes_of_the_textbooks_are_exact_for_polynomials():
    for beta, weights in SCHEMES.values():
        sums = [sum(w * j**k for j, w in weights.items()) for k in range(beta + 1)]
        assert sums == [0] * beta + [math.factorial(beta)]


def test_second_order_on_irregular_particles_needs_wider_kernels(found):
    power = found["P-C3.arbitrary_positions"].numbers["power"]
    assert power["jittered, ε = 2 h"] < 0.0
    assert power["jittered, ε ∝ h^(2/5)"] == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("name", few(SCENES))  # the smoke run draws all of them
def test_the_figure_is_drawn(results, name):
    result = results[name]
    drawn = figure(name)(result.series, result.table, SCENES[name])
    drawn.draw_without_rendering()
    assert all(ax.lines or ax.collections for ax in drawn.axes)


def test_the_constants_of_the_law_are_the_predicted_ones(results):
    table = results["note_error_law"].table.dropna(subset="constant")
    # The next term of the regularisation is smaller by epsilon^2 / 4 at the most: 1 %.
    ratio = table["constant"] / table["predicted constant"]
    assert ratio.between(0.98, 1.02).all()


def test_waves_and_the_heat_kernel_have_their_derivatives():
    x, h = np.linspace(-1.0, 2.0, 7), 1e-3

    def second(f):
        return (f(x + h) - 2.0 * f(x) + f(x - h)) / h**2

    # The difference has the error h^2 / 12 times a fourth derivative of at most 16.
    assert wave(x, 2.0, 2) == pytest.approx(second(lambda y: wave(y, 2.0)), abs=2e-6)
    assert heat_second(x, 0.5) == pytest.approx(second(lambda y: heat_kernel(y, 0.5)), abs=2e-6)


def test_the_skewed_kernel_differs_by_its_third_moment_only():
    skewed = Skewed()
    assert moment(skewed, 1) == pytest.approx(0.0, abs=1e-14)
    assert moment(skewed, 2) == pytest.approx(2.0, rel=1e-13)
    assert abs(moment(skewed, 3)) > 0.1


@pytest.mark.parametrize("kind", ["lattice", "mapped", "jittered", "random"])
def test_volumes_fill_the_domain(kind):
    x, v = arranged(kind, 64, 8.0, 0.3)
    assert (np.diff(x) > 0.0).all()
    # The cells at the ends are as wide outside as inside.
    assert v.sum() == pytest.approx(16.0, abs=3.0 * v.max())


def test_the_random_error_of_jittered_particles_falls_with_the_power_five_halves():
    """The error of the trapezoidal rule, (h / eps)^2, times the square root of h / eps, at a fixed radius."""
    epsilon, errors = 0.4, []
    for n in (320, 1280):
        squares = []
        for seed in range(6):
            x, v = arranged("jittered", n, 8.0, 0.3, seed)
            inside = np.abs(x) < 4.0
            exchange = StrengthExchange(x, v, epsilon, GAUSSIAN_20)
            rate = exchange.apply(v * heat_kernel(x, 0.5)) / v
            integral = regularised(
                lambda y: heat_kernel(y, 0.5), x[inside], epsilon, GAUSSIAN_20, 2
            )
            squares.append(np.mean((rate[inside] - integral) ** 2))
        errors.append(np.sqrt(np.mean(squares)))
    # About 6 * 20 independent radii within |x| < 4: each mean is good to 10 %, the power to 0.1.
    assert np.log(errors[0] / errors[1]) / np.log(4.0) == pytest.approx(2.5, abs=0.2)
