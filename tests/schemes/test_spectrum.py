"""Where the eigenvalues lie: the Chebyshev series stands on `spectral_interval`."""

from __future__ import annotations

import numpy as np
import pytest

from combinations import case_of
from fracparticles.errors import FracparticlesError
from fracparticles.lattice.operators import ConvolutionOperator
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import (
    dense_matrix,
    eigenvalue_bounds,
    power_iteration,
    scheme_matrix,
    spectral_interval,
)
from fracparticles.schemes.stability import symbol_range
from fracparticles.time import STEP_POLYNOMIALS
from sweeps import covering, few

OVERLAPS = {"GPSE": (1.65, 2.0, 2.9), "FD": (2.0,)}
# FPSE of order IV with overlap 2.9 has a defective eigenvalue near zero: round-off eps splits it by sqrt(eps).
ROUND_OFF = np.sqrt(np.finfo(float).eps)


def test_the_interval_holds_every_eigenvalue_and_all_are_real(combination):
    overlaps = OVERLAPS.get(combination[0], (0.5, 1.0, 1.5, 2.0, 2.9, 4.0, 8.0))
    betas = few((0.02, 0.1, 0.5, 0.9, 0.98), 3)
    for overlap, n, beta in covering(overlaps, (8, 40), betas):
        case = case_of(combination, beta, overlap, n)
        operator = SCHEMES[case.scheme].operator(case.setting)
        low, high = spectral_interval(case.scheme, case.setting, operator, case.steps)
        values = np.linalg.eigvals(dense_matrix(operator))
        room = ROUND_OFF * 10.0 * (high - low)
        assert np.abs(values.imag).max() <= room, (overlap, n, beta)
        assert low - room <= values.real.min(), (overlap, n, beta)
        assert values.real.max() <= high + room, (overlap, n, beta)


@pytest.mark.parametrize("beta", [0.1, 0.9])
def test_the_lowest_eigenvalue_tends_to_the_least_of_the_symbol(combination, beta):
    scheme, order, _ = combination
    if scheme == "PSE29":
        beta = 0.5
    low, high = symbol_range(scheme, beta, order, 2.0)
    gaps = []
    for n in (20, 40, 80):
        operator = SCHEMES[scheme].operator(case_of(combination, beta, 2.0, n).setting)
        lowest = np.linalg.eigvals(dense_matrix(operator)).real.min()
        gaps.append((lowest - low) / (high - low))
    # Sines of half-wavelengths on the lattice miss the extreme by up to pi / (2 n): gap ~ n^-2 at least once n is
    # beyond the layers at the ends.
    assert gaps[2] < 0.02
    assert abs(gaps[2]) <= abs(gaps[0])


def test_a_kernel_that_changes_sign_pushes_an_eigenvalue_below_the_symbol():
    """KPSE of order IV at beta = 0.9 has negative weights: why the shift of the diagonal is needed."""
    case = case_of(("KPSE", 4, "truncated"), 0.9, 4.0, 60)
    operator = SCHEMES["KPSE"].operator(case.setting)
    values = np.linalg.eigvalsh(dense_matrix(operator))
    least = symbol_range("KPSE", 0.9, 4, 4.0)[0]
    assert operator.diagonal_shift[0] < values[0] - least < 0.0
    assert values[0] < least * (1.0 + 1e-3)


def test_positive_weights_need_no_shift():
    for scheme in ("KPSE", "GPSE", "RIESZ"):
        operator = SCHEMES[scheme].operator(Setting(n=40, spacing=1.0, alpha=1.5))
        assert operator.diagonal_shift[0] == 0.0


def test_dense_matrix_of_known_weights():
    w = np.array([[-2.0, 1.0, 0.5], [1.0, -3.0, 1.0], [0.5, 1.0, -2.0]])
    operator = ConvolutionOperator(
        lambda u: np.array([u[1] + 0.5 * u[2], u[0] + u[2], 0.5 * u[0] + u[1]]),
        np.array([-2.0, -3.0, -2.0]),
        None,
    )
    assert np.array_equal(dense_matrix(operator), w)


