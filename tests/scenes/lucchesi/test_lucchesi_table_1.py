"""Table 1: the operators against the paper's sums over all pairs."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.moving.dvm import DiffusionVelocity
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.variable.closed_forms import Cauchy, exchange_limit
from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_table_1.study import (
    PAIR_SUMS,
    consistency_order,
    diffusion_velocity,
    study,
    velocity_order,
)

_X = np.linspace(-20.0, 20.0, 3201)


def test_every_scheme_is_listed_and_equals_its_sum():
    variable = {"alpha": 1.5, "amplitude": 2.0, "half_width": 20.0, "spacings": [0.025, 0.0125]}
    inputs = Inputs("methods", ["L-T1", "L-COST"])
    result = study(inputs, beta=[0.5], particles=11, spacing=0.3, variable=variable)
    assert list(result.table["referred"]) == [*SCHEMES, "DVM"]
    assert (result.table["equals the sum over pairs"] == "yes").all()
    found = {finding.claim: finding.numbers for finding in result.findings}
    # Sums of eleven terms.
    assert (
        max(found[f"L-T1.{name}"]["difference"] for name in ("DD", "FPSE", "KPSE", "GPSE", "DVM"))
        < 1e-11
    )
    # DD, KPSE and GPSE are one convolution sum each, the schemes of two passes are none.
    assert (
        max(found[f"L-COST.{name}"]["defect"]["beta = 0.5"] for name in ("DD", "KPSE", "GPSE"))
        < 1e-12
    )
    assert min(found[f"L-COST.{name}"]["defect"]["beta = 0.5"] for name in ("DPSE", "FPSE")) > 0.1
    # Beside the pairs of the flux, the divergence needs those within six smoothing lengths: 23 of 128001.
    assert found["L-COST.cheaper"]["localised"] == pytest.approx(23.0 / 128001.0, abs=5e-5)
    # D in the flux, or by the product rule, keeps the second order, less h^2; the mean D of a pair is another equation,
    # (D L u + L(D u) - u L D) / 2, whatever the spacing is.
    assert max(found["L-COST.amenable"]["order"].values()) < 0.1
    u, at = Cauchy.value([_X]), [_X]
    slope = [2.0 * part for part in Cauchy.gradient(at, 2.0)]
    exact = Cauchy.flux_divergence(at, 1.5, 1.0 + 2.0 * u, slope)
    apart = np.abs(exchange_limit(_X, 1.5, 2.0) - exact).max() / np.abs(exact).max()
    assert found["L-COST.complicated"]["error"] == pytest.approx(apart, rel=0.05)
    assert found["L-COST.complicated"]["order"] < 0.2


@pytest.mark.parametrize("name", SCHEMES)
def test_a_sum_tells_a_wrong_operator(name):
    """The comparison can fail: another overlap (for FD another beta) gives another sum."""
    u = np.random.default_rng(0).standard_normal(11)
    r = np.subtract.outer(np.arange(11), np.arange(11)) * 0.3
    ours = SCHEMES[name].operator(Setting(n=5, spacing=0.3, alpha=1.5)).apply(u)
    wrong = Setting(n=5, spacing=0.3, alpha=1.4 if name == "FD" else 1.5, overlap=2.5)
    assert np.abs(PAIR_SUMS[name](u, r, wrong) - ours).max() > 1e-3 * np.abs(ours).max()


def test_the_sum_tells_a_wrong_velocity():
    """It can fail: an overlap off by a tenth changes the velocity."""
    x = 0.3 * np.arange(-5.0, 6.0) ** 3 / 25.0
    strength = 0.3 / (1.0 + x**2)
    ours = DiffusionVelocity(1.5, 2, 0.6)(x, strength)
    right, wrong = (
        diffusion_velocity(x, strength, Setting(n=5, spacing=0.3, alpha=1.5, overlap=overlap))
        for overlap in (2.0, 2.2)
    )
    # Ten terms of round-off, divided by the field.
    assert np.abs(right - ours).max() < 1e-11 * np.abs(ours).max()
    assert np.abs(wrong - ours).max() > 1e-3 * np.abs(ours).max()


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_finite_differences_are_of_first_order(alpha):
    # The next term of the symbol has the order 3 - alpha; at k h = 0.025 and alpha = 1.9 it bends the measured
    # order by (0.025)^0.1 - 0.0125^0.1 in the ratio, which is a few per cent.
    assert consistency_order(alpha) == pytest.approx(1.0, abs=0.05)


def test_the_velocity_of_the_fundamental_solution_is_of_second_order():
    assert velocity_order(1.5) == pytest.approx(2.0, abs=0.05)
