"""DD, FPSE and KPSE with the kernels of order 6 to 12, from the case to the error."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import expm

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import family_of, kernel, kernel_transform
from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solve import solve
from fracparticles.run.solver import compute, prepare
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix, spectral_interval
from fracparticles.schemes.stability import stability_limit, symbol_range
from fracparticles.schemes.transform import lattice_transform
from fracparticles.special.stable import central_mass
from sweeps import covering

EPS = np.finfo(float).eps
HIGH = ("DD", "FPSE", "KPSE")
ORDERS = (6, 8, 12)


def line(scheme: str, order: int, **given) -> Case:
    fields = {"beta": 0.5, "integrator": "exponential", "exterior": "open", **given}
    return Case(scheme=scheme, order=order, **fields)


# --- convergence ----------------------------------------------------------------------------------


def smoothing_error(case: Case) -> float:
    """The error (48) that the kernel alone makes: the solution on a continuum of particles, in Fourier space.

    With t_initial = 0.5 the integrand falls like exp(-k^alpha / 2): 1e-27 at k = 25.
    """
    alpha, epsilon = case.alpha, case.resolved_overlap * case.particle_spacing
    nodes, weights = np.polynomial.legendre.leggauss(800)
    k, weights = 12.5 * (1.0 + nodes), 12.5 * weights
    eta = kernel_transform("eta", epsilon * k, alpha, order=case.order)
    total = kernel_transform("K", 0.0, alpha, order=case.order)
    rate = {
        "DD": k**alpha * eta,
        "FPSE": k**alpha * eta**2,
        "KPSE": alpha
        * epsilon**-alpha
        * (total - kernel_transform("K", epsilon * k, alpha, order=case.order)),
    }[case.scheme]
    change = np.exp(-0.5 * k**alpha) * (np.exp(-rate) - np.exp(-(k**alpha)))
    x = case.x[np.abs(case.x) <= case.error_radius * (1.0 + 1e-12)]
    error = np.cos(np.outer(x, k)) @ (weights * change) / np.pi
    return float(
        case.particle_spacing * np.abs(error).sum() / central_mass(case.error_radius, 1.5, alpha)
    )


@pytest.mark.parametrize("scheme", HIGH)
@pytest.mark.parametrize("order", ORDERS)
def test_convergence_with_the_open_exterior(scheme, order):
    """The error is that of the smoothing, 1 - Q(m, z) ~ h^order, and nothing else.

    Overlap 2.5: the aliases, Q(m, (2.5 pi)^2) at most, are 1e-20. Left are the far field at C = 40, 1e-9, and what
    the initial data hold beyond the wavenumber pi / h.
    """
    errors = []
    for h in (0.3, 0.15):
        case = line(scheme, order, truncation=40.0, spacing=h, overlap=2.5)
        room = 1e-9 + math.exp(-0.5 * (math.pi / h) ** case.alpha)
        errors.append(relative_l1_error(case, compute(case).u))
        assert errors[-1] == pytest.approx(smoothing_error(case), rel=1e-3, abs=room)
    # The next term of the smoothing takes up to half of it at h = 0.3 (FPSE smooths twice).
    assert math.log2(errors[0] / errors[1]) >= order - 2.5


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("scheme", ["DD", "KPSE"])
def test_a_box(scheme, dim):
    """In a box, too, every pair of orders gains."""
    given = {"dim": dim, "half_width": 4.0, "spacing": 0.5, "t_initial": 1.0, "t_final": 2.0}
    errors = []
    for order in (4, 6, 8):
        case = line(scheme, order, **given)
        errors.append(relative_l1_error(case, compute(case).u))
    assert errors[2] < errors[1] < errors[0]


# --- the operator and its spectrum ----------------------------------------------------------------


def on_sixty(scheme: str, order: int, beta: float, overlap: float, exterior: str) -> Case:
    given = {"half_width": 60.0, "spacing": 1.0, "overlap": overlap}
    return line(scheme, order, beta=beta, exterior=exterior, **given)


def outside(case: Case) -> tuple[float, float]:
    """How far the eigenvalues lie outside the interval, and off the real line; relative to its length."""
    operator = SCHEMES[case.scheme].operator(case.setting)
    low, high = spectral_interval(case.scheme, case.setting, operator, case.steps)
    values = np.linalg.eigvals(dense_matrix(operator))
    beyond = max(low - values.real.min(), values.real.max() - high)
    return beyond / (high - low), np.abs(values.imag).max() / (high - low)


@pytest.mark.parametrize(
    ("operator", "order"),
    covering(
        [
            ("DD", "truncated", (1.0, 1.5, 2.0, 2.9, 4.0)),
            ("DD", "open", (1.0, 1.5, 2.0, 2.9, 4.0)),
            ("KPSE", "truncated", (1.0, 1.5, 2.0, 2.9, 4.0)),
            ("KPSE", "open", (1.0, 1.5, 2.0, 2.9, 4.0)),
            ("FPSE", "truncated", (1.5, 2.0)),
            ("FPSE", "open", (1.0, 1.5, 2.0, 2.9, 4.0)),
        ],
        ORDERS,
    ),
)
def test_the_interval_holds_every_eigenvalue_and_all_are_real(operator, order):
    scheme, exterior, overlaps = operator
    for beta, overlap in covering((0.1, 0.5, 0.9), overlaps):
        beyond, imaginary = outside(on_sixty(scheme, order, beta, overlap, exterior))
        # As in test_spectrum: round-off splits a defective eigenvalue by its square root.
        assert max(beyond, imaginary) <= 10.0 * math.sqrt(EPS), (beta, overlap)


@pytest.mark.filterwarnings("ignore::fracparticles.errors.StabilityWarning")  # of those modes
@pytest.mark.parametrize(
    ("order", "overlap"), [(6, 2.9), (8, 2.9), (10, 1.5), (10, 2.9), (12, 3.0)]
)
def test_the_interval_of_fpse_ends_at_an_eigenvalue_above_zero(order, overlap):
    """On a truncated lattice a mode at the ends may grow; the interval holds it, and the run is the exponential."""
    for n in (9, 60):
        given = {"half_width": float(n), "spacing": 1.0, "overlap": overlap}
        given |= {"t_initial": 0.0, "t_final": 1000.0}
        case = line("FPSE", order, exterior="truncated", **given)
        assert outside(case)[0] <= 10.0 * math.sqrt(EPS)
        operator = SCHEMES["FPSE"].operator(case.setting)
        u = np.random.default_rng(1).standard_normal(case.particles)
        run, applications = prepare(case, operator).run(u)
        exact = expm(1000.0 * dense_matrix(operator)) @ u
        # Each term has a round-off, in a recurrence over all; T_k grows by 10 at most, seen in test_spectrum.
        room = 10.0 * applications**1.5 * EPS * max(np.abs(exact).max(), np.abs(u).max())
        assert np.abs(run - exact).max() <= room


@pytest.mark.parametrize("family", [None, "gamma"])
@pytest.mark.parametrize("scheme", HIGH)
@pytest.mark.parametrize("order", [4, 6, 12])
def test_the_operator_in_the_middle_is_the_symbol(scheme, order, family):
    """The kernels in space against those in Fourier space, for a Gaussian that is zero at the ends.

    At m = 0 the operator gives the mean over theta of the symbol times the transform of u. The mean over M angles
    lacks the weights beyond M, which are below M^(-1-alpha).
    """
    n, alpha, angles = 60, 1.5, 2**14
    m = np.arange(-n, n + 1)
    setting = Setting(n=n, spacing=1.0, alpha=alpha, order=order, exterior="open", family=family)
    rate = SCHEMES[scheme].operator(setting).apply(np.exp(-np.square(m / 3.0)))[n]
    theta = 2.0 * np.pi * np.arange(angles) / angles
    theta = np.minimum(theta, 2.0 * np.pi - theta)
    transform = 3.0 * math.sqrt(math.pi) * np.exp(-np.square(1.5 * theta))
    symbol = SCHEMES[scheme].symbol(theta, setting)
    # exp(-(1.5 pi)^2) = 2e-10: the next alias of u.
    assert rate == pytest.approx((symbol * transform).mean(), abs=2e-9)


@pytest.mark.parametrize("dim", [2, 3])
def test_fpse_of_order_4_in_a_box_has_both_families(dim):
    n, alpha, theta = {2: 40, 3: 14}[dim], 1.5, 0.7
    x = np.meshgrid(*(np.arange(-n, n + 1.0),) * dim, indexing="ij")
    wave = (np.cos(theta * x[0]) * np.exp(-sum(np.square(part) for part in x) / n)).reshape(-1)
    rates = {}
    for family in (None, "printed", "gamma"):
        setting = Setting(n=n, spacing=1.0, alpha=alpha, order=4, dim=dim, family=family)
        rates[family] = SCHEMES["FPSE"].operator(setting).apply(wave)
    assert np.array_equal(rates[None], rates["printed"])
    assert not np.allclose(rates["gamma"], rates["printed"], rtol=1e-3)


@pytest.mark.parametrize("scheme", HIGH)
@pytest.mark.parametrize("order", ORDERS)
def test_series_and_stepping_give_the_same(scheme, order):
    given = {"half_width": 20.0, "spacing": 0.25, "integrator": "rk4"}
    limit = line(scheme, order, dt=0.1, **given).largest_stable_step
    runs = [
        compute(line(scheme, order, dt=0.9 * limit, evaluation=evaluation, **given)).u
        for evaluation in ("series", "stepping")
    ]
    # As in test_integrators, of the greatest value.
    assert np.abs(runs[0] - runs[1]).max() <= 1e-12 * np.abs(runs[0]).max()


# --- the families ---------------------------------------------------------------------------------


def test_the_default_family_is_the_papers_as_far_as_it_goes():
    assert [family_of(order) for order in (2, 4, 6, 12)] == ["printed", "printed", "gamma", "gamma"]
    r = np.linspace(0.0, 12.0, 40)
    for name in ("eta", "Phi", "kappa", "F", "G", "K"):
        for function in (kernel, kernel_transform):
            plain, printed, gamma = (
                function(name, r[1:], 1.5, order=4, family=f) for f in (None, "printed", "gamma")
            )
            assert np.array_equal(plain, printed)
            assert np.abs(gamma - printed).max() > 1e-3
            second = [function(name, r[1:], 1.5, family=f) for f in ("printed", "gamma")]
            assert np.array_equal(*second)


@pytest.mark.parametrize("dim", [1, 2])
@pytest.mark.parametrize("order", [6, 12])
def test_the_aliases_of_a_high_order_are_summed_until_they_vanish(order, dim):
    """Poisson's formula: the transform's aliases against the kernel on the lattice, at an overlap with many."""
    overlap = 0.7
    m = np.stack(np.meshgrid(*(np.arange(-12, 13.0),) * dim, indexing="ij"), axis=-1)
    radius = np.sqrt(np.square(m).sum(axis=-1))
    theta = np.full(dim, 0.9)
    weights = kernel("eta", radius / overlap, 1.5, dim=dim, order=order)
    direct = float((weights * np.cos(m @ theta)).sum()) / overlap**dim
    at = theta if dim == 1 else theta[None]
    setting = Setting(alpha=1.5, order=order, overlap=overlap, dim=dim)
    aliases = float(lattice_transform("eta", at, setting)[0])
    assert aliases == pytest.approx(direct, abs=1e-13)


def test_a_given_family_is_kept_in_the_data_set():
    given = {"half_width": 8.0, "spacing": 0.5}
    named = solve(line("KPSE", 4, kernel_family="gamma", **given))
    assert named.kernel_family.item() == "gamma"
    assert named.kernel_family.attrs["long_name"] == "family of the kernels"
    assert "kernel_family" not in solve(line("KPSE", 6, **given)).coords
    twin = solve(line("KPSE", 6, kernel_family="gamma", **given))
    assert np.array_equal(twin.u, solve(line("KPSE", 6, **given)).u)


def test_a_table_of_the_family():
    given = {"half_width": 8.0, "spacing": 0.25, "overlap": 2.1, "order": 4, "beta": 0.5}
    given |= {"scheme": "DD", "integrator": "exponential", "kernel_family": "gamma"}
    exact, table = (compute(Case(**given, **extra)).u for extra in ({}, {"kernel_table": 1e-3}))
    # step^2 max|G''| / 8 of G, and 100 significant weights.
    assert 0.0 < np.abs(exact - table).max() < 1e-4


def test_the_limit_of_a_family():
    assert stability_limit("DD", 0.5, 4, family="printed") == stability_limit("DD", 0.5, 4)
    assert stability_limit("DD", 0.5, 4, family="gamma") != stability_limit("DD", 0.5, 4)
    assert symbol_range("KPSE", 0.5, 12)[0] < symbol_range("KPSE", 0.5, 6)[0]


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("family", {"order": 6, "family": "printed"}),
        ("family", {"order": 4, "family": "Gamma"}),
        ("family", {"name": "E", "family": "gamma"}),
        ("order", {"name": "E", "order": 6}),
        ("order", {"order": 14}),
    ],
)
def test_refused(field, arguments):
    given = {"name": "K", "alpha": 1.5, **arguments}
    with pytest.raises(InvalidInput, match=f"^{field} = "):
        kernel(r=1.0, **given)
    with pytest.raises(InvalidInput, match=f"^{field} = "):
        kernel_transform(k=1.0, **given)
