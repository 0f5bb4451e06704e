"""A new scheme is one new file: dropped into a copy of the package, it can be run, checked and judged at once."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import fracparticles
from copies import answer, copy_packages
from fracparticles.schemes import ALL_SCHEMES
from test_contributing import FILES

MODULE = FILES["src/fracparticles/schemes/smear.py"]

PROGRAM = """
import json, warnings
import numpy as np
import fracparticles as fp
from fracparticles.run.case import Case
from fracparticles.run.solver import compute
from fracparticles.schemes import SCHEMES, Setting

warnings.simplefilter("ignore")
fields = {"beta": 0.5, "half_width": 40.0, "spacing": 0.25, "integrator": "exponential"}
data = fp.solve(Case(scheme="SMEAR", **fields))
again = compute(Case(scheme="SMEAR", evaluation="stepping", **{**fields, "integrator": "rk2", "dt": 0.005}))
try:
    Case(scheme="SMEAT", **fields)
except fp.InvalidInput as error:
    refused = str(error)
m, s = np.arange(2000.0), Setting(alpha=1.5)
w = SCHEMES["SMEAR"].weights(m, s)
theta = np.array([0.3, 1.0, 3.0])
sums = 2.0 * (w[1:, None] * (np.cos(m[1:, None] * theta) - 1.0)).sum(axis=0)
print(json.dumps({
    "file": fp.__file__,
    "names": list(SCHEMES),
    "limit": fp.stability_limit("SMEAR", 0.5),
    "symbol": float(np.abs(SCHEMES["SMEAR"].symbol(theta, s) - sums).max()),
    "mass": float(data.mass_final / data.mass_initial),
    "error": float(data.relative_l1_error),
    "difference": float(np.abs(again.u - data.u.values).max()),
    "greatest": float(np.abs(data.u).max()),
    "refused": refused,
}))
"""


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> dict:
    """What a program says that runs with a copy of the sources and one file more."""
    copy = tmp_path_factory.mktemp("copy")
    copy_packages(copy)
    (copy / "fracparticles" / "schemes" / "smear.py").write_text(MODULE, encoding="utf-8")
    return answer(copy, PROGRAM)


def test_it_is_found_and_comes_last(found):
    assert found["names"][-1] == "SMEAR"
    assert len(found["names"]) == len(set(found["names"])) == 9


def test_its_symbol_is_derived_from_its_transform(found):
    assert found["symbol"] < 1e-12
    # The lowest value, -s^-alpha (K^(0) - K^(pi)) with s = 2: a = 2 s^alpha.
    assert found["limit"] == pytest.approx(2.0 * 2.0**1.5, rel=1e-3)


def test_a_case_is_solved_with_it(found):
    assert found["mass"] == pytest.approx(1.0, abs=1e-12)
    assert 0.01 < found["error"] < 1.0  # it is no fractional Laplacian
    assert found["difference"] < 1e-4 * found["greatest"]


def test_a_misspelt_name_is_told_of_it(found):
    assert "one of DD, DPSE, " in found["refused"]
    assert "Did you mean 'SMEAR'?" in found["refused"]


_MADE_OF_SOME = (
    "variable",
    "problems",
    "bounded",
)  # forms of an equation that are made of certain schemes


def test_no_other_file_of_the_library_lists_schemes():
    """Nothing to register: a name stands in the module of its scheme, and is read from there."""
    library = Path(fracparticles.__file__).parent
    for path in library.rglob("*.py"):
        if path.parent.name in ("schemes", *_MADE_OF_SOME):
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        texts = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
        assert not texts & set(ALL_SCHEMES), path.name
