"""The diffusion velocity method, and the particle solver beneath it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.kernels.families import kernel_transform
from fracparticles.moving import dvm
from fracparticles.moving.lagrangian import FieldNotPositive, Remeshing, advance, quotient_velocity
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.special.stable import green, mean_radius
from fracparticles.time.whole_space import evolve
from sweeps import covering, few

START = 0.5


def lattice(half_width, h):
    n = round(half_width / h)
    return np.arange(-n, n + 1) * (half_width / n)


# --- the velocity ---------------------------------------------------------------------------------


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("alpha", [1.2, 1.5, 1.8])
def test_the_velocity_of_the_fundamental_solution(alpha, order):
    """v = x / (alpha t), with an error of the order of the kernel."""
    errors = []
    for h in (0.1, 0.05):
        x = lattice(200.0, h)
        velocity = dvm.DiffusionVelocity(alpha, order, 2.0 * h)
        v = velocity(x, h * green(x, 1.0, alpha))
        near = np.abs(x) <= 2.0 * mean_radius(alpha)
        errors.append(np.abs(v - x / alpha)[near].max())
    # What is left out beyond 200 adds to the flux near the origin, by symmetry, no more than x u(200) 200^-alpha.
    assert errors[1] < {2: 1e-2, 4: 1e-3}[order]
    assert math.log2(errors[0] / errors[1]) > order - 0.4


def test_the_velocity_does_not_depend_on_the_sign_or_size_of_the_field():
    x = lattice(5.0, 0.1)
    u = green(x, 1.0, 1.5)
    velocity = dvm.DiffusionVelocity(1.5, 2, 0.2)
    expected = velocity(x, u)
    for factor in (-1.0, 1e-200, 1e200):
        assert velocity(x, factor * u) == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_diffusivity_is_a_factor():
    x = lattice(5.0, 0.1)
    one, three = (dvm.DiffusionVelocity(1.5, 4, 0.2, d)(x, green(x, 1.0, 1.5)) for d in (1.0, 3.0))
    assert three == pytest.approx(3.0 * one, rel=1e-13)


@pytest.mark.parametrize(("order", "theta"), covering([2, 4], [0.4, 0.8, 1.2]))
def test_a_displacement_wave_decays_at_the_symbol_of_dd(order, theta):
    """In a uniform field: -D |k|^alpha eta^(k eps), so that the step is limited as DD's is (the paper: stable)."""
    h, n, alpha = 0.01, 2000, 1.5
    velocity = dvm.DiffusionVelocity(alpha, order, 2.0 * h)
    x, strength = np.arange(-n, n + 1) * h, np.full(2 * n + 1, h)
    wave = np.sin(theta / h * x)
    amplitude = 1e-4 * h  # the second-order response is 1e-4 of the first
    change = velocity(x + amplitude * wave, strength) - velocity(x, strength)
    middle = slice(n - 40, n + 41)
    rate = (change[middle] @ wave[middle]) / (wave[middle] @ wave[middle]) / amplitude * h**alpha
    expected = -(theta**alpha) * kernel_transform("eta", 2.0 * theta, alpha, order=order)
    assert rate == pytest.approx(expected, rel=3e-4)  # the ends are 2000 h away: F ~ 2000^-1.5
    symbol = SCHEMES["DD"].symbol(np.array([theta]), Setting(alpha=alpha, order=order))[0]
    assert expected == pytest.approx(symbol, rel=1e-3)


@pytest.mark.parametrize(("factor", "stable"), [(0.9, True), (1.1, False)])
def test_the_step_is_limited_as_that_of_dd(factor, stable):
    h, n, alpha = 0.1, 400, 1.5
    # s = 2, order II.
    limit = 2.0 / (2.0 / 2.0) ** alpha * (2.0 * math.e / alpha) ** (alpha / 2.0) * h**alpha
    theta = math.sqrt(2.0 * alpha) / 2.0  # the fastest wave
    x = np.arange(-n, n + 1) * h
    bump = 1e-7 * np.sin(theta * x / h) * np.exp(-((x / (40 * h)) ** 2))
    velocity = dvm.DiffusionVelocity(alpha, 2, 2.0 * h)
    strength = np.full(x.size, h)

    # The ends of the set run away; only their drift in the middle is left, which the undisturbed run has too.
    def middle(start):
        moved, _, _ = advance(start, strength, velocity, dt=factor * limit, steps=12)
        return moved[n - 60 : n + 61]

    growth = np.abs(middle(x + bump) - middle(x)).max() / np.abs(bump).max()
    # Amplification per step of the fastest wave: 1 - 2 f + 2 f^2 = 0.82 and 1.22.
    assert (growth < 1.0) == stable


