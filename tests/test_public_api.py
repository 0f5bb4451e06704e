"""`import fracparticles`: every name resolves, and nothing heavy comes before it is needed."""

from __future__ import annotations

import inspect
import json
import subprocess
import sys

import pytest

import fracparticles as fp

HEAVY = {"cyclopts", "matplotlib", "netCDF4", "numba", "pandas", "pyfftw", "scipy", "xarray"}


def imported_by(program: str) -> set[str]:
    """Return the heavy libraries that a program imports."""
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            f"{program}\nimport json, sys\nprint(json.dumps(sorted(sys.modules)))",
        ],
        capture_output=True,
        text=True,
        check=True,
    )
    return HEAVY & set(json.loads(done.stdout.splitlines()[-1]))


@pytest.mark.parametrize("name", fp.__all__)
def test_every_public_name_resolves(name):
    assert getattr(fp, name) is not None
    assert name in dir(fp)


@pytest.mark.parametrize("name", [n for n in fp.__all__ if callable(getattr(fp, n))])
def test_every_public_name_is_documented(name):
    assert inspect.getdoc(getattr(fp, name))


def test_unknown_names_are_refused():
    with pytest.raises(AttributeError, match="has no attribute 'sovle'"):
        fp.sovle  # noqa: B018


def test_the_import_is_light():
    assert imported_by("import fracparticles") == set()


def test_kernels_and_green_need_no_tables_and_no_figures():
    program = (
        "import fracparticles as fp\n"
        "fp.green(1.0, 1.0, 1.5), fp.kernel('K', 1.0, 1.5), fp.mean_radius(1.5)"
    )
    assert imported_by(program) <= {"numba", "scipy"}


def test_a_case_needs_no_tables_and_no_figures():
    program = (
        "import fracparticles as fp\n"
        "fp.Case(scheme='KPSE', beta=0.5, half_width=4.0, spacing=0.1, dt=0.001)"
    )
    assert imported_by(program) <= {"numba", "scipy", "pyfftw"}


def test_a_run_needs_no_figures_and_no_command_line():
    program = (
        "import fracparticles as fp\n"
        "fp.solve(fp.Case(scheme='KPSE', beta=0.5, half_width=4.0, spacing=0.1, dt=0.001))"
    )
    assert not imported_by(program) & {"matplotlib", "cyclopts"}


def test_the_help_of_the_command_line_is_light():
    program = "from fracparticles.run.cli import main\nmain(['--help'])"
    assert imported_by(program) == {"cyclopts"}


def test_errors_are_what_they_say():
    error = fp.InvalidInput("beta", 2.0, "a number between 0 and 1", "Give such a value.")
    assert isinstance(error, ValueError)
    assert isinstance(error, fp.FracparticlesError)
    assert str(error) == ("beta = 2.0 is not allowed: a number between 0 and 1. Give such a value.")
    assert issubclass(fp.NonFiniteSolution, ArithmeticError)
    assert issubclass(fp.StabilityWarning, UserWarning)
