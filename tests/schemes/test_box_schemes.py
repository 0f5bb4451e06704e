"""Two and three dimensions: operators, symbols, the open exterior, and the solutions."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import PAPER_ORDERS, kernel
from fracparticles.kernels.tabulated import tabulated
from fracparticles.run.case import Case
from fracparticles.run.solver import compute
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix, spectral_interval
from fracparticles.schemes.stability import stability_limit, symbol_range
from fracparticles.special import green
from sweeps import covering

BOXED = [
    (name, order)
    for name, scheme in SCHEMES.items()
    for order in scheme.box_orders
    if order in PAPER_ORDERS
]
EPS = np.finfo(float).eps


def box(name: str, order: int, n: int = 6, dim: int = 2, **given):
    return SCHEMES[name].operator(
        Setting(n=n, alpha=1.5, order=order, dim=dim, **{"spacing": 1.0, **given})
    )


@pytest.mark.parametrize(("one", "exterior"), covering(BOXED, ["truncated", "open"]))
def test_fast_against_naive(one, exterior):
    name, order = one
    u = np.random.default_rng(0).standard_normal(13**2)
    fast = box(name, order, exterior=exterior).apply(u)
    naive = box(name, order, exterior=exterior, summation="naive").apply(u)
    assert np.abs(fast - naive).max() <= 1e-13 * np.abs(naive).max()


@pytest.mark.parametrize(("one", "dim"), covering(BOXED, [2, 3]))
def test_a_wave_in_the_middle_sees_the_symbol(one, dim):
    """With a window that varies slowly A u is symbol(theta) u up to the window's scale to the power -2."""
    name, order = one
    n, theta = {2: 80, 3: 24}[dim], np.array([0.9, -0.5, 0.3])[:dim]
    alpha = 1.5
    j = np.indices((2 * n + 1,) * dim) - n
    window = np.exp(-np.square(j / (0.3 * n)).sum(axis=0))
    wave = np.cos(np.tensordot(theta, j, axes=1)) * window
    ours = box(name, order, n=n, dim=dim).apply(wave.ravel()).reshape(wave.shape)
    symbol = SCHEMES[name].symbol(theta, Setting(alpha=alpha, order=order, dim=dim))
    middle = (slice(n - 3, n + 4),) * dim
    assert np.abs(ours - symbol * wave)[middle].max() < 20.0 / (0.3 * n) ** 2 * abs(symbol)


@pytest.mark.parametrize(("name", "order"), BOXED)
def test_conservation_and_symmetry(name, order):
    operator = box(name, order)
    rng = np.random.default_rng(1)
    u = rng.standard_normal(operator.size)
    total = np.abs(operator.apply(u)).sum()
    if SCHEMES[name].conservative:
        assert abs(operator.apply(u).sum()) <= 1e-13 * total
    else:
        assert abs(operator.apply(u).sum()) > 1e-3 * total
    # The square's own symmetry: a rotation by a quarter turn.
    turned = operator.apply(np.rot90(u.reshape(13, 13)).ravel()).reshape(13, 13)
    assert np.abs(turned - np.rot90(operator.apply(u).reshape(13, 13))).max() <= 1e-13 * total


@pytest.mark.parametrize(("one", "exterior"), covering(BOXED, ["truncated", "open"]))
def test_the_spectral_interval_holds_the_spectrum(one, exterior):
    name, order = one
    case = Case(
        scheme=name, order=order, beta=0.5, dim=2, truncation=4.0, spacing=0.9,
        exterior=exterior, **({} if name == "GPSE" else {"integrator": "exponential"}),
    )  # fmt: skip
    operator = SCHEMES[name].operator(case.setting)
    low, high = spectral_interval(case.scheme, case.setting, operator, case.steps)
    eigenvalues = np.linalg.eigvals(dense_matrix(operator))
    # FPSE: its real parts come close to 0 from either side, by the ends of the lattice.
    room = 1e-3 * (high - low)
    assert low - room <= eigenvalues.real.min()
    assert eigenvalues.real.max() <= high + room


