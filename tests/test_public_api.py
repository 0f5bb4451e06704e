"""`import fracparticles`: every name resolves, and nothing heavy comes before it is needed."""

from __future__ import annotations

import inspect
import json
import subprocess
import sys

import pytest

import fracparticles as fp
from sweeps import at_once, few

HEAVY = {
    *("cyclopts", "finufft", "matplotlib", "netCDF4", "numba", "pandas", "pydantic", "pyfftw"),
    *("scipy", "xarray"),
}
# Of the libraries that a run needs, what no run on a line needs: numba's functions to be compiled, scipy's packages.
UNNEEDED = {
    *("numba.np.arraymath", "numba.np.arrayobj", "numba.np.linalg"),
    *("scipy.integrate", "scipy.linalg", "scipy.optimize", "scipy.sparse"),
}
WAYS = {
    "GPSE in one step": "scheme='GPSE', dt=1.0, exterior='open', far_terms=3, evaluation='convolution'",
    "DD": "scheme='DD', order=4, dt=0.001",
    "the gamma kernels": "scheme='KPSE', order=8, integrator='exponential', exterior='open'",
    "KPSE": "scheme='KPSE', order=4, dt=0.001, exterior='open'",
    "graded particles": "scheme='GPSE', graded_scale=2.0",
}
CASES = dict(few(WAYS.items()))


def modules_of(program: str) -> set[str]:
    """Return the modules that a program imports."""
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
    return set(json.loads(done.stdout.splitlines()[-1]))


def imported_by(program: str) -> set[str]:
    """Return the heavy libraries that a program imports."""
    return HEAVY & modules_of(program)


@at_once(fp.__all__)
def test_every_public_name_resolves(name):
    assert getattr(fp, name) is not None
    assert name in dir(fp)


@at_once([n for n in fp.__all__ if callable(getattr(fp, n))])
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


def test_the_exact_symbol_and_the_names_of_a_run_need_no_compiler():
    """One process for all: numba takes longer to import than any of them."""
    program = (
        "import numpy as np, fracparticles as fp\n"
        "x = np.linspace(-20.0, 20.0, 400, endpoint=False)\n"
        "fp.evolve(1.0 / (1.0 + x**2), 0.1, 1.5, 1.0)\n"
        "fp.Case, fp.solve, fp.prepare"
    )
    assert not {name.split(".")[0] for name in modules_of(program)} & {"numba", "xarray", "pandas"}


def test_a_case_needs_no_tables_and_no_figures():
    program = (
        "import fracparticles as fp\n"
        "fp.Case(scheme='KPSE', beta=0.5, half_width=4.0, spacing=0.1, dt=0.001)"
    )
    assert imported_by(program) <= {"numba", "pydantic", "pyfftw", "scipy"}


FORKED = """
import json, os, sys
import fracparticles as fp
import numba, pydantic  # what every run needs

cases, unneeded = json.loads(sys.argv[1])
for name, case in cases.items():
    for _ in range(2):  # the first may compile what is not yet in the cache
        if not os.fork():
            fp.solve(eval(f"fp.Case(beta=0.5, half_width=40.0, spacing=0.4, {case})"))
            print(json.dumps([name, sorted(sys.modules)]), flush=True)
            os._exit(not set(unneeded).isdisjoint(sys.modules))
        if os.wait()[1] == 0:
            break
"""


@pytest.fixture(scope="module")
def loaded():
    """What a run has imported, by the case; each in a process of its own."""
    words = [sys.executable, "-c", FORKED, json.dumps([CASES, sorted(UNNEEDED)])]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    return {name: set(modules) for name, modules in map(json.loads, done.stdout.splitlines())}


@pytest.mark.parametrize("case", CASES)
def test_a_run_loads_no_more_of_them_than_it_needs(case, loaded):
    assert not loaded[case] & UNNEEDED


def test_a_run_needs_no_figures_and_no_command_line(loaded):
    for modules in loaded.values():
        assert not modules & {"cyclopts", "finufft", "matplotlib", "netCDF4"}


def test_the_help_of_the_command_line_is_light():
    program = "from fracparticles.command_line.cli import main\nmain(['--help'])"
    assert imported_by(program) == {"cyclopts"}


def test_errors_are_what_they_say():
    error = fp.InvalidInput("beta", 2.0, "a number between 0 and 1", "Give such a value.")
    assert isinstance(error, ValueError)
    assert isinstance(error, fp.FracparticlesError)
    assert (
        str(error)
        == "beta = 2.0 is not allowed. Allowed: a number between 0 and 1. Give such a value."
    )
    assert issubclass(fp.NonFiniteSolution, ArithmeticError)
    assert issubclass(fp.StabilityWarning, UserWarning)
