"""DVM in the plane: sums over all pairs, moments, the exact velocity and solution, order, and what is refused."""

from __future__ import annotations

import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.integrate import dblquad

import fracparticles as fp
from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution, StabilityWarning
from fracparticles.moving.dvm_plane import PlaneVelocity, run_in_plane
from fracparticles.moving.lagrangian import FieldNotPositive
from fracparticles.moving.plane_remeshing import remesh_plane
from fracparticles.moving.plane_sums import PlaneSums, naive_sums
from fracparticles.moving.plane_tail import PlaneTail, far_flux
from fracparticles.moving.remeshing import REMESHINGS, remesh

ALPHA = 1.5


def lattice(spacing, half_width):
    line = spacing * np.arange(-round(half_width / spacing), round(half_width / spacing) + 1)
    return np.meshgrid(line, line, indexing="ij")


def exact(x, y, t=1.0, alpha=ALPHA):
    return fp.green(np.hypot(x, y), t, alpha, dim=2)


@pytest.fixture(scope="module")
def scattered():
    rng = np.random.default_rng(0)
    return *rng.uniform(-3.0, 3.0, (2, 300)), rng.standard_normal(300)


# --- sums -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("alpha", "order"), [(1.2, 2), (1.5, 4), (1.9, 2)])
def test_the_sums_are_those_over_all_pairs(scattered, alpha, order):
    found = PlaneSums(alpha, order, 0.4)(*scattered)
    naive = naive_sums(*scattered, alpha, order, 0.4)
    for ours, theirs in zip(found, naive, strict=True):
        assert np.abs(ours - theirs).max() < PlaneSums.accuracy * np.abs(theirs).max()


def test_the_sums_follow_particles_that_move_away(scattered):
    x, y, q = scattered
    sums = PlaneSums(ALPHA, 2, 0.4)
    sums(x, y, q)
    for shift, stretch in ((1e3, 1.0), (0.0, 1.7), (-5.0, 0.3)):
        moved = stretch * x + shift, stretch * y - shift
        naive = naive_sums(*moved, q, ALPHA, 2, 0.4)
        assert np.abs(sums(*moved, q) - naive).max() < 1e-10 * np.abs(naive).max()


@pytest.mark.parametrize("exponent", [-1000, -600, 600, 1000])
def test_the_sums_are_linear_to_the_ends_of_the_range_of_numbers(scattered, exponent):
    """Times a power of 2 they are the same to the last bit, however small the strengths and 1 / epsilon^2 large."""
    x, y, q = scattered
    unit = 1e-40 if exponent < 0 else 1e40
    sums = PlaneSums(ALPHA, 2, 0.4 * unit)
    found = sums(unit * x, unit * y, np.ldexp(q, exponent))
    assert np.array_equal(np.ldexp(found, -exponent), sums(unit * x, unit * y, q))


def test_strengths_that_lose_their_digits_are_refused():
    """1e-300 at spacings of 0.1 is 1e-302 in the plane: a field, but no strengths to 1e-16 of it."""
    u = 1e-300 * exact(*lattice(0.1, 1.0))
    with pytest.raises(InvalidInput, match=r"u = .* strengths of 1e-290 and more"):
        run_in_plane(u, spacing=0.1, alpha=ALPHA, dt=1e-4, steps=1)
    with pytest.raises(InvalidInput, match="overflow"):
        run_in_plane(1e308 + 0.0 * u, spacing=1e10, alpha=ALPHA, dt=1e-4, steps=1)


def test_sums_at_other_points(scattered):
    x, y, q = scattered
    sums = PlaneSums(ALPHA, 2, 0.4)
    some = x[:7] + 0.0, y[:7] + 0.0
    assert sums(x, y, q, some) == pytest.approx(sums(x, y, q)[:, :7], abs=1e-10)


def test_threads_may_share_the_sums(scattered):
    """Sets of other widths make it another box, each call with its own."""
    x, y, q = scattered
    sums, widths = PlaneSums(ALPHA, 2, 0.4), [0.2, 0.5, 1.0, 2.0, 3.0, 1.5] * 2
    with ThreadPoolExecutor(8) as pool:
        together = list(pool.map(lambda s: sums(s * x, s * y, q), widths))
    for s, found in zip(widths, together, strict=True):
        naive = naive_sums(s * x, s * y, q, ALPHA, 2, 0.4)
        assert np.abs(found - naive).max() < 1e-10 * np.abs(naive).max()


