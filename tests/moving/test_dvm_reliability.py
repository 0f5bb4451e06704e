"""What the particles of a run say of its accuracy, against what is measured."""

from __future__ import annotations

import re

import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning, InvalidInput, StabilityWarning
from fracparticles.moving import dvm
from fracparticles.moving.reliability import cells, looked_at, ripple
from fracparticles.schemes.stability import stability_limit
from fracparticles.special.stable import green

ALPHA, START = 1.5, 0.5


def cloud(half_width=10.0, h=0.1):
    n = round(half_width / h)
    x = h * np.arange(-n, n + 1.0)
    return x, green(x, START, ALPHA)


def moved(x, u, *, dt=0.02, steps=10, **options):
    return dvm.run(x, u, spacing=0.1, alpha=ALPHA, dt=dt, steps=steps, start=START, **options)


def test_cells_fill_the_line():
    x = np.array([3.0, 0.0, 1.0, 1.0])
    # The gaps are 1, 0, 2; an end has the whole gap next to it.
    assert cells(x).tolist() == [2.0, 1.0, 0.5, 1.0]


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("overlap", [0.4, 0.6, 0.8])
def test_the_ripple_of_a_uniform_field_is_that_of_the_transform(order, overlap):
    x = np.arange(-200.0, 201.0)
    velocity = dvm.DiffusionVelocity(ALPHA, order, overlap)
    z = np.linspace(-0.5, 0.5, 201)
    field = velocity.field(x, np.ones(x.size), z)
    # Between the crest and the mean; the second wave has K^(4 pi s) < 2e-3 at s = 0.4, four times as fine.
    measured = 0.5 * (field.max() - field.min())
    predicted = ripple(x, np.ones(x.size), overlap, velocity.transform)
    assert predicted == pytest.approx(measured, rel=0.01)


def test_no_ripple_of_particles_in_one_place_and_a_full_one_of_a_single_particle():
    transform = dvm.DiffusionVelocity(ALPHA, 2, 1.0).transform
    assert ripple(np.zeros(5), np.ones(5), 1.0, transform) == 0.0
    assert ripple(np.zeros(1), np.ones(1), 1.0, transform) == 1.0


@pytest.mark.parametrize(("overlap", "wrong"), [(0.4, 0.3), (0.5, 0.1)])
def test_too_small_an_overlap_is_warned_of(overlap, wrong):
    x, u = cloud()
    with pytest.warns(AccuracyWarning, match="too far apart for the smoothing length"):
        run = moved(x, u, dt=1e-3, steps=1000, overlap=overlap)
    exact = green(x, START + 1.0, ALPHA)
    assert np.abs(run.field(x) - exact).sum() > wrong * exact.sum()


def test_a_fine_run_says_nothing(recwarn):
    x, u = cloud()
    moved(x, u)
    moved(x, u, exterior="open")
    assert not recwarn.list


@pytest.mark.parametrize("ratio", [0.5, 0.9, 1.1, 2.0])
def test_a_spacing_that_is_not_that_of_the_places_is_warned_of(ratio):
    """The strengths are h u: the field comes out as many times too large as the spacing is."""
    x, u = cloud()
    with pytest.warns(
        AccuracyWarning, match=f"spacing = {0.1 * ratio:.4g}, and the places are 0.1 "
    ):
        run = dvm.run(x, u, spacing=0.1 * ratio, alpha=ALPHA, dt=1e-3, steps=5, order=4)
    assert run.strength.sum() == pytest.approx(ratio * 0.1 * u.sum(), rel=1e-3)


def test_the_places_may_come_in_any_order_and_be_shaken_and_share_a_place(recwarn):
    x, u = cloud()
    rng = np.random.default_rng(0)
    shaken = x + rng.uniform(-0.02, 0.02, x.size)
    moved(shaken, green(shaken, START, ALPHA), order=4)
    moved(x[::-1], u[::-1])
    moved(np.concatenate([x, x]), np.concatenate([0.5 * u, 0.5 * u]), remeshing="none")
    assert not recwarn.list


def test_data_that_the_kernels_smooth_are_warned_of():
    """Of a Gaussian of width w the kernel exp(-(x/eps)^2) leaves the peak (1 + (eps/w)^2)^(-1/2)."""
    x, _ = cloud()
    peak = (1.0 + (0.2 / 0.18) ** 2) ** -0.5
    with pytest.warns(AccuracyWarning, match=f"not u at the start, by {1.0 - peak:.2g} "):
        moved(x, np.exp(-np.square(x / 0.18)), dt=1e-4, steps=1, threshold=1e-4)


def test_what_a_threshold_takes_away_is_warned_of():
    x, u = cloud()
    with pytest.warns(AccuracyWarning, match=r"held 0\.\d+ of the total"):
        run = moved(x, u, threshold=0.2)
    assert run.history.eliminated_strength > 0.05 * run.history.total_initial


def test_what_a_narrow_lattice_loses_is_warned_of():
    x, u = cloud(half_width=2.0)
    with pytest.warns(AccuracyWarning, match=r"left out 0\.\d+ of the total strength"):
        moved(x, u, dt=0.05, steps=20)


