"""What a run says of itself: the estimates against true errors, and a warning wherever a number is wrong."""

from __future__ import annotations

import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.run.reliability import between_particles, estimates, wave_error, wavenumber
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute
from fracparticles.special.stable import green
from sweeps import covering


def bump(*x):
    return np.exp(-sum(np.square(part) for part in x))


def case_of(**given) -> fp.Case:
    stepped = (
        {} if given.get("scheme") == "GPSE" or "dt" in given else {"integrator": "exponential"}
    )
    return fp.Case(**{"scheme": "KPSE", "beta": 0.5, "t_initial": 0.0, **stepped, **given})


# --- the far field ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "time"),
    [
        ({"dim": 2, "half_width": 8.0, "spacing": 0.2}, 100.0),
        ({"dim": 2, "half_width": 8.0, "spacing": 0.2}, 1000.0),
        ({"scheme": "DD", "half_width": 8.0, "spacing": 0.1}, 1000.0),
        ({"scheme": "DD", "half_width": 8.0, "spacing": 0.1, "evaluation": "convolution"}, 1e4),
        ({"scheme": "DD", "order": 4, "dim": 2, "half_width": 8.0, "spacing": 0.2}, 1e6),
        ({"scheme": "FPSE", "dim": 3, "half_width": 4.0, "spacing": 0.5}, 100.0),
    ],
)
def test_an_open_lattice_that_the_solution_outgrows_is_refused(given, time):
    with pytest.raises(InvalidInput, match=r"half_width.*wider than the solution"):
        case_of(exterior="open", t_final=time, **given)


@pytest.mark.parametrize(
    ("dim", "half_width"), [(1, 4.0), (1, 8.0), (1, 16.0), (1, 40.0), (2, 4.0), (2, 8.0), (2, 16.0)]
)
@pytest.mark.parametrize("beta", [0.1, 0.5, 0.9])
def test_the_far_field_estimate_is_no_fiction(dim, beta, half_width):
    """Order 12 resolves the data, so that the error is that of the far field: not far above the estimate."""
    spacing = 0.15 if dim == 1 else 0.25
    case = case_of(
        order=12, beta=beta, dim=dim, half_width=half_width, spacing=spacing, exterior="open",
        t_initial=0.5, t_final=1.5,
    )  # fmt: skip
    run = compute(case)
    estimate = run.estimates["far_field_error"][0]
    inside = case.radius <= 2.0
    exact = green(case.radius[inside], 1.5, case.alpha, dim)
    error = np.abs(run.u[inside] - exact).sum() / np.abs(exact).sum()
    # Within a factor of ten from above, but for what the kernels of order 12 leave.
    assert error <= 10.0 * estimate + 1e-9


def test_data_of_another_tail_are_told_apart():
    """1 / (1 + x^2) at beta = 0.3: the closure takes |x|^-2.3, and the error is above what it leaves otherwise."""
    given = {"beta": 0.3, "half_width": 20.0, "spacing": 0.1, "exterior": "open", "t_final": 1.0}
    case = case_of(**given)
    with pytest.warns(AccuracyWarning, match="the far field leaves a relative error"):
        run = compute(case, lambda x: 1.0 / (1.0 + x**2))
    wide = compute(case_of(**{**given, "half_width": 640.0}), lambda x: 1.0 / (1.0 + x**2))
    middle = slice(wide.case.n - case.n, wide.case.n + case.n + 1)
    error = np.abs(run.u - wide.u[middle]).sum() / np.abs(run.u).sum()
    estimate = run.estimates["far_field_error"][0]
    assert estimate / 10.0 <= error <= 10.0 * estimate
    right = compute(case, lambda x: green(x, 1.0, 1.3))
    assert right.estimates["far_field_error"][0] < 0.5 * estimate


def test_a_good_open_run_says_nothing():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for scheme in ("DD", "FPSE", "KPSE"):
            case = fp.Case(
                scheme=scheme, beta=0.5, truncation=20.0, spacing=0.1, integrator="exponential", exterior="open"
            )  # fmt: skip
            run = compute(case)
            assert relative_l1_error(case, run.u) < 0.02


# --- a truncated lattice, and what leaves it -------------------------------------------------------------------------


@pytest.mark.parametrize("scheme", ["DD", "FPSE", "KPSE"])
def test_data_that_do_not_vanish_at_the_ends_are_named(scheme):
    case = case_of(scheme=scheme, half_width=8.0, spacing=0.1, t_final=1.0)
    with pytest.warns(AccuracyWarning, match="does not fit on"):
        compute(case, np.ones_like)


