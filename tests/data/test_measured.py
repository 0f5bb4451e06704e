"""Measured data: tables and files with any points and names, interpolated with an error that is stated."""

from __future__ import annotations

import math
import warnings
from contextlib import suppress

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import fracparticles as fp
from fracparticles.command_line.cli import main
from fracparticles.data.interpolated import Measured
from fracparticles.errors import AccuracyWarning, InvalidInput
from sweeps import covering

GIVEN = {"scheme": "KPSE", "order": 4, "beta": 0.5, "half_width": 20.0, "spacing": 0.1, "t_initial": 0.0,
         "integrator": "exponential", "exterior": "open"}  # fmt: skip
X = np.sort(np.concatenate([np.linspace(-8.0, 9.0, 41), [0.3, 1.1, 2.7]]))
PROFILES = {
    "Gaussian": lambda x: np.exp(-0.25 * x * x),
    "algebraic": lambda x: 1.0 / (1.0 + x * x) ** 2,
    "two blobs": lambda x: np.exp(-0.25 * x * x) + 0.3 * np.exp(-((x - 4.0) ** 2)),
}


def profile(x):
    return np.exp(-0.25 * (x - 1.0) ** 2)


def table(path, x=X, head="x [m], c (mg/L)\n", mark=","):
    lines = [f"{a!r}{mark}{b!r}" for a, b in zip(x.tolist(), profile(x).tolist(), strict=True)]
    path.write_text(head + "\n".join(lines) + "\n", "utf-8")
    return path


# --- the stated error -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("points", [25, 50, 100, 200])
@pytest.mark.parametrize("uneven", [False, True])
def test_the_stated_error_is_that_of_the_interpolation(name, points, uneven):
    """Never below half of the true error, nor above it by more than twenty: coarse points are taken at their worst."""
    x = np.linspace(-3.0, 3.0, points)
    x = np.sinh(x) if uneven else 10.0 * x / 3.0
    data = fp.measured((x, PROFILES[name](x)))
    z = np.linspace(-10.0, 10.0, 20001)
    true = np.abs(data(z) - PROFILES[name](z)).sum() / np.abs(PROFILES[name](z)).sum()
    assert 0.5 * true <= data.interpolation_error <= 20.0 * true + 1e-12


@pytest.mark.parametrize(
    ("points", "name", "uneven", "shift"),
    covering(
        [4, 5, 6, 7, 8, 10, 12, 15, 16, 18, 20, 24], PROFILES, [False, True], [0.0, 1.3], together=2
    ),
)
def test_the_stated_error_of_few_points_is_no_accident(name, points, uneven, shift):
    """A third of the true error, or 1, which says that nothing is known: few points may be met by chance."""
    x = np.linspace(-3.0, 3.0, points)
    x = np.sinh(x) if uneven else 10.0 * x / 3.0
    data = fp.measured((x, PROFILES[name](x - shift)))
    z = np.linspace(-10.0, 10.0, 4001)
    true = np.abs(data(z) - PROFILES[name](z - shift)).sum() / PROFILES[name](z - shift).sum()
    assert data.interpolation_error >= min(1.0, true / 3.0)


def test_four_points_on_a_parabola_are_not_known_to_be_one():
    assert fp.measured(([-3.0, -1.0, 1.0, 3.0], [0.0, 1.0, 1.0, 0.0])).interpolation_error >= 1.0
    assert fp.measured((np.arange(4.0), np.zeros(4))).interpolation_error == 0.0


def test_noise_is_stated_and_not_taken_for_a_smooth_profile():
    x, noise = np.linspace(-10.0, 10.0, 101), np.random.default_rng(3).standard_normal(101)
    data = fp.measured((x, profile(x) + 0.02 * noise))
    assert 0.02 < data.interpolation_error < 0.5


def test_a_step_is_not_overshot():
    x = np.linspace(-5.0, 5.0, 41)
    data = fp.measured((x, np.where(np.abs(x) < 2.0, 1.0, 0.0)))
    assert data.method == "monotone cubic"
    z = np.linspace(-6.0, 6.0, 1001)
    assert data(z).min() >= 0.0
    assert data(z).max() <= 1.0


