"""One run, one file: conventions, identical bytes, atomic writing, reading, cubes of runs."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fracparticles as fp
from fracparticles.case import Case
from fracparticles.dataset import read_strengths
from fracparticles.errors import InvalidInput
from fracparticles.special import mean_radius

GIVEN = {
    "scheme": "KPSE",
    "order": 4,
    "beta": 0.5,
    "half_width": 10.0,
    "spacing": 0.25,
    "dt": 0.05,
}
PARAMETERS = {
    "scheme": "KPSE",
    "order": 4,
    "beta": 0.5,
    "half_width": 10.0,
    "spacing": 0.25,
    "particle_spacing": 0.25,
    "overlap": 2.0,
    "dt": 0.05,
    "diffusivity": 1.0,
    "t_initial": 0.5,
    "t_final": 1.5,
    "integrator": "rk2",
    "evaluation": "series",
    "summation": "fft",
    "exterior": "truncated",
    "dim": 1,
}


def case(**changes) -> Case:
    return Case(**{**GIVEN, **changes})


@pytest.fixture
def run_file(tmp_path) -> Path:
    path = tmp_path / "run.nc"
    fp.write(fp.solve(case()), path)
    return path


# --- what a run holds -----------------------------------------------------------------------------


def test_every_parameter_is_a_scalar_coordinate():
    run = fp.solve(case())
    for name, value in PARAMETERS.items():
        assert run.coords[name].ndim == 0
        assert run.coords[name].item() == pytest.approx(value) if name != "scheme" else value
    spread = 1.5 ** (1.0 / 1.5) * mean_radius(1.5)
    assert run.coords["truncation"].item() == pytest.approx(10.0 / spread)
    assert set(run.coords) == {*PARAMETERS, "truncation", "x"}


def test_variables_and_masses():
    run = fp.solve(case())
    assert set(run.data_vars) == {
        "u",
        "relative_l1_error",
        "mass_initial",
        "mass_final",
        "operator_applications",
    }
    assert run.u.dims == ("x",)
    assert run.mass_final.item() == pytest.approx(0.25 * run.u.values.sum(), rel=1e-15)
    assert run.mass_initial.item() == pytest.approx(run.mass_final.item(), rel=1e-13)
    assert "time" not in run.dims


def test_attributes_follow_the_conventions():
    run = fp.solve(case())
    assert run.attrs["Conventions"] == "CF-1.11, ACDD-1.3"
    for name in ("title", "summary", "keywords", "source", "history", "references"):
        assert run.attrs[name]
    assert Case.from_json(run.attrs["case"]) == case()
    assert json.loads(run.attrs["case"])["scheme"] == "KPSE"
    for name, variable in run.variables.items():
        assert variable.attrs["long_name"], name
        assert variable.attrs["units"] == "1", name


def test_own_initial_data_have_no_error_but_a_digest():
    run = fp.solve(case(), lambda x: np.exp(-x * x))
    assert "relative_l1_error" not in run
    assert run.attrs["initial_data"].startswith("callable, sha256 ")
    other = fp.solve(case(), lambda x: np.exp(-2.0 * x * x))
    assert other.attrs["initial_data"] != run.attrs["initial_data"]


def test_a_square():
    given = {**GIVEN, "half_width": 4.0, "spacing": 0.5, "dim": 2}
    field, profile = (fp.solve(Case(**given, store=store)) for store in ("field", "profile"))
    assert field.u.dims == ("x", "y")
    assert np.array_equal(field.y.values, field.x.values)
    assert np.array_equal(profile.u_axis.values, field.u.sel(y=0.0).values)
    assert np.array_equal(profile.u_diagonal.values, np.diagonal(field.u.values))
    assert field.mass_final.item() == pytest.approx(0.25 * field.u.values.sum(), rel=1e-14)
    assert "u" not in profile


def test_a_square_is_read_again(tmp_path):
    whole = Case(**{**GIVEN, "half_width": 4.0, "spacing": 0.5, "dim": 2, "dt": 0.05})
    first, path = whole.model_copy(update={"t_final": 1.0}), tmp_path / "half.nc"
    fp.write(fp.solve(first), path)
    second = fp.solve(whole.model_copy(update={"t_initial": 1.0}), path)
    assert np.abs(second.u.values - fp.solve(whole).u.values).max() <= 1e-14
    with pytest.raises(InvalidInput, match=r"u\(x\) and the coordinates x"):
        read_strengths(path, case())


def test_what_is_stored():
    field, profile, metrics = (fp.solve(case(store=s)) for s in ("field", "profile", "metrics"))
    assert field.sizes["x"] == 81
    five = 5.0 * mean_radius(1.5)
    assert np.abs(profile.x.values).max() <= five < np.abs(profile.x.values).max() + 0.25
    assert np.array_equal(profile.u.values, field.u.sel(x=profile.x).values)
    assert "u" not in metrics
    assert "x" not in metrics.dims
    for name in ("mass_final", "relative_l1_error", "operator_applications"):
        assert field[name].item() == profile[name].item() == metrics[name].item()


# --- the file -------------------------------------------------------------------------------------


def test_a_file_is_read_as_it_was_written(run_file):
    run, again = fp.solve(case()), fp.read_run(run_file)
    assert again.identical(run)
    assert set(again.coords) == set(run.coords)


def test_no_fill_values(run_file):
    run = xr.open_dataset(run_file, decode_cf=False)
    for name, variable in run.variables.items():
        assert "_FillValue" not in variable.attrs, name
    run.close()


def test_the_same_case_gives_the_same_bytes(tmp_path):
    for name in ("a.nc", "b.nc"):
        fp.write(fp.solve(case()), tmp_path / name)
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_another_process_gives_the_same_bytes(run_file, tmp_path):
    other = tmp_path / "other.nc"
    program = (
        "import sys, json, fracparticles as fp\n"
        "fp.write(fp.solve(fp.Case(**json.loads(sys.argv[1]))), sys.argv[2])"
    )
    subprocess.run([sys.executable, "-c", program, json.dumps(GIVEN), str(other)], check=True)
    assert run_file.read_bytes() == other.read_bytes()


def test_write_makes_the_directories(tmp_path):
    path = tmp_path / "a" / "b" / "run.nc"
    fp.write(fp.solve(case(store="metrics")), path)
    assert [p.name for p in path.parent.iterdir()] == ["run.nc"]


def test_a_write_that_fails_leaves_nothing(tmp_path):
    run = fp.solve(case())
    run.attrs["broken"] = {"a": 1}
    with pytest.raises(TypeError):
        fp.write(run, tmp_path / "run.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_write_that_fails_keeps_the_old_file(run_file):
    before = run_file.read_bytes()
    run = fp.solve(case())
    run.attrs["broken"] = {"a": 1}
    with pytest.raises(TypeError):
        fp.write(run, run_file)
    assert run_file.read_bytes() == before
    assert [p.name for p in run_file.parent.iterdir()] == ["run.nc"]


def test_runs_combine_into_a_cube(tmp_path):
    paths = []
    for beta in (0.3, 0.5):
        for order in (2, 4):
            paths.append(tmp_path / f"{beta}-{order}.nc")
            fp.write(fp.solve(case(beta=beta, order=order)), paths[-1])
    runs = [fp.read_run(p).drop_attrs().expand_dims(["beta", "order"]) for p in paths]
    cube = xr.combine_by_coords(runs, coords="minimal", compat="override")
    assert dict(cube.sizes) == {"beta": 2, "order": 2, "x": 81}
    one = cube.sel(beta=0.5, order=4)
    assert np.array_equal(one.u.values, fp.solve(case()).u.values)
    assert cube.relative_l1_error.dims == ("beta", "order")
    line = xr.concat(
        [fp.read_run(p) for p in paths[:2]],
        dim="order",
        coords="minimal",
        compat="override",
        combine_attrs="drop",
    )
    assert list(line.order.values) == [2, 4]


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # its own
@pytest.mark.parametrize("store", ["field", "metrics"])
def test_the_checker_of_the_convention_finds_nothing(tmp_path, store):
    from compliance_checker.runner import CheckSuite, ComplianceChecker

    path, report = tmp_path / "run.nc", tmp_path / "report.json"
    fp.write(fp.solve(case(store=store)), path)
    CheckSuite.load_all_available_checkers()
    passed, failed = ComplianceChecker.run_checker(
        str(path), ["cf:1.11"], 0, "normal", output_filename=str(report), output_format="json"
    )
    verdict = json.loads(report.read_text())["cf:1.11"]
    messages = [
        m for level in ("high", "medium") for c in verdict[f"{level}_priorities"] for m in c["msgs"]
    ]
    assert messages == []
    assert passed
    assert not failed


# --- files that cannot be read --------------------------------------------------------------------


def test_a_missing_file(tmp_path):
    with pytest.raises(InvalidInput, match="an existing file"):
        fp.read_run(tmp_path / "none.nc")


@pytest.mark.parametrize("keep", [0, 4, 100, 2000, -100])
def test_a_truncated_file(run_file, keep):
    whole = run_file.read_bytes()
    run_file.write_bytes(whole[:keep])
    with pytest.raises(InvalidInput, match="a readable NetCDF file") as refused:
        fp.read_run(run_file)
    assert "\n" not in str(refused.value)


def test_a_file_with_garbage_in_it(run_file):
    whole = bytearray(run_file.read_bytes())
    whole[:64] = b"\xff" * 64
    run_file.write_bytes(whole)
    with pytest.raises(InvalidInput, match="a readable NetCDF file"):
        fp.read_run(run_file)


def test_a_text_file_and_a_directory(tmp_path):
    text = tmp_path / "run.nc"
    text.write_text("not NetCDF\n")
    for path in (text, tmp_path):
        with pytest.raises(InvalidInput, match="file = "):
            fp.read_run(path)


def test_a_file_of_something_else(tmp_path):
    path = tmp_path / "other.nc"
    xr.Dataset({"a": ("t", [1.0, 2.0])}).to_netcdf(path)
    with pytest.raises(InvalidInput, match="a run written by fracparticles"):
        fp.read_run(path)
    with pytest.raises(InvalidInput, match=r"u\(x\) and the coordinates x"):
        read_strengths(path, case())


def test_strengths_on_another_lattice(run_file):
    for changes in ({"spacing": 0.125}, {"half_width": 11.0}):
        with pytest.raises(InvalidInput, match=r"u on the .* points of case\.positions"):
            read_strengths(run_file, case(**changes))


def test_strengths_that_are_not_finite(tmp_path):
    c, path = case(), tmp_path / "u.nc"
    u = np.ones(c.particles)
    u[3] = np.nan
    xr.Dataset({"u": ("x", u)}, {"x": c.x}).to_netcdf(path)
    with pytest.raises(InvalidInput, match="finite strengths"):
        read_strengths(path, c)


@pytest.mark.parametrize("kind", ["text", "complex-pair", "empty"])
def test_strengths_of_another_kind(tmp_path, kind):
    c, path = case(), tmp_path / "u.nc"
    if kind == "text":
        data = xr.Dataset({"u": ("x", ["a"] * c.particles)}, {"x": c.x})
    elif kind == "complex-pair":
        data = xr.Dataset({"u": (("x", "part"), np.ones((c.particles, 2)))}, {"x": c.x})
    else:
        data = xr.Dataset({"u": ("x", np.ones(0))}, {"x": np.ones(0)})
    data.to_netcdf(path)
    with pytest.raises(InvalidInput) as refused:
        read_strengths(path, c)
    assert "\n" not in str(refused.value)