@pytest.mark.parametrize(("name", "order"), [("DD", 2), ("FPSE", 4), ("KPSE", 2)])
@pytest.mark.parametrize("dim", [2, 3])
def test_stability_limit(name, order, dim):
    """The radial part decides for DD and FPSE; KPSE's least value lies in the corner, a little lower."""
    line, cube = stability_limit(name, 0.5, order), stability_limit(name, 0.5, order, dim=dim)
    assert cube <= line * (1.0 + 1e-7)
    assert cube == pytest.approx(line, rel=1e-3 if name == "KPSE" else 1e-7)
    theta = np.random.default_rng(2).uniform(-np.pi, np.pi, (2000, dim))
    low, high = symbol_range(name, 0.5, order, 2.0, dim)
    values = SCHEMES[name].symbol(theta, Setting(alpha=1.5, order=order, dim=dim))
    assert low * (1.0 + 1e-7) <= values.min()
    assert values.max() <= high + 1e-12


# --- the open exterior ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("one", "mode"), covering([("DD", 2), ("FPSE", 2), ("FPSE", 4)], [0, 1, 2])
)
def test_the_open_operator_is_that_of_a_very_wide_lattice(one, mode):
    """u is beyond the lattice one of the closure's own modes. Schemes without an exchange sum, which would be cut."""
    name, order = one
    n, wide, dim = 10, 300, 2
    j = (np.indices((2 * wide + 1,) * dim) - wide) / n
    rho = np.maximum(np.sqrt(np.square(j).sum(axis=0)), 0.5)
    u = [rho**-3.5, rho**-5.0, j[0] * rho**-5.5][mode]
    inner = (slice(wide - n, wide + n + 1),) * dim
    shape = (2 * n + 1,) * dim
    ours = box(name, order, n=n, exterior="open").apply(u[inner].ravel()).reshape(shape)
    expected = box(name, order, n=wide).apply(u.ravel()).reshape(u.shape)[inner]
    # Euler-Maclaurin at 3 n stops at the fourth derivative, (2 (n + alpha) / 3 n)^4 / 1000 of a tail of a hundredth;
    # the wide lattice ends at 30 n, which leaves out 30^-(2 + 2 alpha) and less.
    assert np.abs(ours - expected).max() <= 1e-8 * np.abs(expected).max()
    cut = box(name, order, n=n).apply(u[inner].ravel()).reshape(shape)
    assert np.abs(cut - expected).max() > 1e-3 * np.abs(expected).max()


@pytest.mark.parametrize(("scheme", "order"), [("DD", 4), ("FPSE", 4), ("KPSE", 4), ("GPSE", 2)])
def test_the_open_exterior_removes_the_error_at_the_edge(scheme, order):
    """Truncated, the relative error at the edge is of order 1: half of the neighbours are missing there."""

    def edge(exterior):
        given = {} if scheme == "GPSE" else {"integrator": "exponential"}
        case = Case(
            scheme=scheme, order=order, beta=0.5, dim=2, truncation=4.0, spacing=0.15,
            exterior=exterior, **given,
        )  # fmt: skip
        exact = green(case.radius, 1.5, 1.5, 2)
        return np.abs(compute(case).u / exact - 1.0)[0].max()

    assert edge("open") < 0.1 * edge("truncated")


# --- solutions ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scheme", "order"), [("DD", 2), ("DD", 4), ("FPSE", 2), ("KPSE", 4)])
def test_series_against_stepping(scheme, order):
    given = dict(scheme=scheme, order=order, beta=0.5, dim=2, truncation=4.0, spacing=0.45, dt=0.01)
    series = compute(Case(**given)).u
    stepped = compute(Case(**given, evaluation="stepping")).u
    assert np.abs(series - stepped).max() <= 1e-12 * stepped.max()


def peak_on_the_infinite_lattice(scheme, order, dim, h, alpha=1.5, start=0.5, end=1.5):
    """u(0, t_f) of a scheme whose symbol has no aliases: the radial integral of exp(-k^alpha t_0 + A(k) T)."""
    k, step = np.linspace(0.0, np.pi / h, 200001, retstep=True)
    theta = np.zeros((k.size, dim))
    theta[:, 0] = k * h
    setting = Setting(alpha=alpha, order=order, dim=dim)
    growth = SCHEMES[scheme].symbol(theta, setting) * (end - start) / h**alpha
    surface = {2: 2.0 * np.pi, 3: 4.0 * np.pi}[dim]
    spectrum = k ** (dim - 1) * np.exp(-(k**alpha) * start + growth)
    return surface / (2.0 * np.pi) ** dim * spectrum[1:].sum() * step