@pytest.mark.parametrize(("time", "factor"), [(1.0, 5.0), (10.0, 12.0), (100.0, 21.0)])
def test_the_layer_of_fpse_is_named(time, factor):
    case = case_of(scheme="FPSE", half_width=8.0, spacing=0.1, t_final=time)
    with pytest.warns(AccuracyWarning, match="has grown by the factor"):
        run = compute(case, np.ones_like)
    assert run.estimates["growth"][0] == pytest.approx(factor, rel=0.1)


def test_tabulated_kernels_give_the_exponential_of_their_own_matrix():
    from scipy.linalg import expm

    from fracparticles.schemes import SCHEMES
    from fracparticles.schemes.spectrum import dense_matrix

    case = case_of(
        scheme="FPSE", order=4, beta=0.81628, spacing=0.0021, half_width=1.0776, overlap=0.74966, kernel_table=0.1,
        t_final=1.0,
    )  # fmt: skip
    with pytest.warns(AccuracyWarning, match="has grown by the factor"):
        run = compute(case, np.ones_like)
    exact = expm(dense_matrix(SCHEMES["FPSE"].operator(case.setting))) @ np.ones(case.particles)
    assert np.abs(run.u - exact).max() <= 1e-8 * np.abs(exact).max()


# --- resolution ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("k", [0.01, 0.3, 1.0, 3.0])
def test_the_wavenumber_of_a_wave_is_its_own(k):
    x = np.arange(-2000, 2001)
    assert wavenumber(np.cos(k * x)) == pytest.approx(k, rel=0.02)
    assert wavenumber(np.cos(k * x)[:, None] * np.ones(4)) == pytest.approx(k, rel=0.02)
    assert wavenumber(1e300 * np.cos(k * x)) == pytest.approx(k, rel=0.02)


@pytest.mark.parametrize(
    ("given", "initial"),
    [
        ({"half_width": 50.0, "spacing": 5.0}, bump),
        ({"half_width": 50.0, "spacing": 0.6, "t_initial": 1e-6}, None),
        ({"half_width": 50.0, "spacing": 2.0, "dim": 2}, bump),
        ({"half_width": 8.0, "spacing": 0.1}, lambda x: np.random.default_rng(1).random(x.size)),
    ],
)
def test_data_narrower_than_the_spacing_are_named_with_the_numbers(given, initial):
    with pytest.warns(
        AccuracyWarning, match=r"vary over the length .*spacing h = .*Take spacing <="
    ):
        compute(case_of(t_final=1.0, **given), initial)


def test_data_off_the_lattice_are_named():
    with pytest.warns(AccuracyWarning, match="zero at all particles"):
        compute(case_of(half_width=8.0, spacing=0.1, t_final=1.0), lambda x: bump(x - 100.0))


def test_the_estimates_are_stored_and_cost_little():
    case = case_of(half_width=20.0, spacing=0.1, t_final=1.0, exterior="open", t_initial=0.5)
    run = fp.solve(case)
    names = ("resolution", "growth", "outside_share", "tail_misfit", "far_field_error", "round_off")
    found = estimates(case, *(np.asarray(part) for part in (green(case.x, 0.5, 1.5), run.u)))
    for name in names:
        assert float(run[name]) == pytest.approx(found[name][0], rel=1e-12)
        assert run[name].attrs["long_name"]


# --- the error does not depend on the units --------------------------------------------------------------------------


@pytest.mark.parametrize("time", [1e-2, 7.0, 1e5])
@pytest.mark.parametrize("dim", [1, 2])
def test_the_error_of_the_same_problem_in_other_units_is_the_same(time, dim):
    given = {"truncation": 8.0, "spacing": 0.4, "t_initial": 0.5, "t_final": 1.5, "dim": dim}
    error = float(fp.solve(case_of(**given)).relative_l1_error)
    scaled = given | {"t_initial": 0.5 * time, "t_final": 1.5 * time, "diffusivity": 1.0 / time}
    assert float(fp.solve(case_of(**scaled)).relative_l1_error) == pytest.approx(error, rel=1e-9)
    length = 1e3
    stretched = given | {"spacing": 0.4 * length, "diffusivity": length**1.5}
    assert float(fp.solve(case_of(**stretched)).relative_l1_error) == pytest.approx(error, rel=1e-9)


