"""Table A.4: the sums and what they add up to."""

from __future__ import annotations

import pytest
from scipy.integrate import quad

from fracparticles.special import mean_radius, reduced_green
from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_table_A4.study import inner_moment, outer_moment, split_radius, study


@pytest.mark.parametrize(("alpha", "m"), [(1.3, 1.5), (1.5, 2.0), (1.9, 3.0)])
def test_inner_moment_is_the_integral(alpha, m):
    """(A.7) against quadrature of x L(x): both to some roundings of numbers of order 1."""
    moment, _ = inner_moment(m, alpha)
    assert moment == pytest.approx(
        quad(lambda x: x * reduced_green(x, alpha), 0.0, m)[0], rel=1e-12
    )


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_outer_moment_is_the_integral(alpha):
    """(A.8) at M = 50, where the smallest term is zero; quadrature in v = M / x."""
    m = 50.0
    moment, _ = outer_moment(m, alpha)

    def integrand(v: float) -> float:
        return m * m / v**3 * reduced_green(m / v, alpha)

    assert moment == pytest.approx(quad(integrand, 0.0, 1.0, epsabs=0.0, epsrel=1e-10)[0], rel=1e-9)


@pytest.mark.parametrize("alpha", [1.1, 1.2, 1.5, 1.8, 1.9])
def test_sums_give_the_mean_radius(alpha):
    """Half a digit of the print, 5e-4, is what is claimed; double precision leaves 1e-6 of it."""
    assert split_radius(alpha).radius == pytest.approx(mean_radius(alpha), abs=2e-6)


def test_mean_radius_table():
    printed = {"L-TA4.alpha1.5": "1.705"}
    result = study(Inputs("a4", ["L-TA4"], printed=printed), alpha=[1.5, 1.9])
    assert list(result.table["printed"].isna()) == [False, True]
    found = {finding.claim: finding.numbers for finding in result.findings}
    assert found["L-TA4.alpha1.5"]["ours"] == mean_radius(1.5)
    assert max(found["L-TA4.series"]["difference"].values()) <= 1e-6
    moments = found["L-TA4.moments"]
    assert max(*moments["inner"].values(), *moments["outer"].values()) < 2e-6
    assert max(found["L-TA4.unit_mass"]["difference"].values()) < 1e-11
    # Each decade far out has 10^(p - alpha) times the moment p of the one before.
    second = found["L-TA4.second_moment"]
    assert second["second"]["alpha = 1.9"] == pytest.approx(10.0**0.1, rel=1e-5)
    assert second["first"]["alpha = 1.5"] == pytest.approx(10.0**-0.5, rel=1e-5)