@pytest.mark.parametrize(
    ("scheme", "order", "dim"),
    [(*each, 2) for each in covering(["DD", "FPSE", "KPSE"], [2, 4])]
    + [("DD", 2, 3), ("KPSE", 4, 3)],
)
def test_the_peak_is_that_of_the_infinite_lattice(scheme, order, dim):
    h = 0.3
    case = Case(
        scheme=scheme, order=order, beta=0.5, dim=dim, truncation=4.0, spacing=h,
        exterior="open", integrator="exponential",
    )  # fmt: skip
    ours = compute(case).u[(case.n,) * dim]
    expected = peak_on_the_infinite_lattice(scheme, order, dim, case.particle_spacing)
    exact = green(0.0, 1.5, 1.5, dim)
    error = abs(expected - exact) / exact
    # The initial spectrum at pi / h is exp(-17); the closure's own error is that of GPSE, 1e-7, but it now continues
    # a solution whose tail is off by the error of the scheme.
    assert error > 1e-3
    assert abs(ours - expected) <= (1e-6 + 0.01 * error) * exact


def test_a_solution_off_the_middle():
    """The far field's dipole: the error of a shifted solution is as small as that of one in the middle."""

    def error(shift):
        case = Case(
            scheme="KPSE", order=4, beta=0.5, dim=2, truncation=5.0, spacing=0.2,
            exterior="open", integrator="exponential",
        )  # fmt: skip

        def at(t):
            return lambda x, y: green(np.hypot(x - shift, y + 0.5 * shift), t, 1.5, 2)

        exact = at(1.5)(*case.positions)
        return np.abs(compute(case, at(0.5)).u - exact).max() / exact.max()

    assert error(1.0) < 3.0 * error(0.0)


def test_the_initial_data_of_a_square():
    case = Case(scheme="DD", beta=0.5, dim=2, truncation=4.0, spacing=1.0, integrator="exponential")
    u = np.exp(-np.square(case.radius))
    from_array = compute(case, u).u
    from_function = compute(case, lambda x, y: np.exp(-x * x - y * y)).u
    assert np.abs(from_array - from_function).max() <= 4.0 * EPS
    with pytest.raises(InvalidInput, match="shape"):
        compute(case, u[0])
    u[2, 3] = np.inf
    with pytest.raises(InvalidInput, match=r"not finite at x = -?[0-9.]+, -?[0-9.]+"):
        compute(case, u)


# --- tables ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["F", "G"])
def test_a_kernel_table(name):
    r = np.linspace(0.0, 9.0, 977)
    exact = kernel(name, r, 1.5, dim=2)
    curvature = (
        np.abs(np.diff(kernel(name, np.linspace(0.0, 9.0, 9001), 1.5, dim=2), 2)).max() / 1e-6
    )
    for step in (0.1, 0.01):
        error = np.abs(tabulated(step)(name, r, 1.5, dim=2) - exact).max()
        assert 0.2 * step**2 / 8.0 * curvature < error <= 1.01 * step**2 / 8.0 * curvature
    points = 0.1 * np.arange(50)
    at_points = tabulated(0.1)(name, points, 1.5, dim=2)
    assert np.abs(at_points - kernel(name, points, 1.5, dim=2)).max() <= 1e-14


def test_tables_are_for_kernels():
    given = {"beta": 0.5, "truncation": 4.0, "spacing": 0.1, "dt": 1e-3, "kernel_table": 0.1}
    for scheme in ("FD", "DVM"):
        with pytest.raises(InvalidInput, match="kernel_table"):
            Case(scheme=scheme, **given)
    with pytest.raises(InvalidInput, match="dim"):
        Case(scheme="DPSE", **{**given, "dim": 2})
