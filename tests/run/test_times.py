"""Several output times in one run: each is what a run to it gives, and all cost what the last does."""

from __future__ import annotations

import time
import warnings

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.command_line.cli import main
from fracparticles.errors import FracparticlesError, InvalidInput
from fracparticles.run.solver import compute
from fracparticles.time.chebyshev import exponential
from fracparticles.time.snapshots import exponential_snapshots
from fracstudy.run_blocks import RunBlock, expand

TIMES = (0.6, 0.75, 1.0, 1.5)
GIVEN = {"scheme": "KPSE", "beta": 0.5, "half_width": 20.0, "spacing": 0.2}
EXPONENTIAL = {"order": 4, "integrator": "exponential"}
WAYS = {
    "series": EXPONENTIAL,
    "open": {**EXPONENTIAL, "exterior": "open"},
    "steps as a series": {"dt": 0.001},
    "RK4 of FPSE": {"scheme": "FPSE", "dt": 0.01, "integrator": "rk4", "exterior": "open"},
    "stepping": {"dt": 0.01, "evaluation": "stepping"},
    "convolution": {**EXPONENTIAL, "exterior": "open", "evaluation": "convolution"},
    "GPSE": {"scheme": "GPSE", "dt": 0.05},
    "GPSE, other steps": {"scheme": "GPSE"},
    "GPSE in one step": {"scheme": "GPSE", "dt": 1.0, "spacing": 0.1},
    "GPSE by convolution": {"scheme": "GPSE", "dt": 1.0, "spacing": 0.1, "exterior": "open", "evaluation": "auto"},
    "graded": {"scheme": "GPSE", "graded_scale": 2.0},
    "DVM": {"scheme": "DVM", "dt": 0.01},
    "DVM, open": {"scheme": "DVM", "dt": 0.01, "exterior": "open"},
    "plane": {**EXPONENTIAL, "exterior": "open", "dim": 2, "half_width": 8.0, "spacing": 0.5},
    "profile of a plane": {**EXPONENTIAL, "dim": 2, "half_width": 8.0, "spacing": 0.5, "store": "profile"},
    "profile": {**EXPONENTIAL, "store": "profile"},
    "metrics": {**EXPONENTIAL, "store": "metrics"},
}  # fmt: skip
# What a run of an operator costs, all its outputs share.
SHARED = ("series", "open", "steps as a series", "RK4 of FPSE", "stepping", "GPSE", "DVM", "plane")


def quietly(case: fp.Case, *initial):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return fp.solve(case, *initial)


@pytest.mark.parametrize("way", WAYS)
def test_each_output_is_what_a_run_to_it_gives(way):
    given = {**GIVEN, **WAYS[way]}
    run = quietly(fp.Case(**given, times=TIMES))
    assert run.t.values.tolist() == list(TIMES)
    assert float(run.t_final) == TIMES[-1]
    for at in TIMES:
        alone, here = quietly(fp.Case(**given, t_final=at)), run.sel(t=at)
        for name in ("u", "u_axis", "u_diagonal"):
            assert (name in run) == (name in alone)
            if name in run:
                assert np.abs(here[name].values - alone[name].values).max() <= 1e-14
        assert float(here.mass) == pytest.approx(float(alone.mass_final), rel=1e-13)
        assert float(here.relative_l1_error) == pytest.approx(
            float(alone.relative_l1_error), rel=1e-9, abs=1e-13
        )
        if at == TIMES[-1]:
            assert float(run.mass_final) == pytest.approx(float(alone.mass_final), rel=1e-14)


@pytest.mark.parametrize("way", SHARED)
def test_ten_outputs_cost_a_fifth_more_than_one_at_most(way):
    given = {**GIVEN, **WAYS[way]}
    ten = compute(fp.Case(**given, times=np.linspace(0.6, 1.5, 10)))
    one = compute(fp.Case(**given, t_final=1.5))
    assert ten.operator_applications <= 1.2 * one.operator_applications
    assert ten.outputs.u.shape == (10, *one.u.shape)


def test_ten_outputs_take_little_more_time_than_one():
    """Side by side, in one process, the least of some repeats; 1.1 on a quiet machine."""
    given = {**GIVEN, **EXPONENTIAL, "half_width": 400.0, "spacing": 0.05, "exterior": "open"}
    cases = fp.Case(**given), fp.Case(**given, times=np.linspace(0.6, 1.5, 10))
    ready = [fp.prepare(case) for case in cases]
    u0 = np.exp(-(cases[0].x ** 2))
    least = [np.inf, np.inf]
    for _ in range(7):
        for k, one in enumerate(ready):
            start = time.perf_counter()
            one.solve(u0)
            least[k] = min(least[k], time.perf_counter() - start)
    assert least[1] <= 1.5 * least[0]


