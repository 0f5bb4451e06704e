"""The marker solver: sums against loops, closed forms, invariants, and the linear theory of clusters."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fracparticles.errors import InvalidInput
from fracparticles.markers import (
    SHAPES,
    Gaussian,
    MarkerVelocity,
    Square,
    diffusion,
    equal_weight,
    run,
    uniform,
)
from fracparticles.markers.stability import extremes, lattice_rate, rate
from fracparticles.moving.lagrangian import FieldNotPositive


def loop(shape, epsilon, x, w, z, m):
    return np.array(
        [sum(v * shape((p - s) / epsilon, m) for s, v in zip(x, w, strict=True)) for p in z]
    ) / epsilon ** (m + 1)


@settings(max_examples=20)
@given(
    x=st.lists(st.floats(-3.0, 3.0), min_size=2, max_size=12),
    epsilon=st.floats(0.2, 2.0),
    name=st.sampled_from(["S4", "S6", "S8"]),
)
def test_fields_are_the_sums_of_6(x, epsilon, name):
    x = np.array(x)
    w = 1.0 + 0.1 * np.arange(x.size)
    fields = MarkerVelocity(SHAPES[name], epsilon, derivatives=2).fields(x, w, x + 0.1)
    for m in range(3):
        exact = loop(SHAPES[name], epsilon, x, w, x + 0.1, m)
        # Round-off of the sum, and S8 cut off at exp(-6.5^2).
        size = w.sum() / epsilon ** (m + 1)
        assert fields[m] == pytest.approx(exact, abs=1e-13 * size)


def test_the_velocity_is_that_of_7():
    x, w = equal_weight(Gaussian(), 20)
    shape, epsilon = SHAPES["S8"], 0.8
    exact = -loop(shape, epsilon, x, w, x, 1) / loop(shape, epsilon, x, w, x, 0)
    assert MarkerVelocity(shape, epsilon)(x, w) == pytest.approx(exact, abs=1e-12)


def test_the_constant_of_the_shape_function_does_not_move_markers():
    x, w = equal_weight(Square(), 16)
    right = MarkerVelocity(SHAPES["S7"], 0.7)(x, w)
    printed = MarkerVelocity(SHAPES["S7"].as_printed(), 0.7)(x, w)
    assert printed == pytest.approx(right, rel=1e-13, abs=1e-13)


def test_another_flux_is_another_equation():
    # V = 1 for the flux F: the markers move as one.
    x, w = equal_weight(Gaussian(), 12)
    velocity = MarkerVelocity(SHAPES["S4"], 0.9, flux=lambda x, fields: fields[0], derivatives=0)
    end = run(x, w, velocity, dt=0.1, steps=5)
    assert end.x == pytest.approx(x + 0.5, abs=1e-13)


@pytest.mark.parametrize("support", [0.6, 0.3])
def test_a_gaussian_stays_one(support):
    """Markers of the exact Gaussian at t stay near quantile(g, t); the error falls like eps^4 with S8."""
    profile = Gaussian()
    x, w = equal_weight(profile, 200)
    end = run(x, w, MarkerVelocity(SHAPES["S8"], support), dt=0.02, steps=50)
    z = np.linspace(-2.0, 2.0, 81)
    error = np.abs(end.field(z) - profile.value(z, 1.0)).max()
    # S8: F - f = (eps^4 / 32) f'''' to the lowest order (from the transform), and f'''' <= 12 at t = 0.
    assert error < 12.0 / 32.0 * support**4


def test_total_and_centre_are_kept():
    """The weights are constant; by S'(-x) = -S'(x) the sum of W_j F_j V_j vanishes, at every moment."""
    rng = np.random.default_rng(3)
    x, w = rng.normal(size=40), rng.uniform(0.5, 1.0, 40)
    velocity = MarkerVelocity(SHAPES["S4"], 0.8)
    fields = velocity.fields(x, w)
    assert np.sum(w * diffusion(x, fields)) == pytest.approx(0.0, abs=1e-12)
    end = run(x, w, velocity, dt=0.01, steps=3)
    assert end.weights.sum() == w.sum()


def test_a_symmetric_start_stays_symmetric():
    x, w = equal_weight(Square(), 31)
    end = run(x, w, MarkerVelocity(SHAPES["S8"], 1.0), dt=0.05, steps=20)
    assert end.x == pytest.approx(-end.x[::-1], abs=1e-11)


@settings(max_examples=10)
@given(shift=st.floats(-5.0, 5.0), scale=st.floats(0.2, 4.0))
def test_diffusion_is_invariant(shift, scale):
    """x -> scale x + shift with t -> scale^2 t and eps -> scale eps gives the same markers."""
    x, w = equal_weight(Square(), 20)
    one = run(x, w, MarkerVelocity(SHAPES["S8"], 1.0), dt=0.05, steps=4).x
    other = run(
        scale * x + shift, w, MarkerVelocity(SHAPES["S8"], scale), dt=0.05 * scale**2, steps=4
    ).x
    assert other == pytest.approx(scale * one + shift, abs=1e-10)


def test_a_field_that_turns_negative_stops_the_run():
    # exp(-x^2) by uniform markers far into the tail: S8 makes F negative there.
    x, w = uniform(Gaussian().value, (-5.0, 5.0), 100)
    with pytest.raises(
        FieldNotPositive, match=r"t = 0 to 0\.01: the field is .* at the particle x = "
    ):
        run(x, w, MarkerVelocity(SHAPES["S8"], 1.0), dt=0.01, steps=5)
    # S4 is not negative anywhere: it goes on.
    run(x, w, MarkerVelocity(SHAPES["S4"], 1.0), dt=0.01, steps=5)


@pytest.mark.parametrize(
    "call",
    [
        lambda: MarkerVelocity(SHAPES["S4"], 0.0),
        lambda: MarkerVelocity(SHAPES["S4"], 1.0, period=2.0),
        lambda: MarkerVelocity(SHAPES["S1"], 1.0),
        lambda: MarkerVelocity(SHAPES["S4"], 1.0, derivatives=3),
        lambda: lattice_rate(SHAPES["S4"], np.ones(1), 0.0),
        lambda: lattice_rate(SHAPES["S7"], np.ones(1), 0.1),
    ],
)
def test_what_cannot_be_is_refused(call):
    with pytest.raises(InvalidInput):
        call()


# --- periodic markers and the linear theory -------------------------------------------------------


def test_periodic_markers_are_many_copies():
    rng = np.random.default_rng(5)
    x, w = np.sort(rng.uniform(0.0, 3.0, 30)), rng.uniform(0.5, 1.0, 30)
    periodic = MarkerVelocity(SHAPES["S4"], 1.0, period=3.0)(x + 7.5, w)
    copies = np.concatenate([x - 3.0, x, x + 3.0])
    plain = MarkerVelocity(SHAPES["S4"], 1.0)(copies, np.tile(w, 3))[30:60]
    assert periodic == pytest.approx(plain, abs=1e-12)


@pytest.mark.parametrize(("name", "spacing"), [("S4", 1 / 32), ("S6", 1 / 32), ("S8", 0.25)])
@pytest.mark.parametrize("k", [math.pi, 2.0 * math.pi])
def test_perturbations_grow_as_the_lattice_sum_says(name, spacing, k):
    period = 16.0 if name == "S8" else 4.0
    count = round(period / spacing)
    lattice, amplitude, dt, steps = spacing * (np.arange(count) + 0.5), 1e-6, 0.01, 5
    wave = np.cos(k * lattice)
    velocity = MarkerVelocity(SHAPES[name], 1.0, period=period)
    end = run(lattice + amplitude * wave, np.full(count, spacing), velocity, dt=dt, steps=steps)
    growth = 2.0 * np.mean((end.x - lattice) * wave) / amplitude
    z = dt * float(lattice_rate(SHAPES[name], np.array([k]), spacing)[0])
    # What is left of the linear theory: terms of the second order in the amplitude over the spacing.
    assert growth == pytest.approx((1.0 + z + 0.5 * z * z) ** steps, rel=1e-4)


def test_many_markers_make_the_lattice_rate_the_transform():
    k = np.linspace(0.5, 9.0, 18)
    for name, spacing, bound in (("S8", 0.1, 1e-11), ("S4", 1 / 64, 0.01), ("S6", 1 / 64, 0.01)):
        # S8: aliases at k = 2 pi / spacing are zero. The others: S'' jumps, so the sum is of the order spacing^2.
        gap = lattice_rate(SHAPES[name], k, spacing) - rate(SHAPES[name], k)
        assert np.abs(gap).max() < bound


def test_extremes_in_closed_form():
    # S8: 4 s (1 + s) exp(-s), s = k^2 / 4, is largest where s^2 = s + 1: the golden ratio.
    golden = 0.5 * (1.0 + math.sqrt(5.0))
    found = extremes(SHAPES["S8"])
    assert found.growth == 0.0
    assert math.isinf(found.first_zero)
    assert math.isinf(found.wavelength)
    # A parabola through points 0.005 apart: k to the third order, the value to the fourth.
    assert found.k_decay == pytest.approx(2.0 * math.sqrt(golden), abs=1e-5)
    decay = 4.0 * golden * (1.0 + golden) * math.exp(-golden)
    assert found.decay == pytest.approx(decay, rel=1e-9)
    assert found.eta == pytest.approx(2.0 / decay, rel=1e-9)
    # S4: 15 j_2(k); j_2 vanishes first at 5.763459196894550.
    assert extremes(SHAPES["S4"]).first_zero == pytest.approx(5.763459196894550, abs=1e-5)


@pytest.mark.parametrize("name", SHAPES)
def test_an_extreme_at_the_end_of_the_range_is_there(name):
    found = extremes(SHAPES[name], 1.0)
    assert found.k_decay == 1.0
    assert found.decay == pytest.approx(-rate(SHAPES[name], 1.0), rel=1e-14)


def test_which_shape_functions_cluster():
    growing = {name for name, shape in SHAPES.items() if extremes(shape).growth > 0.0}
    assert growing == {"S1", "S3", "S4", "S6", "S7"}