def test_beyond_the_data_is_zero_and_what_may_be_there_is_stated():
    x = np.linspace(-10.0, 10.0, 201)
    data = fp.measured((x, fp.green(x, 1.0, 1.5)))
    assert data(10.1) == data(-11.0) == 0.0
    outside = 1.0 - float(np.trapezoid(fp.green(x, 1.0, 1.5), x))
    assert outside <= data.beyond <= 2.5 * outside
    assert data.error == data.interpolation_error + data.beyond


def test_in_the_plane():
    x, y = np.linspace(-4.0, 4.5, 41), np.sinh(np.linspace(-2.0, 2.0, 45))
    values = np.exp(-(x[:, None] ** 2) - (y - 0.5) ** 2)
    data = fp.measured(xr.DataArray(values.T, {"y": y, "x": x}, ("y", "x")))
    assert data(0.1, 0.2) == pytest.approx(np.exp(-0.1), abs=3e-4)
    assert data(np.array([0.0, 9.0]), np.array([0.0, 0.0]))[1] == 0.0
    assert data.integral == pytest.approx(np.pi, rel=1e-3)
    case = fp.Case(**{**GIVEN, "half_width": 8.0, "spacing": 0.25, "t_final": 1.0}, dim=2)
    run = fp.solve(case, data)
    right = fp.solve(case, lambda x, y: np.exp(-(x**2) - (y - 0.5) ** 2))
    assert np.abs(run.u - right.u).sum() <= 5.0 * data.interpolation_error * np.abs(right.u).sum()
    grid = np.meshgrid(x, y, indexing="ij")
    again = fp.measured((*grid, values))
    assert np.array_equal(again.values, data.values)


# --- where they come from -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("head", "mark", "units"),
    [
        ("x [m], c (mg/L)\n", ",", ("m", "mg/L")),
        ("position\tconcentration\n", "\t", ("", "")),
        ("# by hand\nx;u\n", ";", ("", "")),
        ("", " ", ("", "")),
        ("\ufeffx,u\n\n", ",", ("", "")),
        ("days since the start of it all in a long line\n", ",", ("", "")),
    ],
)
def test_tables(tmp_path, head, mark, units):
    data = fp.measured(table(tmp_path / "p.csv", head=head, mark=mark))
    assert np.array_equal(data.axes[0], X)
    assert np.array_equal(data.values, profile(X))
    assert data.units == units


def test_a_decimal_comma(tmp_path):
    path = table(tmp_path / "p.csv", head="x;u\n", mark=";")
    path.write_text(path.read_text().replace(".", ","))
    assert np.array_equal(fp.measured(path).values, profile(X))


@pytest.mark.parametrize("mark", [";", "\t"])
def test_a_decimal_comma_in_some_rows_only(tmp_path, mark):
    """The last row may have whole numbers."""
    path = tmp_path / "p.csv"
    rows = ["x, c", "0,5 1,5", "1 2", "2,5 2,25", "3 1"]
    path.write_text("\n".join(row.replace(" ", mark) for row in rows).replace(f",{mark}", mark))
    data = fp.measured(path)
    assert data.axes[0].tolist() == [0.5, 1.0, 2.5, 3.0]
    assert data.values.tolist() == [1.5, 2.0, 2.25, 1.0]


@pytest.mark.parametrize(
    ("names", "axes"),
    [
        ("y,x,c", "yxc"), ("c,x,y", "cxy"), ("x,u,y", "xcy"), ("X,Y,c", "xyc"), ("x,y,z", "xyc"),
        ("u,a,b", "cxy"), ("a,b,c", "xyc"),
    ],
)  # fmt: skip
def test_columns_are_taken_by_their_names(tmp_path, names, axes):
    """x comes before y, and u is the value, wherever they stand; `axes` says what stands in which column."""
    points = [(x, y) for x in range(4) for y in range(10, 15)]
    rows = [{"x": x, "y": y, "c": x + 100 * y} for x, y in points]
    path = tmp_path / "p.csv"
    lines = [",".join(str(row[axis]) for axis in axes) for row in rows]
    path.write_text("\n".join([names, *lines]))
    data = fp.measured(path)
    assert [axis.tolist() for axis in data.axes] == [[0, 1, 2, 3], [10, 11, 12, 13, 14]]
    assert np.array_equal(data.values, np.add.outer(np.arange(4), 100 * np.arange(10, 15)))
    frame = pd.DataFrame(rows)[list(axes)].set_axis(names.split(","), axis=1)
    assert np.array_equal(fp.measured(frame).values, data.values)


