"""One run, one file: conventions, identical bytes, atomic writing, reading, cubes of runs."""

from __future__ import annotations

import json
import os
import resource
import signal
import socket
import stat
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fracparticles as fp
from fracparticles.command_line.cli import main
from fracparticles.errors import InvalidInput
from fracparticles.files import replaceable, replacing, uninterrupted
from fracparticles.run.case import Case
from fracparticles.run.initial import initial_strengths
from fracparticles.run.solver import compute
from fracparticles.special import mean_radius
from scenes.extremes.faults.processes import forked
from sweeps import covering, few

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


@cache
def solved() -> xr.Dataset:
    """The run of the case, not to be changed."""
    return fp.solve(case())


@pytest.fixture
def run_file(tmp_path) -> Path:
    path = tmp_path / "run.nc"
    fp.write(solved(), path)
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
        *compute(case()).estimates,
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


def test_the_title_says_all_of_the_equation():
    for diffusivity, words in ((1.0, "D = 1"), (0.02, "D = 0.02"), (3e5, "D = 300000")):
        run = fp.solve(
            case(
                diffusivity=diffusivity,
                store="metrics",
                integrator="exponential",
                dt=None,
                t_final=0.6,
            )
        )
        assert run.attrs["title"].endswith(
            f"u_t = -D (-Laplacian)^(alpha/2) u, alpha = 1.5, {words}"
        )


def test_strength_and_mass_are_told_apart():
    """u is a density, the strength; V u a mass."""
    dvm = {**GIVEN, "scheme": "DVM", "t_final": 0.6, "remesh_above": 1.01}
    plane = {**GIVEN, "half_width": 4.0, "spacing": 0.5, "dim": 2, "store": "profile"}
    runs = [fp.solve(Case(**fields)) for fields in (GIVEN, plane, dvm)]
    assert runs[2].remeshings.item() > 0
    named = {
        name: variable.attrs["long_name"]
        for run in runs
        for name, variable in run.data_vars.items()
    }
    strengths = {name for name, words in named.items() if "strength" in words}
    masses = {name for name, words in named.items() if "mass" in words}
    assert strengths == {"u_axis", "u_diagonal"}
    assert masses == {
        "mass_initial",
        "mass_final",
        "particle_strength",
        "eliminated_strength",
        "lost_strength",
    }
    assert runs[0].u.attrs["long_name"] == "particle strength u at t_final"
    assert runs[2].u.attrs["long_name"] == "field u at t_final"
    assert runs[2].particle_strength.sum().item() == runs[2].mass_final.item()


def test_estimates_are_scalars_of_the_run():
    solution = compute(case())
    assert solution.estimates
    run = fp.solve(case())
    for name, (value, meaning) in solution.estimates.items():
        assert run[name].item() == value
        assert run[name].attrs == {"long_name": meaning, "units": "1"}


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
    with pytest.raises(InvalidInput, match=r"dim = 1, .* dim = 2"):
        initial_strengths(case(), path)


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


CANNOT_BE_HELD = [
    {"a": 1},
    None,
    object(),
    {1, 2},
    1j,
    [1, "a", None],
    np.datetime64("2020-01-01"),
    2**70,
    print,
]


@pytest.mark.parametrize(("value", "holder"), covering(CANNOT_BE_HELD, ["run", "u", "x", "beta"]))
def test_an_attribute_that_cannot_be_written_is_named_and_leaves_nothing(tmp_path, value, holder):
    run = solved().copy(deep=True)
    (run if holder == "run" else run[holder]).attrs["broken"] = value
    of = "" if holder == "run" else f" of {holder},"
    with pytest.raises(InvalidInput, match=f"^attribute{of} 'broken' = ") as refused:
        fp.write(run, tmp_path / "run.nc")
    assert "\n" not in str(refused.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["a/b", "", 3, "trailing "])
def test_a_name_that_cannot_be_written(tmp_path, name):
    run = fp.solve(case(store="metrics"))
    run.attrs[name] = 1
    with pytest.raises(InvalidInput, match=r"^attribute "):
        fp.write(run, tmp_path / "run.nc")