def test_sums_refuse_arrays_that_do_not_fit_together(scattered):
    x, y, q = scattered
    sums = PlaneSums(ALPHA, 2, 0.4)
    for given in ((x[1:], y, q), (x, y, q[1:]), (x, y, q, (x[:3], y[:4]))):
        with pytest.raises(InvalidInput, match="arrays of one shape"):
            sums(*given)


# --- remeshing ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", REMESHINGS)
def test_remeshing_keeps_the_moments(scattered, name):
    x, y, q = scattered
    at_x, at_y, total = remesh_plane(x, y, q, 0.3, name)
    highest = {"M4'": 2, "Lambda3": 3, "Lambda6,4": 6}[name]
    for a in range(highest + 1):
        for b in range(highest + 1):
            before, size = (q * x**a * y**b).sum(), (np.abs(q) * np.abs(x**a * y**b)).sum()
            assert (total * at_x**a * at_y**b).sum() == pytest.approx(before, abs=1e-13 * size)


@pytest.mark.parametrize("name", REMESHINGS)
def test_remeshing_is_the_product_of_that_of_the_line(name):
    line, q = np.array([-0.7, 0.1, 0.65, 2.0]), np.array([1.0, 2.0, -0.5, 0.3])
    x, y = np.meshgrid(line, line, indexing="ij")
    at, once = remesh(line, q, 0.5, name)
    at_x, at_y, total = remesh_plane(x, y, np.outer(q, q), 0.5, name)
    assert at_x[:, 0] == pytest.approx(at)
    assert at_y[0] == pytest.approx(at)
    assert total == pytest.approx(np.outer(once, once), abs=1e-15)


@pytest.mark.parametrize("far", [1e4, 1e30, 1e300])
def test_a_particle_that_ran_away_is_named(far):
    """Beyond 2^63 lattice points, too."""
    x, y = np.array([0.0, 0.3]), np.array([0.0, far])
    with pytest.raises(InvalidInput, match=r"y = 'particles from 0 to .* less than 819.2 apart"):
        remesh_plane(x, y, np.ones(2), 0.1, "M4'")


def test_particles_on_the_lattice_keep_their_strengths():
    x, y = lattice(0.1, 1.0)
    q = np.random.default_rng(1).random(x.shape)
    _, _, total = remesh_plane(x, y, q, 0.1, "M4'")
    assert np.array_equal(total[total != 0.0].reshape(x.shape), q)


# --- the far field --------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", [1.2, 1.8])
def test_the_flux_of_the_far_field_is_its_integral(alpha):
    x, y = 0.4, 0.3

    def integrand(a, b):
        squared = (x - a) ** 2 + (y - b) ** 2
        return (a * a + b * b) ** (-1 - alpha / 2) * (x - a) * squared ** (-1 - alpha / 2)

    inf = np.inf
    total = sum(
        dblquad(integrand, *along_b, *along_a, epsrel=1e-6)[0]
        for along_a, along_b in [
            ((1, inf), (-inf, inf)),
            ((-inf, -1), (-inf, inf)),
            ((-1, 1), (1, inf)),
            ((-1, 1), (-inf, -1)),
        ]
    )
    found = far_flux(np.array([x]), np.array([y]), alpha, 0.85)
    assert found[0] == pytest.approx(total, rel=2e-4)


def test_the_continued_particles_are_those_of_the_far_field():
    x, y = lattice(0.5, 4.0)
    strength = np.maximum(np.hypot(x, y), 0.1) ** -3.5
    wide_x, wide_y, wide = PlaneTail(ALPHA, 2, 1.0).continued(x, y, strength)
    more = (len(wide_x) - len(x)) // 2
    assert more == 14
    assert wide_x[:, 0] == pytest.approx(0.5 * np.arange(-22, 23))
    assert wide_y[3] == pytest.approx(0.5 * np.arange(-22, 23))
    assert wide == pytest.approx(np.maximum(np.hypot(wide_x, wide_y), 0.1) ** -3.5, rel=1e-12)


def test_the_velocity_of_the_fundamental_solution():
    # v = x / alpha at t = 1: of second order inside, as the kernels; at the ends the far field has its own error.
    errors = []
    for spacing in (0.2, 0.1):
        x, y = lattice(spacing, 6.0)
        velocity = PlaneVelocity(ALPHA, 2, 2.0 * spacing, exterior="open")
        vx, vy = velocity(x, y, spacing**2 * exact(x, y))
        error = np.hypot(vx - x / ALPHA, vy - y / ALPHA)
        errors.append(error[np.hypot(x, y) < 2.0].max())
        alone = PlaneVelocity(ALPHA, 2, 2.0 * spacing)(x, y, spacing**2 * exact(x, y))
        assert np.abs(alone[0] - x / ALPHA).max() > 20.0 * error.max()
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.25)