def test_scheme_matrix_is_the_one_of_its_operator():
    setting = Setting(n=5, spacing=0.3, alpha=1.5)
    u = np.linspace(1.0, 2.0, 11)
    expected = SCHEMES["DD"].operator(setting).apply(u)
    assert np.allclose(scheme_matrix("DD", setting) @ u, expected, rtol=1e-13)
    with pytest.raises(FracparticlesError):
        scheme_matrix("none", setting)


@pytest.mark.parametrize("scheme", ["DD", "KPSE", "FPSE"])
def test_power_iteration_finds_the_eigenvalue_of_greatest_modulus(scheme):
    operator = SCHEMES[scheme].operator(Setting(n=10, spacing=0.1, alpha=1.5))
    value, iterations = power_iteration(operator, tolerance=1e-12)
    least, second = np.sort(np.linalg.eigvals(dense_matrix(operator)).real)[:2]
    # The error falls by q a step, at most (for a symmetric A by q^2): the changes to come are a geometric series.
    q = second / least
    assert value == pytest.approx(least, rel=1e-12 / (1.0 - q**10))
    assert iterations % 10 == 0


def test_power_iteration_says_when_it_fails():
    operator = SCHEMES["KPSE"].operator(Setting(n=40, spacing=0.1, alpha=1.5))
    with pytest.raises(FracparticlesError, match="no convergence within 10 iterations"):
        power_iteration(operator, most=10)


# --- what the ends and a table add -----------------------------------------------------------------------------------


@pytest.mark.parametrize("exterior", ["truncated", "open"])
@pytest.mark.parametrize("scheme", ["DD", "KPSE", "FPSE"])
def test_the_bounds_hold_with_interpolated_kernels(scheme, exterior):
    for table, order, overlap in ((0.1, 2, 3.3), (0.3, 4, 3.3), (1.0, 4, 2.0)):
        setting = Setting(
            n=60, alpha=1.9, order=order, overlap=overlap, exterior=exterior, kernel_table=table
        )
        operator = SCHEMES[scheme].operator(setting)
        low, high = eigenvalue_bounds(scheme, setting, operator)
        values = np.linalg.eigvals(dense_matrix(operator)).real
        room = ROUND_OFF * 10.0 * (high - low)
        assert low - room <= values.min()
        assert values.max() <= high + room


def test_a_coarse_table_makes_fpse_grow():
    setting = Setting(n=60, alpha=1.5, order=4, kernel_table=1.0)
    operator = SCHEMES["FPSE"].operator(setting)
    high = eigenvalue_bounds("FPSE", setting, operator)[1]
    greatest = np.linalg.eigvals(dense_matrix(operator)).real.max()
    assert greatest > 0.01
    assert greatest == pytest.approx(high, rel=0.1)


@pytest.mark.parametrize(("dim", "n"), [(1, 60), (2, 10)])
def test_an_open_exchange_from_a_table_keeps_a_constant(dim, n):
    """The exterior is that of the exact kernels, and the diagonal what both add up to."""
    for table in (None, 0.3):
        setting = Setting(n=n, alpha=1.5, exterior="open", kernel_table=table, dim=dim)
        operator = SCHEMES["KPSE"].operator(setting)
        assert np.linalg.eigvals(dense_matrix(operator)).real.max() <= 1e-8


def test_an_open_exterior_of_fpse_from_a_table_is_that_of_the_exact_kernels():
    exact, table = (
        SCHEMES["FPSE"].operator(Setting(n=60, alpha=1.5, exterior="open", kernel_table=step))
        for step in (None, 1e-3)
    )
    u = 1.0 / (1.0 + np.arange(-60, 61.0) ** 2)
    assert table.apply(u) == pytest.approx(exact.apply(u), abs=1e-12)


def test_a_step_at_the_limit_has_hardly_any_room_below():
    """What is below is amplified by each step; a run of n, by two at most."""
    setting = Setting(n=20, alpha=1.5)
    operator = SCHEMES["KPSE"].operator(setting)
    low = eigenvalue_bounds("KPSE", setting, operator)[0]
    for steps in (10, 10**9):
        z = 2.785293563405282 * spectral_interval("KPSE", setting, operator, steps)[0] / low
        sign, exponent = STEP_POLYNOMIALS["rk4"].log_power(np.array([-z]), steps)
        assert sign[0] > 0.0
        assert exponent[0] <= np.log(2.0)