@pytest.mark.parametrize("names", [("u", "x"), ("c [mg/L]", "X [m]")])
@pytest.mark.parametrize("mark", [" ", ",", ";", "\t"])
def test_headings_in_a_remark_name_the_columns(tmp_path, names, mark):
    """As numpy.savetxt writes them; the values stand first, and would else be taken for places."""
    path, x = tmp_path / "t.txt", np.linspace(-3.0, 3.0, 21)
    header = "salt at noon, the second day\n" + mark.join(names)
    np.savetxt(path, np.array([np.exp(-x * x), x]).T, delimiter=mark, header=header)
    found = fp.measured(path)
    np.testing.assert_allclose(found.axes[0], x, rtol=1e-15)
    assert found.units == (("m", "mg/L") if "[" in names[0] else ("", ""))


@pytest.mark.parametrize("remark", ["two words", "x", "x y z", "u of noon", "depth 7"])
def test_other_remarks_do_not(tmp_path, remark):
    path, x = tmp_path / "t.txt", np.linspace(-3.0, 3.0, 21)
    np.savetxt(path, np.array([x, np.exp(-x * x)]).T, header=remark)
    np.testing.assert_allclose(fp.measured(path, x="column 1").axes[0], x, rtol=1e-15)


def test_axes_of_two_units_are_refused(tmp_path):
    """A lattice has one unit of length."""
    points = [(x, y) for x in range(4) for y in range(5)]
    path = tmp_path / "p.csv"
    path.write_text("\n".join(["x [m],y [cm],c [g]", *(f"{x},{y},1" for x, y in points)]))
    with pytest.raises(InvalidInput, match="in one unit, and these are in m and cm"):
        fp.measured(path)
    array = xr.DataArray(np.ones((4, 5)), {"x": np.arange(4.0), "y": np.arange(5.0)}, ("x", "y"))
    array.x.attrs["units"], array.y.attrs["units"] = "m", "km"
    with pytest.raises(InvalidInput, match="in one unit, and these are in m and km"):
        fp.measured(array)
    array.y.attrs["units"] = "m"
    assert fp.measured(array).units == ("m", "")


