"""What a coefficient on the particles says of itself: `variable.resolution`, and who warns of it."""

import warnings

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.errors import AccuracyWarning
from fracparticles.schemes.setting import Setting
from fracparticles.variable import FORMS, VariableDiffusivity, VariableOrder
from fracparticles.variable.resolution import unresolved

LINE = np.linspace(-4.0, 4.0, 81)


def said(do):
    """The texts of the warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        do()
    return [str(one.message) for one in caught]


@pytest.mark.parametrize("overlap", [0.5, 1.0, 2.0, 2.6])
def test_a_cubic_is_resolved_to_round_off(overlap):
    """The interpolation is exact for it; values from 130 to 270, whose rounding is a part of the least."""
    d = 200.0 + LINE - 0.1 * LINE**2 + LINE**3
    assert unresolved(d, overlap) <= 16.0 * np.finfo(float).eps


def test_a_jump_from_zero_is_missed_by_a_half():
    """The last zero has 0, 1 at its near neighbours and 0, 1 at the far ones: (9 - 1) / 16."""
    assert unresolved(np.where(LINE > 0.01, 1.0, 0.0), 1.0) == 0.5


@pytest.mark.parametrize("below", [0.9, 0.5, 0.1])
def test_a_jump_is_missed_by_half_of_its_height(below):
    assert unresolved(np.where(LINE > 0.01, 1.0, below), 2.0) == pytest.approx(0.5 * (1.0 - below))


def test_it_has_no_unit_and_no_direction():
    d = 1.0 + 0.8 * np.tanh(LINE / 0.1)
    found = unresolved(d, 2.0)
    assert unresolved(2.0**200 * d, 2.0) == found  # a power of two: to the bit
    assert unresolved(d[::-1], 2.0) == found
    assert unresolved(np.outer(np.ones(81), d), 2.0) == found
    assert unresolved(np.outer(d, np.ones(81)), 2.0) == found


def test_what_is_constant_zero_or_short_says_nothing():
    assert unresolved(np.full(40, 3.0), 2.0) == 0.0
    assert unresolved(np.zeros(40), 2.0) == 0.0
    assert unresolved(np.array([1.0, 0.0, 1.0]), 1.0) == 0.0


def test_a_negligible_part_is_not_asked():
    """A Gaussian falls by powers of ten from particle to particle where it is nothing."""
    assert unresolved(np.exp(-0.5 * np.linspace(-20.0, 20.0, 201) ** 2), 1.0) < 0.02


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("dim", [1, 2])
def test_a_jump_and_a_wave_of_the_lattice_are_told_once(form, dim):
    setting = Setting(alpha=1.5, n=16, spacing=0.25, order=2, dim=dim, exterior="truncated")
    for wild in (lambda x: np.where(x > 0.0, 1.0, 0.1), lambda x: 1.5 + np.cos(np.pi * x / 0.25)):
        operator, u = VariableDiffusivity(form, setting), np.ones(setting.shape)
        d = np.broadcast_to(wild(operator.points[-1]), operator.points_shape)
        first, again = said(lambda: operator.apply(u, d)), said(lambda: operator.apply(u, 2.0 * d))  # noqa: B023
        assert len(first) == 1
        assert "varies faster than particles of spacing 0.25" in first[0]
        assert again == []


def test_a_diffusivity_that_changes_in_time_is_judged_each_time():
    """The first may be constant: what it says of the ends and of the particles is not what the next says."""
    setting = Setting(alpha=1.5, n=40, spacing=0.25, order=4, exterior="open")
    operator, u = VariableDiffusivity("FPSE", setting), np.ones(setting.shape)
    (x,) = operator.points
    assert said(lambda: operator.apply(u, 1.0)) == []
    (slope,) = said(lambda: operator.apply(u, 1.0 + np.exp(0.1 * x)))
    assert "in the outer quarter of the lattice" in slope
    (jump,) = said(lambda: operator.apply(u, np.where(x > 0.1, 2.0, 0.5)))
    assert "varies faster than" in jump


@pytest.mark.parametrize("width", [1e-3, 0.05, 0.1, 0.4])
@pytest.mark.parametrize("below", [0.05, 0.5, 0.9])
def test_a_run_is_within_three_per_cent_or_is_warned_of(width, below):
    """Against a quarter of the spacing; steps off the particles, of D and so of the slope of u."""

    def run(spacing):
        step = f"{0.5 * (1.0 + below)} + {0.5 * (1.0 - below)}*tanh((x - 0.33)/{width})"
        problem = fp.Problem(
            alpha=1.5, diffusivity=step, half_width=10.0, spacing=spacing, t_final=0.5, rtol=1e-4
        )
        run = fp.solve_problem(problem, lambda x: np.exp(-x * x), estimate=False)
        return run.u.values.reshape(-1)

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", AccuracyWarning)
        coarse = run(0.1)
    warned = any("diffusivity varies faster" in str(one.message) for one in caught)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        fine = run(0.025)[::4]
    error = np.abs(coarse - fine).max() / fine.max()
    assert warned or error < 0.03
    if width == 0.4:
        assert not warned


@pytest.mark.parametrize("dim", [1, 2])
def test_an_order_that_goes_up_and_down_between_the_particles_is_told(dim):
    """A jump is not: each row has its own order, and a run across one from 1.2 to 1.8 is off by two per cent."""
    setting = Setting(alpha=1.5, n=16, spacing=0.25, order=4, dim=dim)
    x = np.broadcast_to(0.25 * np.arange(-16, 17), setting.shape)
    jump, smooth = np.where(x > 0.1, 1.8, 1.2), 1.5 + 0.3 * np.tanh(x)
    wave = 1.5 + 0.3 * np.cos(4.0 * np.pi * x)
    assert said(lambda: VariableOrder(setting, jump)) == []
    assert said(lambda: VariableOrder(setting, smooth)) == []
    (text,) = said(lambda: VariableOrder(setting, wave))
    assert "alpha - 1 varies faster than particles of spacing 0.25" in text
