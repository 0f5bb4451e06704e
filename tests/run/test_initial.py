"""Initial data of one's own: kinds, labels, files, restarts, and what is stored of where a run came from."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import warnings

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import fracparticles as fp
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.run.agreement import refuse_contradiction
from fracparticles.run.case import Case
from fracparticles.run.initial import initial_strengths

GIVEN = {
    "scheme": "KPSE",
    "order": 4,
    "beta": 0.5,
    "half_width": 10.0,
    "spacing": 0.25,
    "integrator": "exponential",
    "t_initial": 0.5,
}


def case(**changes) -> Case:
    return Case(**{**GIVEN, **changes})


def square(**changes) -> Case:
    return case(half_width=4.0, spacing=0.5, dim=2, **changes)


def skew(x):
    """Not even, so that data taken by position and not by label come out mirrored."""
    return np.exp(-((x - 1.0) ** 2))


def skew_square(x, y):
    return np.exp(-((x - 1.0) ** 2) - 2.0 * (y + 0.5) ** 2)


def u0_of(the_case, initial) -> np.ndarray:
    u0, _ = initial_strengths(the_case, initial)
    assert type(u0) is np.ndarray
    assert u0.dtype == np.float64
    assert u0.shape == the_case.shape
    return u0


def refused(the_case, initial, *words) -> None:
    with pytest.raises(InvalidInput) as error:
        initial_strengths(the_case, initial)
    message = str(error.value)
    assert error.value.field == "initial"
    assert "\n" not in message
    for word in words:
        assert word in message, message


def labelled(the_case=None, **changes) -> xr.DataArray:
    x = (the_case or case()).x
    return xr.DataArray(skew(x), {"x": x}, "x", **changes)


# --- bare arrays ----------------------------------------------------------------------------------


def test_masked_values_are_refused_and_a_mask_without_any_is_not():
    c = case()
    some = np.ma.masked_greater(skew(c.x), 0.5)
    refused(c, some, "without a mask", "Fill the masked entries")
    refused(c, lambda x: np.ma.masked_less(skew(x), 0.1), "without a mask")
    refused(square(), np.ma.masked_all((17, 17)), "without a mask")
    assert np.array_equal(u0_of(c, np.ma.array(skew(c.x))), skew(c.x))


@pytest.mark.parametrize("kind", [np.int8, np.uint64, np.float16, np.float32, np.longdouble, ">f8"])
def test_real_numbers_of_any_type_are_cast(kind):
    c = case()
    whole = (np.arange(81) % 7).astype(kind)
    assert np.array_equal(u0_of(c, whole), np.arange(81) % 7)
    assert np.array_equal(u0_of(c, whole.tolist()), np.arange(81) % 7)


@pytest.mark.parametrize("kind", [bool, complex, str, object, "datetime64[s]"])
def test_other_kinds_are_refused(kind):
    c = case()
    data = np.zeros(81).astype("int64").astype(kind)
    refused(c, data, "real numbers")
    refused(c, lambda x: data, "real numbers")
    if kind is not object:
        refused(c, xr.DataArray(data, {"x": c.x}, "x"), "real numbers")


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_is_named_with_its_place(bad):
    c, u0 = case(), np.ones(81)
    u0[3] = bad
    for data in (u0, lambda x: u0, xr.DataArray(u0, {"x": c.x}, "x")):
        refused(c, data, "not finite at x = -9.25")
    plane = np.ones((17, 17))
    plane[0, 16] = bad
    refused(square(), plane, "not finite at x = -4, 4")


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"integrator": "rk2", "dt": 0.01},
        {"integrator": "euler", "dt": 0.01, "evaluation": "stepping"},
        {"exterior": "open", "evaluation": "convolution"},
        {"scheme": "GPSE", "order": 2, "integrator": None, "dt": 1.0},
        {"half_width": 4.0, "spacing": 0.5, "dim": 2},
    ],
    ids=str,
)
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_prepared_case_names_data_that_are_not_finite(changes, bad):
    c = case(**changes)
    ready, u0 = fp.prepare(c), np.ones(c.shape)
    u0[(2,) * c.dim] = bad
    with pytest.raises(InvalidInput, match=f"not finite at x = {c.x[2]:g}"):
        ready.solve(u0)


def test_a_prepared_case_takes_bare_arrays_only():
    ready, c = fp.prepare(case()), case()
    right = ready.solve(skew(c.x))
    assert np.array_equal(ready.solve(skew(c.x).tolist()), right)
    assert np.array_equal(ready.solve(np.arange(81)), ready.solve(np.arange(81.0)))
    for data in (
        labelled(),
        labelled().to_dataset(name="u"),
        pd.Series(skew(c.x), c.x),
        np.ma.masked_all(81),
        skew(c.x) + 0j,
        np.ones(81, bool),
        np.ones(80),
        None,
    ):
        with pytest.raises(InvalidInput, match=r"^initial (=|is missing)"):
            ready.solve(data)


# --- callables ------------------------------------------------------------------------------------


def test_a_callable_of_single_numbers():
    c = case()
    assert np.array_equal(
        u0_of(c, lambda x: math.exp(-((x - 1.0) ** 2))),
        [math.exp(-((x - 1.0) ** 2)) for x in c.x],
    )
    hat = u0_of(c, lambda x: 1.0 - abs(x) if abs(x) < 1.0 else 0)  # first an int: not what all are
    assert np.array_equal(hat, np.maximum(1.0 - np.abs(c.x), 0.0))
    plane = square()
    x, y = plane.positions
    assert u0_of(plane, lambda x, y: math.cos(x) * max(y, 0.0)) == pytest.approx(
        np.cos(x) * np.maximum(y, 0.0), rel=1e-15
    )


def test_a_constant_callable_is_that_constant():
    assert np.array_equal(u0_of(case(), lambda x: 2), np.full(81, 2.0))
    assert np.array_equal(u0_of(square(), lambda x, y: np.float32(0.5)), np.full((17, 17), 0.5))
    plane = square()
    along = u0_of(plane, lambda x, y: skew(x))  # shape (17, 1)
    assert np.array_equal(along, np.repeat(skew(plane.x)[:, None], 17, axis=1))
    along = u0_of(plane, lambda x, y: skew(y))
    assert np.array_equal(along, np.repeat(skew(plane.x)[None, :], 17, axis=0))


def test_a_callable_that_gives_a_wrong_shape():
    for function in (lambda x: x[1:], lambda x: x[:, None], lambda x: np.ones(1), lambda x: []):
        refused(case(), function, "of shape (81,)")
    for function in (lambda x, y: x[:, 0], lambda x, y: np.ones((17, 2)), lambda x, y: np.ones(17)):
        refused(square(), function, "of shape (17, 17)")
    refused(case(), lambda x: [[1.0], [1.0, 2.0]], "rows of equal length")


def test_what_a_callable_raises_goes_through_with_a_note():
    def of_its_own(x):
        raise KeyError("mine")

    def too_hot(x):
        raise ValueError("too hot")

    for function, kind, words in (
        (of_its_own, KeyError, "mine"),
        (too_hot, ValueError, "too hot"),
        (lambda x: math.log(x), TypeError, "0-dimensional"),
    ):
        with pytest.raises(kind, match=words) as raised:
            initial_strengths(case(), function)
        assert "case.positions" in raised.value.__notes__[0]
    assert raised.value.__notes__[1] == "For single numbers: ValueError: math domain error"


def test_the_names_of_arguments_say_which_coordinate_they_take():
    def at_three(x, y):
        return np.exp(-((x - 3.0) ** 2) - y * y)

    straight, swapped = (
        initial_strengths(square(), f)[0] for f in (at_three, lambda y, x: at_three(x, y))
    )
    np.testing.assert_array_equal(swapped, straight)
    assert np.ptp(straight - straight.T) > 0.1  # another order would be another solution


def test_a_function_of_other_variables_is_refused():
    for function in (lambda: 1.0, lambda x, y: x, lambda t: t, lambda y, x: x):
        refused(case(), function, "a function of x. Name")
    refused(square(), lambda x, y, z: x, "a function of x or y, or of several of these")


# --- labels ---------------------------------------------------------------------------------------


@given(st.permutations(range(81)), st.sampled_from([np.float64, np.float32]), st.booleans())
def test_data_are_taken_by_their_labels(order, kind, as_dataset):
    c, order = case(), np.array(order)
    data = xr.DataArray(skew(c.x)[order].astype(kind), {"x": c.x[order].astype(kind)}, "x")
    assert np.array_equal(
        u0_of(c, data.to_dataset(name="u") if as_dataset else data), skew(c.x).astype(kind)
    )


def test_a_mirrored_x_and_a_shifted_one():
    c = case()
    assert np.array_equal(u0_of(c, labelled().isel(x=slice(None, None, -1))), skew(c.x))
    refused(c, labelled().assign_coords(x=c.x + 0.25), "up to 1 h off", "-9.75 for -10.0")
    refused(c, labelled().assign_coords(x=c.x + 1e-6), "up to 4e-06 h off")
    refused(c, labelled().assign_coords(x=c.x * 1.5), "up to 20 h off")
    refused(c, labelled().isel(x=slice(1, None)), "80 points along x")
    twice = np.array(c.x)
    twice[40] = c.x[41]
    refused(c, labelled().assign_coords(x=twice), "up to 1 h off", "0.25 for 0.0")


def test_a_type_of_few_digits_is_matched_to_its_precision():
    c = case(half_width=30.0, spacing=0.1)
    x = c.x.astype(np.float32)
    assert 0.0 < np.abs(x - c.x).max() < 2e-6
    data = xr.DataArray(skew(c.x), {"x": x}, "x")
    assert np.array_equal(u0_of(c, data), skew(c.x))
    refused(c, data.assign_coords(x=x + np.float32(1e-3)), "up to 0.01 h off")


def test_a_plane_is_transposed_and_sorted():
    c = square()
    right = skew_square(*c.positions)
    data = xr.DataArray(right, {"x": c.x, "y": c.x}, ("x", "y"))
    assert np.array_equal(u0_of(c, data.T), right)
    assert np.array_equal(u0_of(c, data.T.isel(x=slice(None, None, -1))), right)
    assert np.array_equal(
        u0_of(c, data.expand_dims(level=[3.0]).transpose("y", "level", "x")), right
    )
    refused(c, data.rename(y="z"), "(x: 17, z: 17)")
    refused(case(), data, "(x: 17, y: 17)")
    refused(c, labelled(), "u(x, y)")


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (labelled().drop_vars("x"), ["Store x, which u does not have"]),
        (labelled().rename(x="position"), ["(position: 81)"]),
        (labelled().expand_dims(t=3), ["(t: 3, x: 81)", "select one"]),
        (labelled().assign_coords(x=[f"{x}" for x in range(81)]), ["finite real numbers as x"]),
        (labelled().assign_coords(x=np.full(81, np.nan)), ["finite real numbers as x"]),
        (labelled().to_dataset(name="v"), ["u(x)", "It holds", "v"]),
        (xr.Dataset(), ["It holds nothing"]),
        (pd.DataFrame({"u": skew(case().x)}, case().x), ["DataFrame", "Take a column"]),
        (pd.Series(skew(case().x), case().x + 0.25), ["up to 1 h off"]),
    ],
    ids=range(9),
)
def test_labels_that_do_not_fit_are_refused_with_the_reason(data, words):
    refused(case(), data, *words)


def test_a_series_is_labelled_by_its_index():
    c = case()
    series = pd.Series(skew(c.x), c.x)
    assert np.array_equal(u0_of(c, series[::-1]), skew(c.x))
    assert np.array_equal(u0_of(c, pd.Series(skew(c.x))), skew(c.x))  # counted, not labelled


def test_a_name_that_a_coordinate_has():
    c = case()
    data = labelled().assign_coords(u=3.0).rename("x")
    assert np.array_equal(u0_of(c, data), skew(c.x))


# --- files ----------------------------------------------------------------------------------------


def stored(tmp_path, data, **encoding):
    path = tmp_path / "u.nc"
    data.to_netcdf(path, engine="netcdf4", encoding=encoding)
    return path


def as_file() -> xr.Dataset:
    return labelled().to_dataset(name="u")


def test_a_file_is_taken_by_its_labels(tmp_path):
    c = case()
    for data in (
        as_file(),
        as_file().isel(x=slice(None, None, -1)),
        as_file().assign_coords(x=c.x.astype(np.float32)),
        as_file().expand_dims(time=[3.0]),
        as_file().expand_dims(time=[3.0]).transpose("x", "time"),
    ):
        path = stored(tmp_path, data)
        assert np.array_equal(initial_strengths(c, path)[0], skew(c.x))
        assert np.array_equal(u0_of(c, path), skew(c.x))
    assert np.array_equal(u0_of(case(initial=str(path)), None), skew(c.x))
    refused(c, stored(tmp_path, as_file().assign_coords(x=c.x + 0.25)), "up to 1 h off", "u.nc")
    refused(c, stored(tmp_path, as_file().expand_dims(time=[1.0, 2.0])), "(time: 2, x: 81)")


def test_variables_that_nobody_asked_for_are_left_alone(tmp_path):
    c = case()
    data = as_file().assign(
        later=("x", np.ones(81), {"units": "hours since analysis"}),
        span=((), 1.0, {"units": "days"}),
        scaled=("x", np.ones(81), {"scale_factor": "two"}),
    )
    data = data.expand_dims(time=[0.5]).assign_coords(
        time=("time", [0.5], {"units": "hours since analysis", "calendar": "of one's own"})
    )
    assert np.array_equal(initial_strengths(c, stored(tmp_path, data))[0], skew(c.x))


def test_packed_numbers_are_unpacked_and_missing_ones_refused(tmp_path):
    c = case()
    packed = {"dtype": "i2", "scale_factor": 2.0**-14, "_FillValue": -1}
    path = stored(tmp_path, as_file(), u=packed)
    assert np.abs(initial_strengths(c, path)[0] - skew(c.x)).max() <= 2.0**-15
    data = as_file()
    data["u"][5] = np.nan
    refused(c, stored(tmp_path, data, u=packed), "not finite at x = -8.75")


def test_what_is_no_file_is_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe.nc")
    for path in (tmp_path / "pipe.nc", "/dev/null", "/dev/zero"):
        with pytest.raises(InvalidInput, match="a regular file"):
            initial_strengths(case(), path)
    with pytest.raises(InvalidInput, match="an existing file"):
        initial_strengths(case(), tmp_path / "none.nc")


# --- restarts -------------------------------------------------------------------------------------


@pytest.mark.parametrize("how", ["path", "field", "DataArray", "Dataset"])
def test_a_restart_must_go_on_where_the_run_ended(tmp_path, how):
    first = fp.solve(case(diffusivity=2.0, t_final=1.0))
    path = tmp_path / "first.nc"
    fp.write(first, path)

    def restart(**changes):
        initial = {"path": path, "field": None, "DataArray": first.u, "Dataset": first}[how]
        if how == "field":
            changes["initial"] = str(path)
        return fp.solve(case(**{"diffusivity": 2.0, "t_initial": 1.0, **changes}), initial)

    whole = fp.solve(case(diffusivity=2.0)).u.values
    assert np.abs(restart().u.values - whole).max() <= 1e-13 * whole.max()
    for changes, words in (
        ({"beta": 0.3}, "beta = 0.3, .* beta = 0.5. Set beta = 0.5"),
        ({"diffusivity": 5.0}, "diffusivity = 5, .* Set diffusivity = 2"),
        ({"t_initial": 0.25}, "t_initial = 0.25, .* t_final = 1. Set t_initial = 1"),
        ({"t_initial": 1.0 + 1e-6}, "Set t_initial = 1"),
    ):
        with pytest.raises(InvalidInput, match=words):
            restart(**changes)
    u = first.u.values  # the numbers alone say nothing
    fp.solve(case(beta=0.3), u)


def test_the_case_stored_with_a_file_says_what_it_is_when_the_coordinates_do_not(tmp_path):
    first = fp.solve(case(t_final=1.0))
    bare = first[["u"]].drop_vars([name for name in first.coords if name != "x"])
    assert np.array_equal(u0_of(case(t_initial=1.0), bare), first.u.values)
    refused(case(beta=0.25, t_initial=1.0), bare, "beta = 0.25")
    bare.attrs["case"] = "{"  # not ours
    u0_of(case(beta=0.25, t_initial=1.0), bare)


@pytest.mark.parametrize(("name", "value"), [("beta", 0.3), ("t_final", 2.0), ("diffusivity", 4.0)])
def test_a_run_that_contradicts_its_case_is_refused(tmp_path, name, value):
    """Whichever of the two the new case has: one of them is wrong."""
    first = fp.solve(case(t_final=1.0))
    other = first.assign_coords({name: value})
    for data in (other, stored(tmp_path, other)):
        said = {name: value} if name != "t_final" else {}
        at = value if name == "t_final" else 1.0
        for changes in ({"t_initial": 1.0}, {"t_initial": at, "t_final": 3.0, **said}):
            refused(case(**changes), data, f"its {name} is {value}", "drop the attribute 'case'")
    # The same scalar with fewer digits is no contradiction.
    single = first.assign_coords({name: first[name].astype(np.float32)})
    refuse_contradiction("initial", single, "single")
    without = other.drop_attrs()
    at_its_time = (
        {"t_initial": value, "t_final": 3.0}
        if name == "t_final"
        else {name: value, "t_initial": 1.0}
    )
    assert np.array_equal(u0_of(case(**at_its_time), without), first.u.values)


def test_a_file_of_another_program_is_what_it_says(tmp_path):
    """By alpha for beta, and by one time as by several."""
    c = case(t_initial=1.0)
    foreign = fp.solve(case(t_final=1.0))[["u"]].drop_attrs()
    foreign = foreign.drop_vars([name for name in foreign.coords if name != "x"])
    told = foreign.assign_coords(alpha=c.alpha, t=1.0)
    assert np.array_equal(u0_of(c, told), foreign.u.values)
    refused(c, stored(tmp_path, told.assign_coords(alpha=1.9)), "alpha = 1.5", "Set alpha = 1.9")
    for late in (told.assign_coords(t=7.0), told.assign_coords(t=7.0).expand_dims("t")):
        refused(c, stored(tmp_path, late), "t_initial = 1", "t_final = 7")


def test_a_plane_does_not_go_on_as_a_line(tmp_path):
    refused(case(t_initial=1.0), fp.solve(square(t_final=1.0)), "dim = 1", "dim = 2")


# --- a time for data of one's own -----------------------------------------------------------------


def without_time(**changes) -> Case:
    return Case(**{name: value for name, value in GIVEN.items() if name != "t_initial"}, **changes)


def test_data_without_a_time_are_warned_of_once(tmp_path):
    c, path = without_time(t_final=2.0), stored(tmp_path, as_file())
    for initial in (skew(c.x), skew, labelled(), labelled().to_dataset(name="u"), path):
        with pytest.warns(AccuracyWarning, match="t_initial was not given") as caught:
            fp.solve(c, initial)
        (warning,) = [w for w in caught if "t_initial" in str(w.message)]
        assert "t_initial = 0.5" in str(warning.message)
        assert "t_final - t_initial = 1.5" in str(warning.message)
        assert warning.filename == __file__


def test_no_warning_where_the_time_is_known(tmp_path):
    first = fp.solve(without_time(t_final=0.5, t_initial=0.25))
    fp.write(first, tmp_path / "first.nc")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        initial_strengths(without_time(), None)
        initial_strengths(case(), skew)
        initial_strengths(without_time(), tmp_path / "first.nc")
        initial_strengths(without_time(), first.u)
        initial_strengths(Case.from_json(without_time().to_json()), skew)  # it says all


# --- what is stored makes the run again -----------------------------------------------------------


@pytest.mark.parametrize(
    "initial", [skew, skew(case().x), labelled()], ids=["callable", "array", "labels"]
)
def test_a_run_from_given_data_says_so(initial):
    run = fp.solve(case(), initial)
    again = Case.from_json(run.attrs["case"])
    assert again.initial.startswith("given, sha256 ")
    assert again.initial.rpartition(" ")[2] == run.attrs["initial_data"].rpartition(" ")[2]
    assert again.model_copy(update={"initial": "fundamental"}) == case()
    with pytest.raises(InvalidInput, match=r"initial = 'given, .*Pass the data again"):
        fp.solve(again)
    with pytest.raises(InvalidInput, match="the data that the case was run from"):
        fp.solve(again, 2.0 * skew(again.x))
    assert fp.solve(again, initial).identical(run)
    assert again.path != case().path


def test_a_run_from_a_file_names_it_and_its_content(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    stored(tmp_path, as_file())
    run = fp.solve(case(), "u.nc")
    again = Case.from_json(run.attrs["case"])
    assert again == case(initial="u.nc")
    assert fp.solve(again).identical(run)
    assert run.attrs["initial_data"].startswith("file u.nc, sha256 ")
    stored(tmp_path, 2.0 * as_file())
    assert fp.solve(again).attrs["initial_data"] != run.attrs["initial_data"]


@pytest.mark.parametrize("name", ["fundamental", "given, sha256 00", "a, sha256 b.nc"])
def test_files_of_odd_names(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    stored(tmp_path, as_file()).rename(tmp_path / name)
    run = fp.solve(case(), tmp_path.joinpath(name).relative_to(tmp_path))
    assert fp.solve(Case.from_json(run.attrs["case"])).u.identical(run.u)


def test_a_run_from_the_fundamental_solution_stays_what_it_was():
    run = fp.solve(case())
    assert run.attrs["initial_data"] == "fundamental solution at t = 0.5"
    assert Case.from_json(run.attrs["case"]) == case()
    assert fp.solve(Case.from_json(run.attrs["case"])).identical(run)


def test_bare_data_import_no_library_of_labels():
    program = (
        "import sys, numpy as np\n"
        "from fracparticles.run.case import Case\n"
        "from fracparticles.run.initial import initial_strengths\n"
        f"case = Case(**{GIVEN!r})\n"
        "initial_strengths(case, np.ones(81))\n"
        "sys.exit(sum(name in sys.modules for name in ('xarray', 'pandas', 'netCDF4')))"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_data_whose_mass_overflows_are_refused():
    c = case(half_width=1e20, spacing=5e18, t_initial=0.5e30, t_final=1.5e30)
    with pytest.raises(
        InvalidInput, match=r"^initial = 'strengths up to 1e\+300 of the volume 5e\+18"
    ):
        initial_strengths(c, np.full(c.shape, 1e300))