def test_order_does_not_matter_and_names_may_be_any(tmp_path):
    order = np.random.default_rng(1).permutation(X.size)
    right = fp.measured((X, profile(X)))
    frame = pd.DataFrame({"t": np.arange(X.size), "where": X[order], "what": profile(X)[order]})
    several = [
        fp.measured((X[order], profile(X)[order])),
        fp.measured(pd.Series(profile(X)[order], X[order])),
        fp.measured(frame, x="where", u="what"),
        fp.measured(xr.DataArray(profile(X)[order], {"depth": X[order]}, "depth")),
        fp.measured(xr.Dataset({"salt": ("depth", profile(X)[order])}, {"depth": X[order]})),
    ]
    path = tmp_path / "any.nc"
    array = xr.DataArray(profile(X), {"depth": X}, "depth", name="salt", attrs={"units": "g/kg"})
    array.depth.attrs["units"] = "m"
    array.to_netcdf(path)
    several.append(fp.measured(path))
    assert several[-1].units == ("m", "g/kg")
    for data in several:
        assert isinstance(data, Measured)
        assert np.array_equal(data.axes[0], X)
        assert np.array_equal(data.values, right.values)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ((X[:3], profile(X[:3])), "at least 4 points"),
        ((np.append(X, X[3]), profile(np.append(X, X[3]))), "is there twice"),
        ((X, np.where(X > 8.0, np.nan, profile(X))), "finite"),
        (([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 1.0, 2.0], [1.0] * 4), "a rectangular grid"),
        (pd.DataFrame({"a": X, "b": X, "c": X, "d": X, "e": X}), "Say which"),
        (xr.Dataset({"a": ("x", X), "b": ("x", X)}, {"x": X}), "one variable of values"),
        (xr.Dataset({"a": ("x", X)}), "coordinates of a along x"),
        (3.0, "a file, a table"),
        ("missing.csv", "an existing file"),
        ("missing.nc", "an existing file"),
        ((np.arange(9.0), np.arange(5.0), np.ones((9, 5))), "columns of one length"),
        ((np.arange(9.0), np.ones(5)), "columns of one length"),
        ((1e150 * np.arange(9.0), np.ones(9)), "unit of length"),
        ((1e-150 * np.arange(9.0), np.ones(9)), "unit of length"),
        ((np.arange(9.0), 1e250 * np.ones(9)), "unit of u"),
        ((np.arange(9.0), 1e-250 * np.ones(9)), "unit of u"),
        (pd.DataFrame({"v": 2.0 * X, "u": X}, index=pd.Index(X, name="x")), "Say which"),
        (pd.DataFrame(np.c_[X, X, X], columns=["x", "u", "u"]), "different names"),
    ],
)
def test_what_is_refused(data, words):
    """No error of a library comes through, and no integral that is zero because it underflows."""
    with pytest.raises(InvalidInput, match=words) as refused:
        fp.measured(data)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "It is empty"),
        ("x,u\n1,2\n2,three\n3,4\n4,5\n", "row 2 of the numbers"),
        ("x,u\n1,2\n2\n3,4\n4,5\n", "row 2 of the numbers"),
        ("x,u\n1,2\n2,1_0\n3,4\n4,5\n", "row 2 of the numbers"),
        ("t,x,u\n1,1,2\n1,2,3\n1,3,4\n1,4,5\n", "Say which"),
        ("u,u\n1,2\n2,3\n3,4\n4,5\n", "columns of different names"),
        ("x,u\n", "It has headings only"),
        ("u of x, at noon\n1 2\n2 3\n3 4\n4 5", "a name for each of the 2 columns"),
        ("x\tu\n800\t0.5\n900\t0.7\n1,000\t0.4\n1,100\t0.1", "one decimal mark"),
    ],
)
def test_tables_that_are_refused(tmp_path, text, words):
    """A title is no heading, and a comma beside points parts thousands: 1,000 is not 1."""
    path = tmp_path / "p.csv"
    path.write_text(text)
    with pytest.raises(InvalidInput, match=words):
        fp.measured(path)


