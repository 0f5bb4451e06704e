"""Appendix A: the sums of Table A.4, the partial sums of Figs A.10-A.12, the reference values."""

from __future__ import annotations

import csv
import random
from pathlib import Path

import mpmath as mp
import pandas as pd
import pytest
from matplotlib.figure import Figure
from scipy.integrate import quad

from fracparticles.special import mean_radius as closed_form
from fracparticles.special import reduced_green
from fracstudy.inputs import Inputs
from scene_functions import figure
from scenes.lucchesi.fundamental import (
    expansions,
    fundamental_solution,
    inner_moment,
    mean_radius,
    outer_moment,
    split_radius,
)

REFERENCE = Path(__file__).parents[2] / "report/reference/stable_density.csv"


@pytest.mark.parametrize(("alpha", "m"), [(1.3, 1.5), (1.5, 2.0), (1.9, 3.0)])
def test_inner_moment_is_the_integral(alpha, m):
    """(A.7) against quadrature of x L(x): both to some roundings of numbers of order 1."""
    moment, _ = inner_moment(m, alpha)
    assert moment == pytest.approx(
        quad(lambda x: x * reduced_green(x, alpha), 0.0, m)[0], rel=1e-12
    )


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_outer_moment_is_the_integral(alpha):
    """(A.8) at M = 50, where the smallest term is nil; quadrature in v = M / x."""
    m = 50.0
    moment, _ = outer_moment(m, alpha)

    def integrand(v: float) -> float:
        return m * m / v**3 * reduced_green(m / v, alpha)

    assert moment == pytest.approx(quad(integrand, 0.0, 1.0, epsabs=0.0, epsrel=1e-10)[0], rel=1e-9)


@pytest.mark.parametrize("alpha", [1.1, 1.2, 1.5, 1.8, 1.9])
def test_sums_give_the_mean_radius(alpha):
    """Half a digit of the print, 5e-4, is what is claimed; double precision leaves 1e-6 of it."""
    assert split_radius(alpha).radius == pytest.approx(closed_form(alpha), abs=2e-6)


def test_mean_radius_table():
    printed = {"L-TA4.alpha1.5": "1.705"}
    result = mean_radius(Inputs("a4", ["L-TA4"], {"alpha": [1.5, 1.9], "printed": printed}))
    assert list(result.table["printed"].isna()) == [False, True]
    assert [finding.claim for finding in result.findings] == [
        "L-TA4.alpha1.5",
        "L-TA4.alpha1.9",
        "L-TA4.series",
    ]
    assert result.findings[-1].verdict


@pytest.mark.parametrize(("alpha", "item"), [(1.1, "L-FA10"), (1.9, "L-FA12")])
def test_expansions(alpha, item):
    parameters = {
        "alpha": alpha,
        "terms": [1, 5, 20, 80, 320],
        "series_terms": [5, 80],
        "asymptotic_terms": [1, 20],
    }
    result = expansions(Inputs("a", [item], parameters))
    assert [f.claim for f in result.findings] == [
        f"{item}.{n}" for n in ("series", "asymptotic", "overlap")
    ]
    assert all(finding.verdict for finding in result.findings)
    drawn = figure("lucchesi_figure_A10")(result.series, result.table, parameters)
    assert isinstance(drawn, Figure)
    drawn.draw_without_rendering()


def test_too_few_terms_do_not_overlap():
    parameters = {"alpha": 1.5, "terms": [1, 2, 3], "series_terms": [1], "asymptotic_terms": [1]}
    overlap = expansions(Inputs("a", ["L-FA11"], parameters)).findings[-1]
    assert not overlap.verdict
    assert overlap.reason


def test_fundamental_solution(tmp_path):
    reference = pd.read_csv(REFERENCE)
    few = reference[reference["alpha"].isin([1.5])].iloc[::6]
    path = tmp_path / "few.csv"
    few.to_csv(path, index=False)
    parameters = {"reference": str(path), "shown": [1.5]}
    result = fundamental_solution(Inputs("f", parameters=parameters))
    row = result.table.iloc[0]
    assert row["ours, error below"] <= 1e-13
    assert row["scipy, largest error"] > row["ours, error below"]
    drawn = figure("fundamental_solution")(result.series, result.table, parameters)
    drawn.draw_without_rendering()


def _by_series(x: float, alpha: float) -> mp.mpf:
    """(A.1) near 0, (A.2) far away: not the integral that made the file."""
    with mp.workdps(60):
        x, alpha, total = mp.mpf(x), mp.mpf(alpha), mp.mpf(0)
        for m in range(1, 400):
            if x < 2:
                size = mp.gamma(1 + m / alpha) / mp.factorial(m) * x ** (m - 1)
                term = size * mp.sin(mp.pi * m / 2)
            else:
                size = mp.gamma(1 + alpha * m) / mp.factorial(m) * x ** (-alpha * m - 1)
                term = size * mp.sin(mp.pi * alpha * m / 2) * (-1) ** (m + 1)
            total += term / mp.pi
            if size < mp.mpf(10) ** -28 * abs(total):
                return total
        raise AssertionError(f"no convergence at x = {x}, alpha = {alpha}")


def test_reference_values_are_right():
    """A random choice of the points that a series reaches; the file holds 25 digits."""
    with REFERENCE.open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if not 0.6 < float(row["x"]) < 90.0]
    for row in random.Random(3).sample(rows, 40):
        exact = _by_series(float(row["x"]), float(row["alpha"]))
        with mp.workdps(40):
            assert abs(mp.mpf(row["density"]) / exact - 1) < mp.mpf(10) ** -23, row