# --- runs -----------------------------------------------------------------------------------------


def reference(h=0.05, **options):
    x = lattice(6.0, h)
    options = {"spacing": h, "alpha": 1.5, "dt": 2e-3, "steps": 100, "start": START} | options
    return dvm.run(x, green(x, START, 1.5), **options)


@pytest.mark.parametrize("remeshing", ["M4'", "Lambda3", "none"])
@pytest.mark.parametrize("order", [2, 4])
def test_the_field_follows_the_fundamental_solution(order, remeshing):
    run = reference(order=order, remeshing=remeshing)
    z = np.linspace(-2.0, 2.0, 41)
    exact = green(z, START + 0.2, 1.5)
    # h^2 u'' is about 3e-3 here, and the tail beyond 6 that is left out about as much.
    assert np.abs(run.field(z) - exact).max() < 5e-3
    assert (run.history.remeshings > 0) == (remeshing != "none")
    assert run.history.overtaking_steps == 0


def test_the_error_falls_with_the_spacing():
    z = np.linspace(-1.0, 1.0, 21)
    errors = []
    for h in (0.2, 0.1):
        x = lattice(40.0, h)
        run = dvm.run(x, green(x, START, 1.8), spacing=h, alpha=1.8, dt=2e-3, steps=50, start=START)
        errors.append(np.abs(run.field(z) - green(z, 0.6, 1.8)).max())
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)


@pytest.mark.parametrize("remeshing", ["M4'", "none"])
def test_fast_and_naive_sums_give_the_same_run(remeshing):
    fast, slow = (
        reference(h=0.1, steps=40, remeshing=remeshing, summation=s) for s in ("fft", "naive")
    )
    assert fast.history.remeshings == slow.history.remeshings
    assert fast.x == pytest.approx(slow.x, abs=1e-8)
    assert fast.strength == pytest.approx(slow.strength, abs=1e-9)


def test_the_same_run_gives_the_same_bytes():
    first, second = reference(steps=30), reference(steps=30)
    assert first.x.tobytes() == second.x.tobytes()
    assert first.strength.tobytes() == second.strength.tobytes()


def test_the_solution_stays_even():
    run = reference()
    assert run.x == pytest.approx(-run.x[::-1], abs=1e-9)
    assert run.strength == pytest.approx(run.strength[::-1], rel=1e-7)


def test_without_remeshing_the_strengths_stay_as_they_are():
    run = reference(remeshing="none")
    assert run.history.total_final == run.history.total_initial
    assert np.array_equal(run.strength, 0.05 * green(lattice(6.0, 0.05), START, 1.5))
    assert run.history.remeshing_times == []


@pytest.mark.parametrize(
    "options", [{}, {"threshold": 1e-3}, {"threshold": 2e-3, "lattice": "extended"}]
)
def test_every_strength_is_accounted_for(options):
    history = reference(dt=5e-4, steps=200, **options).history
    gone = history.eliminated_strength + history.lost_strength
    # Each remeshing sums 240 strengths of a total below 1: a few round-offs each.
    assert history.total_initial - history.total_final == pytest.approx(gone, abs=1e-15 * 200)
    assert gone > 0.0
    assert len(history.particles) == history.remeshings + 1
    assert min(history.spacings_before) > 1.5 * 0.05
    assert history.largest_spacing == max(history.spacings_before)
    # The ends run into the void: that is where the grid tears.
    assert min(np.abs(history.spacings_where)) > 4.0


def test_the_initial_lattice_is_kept_or_extended():
    run = reference(steps=50)
    assert np.abs(run.x).max() < 6.0 + 0.05 * 1.5
    run = reference(dt=5e-4, steps=100, lattice="extended", threshold=2e-3)
    assert run.history.lost_strength == 0.0


