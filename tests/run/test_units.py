"""Names of units: into the data set, from one run to the next, and onto the axes of plots."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

import fracparticles as fp
from fracparticles.command_line.cli import main
from fracparticles.errors import InvalidInput

mpl.use("Agg")
GIVEN = {
    "scheme": "KPSE",
    "order": 4,
    "beta": 0.5,
    "half_width": 20.0,
    "spacing": 0.2,
    "integrator": "exponential",
}
METRES = fp.Units(length="m", time="d", concentration="mg/L")


def solved(*data, units=None, **changes):
    return fp.solve(fp.Case(**{**GIVEN, **changes}), *data, units=units)


def test_every_variable_that_has_a_dimension_is_in_its_unit():
    run = solved(units=METRES, times=[0.75, 1.5], diffusivity=0.3, t_initial=0.5)
    found = {name: run[name].attrs["units"] for name in run.variables if "units" in run[name].attrs}
    expected = {
        "x": "m",
        "half_width": "m",
        "t": "d",
        "t_initial": "d",
        "u": "mg/L",
        "mass": "mg/L m",
    }
    assert (
        found.items()
        >= {**expected, "mass_final": "mg/L m", "diffusivity": "m^1.5 d^-1", "beta": "1"}.items()
    )
    square = solved(units=METRES, dim=2, half_width=8.0, spacing=0.5)
    assert square.mass_final.attrs["units"] == "mg/L m^2"
    assert square.y.attrs["units"] == "m"


def test_those_of_a_problem():
    def units(initial, **given):
        problem = fp.Problem(t_final=0.1, **given)
        run = fp.solve_problem(problem, initial, estimate=False, units=METRES)
        return {name: one.attrs.get("units") for name, one in run.variables.items()}

    line = units(lambda x: np.exp(-x * x), alpha=1.5, half_width=20.0, spacing=0.5, source="-u")
    expected = {"x": "m", "u": "mg/L", "mass": "mg/L m", "diffusivity": "m^1.5 d^-1"}
    assert line.items() >= {**expected, "t_final": "d", "beta": "1"}.items()
    disc = units(
        lambda x, y: 1.0 - x * x - y * y,
        alpha=1.5, half_width=1.0, exterior="absorbing", domain="disc", particles=12,
    )  # fmt: skip
    assert disc.items() >= {"x": "m", "volume": "m^2", "mass_final": "mg/L m^2"}.items()
    varied = units(
        lambda x: np.exp(-x * x),
        beta="0.5 + 0.1*tanh(x)", form="DD", half_width=20.0, spacing=0.5,
    )  # fmt: skip
    assert varied["diffusivity"] is None  # in length^alpha(x) / time
    assert varied["u"] == "mg/L"


def test_without_them_nothing_changes():
    run = solved()
    assert {v.attrs["units"] for v in run.variables.values() if "units" in v.attrs} == {"1"}
    named = solved(units=METRES)
    assert np.array_equal(named.u, run.u)
    assert solved(units=fp.Units()).identical(run)


def test_of_particles_too():
    case = fp.Case(scheme="DVM", beta=0.5, half_width=10.0, spacing=0.2, dt=0.02)
    run = fp.solve(case, units=METRES)
    assert run.particle_position.attrs["units"] == "m"
    assert run.particle_strength.attrs["units"] == "mg/L m"


def test_they_stand_on_the_axes():
    run = solved(units=METRES)
    (line,) = run.u.plot()
    assert line.axes.get_xlabel() == "particle position [m]"
    assert "[mg/L]" in line.axes.get_ylabel()
    line.axes.figure.clear()


def test_they_go_on_from_run_to_run(tmp_path):
    first = solved(units=METRES, t_final=1.0, t_initial=0.5)
    fp.write(first, tmp_path / "first.nc")
    for data in (first, tmp_path / "first.nc"):
        assert solved(data, t_initial=1.0).x.attrs["units"] == "m"
        assert solved(data, t_initial=1.0).t_final.attrs["units"] == "d"
    with pytest.raises(InvalidInput, match="the length of the data, 'm'"):
        solved(first, t_initial=1.0, units=fp.Units(length="km", time="d", concentration="mg/L"))


def test_those_of_measured_data(tmp_path):
    x = np.linspace(-8.0, 8.0, 60)
    lines = [f"{a!r},{b!r}" for a, b in zip(x.tolist(), np.exp(-x * x).tolist(), strict=True)]
    (tmp_path / "p.csv").write_text("x [m],c [mg/L]\n" + "\n".join(lines))
    run = solved(tmp_path / "p.csv", t_initial=0.0)
    assert (run.x.attrs["units"], run.u.attrs["units"], run.t_final.attrs["units"]) == (
        "m",
        "mg/L",
        "1",
    )
    run = solved(tmp_path / "p.csv", t_initial=0.0, units=METRES)
    assert run.t_final.attrs["units"] == "d"


def test_the_command_line(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    flags = [f"--{name.replace('_', '-')}={value}" for name, value in GIVEN.items()]
    assert main(["solve", *flags, "--units", "m,d,mg/L", "-o", "run.nc"]) == 0
    assert xr.open_dataset("run.nc", decode_times=False).x.attrs["units"] == "m"
    assert fp.read_run("run.nc").identical(solved(units=METRES))
    assert main(["solve", *flags, "--units", "m,d", "-o", "run.nc"]) == 2
    assert "three names" in capsys.readouterr().err


@pytest.mark.parametrize("bad", ["", " ", "a\nb", 3, None, "m" * 50])
def test_what_is_refused(bad):
    with pytest.raises(InvalidInput, match="the name of a unit"):
        fp.Units(length=bad)
    with pytest.raises(InvalidInput, match="Units"):
        solved(units="m")