# --- threads ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given",
    [
        {"half_width": 100.0, "spacing": 0.1},
        {"half_width": 10.0, "spacing": 0.2},
        {"scheme": "FPSE", "half_width": 40.0, "spacing": 0.1, "exterior": "open"},
        {"scheme": "DPSE", "half_width": 40.0, "spacing": 0.1},
        {"scheme": "FPSE", "half_width": 5.0, "spacing": 0.25, "dim": 2},
        {"scheme": "KPSE", "half_width": 8.0, "spacing": 0.25, "dim": 2, "exterior": "open"},
        {"scheme": "GPSE", "half_width": 100.0, "spacing": 0.1, "dt": 1.0},
        {"half_width": 100.0, "spacing": 0.1, "exterior": "open", "evaluation": "convolution"},
    ],
)
def test_threads_may_share_a_case_made_ready(given):
    ready = fp.prepare(case_of(t_final=1.0, **given))
    x = ready.case.positions
    data = [bump(*(part - shift for part in x)) for shift in np.linspace(-2.0, 2.0, 24)]
    one_by_one = [ready.solve(u0) for u0 in data]
    with ThreadPoolExecutor(8) as pool:
        together = list(pool.map(ready.solve, data))
    assert all(np.array_equal(a, b) for a, b in zip(one_by_one, together, strict=True))


# --- what the symbol says, and a table ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given",
    [
        {"scheme": "DPSE", "beta": 0.63, "overlap": 0.41, "half_width": 5.2, "spacing": 0.027},
        {"scheme": "KPSE", "beta": 0.935, "order": 8, "overlap": 0.31, "half_width": 44.0, "spacing": 0.089},
        {"scheme": "FD", "beta": 1e-5, "half_width": 13.0, "spacing": 0.024},
        {"scheme": "KPSE", "half_width": 20.0, "spacing": 0.1, "integrator": "euler", "dt": 0.5, "overlap": 10.0},
    ],
)  # fmt: skip
def test_waves_that_come_out_wrong_are_named(given):
    with pytest.warns(AccuracyWarning, match="come out wrong by"):
        run = compute(case_of(t_final=1.0, **given), bump)
    exact = compute(
        case_of(beta=run.case.beta, half_width=60.0, spacing=0.1, order=12, t_final=1.0, exterior="open"), bump
    )  # fmt: skip
    ours = np.interp([0.0, 0.5, 1.0], run.x, run.u)
    assert np.abs(ours - np.interp([0.0, 0.5, 1.0], exact.x, exact.u)).max() > 0.005


def test_ends_that_absorb_hide_nothing():
    """What has left the lattice leaves no strength at its ends: the share is that of a point mass."""
    case = case_of(
        scheme="FD", beta=0.88, half_width=1.0, spacing=0.005, diffusivity=50.0, t_final=0.1
    )
    with pytest.warns(AccuracyWarning, match="does not fit on"):
        compute(case, lambda x: bump(20.0 * x))


@pytest.mark.parametrize("step", [0.38, 0.1, 1e-3])
def test_a_table_too_coarse_is_named(step):
    given = {
        "scheme": "GPSE",
        "beta": 0.96,
        "half_width": 20.0,
        "spacing": 0.05,
    }
    case = case_of(**given, t_final=1.0, kernel_table=step)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = compute(case, bump)
    exact = compute(case_of(**given, t_final=1.0), bump)
    error = np.abs(run.u - exact.u).sum() / np.abs(exact.u).sum()
    estimate = run.estimates["table_error"][0]
    assert error <= 2.0 * estimate
    assert any("interpolated in a table" in str(one.message) for one in caught) == (estimate > 0.05)
    assert error < 0.05 or caught


def test_a_field_of_zeros_has_no_wave():
    assert wavenumber(np.zeros(9)) == 0.0


def test_a_warning_points_at_the_call():
    case = case_of(half_width=8.0, spacing=1.0, t_final=1.0)
    with pytest.warns(AccuracyWarning, match="spacing") as said:
        fp.solve(case, initial=lambda x: np.exp(-25.0 * x * x))
    assert {warning.filename for warning in said} == {__file__}