@given(st.text(alphabet="0123456789.,;eE+- \t\n#xu[]\"'", max_size=60))
def test_any_text_is_refused_or_a_table(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("t") / "p.csv"
    path.write_text(text)
    with suppress(InvalidInput):
        assert fp.measured(path).values.size >= 4


@pytest.mark.parametrize("width", [1.0, 1.3])
def test_data_that_underflow_far_out_are_read_in_silence(width):
    """exp(-x^2) has slopes below 1e-308 there, whose harmonic mean is zero."""
    x = np.linspace(-50.0, 50.0, 1001)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        data = fp.measured((x, np.exp(-((x / width) ** 2))))
        assert data.interpolation_error < 1e-3
        assert data(np.array([45.0]))[0] == 0.0


# --- runs -----------------------------------------------------------------------------------------


def test_a_run_states_the_error_of_its_data(tmp_path):
    path = table(tmp_path / "p.csv")
    run = fp.solve(fp.Case(**GIVEN), path)
    right = fp.solve(fp.Case(**GIVEN), profile)
    error = float(np.abs(run.u - right.u).sum() / np.abs(right.u).sum())
    assert error <= 2.0 * float(run.interpolation_error) + float(run.beyond_data)
    assert "cubic" in run.interpolation_error.attrs["long_name"]
    assert run.attrs["initial_data"].startswith(f"file {path}, sha256")
    again = fp.Case.from_json(run.attrs["case"])
    assert again.initial == str(path)
    assert np.array_equal(fp.solve(again).u, run.u)


def test_the_command_line(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    table(tmp_path / "p.csv")
    xr.DataArray(profile(X), {"depth": X}, "depth", name="salt").to_netcdf("p.nc")
    flags = [f"--{name.replace('_', '-')}={value}" for name, value in GIVEN.items()]
    for name in ("p.csv", "measured:p.nc"):
        assert main(["solve", *flags, "--initial", name, "-o", "run.nc"]) == 0
        assert fp.read_run("run.nc").interpolation_error < 0.01
    assert np.array_equal(fp.read_run("run.nc").u, fp.solve(fp.Case(**GIVEN), "p.csv").u)
    capsys.readouterr()
    assert main(["solve", *flags, "--initial", "p.nc", "-o", "run.nc"]) == 2
    assert "u(x)" in capsys.readouterr().err


def test_a_lattice_that_does_not_hold_the_data_is_refused():
    data = fp.measured((X, profile(X)))
    for changes in ({"half_width": 2.0}, {"spacing": 2.5}):
        case = fp.Case(**{**GIVEN, **changes, "t_final": 0.1})
        with pytest.raises(InvalidInput, match="of their mass"):
            fp.solve(
                case, fp.measured((X, fp.green(X, 0.01, 1.5))) if "spacing" in changes else data
            )


def test_data_that_end_too_early_are_warned_of():
    x = np.linspace(-3.0, 3.0, 61)
    with pytest.warns(AccuracyWarning, match="that may lie beyond them"):
        fp.solve(fp.Case(**GIVEN), fp.measured((x, fp.green(x, 1.0, 1.5))))


def test_good_data_are_not_warned_of():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fp.solve(fp.Case(**GIVEN), fp.measured((X, profile(X))))


def test_headings_with_blanks_before_the_units_name_their_columns(tmp_path):
    """Separated by blanks, "u [mg]  x [m]" are two names: the columns are not taken for each other."""
    x = np.linspace(-3.0, 3.0, 9)
    table = tmp_path / "swapped.txt"
    lines = "\n".join(f"{2.0 + place} {place}" for place in x.tolist())
    table.write_text(f"u [mg]  x [m]\n{lines}")
    found = fp.measured(table)
    assert found.axes[0].tolist() == x.tolist()
    assert found.values.tolist() == (2.0 + x).tolist()
    assert found.units == ("m", "mg")


def test_a_frame_is_read_like_a_table():
    """Units stand in its headings, and an index of places is a column."""
    x = np.linspace(-3.0, 3.0, 9)
    swapped = fp.measured(pd.DataFrame({"u [mg]": 2.0 + x, "x [m]": x}))
    assert swapped.axes[0].tolist() == x.tolist()
    assert swapped.units == ("m", "mg")
    indexed = fp.measured(pd.DataFrame({"u": 2.0 + x}, index=pd.Index(x, name="x")))
    assert indexed.axes[0].tolist() == x.tolist()
    assert indexed.values.tolist() == (2.0 + x).tolist()


@pytest.mark.parametrize("first", ["", "sample"])
def test_a_column_that_is_no_place_is_left_out_by_names(tmp_path, first):
    """`DataFrame.to_csv` writes a first column of row numbers, without a heading."""
    rows = [f"{k},{x},{math.exp(-x * x)}" for k, x in enumerate(np.linspace(-3.0, 3.0, 16))]
    path = tmp_path / "profile.csv"
    path.write_text("\n".join([f"{first},depth [m],salt [g/L]", *rows]))
    with pytest.raises(
        InvalidInput, match=r"and 'depth', here of 16 x 16 points.*x='.*', u='salt'"
    ):
        fp.measured(path)
    assert fp.measured(path, x="depth", u="salt").units == ("m", "g/L")


@pytest.mark.parametrize("x", ["a", np.nan])
def test_interpolated_data_are_asked_for_at_numbers(x):
    data = fp.measured((np.arange(5.0), np.ones(5)))
    with pytest.raises(InvalidInput, match=r"^x = "):
        data(x)