def test_steps_meet_the_outputs_in_a_march_and_in_a_series():
    given = {**GIVEN, "dt": 0.007}
    marched = quietly(fp.Case(**given, times=TIMES, evaluation="stepping"))
    summed = quietly(fp.Case(**given, times=TIMES))
    assert np.abs(marched.u.values - summed.u.values).max() <= 1e-14
    steps = [dt for dt, _ in fp.Case(**given, times=TIMES).legs]
    assert float(summed.dt) == max(steps) <= 0.007


def test_where_digits_would_be_lost_the_recurrence_is_cut():
    """At the ends of the interval the coefficients do not fall with the solution: so that halves are taken."""
    case = fp.Case(**{**GIVEN, **EXPONENTIAL, "spacing": 0.1}, t_final=200.5)
    ready = fp.prepare(case)
    times = np.linspace(10.0, 200.0, 5)
    low = -2.2 * case.setting.rate
    long = exponential_snapshots(ready.operator, times, low, 0.0)
    short = exponential_snapshots(
        ready.operator, times, low, 0.0, largest_degree=long.operator_applications // 2
    )
    u0 = np.exp(-(case.x**2))
    assert short.operator_applications > long.operator_applications
    assert np.abs(long.run(u0)[0] - short.run(u0)[0]).max() < 1e-13
    assert np.array_equal(short(u0), short.run(u0)[0])


def test_a_part_starts_where_the_last_one_has_come_to():
    """Ten outputs in parts of several: each part from the last output of the one before."""
    case = fp.Case(**{**GIVEN, **EXPONENTIAL, "spacing": 0.1}, t_final=200.5)
    ready = fp.prepare(case)
    times = np.linspace(20.0, 200.0, 10)
    low = -2.2 * case.setting.rate
    long = exponential_snapshots(ready.operator, times, low, 0.0)
    most = int(0.8 * long.operator_applications)
    short = exponential_snapshots(ready.operator, times, low, 0.0, largest_degree=most)
    u0 = np.exp(-(case.x**2))
    assert np.abs(long(u0) - short(u0)).max() < 1e-13


class Decay:
    """One mode that decays by many decades."""

    size, rate = 1, -5.0

    def combine(self, u, out, scale, shift=0.0, keep=0.0):
        out[:] = (scale * self.rate + shift) * u + keep * out

    def apply(self, u):
        return self.rate * u


def test_terms_far_larger_than_their_sum_are_noticed_and_the_outputs_halved():
    times = np.arange(1.0, 9.0)
    run = exponential_snapshots(Decay(), times, -2000.0, 0.0)
    u, applications = run.run(np.ones(1))
    assert u[:, 0] == pytest.approx(np.exp(-5.0 * times), rel=1e-9)
    assert applications > run.operator_applications == exponential(8.0, -2000.0, 0.0).degree


# --- how times are said ---------------------------------------------------------------------------


def case(**changes) -> fp.Case:
    return fp.Case(**{**GIVEN, **EXPONENTIAL, **changes})


def test_the_last_of_the_times_is_the_final_one():
    assert case(times=[0.6, 1, 2]).t_final == 2.0
    assert case(times=[0.6, 1, 2]) == case(times=(0.6, 1.0, 2.0), t_final=2.0)
    assert case(times=np.array([0.6, 1.0, 2.0])).path == case(times=[0.6, 1.0, 2.0]).path
    assert fp.Case.from_json(case(times=[0.6, 2.0]).to_json()) == case(times=[0.6, 2.0])


@pytest.mark.parametrize(
    ("changes", "field", "words"),
    [
        ({"times": [0.6, 1.0], "t_final": 2.0}, "t_final", "nothing or 1 with these times"),
        ({"times": [1.0, 0.6]}, "times", "ascending"),
        ({"times": [1.0, 1.0]}, "times", "ascending"),
        ({"times": []}, "times", "a list"),
        ({"times": 1.0}, "times", "a list"),
        ({"times": "0.6,1"}, "times", "a list"),
        ({"times": ["0.6"]}, "times", "a list"),
        ({"times": [True]}, "times", "a list"),
        ({"times": [np.nan, 1.0]}, "times", "ascending"),
        ({"times": [1.0, np.inf]}, "t_final", "a number between"),
        ({"times": [0.5, 1.0]}, "times", "numbers > t_initial = 0.5"),
        ({"times": np.ones((2, 2))}, "times", "a list"),
    ],
    ids=str,
)
def test_times_that_are_refused(changes, field, words):
    with pytest.raises(InvalidInput, match=words) as refused:
        case(**changes)
    assert refused.value.field == field


