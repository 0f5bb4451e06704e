"""Particles that follow a solution: two blobs of very different widths, against their exact evolution."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from fracparticles.adaptive.follow import _placed_again, follow
from fracparticles.adaptive.placement import LengthField, place_particles, wanted_lengths
from fracparticles.adaptive.placing import Place
from fracparticles.adaptive.samples import adapted_samples
from fracparticles.adaptive.splitting import Physics
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.special import green, tail_constant
from known import blobs

TIMES = (1e-3, 0.1, 1.0, 10.0)


def followed(alpha, times=TIMES, **how):
    return follow(lambda x: blobs(x, 0.0, alpha), times, alpha=alpha, window=(-20.0, 80.0), **how)


def error(state, alpha):
    """Sum V |u - exact|, of a mass of one."""
    exact = blobs(state.particles.x, state.time, alpha)
    return float(state.particles.volumes @ np.abs(state.u - exact))


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_two_blobs_at_all_times(alpha):
    states = followed(alpha, step=0.25)
    assert max(error(state, alpha) for state in states) < 5e-5
    masses = np.array([state.mass for state in states])
    assert np.abs(masses / masses[0] - 1.0).max() < 1e-12
    # As the narrow one widens, particles that are close are merged.
    counts = [state.u.size for state in states]
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] < 0.75 * counts[0] < 300
    assert states[-1].placements > 5


def test_the_error_falls_with_the_step_by_its_order():
    """Without placing again: the order of the exchange, 2 q + 2 - alpha = 4.5, in the parts of a length."""
    errors = [
        error(followed(1.5, (0.01,), step=h, near=2, again=False)[0], 1.5) for h in (0.1, 0.08)
    ]
    assert np.log(errors[0] / errors[1]) / np.log(1.25) == pytest.approx(4.5, abs=0.1)


def test_particles_go_as_far_as_a_share_of_1e_7():
    """A tail of mass c |x|^-alpha / alpha, of the blobs at first and of what spreads from a bell without a tail."""
    c = tail_constant(1.5)
    state = followed(1.5, (1e-3,))[0]
    beyond = c * state.particles.x[-1] ** -1.5 / 1.5 * (0.5 * 0.01**1.5 + 0.5)
    assert 0.2e-7 < beyond < 1e-7
    later = follow(lambda x: np.exp(-x * x), 2.0, alpha=1.5, window=(-5.0, 5.0))[0]
    assert 2.0 * c * (later.particles.x[-1] - 5.0) ** -1.5 / 1.5 == pytest.approx(1e-7, rel=1e-3)


@pytest.mark.parametrize("alpha", [1.1, 1.8])
def test_a_placement_keeps_mass_and_first_moment(alpha):
    before = followed(alpha, (0.05,), step=0.3, again=False)[0]
    place = Place(Physics(alpha, 6, 1.0), (-20.0, 80.0), np.zeros(0), 0.3)
    after = _placed_again(before, place)
    assert after.u.size < before.u.size
    assert 0.0 < after.corrected < 1e-5
    assert after.mass == pytest.approx(before.mass, rel=1e-13)
    moments = [state.particles.volumes * state.particles.x @ state.u for state in (before, after)]
    size = before.particles.volumes * np.abs(before.particles.x) @ before.u
    assert moments[1] == pytest.approx(moments[0], abs=1e-13 * size)


def test_a_long_time_from_a_narrow_bell_is_the_fundamental_solution():
    """u(t) = sqrt(pi) G(x, t) but for G'' / 4, the second moment of the bell."""
    state = follow(lambda x: np.exp(-x * x), 1e3, alpha=1.7, window=(-5.0, 5.0), step=0.2)[0]
    x = np.linspace(-200.0, 200.0, 41)
    bend = (green(x + 1.0, 1e3, 1.7) - 2.0 * green(x, 1e3, 1.7) + green(x - 1.0, 1e3, 1.7)) / 4.0
    exact = np.sqrt(np.pi) * (green(x, 1e3, 1.7) + bend)
    assert state.at(x) == pytest.approx(exact, abs=1e-5 * exact.max())


def test_data_of_both_signs_keep_their_first_moment_in_time():
    states = follow(lambda x: x * np.exp(-x * x), (0.01, 1.0), alpha=1.6, window=(-5.0, 5.0))
    for state in states:
        assert abs(state.mass) < 1e-9  # of the sum at the start
        assert state.mass == pytest.approx(states[0].mass, abs=1e-13)
        moment = state.particles.volumes * state.particles.x @ state.u
        assert moment == pytest.approx(0.5 * np.sqrt(np.pi), rel=1e-4)


def test_between_the_particles_it_has_the_same_error():
    state = followed(1.5, (0.1,), step=0.2)[0]
    x = np.concatenate([np.linspace(-1.0, 1.0, 77), np.linspace(45.0, 55.0, 77), [300.0]])
    assert state.at(x) == pytest.approx(blobs(x, 0.1, 1.5), abs=1e-5 * state.u.max())
    with pytest.raises(InvalidInput, match=r"^x = "):
        state.at(1e9)


def test_a_constant_length_gives_equal_distances():
    x = np.linspace(-50.0, 50.0, 2001)
    field = LengthField(x, np.full(2001, 0.7))
    assert field(np.array([0.3])) == pytest.approx(0.7, rel=1e-4)  # but for the ends
    particles = place_particles(lambda x: np.full(x.size, 2.0), -10.0, 10.0, 0.5)
    assert np.diff(particles.x) == pytest.approx(1.0, rel=1e-9)
    assert particles.volumes[1:-1] == pytest.approx(1.0)
    assert particles.volumes.sum() == pytest.approx(20.0)


def test_a_length_does_not_change_by_more_than_the_distance():
    x, u = adapted_samples(lambda x: blobs(x, 0.0, 1.5), -20.0, 80.0, np.zeros(0))
    field = LengthField(x, wanted_lengths(x, u))
    at = np.sort(np.concatenate([np.geomspace(1e-4, 400.0, 300), -np.geomspace(1e-4, 400.0, 300)]))
    lengths = field(at)
    assert (np.abs(np.diff(lengths)) <= np.diff(at) * (1.0 + 1e-9)).all()
    assert field(np.array([0.0, 50.0])) == pytest.approx([0.01, 1.0], rel=0.5)


def test_places_are_those_of_a_smooth_map():
    """s(x) = asinh(x) of l = (1 + x^2)^(1/2), and volumes that are the slope of the map."""
    particles = place_particles(lambda x: np.sqrt(1.0 + x * x), -1e4, 1e4, 0.3)
    s = np.linspace(-np.arcsinh(1e4), np.arcsinh(1e4), particles.x.size)
    assert particles.x[1:-1] == pytest.approx(np.sinh(s[1:-1]), rel=1e-9, abs=1e-9)
    assert particles.volumes[1:-1] == pytest.approx((s[1] - s[0]) * np.cosh(s[1:-1]), rel=1e-9)


def test_what_is_refused_or_warned_of():
    def bell(x):
        return np.exp(-x * x)

    good = {"alpha": 1.5, "window": (-5.0, 5.0)}
    for field, call in {
        "alpha": lambda: follow(bell, 1.0, alpha=2.5, window=(-5.0, 5.0)),
        "window": lambda: follow(bell, 1.0, alpha=1.5, window=(5.0, -5.0)),
        "times": lambda: follow(bell, (1.0, 0.5), **good),
        "step": lambda: follow(bell, 1.0, step=2.0, **good),
        "diffusivity": lambda: follow(bell, 1.0, diffusivity=-1.0, **good),
        "initial": lambda: follow(lambda x: np.where(x > 0, np.nan, 1.0), 1.0, **good),
        "near": lambda: follow(bell, 1.0, near=0, **good),
        "tolerance": lambda: follow(bell, 1.0, tolerance=0.0, **good),
        "velocity": lambda: follow(bell, 1.0, velocity=1.0, **good),
        "source": lambda: follow(bell, 1.0, source=lambda x, t, u: np.inf * u, **good),
        "diffusivity ": lambda: follow(bell, 1.0, diffusivity=lambda x: -1.0 + 0.0 * x, **good),
        "reach": lambda: follow(bell, 1.0, reach=-1.0, **good),
        "again": lambda: follow(bell, 1.0, again=1, **good),
    }.items():
        with pytest.raises(InvalidInput, match=f"^{field.strip()} = ") as error:
            call()
        assert "\n" not in str(error.value)
    with pytest.raises(InvalidInput, match="zero at all samples"):
        follow(lambda x: 0.0 * x, 1.0, **good)
    with pytest.warns(AccuracyWarning, match=r"of int \|u\|"):
        follow(bell, 0.1, step=1.0, **good)
    with pytest.warns(AccuracyWarning, match=r"the exchange is off by some"):
        follow(bell, 0.1, step=0.5, near=1, **good)
    with pytest.warns(AccuracyWarning, match=r"beyond the particles is .* of int \|u\|"):
        follow(bell, 0.1, reach=1.0, **good)


@pytest.mark.parametrize("distance", [30.0, 300.0])
def test_a_narrow_bump_beyond_the_window_is_said(distance):
    def initial(x):
        return green(x, 1.0, 1.5) + green(x - distance, 1e-3**1.5, 1.5)

    with pytest.warns(AccuracyWarning, match="beyond the window `initial` is not what"):
        follow(initial, 0.1, alpha=1.5, window=(-10.0, 10.0))


@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_tails_without_bends_are_not_warned_of(alpha):
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        follow(lambda x: green(x, 1.0, 1.5), 1.0, alpha=alpha, window=(-10.0, 10.0))
        follow(lambda x: np.exp(-x * x), 1.0, alpha=alpha, window=(-5.0, 5.0))
