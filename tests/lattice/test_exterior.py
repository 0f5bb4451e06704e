"""The far-field closure against sums over very long lattices, and what it is worth."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.lattice.exterior import far_field
from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.schemes.stability import symbol_range

LONG = 200_000


def weights_of(alpha: float, parity: int):
    """The power by which even or odd weights fall, and the weights."""
    decay = 1.0 + alpha if parity > 0 else alpha

    def weight(m):
        even = (1.0 + np.square(m)) ** (-0.5 * decay)
        return even if parity > 0 else np.sign(m) * even

    return decay, weight


def brute_force(weight, alpha: float, n: int, i: int) -> float:
    """sum_{j = n+1}^{LONG} (n / j)^(1+alpha) w_{i-j}, from the small terms to the large."""
    j = np.arange(LONG, n, -1.0)
    return float(((n / j) ** (1.0 + alpha) * weight(i - j)).sum())


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("parity", [1, -1])
@pytest.mark.parametrize("pad", [0, 7])
def test_exterior_sums(alpha, parity, pad):
    n = 40
    decay, weight = weights_of(alpha, parity)
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


@pytest.mark.parametrize("name", [n for n, s in SCHEMES.items() if "open" in s.exteriors])
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


def expansion(x, alpha, terms):
    """A decaying field that is its own far-field expansion, with coefficients of both signs."""
    return sum(
        c * np.abs(x) ** (-1.0 - k * alpha)
        for k, c in zip(range(1, terms + 1), (1.0, -2.0, 3.0), strict=False)
    )


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("terms", [1, 2, 3])
@pytest.mark.parametrize("parity", [1, -1])
def test_a_field_that_is_the_expansion_is_continued_exactly(alpha, terms, parity):
    n = 40
    decay, weight = weights_of(alpha, parity)
    far = far_field(weight, decay, alpha, n, parity, terms=terms)
    u = expansion(np.where(np.arange(-n, n + 1) == 0, 1.0, np.arange(-n, n + 1)), alpha, terms)
    points = np.array([-n, -7, 0, 11, n])
    y = np.zeros(2 * n + 1)
    far.add(u, y)
    j = np.arange(LONG, n, -1.0)
    beyond = expansion(j, alpha, terms)
    right, left = (np.array([(beyond * weight(i - s * j)).sum() for i in points]) for s in (1, -1))
    # As above: what the long sum lacks, and what Euler-Maclaurin leaves of sums whose powers are higher by 2 alpha.
    cut = 2.0 * float(LONG) ** (-alpha - decay)
    relative = 7.0 / 5760.0 * ((6.0 + (terms - 1) * alpha) / (3.0 * n)) ** 3
    scale = np.abs(expansion(float(n), alpha, 1)) * np.abs(weight(points - j[-1])).max()
    assert np.abs(y[points + n] - right - left).max() <= cut + relative * n * scale + 1e-14


@pytest.mark.parametrize("scheme", ["DD", "FPSE", "KPSE", "GPSE"])
def test_more_terms_of_the_exterior_leave_less_error(scheme):
    """By D^-alpha for each further term; a factor of five is asked at C = 7, where D^-alpha is one thirtieth."""
    given = {"scheme": scheme, "order": 12, "truncation": 7.0, "spacing": 0.1}
    given |= {"dt": None, "integrator": "exponential", "overlap": 3.0}
    if scheme == "GPSE":
        given |= {"order": 2, "dt": 1.0, "integrator": None, "overlap": None}
    one, two, three = (error(**given, far_terms=terms) for terms in (1, 2, 3))
    assert two < 0.2 * one
    assert three < 0.2 * two


@pytest.mark.parametrize("terms", [1, 2, 3])
@pytest.mark.parametrize(("scheme", "order"), [("DD", 4), ("FPSE", 2), ("KPSE", 12), ("GPSE", 2)])
def test_the_terms_of_the_exterior_leave_the_operator_dissipative(scheme, order, terms):
    """No eigenvalue above zero, whatever the terms: the series and the steps stay stable."""
    setting = Setting(n=40, spacing=0.4, alpha=1.5, order=order, exterior="open", far_terms=terms)
    eigenvalues = np.linalg.eigvals(dense_matrix(SCHEMES[scheme].operator(setting)))
    low, high = (setting.rate * edge for edge in symbol_range(scheme, 0.5, order))
    room = 1e-6 * (high - low)
    assert eigenvalues.real.max() <= max(high, 0.0) + room
    assert eigenvalues.real.min() >= low - room
    assert np.abs(eigenvalues.imag).max() <= 1e-8 * (high - low)


def test_terms_are_for_an_open_exterior_on_the_line():
    given = {"scheme": "KPSE", "beta": 0.5, "truncation": 10.0, "spacing": 0.5, "dt": 0.01}
    for wrong in ({"exterior": "truncated"}, {"exterior": "open", "dim": 2}):
        with pytest.raises(InvalidInput, match=r"far_terms.*exterior='open', with dim=1"):
            Case(**given, **wrong, far_terms=2)
    assert "_open3_" in Case(**given, exterior="open", far_terms=3).path


@pytest.mark.parametrize(("n", "terms"), [(0, 1), (1, 2), (2, 3)])
def test_a_lattice_of_too_few_particles_has_no_far_field(n, terms):
    with pytest.raises(InvalidInput, match=f"{terms} particles from its middle"):
        far_field(lambda m: np.abs(m) ** -2.5, 2.5, 1.5, n, terms=terms)