# --- runs -----------------------------------------------------------------------------------------


def test_a_run_against_the_exact_solution_with_the_order_of_its_kernels():
    errors = []
    for spacing in (0.4, 0.2):
        x, y = lattice(spacing, 5.0)
        run = run_in_plane(
            exact(x, y), spacing=spacing, alpha=ALPHA, dt=0.1, steps=10, start=1.0,
            remeshing="none", exterior="open",
        )  # fmt: skip
        assert run.total_final == run.total_initial  # to the last bit
        end = exact(x, y, 2.0)
        errors.append(np.abs(run.field(x, y) - end).max() / end.max())
    assert errors[-1] < 4e-3
    assert np.log2(errors[0] / errors[1]) > 1.8


@pytest.mark.parametrize("exterior", ["truncated", "open"])
def test_remeshing_by_a_smooth_function_leaves_the_error_of_the_kernels(exterior):
    x, y = lattice(0.2, 4.0)
    errors = []
    for remeshing, at_edge in (("none", "open"), ("Lambda6,4", exterior), ("Lambda3", exterior)):
        run = run_in_plane(
            exact(x, y, 0.5), spacing=0.2, alpha=ALPHA, dt=0.04, steps=6, start=0.5, order=4,
            remeshing=remeshing, exterior=at_edge,
        )  # fmt: skip
        assert (len(run.remeshing_times) > 2) == (remeshing != "none")
        inside, end = np.hypot(x, y) < 2.0, exact(x, y, 0.74)
        errors.append(np.abs(run.field(x, y) - end)[inside].max() / end.max())
        assert run.total_final + run.lost == pytest.approx(run.total_initial, rel=1e-13)
    kernels, smooth, rough = errors
    assert smooth < 1.1 * kernels
    assert rough > 5.0 * smooth


@pytest.mark.parametrize("exterior", ["truncated", "open"])
@pytest.mark.parametrize("remeshing", REMESHINGS)
def test_what_remeshing_leaves_out_is_counted(exterior, remeshing):
    x, y = lattice(0.4, 5.0)
    run = run_in_plane(
        exact(x, y), spacing=0.4, alpha=ALPHA, dt=0.1, steps=10, start=1.0,
        remeshing=remeshing, exterior=exterior,
    )  # fmt: skip
    assert len(run.remeshing_times) > 2
    assert run.total_final + run.lost == pytest.approx(run.total_initial, rel=1e-13)
    end = exact(x, y, 2.0)
    assert np.abs(run.field(x, y) - end).max() < 0.03 * end.max()


def test_a_run_keeps_the_symmetries_of_the_square():
    x, y = lattice(0.5, 4.0)
    u = exact(x, y) * (1.0 + 0.1 * np.cos(x) * np.cos(2.0 * y))
    settings = {"spacing": 0.5, "alpha": ALPHA, "dt": 0.1, "steps": 4, "exterior": "open"}
    one, other = run_in_plane(u, **settings), run_in_plane(u.T, **settings)
    assert one.field(x, y) == pytest.approx(other.field(x, y).T, abs=1e-9)
    assert one.field(x, y) == pytest.approx(one.field(-x, y), abs=1e-9)


def test_a_field_of_two_signs_is_refused_with_the_time():
    x, y = lattice(0.5, 4.0)
    with pytest.raises(FieldNotPositive, match=r"^step 1 of 3, from t = 2 to 2\.1: the field is"):
        run_in_plane(x * exact(x, y), spacing=0.5, alpha=ALPHA, dt=0.1, steps=3, start=2.0)


def test_outermost_rows_that_have_met_are_refused_with_the_time():
    """Of rows that have changed places, or nearly meet, no number of rows goes on with the last gap."""
    x, y = lattice(0.4, 1.6)
    data = {"u": np.exp(-(x**2) - y**2), "spacing": 0.4, "alpha": 1.1, "dt": 0.35, "steps": 5}
    with pytest.raises(NonFiniteSolution, match=r"^step 1 of 5, .*outermost rows .* Remesh"):
        run_in_plane(**data, order=4, overlap=1.5, exterior="open")
    far = PlaneTail(ALPHA, 2, 0.4)
    x[0] = x[1] - 1e-9
    with pytest.raises(InvalidInput, match=r"particles 1e-09 apart"):
        far.continued(x, y, np.ones_like(x))


