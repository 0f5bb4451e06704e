"""div(a u) on the lattice: against the derivative in closed form, a dense sum, and what is conserved."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.problems.transport import Transport
from fracparticles.schemes import Setting
from fracparticles.schemes.fpse import divergence_weights


def setting(**fields) -> Setting:
    return Setting(
        **{"alpha": 1.5, "order": 4, "n": 40, "spacing": 0.2, "exterior": "open", **fields}
    )


def test_of_gaussians_it_has_the_order_of_the_kernel():
    for order in (2, 4, 6, 8):
        errors = []
        for n in (80, 160):
            transport = Transport(setting(order=order, n=n, spacing=8.0 / n))
            x = np.arange(-n, n + 1) * 8.0 / n
            (a,) = (np.sin(points[0]) for points in transport.points)
            u = np.exp(-x * x / 2.0)
            exact = -(np.cos(x) - x * np.sin(x)) * u
            errors.append(np.abs(transport.apply(u, [a]) - exact).sum() / n)
        assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.15)


@pytest.mark.parametrize("dim", [1, 2])
@pytest.mark.parametrize("exterior", ["open", "truncated"])
def test_it_is_the_sum_over_pairs(dim, exterior):
    n, one = 9, setting(n=9, dim=dim, exterior=exterior, far_terms=1)
    transport, rng = Transport(one), np.random.default_rng(3)
    u = rng.normal(size=one.shape)
    a = [1.0 + 0.1 * sum(points) ** 2 for points in transport.points]
    total = np.zeros(one.shape)
    for d in range(dim):
        pad = (a[d].shape[d] - (2 * n + 1)) // 2
        lines = np.moveaxis(u, d, -1).reshape(-1, 2 * n + 1)
        speeds = np.moveaxis(a[d], d, -1).reshape(lines.shape[0], -1)
        across = np.arange(-n, n + 1) * 0.2 if dim == 2 else np.zeros(1)
        out = np.zeros_like(lines)
        for row, (line, speed, other) in enumerate(zip(lines, speeds, across, strict=True)):
            places = np.arange(-n - pad, n + pad + 1)
            inside = np.clip(places, -n, n)
            r, end = np.hypot(places * 0.2, other), np.hypot(inside * 0.2, other)
            fall = np.where(places == inside, 1.0, (end / np.where(r > 0, r, 1.0)) ** (dim + 1.5))
            flux = speed * line[inside + n] * fall
            for i in range(-n, n + 1):
                m = i - places
                c = np.sign(m) * divergence_weights(np.abs(m) + 0.0, setting(dim=1))
                own = flux[i + n + pad] if exterior == "truncated" else 0.0
                out[row, i + n] = (c * (flux + own)).sum() / 0.2
        total += np.moveaxis(out.reshape(np.moveaxis(u, d, -1).shape), -1, d)
    # Beyond the reach of the kernel its weights are below 1e-17 of the greatest.
    np.testing.assert_allclose(transport.apply(u, a), total, atol=1e-12)


@pytest.mark.parametrize("dim", [1, 2])
def test_on_a_truncated_lattice_the_mass_stays_to_round_off(dim):
    transport = Transport(setting(n=12, dim=dim, exterior="truncated"))
    rng = np.random.default_rng(5)
    u = rng.random((25,) * dim)
    a = [
        rng.normal(size=np.broadcast_shapes(*map(np.shape, points))) for points in transport.points
    ]
    rate = transport.apply(u, a)
    assert abs(rate.sum()) <= 1e-13 * np.abs(rate).sum()


def test_the_bound_holds_for_the_eigenvalues():
    for order, far_terms in ((2, 1), (4, 3), (12, 1)):
        transport = Transport(setting(order=order, far_terms=far_terms))
        a = [-points[0] for points in transport.points]
        size = 81
        matrix = np.array([transport.apply(column, a) for column in np.eye(size)]).T
        # The ends add a little to the infinite lattice.
        assert np.abs(np.linalg.eigvals(matrix)).max() <= 1.05 * transport.fastest(a)


def test_a_rotation_is_the_same_in_both_coordinates():
    transport = Transport(setting(n=20, dim=2))
    x, y = np.meshgrid(*(np.arange(-20, 21) * 0.2,) * 2, indexing="ij")
    u = np.exp(-((x - 0.6) ** 2) - (y + 0.3) ** 2)
    a = [-transport.points[0][1], transport.points[1][0]]
    turned = np.rot90(transport.apply(np.ascontiguousarray(np.rot90(u)), a), -1)
    np.testing.assert_allclose(transport.apply(u, a), turned, atol=1e-14)