@pytest.mark.parametrize(
    "values", [np.array([1j, 2j]), np.array([{}, {}], object)], ids=["complex", "object"]
)
def test_a_variable_that_cannot_be_written(tmp_path, values):
    run = fp.solve(case(store="metrics")).assign(odd=("i", values))
    with pytest.raises(InvalidInput, match=r"^variable 'odd' = "):
        fp.write(run, tmp_path / "run.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_write_that_fails_keeps_the_old_file(run_file):
    before = run_file.read_bytes()
    run = fp.solve(case())
    run.attrs["broken"] = {"a": 1}
    with pytest.raises(InvalidInput):
        fp.write(run, run_file)
    assert run_file.read_bytes() == before
    assert [p.name for p in run_file.parent.iterdir()] == ["run.nc"]


def test_what_is_not_a_data_set_is_refused(tmp_path):
    for thing in (None, fp.solve(case()).u, {}, tmp_path / "run.nc", xr.Dataset()):
        with pytest.raises(InvalidInput, match=r"^dataset (=|is missing)"):
            fp.write(thing, tmp_path / "run.nc")
    for path in (None, 3, b"run.nc", "a\0b", tmp_path, ""):
        with pytest.raises(InvalidInput, match=r"^path (=|is missing)"):
            fp.write(fp.solve(case(store="metrics")), path)
    with pytest.raises(InvalidInput, match=r"path = .* a NetCDF file, .* like a table"):
        fp.write(fp.solve(case(store="metrics")), tmp_path / "run.CSV")


def test_the_mode_is_what_the_umask_leaves(tmp_path):
    before = os.umask(0o022)
    try:
        for umask in (0o022, 0o077, 0o027, 0o002):
            path = tmp_path / f"{umask:o}"
            path.touch(0o600)  # the mode of what was there does not count
            os.umask(umask)
            fp.write(xr.Dataset({"a": 1.0}), path)
            assert stat.S_IMODE(path.stat().st_mode) == 0o666 & ~umask
    finally:
        os.umask(before)


def test_only_regular_files_are_replaced(tmp_path, monkeypatch):
    run = fp.solve(case(store="metrics"))
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe")
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("socket")
        Path("null").symlink_to("/dev/null")
        Path("again").symlink_to("pipe")
        for path in ("/dev/null", "/dev/full", "pipe", "socket", "null", "again"):
            before = os.stat(path)
            with pytest.raises(InvalidInput, match="a device, a pipe or a socket"):
                fp.write(run, path)
            after = os.stat(path)
            assert (after.st_mode, after.st_ino, after.st_rdev) == (
                before.st_mode,
                before.st_ino,
                before.st_rdev,
            )


def test_a_link_is_written_through(tmp_path):
    run, there = fp.solve(case(store="metrics")), tmp_path / "store"
    there.mkdir()
    old = there / "old.nc"
    old.write_text("old")
    for name, target in (("near", old), ("far", tmp_path / "near"), ("relative", "store/old.nc")):
        old.write_text("old")
        link = tmp_path / name
        link.symlink_to(target)
        fp.write(run, link)
        assert link.is_symlink()
        assert not old.is_symlink()
        assert fp.read_run(old).identical(run)
        assert [p.name for p in there.iterdir()] == ["old.nc"]


def test_a_link_to_nothing_or_to_itself_is_refused(tmp_path):
    run = fp.solve(case(store="metrics"))
    (tmp_path / "dangling").symlink_to(tmp_path / "none.nc")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "folder").symlink_to(tmp_path)
    for name, words in (("dangling", "which does not exist"), ("loop", "a link to")):
        with pytest.raises(InvalidInput, match=words):
            fp.write(run, tmp_path / name)
    with pytest.raises(InvalidInput, match="this is a directory"):
        fp.write(run, tmp_path / "folder")
    assert replaceable(tmp_path / "folder" / "a.nc") == tmp_path.resolve() / "a.nc"


@pytest.mark.parametrize(
    "name", ["ü" * 120 + ".nc", "a" * 252 + ".nc", "no_suffix", "a." + "b" * 250]
)
def test_names_as_long_as_they_may_be(tmp_path, name):
    run = fp.solve(case(store="metrics"))
    fp.write(run, tmp_path / name)
    assert [p.name for p in tmp_path.iterdir()] == [name]
    assert fp.read_run(tmp_path / name).identical(run)


_ARGUMENTS = (
    "solve --scheme KPSE --beta 0.5 --half-width 100 --spacing 0.01 --integrator exponential -o"
)


def full_disk(folder: Path, most: int | None = None) -> None:
    """Run the command line where the disk does not take the file: one line, status 1, the old file as it was."""
    old = folder / "run.nc"
    old.write_text("old")

    def work() -> int:
        if most is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        return main([*_ARGUMENTS.split(), str(old)])

    status, said = forked(work)  # what it prints and the line of the error
    assert status == 1, said
    assert said.startswith(f"error: cannot write '{old}' (")
    assert said.count("\n") == 1
    assert old.read_text() == "old"
    assert [p.name for p in folder.iterdir()] == ["run.nc"]


def test_a_file_larger_than_it_may_be_is_one_line(tmp_path):
    full_disk(tmp_path, 50_000)


def test_a_full_disk_is_one_line(tmp_path):
    mounted = os.geteuid() == 0 and subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(tmp_path)],
        capture_output=True,
        check=False,
    )
    if not mounted or mounted.returncode:
        pytest.skip("a small disk cannot be mounted")
    try:
        full_disk(tmp_path)
    finally:
        subprocess.run(["umount", str(tmp_path)], check=True)


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
@pytest.mark.parametrize("store", few(["field", "metrics"], 1))
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


