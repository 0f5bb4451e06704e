"""The exterior of a square and a cube against sums over the lattice beyond, term by term, and its symmetries."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import mpmath as mp
import numpy as np
import pytest

import fracparticles as fp
from fracparticles.errors import InvalidInput
from fracparticles.lattice.exterior_box import BoxFarField, box_continuation, box_far_field
from fracparticles.lattice.smooth_modes import _next_integral, transforms
from fracparticles.schemes import SCHEMES, Setting

ALPHA = 1.5


def modes(j, n, alpha=ALPHA):
    """phi_1 .. phi_{dim+2} at the lattice points j, shape (dim, ..)."""
    dim = len(j)
    rho = np.sqrt(np.square(j).sum(axis=0)) / n
    tail = rho ** -(dim + alpha)
    return [tail, rho ** -(dim + 2.0 * alpha), *(tail / rho**2 * part / n for part in j)]


def gaussian(theta, s):
    """The symbol of w_m = exp(-|m|^2 / s^2), all aliases: the product of one sum along each axis."""
    m = np.arange(-40, 41)
    return (np.cos(theta[..., None] * m) @ np.exp(-((m / s) ** 2))).prod(axis=-1)


def gaussian_sums(u, s):
    m = np.arange(u.shape[0])
    matrix = np.exp(-np.square(np.subtract.outer(m, m) / s))
    for axis in range(u.ndim):
        u = np.moveaxis(np.tensordot(matrix, u, axes=(1, axis)), 0, axis)
    return u


def exterior_sums(far, dim, n):
    """S_k on the whole lattice, each as the far field adds it."""
    points = (2 * n + 1) ** dim
    alone = BoxFarField(np.arange(dim + 2), np.eye(dim + 2), far.sums)
    sums = np.zeros((dim + 2, points))
    for k, total in enumerate(sums):
        alone.add((np.arange(points) == k).astype(float), total)
    return sums.reshape(dim + 2, *(2 * n + 1,) * dim)


@pytest.mark.parametrize(("dim", "n", "s"), [(2, 12, 2.0), (2, 20, 0.8), (3, 9, 1.5), (3, 12, 0.8)])
def test_the_sums_are_those_over_the_points_outside(dim, n, s):
    """Of a Gaussian weight, which needs no points far away; with s < 1 the aliases are a hundredth."""
    far = box_far_field(partial(gaussian, s=s), partial(gaussian_sums, s=s), ALPHA, n, dim)
    wide = n + 14
    j = np.indices((2 * wide + 1,) * dim) - wide
    outside = np.abs(j).max(axis=0) > n
    inner = (slice(wide - n, wide + n + 1),) * dim
    # The smooth mode is the mode to 1e-9 at the faces; the images of the aliases are 1e-7 for so few points.
    room = 3e-9 if s > 1.0 else 3e-7
    j = np.where(outside, j, n + 1)
    for ours, mode in zip(exterior_sums(far, dim, n), modes(j, n), strict=True):
        expected = gaussian_sums(np.where(outside, mode, 0.0), s)[inner]
        assert np.abs(ours - expected).max() <= room * np.abs(expected).max()


@pytest.mark.parametrize("name", ["DD", "KPSE", "FPSE"])
def test_the_sums_are_the_limit_of_wider_and_wider_cubes(name):
    """In three dimensions. What is beyond a cube of width W adds some W^-(3 + 2 alpha): two widths give the limit."""
    dim, n = 3, 6

    def without_exterior(wide):
        setting = Setting(n=wide, alpha=ALPHA, dim=dim)
        operator = SCHEMES[name].operator(setting)
        j = np.indices((2 * wide + 1,) * dim) - wide
        outside = np.abs(j).max(axis=0) > n
        u = np.where(outside, modes(np.where(outside, j, n + 1), n)[0], 0.0)
        inner = (slice(wide - n, wide + n + 1),) * dim
        return operator.apply(u.ravel()).reshape(u.shape)[inner]

    setting = Setting(n=n, alpha=ALPHA, dim=dim, exterior="open")
    far = SCHEMES[name].operator(setting)._far
    ours = exterior_sums(far, dim, n)[0]
    widths = np.array([24.0, 36.0])
    near, wider = (without_exterior(int(width)) for width in widths)
    ratio = (widths[1] / widths[0]) ** (dim + 2.0 * ALPHA)
    expected = (ratio * wider - near) / (ratio - 1.0)
    assert np.abs(ours - expected).max() <= 2e-5 * np.abs(expected).max()


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("name", ["DD", "FPSE"])
def test_the_far_field_has_the_symmetries_of_the_lattice(name, dim):
    """Turned and mirrored strengths give turned and mirrored sums.

    To the round-off of psi_k in the middle, where it is some thousand times larger than at the faces.
    """
    n = 7
    operator = SCHEMES[name].operator(Setting(n=n, alpha=ALPHA, dim=dim, exterior="open"))
    shape = (2 * n + 1,) * dim

    def added(u):
        y = np.zeros(u.size)
        operator._far.add(np.ascontiguousarray(u).reshape(-1), y)
        return y.reshape(shape)

    u = np.random.default_rng(3).standard_normal(shape)
    y = added(u)
    for axis in range(dim):
        assert np.abs(added(np.flip(u, axis)) - np.flip(y, axis)).max() <= 2e-11 * np.abs(y).max()
        turned = added(np.swapaxes(u, 0, axis))
        assert np.abs(turned - np.swapaxes(y, 0, axis)).max() <= 2e-11 * np.abs(y).max()


@pytest.mark.parametrize("dim", [2, 3])
def test_the_fit_finds_the_modes(dim):
    n = 6
    far = SCHEMES["DD"].operator(Setting(n=n, alpha=ALPHA, dim=dim, exterior="open"))._far
    j = np.indices((2 * n + 1,) * dim).reshape(dim, -1) - n
    u = np.array(modes(j[:, far.boundary], n))
    assert np.abs(far.fit @ u.T - np.eye(dim + 2)).max() <= 1e-11


@pytest.mark.parametrize("name", ["DD", "FPSE"])
@pytest.mark.parametrize("change", [{"kernel_table": 0.01}, {"summation": "naive"}])
def test_the_exterior_does_not_depend_on_how_the_sums_are_done(name, change):
    setting = Setting(n=8, alpha=ALPHA, dim=2, exterior="open")
    exact, other = (
        SCHEMES[name].operator(one)._far for one in (setting, replace(setting, **change))
    )
    assert np.array_equal(exact.sums, other.sums)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("alpha", [1.01, 1.5, 1.99])
def test_the_transforms_of_the_smooth_modes(alpha, dim):
    """Against the exponential integrals by a library of any precision."""
    k = np.array([0.01, 1.0, 7.0, 20.0, 40.0])
    for ours, q in zip(transforms(k, alpha, dim, 30.0), (0.5 * alpha, alpha), strict=True):
        scale = np.pi ** (0.5 * dim) * 30.0**q / float(mp.gamma(0.5 * dim + q))
        expected = [scale * float(mp.expint(1.0 + q, one**2 / 120.0)) for one in k]
        # The recurrence subtracts: what it loses grows with z and with 1 / (alpha - 1).
        assert ours == pytest.approx(expected, rel=1e-13, abs=1e-13 * expected[0])


@pytest.mark.parametrize(("dim", "n"), [(2, 6), (2, 12), (3, 8)])
def test_the_continuation_of_the_modes_is_the_modes(dim, n):
    """A field that is a sum of the modes is what it is continued to, inwards to 3 n / 4."""
    j = np.indices((2 * n + 1,) * dim).reshape(dim, -1) - n
    away = np.abs(j).max(axis=0) > 0
    u = np.zeros((2 * n + 1) ** dim)
    u[away] = np.arange(1.0, dim + 3.0) @ np.array(modes(j[:, away], n))
    places, values = box_continuation(u.reshape((2 * n + 1,) * dim), n, ALPHA)
    assert np.array_equal(np.abs(j[:, places]).max(axis=0), np.full(places.size, round(0.75 * n)))
    assert values == pytest.approx(u[places], rel=1e-11)


@pytest.mark.parametrize("p", [1e-16, 1e-12, 1e-3, 0.0999])
def test_the_exponential_integral_of_a_small_order_keeps_its_digits(p):
    z = np.array([1e-10, 0.01, 0.999, 1.001, 3.0, 36.0])
    exact = np.array([float(mp.expint(1 + mp.mpf(p), float(one))) for one in z])
    assert np.allclose(_next_integral(p, z), exact, rtol=2e-14, atol=0.0)


def test_a_run_as_beta_goes_to_zero():
    def greatest(beta):
        case = fp.Case(
            scheme="DD", dim=3, beta=beta, half_width=4.0, spacing=0.5, exterior="open", integrator="exponential",
            t_initial=0.5, t_final=1.0,
        )  # fmt: skip
        return float(fp.solve(case).u.max())

    assert greatest(2.3e-16) == pytest.approx(greatest(1e-6), rel=1e-5)


def test_a_single_particle_has_no_exterior():
    with pytest.raises(InvalidInput, match="at least 1"):
        box_far_field(lambda theta: theta[..., 0], lambda u: u, 1.5, 0, 2)
