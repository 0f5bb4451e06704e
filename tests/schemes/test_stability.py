"""Stability limits: the printed Table 3, closed forms, and the step where power really starts to grow."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fracparticles as fp
from fracparticles.errors import InvalidInput
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.schemes.stability import stability_limit, symbol_range, worst_wave
from fracparticles.time import STEP_POLYNOMIALS
from sweeps import few

# epsilon / h = 2, order II: the infinite lattice, to the digits given.
KNOWN = {
    "DD": (4.8161, 5.2536, 5.4297),
    "FPSE": (7.0511, 8.8354, 10.4894),
    "KPSE": (2.2501, 2.1762, 2.0412),
}
BETAS = (0.1, 0.5, 0.9)


@pytest.mark.parametrize("scheme", KNOWN)
@pytest.mark.parametrize("k", range(3))
def test_known_limits(scheme, k):
    assert round(stability_limit(scheme, BETAS[k]), 4) == pytest.approx(KNOWN[scheme][k], abs=1e-9)


@pytest.mark.parametrize("scheme", KNOWN)
@given(beta=st.floats(0.01, 0.99), overlap=st.floats(2.0, 20.0))
def test_closed_forms_neglect_the_aliases_only(scheme, beta, overlap):
    # The nearest alias, at k = pi s and beyond at the extreme theta s ~ sqrt(2 alpha) <= 2, weighs less than
    # (2 pi s - 2)^2 exp(-(2 pi s - 2)^2 / 4) < 1e-9 for DD and FPSE; for KPSE, whose extreme is theta = pi, the closed
    # form drops 2^beta Gamma(alpha / 2, (pi s / 2)^2) there: exp(-(pi s / 2)^2) = 5e-5 and less.
    rel = 1e-4 if scheme == "KPSE" else 1e-8
    assert stability_limit(scheme, beta, 2, overlap) == pytest.approx(
        SCHEMES[scheme].closed_form_limit(beta, overlap), rel=rel
    )


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("overlap", [2.0, 5.0])
def test_the_worst_wave(alpha, overlap):
    """DD's symbol -theta^alpha exp(-(theta s)^2 / 4) is least at theta s = sqrt(2 alpha), FD's at pi."""
    setting = Setting(alpha=alpha, overlap=overlap)
    assert worst_wave("DD", setting) == pytest.approx(np.sqrt(2.0 * alpha) / overlap, abs=1e-3)
    assert worst_wave("FD", setting) == np.pi


def test_there_is_no_closed_form_for_the_others():
    with pytest.raises(InvalidInput, match="scheme = 'GPSE'"):
        SCHEMES["GPSE"].closed_form_limit(0.5, 2.0)


def test_the_range_holds_the_symbol(combination):
    name, order, _ = combination
    for overlap in few((0.3, 1.0, 2.0, 7.0, 300.0), 3):
        low, high = symbol_range(name, 0.5, order, overlap)
        values = SCHEMES[name].symbol(
            np.linspace(0.0, np.pi, 4001), Setting(alpha=1.5, order=order, overlap=overlap)
        )
        room = 1e-7 * (high - low)
        assert values.min() >= low - room
        assert values.max() <= high + room
        # and it is not too wide: 4001 points come within (spacing of theta s)^2 of the extreme
        assert values.min() <= low + 0.02 * (high - low)


@pytest.mark.parametrize("name", ["DD", "FPSE", "KPSE", "FD"])
@pytest.mark.parametrize("integrator", STEP_POLYNOMIALS)
def test_beyond_the_limit_the_powers_grow(name, integrator):
    p = STEP_POLYNOMIALS[integrator]
    operator = SCHEMES[name].operator(Setting(n=60, spacing=0.1, alpha=1.5))
    eigenvalues = np.linalg.eigvals(dense_matrix(operator)).real
    dt = stability_limit(name, 0.5) * 0.1**1.5 * p.stability_interval / 2.0
    assert np.abs(p(eigenvalues * dt * 0.999)).max() <= 1.0 + 1e-13  # an eigenvalue is zero
    assert np.abs(p(eigenvalues * dt * 1.02)).max() > 1.0


def test_a_green_step_is_stable_whatever_the_overlap():
    """a >= s^alpha, the step of GPSE: |1 + dt A| <= 1."""
    for beta in BETAS:
        for overlap in (1.0, 1.65, 2.0, 2.9, 10.0):
            assert stability_limit("GPSE", beta, 2, overlap) >= overlap ** (1.0 + beta)


def test_numpy_scalars_are_taken():
    expected = stability_limit("KPSE", 0.5, 4, 3.0)
    assert stability_limit("KPSE", np.float64(0.5), np.int64(4), np.int32(3)) == expected
    assert stability_limit("KPSE", np.float32(0.5), 4, np.float32(3.0)) == expected
    assert fp.stability_limit is stability_limit


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        (("kpse", 0.5), "scheme"),
        ((None, 0.5), "scheme"),
        (("KPSE", 1.0), "beta"),
        (("KPSE", 0.0), "beta"),
        (("KPSE", 1e-17), "beta"),
        (("KPSE", float("nan")), "beta"),
        (("KPSE", "0.5"), "beta"),
        (("KPSE", [0.5]), "beta"),
        (("KPSE", None), "beta"),
        (("KPSE", 0.5, 3), "order"),
        (("KPSE", 0.5, True), "order"),
        (("KPSE", 0.5, "4"), "order"),
        (("GPSE", 0.5, 4), "order"),
        (("FPSE", 0.5, 6, 2.0, 2), "order"),
        (("KPSE", 0.5, 6, 2.0, 1, "printed"), "family"),
        (("KPSE", 0.5, 6, 2.0, 1, "other"), "family"),
        (("GPSE", 0.5, 2, 2.0, 1, "printed"), "family"),
        (("KPSE", 0.5, 2, 0.0), "overlap"),
        (("KPSE", 0.5, 2, float("inf")), "overlap"),
        (("KPSE", 0.5, 2, True), "overlap"),
        (("KPSE", 0.5, 2, None), "overlap"),
        (("KPSE", 0.5, 2, 2.0, 4), "dim"),
        (("FD", 0.5, 2, 2.0, 2), "dim"),
    ],
)
def test_refused(arguments, field):
    with pytest.raises(InvalidInput) as refused:
        stability_limit(*arguments)
    assert refused.value.field == field


@pytest.mark.parametrize(
    ("scheme", "beta", "order", "overlap"),
    [("KPSE", 0.999999, 12, 1.0), ("DPSE", 0.5, 4, 0.5), ("KPSE", 1.0 - 1e-12, 4, 0.3)],
)
def test_the_limit_is_zero_where_the_symbol_is_positive(scheme, beta, order, overlap):
    """Whether a kernel of high order at a small overlap amplifies a wave is seen from the symbol on a fine grid."""
    theta = np.linspace(0.01, np.pi, 2000)
    setting = Setting(alpha=1.0 + beta, order=order, overlap=overlap)
    assert SCHEMES[scheme].symbol(theta, setting).max() > 0.0
    assert stability_limit(scheme, beta, order, overlap) == 0.0


# --- where the search for the extremes, and the symbol itself, lose digits -------------------------------------------


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("overlap", [0.6, 1.25, 2.0, 8.0])
@pytest.mark.parametrize("beta", [1e-9, 0.1, 0.5])
def test_round_off_next_to_zero_is_no_growth(order, overlap, beta):
    """DPSE: Phi^(theta) - Phi^(0) was round-off for small theta, times kappa^ ~ theta^(beta-1): a limit of zero."""
    theta = np.geomspace(1e-9, 3.0, 200)
    setting = Setting(alpha=1.0 + beta, order=order, overlap=overlap)
    assert SCHEMES["DPSE"].symbol(theta, setting).max() <= 0.0
    assert stability_limit("DPSE", beta, order, overlap) > 0.1


def test_the_symbol_of_dpse_next_to_zero():
    """To leading order -|theta|^alpha times the second moment of c_m, which is 2 but for the aliases."""
    setting = Setting(alpha=1.5, overlap=2.0)
    symbol = SCHEMES["DPSE"].symbol(np.array([1e-8]), setting)
    assert symbol[0] == pytest.approx(-(1e-8**1.5), rel=1e-9)


def test_a_kernel_with_positive_weights_grows_nowhere():
    """KPSE of order II: next to beta = 1 the range is 1e-9 of what cancels in it at overlap 1/4."""
    low, high = symbol_range("KPSE", 1.0 - 1e-9, 2, 0.25)
    assert high == 0.0
    assert low < 0.0


@pytest.mark.parametrize(("order", "overlap"), [(6, 0.6), (8, 0.6)])
def test_a_bump_between_two_samples_is_found(order, overlap):
    """FPSE, where its two factors change sign close to one another."""
    theta = np.linspace(1e-3, np.pi, 200_001)
    values = SCHEMES["FPSE"].symbol(theta, Setting(alpha=1.9, order=order, overlap=overlap))
    assert values.max() > 0.0
    assert symbol_range("FPSE", 0.9, order, overlap)[1] >= values.max()
    assert stability_limit("FPSE", 0.9, order, overlap) == 0.0


@pytest.mark.parametrize(("dim", "count"), [(2, 400), (3, 60)])
@pytest.mark.parametrize("order", [4, 12])
def test_in_a_box_the_range_holds_a_symbol_that_is_nearly_radial(dim, count, order):
    """The least value lies on a sphere, little less than elsewhere on it."""
    axis = np.linspace(0.0, 2.2, count)
    theta = np.stack(np.meshgrid(*[axis] * dim, indexing="ij"), axis=-1).reshape(-1, dim)
    theta = theta[(np.diff(theta, axis=1) >= 0.0).all(axis=1)]
    values = SCHEMES["DD"].symbol(theta, Setting(alpha=1.5, order=order, overlap=2.0, dim=dim))
    low, _ = symbol_range("DD", 0.5, order, 2.0, dim)
    assert low <= values.min() * (1.0 - 1e-9)
    assert low == pytest.approx(values.min(), rel=2e-3)


def test_overlaps_from_a_quarter_to_a_thousand():
    """Both ends are allowed."""
    for overlap in (0.25, 1000.0):
        low, high = symbol_range("DD", 0.5, 2, overlap)
        assert low < high
    for overlap in (0.2499, 1001.0):
        with pytest.raises(InvalidInput, match=r"0\.25 to 1000"):
            symbol_range("DD", 0.5, 2, overlap)
