"""The scenes of the lecture note, on tiny grids."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fracparticles.pse import GAUSSIAN_20, StrengthExchange, moment, regularised
from fracstudy.claims import read_claims
from fracstudy.inputs import Inputs
from scene_functions import figure, scenes, study
from scenes.particle_note.note_conservation.study import Skewed, arranged, heat, heat_second
from scenes.particle_note.waves import wave

PRINTED = Path(__file__).resolve().parents[3] / "report/printed/particle_note.yaml"
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
REFUTED = {
    "P-F1.kernel",
    "P-F1.sifting",
    "P-C1.regularisation_norm",
    "P-C1.quadrature_norm",
    "P-C1.law",
    "P-C3.arbitrary_positions",
}


@pytest.fixture(scope="module")
def results():
    items = {name: scenes()[name].items for name in SCENES}
    return {name: study(name)(Inputs(name, items[name]), **given) for name, given in SCENES.items()}


def test_every_claim_of_the_note_has_one_finding(results):
    found = [finding.claim for result in results.values() for finding in result.findings]
    assert sorted(found) == sorted(claim.id for claim in read_claims(PRINTED))


def test_the_verdicts_hold_on_small_grids_too(results):
    for result in results.values():
        for finding in result.findings:
            assert finding.verdict is (finding.claim not in REFUTED), finding
            assert bool(finding.reason) is not finding.verdict


@pytest.mark.parametrize("name", SCENES)
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
    assert heat_second(x, 0.5) == pytest.approx(second(lambda y: heat(y, 0.5)), abs=2e-6)


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
            rate = exchange.apply(v * heat(x, 0.5)) / v
            integral = regularised(lambda y: heat(y, 0.5), x[inside], epsilon, GAUSSIAN_20, 2)
            squares.append(np.mean((rate[inside] - integral) ** 2))
        errors.append(np.sqrt(np.mean(squares)))
    # About 6 * 20 independent radii within |x| < 4: each mean is good to 10 %, the power to 0.1.
    assert np.log(errors[0] / errors[1]) / np.log(4.0) == pytest.approx(2.5, abs=0.2)