# --- the rules ------------------------------------------------------------------------------------


def test_the_midpoint_rule():
    x, _, history = advance(np.array([1.0, 2.0]), np.ones(2), lambda x, _: x, dt=0.1, steps=5)
    assert x == pytest.approx(np.array([1.0, 2.0]) * (1.0 + 0.1 + 0.1**2 / 2.0) ** 5, rel=1e-14)
    assert history.velocity_evaluations == 10


def test_the_observer_sees_every_step():
    seen = []
    advance(
        np.array([1.0]),
        np.ones(1),
        lambda x, _: x,
        dt=0.5,
        steps=2,
        start=1.0,
        observe=lambda t, x, strength: seen.append((t, x[0], strength[0])),
    )
    assert seen == [(1.0, 1.0, 1.0), (1.5, 1.625, 1.0), (2.0, 1.625**2, 1.0)]


def test_the_arrays_given_are_left_alone():
    x, strength = lattice(6.0, 0.1), np.ones(121)
    before = x.copy(), strength.copy()
    advance(x, strength, lambda x, _: x, dt=0.1, steps=3)
    assert np.array_equal(x, before[0])
    assert np.array_equal(strength, before[1])


def test_coincident_particles_are_one_particle():
    x = lattice(3.0, 0.1)
    u = green(x, START, 1.5)
    options = {"spacing": 0.1, "alpha": 1.5, "dt": 2e-3, "steps": 20, "remeshing": "none"}
    whole = dvm.run(x, u, **options)
    halves = dvm.run(np.concatenate([x, x]), np.concatenate([0.5 * u, 0.5 * u]), **options)
    assert halves.x[: x.size] == pytest.approx(whole.x, abs=1e-9)
    assert np.array_equal(halves.x[: x.size], halves.x[x.size :])


def test_particles_in_any_order():
    x = lattice(3.0, 0.1)
    options = {"spacing": 0.1, "alpha": 1.5, "dt": 2e-3, "steps": 20}
    shuffled = np.random.default_rng(0).permutation(x)
    first, second = (
        dvm.run(points, green(points, START, 1.5), **options) for points in (x, shuffled)
    )
    assert second.field(x) == pytest.approx(first.field(x), abs=1e-9)
    assert second.history.remeshing_times == first.history.remeshing_times


def test_overtaking_is_counted():
    _, _, history = advance(np.array([-1.0, 1.0]), np.ones(2), lambda x, _: -x, dt=3.0, steps=1)
    assert history.overtaking_steps == 0  # 1 - 3 + 9/2 > 0: no overtaking
    turn = np.array([1.0, -1.0])
    _, _, history = advance(np.array([-1.0, 1.0]), np.ones(2), lambda x, _: turn, dt=3.0, steps=1)
    assert history.overtaking_steps == 1
    assert history.largest_spacing == pytest.approx(4.0)


def test_a_strength_that_underflowed_is_left_out():
    x = lattice(3.0, 0.1)
    u = green(x, START, 1.5)
    u[[0, -1]] = 0.0
    run = dvm.run(x, u, spacing=0.1, alpha=1.5, dt=1e-3, steps=1, remeshing="none")
    assert run.x.size == x.size - 2
    with pytest.raises(InvalidInput, match="strength"):
        dvm.run(x, 1e-320 * u, spacing=1e-10, alpha=1.5, dt=1e-15, steps=1)


def test_a_field_below_the_accuracy_of_the_sum_needs_a_threshold():
    x = lattice(8.0, 0.1)
    options = {"spacing": 0.1, "alpha": 1.5, "dt": 1e-4, "steps": 2, "remeshing": "none"}
    with pytest.raises(FieldNotPositive, match=r"step 1 of 2, from t = 0 .*threshold"):
        dvm.run(x, np.exp(-x * x), **options)
    assert dvm.run(x, np.exp(-x * x), threshold=1e-6, **options).history.eliminated_count > 0


