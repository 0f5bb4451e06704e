"""The far-field closure against sums over very long lattices, and what it is worth."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.case import Case
from fracparticles.exterior import far_field
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.solver import compute, relative_l1_error

LONG = 2_000_000


def brute_force(weight, alpha: float, n: int, i: int) -> float:
    """sum_{j = n+1}^{LONG} (n / j)^(1+alpha) w_{i-j}, from the small terms to the large."""
    j = np.arange(LONG, n, -1.0)
    return float(((n / j) ** (1.0 + alpha) * weight(i - j)).sum())


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("parity", [1, -1])
@pytest.mark.parametrize("pad", [0, 7])
def test_exterior_sums(alpha, parity, pad):
    n = 40
    decay = 1.0 + alpha if parity > 0 else alpha

    def weight(m):
        even = (1.0 + np.square(m)) ** (-0.5 * decay)
        return even if parity > 0 else np.sign(m) * even

    far = far_field(weight, decay, alpha, n, parity, pad)
    points = np.array([-n - pad, -n, -3, 0, 5, n - 1, n, n + pad])
    exact = np.array([brute_force(weight, alpha, n, i) for i in points])
    # Left out by the brute force: LONG (n / LONG)^(1+alpha) LONG^(-decay) / (alpha + decay). Euler-Maclaurin stops at
    # f': the next term, 7 f''' / 5760 at j = 4 n, is ((1+alpha+decay) / (3 n))^3 7 / 5760 of the summand there, and the
    # sum beyond 4 n is at most about a tenth of the whole.
    cut = LONG * (n / LONG) ** (1.0 + alpha) * float(LONG) ** -decay
    relative = 7.0 / 5760.0 * (6.0 / (3.0 * n)) ** 3
    room = cut + relative * np.abs(exact) + 1e-14
    assert (np.abs(far.right[0, points + n + pad] - exact) <= room).all()
    assert np.array_equal(far.left, parity * far.right[:, ::-1])
    assert far.right.size == 2 * (n + pad) + 1


def test_adding_the_far_field():
    far = far_field(lambda m: 1.0 / (1.0 + m * m), 2.0, 1.5, 10)
    u, y = np.arange(21.0), np.ones(21)
    far.add(u, y)
    assert y == pytest.approx(1.0 + 20.0 * far.right[0] + 0.0 * far.left[0], rel=1e-15)


@pytest.mark.parametrize("name", [n for n, s in SCHEMES.items() if "open" in s.EXTERIORS])
def test_the_open_operator_is_that_of_a_very_wide_lattice(name):
    """A u in the middle of 40 n points, where u beyond n is continued as the closure has it."""
    n, wide, alpha = 50, 20_000, 1.5
    x = np.arange(-wide, wide + 1.0)
    u = (1.0 + x * x) ** -1.25
    inner = slice(wide - n, wide + n + 1)
    outside = np.abs(x) > n
    u[outside] = u[wide + n] * (n / np.abs(x[outside])) ** (1.0 + alpha)
    setting = {"spacing": 1.0, "alpha": alpha}
    expected = SCHEMES[name].operator(Setting(n=wide, **setting)).apply(u)[inner]
    ours = SCHEMES[name].operator(Setting(n=n, exterior="open", **setting)).apply(u[inner])
    # The wide lattice ends too: it lacks u_i sum_{|m| > wide} w_m ~ wide^-alpha / alpha of the exchange.
    room = 2.0 * float(wide) ** -alpha * np.abs(u[inner]) + 1e-9 * np.abs(expected)
    assert (np.abs(ours - expected) <= room).all()


def error(**changes) -> float:
    given = {
        "scheme": "KPSE",
        "order": 4,
        "beta": 0.5,
        "truncation": 20.0,
        "spacing": 0.0111739,
        "dt": 5e-5,
        "exterior": "open",
        **changes,
    }
    solution = compute(Case(**given))
    return relative_l1_error(solution.case, solution.u)


def test_the_reference_problem_with_the_open_exterior():
    """The goals: below 1e-8 at C = 20 and below 1e-7 at C = 10, where the truncated lattice has 1e-3."""
    assert error(truncation=20.0) < 1e-8
    assert error(truncation=10.0) < 1e-7
    assert error(truncation=20.0, exterior="truncated") > 1e-3


@pytest.mark.parametrize(("scheme", "order"), [("DD", 4), ("FPSE", 4), ("KPSE", 2), ("GPSE", 2)])
def test_every_open_scheme_beats_its_truncation(scheme, order):
    given = {"scheme": scheme, "order": order, "truncation": 8.0, "spacing": 0.03}
    given |= {"dt": None} if scheme == "GPSE" else {"dt": None, "integrator": "exponential"}
    assert error(**given) < 0.2 * error(**given, exterior="truncated")
