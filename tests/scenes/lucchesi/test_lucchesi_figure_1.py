"""Fig. 1: what the study sees in the kernels, and the formulas against quadrature."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from fracparticles.kernels.families import kernel
from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_figure_1.figure import figure
from scenes.lucchesi.lucchesi_figure_1.formulas import formulas
from scenes.lucchesi.lucchesi_figure_1.integrals import (
    from_transform,
    gaussian_integral,
    printed_kernel,
)
from scenes.lucchesi.lucchesi_figure_1.study import study, tail_exponent

ITEMS = ["L-F1", "L-KERNELS", "L-FORMULAS"]
RADII = np.array([0.2, 1.0, 2.5])


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize(
    ("name", "order"), [("kappa", 2), ("kappa", 4), ("E", 2), ("K", 2), ("K", 4)]
)
def test_tail_exponent(name, order, alpha):
    """The next term of kappa and K is smaller by r^-2, of E by r^-alpha: 3e-6 at r = 1e5 and alpha = 1.1."""
    expected = 1.0 - alpha if name == "kappa" else -1.0 - alpha
    assert tail_exponent(name, alpha, order) == pytest.approx(expected, abs=1e-5)


def test_kernels():
    result = study(Inputs("fig", ITEMS), beta=[0.1, 0.5, 0.9], points=401)
    found = {finding.claim: finding for finding in result.findings}
    least = found["L-F1.K_positive.IV"].numbers["least"]
    assert least["beta = 0.5"] > 0.0 > least["beta = 0.9"]
    # It is negative where kappa of order IV rises, since kappa' = -r K.
    monotone = found["L-F1.kappa_monotone"]
    assert max(monotone.numbers["rise"].values()) < 0.0
    rise = next(iter(monotone.others.values()))["rise"]
    assert rise["beta = 0.5"] < 0.0 < rise["beta = 0.9"]
    extrema = found["L-KERNELS.F_single_minimum"]
    assert set(extrema.numbers["extrema"].values()) == {1}
    assert next(iter(extrema.others.values()))["extrema"]["beta = 0.9"] == 3
    drawn = figure(result.series)
    assert len(drawn.axes) == 3
    drawn.draw_without_rendering()


def test_order_four_is_positive_at_small_beta():
    """So the numbers follow the data."""
    result = study(Inputs("fig", ["L-F1"]), beta=[0.1], points=401)
    found = {finding.claim: finding for finding in result.findings}
    assert found["L-F1.K_positive.IV"].numbers["least"]["beta = 0.1"] > 0.0


@pytest.mark.parametrize("slope", [False, True])
def test_the_integral_of_a_gaussian(slope):
    """Against adaptive quadrature, n = 1: int |y|^0.5 exp(-0.7 y^2) cos(x y) dy, or its derivative."""
    for x, ours in zip(RADII, gaussian_integral(0.5, RADII, 1, 0.7, slope), strict=True):

        def integrand(y: float, x: float = x) -> float:
            wave = -y * np.sin(x * y) if slope else np.cos(x * y)
            return 2.0 * np.sqrt(y) * np.exp(-0.7 * y * y) * wave

        assert ours == pytest.approx(
            quad(integrand, 0.0, 10.0, epsabs=1e-12, limit=200)[0], abs=1e-10
        )


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("name", ["kappa", "F", "G"])
def test_printed_kernels_are_those_of_the_library(name, n):
    for order, wide in ((2, None), (4, 0.5)):
        ours = kernel(name, RADII, 1.5, dim=n, order=order)
        np.testing.assert_allclose(printed_kernel(name, RADII, 1.5, n, wide), ours, rtol=1e-12)
        np.testing.assert_allclose(from_transform(name, RADII, 1.5, n, order), ours, rtol=1e-11)


def test_scaled_kernels_follow_from_the_transform():
    """epsilon^-alpha G_epsilon is the inverse transform of -k^alpha eta^(epsilon k)."""
    scaled = 0.5**-1.5 * kernel("G", RADII / 0.5, 1.5) / 0.5
    np.testing.assert_allclose(from_transform("G", RADII, 1.5, 1, epsilon=0.5), scaled, rtol=1e-10)


def test_the_misprints_are_told_from_what_is_right():
    found = {finding.claim: finding.numbers for finding in formulas([0.1, 0.5, 0.9])}
    for claim in ("B11_B13", "B15_B17"):
        numbers = found[f"L-FORMULAS.{claim}"]
        assert min(abs(ratio - 1.0) for ratio in numbers["printed"].values()) > 0.2
        assert max(numbers["intended"].values()) < 1e-12
    assert min(found["L-FORMULAS.B18"]["difference"].values()) > 0.01
    assert max(found["L-FORMULAS.B18"]["intended"].values()) < 1e-12
    fourth = found["L-FORMULAS.24"]
    assert fourth["difference"]["n = 1"] < 0.1 < 3.0 < fourth["difference"]["n = 2"]
    assert max(fourth["intended"].values()) < 0.1
    assert max(found["L-FORMULAS.33"]["printed"].values()) < 1e-3
    # The tail of kappa falls like r^(1-n-beta): n - 1 less than -beta.
    stretched = found["L-KERNELS.stretched"]
    assert stretched["printed"]["n = 3, beta = 0.5"] == pytest.approx(-2.0)
    assert max(map(abs, stretched["intended"].values())) < 1e-6


def test_the_mass_of_g_is_what_its_flux_carries_out():
    """int |G| dr over the line is 4 |min F|: G = F', which changes sign once on each side."""
    r = np.linspace(0.0, 60.0, 60001)
    values = np.abs(kernel("G", r, 1.5))
    mass = 2.0 * (values.sum() - 0.5 * (values[0] + values[-1])) * (r[1] - r[0])
    beyond = 2.0 * abs(kernel("F", 60.0, 1.5))
    assert mass + beyond == pytest.approx(
        -4.0 * kernel("F", np.linspace(0.5, 1.2, 7001), 1.5).min(), rel=1e-6
    )