@pytest.mark.parametrize(("half_width", "centre"), [(2.0, 0.0), (10.0, 8.0)])
def test_tails_that_do_not_continue_the_field_are_warned_of(half_width, centre):
    x, _ = cloud(half_width)
    with pytest.warns(AccuracyWarning, match="does not meet the field inside"):
        run = moved(x, green(x - centre, START, ALPHA), dt=0.02, steps=50, exterior="open")
    z = np.linspace(-0.9, 0.9, 91) * half_width
    assert np.abs(run.field(z) - green(z - centre, START + 1.0, ALPHA)).max() > 0.01


def test_a_step_beyond_the_limit_is_warned_of():
    x, u = cloud()
    velocity = dvm.DiffusionVelocity(ALPHA, 2, 0.2)
    limit = stability_limit("DD", ALPHA - 1.0) * 0.1**ALPHA
    # The same but for aliases, at this overlap exp(-pi^2 4 3/4) of the whole.
    assert velocity.largest_stable_step == pytest.approx(limit, rel=1e-5)
    with pytest.warns(StabilityWarning, match="outside the stability interval of DVM"):
        moved(x, u, dt=1.01 * limit, steps=1)


def test_a_few_steps_that_are_too_long_are_warned_of(recwarn):
    """Within the limit of stability a twentieth of the peak was wrong without a word, and up to a third."""
    h, alpha, start = 0.3, 1.18, 1.3**1.18
    x = h * np.arange(-33.0, 34.0)

    def run(dt, steps):
        how = {"spacing": h, "alpha": alpha, "start": start, "exterior": "open"}
        return dvm.run(x, green(x, start, alpha), dt=dt, steps=steps, **how).field(x)

    limit = dvm.DiffusionVelocity(alpha, 2, 2.0 * h, exterior="open").largest_stable_step
    few, end = 4, 4 * 0.95 * limit
    with pytest.warns(AccuracyWarning, match="so long that they leave an error of about") as caught:
        u = run(end / few, few)
    fine = run(end / (16 * few), 16 * few)
    said = float(re.search(r"about ([\d.e-]+) of", str(caught[0].message))[1])
    measured = np.abs(u - fine).max() / u.max()
    # Of second order: half the step has a quarter of it, give or take the next order, which is half of that before.
    assert measured / 2.0 < said < 2.0 * measured
    recwarn.clear()
    run(0.25 * end / few, few)
    assert not len(recwarn)


def test_numbers_that_overflow_are_refused():
    x, u = cloud()
    with pytest.raises(InvalidInput) as error:
        dvm.run(x, 1e300 * u, spacing=1e50, alpha=ALPHA, dt=1.0, steps=1)
    assert error.value.field == "u"


@pytest.mark.parametrize(("remeshing", "overlap"), [("Lambda3", 1.0), ("Lambda6,4", 2.0)])
def test_remeshings_that_change_the_field_are_said(remeshing, overlap, recwarn):
    """A kernel as narrow as the spacing sees the kinks of Lambda3: the peak rose in silence, as in the plane."""
    h, age = 0.1, 0.2**ALPHA
    x = h * np.arange(-30, 31)
    limit = dvm.DiffusionVelocity(ALPHA, 4, overlap * h).largest_stable_step
    steps = round(4.0 * age / min(0.4 * limit, 0.1 * age))  # a step is a small share of the age
    run = dvm.run(
        x, green(x, age, ALPHA), spacing=h, alpha=ALPHA, dt=4.0 * age / steps, steps=steps,
        start=age, order=4, overlap=overlap, remeshing=remeshing, exterior="open",
    )  # fmt: skip
    exact = green(x, 5.0 * age, ALPHA)
    off = np.abs(run.field(x) - exact).max() / exact.max()
    if overlap == 2.0:
        assert off < 0.01
        assert not recwarn.list
        return
    assert off > 0.05
    (text,) = (str(one.message) for one in recwarn)
    # What changes the peak early has spread by the end, and what is measured stands for as many again: twice or half.
    assert off / 2.0 < float(text.split("changed the field by ")[1].split(" of")[0]) < 2.0 * off


def test_of_many_places_the_strongest_are_looked_at_and_some_everywhere():
    """All of them were: with sums one by one that took as long as the run."""
    u = np.zeros(100_000)
    u[[700, 90_001]] = -3.0, 2.0
    looks = looked_at(u)
    assert looks.size <= 2048
    assert np.isin([700, 90_001], looks).all()
    # Half of them are equally spaced.
    assert np.diff(looks).max() <= -(-u.size // 1023)
    assert looked_at(u[:2048]).tolist() == list(range(2048))


def test_gaps_before_a_remeshing_are_said():
    """Only those of the start and the end were looked at; between, gaps of two overlaps had made waves."""
    h, alpha, age = 0.1, 1.7, 1.0
    x = h * np.arange(-150, 151)
    limit = dvm.DiffusionVelocity(alpha, 2, h).largest_stable_step
    steps = round(4.0 * age / (0.4 * limit))
    with pytest.warns(AccuracyWarning, match="too far apart for the smoothing length"):
        run = dvm.run(
            x, green(x, age, alpha), spacing=h, alpha=alpha, dt=4.0 * age / steps, steps=steps,
            start=age, overlap=1.0, exterior="open", remesh_above=2.0,
        )  # fmt: skip
    exact = green(x, 5.0 * age, alpha)
    assert np.abs(run.field(x) - exact)[50:-50].max() > 0.05 * exact.max()
