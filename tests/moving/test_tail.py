"""The far field beyond the end particles: against quadrature, against a far longer set, and in whole runs of DVM."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad

from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.kernels.families import kernel
from fracparticles.moving import dvm
from fracparticles.moving.tail import FITTED, REACH, TailModel
from fracparticles.run.case import Case
from fracparticles.run.solve import solve
from fracparticles.run.solver import compute
from fracparticles.run.strengths import lattice_strengths
from fracparticles.special.stable import green, mean_radius
from fracparticles.special.tails import tail_constant

START = 0.5


def lattice(n, h):
    return np.arange(-n, n + 1) * h


def power(x, alpha):
    """An even density that is |x|^(-1-alpha) but for the middle."""
    return np.maximum(np.abs(x), 1.0) ** (-1.0 - alpha)


# --- the tail --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_a_power_goes_on_as_itself(alpha):
    x = lattice(200, 0.1)
    tail = TailModel(alpha, 0.2)(x, 0.1 * power(x, alpha))
    for end in (tail.left, tail.right):
        assert alpha * end.beyond * end.last**alpha == pytest.approx(1.0, rel=1e-4)  # c
        assert end.x[0] == pytest.approx(20.1)
        assert end.strength == pytest.approx(0.1 * power(end.x, alpha), rel=1e-4)
        # The strengths and what is beyond hold the whole tail.
        beyond = end.start**-alpha / alpha
        assert end.strength.sum() + beyond == pytest.approx(20.05**-alpha / alpha, rel=1e-4)
        assert end.start - 20.05 >= REACH * 0.2 * (1.0 - 1e-12)


def test_the_far_field_of_the_kernel():
    """F is -A r^(-alpha) far out, with the error that the module states for it."""
    for alpha, order in ((1.2, 2), (1.5, 2), (1.5, 4), (1.8, 4)):
        constant = tail_constant(alpha) / alpha
        misfit = -kernel("F", REACH, alpha, order=order) / (constant * REACH**-alpha) - 1.0
        expected = alpha * (alpha + 1.0) / (4.0 * REACH**2) if order == 2 else 0.0
        assert misfit == pytest.approx(expected, abs=2e-4)


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_the_flux_is_the_integral_over_both_tails(alpha):
    x = lattice(300, 0.1)
    u = power(x, alpha) * np.where(x > 0.0, 2.0, 1.0)  # not even
    model = TailModel(alpha, 0.2, 3.0)
    tail = model(x, 0.1 * u)
    z = np.array([-31.0, -30.0, -7.0, 0.0, 12.0, 29.0, 30.0])

    def one(end, at):
        def integrand(s):  # y = start / s
            return s ** (2.0 * alpha - 1.0) * (1.0 - s * at / end.start) ** -alpha

        value = quad(integrand, 0.0, 1.0, epsabs=0.0, epsrel=1e-10, limit=400)[0]
        c = alpha * end.beyond * end.last**alpha
        return c * end.start ** (-2.0 * alpha) * value

    constant = 3.0 * tail_constant(alpha) / alpha
    expected = [constant * (one(tail.left, -at) - one(tail.right, at)) for at in z]
    assert model.flux(tail, z) == pytest.approx(expected, rel=1e-7)
    assert model.flux(tail, np.empty(0)).shape == (0,)


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("summation", ["fft", "naive"])
def test_the_open_exterior_is_a_far_longer_set(order, summation):
    """Field and flux equal, but for c and the far field of F, the sums over 25 times the particles."""
    alpha, h = 1.5, 0.1
    x, far = lattice(160, h), lattice(4000, h)
    u, long = power(x, alpha), power(far, alpha)
    velocity = dvm.DiffusionVelocity(alpha, order, 2.0 * h, 2.0, summation, exterior="open")
    bare = dvm.DiffusionVelocity(alpha, order, 2.0 * h, 2.0)
    z = np.array([-16.5, -16.0, -3.0, 0.0, 5.05, 15.9, 17.0])
    for ours, exact, truncated in zip(
        velocity.field_and_flux(x, h * u, z),
        bare.field_and_flux(far, h * long, z),
        bare.field_and_flux(x, h * u, z),
        strict=True,
    ):
        left_out = np.abs(truncated - exact).max()
        assert np.abs(ours - exact).max() < 2e-3 * left_out
    assert velocity.field(x, h * u, z) == pytest.approx(bare.field(far, h * long, z), rel=1e-3)
    beyond = np.array([-90.0, 25.0])
    assert velocity.field(x, h * u, beyond) == pytest.approx(power(beyond, alpha), rel=1e-3)


def test_the_order_of_the_particles_and_the_side_do_not_matter():
    x = lattice(100, 0.1)
    strength = 0.1 * power(x - 0.3, 1.4)
    velocity = dvm.DiffusionVelocity(1.4, 2, 0.2, exterior="open")
    straight = velocity(x, strength)
    turned = np.random.default_rng(0).permutation(x.size)
    assert velocity(x[turned], strength[turned]) == pytest.approx(straight[turned], rel=1e-9)
    mirrored = velocity(-x[::-1], strength[::-1])
    assert mirrored == pytest.approx(-straight[::-1], rel=1e-7, abs=1e-9)


@pytest.mark.parametrize("alpha", [1.3, 1.5, 1.8])
def test_the_end_particles_keep_to_the_paths_of_the_solution(alpha):
    """v = x / (alpha t) up to the very end, the better the farther out it is; without the tail they run away."""
    errors = []
    for n in (150, 300, 600):
        x = lattice(n, 0.1)
        u = 0.1 * green(x, 1.0, alpha)
        exact = x[-5:] / alpha
        velocity = dvm.DiffusionVelocity(alpha, 4, 0.2, exterior="open")
        errors.append(np.abs(velocity(x, u)[-5:] / exact - 1.0).max())
        assert dvm.DiffusionVelocity(alpha, 4, 0.2)(x, u)[-1] > 1.5 * exact[-1]
    assert errors[0] < 5e-3
    assert np.log2(errors[0] / errors[2]) > 2.0 * (1.0 + alpha)


def test_few_particles_or_none_on_one_side_are_refused():
    model = TailModel(1.5, 0.2)
    with pytest.raises(InvalidInput, match="16 particles"):
        model(np.arange(-7.0, 8.0), np.ones(15))
    with pytest.raises(InvalidInput, match="surround the origin"):
        model(np.arange(1.0, 31.0), np.ones(30))
    velocity = dvm.DiffusionVelocity(1.5, 2, 0.2, exterior="open")
    x = lattice(100, 0.1)
    with pytest.raises(InvalidInput, match="z"):
        velocity.field_and_flux(x, 0.1 * power(x, 1.5), np.array([20.0]))
    with pytest.raises(InvalidInput, match="exterior"):
        dvm.DiffusionVelocity(1.5, 2, 0.2, exterior="closed")


def test_particles_in_one_place_have_a_tail():
    x = np.concatenate([lattice(10, 0.1), np.full(FITTED + 1, 1.0), np.full(FITTED + 1, -1.0)])
    tail = TailModel(1.5, 0.2)(x, np.full(x.size, 0.1))
    assert np.isfinite(tail.right.strength).all()


# --- runs ------------------------------------------------------------------------------------------------


def reference(alpha=1.5, n=120, h=0.1, steps=500, **options):
    x = lattice(n, h)
    common = {"spacing": h, "alpha": alpha, "dt": 1.0 / steps, "steps": steps, "start": START}
    return dvm.run(x, green(x, START, alpha), **common, **options)


def edge_error(run, alpha=1.5, end=12.0):
    z = np.linspace(0.8 * end, end, 30)
    return np.abs(run.field(z) / green(z, START + 1.0, alpha) - 1.0).max()


def error(run, alpha=1.5):
    z = np.linspace(-5.0, 5.0, 201) * mean_radius(alpha)
    exact = green(z, START + 1.0, alpha)
    return np.abs(run.field(z) - exact).sum() / exact.sum()


@pytest.mark.parametrize("alpha", [1.5, 1.8])
def test_an_open_exterior_is_remeshed_for_its_growth_alone(alpha):
    """All spacings grow as 3^(1/alpha); without the tail the ends are torn at every other step."""
    opened, truncated = reference(alpha, exterior="open"), reference(alpha)
    growth = np.log(3.0) / alpha / np.log(dvm.REMESH_ABOVE_OPEN)
    assert growth - 1.0 < opened.history.remeshings < 1.5 * growth
    assert truncated.history.remeshings > 10 * opened.history.remeshings
    assert error(opened, alpha) < error(truncated, alpha)
    assert edge_error(opened, alpha) < 0.02
    assert edge_error(truncated, alpha) > 0.5


def test_without_remeshing_the_particles_keep_to_their_paths():
    run = reference(exterior="open", remeshing="none", order=4)
    assert run.x == pytest.approx(lattice(120, 0.1) * 3.0 ** (1.0 / 1.5), rel=0.02, abs=1e-9)
    assert edge_error(run) < 5e-3
    assert run.history.total_final == run.history.total_initial
    far = np.array([-80.0, 60.0])
    # The next term of (A.2), which c holds at the last particle and not farther out; c itself is 1 % too large.
    exact, last = green(far, 1.5, 1.5), run.x[-1]
    misfit = green(last, 1.5, 1.5) / exact * (np.abs(far) / last) ** -2.5 - 1.0
    assert run.field(far) / exact - 1.0 == pytest.approx(misfit, abs=0.02)
    assert np.abs(misfit).max() < 0.05


def test_the_error_of_an_open_run_falls_with_the_spacing():
    errors = [error(reference(n=n, h=12.0 / n, exterior="open")) for n in (60, 120, 240)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert orders == pytest.approx(2.0, abs=0.35)


def test_what_leaves_the_lattice_is_what_the_solution_loses():
    history = reference(exterior="open").history
    assert history.total_initial - history.total_final == pytest.approx(
        history.lost_strength, abs=1e-13
    )
    run, x = reference(exterior="open"), lattice(120, 0.1)
    inside = np.abs(run.x) <= 12.0
    # The particles of a moment hold the solution as far as they reach.
    exact = 0.1 * green(x, 1.5, 1.5).sum()
    assert run.strength[inside].sum() == pytest.approx(exact, rel=3e-3)


def test_fast_and_naive_sums_and_two_runs_agree():
    options = {"n": 60, "h": 0.2, "steps": 60, "exterior": "open"}
    fast, again = reference(**options), reference(**options)
    assert fast.x.tobytes() == again.x.tobytes()
    slow = reference(**options, summation="naive")
    assert fast.history.remeshing_times == slow.history.remeshing_times
    assert fast.x == pytest.approx(slow.x, abs=1e-8)


def test_an_open_run_keeps_to_its_lattice():
    with pytest.raises(InvalidInput, match="lattice"):
        reference(exterior="open", lattice="extended")
    with pytest.raises(NonFiniteSolution, match="16 particles"):
        reference(n=7, exterior="open")


# --- cases -----------------------------------------------------------------------------------------------

GIVEN = {"scheme": "DVM", "beta": 0.5, "half_width": 10.0, "spacing": 0.2, "exterior": "open"}


def test_a_case_with_an_open_exterior():
    case = Case(**GIVEN, dt=0.01)
    assert case.redistribution["remesh_above"] == dvm.REMESH_ABOVE_OPEN
    assert Case(**{**GIVEN, "exterior": "truncated"}, dt=0.01).redistribution["remesh_above"] == 1.5
    solution = compute(case)
    exact = green(case.x, 1.5, 1.5)
    assert np.abs(solution.u - exact).max() < 0.02 * exact.max()
    assert solution.u[-1] == pytest.approx(exact[-1], rel=0.05)
    run = solve(case)
    strengths = lattice_strengths(run)
    assert strengths[[0, -1]] == pytest.approx(exact[[0, -1]], rel=0.1)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"far_terms": 2}, "far_terms"),
        ({"evaluation": "convolution"}, "scheme"),
        ({"half_width": 0.6, "spacing": 0.05}, "half_width"),
    ],
)
def test_what_does_not_go_together(changes, field):
    with pytest.raises(InvalidInput) as refused:
        Case(**{**GIVEN, "dt": 0.01, **changes})
    assert refused.value.field == field


def test_the_strengths_beyond_the_particles_are_those_of_an_open_run_only():
    """Particles that end half-way: on the lattice beyond them there is nothing, or the tail |x|^(-1-alpha)."""
    h, x = 0.1, lattice(400, 0.1)
    particles = x[200:-200]
    run = xr.Dataset(
        {"particle_position": ("particle", particles), "particle_strength": ("particle", h * power(particles, 1.5))},
        {"x": x, "particle_spacing": h, "remeshing": "M4'", "beta": 0.5, "overlap": 2.0},
    )  # fmt: skip
    ended = lattice_strengths(run.assign_coords(exterior="truncated"))
    assert ended[200:-200] == pytest.approx(power(particles, 1.5))
    assert not ended[:200].any()
    assert not ended[-200:].any()
    open_ = lattice_strengths(run.assign_coords(exterior="open"))
    # The tail's particles grow apart, and the farthest of them lie beyond the lattice.
    tail = (20.05**-1.5 - 40.05**-1.5) / 1.5
    for beyond in (open_[:200], open_[-200:]):
        assert 0.1 * tail < h * beyond.sum() < tail


def test_points_too_far_beyond_the_particles_are_refused_with_how_far_is_allowed():
    x = lattice(200, 0.1)
    velocity = dvm.DiffusionVelocity(1.5, 2, 0.2, exterior="open")
    with pytest.raises(InvalidInput, match=rf"up to {0.5 * REACH:g} smoothing lengths beyond"):
        velocity.field_and_flux(x, 0.1 * power(x, 1.5), np.array([20.0 + 0.6 * REACH * 0.2]))
    velocity.field_and_flux(x, 0.1 * power(x, 1.5), np.array([20.0 + 0.45 * REACH * 0.2]))
