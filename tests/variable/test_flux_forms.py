import warnings
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.setting import Setting
from fracparticles.variable import FORMS, VariableDiffusivity
from fracparticles.variable.closed_forms import Cauchy, Gaussian, Packet, exchange_limit
from sweeps import covering

ALPHA = 1.5


@pytest.fixture
def rng():
    return np.random.default_rng(17)


def lattice(h, half_width, **more):
    return Setting(alpha=ALPHA, n=round(half_width / h), spacing=h, **more)


def bell(points):
    """D = 1 + exp(-|x|^2) / 2 and its gradient."""
    d = 0.5 * np.exp(-sum(part**2 for part in points))
    return 1.0 + d, [-2.0 * part * d for part in points]


def error(form, setting, scale=1.0, field=Cauchy):
    """The greatest error of the manufactured solution u = field(x / scale), D = bell(x / scale)."""
    tail = setting.dim + 1.0 if field is Cauchy else None
    operator = VariableDiffusivity(form, setting, tail=tail)
    at = [part / scale for part in setting.positions]
    d, _ = bell([part / scale for part in operator.points])
    exact = field.flux_divergence(at, ALPHA, *bell(at)) * scale**-ALPHA
    return np.abs(operator.apply(field.value(at), d) - exact).max()


def dense(operator, d):
    shape = operator.setting.shape
    columns = [operator.apply(e.reshape(shape), d).reshape(-1) for e in np.eye(int(np.prod(shape)))]
    return np.array(columns).T


@pytest.mark.parametrize("dim", [1, 2])
@pytest.mark.parametrize("field", [Cauchy, Gaussian])
def test_closed_forms_are_those_of_the_transform(field, dim):
    x = [np.array([0.7]), np.array([-0.4])][:dim]

    def transform(k):
        """That of u over (2 pi)^n, times the surface of the unit sphere: exp(-k), or exp(-k^2 / 4) / sqrt(pi) or 2."""
        if field is Cauchy:
            return mpmath.exp(-k)
        return mpmath.exp(-k * k / 4) / (mpmath.sqrt(mpmath.pi) if dim == 1 else 2)

    r = float(np.sqrt(sum(part**2 for part in x))[0])
    if dim == 1:

        def wave(k, power, odd):
            return (
                k**power
                * mpmath.mpf(transform(k))
                * (mpmath.sin(k * r) if odd else mpmath.cos(k * r))
            )
    else:

        def wave(k, power, odd):
            return k ** (power + 1) * mpmath.mpf(transform(k)) * mpmath.besselj(int(odd), k * r)

    laplacian = -mpmath.quad(lambda k: wave(k, ALPHA, False), [0, 5, 20, 80])
    radial = -mpmath.quad(lambda k: wave(k, ALPHA - 1.0, True), [0, 5, 20, 80])
    assert field.laplacian(x, ALPHA)[0] == pytest.approx(float(laplacian), rel=1e-9)
    for part, component in zip(x, field.gradient(x, ALPHA), strict=True):
        assert component[0] == pytest.approx(float(radial * part[0] / r), rel=1e-9)


@pytest.mark.parametrize("form", ["FPSE", "DD"])
@pytest.mark.parametrize("order", [2, 4, 6, 8, 10, 12])
def test_converges_on_the_line_with_the_order_of_the_kernels(form, order):
    # Nearly one wave, and a diffusivity of the same length. With overlap 2 the aliases of the lattice leave some 1e-9,
    # which is too much for the orders 10 and 12; FPSE smooths twice, and is late to show its order.
    h = {
        "FPSE": {2: 0.04, 4: 0.06, 6: 0.07, 8: 0.07, 10: 0.06, 12: 0.07},
        "DD": {2: 0.06, 4: 0.09, 6: 0.1, 8: 0.1, 10: 0.1, 12: 0.12},
    }[form][order]
    errors = []
    for size in (1.2 * h, h):
        setting = lattice(size, 72.0, order=order, overlap=3.0, exterior="open")
        operator = VariableDiffusivity(form, setting)
        (at,) = setting.positions
        d = 1.0 + 0.5 * np.cos(operator.points[0])
        exact = Packet.flux_divergence([at], ALPHA, 1.0 + 0.5 * np.cos(at), [-0.5 * np.sin(at)])
        errors.append(np.abs(operator.apply(Packet.value([at]), d) - exact).max())
    assert np.log(errors[0] / errors[1]) / np.log(1.2) == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("form", ["FPSE", "DD"])
def test_a_millionth_on_the_line_and_a_ten_thousandth_in_the_plane(form):
    line = lattice(0.05, 40.0, order=12, exterior="open", far_terms=3)
    plane = lattice(0.3, 15.0, order=12, exterior="open", dim=2)
    assert error(form, line) < 1e-6
    assert error(form, plane, 3.0) < 1e-4