@pytest.mark.parametrize(("order", "later"), few([(2, 0.5), (4, 0.5), (4, 2.0)]))
def test_a_gaussian_is_carried_with_the_threshold_that_the_message_names(order, later):
    x = lattice(20.0, 0.1)
    options = {"spacing": 0.1, "alpha": 1.5, "dt": 2e-3, "steps": round(later / 2e-3)}
    with pytest.raises(FieldNotPositive, match=r"takes a threshold of 1e-4\.") as refused:
        dvm.run(x, np.exp(-x * x), order=order, **options)
    named = float(str(refused.value).split()[-1].rstrip("."))
    run = dvm.run(x, np.exp(-x * x), order=order, threshold=named, **options)
    exact = evolve(np.exp(-x * x), 0.1, 1.5, later, tail=())
    inner = np.abs(x) <= 15.0
    # Less than that of the peak is left out, on a lattice of the length 40: of the mass at most 40 times as much.
    assert np.abs(run.field(x) - exact)[inner].max() <= 40.0 * named


def test_a_field_that_changes_sign_stops_the_run():
    x = lattice(3.0, 0.1)
    with pytest.raises(
        FieldNotPositive, match=r"step 1 of 5, from t = 0\.5 to 0\.51: the field is -"
    ):
        dvm.run(x, x + 0.01, spacing=0.1, alpha=1.5, dt=0.01, steps=5, start=0.5)


def test_a_particle_that_runs_away_stops_the_run():
    strength = np.ones(2)
    with pytest.raises(
        NonFiniteSolution, match=r"step 2 of 3, from t = 1 to 2: .* went to infinity"
    ):
        advance(
            np.array([1.0, 2.0]),
            strength,
            lambda x, _: np.where(x < 1.5, 1.0, np.where(x < 3.5, 2.0, np.inf)),
            dt=1.0,
            steps=3,
        )
    velocity = dvm.DiffusionVelocity(1.5, 2, 0.1)
    with pytest.raises(NonFiniteSolution, match=r"step 1 of 1, .*ran away"):
        advance(np.array([0.0, 1e12]), strength, velocity, dt=1.0, steps=1)
    with pytest.raises(NonFiniteSolution, match=r"step 1 of 1, .*ran away"):
        advance(
            np.array([0.0, 1e12]),
            strength,
            lambda x, _: 0.0 * x,
            dt=1.0,
            steps=1,
            remeshing=Remeshing("M4'", 0.1),
        )


def test_the_quotient():
    x = np.array([0.0, 1.0])
    assert np.array_equal(quotient_velocity(np.ones(2), np.array([2.0, 4.0]), x), [0.5, 0.25])
    assert np.array_equal(quotient_velocity(np.ones(2), np.array([-2.0, -4.0]), x), [-0.5, -0.25])
    for u in ([1.0, 0.0], [1.0, -1.0], [1.0, math.nan], [0.0, 0.0]):
        with pytest.raises(FieldNotPositive, match=r"x = 1|x = 0"):
            quotient_velocity(np.ones(2), np.array(u), x)
    with pytest.raises(NonFiniteSolution, match="x = 1"):
        quotient_velocity(np.array([1.0, 1e300]), np.array([1.0, 1e-10]), x)


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"remeshing": "M5"}, "remeshing"),
        ({"remesh_above": 1.0}, "remesh_above"),
        ({"lattice": "finite"}, "lattice"),
        ({"threshold": 1.0}, "threshold"),
        ({"summation": "tree"}, "summation"),
        ({"order": 3}, "order"),
        ({"alpha": 2.0}, "alpha"),
        ({"dt": 0.0}, "dt"),
        ({"steps": 0}, "steps"),
        ({"overlap": -1.0}, "overlap"),
        ({"diffusivity": 0.0}, "diffusivity"),
    ],
)
def test_bad_input_is_refused(options, field):
    with pytest.raises(InvalidInput) as error:
        reference(**options)
    assert error.value.field == field


def test_bad_arrays_are_refused():
    options = {"dt": 0.1, "steps": 1}
    for x, strength in (
        (np.zeros(2), np.zeros(3)),
        (np.zeros((2, 2)), np.zeros((2, 2))),
        (np.array([0.0, np.inf]), np.ones(2)),
        (np.zeros(2), np.array([1.0, np.inf])),
    ):
        with pytest.raises(InvalidInput):
            advance(x, strength, lambda x, _: x, **options)
    with pytest.raises(InvalidInput, match="ends"):
        Remeshing("M4'", 0.1, 1.5, (1.0, -1.0))
