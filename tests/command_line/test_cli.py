"""The command line: results on standard output, one line for everything else, exit statuses."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fracparticles as fp
from fracparticles.command_line.cli import main
from fracparticles.command_line.commands import number_or_text
from fracparticles.run.case import Case
from sweeps import covering, few


def words_of(text: str) -> list[str]:
    return text.split()


SMALL = words_of("--scheme KPSE --order 4 --beta 0.5 --half-width 10 --spacing 0.25")
CASE = Case(scheme="KPSE", order=4, beta=0.5, half_width=10.0, spacing=0.25, dt=0.05)
PROGRAM = [
    sys.executable,
    "-c",
    "import sys; from fracparticles.command_line.cli import main; sys.exit(main())",
]


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Return a function that runs the command line and gives status, output, messages."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        status = main([str(a) for a in arguments])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return run


def refused(result, *words, status=2):
    """Assert one line of error and nothing else."""
    code, out, err = result
    assert code == status
    assert out == ""
    assert err.startswith("error: ")
    assert err.count("\n") == 1
    for word in words:
        assert word in err
    return True


# --- solve ----------------------------------------------------------------------------------------


def test_solve_prints_the_path_and_writes_the_run(cli, tmp_path):
    assert cli("solve", *SMALL, "--dt", 0.05, "-o", "run.nc") == (0, "run.nc\n", "")
    assert fp.read_run("run.nc").identical(fp.solve(CASE))
    assert [p.name for p in tmp_path.iterdir()] == ["run.nc"]


def test_time_step_is_another_name_for_dt(cli):
    cli("solve", *SMALL, "--dt", 0.05, "-o", "a.nc")
    cli("solve", *SMALL, "--time-step=0.05", "--output", "b.nc")
    with open("a.nc", "rb") as a, open("b.nc", "rb") as b:
        assert a.read() == b.read()


def test_there_is_a_flag_for_every_field(cli):
    status, out, err = cli("solve", "--help")
    assert (status, err) == (0, "")
    for name in Case.model_fields:
        assert f"--{name.replace('_', '-')} " in out
    assert "--time-step" in out


def test_every_flag_reaches_the_case(cli):
    everything = {
        "scheme": "FPSE",
        "order": 4,
        "kernel_family": "gamma",
        "beta": 0.25,
        "dim": 1,
        "truncation": 6.0,
        "spacing": 0.5,
        "overlap": 2.5,
        "dt": 0.01,
        "diffusivity": 1.5,
        "t_initial": 0.25,
        "t_final": 1.25,
        "initial": "fundamental",
        "integrator": "rk4",
        "evaluation": "stepping",
        "summation": "naive",
        "exterior": "open",
        "far_terms": 2,
        "kernel_table": 0.01,
        "store": "profile",
    }
    of_others = {"times", "half_width", "graded_scale", "graded_form"}
    of_others |= {"remeshing", "remesh_above", "threshold"}
    assert {*everything, *of_others} == set(Case.model_fields)
    flags = [f"--{name.replace('_', '-')}={value}" for name, value in everything.items()]
    assert cli("solve", *flags, "-o", "run.nc")[0] == 0
    assert Case.from_json(fp.read_run("run.nc").attrs["case"]) == Case(**everything)


def test_graded_particles(cli):
    given = words_of("--scheme GPSE --beta 0.1 --half-width 1e9 --spacing 0.4 --graded-scale 2")
    assert cli("solve", *given, "--graded-form", "exchange", "-o", "a.nc")[0] == 0
    assert cli("solve", *given, "-o", "b.nc") == (0, "b.nc\n", "")
    fields = {"scheme": "GPSE", "beta": 0.1, "half_width": 1e9, "spacing": 0.4, "graded_scale": 2.0}
    assert fp.read_run("b.nc").identical(fp.solve(Case(**fields)))
    assert fp.read_run("a.nc").graded_form.item() == "exchange"
    status, out, err = cli("show", "b.nc")
    assert (status, err) == (0, "")
    shown = dict(line.split(maxsplit=1) for line in out.splitlines()[1:])
    assert shown["graded_form"].startswith("interpolated ")
    assert refused(cli("solve", *given, "--dt", 1, "-o", "c.nc"), "dt = 1", "graded particles")


def test_a_restart(cli):
    half = [*SMALL, "--integrator", "exponential"]
    cli("solve", *half, "--t-final", 1.0, "-o", "a.nc")
    restart = ("--t-initial", 1.0, "--initial", "a.nc")
    assert cli("solve", *half, *restart, "-o", "b.nc") == (0, "b.nc\n", "")
    cli("solve", *half, "-o", "c.nc")
    whole = fp.read_run("c.nc").u.values
    assert np.abs(fp.read_run("b.nc").u.values - whole).max() <= 1e-13 * np.abs(whole).max()


def test_each_warning_of_an_unstable_step_is_one_line(cli):
    status, out, err = cli("solve", *SMALL, "--dt", 0.5, "-o", "run.nc")
    assert (status, out) == (0, "run.nc\n")
    unstable, inaccurate = err.splitlines()
    assert unstable.startswith("warning: dt = 0.5 lies outside the stability interval")
    assert inaccurate.startswith("warning: the waves that the initial data hold come out wrong")


def test_a_blow_up_is_one_line_and_leaves_no_file(cli, tmp_path):
    flags = (*SMALL, "--integrator", "euler", "--dt", 1.0, "--t-final", 2000.5, "-o", "run.nc")
    code, out, err = cli("solve", *flags)
    warning, error = err.splitlines()
    assert (code, out) == (3, "")
    assert warning.startswith("warning: dt = 1 lies")
    assert error.startswith("error: KPSE (order 4): euler with dt = 1")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        ("--scheme kpse", ("scheme = 'kpse'", "Did you mean 'KPSE'?")),
        ("--order 3", ("order = 3", "one of 2, 4")),
        ("--beta 1.5", ("beta = 1.5", "a number between 0 and 1 (exclusive)")),
        ("--beta abc", ("beta = 'abc'", "a number between 0 and 1 (exclusive)")),
        ("--beta nan", ("beta = nan", "a number between 0 and 1 (exclusive)")),
        ("--beta True", ("beta = 'True'",)),
        ("--half-width -3", ("half_width = -3", "a number between")),
        ("--spacing 0", ("spacing = 0",)),
        ("--spacing 1e-10", ("spacing = 1e-10", "GiB", "Take a larger spacing")),
        ("--t-final 0.2", ("t_final = 0.2", "t_initial = 0.5")),
        ("--dt -0.1", ("dt = -0.1",)),
        ("--store all", ("store = 'all'",)),
        ("--initial none.nc", ("none.nc", "an existing file")),
        ("--bta 0.5", ("--bta", "Did you mean --beta?")),
        ("--dtt 3", ("--dtt",)),
        ("--dt", ("--dt", "requires an argument")),
        ("stray", ("stray",)),
    ],
)
def test_bad_flags(cli, tmp_path, flags, words):
    given = [*SMALL, "--dt", "0.05", "-o", "run.nc"]
    name, *_ = flags.split()
    if name in given:
        at = given.index(name)
        del given[at : at + 2]
    assert refused(cli("solve", *given, *flags.split()), *words)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("flags", ["--beta 0.5 --beta 0.6", "--dt 0.1 --time-step 0.1"])
def test_a_flag_given_twice(cli, flags):
    given = words_of("--scheme KPSE --half-width 10 --spacing 0.25 -o run.nc")
    assert refused(cli("solve", *given, *flags.split()), "multiple times")


def test_missing_flags(cli):
    assert refused(cli("solve", "-o", "run.nc"), "scheme is missing", "Give scheme.")
    assert refused(cli("solve", *SMALL, "--dt", 0.1), "output is missing", "Give -o run.nc.")
    assert refused(cli("solve", *SMALL, "-o", "run.nc"), "dt is missing", "stable up to 0.1936")


def test_outputs_that_cannot_be_written_are_refused_before_any_work(cli, tmp_path, monkeypatch):
    monkeypatch.setattr("fracparticles.run.solve.compute", lambda *_: pytest.fail("work was done"))
    given = (*SMALL, "--dt", 0.05, "-o")
    assert refused(cli("solve", *given, "none/run.nc"), "none/run.nc", "a directory that exists")
    assert refused(cli("solve", *given, tmp_path), "this is a directory")
    assert refused(cli("solve", *given, "run.csv"), "output = 'run.csv'", "Name it run.nc.")
    os.mkfifo("pipe")
    os.symlink("/dev/null", "null")
    os.symlink("none.nc", "dangling")
    for path in ("/dev/null", "/dev/full", "pipe", "null"):
        assert refused(cli("solve", *given, path), "output", "a device, a pipe or a socket")
    assert refused(cli("solve", *given, "dangling"), "output", "does not exist")
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert refused(cli("solve", *given, "run.nc"), "a directory that can be written")


def test_an_output_that_is_a_link_is_written_through(cli, tmp_path):
    (tmp_path / "run.nc").write_text("old")
    (tmp_path / "link").symlink_to("run.nc")
    assert cli("solve", *SMALL, "--dt", 0.05, "-o", "link") == (0, "link\n", "")
    assert (tmp_path / "link").is_symlink()
    assert fp.read_run("run.nc").identical(fp.solve(CASE))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ("--beta 0.3 --t-initial 1", ("beta = 0.3", "beta = 0.5")),
        ("--diffusivity 5 --t-initial 1", ("diffusivity = 5", "diffusivity = 1")),
        ("--t-initial 0.75", ("t_initial = 0.75", "t_final = 1")),
        ("", ("t_initial = 0.5", "t_final = 1", "Set t_initial = 1")),
    ],
)
def test_a_restart_that_does_not_go_on(cli, changes, words):
    given = words_of("--scheme KPSE --half-width 10 --spacing 0.25 --integrator exponential")
    cli("solve", *given, "--beta", 0.5, "--t-final", 1.0, "-o", "a.nc")
    if "--beta" not in changes:
        given += ["--beta", "0.5"]
    result = cli("solve", *given, *changes.split(), "--initial", "a.nc", "-o", "b.nc")
    assert refused(result, "a.nc", *words)
    assert not os.path.exists("b.nc")


def test_a_file_without_a_time_is_one_line_of_warning(cli):
    u = xr.DataArray(np.exp(-(CASE.x**2)), {"x": CASE.x[::-1]}, "x", name="u")
    u.to_netcdf("u.nc")
    status, out, err = cli("solve", *SMALL, "--dt", 0.05, "--initial", "u.nc", "-o", "run.nc")
    assert (status, out) == (0, "run.nc\n")
    assert err.startswith("warning: the initial data are your own and t_initial was not given")
    assert err.count("\n") == 1
    given = (*SMALL, "--dt", 0.05, "--initial", "u.nc", "--t-initial", 0.5)
    assert cli("solve", *given, "-o", "run.nc") == (0, "run.nc\n", "")


def test_a_stored_case_whose_data_came_with_the_call(cli):
    marker = fp.solve(CASE, np.exp(-(CASE.x**2))).attrs["case"].split('"initial": "')[1][:30]
    assert marker.startswith("given, sha256 ")
    result = cli("solve", *SMALL, "--dt", 0.05, "--initial", marker, "-o", "run.nc")
    assert refused(result, marker, "Pass the data again")


def test_damaged_initial_data(cli, tmp_path):
    (tmp_path / "bad.nc").write_bytes(b"CDF\x01 and no more")
    given = (*SMALL, "--dt", 0.05, "--initial", "bad.nc", "-o", "run.nc")
    assert refused(cli("solve", *given), "bad.nc", "a readable NetCDF file")


# --- show -----------------------------------------------------------------------------------------


def test_show(cli):
    cli("solve", *SMALL, "--dt", 0.05, "-o", "run.nc")
    status, out, err = cli("show", "run.nc")
    assert (status, err) == (0, "")
    lines = dict(line.split(maxsplit=1) for line in out.splitlines()[1:])
    assert lines["scheme"].startswith("KPSE ")
    assert lines["beta"].startswith("0.5 ")
    run = fp.read_run("run.nc")
    for name in ("relative_l1_error", "mass_initial", "mass_final", "operator_applications"):
        assert float(lines[name].split()[0]) == pytest.approx(run[name].item(), rel=1e-8)
    assert lines["u"].startswith("81 values, x = -10 .. 10")


def test_show_a_run_without_a_field(cli):
    cli("solve", *SMALL, "--dt", 0.05, "--store", "metrics", "-o", "run.nc")
    status, out, _ = cli("show", "run.nc")
    assert status == 0
    assert "relative_l1_error" in out
    assert "\n  u " not in out


def test_show_what_is_not_a_run(cli, tmp_path):
    (tmp_path / "text.nc").write_text("no")
    assert refused(cli("show", "none.nc"), "none.nc", "an existing file")
    assert refused(cli("show", "text.nc"), "a readable NetCDF file")
    assert refused(cli("show"), "requires an argument")


# --- plot and compare -----------------------------------------------------------------------------


SERIES = (*SMALL, "--integrator", "exponential")


@pytest.mark.parametrize(
    ("flags", "name"),
    covering(
        ["--times 0.7,1", "--dim 2", "--dim 2 --times 0.7,1", "--dim 3"], ["run.png", "run.SVG"]
    ),
)
def test_plot(cli, tmp_path, flags, name):
    spacing = ("--spacing", 1.0)
    given = [word for word in SERIES if word not in ("--spacing", "0.25")]
    cli("solve", *given, *spacing, *flags.split(), "-o", "run.nc")
    assert cli("plot", "run.nc", "-o", name, "--log") == (0, f"{name}\n", "")
    start = (tmp_path / name).read_bytes()[:200]
    assert start.startswith(b"\x89PNG") or b"<?xml" in start
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(["run.nc", name])


def test_what_a_plot_shows(cli):
    from fracparticles.command_line.picture import draw

    run = fp.solve(CASE.until(0.7, 2.0), units=fp.Units("m", "d", "mg/L"))
    (axes,) = draw(run).axes
    lines = {line.get_label(): line.get_ydata() for line in axes.lines}
    assert np.array_equal(lines["t = 0.7"], run.u[0])
    assert np.array_equal(lines["t = 2"], run.u[1])
    exact = next(line.get_ydata() for line in axes.lines if line.get_linestyle() == "--")
    assert exact == pytest.approx(fp.green(run.x.values, 0.7, 1.5))
    assert "[m]" in axes.get_xlabel()
    assert "[mg/L]" in axes.get_ylabel()


@pytest.mark.parametrize("dim", [1, 2])
def test_a_solved_problem_is_shown_and_plotted_as_a_run_is(cli, dim):
    drift = ("1", "0")[:dim]
    fields = {"half_width": 10.0, "spacing": 0.5, "t_initial": 0.5, "t_final": 1.0}
    problem = fp.Problem(alpha=1.5, dim=dim, velocity=drift, form="DD", **fields)
    fp.write(fp.solve_problem(problem), "problem.nc")
    assert cli("plot", "problem.nc") == (0, "problem.png\n", "")
    assert cli("show", "problem.nc")[0] == 0
    assert "no difference" in cli("compare", "problem.nc", "problem.nc")[1]


def test_what_cannot_be_plotted(cli):
    cli("solve", *SERIES, "--store", "metrics", "-o", "run.nc")
    assert refused(cli("plot", "run.nc"), "holds its strengths", "--store field")
    assert refused(cli("plot", "run.nc", "-o", "run.gif"), "run.gif", ".png, .svg or .pdf")
    assert refused(cli("plot", "none.nc"), "an existing file")


def test_a_plot_says_that_it_needs_matplotlib(cli, monkeypatch):
    monkeypatch.setattr("fracparticles.command_line.picture.find_spec", lambda name: None)
    cli("solve", *SERIES, "-o", "run.nc")
    assert refused(cli("plot", "run.nc"), "pip install matplotlib", status=1)


def test_compare(cli):
    cli("solve", *SERIES, "--times", "0.7,1,2", "-o", "a.nc")
    half = [word if word != "0.25" else "0.125" for word in SERIES]
    cli("solve", *half, "--t-final", 2.0, "-o", "b.nc")
    status, out, err = cli("compare", "a.nc", "b.nc")
    assert (status, err) == (0, "")
    head, *rows, last = out.splitlines()
    assert head.split() == ["a.nc", "b.nc"]
    assert {"spacing", "particle_spacing"} <= {row.split()[0] for row in rows}
    assert not {"order", "beta", "scheme"} & {row.split()[0] for row in rows}
    u, v = fp.read_run("a.nc").u[2].values, fp.read_run("b.nc").u.values[::2]
    apart = np.abs(u - v).sum() / np.abs(u).sum()
    assert f"81 shared values of 243 and 161 sum |u - v| / sum |u| = {apart:.3g}" in last


def test_compare_what_is_the_same_and_what_cannot_be(cli):
    cli("solve", *SERIES, "-o", "a.nc")
    cli("solve", *SERIES, "--store", "metrics", "-o", "metrics.nc")
    cli("solve", *SERIES, "--t-final", 2.0, "-o", "later.nc")
    cli("solve", *SERIES, "--dim", 2, "-o", "plane.nc")
    out = cli("compare", "a.nc", "a.nc")[1]
    assert "no difference in parameters and results" in out
    assert "at 81 shared values of 81 and 81 no difference" in out
    assert "--store field" in cli("compare", "a.nc", "metrics.nc")[1]
    assert "share no time and place" in cli("compare", "a.nc", "later.nc")[1]
    assert "not on the same axes, t, x and t, x, y" in cli("compare", "a.nc", "plane.nc")[1]
    assert refused(cli("compare", "a.nc", "none.nc"), "none.nc", "an existing file")


def test_compare_does_not_take_metres_for_millimetres(cli):
    """The numbers are the same, and what they mean is not."""
    for unit in ("m", "mm", None):
        named = () if unit is None else ("--units", f"{unit},d,mg/L")
        cli("solve", *SERIES, *named, "-o", f"{unit}.nc")
    _, row, last = cli("compare", "m.nc", "mm.nc")[1].splitlines()
    assert row.split() == ["unit", "of", "length", "m", "mm"]
    assert last == "u: not in the same units, length is in m and in mm"
    *rows, last = cli("compare", "m.nc", "None.nc")[1].splitlines()
    assert ["unit", "of", "u", "mg/L", "1"] in [row.split() for row in rows]
    assert last.endswith("no difference")


def test_compare_names_the_coefficients_and_the_data(cli):
    """Runs of other velocities have the same scalars; those of mirrored data the same results."""
    fields = {"alpha": 1.5, "half_width": 10.0, "spacing": 0.5, "t_initial": 0.5, "t_final": 1.0}
    for name, velocity in (("left", "-1"), ("right", "1"), ("own", lambda x: -1.0 + 0.0 * x)):
        fp.write(fp.solve_problem(fp.Problem(velocity=velocity, **fields)), f"{name}.nc")
    out = cli("compare", "left.nc", "right.nc")[1]
    assert ["velocity", "-1", "1"] in [row.split() for row in out.splitlines()]
    assert "no difference" not in out
    assert "whether they differ is not known" in cli("compare", "own.nc", "own.nc")[1]
    u0 = np.exp(-((CASE.x - 1.0) ** 2))
    fp.write(fp.solve(CASE, u0), "one.nc")
    fp.write(fp.solve(CASE, u0[::-1]), "other.nc")
    names = [row.split()[0] for row in cli("compare", "one.nc", "other.nc")[1].splitlines()[1:-1]]
    assert "initial_data" in names


def test_compare_on_domains(cli):
    """Graded particles of an interval, and rings, which have no lattice."""
    given = {"alpha": 1.5, "exterior": "absorbing", "t_final": 0.1}

    def hat(*place):
        return np.maximum(1.0 - sum(x**2 for x in place), 0.0)

    for name, more in {
        "one": {"half_width": 1.0},
        "late": {"half_width": 1.0, "times": [0.05, 0.1]},
        "disc": {"half_width": 1.0, "domain": "disc"},
        "wide": {"half_width": 2.0, "domain": "disc"},
    }.items():
        fp.write(fp.solve_problem(fp.Problem(**given, **more), hat, estimate=False), f"{name}.nc")

    def last(one, other):
        return cli("compare", f"{one}.nc", f"{other}.nc")[1].splitlines()[-1]

    assert last("one", "one") == "u: at 200 shared values of 200 and 200 no difference"
    assert "at 200 shared values of 200 and 400" in last("one", "late")
    assert last("disc", "disc").endswith("no difference")
    assert last("disc", "wide") == "u: not on the same rings"


def test_compare_takes_times_to_round_off(cli):
    for name, time in (("one", 0.3), ("other", 0.1 + 0.2)):
        cli("solve", *SERIES, "--t-initial", 0.1, "--t-final", repr(time), "-o", f"{name}.nc")
    out = cli("compare", "one.nc", "other.nc")[1]
    assert "t_final" in out
    assert "0.3  " in out
    assert "0.30000000000000004" in out
    assert "at 81 shared values of 81 and 81" in out


@pytest.mark.parametrize(
    ("flag", "text"),
    [("--beta", "0_5"), ("--beta", "0.5_0"), ("--times", "1_0"), ("--spacing", "0_1")],
)
def test_a_number_has_no_underscore(cli, flag, text):
    """Python reads 0_5 as five and 1_0 as ten."""
    given = [*SERIES, flag, text]
    if flag in SERIES:
        given = list(SERIES)
        given[given.index(flag) + 1] = text
    assert refused(cli("solve", *given, "-o", "run.nc"), flag.removeprefix("--"), text)
    if flag == "--spacing":
        assert refused(cli("limit", "--scheme", "KPSE", "--beta", 0.5, flag, text), "spacing", text)


# --- what a terminal shows ------------------------------------------------------------------------


@pytest.mark.parametrize("flags", ["--dt 0.05", "--dt 0.05 --evaluation stepping"])
def test_progress_reaches_the_end_and_never_goes_back(flags):
    seen = []
    fields = {"dt": 0.05} | ({"evaluation": "stepping"} if "stepping" in flags else {})
    case = Case(**{**CASE.model_dump(exclude_none=True, exclude_unset=False), **fields})
    watched = fp.solve(case, progress=seen.append)
    assert watched.identical(fp.solve(case))
    assert seen == sorted(seen)
    assert len(seen) == watched.operator_applications
    assert seen[-1] == 1.0


def test_what_progress_is_told_to_must_be_a_function():
    with pytest.raises(fp.InvalidInput, match="progress = 'yes'"):
        fp.solve(CASE, progress="yes")


def test_progress_of_particles_that_move():
    seen = []
    case = Case(scheme="DVM", beta=0.5, half_width=10.0, spacing=0.5, dt=0.05)
    fp.solve(case, progress=seen.append)
    assert seen == pytest.approx(np.linspace(0.0, 1.0, len(seen)))


def test_a_line_of_progress_begins_late_and_goes(monkeypatch, capsys):
    from fracparticles.command_line import progress

    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setattr(progress, "_FIRST", 0.0)
    monkeypatch.setattr(progress, "_BETWEEN", 0.0)
    with progress.on_terminal("solving") as told:
        told(0.25)
        told(1.0)
    assert "solving" in capsys.readouterr().err
    monkeypatch.setattr(progress, "_FIRST", 60.0)
    with progress.on_terminal("solving") as told:
        told(0.25)
        told(1.0)
    assert capsys.readouterr().err == ""


def test_a_pipe_is_told_nothing():
    from fracparticles.command_line.progress import on_terminal

    with on_terminal("solving") as told:
        assert told is None


# --- limit ----------------------------------------------------------------------------------------


def test_limit(cli):
    assert cli("limit", "--scheme", "KPSE", "--beta", 0.5) == (0, "a = 2.17623\n", "")
    flags = "--scheme KPSE --beta 0.5 --order 4 --overlap 3 --spacing 0.1 --diffusivity 2"
    status, out, err = cli("limit", *words_of(flags))
    a = fp.stability_limit("KPSE", 0.5, 4, 3.0)
    assert (status, err) == (0, "")
    dt, largest = float(out.split()[-1]), a * 0.1**1.5 / 2.0
    assert out == f"a = {a:.6g}\ndt = {dt:.6g}\n"
    assert (1.0 - 1e-5) * largest < dt <= largest  # six digits, none of them rounded up
    square = fp.stability_limit("KPSE", 0.5, dim=2)
    assert cli("limit", *words_of("--scheme KPSE --beta 0.5 --dim 2"))[1] == f"a = {square:.6g}\n"
    assert err == ""
    high = fp.stability_limit("KPSE", 0.5, 8)
    flags = "--scheme KPSE --beta 0.5 --order 8 --kernel-family gamma"
    assert cli("limit", *words_of(flags))[1] == f"a = {high:.6g}\n"


def test_a_limit_says_what_it_does_not_bind(cli):
    """One step of GPSE, the whole run, is exp or less for every wave; steps repeated are stable to the limit."""
    flags = words_of("--scheme GPSE --beta 0.5 --spacing 0.1")
    status, out, err = cli("limit", *flags)
    a = fp.stability_limit("GPSE", 0.5)
    assert (status, out) == (0, f"a = {a:.6g}\ndt = {a * 0.1**1.5:.6g}\n")
    assert err.startswith("note: this limits repeated steps; a single step of GPSE")
    assert err.count("\n") == 1
    once = Case(scheme="GPSE", beta=0.5, half_width=10.0, spacing=0.1, dt=1.0)
    assert once.time_step > a * 0.1**1.5
    u = fp.solve(once, np.exp(-(once.x**2))).u.values
    assert np.abs(u).max() <= 1.0


@pytest.mark.parametrize("flags", ["--order 12 --overlap 1", "--order 8 --overlap 0.85"])
def test_a_limit_of_zero_says_that_no_step_is_stable(cli, flags):
    status, out, err = cli("limit", *words_of("--scheme KPSE --beta 0.9"), *flags.split())
    assert (status, out) == (0, "a = 0\n")
    assert (
        err == "note: no step is stable, some wave grows: take a larger overlap or a lower order\n"
    )


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        ("--scheme KPS --beta 0.5", ("scheme = 'KPS'", "one of DD", "Did you mean 'KPSE'?")),
        ("--scheme DVM --beta 0.5", ("scheme = 'DVM'", "its waves are DD's")),
        ("--scheme KPSE --beta 1", ("beta = 1", "between 0 and 1")),
        ("--scheme KPSE --beta x", ("beta = 'x'",)),
        ("--scheme KPSE --beta 0.5 --order 3", ("order = 3",)),
        ("--scheme KPSE --beta 0.5 --overlap 0", ("overlap = 0",)),
        ("--scheme FD --beta 0.5 --dim 2", ("dim = 2", "1 for FD")),
        ("--scheme KPSE --beta 0.5 --spacing 0", ("spacing = 0", "positive")),
        ("--scheme KPSE --beta 0.5 --spacing x", ("spacing = 'x'", "positive")),
        ("--scheme KPSE --beta 0.5 --diffusivity -1", ("diffusivity = -1", "positive")),
        ("--scheme FD --beta 0.5 --overlap 2", ("overlap", "nothing for FD")),
        ("--scheme KPSE", ("beta", "Give --beta, or --alpha")),
        ("--scheme KPSE --beta 0.5 --overlp 2", ("--overlp", "Did you mean --overlap?")),
    ],
)
def test_bad_limits(cli, flags, words):
    assert refused(cli("limit", *flags.split()), *words)


# --- the program ----------------------------------------------------------------------------------


def test_unknown_commands(cli):
    assert refused(cli("solv"), "solv", 'Did you mean "solve"?')


def test_what_belongs_to_no_option(cli):
    assert refused(cli("solve", "KPSE", "--beta", "0.5"), "'KPSE' belongs to no option")
    assert refused(cli("solve", "--times", "0.7", "1", "-o", "run.nc"), "lists as 1,2,3")


def test_python_runs_the_package_which_exits_with_the_status():
    """`python -m fracparticles` is the command."""
    command = [sys.executable, "-m", "fracparticles", "limit", "--scheme", "X", "--beta", "0.5"]
    done = subprocess.run(command, capture_output=True, check=False)
    assert done.returncode == 2
    assert done.stdout == b""
    assert done.stderr.startswith(b"error: scheme = 'X'")


def test_version_and_help(cli):
    assert cli("--version") == (0, f"{fp.__version__}\n", "")
    status, out, err = cli("--help")
    assert (status, err) == (0, "")
    for command in ("solve", "show", "plot", "compare", "limit", "scenes"):
        assert command in out


def test_the_list_of_scenes(cli, monkeypatch):
    assert refused(cli("scenes"), "config/study.yaml", "the folder of the study")
    monkeypatch.chdir(Path(__file__).parents[2])
    status, out, err = cli("scenes", "--document", "lucchesi")
    assert (status, err) == (0, "")
    (row,) = [line for line in out.splitlines() if line.split()[0] == "lucchesi_table_3"]
    assert "[L-T3, " in row
    assert "marker_square" not in out
    assert "marker_square" in cli("scenes")[1]
    assert "List the scenes" in cli("--help")[1]
    assert refused(cli("scenes", "luchesi"), "luchesi", "lucchesi")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_is_written_where_one_says(cli, tmp_path, shell):
    script = tmp_path / "script"
    status, out, _ = cli("--install-completion", "--shell", shell, "--output", script)
    assert status == 0
    assert str(script) in out
    assert "--half-width" in script.read_text()


def test_numbers_and_text():
    assert number_or_text("2") == 2
    assert isinstance(number_or_text("2"), int)
    assert number_or_text("1e-4") == 1e-4
    assert number_or_text("inf") == float("inf")
    assert number_or_text("2x") == "2x"


@pytest.mark.parametrize(
    ("error", "status", "line"),
    [
        (KeyboardInterrupt(), 130, "error: interrupted\n"),
        (OSError(28, "No space left on device"), 1, "error: [Errno 28] No space left on device\n"),
        (MemoryError(), 1, "error: MemoryError\n"),
        (fp.FracparticlesError("two\nlines"), 1, "error: two lines\n"),
    ],
)
def test_failures_in_one_line(cli, monkeypatch, error, status, line):
    def fail(*_):
        raise error

    monkeypatch.setattr("fracparticles.run.solve.compute", fail)
    assert cli("solve", *SMALL, "--dt", 0.05, "-o", "run.nc") == (status, "", line)


def test_a_reader_that_goes_away_is_no_error():
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [*PROGRAM, "limit", "--scheme", "KPSE", "--beta", "0.5"],
        stdout=write,
        stderr=subprocess.PIPE,
    )
    os.close(write)
    assert done.returncode == 141
    assert done.stderr == b""


@pytest.mark.parametrize("closed", few(["<&- >&- 2>&-", ">&-", "2>&-"], 1))
def test_streams_that_are_closed_spoil_no_file(tmp_path, closed):
    """The first file that is opened would take the place of the stream, and its text."""
    words = [*PROGRAM, "solve", *SMALL, "--dt", "0.5", "-o", str(tmp_path / "run.nc")]
    done = subprocess.run(["sh", "-c", f'"$@" {closed}', "sh", *words], capture_output=True)
    assert done.returncode == 0
    with pytest.warns(fp.StabilityWarning):
        run = fp.solve(Case(**{**CASE.model_dump(exclude_unset=True), "dt": 0.5}))
    assert fp.read_run(tmp_path / "run.nc").identical(run)
    assert b"Traceback" not in done.stdout + done.stderr


def test_a_name_that_cannot_be_printed(tmp_path, monkeypatch):
    """By a stream as `PYTHONIOENCODING=ascii:strict` makes it."""
    monkeypatch.chdir(tmp_path)
    printed = io.TextIOWrapper(io.BytesIO(), encoding="ascii", errors="strict")
    monkeypatch.setattr(sys, "stdout", printed)
    assert main(["solve", *SMALL, "--dt", "0.05", "-o", "ü.nc"]) == 0
    printed.flush()
    assert printed.buffer.getvalue() == b"\\xfc.nc\n"


def test_an_interrupt_while_it_starts(cli, monkeypatch):
    monkeypatch.delitem(sys.modules, "fracparticles.command_line.program")

    class Interrupting:
        def find_spec(self, name, *_):
            if name == "fracparticles.command_line.program":
                raise KeyboardInterrupt

    monkeypatch.setattr(sys, "meta_path", [Interrupting(), *sys.meta_path])
    assert cli("limit", "--scheme", "KPSE", "--beta", 0.5) == (130, "", "error: interrupted\n")