@pytest.mark.parametrize(("form", "order"), covering(["FPSE", "DD"], [2, 4, 6]))
def test_converges_in_the_plane_with_the_order_of_the_kernels(form, order):
    h = {2: 0.03, 4: 0.04, 6: 0.04}[order]
    errors = [
        error(form, lattice(size, 4.0, order=order, exterior="open", dim=2), field=Gaussian)
        for size in (1.25 * h, h)
    ]
    assert np.log(errors[0] / errors[1]) / np.log(1.25) == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("exterior", ["truncated", "open"])
@pytest.mark.parametrize("order", [2, 8])
def test_a_constant_diffusivity_gives_the_constant_scheme(form, exterior, order, rng):
    setting = lattice(0.3, 30.0, order=order, exterior=exterior, far_terms=2)
    u = rng.normal(size=setting.shape) / (1.0 + setting.positions[0] ** 2)
    scheme = SCHEMES[FORMS[form]]
    expected = scheme.operator(replace(setting, diffusivity=3.0)).apply(u)
    found = VariableDiffusivity(form, setting).apply(u, 3.0)
    np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize(("form", "dim", "exterior"), [
    ("FPSE", 2, "truncated"), ("DD", 2, "truncated"), ("exchange", 2, "truncated"), ("DD", 2, "open"),
])  # fmt: skip
def test_a_constant_diffusivity_gives_the_constant_scheme_in_the_plane(form, dim, exterior, rng):
    setting = lattice(0.5, 5.0, order=4, exterior=exterior, dim=dim)
    u = rng.normal(size=setting.shape)
    expected = SCHEMES[FORMS[form]].operator(setting).apply(u.reshape(-1)).reshape(u.shape)
    found = VariableDiffusivity(form, setting).apply(u, 1.0)
    np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())


def test_the_flux_from_outside_of_the_plane_is_that_of_the_constant_scheme():
    # Beyond four half-widths nothing is added: 4^(-2 p), p = 3.5, of what the exterior adds, below 1e-2.
    setting = lattice(0.5, 10.0, order=4, exterior="open", dim=2)
    u = (1.0 + sum(part**2 for part in setting.positions)) ** -1.75
    expected = SCHEMES["FPSE"].operator(setting).apply(u.reshape(-1)).reshape(u.shape)
    found = VariableDiffusivity("FPSE", setting).apply(u, 1.0)
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("dim", [1, 2])
def test_fast_sums_are_the_naive_ones(form, dim, rng):
    setting = lattice(0.5, 5.0 if dim == 1 else 2.0, order=4, dim=dim)
    u = rng.normal(size=setting.shape)
    fast, naive = (
        VariableDiffusivity(form, replace(setting, summation=how)) for how in ("fft", "naive")
    )
    d, _ = bell(fast.points)
    expected = naive.apply(u, d)
    np.testing.assert_allclose(fast.apply(u, d), expected, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("form", ["FPSE", "exchange"])
@pytest.mark.parametrize("dim", [1, 2])
def test_the_total_strength_is_invariant(form, dim, rng):
    setting = lattice(0.2, 8.0 if dim == 1 else 4.0, order=4, dim=dim)
    operator = VariableDiffusivity(form, setting)
    u = rng.uniform(size=setting.shape)
    rate = operator.apply(u, bell(operator.points)[0])
    assert operator.conservative
    assert abs(rate.sum()) < 1e-12 * np.abs(rate).sum()


def test_with_an_open_exterior_the_total_changes_by_the_flux_through_the_ends():
    setting = lattice(0.05, 20.0, order=12, exterior="open", far_terms=3)
    operator = VariableDiffusivity("FPSE", setting, tail=2.0)
    (x,) = setting.positions
    rate = operator.apply(Cauchy.value([x]), bell(operator.points)[0]).sum() * setting.spacing
    end = 20.0 + 0.5 * setting.spacing
    through = 2.0 * Cauchy.gradient([np.array([end])], ALPHA)[0][0]  # D = 1 there
    # Half a cell beyond the last particle, up to h^2 / 12 of the second derivative of a flux like x^-alpha.
    assert rate == pytest.approx(
        through, rel=setting.spacing**2 * ALPHA * (ALPHA + 1.0) / 12.0 / end**2
    )


def test_the_exchange_is_symmetric_and_converges_to_another_equation():
    setting = lattice(0.05, 40.0, order=8, exterior="open", far_terms=3)
    operator = VariableDiffusivity("exchange", setting, tail=2.0)
    (x,) = setting.positions
    found = operator.apply(Cauchy.value([x]), 1.0 + 0.5 * Cauchy.value([x]))
    # What is left is D beyond the ends, 1 + 3e-4, and what this adds is 1e-5 there: look at the middle.
    middle = np.abs(x) < 10.0
    assert np.abs(found - exchange_limit(x, ALPHA, 0.5))[middle].max() < 1e-5
    u = Cauchy.value([x])
    other = Cauchy.flux_divergence([x], ALPHA, 1.0 + 0.5 * u, [-x * u * u])
    assert np.abs(found - other).max() > 1e-2  # a thousand times as far
    small = VariableDiffusivity("exchange", lattice(0.4, 6.0, order=4))
    matrix = dense(small, bell(small.points)[0])
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-13 * np.abs(matrix).max())