def test_a_step_that_is_too_large_is_said():
    x, y = lattice(0.5, 2.0)
    limit = PlaneVelocity(ALPHA, 2, 1.0).largest_stable_step
    with pytest.warns(StabilityWarning, match="lies outside the stability interval of DVM"):
        run_in_plane(
            exact(x, y), spacing=0.5, alpha=ALPHA, dt=1.1 * limit, steps=1, exterior="open"
        )


@pytest.mark.parametrize(
    ("exterior", "words"), [("open", "does not meet the field inside"), ("truncated", "left out 0")]
)
def test_a_lattice_that_is_too_small_is_said(exterior, words):
    for half_width, expected in ((2.0, 1), (8.0, 0)):
        x, y = lattice(0.5, half_width)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            run_in_plane(
                exact(x, y),
                spacing=0.5,
                alpha=ALPHA,
                dt=0.1,
                steps=10,
                start=1.0,
                exterior=exterior,
            )
        assert sum(words in str(one.message) for one in said) == expected
        assert all(one.category is AccuracyWarning for one in said)


@pytest.mark.parametrize(
    ("spacing", "overlap", "order", "words"),
    [
        (1.0, 2.0, 2, "is not u at the start"),
        (1.0, 2.0, 4, "is not u at the start"),
        (0.25, 5.0, 2, "is not u at the start"),
        (0.25, 0.7, 2, "are too far apart"),
        (0.25, 2.0, 2, None),
        (0.25, 2.0, 4, None),
    ],
)
def test_data_that_the_particles_do_not_hold_are_said(spacing, overlap, order, words):
    x, y = lattice(spacing, 10.0 if spacing == 1.0 else 6.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run_in_plane(
            exact(x, y), spacing=spacing, alpha=ALPHA, dt=0.01, steps=1, order=order, overlap=overlap, exterior="open"
        )  # fmt: skip
    assert len(caught) == (words is not None)
    assert all(words in str(one.message) for one in caught)


@pytest.mark.parametrize(("remeshing", "overlap"), [("Lambda3", 1.0), ("Lambda6,4", 2.0)])
def test_remeshings_that_change_the_field_are_said(remeshing, overlap, recwarn):
    """A kernel as narrow as the spacing sees the kinks of Lambda3: the peak rose in silence."""
    x, y = lattice(0.3, 5.4)
    run = run_in_plane(
        exact(x, y), spacing=0.3, alpha=ALPHA, dt=0.1, steps=12, order=4, overlap=overlap, start=1.0,
        remeshing=remeshing, exterior="open",
    )  # fmt: skip
    peak = float(exact(np.zeros(1), np.zeros(1), 2.2)[0])
    off = abs(float(run.field(np.zeros(1), np.zeros(1))[0]) - peak) / peak
    said = [str(one.message) for one in recwarn if "remeshings have changed" in str(one.message)]
    if overlap == 2.0:
        assert off < 0.01
        assert not recwarn.list
        return
    assert off > 0.05
    # What changes the peak early has spread by the end, and what is measured stands for as many again: twice or half.
    (text,) = said
    assert off / 2.0 < float(text.split("by ")[1].split(" of")[0]) < 2.0 * off


def test_a_field_is_not_asked_for_where_the_sums_do_not_hold_it():
    x, y = lattice(0.5, 4.0)
    run = run_in_plane(exact(x, y), spacing=0.5, alpha=ALPHA, dt=0.1, steps=1, exterior="open")
    with pytest.raises(InvalidInput, match=r"^x = "):
        run.field(np.array([30.0]), np.array([0.0]))


@pytest.mark.parametrize(
    ("bad", "field"),
    [
        ({"u": np.ones((4, 4))}, "u"),
        ({"u": np.ones((5, 7))}, "u"),
        ({"u": np.full((5, 5), np.nan)}, "u"),
        ({"spacing": 0.0}, "spacing"),
        ({"alpha": 2.0}, "alpha"),
        ({"dt": -1.0}, "dt"),
        ({"steps": 0}, "steps"),
        ({"overlap": 0.0}, "overlap"),
        ({"diffusivity": np.inf}, "diffusivity"),
        ({"remeshing": "M5"}, "remeshing"),
        ({"remesh_above": 1.0}, "remesh_above"),
        ({"exterior": "closed"}, "exterior"),
        ({"order": 3}, "order"),
    ],
)
def test_bad_runs_are_refused(bad, field):
    x, y = lattice(0.5, 1.0)
    good = {"u": exact(x, y), "spacing": 0.5, "alpha": ALPHA, "dt": 0.1, "steps": 1}
    given = {**good, **bad}
    with pytest.raises(InvalidInput, match=rf"^{field} = ") as error:
        run_in_plane(given.pop("u"), **given)
    assert "\n" not in str(error.value)