@pytest.mark.parametrize("order", [2, 4, 8])
def test_the_error_of_a_wave_is_that_of_the_run(order):
    """In the middle of a long train of waves, whose envelope changes the amplitude by (k width)^-2 = 4e-5 or so."""
    k = 0.5
    case = case_of(half_width=1500.0, spacing=1.0, t_final=2.0, order=order, kernel_family="gamma")
    run = compute(case, lambda x: np.cos(k * x) * np.exp(-np.square(x / 300.0)))
    middle = run.u[case.particles // 2]
    error = abs(middle / np.exp(-2.0 * k**1.5) - 1.0)
    assert wave_error(case, run.u0) == pytest.approx(error, rel=0.02, abs=1e-4)


@pytest.mark.parametrize(
    ("lattice", "order", "scheme"),
    covering(
        [(1, 20.0, 0.2), (1, 20.0, 0.4), (2, 8.0, 0.2), (2, 8.0, 0.4), (3, 5.0, 0.4)],
        [2, 4],
        ["DD", "FPSE", "KPSE"],
        together=2,
    ),
)
def test_the_error_of_waves_is_that_of_the_peak(lattice, order, scheme):
    """Of the fundamental solution all waves are in phase at x = 0: the estimate is the error there."""
    dim, half_width, spacing = lattice
    fields = {
        "half_width": half_width,
        "spacing": spacing,
        "t_initial": 0.5,
        "t_final": 1.0,
        "exterior": "open",
    }
    run = compute(case_of(scheme=scheme, order=order, dim=dim, **fields))
    middle = (run.case.n,) * dim
    error = abs(run.u[middle] / fp.green(0.0, 1.0, run.case.alpha, dim) - 1.0)
    # 64 waves stand for all: a share of 1/64 may lie between two that differ by the slope of the error.
    assert run.estimates["wave_error"][0] == pytest.approx(error, rel=0.1, abs=2e-4)


@pytest.mark.parametrize("scheme", ["DD", "FPSE", "KPSE"])
def test_an_early_output_time_is_judged_as_a_run_that_ends_there(scheme):
    """At the last time the waves that came out wrong have decayed: FPSE errs by two fifths of the peak at the first."""
    fields = {"half_width": 100.0, "spacing": 0.2, "exterior": "open"}
    several = case_of(scheme=scheme, times=[0.3, 30.0], **fields)

    def peak(x):
        return np.exp(-np.square(x / 0.5))

    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        run = compute(several, peak)
    first = compute(several.until(0.3), peak)
    assert run.estimates["wave_error"][0] >= first.estimates["wave_error"][0] > 0.05
    assert any("come out wrong" in str(one.message) for one in said)


@pytest.mark.parametrize("times", [[1.8], [3.6], [1.8, 3.6], [1.8, 18.0]])
def test_a_narrow_peak_stays_where_little_is_exchanged_on_a_truncated_lattice(times):
    """The share b of a peak that has nowhere to go is kept in each of n exchanges, b^n of it at least in all."""
    fields = {"beta": 0.16, "half_width": 14.5, "spacing": 0.1, "dt": 1.8}
    case = case_of(scheme="GPSE", times=times, **fields)
    wide = case_of(scheme="GPSE", times=times[:1], exterior="open", **fields)
    run, better = (compute(one, lambda x: np.exp(-np.square(x / 0.2))) for one in (case, wide))
    middle = np.s_[0, case.n]
    error = abs(run.outputs.u[middle] - better.outputs.u[middle]) / run.outputs.u[middle]
    kept = run.estimates["kept"][0]
    assert 0.05 < kept < error + 0.05
    if times[0] == 1.8:
        # The rest is what other particles keep for themselves: a share b = 0.05 of it.
        assert kept == pytest.approx(error, abs=0.05)


# --- what hides, what decays, and units ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given",
    [
        {"scheme": "FPSE", "order": 4, "beta": 0.02, "half_width": 56.0, "spacing": 7.0, "overlap": 0.29},
        {"scheme": "KPSE", "beta": 0.3, "half_width": 73.0, "spacing": 8.1, "overlap": 0.36},
    ],
)  # fmt: skip
def test_an_overlap_below_one_does_not_hide_that_the_lattice_is_too_coarse(given):
    with pytest.warns(AccuracyWarning, match="do not resolve"):
        compute(case_of(t_initial=0.1, t_final=0.2, **given))


@pytest.mark.parametrize("dim", [1, 2])
def test_a_function_is_asked_between_the_particles(dim):
    case = case_of(dim=dim, half_width=8.0, spacing=0.5, t_final=0.5)

    def spike(*x):
        return bump(*x) + 50.0 * bump(*(20.0 * (part - 2.25) for part in x))

    with pytest.warns(AccuracyWarning, match="data between the particles"):
        run = compute(case, spike)
    assert run.estimates["between_particles"][0] > 0.5
    assert "between_particles" not in compute(case, bump(*case.positions)).estimates


def test_a_function_that_knows_the_particles_only_is_not_asked_elsewhere():
    case = case_of(half_width=8.0, spacing=0.25, t_final=0.5)
    known = dict(zip(case.x.tolist(), bump(case.x).tolist(), strict=True))
    run = compute(case, lambda x: np.array([known[place] for place in x.tolist()]))
    assert run.estimates["between_particles"][0] == 0.0