@pytest.mark.parametrize(
    ("form", "order", "exterior"), covering(FORMS, [2, 4, 12], ["truncated", "open"], together=2)
)
def test_the_spectral_radius_is_an_upper_bound_and_not_far_off(form, order, exterior):
    setting = lattice(0.3, 15.0, order=order, exterior=exterior)
    operator = VariableDiffusivity(form, setting)
    d = 1.0 + 0.9 * np.sin(3.0 * operator.points[0]) * np.exp(-(operator.points[0] ** 2) / 50.0)
    greatest = np.abs(np.linalg.eigvals(dense(operator, d))).max()
    bound = operator.spectral_radius(d)
    assert greatest <= bound <= 4.0 * greatest


@pytest.mark.parametrize("form", FORMS)
def test_the_spectral_radius_is_an_upper_bound_in_the_plane(form):
    operator = VariableDiffusivity(form, lattice(0.5, 4.0, order=4, dim=2))
    x, y = operator.points
    d = 1.0 + 0.9 * np.sin(2.0 * x) * np.cos(y)
    greatest = np.abs(np.linalg.eigvals(dense(operator, d))).max()
    assert greatest <= operator.spectral_radius(d) <= 5.0 * greatest


@pytest.mark.parametrize(("setting", "form", "field"), [
    ({}, "KPSE", "form"),
    ({"diffusivity": 2.0}, "DD", "setting.diffusivity"),
    ({"dim": 3}, "FPSE", "dim"),
    ({"dim": 2, "exterior": "open"}, "exchange", "exterior"),
    ({"order": 3}, "DD", "order"),
])  # fmt: skip
def test_what_there_is_not_is_refused(setting, form, field):
    with pytest.raises(InvalidInput) as refused:
        VariableDiffusivity(form, lattice(0.5, 4.0, **setting))
    assert refused.value.field == field


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("dim", [1, 2])
@pytest.mark.parametrize("exterior", ["truncated", "open"])
def test_the_smallest_lattices(form, dim, exterior):
    if (form, dim, exterior) == ("exchange", 2, "open"):
        return  # there is none
    single = Setting(alpha=ALPHA, n=0, dim=dim, exterior=exterior)
    if exterior == "open":
        with pytest.raises(InvalidInput, match="n = 0"):
            VariableDiffusivity(form, single)
    else:
        assert np.isfinite(VariableDiffusivity(form, single).apply(np.ones((1,) * dim), 1.0)).all()
    three = VariableDiffusivity(form, replace(single, n=1))
    assert np.isfinite(three.apply(np.ones((3,) * dim), 1.0)).all()
    assert np.isfinite(three.spectral_radius(1.0))


@pytest.mark.parametrize("d", [-1.0, np.nan, np.ones(3), "x"])
def test_a_diffusivity_that_is_none_is_refused(d):
    operator = VariableDiffusivity("FPSE", lattice(0.5, 4.0))
    with pytest.raises(InvalidInput) as refused:
        operator.apply(np.ones(operator.setting.shape), d)
    assert refused.value.field == "diffusivity"


@pytest.mark.parametrize("tail", [0.5, (2.0, 2.0, 2.0), np.nan, "x"])
def test_a_tail_that_is_none_is_refused(tail):
    with pytest.raises(InvalidInput, match="tail"):
        VariableDiffusivity("DD", lattice(0.5, 4.0, exterior="open"), tail=tail)
    with pytest.raises(InvalidInput, match="tail"):
        VariableDiffusivity("DD", lattice(0.5, 4.0), tail=2.0)


def test_a_diffusivity_that_varies_at_the_ends_warns():
    operator = VariableDiffusivity("FPSE", lattice(0.5, 20.0, exterior="open"))
    u = np.ones(operator.setting.shape)
    with pytest.warns(AccuracyWarning, match="diffusivity varies"):
        operator.apply(u, 1.0 + 0.5 * np.sin(operator.points[0]))
    settled = VariableDiffusivity("FPSE", lattice(0.5, 20.0, exterior="open"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        settled.apply(u, 1.0 + 0.5 * np.tanh(settled.points[0]))
