"""Variable diffusivity: which form solves which equation, on the smoke grid."""

from __future__ import annotations

import numpy as np
import pytest

from fracstudy.panels import pick

# Of the runs that of a line only: those of the plane are no more than run by the smoke grid.
PARAMETERS = {"runs": [["FPSE", 1, 12, 0.1]]}
FLUX, MEAN = "div(D grad^beta u)", "(D L u + L(D u) - u L D) / 2"


def errors(result, **values):
    return pick(result.table, dim=1, **values)["error"].to_numpy()


@pytest.mark.parametrize("form", ["FPSE", "DD"])
@pytest.mark.parametrize("order", [2, 4])
def test_flux_and_product_rule_solve_the_equation(result, form, order):
    # The order is reached from below, and the distance from it falls like h^2: extrapolate it from two.
    observed = pick(result.table, dim=1, way=form, order=order)["observed order"].to_numpy()
    assert observed[-1] + (observed[-1] - observed[-2]) / 3.0 == pytest.approx(order, abs=0.1)


def test_exchange_solves_another_equation(result):
    wrong = errors(result, way="exchange", equation=FLUX)
    right = errors(result, way="exchange", equation=MEAN, order=2)
    assert wrong[-1] > 0.08  # what is between the equations stays,
    assert right[-1] < 0.1 * wrong[-1]  # and what is of the particles goes


def test_flux_and_exchange_are_conservative_and_the_product_rule_is_not(result):
    drift = result.table.groupby("way")["drift of the total"].max()
    assert drift["FPSE"] < 1e-12
    assert drift["exchange"] < 1e-12
    assert drift["DD"] > 0.01


def test_the_two_equations_meet_in_proportion_to_2_minus_alpha(result):
    gap = pick(result.series, panel="gap")
    slope = np.diff(np.log(gap["y"])) / np.diff(np.log(gap["x"]))
    assert slope == pytest.approx(1.0, abs=0.05)


def test_a_run_with_a_diffusivity_of_place_and_time_is_exact_to_a_millionth(result):
    runs = pick(result.table, dim=1, equation="u_t = div(D grad^beta u) + f")
    assert (runs["error"] < 1e-6).all()


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 4
