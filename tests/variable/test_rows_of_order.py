import warnings
from dataclasses import replace

import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.kernels.families import kernel
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.setting import Setting
from fracparticles.variable import VariableOrder
from fracparticles.variable.closed_forms import Cauchy, Packet
from fracparticles.variable.order import (
    _chebyshev_points,
    _lagrange,
    interpolation_bound,
    nodes_needed,
)


def lattice(h, half_width, **more):
    return Setting(alpha=1.5, n=round(half_width / h), spacing=h, **more)


def order_at(points):
    """alpha(x) = 1.5 + 0.3 tanh x, in the plane 1.5 + 0.3 exp(-|x|^2 / 4)."""
    if len(points) == 1:
        return 1.5 + 0.3 * np.tanh(points[0])
    return 1.5 + 0.3 * np.exp(-0.25 * (points[0] ** 2 + points[1] ** 2))


def dense(operator):
    shape = operator.setting.shape
    columns = [operator.apply(e.reshape(shape)).reshape(-1) for e in np.eye(int(np.prod(shape)))]
    return np.array(columns).T


@pytest.mark.parametrize("dim", [1, 2])
@pytest.mark.parametrize("exterior", ["truncated", "open"])
@pytest.mark.parametrize("order", [2, 8])
def test_a_constant_order_gives_direct_differentiation(dim, exterior, order):
    setting = lattice(0.4, 6.0, dim=dim, order=order, exterior=exterior, diffusivity=2.0)
    u = np.random.default_rng(1).normal(size=setting.shape)
    expected = SCHEMES["DD"].operator(setting).apply(u.reshape(-1)).reshape(u.shape)
    found = VariableOrder(setting, 1.5).apply(u)
    np.testing.assert_allclose(found, expected, atol=1e-14 * np.abs(expected).max())


@pytest.mark.parametrize("dim", [1, 2])
@pytest.mark.parametrize(("least", "greatest"), [(1.2, 1.8), (1.01, 1.99), (1.5, 1.50001)])
def test_rows_are_those_of_a_dense_sum_with_one_kernel_each(dim, least, greatest):
    setting = lattice(0.25, 8.0 if dim == 1 else 2.0, dim=dim, order=4)
    rng = np.random.default_rng(2)
    alpha = rng.uniform(least, greatest, size=setting.shape)
    u = rng.normal(size=setting.shape)
    epsilon, volume = setting.overlap * setting.spacing, setting.spacing**dim
    at = np.stack([part.reshape(-1) for part in np.broadcast_arrays(*setting.positions)])
    expected = []
    for x, a in zip(at.T, alpha.reshape(-1), strict=True):
        r = np.sqrt(np.square(at - x[:, None]).sum(axis=0)) / epsilon
        row = kernel("G", r, a, dim=dim, order=4) * volume * epsilon ** (-dim - a)
        expected.append(row @ u.reshape(-1))
    found = VariableOrder(setting, alpha).apply(u).reshape(-1)
    # Kernels are good to 1e-11, relative, and the interpolation is better than that.
    np.testing.assert_allclose(found, expected, atol=2e-11 * np.abs(expected).max())


@pytest.mark.parametrize(("least", "greatest"), [(1.2, 1.8), (1.01, 1.99), (1.4, 1.6)])
def test_the_interpolation_of_the_symbol_is_below_its_bound(least, greatest):
    theta = np.geomspace(1e-8, np.pi, 400)
    alpha = np.linspace(least, greatest, 101)
    exact = theta ** alpha[:, None]
    for nodes in (2, 4, 8, 12):
        chosen = _chebyshev_points(nodes, least, greatest)
        found = _lagrange(chosen, alpha).T @ theta ** chosen[:, None]
        error = np.abs(found - exact).max()
        assert error <= interpolation_bound(nodes, least, greatest) + 1e-13  # of round-off
    nodes = nodes_needed(least, greatest, 1e-12)
    assert interpolation_bound(nodes, least, greatest) <= 1e-12
    assert interpolation_bound(nodes - 1, least, greatest) > 1e-12


@pytest.mark.parametrize("order", [2, 4, 6, 8, 10, 12])
def test_converges_with_the_order_of_the_kernels(order):
    h = {2: 0.04, 4: 0.07, 6: 0.08, 8: 0.1, 10: 0.1, 12: 0.12}[order]
    errors = []
    for size in (1.2 * h, h):
        setting = lattice(size, 72.0, order=order, overlap=3.0, exterior="open")
        (x,) = setting.positions
        alpha = 1.5 + 0.3 * np.sin(x) * np.exp(-((x / 20.0) ** 2))
        found = VariableOrder(setting, alpha).apply(Packet.value([x]))
        errors.append(np.abs(found - Packet.laplacian([x], alpha)).max())
    assert np.log(errors[0] / errors[1]) / np.log(1.2) == pytest.approx(order, abs=0.1)