def test_a_step_of_gpse_too_short_for_the_spacing_is_refused_before_any_work():
    with pytest.raises(InvalidInput, match="epsilon / h"):
        fp.Case(scheme="GPSE", beta=0.5, half_width=20.0, spacing=0.5, dt=1.0, times=[0.501, 1.5])


def test_equal_cases_have_equal_paths_and_only_they():
    several = [
        case(), case(times=[1.5]), case(times=[1.0, 1.5]), case(times=[1.0000000001, 1.5]),
        case(t_final=1.0), case(times=[0.6, 1.0, 1.5]), case(times=np.linspace(0.51, 1.5, 99)),
        case(times=np.linspace(0.52, 1.5, 99)),
    ]  # fmt: skip
    assert len({one.path for one in several}) == len(several)
    assert case(times=[0.6, 1.5]).path.endswith("t0.5-1.5_at0.6,1.5_truncated_field.nc")


def test_in_a_run_block_the_list_is_taken_whole():
    block = {**GIVEN, **EXPONENTIAL, "spacing": [0.2, 0.1], "times": [0.6, 1, 1.5]}
    for one in (block, RunBlock(**block)):
        assert [c.times for c in expand([one])] == [(0.6, 1.0, 1.5)] * 2


# --- files ----------------------------------------------------------------------------------------


def test_the_flag_the_file_and_its_summary(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    flags = (
        "--scheme KPSE --order 4 --beta 0.5 --half-width 20 --spacing 0.2 --integrator exponential"
    )
    assert main(["solve", *flags.split(), "--times", "0.6,1,1.5", "-o", "run.nc"]) == 0
    written = fp.read_run("run.nc")
    assert written.identical(fp.solve(case(times=[0.6, 1.0, 1.5])))
    assert written.u.dims == ("t", "x")
    assert fp.Case.from_json(written.attrs["case"]) == case(times=[0.6, 1.0, 1.5])
    capsys.readouterr()
    assert main(["show", "run.nc"]) == 0
    shown = capsys.readouterr().out
    assert "  t " in shown
    assert "0.6 1 1.5" in shown
    assert main(["solve", *flags.split(), "--times", "0.6;1", "-o", "no.nc"]) == 2
    assert "times = " in capsys.readouterr().err


@pytest.mark.parametrize(
    "way", [{"dt": 0.01, "evaluation": "stepping"}, {"dt": 0.007, "evaluation": "stepping"}]
)
def test_a_march_that_goes_on_from_its_own_file_gives_the_same_bits(way, tmp_path):
    given = {**GIVEN, **way}
    whole = quietly(fp.Case(**given, times=TIMES))
    fp.write(quietly(fp.Case(**given, times=TIMES[:2])), tmp_path / "first.nc")
    rest = quietly(
        fp.Case(**given, t_initial=TIMES[1], times=TIMES[2:], initial=str(tmp_path / "first.nc"))
    )
    assert np.array_equal(rest.u.values, whole.u.values[2:])


def test_a_series_that_goes_on_gives_them_to_round_off():
    """It starts its recurrence anew: another order of the same sum."""
    whole = quietly(case(times=TIMES))
    rest = quietly(case(t_initial=TIMES[1], times=TIMES[2:]), quietly(case(times=TIMES[:2])))
    assert np.abs(rest.u.values - whole.u.values[2:]).max() < 1e-15
    assert np.array_equal(
        rest.u.values, quietly(case(t_initial=TIMES[1], times=TIMES[2:]), whole).u.values
    )


def test_data_of_several_times_are_taken_at_theirs():
    whole = quietly(case(times=TIMES))
    assert fp.solve(case(t_initial=1.0, t_final=2.0), whole).mass_initial == whole.mass[2]
    assert (
        fp.solve(case(t_initial=1.0, t_final=2.0), whole.sel(t=1.0)).mass_initial == whole.mass[2]
    )
    with pytest.raises(
        InvalidInput, match=r"at t_initial = 0\.9, and these are at 0\.6, 0\.75, 1 or 1\.5"
    ):
        fp.solve(case(t_initial=0.9, t_final=2.0), whole)
    with pytest.raises(InvalidInput, match="t_initial"):
        fp.solve(case(t_initial=0.9, t_final=2.0), whole.sel(t=1.0))


def test_a_prepared_case_gives_every_output():
    ready = fp.prepare(case(times=TIMES))
    u0 = np.exp(-(ready.case.x**2))
    assert ready.solve(u0).shape == (4, *ready.case.shape)
    with pytest.raises(FracparticlesError, match="each output time has its own"):
        ready.as_matrix()


def test_a_run_that_blows_up_says_so_with_several_outputs():
    unstable = fp.Case(**{**GIVEN, "dt": 0.25, "spacing": 0.1}, times=np.arange(1, 400) * 1.0)
    with pytest.raises(fp.NonFiniteSolution):
        quietly(unstable)
