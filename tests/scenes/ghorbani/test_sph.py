"""The SPH studies: the printed digits, a tiny grid for the rest, and the figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracstudy.claims import Value
from fracstudy.inputs import Inputs
from fracstudy.ledger import judge
from fracstudy.printed import read_claims
from fracstudy.verdicts import Status
from scene_functions import figure, study
from scenes.ghorbani.operators import OPERATORS, order_at
from scenes.ghorbani.sph_closed_forms.non_singular import _memory
from scenes.ghorbani.sph_closed_forms.study import PRINTED as PRINTED_FORMS
from scenes.ghorbani.sph_readings.study import CASES
from scenes.ghorbani.sph_readings.sums import Reading, approximate
from scenes.ghorbani.sph_spline.study import kernel_sums

PRINTED = Path(__file__).parents[3] / "report/printed/ghorbani"
CLAIMS = {claim.id: claim for claim in read_claims(PRINTED)}
VARIABLE = {"mean": 0.5, "amplitude": 0.3, "waves": 4.0}
PAPER = {"length": 5.0, "count": 401, "smoothing_ratio": 1.1}


def run(name, items, **parameters):
    wanted = {key: claim for key, claim in CLAIMS.items() if claim.item in items}
    printed = {key: claim.printed for key, claim in wanted.items() if isinstance(claim, Value)}
    result = study(name)(Inputs("scene", items, printed=printed), **parameters)
    found = {finding.claim: finding for finding in result.findings}
    assert sorted(found) == sorted(wanted)
    return result, found, {key: judge(wanted[key], finding) for key, finding in found.items()}


@pytest.mark.parametrize(
    ("operator", "order", "items"),
    [
        ("caputo", 0.75, ["S-F3"]),
        ("rl_derivative", 0.75, ["S-F4"]),
        ("rl_integral", 0.75, ["S-F5", "S-F6"]),
        ("caputo", VARIABLE, ["S-F7"]),
        ("rl_integral", VARIABLE, ["S-F8", "S-F9"]),
    ],
)
def test_all_six_digits_come_out(operator, order, items):
    _, _, statuses = run("sph_caputo", items, operator=operator, order=order, **PAPER)
    values = {key: status for key, status in statuses.items() if isinstance(CLAIMS[key], Value)}
    assert values
    assert set(values.values()) == {Status.REPRODUCED}


def test_auxiliary_particles_help_the_integral_and_not_every_derivative():
    items = ["S-F5", "S-F6"]
    _, found, _ = run("sph_rl_integral", items, operator="rl_integral", order=0.75, **PAPER)
    ratio = found["S-F6.all_operators"].numbers["ratio"]
    # What spoils the derivative is the ends.
    assert found["S-F6.all_operators"].numbers["inner"] < 1.0
    worse = {case for case, r in ratio.items() if r > 1.0}
    # Where f'(5) is not zero, the integral that is differentiated stops short at x = 5.
    assert worse == {f"RL derivative, {f}" for f in ("sin πx", "exp x", "(x − 1)³")}
    assert found["S-F6.effective"].numbers["l2_ratio"] == ratio["RL integral, sin πx"]


def test_the_operator_figure_is_drawn():
    parameters = {"operator": "rl_derivative", "order": 0.75, **PAPER, "count": 41}
    result, *_ = run("sph_rl_derivative", ["S-F4"], **parameters)
    assert len(result.table) == 12
    drawn = figure("sph_rl_derivative")(result.series, result.table, parameters)
    drawn.draw_without_rendering()
    assert len(drawn.axes) == 8


def test_the_spline_scene():
    parameters = {"smoothing_ratio": 1.1, "ratios": [0.8, 2.5]}
    result, _, statuses = run("sph_spline", ["S-F2"], **parameters)
    assert set(statuses.values()) == {Status.REPRODUCED}
    figure("sph_spline")(result.series, result.table, parameters).draw_without_rendering()


def test_sums_of_the_spline_over_particles():
    # At h = s the spline is the cubic B-spline of the lattice: a partition of unity that reproduces lines.
    for offset in (0.0, 0.3):
        assert kernel_sums(1.0, offset) == pytest.approx((1.0, 1.0), abs=1e-14)


@pytest.fixture(scope="module")
def closed_forms():
    parameters = {"orders": [0.25, 0.75], "variable": VARIABLE, "length": 5.0, "count": 20}
    return run("sph_closed_forms", ["S-APP", "S-DEF"], **parameters)


def test_misprints_among_the_closed_forms_and_definitions(closed_forms):
    _, _, statuses = closed_forms
    exceptions = {key: s for key, s in statuses.items() if s is not Status.REPRODUCED}
    assert exceptions == dict.fromkeys(["S-APP.A8", "S-DEF.4", "S-DEF.6"], Status.MISPRINT)


@pytest.mark.parametrize("order", [0.3, 0.8, -0.4])
def test_the_forms_as_printed_are_those_of_the_library(order):
    x = np.array([0.1, 0.9, 2.5, 5.0])
    for name, pair in {"sin": "A5", "cos": "A6", "exp": "A7", "cubic": "A8"}.items():
        expected = FUNCTIONS[name].rl(x, order)
        assert PRINTED_FORMS[pair](x, order) == pytest.approx(expected, rel=1e-10)
    if order > 0.0:
        for name, pair in {"sin": "A1", "cos": "A2", "exp": "A3", "cubic": "A4"}.items():
            expected = FUNCTIONS[name].caputo(x, order)
            assert PRINTED_FORMS[pair](x, order) == pytest.approx(expected, rel=1e-10)


def test_an_order_that_remembers_is_integrated_exactly_where_it_does_not():
    """Of a constant order the quadrature of other types gives the form (33)."""
    flat = {"mean": 0.6, "amplitude": 0.0, "waves": 1.0}
    gaps = _memory(np.array([0.5, 2.0, 5.0]), flat).numbers["deviation"]
    assert max(gaps.values()) < 1e-10


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_dense_sums_are_those_of_the_package(case):
    operator, name, varies, modified = case
    line = ParticleLine(0.0, 5.0, 81)
    alpha = order_at(VARIABLE if varies else 0.75, line.x_all)
    ours = approximate(line, name, operator, alpha, modified, Reading())
    method = "modified" if modified else "standard"
    f = FUNCTIONS[name].value(line.x_all)
    package = OPERATORS[operator].approximate(line, f, alpha, method=method)
    assert ours == pytest.approx(package, abs=1e-11)


def test_one_reading_only_gives_the_digits():
    parameters = {"order": 0.75, "variable": VARIABLE, **PAPER}
    result, found, statuses = run("sph_readings", ["S-EQ"], **parameters)
    misprints = {key for key, status in statuses.items() if status is Status.MISPRINT}
    names = ("L_inverse", "auxiliary", "double_sum", "caputo_order", "eta", "score")
    assert misprints == {f"S-EQ.{name}" for name in names}
    assert {statuses[key] for key in statuses.keys() - misprints} == {Status.REPRODUCED}
    # The gradient correction is L: as printed it counts twice.
    twice = found["S-EQ.L_inverse"].numbers
    assert 1.0 + twice["printed"] == pytest.approx((1.0 + twice["plain"]) ** 2, abs=1e-9)
    same = result.table.set_index("reading")["figures with the same digits"]
    # The number of auxiliary particles alone is left open by the digits.
    assert set(same.index[same == len(CASES)]) == {
        "that of the digits",
        "(20) with N auxiliary particles",
    }


def test_convergence_on_a_tiny_grid():
    parameters = {"order": 0.75, "variable": VARIABLE, "counts": [41, 81], "shown": 41}
    parameters |= {"length": 5.0, "smoothing_ratio": 1.1}
    result, *_ = run("sph_convergence", [], **parameters)
    assert len(result.table) == 8 * 3
    drawn = figure("sph_convergence")(result.series, result.table, parameters)
    drawn.draw_without_rendering()
    by_sums = result.table.groupby("sums")["L2, s = 0.125"].mean()
    assert by_sums["halved"] < by_sums["standard"]