def test_a_millionth_on_the_line_and_a_ten_thousandth_in_the_plane():
    for setting, scale, tolerance in (
        (lattice(0.05, 40.0, order=12, exterior="open", far_terms=3), 1.0, 1e-6),
        (lattice(0.3, 15.0, order=12, exterior="open", dim=2), 3.0, 1e-4),
    ):
        at = [part / scale for part in setting.positions]
        alpha = order_at(at)
        operator = VariableOrder(setting, alpha, tail=setting.dim + 1.0)
        exact = Cauchy.laplacian(at, alpha) * scale**-alpha
        assert np.abs(operator.apply(Cauchy.value(at)) - exact).max() < tolerance


def test_either_end_has_its_own_tail():
    # The sum over a lattice four times as wide, of the solution that is continued with the orders at the ends.
    setting = lattice(0.5, 15.0, order=4, exterior="open")
    wide = replace(setting, n=40 * setting.n)
    (x,) = wide.positions
    alpha = order_at([x])
    u = (1.0 + x * x) ** -0.5
    inside = np.abs(x) <= 15.0 + 1e-9
    first, last = u[inside][[0, -1]]
    left = first * (15.0 / np.abs(np.where(x == 0.0, 1.0, x))) ** 2.2
    right = last * (15.0 / np.abs(np.where(x == 0.0, 1.0, x))) ** 2.8
    left_alpha, right_alpha = alpha[inside][[0, -1]]
    assert (left_alpha, right_alpha) == pytest.approx((1.2, 1.8), abs=1e-9)
    continued = np.where(inside, u, np.where(x < 0.0, left, right))
    expected = VariableOrder(replace(wide, exterior="truncated"), alpha).apply(continued)[inside]
    found = VariableOrder(setting, alpha[inside]).apply(u[inside])
    # Left out by the wide lattice: 600^(-2 p) of a strength of 0.07 and weights of x^(-1-alpha), below 1e-8.
    np.testing.assert_allclose(found, expected, atol=1e-8)


@pytest.mark.parametrize("exterior", ["truncated", "open"])
@pytest.mark.parametrize(("dim", "order"), [(1, 2), (1, 4), (1, 12), (2, 4)])
def test_the_spectral_radius_is_an_upper_bound_and_not_far_off(dim, order, exterior):
    setting = lattice(0.3 if dim == 1 else 0.5, 12.0 if dim == 1 else 4.0, dim=dim, order=order)
    operator = VariableOrder(replace(setting, exterior=exterior), order_at(setting.positions))
    greatest = np.abs(np.linalg.eigvals(dense(operator))).max()
    assert greatest <= operator.spectral_radius() <= 4.0 * greatest


@pytest.mark.parametrize("alpha", [1.0, 2.0, np.nan, "x", np.full(3, 1.5), [[1.5]]])
def test_an_order_that_is_none_is_refused(alpha):
    with pytest.raises(InvalidInput) as refused:
        VariableOrder(lattice(0.5, 4.0), alpha)
    assert refused.value.field == "alpha"


@pytest.mark.parametrize(("setting", "more", "field"), [
    ({"dim": 3}, {}, "dim"),
    ({"order": 3}, {}, "order"),
    ({}, {"tail": 2.0}, "tail"),
    ({}, {"tolerance": 0.0}, "tolerance"),
    ({"exterior": "open", "far_terms": 2}, {}, "far_terms"),
])  # fmt: skip
def test_what_there_is_not_is_refused(setting, more, field):
    setting = lattice(0.5, 4.0, **setting)
    alpha = np.full(setting.shape, 1.5)
    alpha[setting.n] = 1.6
    with pytest.raises(InvalidInput) as refused:
        VariableOrder(setting, alpha, **more)
    assert refused.value.field == field


def test_an_order_that_varies_at_the_ends_warns():
    setting = lattice(0.5, 20.0, exterior="open")
    (x,) = setting.positions
    with pytest.warns(AccuracyWarning, match="alpha - 1 varies"):
        VariableOrder(setting, 1.5 + 0.3 * np.sin(x))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        VariableOrder(setting, order_at([x]))
    setting = lattice(0.5, 5.0, exterior="open", dim=2)
    x, y = setting.positions
    with pytest.warns(AccuracyWarning, match="along the faces"):
        VariableOrder(setting, 1.5 + 0.2 * np.tanh(4.0 * x) + 0.0 * y)
