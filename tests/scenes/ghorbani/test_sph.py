"""The SPH studies: the printed digits, a tiny grid for the rest, and the figures."""

from __future__ import annotations

from pathlib import Path

import pytest

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracstudy.claims import Status, judge, read_claims
from fracstudy.inputs import Inputs
from scene_functions import figure, study
from scenes.ghorbani.operators import OPERATORS, order_at
from scenes.ghorbani.sph_readings.study import CASES
from scenes.ghorbani.sph_readings.sums import Reading, approximate
from scenes.ghorbani.sph_spline.study import kernel_sums

CLAIMS = {
    claim.id: claim
    for claim in read_claims(Path(__file__).parents[3] / "report/printed/ghorbani.yaml")
}
VARIABLE = {"mean": 0.5, "amplitude": 0.3, "waves": 4.0}
PAPER = {"length": 5.0, "count": 401, "smoothing_ratio": 1.1}


def run(name, items, **parameters):
    printed = {
        key: claim.printed
        for key, claim in CLAIMS.items()
        if claim.item in items and claim.printed is not None
    }
    result = study(name)(Inputs("scene", items, printed=printed), **parameters)
    answered = [finding.claim for finding in result.findings]
    assert sorted(answered) == sorted(key for key, c in CLAIMS.items() if c.item in items)
    statuses = {f.claim: judge(CLAIMS[f.claim], f)[0] for f in result.findings}
    for finding in result.findings:
        assert finding.reason or not statuses[finding.claim].needs_reason
    return result, statuses


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
    _, statuses = run("sph_caputo", items, operator=operator, order=order, **PAPER)
    assert set(statuses.values()) == {Status.REPRODUCED}


def test_the_operator_figure_is_drawn():
    parameters = {"operator": "rl_derivative", "order": 0.75, **PAPER, "count": 41}
    result, _ = run("sph_rl_derivative", ["S-F4"], **parameters)
    assert len(result.table) == 12
    drawn = figure("sph_rl_derivative")(result.series, result.table, parameters)
    drawn.draw_without_rendering()
    assert len(drawn.axes) == 8


def test_the_spline_scene():
    parameters = {"smoothing_ratio": 1.1, "ratios": [0.8, 2.5]}
    result, statuses = run("sph_spline", ["S-F2"], **parameters)
    assert set(statuses.values()) == {Status.REPRODUCED}
    figure("sph_spline")(result.series, result.table, parameters).draw_without_rendering()


def test_sums_of_the_spline_over_particles():
    # At h = s the spline is the cubic B-spline of the lattice: a partition of unity that reproduces lines.
    for offset in (0.0, 0.3):
        assert kernel_sums(1.0, offset) == pytest.approx((1.0, 1.0), abs=1e-14)


def test_the_closed_forms_hold_but_for_a8():
    _, statuses = run(
        "sph_closed_forms", ["S-APP"], orders=[0.25, 0.75], variable=VARIABLE, length=5.0, count=20
    )
    refuted = {claim for claim, status in statuses.items() if status is not Status.REPRODUCED}
    assert refuted == {"S-APP.A8"}


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
    result, statuses = run("sph_readings", ["S-EQ"], **parameters)
    refuted = {claim for claim, status in statuses.items() if status is Status.REFUTED}
    assert refuted == {key for key in CLAIMS if key.startswith("S-EQ.")} - {"S-EQ.consistency"}
    same = result.table.set_index("reading")["figures with the same digits"]
    # The number of auxiliary particles alone is left open by the digits.
    assert set(same.index[same == len(CASES)]) == {
        "that of the digits",
        "(20) with N auxiliary particles",
    }


def test_convergence_on_a_tiny_grid():
    parameters = {"order": 0.75, "variable": VARIABLE, "counts": [41, 81], "shown": 41}
    parameters |= {"length": 5.0, "smoothing_ratio": 1.1}
    result, _ = run("sph_convergence", [], **parameters)
    assert len(result.table) == 8 * 3
    drawn = figure("sph_convergence")(result.series, result.table, parameters)
    drawn.draw_without_rendering()
    by_sums = result.table.groupby("sums")["L2, s = 0.125"].mean()
    assert by_sums["halved"] < by_sums["standard"]