def test_a_graded_peak_that_hides_is_named():
    case = fp.Case(
        scheme="GPSE", beta=0.5, half_width=1e4, spacing=0.5, graded_scale=1.0, t_initial=1.0, t_final=2.0
    )  # fmt: skip
    with pytest.warns(AccuracyWarning, match="data between the particles"):
        compute(case, lambda x: green(x - 1.28e3, 1.0, 1.5))


def test_waves_that_nearly_vanish_are_wrong_by_what_is_left():
    case = case_of(scheme="FD", beta=0.7, half_width=40.0, spacing=0.222, t_final=4.0)
    with pytest.warns(AccuracyWarning, match="come out wrong by"):
        compute(case, lambda x: np.exp(-x * x / 16.0) * np.cos(2.0 * x))


def test_the_integral_must_not_grow_either():
    """DVM, open: a box has no tail, but the exterior continues it by one."""
    case = fp.Case(
        scheme="DVM", order=4, beta=0.3, half_width=21.0, spacing=0.21, overlap=1.66, exterior="open", dt=0.032,
        t_initial=0.0, t_final=0.032,
    )  # fmt: skip
    with pytest.warns(AccuracyWarning, match=r"integral of \|u\| has grown by the factor"):
        run = compute(case, lambda x: np.where(np.abs(x) < 2.0, 1.0, 0.0))
    assert run.estimates["growth"][0] == pytest.approx(1.5, abs=0.1)


def test_data_of_dvm_beyond_the_lattice_or_narrower_than_the_kernel_are_named():
    given = {
        "scheme": "DVM",
        "beta": 0.5,
        "half_width": 8.0,
        "dt": 0.05,
        "t_initial": 1.0,
        "t_final": 1.5,
    }
    with pytest.warns(AccuracyWarning, match="does not fit on"):
        compute(fp.Case(spacing=0.25, **given), lambda x: green(x - 8.0, 1.0, 1.5))
    with pytest.warns(AccuracyWarning, match="come out wrong by"):
        compute(fp.Case(spacing=0.25, overlap=8.0, **given), lambda x: green(x, 1.0, 1.5))


@pytest.mark.parametrize(
    "given",
    [
        {"half_width": 152.0, "spacing": 0.25, "dt": 999.0, "beta": 0.9, "t_final": 1000.0},
        {"half_width": 1e12, "spacing": 0.1, "graded_scale": 1.0, "graded_form": "exchange", "beta": 0.5,
         "t_final": 1e12},
    ],
)  # fmt: skip
def test_what_an_exchange_keeps_is_named(given):
    with pytest.warns(AccuracyWarning, match="each particle keeps"):
        compute(fp.Case(scheme="GPSE", t_initial=1.0, **given))


@pytest.mark.parametrize(("length", "size"), [(1e-30, 1e-300), (1e28, 1e270), (1e60, 1.0)])
def test_the_estimates_have_no_units(length, size):
    def found(length, size):
        time = length**1.5
        case = case_of(
            scheme="FD", half_width=10.0 * length, spacing=length, t_initial=0.5 * time, t_final=1.5 * time
        )  # fmt: skip
        u = 1.0 / (1.0 + (case.x / length) ** 2)
        return {
            name: value for name, (value, _) in estimates(case, size * u, 0.5 * size * u).items()
        }

    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        assert found(length, size) == pytest.approx(found(1.0, 1.0), rel=1e-6)


@pytest.mark.parametrize(("scheme", "open_"), [("KPSE", True), ("DPSE", False)])
def test_an_open_exterior_is_advised_where_there_is_one(scheme, open_):
    with pytest.warns(AccuracyWarning, match="does not fit") as said:
        compute(case_of(scheme=scheme, half_width=4.0, spacing=0.1, t_final=1.0), bump)
    (text,) = [str(one.message) for one in said if "does not fit" in str(one.message)]
    assert ("or exterior='open'" in text) == open_


def test_waves_of_the_spacing_are_seen():
    """sin(2 pi x / h) is zero at the particles and half-way between them."""
    case = case_of(half_width=10.0, spacing=0.1)
    u0 = np.exp(-(case.x**2))

    def hidden(x):
        return np.exp(-(x**2)) * (1.0 + np.sin(20.0 * np.pi * x))

    assert between_particles(case, u0, hidden) > 0.1
    assert between_particles(case, u0, lambda x: np.exp(-(x**2))) < 1e-4