@pytest.mark.parametrize("changes", [{"order": 2}, {"scheme": "DPSE"}, {"spacing": 0.123}])
def test_a_file_whose_scalars_are_not_those_of_its_case(tmp_path, changes):
    path, run = tmp_path / "run.nc", fp.solve(case())
    fp.write(run.assign_coords(changes), path)
    with pytest.raises(InvalidInput, match=f"its {next(iter(changes))} is .*Mend the one"):
        fp.read_run(path)


def test_a_file_of_something_else(tmp_path):
    path = tmp_path / "other.nc"
    xr.Dataset({"a": ("t", [1.0, 2.0])}).to_netcdf(path)
    with pytest.raises(InvalidInput, match="a run written by fracparticles"):
        fp.read_run(path)
    with pytest.raises(InvalidInput, match=r"u\(x\) and the coordinates x"):
        initial_strengths(case(), path)


def test_strengths_on_another_lattice(run_file):
    for changes in ({"spacing": 0.125}, {"half_width": 11.0}):
        with pytest.raises(InvalidInput, match=r"u on the .* points of case\.positions"):
            initial_strengths(case(t_initial=1.5, t_final=2.0, **changes), run_file)


def test_strengths_that_are_not_finite(tmp_path):
    c, path = case(), tmp_path / "u.nc"
    u = np.ones(c.particles)
    u[3] = np.nan
    xr.Dataset({"u": ("x", u)}, {"x": c.x}).to_netcdf(path)
    with pytest.raises(InvalidInput, match="finite strengths"):
        initial_strengths(c, path)[0]


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
        initial_strengths(c, path)[0]
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("junk", [None, 1.5, b"run.nc", ["run.nc"]], ids=repr)
def test_what_is_no_path_is_refused(junk):
    with pytest.raises(fp.InvalidInput, match=r"^file (=|is missing).* the path of a file"):
        fp.read_run(junk)


# --- faults ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.02, 0.25, 0.3, 0.5, 0.75, 0.9, 0.9999])
def test_a_changed_bit_is_refused(run_file, share):
    data = bytearray(run_file.read_bytes())
    data[int(share * len(data))] ^= 4
    run_file.write_bytes(data)
    with pytest.raises(InvalidInput, match="it has changed since it was written") as refused:
        fp.read_run(run_file)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("end", [slice(None, -1), slice(None, -64)], ids=["cut", "half"])
@pytest.mark.parametrize("more", [b"", b"\n"], ids=["", "longer"])
def test_a_damaged_digest_is_refused(run_file, end, more):
    """It would not be seen that a number has changed, too."""
    run_file.write_bytes(run_file.read_bytes()[end] + more + more)
    with pytest.raises(InvalidInput, match="it has changed since it was written"):
        fp.read_run(run_file)


@pytest.mark.parametrize("said", ["hello", "[1]", 3], ids=repr)
def test_a_file_whose_case_cannot_be_read_is_no_run(run_file, said):
    fp.read_run(run_file).assign_attrs(case=said).to_netcdf(run_file)
    with pytest.raises(InvalidInput, match=r"^file = .* a run written by fracparticles"):
        fp.read_run(run_file)


def test_another_program_may_change_a_file(run_file):
    """It removes the digest, a last line that the NetCDF libraries do not know."""
    import netCDF4

    assert run_file.read_bytes()[-73:].startswith(b"\nsha256 ")
    with netCDF4.Dataset(run_file, "a") as file:
        file["u"][3] = 1.0
    assert b"sha256 " not in run_file.read_bytes()[-73:]
    assert fp.read_run(run_file).u.values[3] == 1.0


def test_what_a_killed_call_left_is_removed_by_the_next(run_file):
    left = run_file.with_name(".run-0123456789abcdef.nc")
    others = [run_file.with_name(name) for name in (".other-0123456789abcdef.nc", ".run-ab.nc")]
    for path in (left, *others):
        path.write_text("half")
    with replacing(run_file.with_name("other.txt")):  # somebody writes here
        fp.write(fp.solve(case()), run_file)
        assert left.exists()
    fp.write(fp.solve(case()), run_file)
    assert not left.exists()
    assert all(path.exists() for path in others)


def test_an_interrupt_waits_for_the_end_of_a_write():
    """In the middle it may leave the lock of the NetCDF library closed: the next call would wait for ever."""
    handler, done = signal.default_int_handler, []
    before = signal.signal(signal.SIGINT, handler)  # a shell's job in the background ignores it

    def work() -> None:
        with uninterrupted():
            signal.raise_signal(signal.SIGINT)
            done.append(True)
        done.append(False)

    try:
        with pytest.raises(KeyboardInterrupt):
            work()
        assert signal.getsignal(signal.SIGINT) is handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert done == [True]


def test_a_run_needs_no_git(monkeypatch):
    from fracparticles.run.dataset import source

    source.cache_clear()
    monkeypatch.setenv("PATH", "")
    assert source() == f"fracparticles {fp.__version__}"
    source.cache_clear()
