"""Time integration with an error-controlled step: exact solutions of small systems, tolerances, blow-up."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from fracparticles.errors import NonFiniteSolution
from fracparticles.time import steps as steps_of_time
from fracparticles.time.krylov import KrylovStep
from fracparticles.time.stabilised import StabilisedStep, spectral_radius
from fracparticles.time.steps import EighthOrderStep
from sweeps import thorough

N = 60
LAPLACIAN = (np.eye(N, k=1) + np.eye(N, k=-1) - 2.0 * np.eye(N)) * 50.0
DRIFT = (np.eye(N, k=1) - np.eye(N, k=-1)) * 20.0
B = np.sin(np.arange(N))
U0 = np.exp(-0.05 * (np.arange(N) - 30.0) ** 2)


def affine_solution(a: np.ndarray, t: float) -> np.ndarray:
    longer = np.zeros((N + 1, N + 1))
    longer[:N, :N], longer[:N, N] = a, B
    return (expm(t * longer) @ np.append(U0, 1.0))[:N]


@pytest.mark.parametrize(
    "a", [LAPLACIAN, LAPLACIAN + DRIFT, DRIFT], ids=["diffusion", "both", "drift"]
)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-8, 1e-12])
def test_krylov_steps_keep_their_tolerance(a, tolerance):
    steps = KrylovStep(lambda u: a @ u + B, N, tolerance, 0.0, 1.7)
    u = steps.advance(U0, 1.7)
    exact = affine_solution(a, 1.7)
    # Of a run, not of a step; the bound is of round-off at the last tolerance: T |lambda| ulp.
    assert np.linalg.norm(u - exact) <= max(tolerance, 400.0 * 2.0**-52) * np.linalg.norm(exact)
    assert steps.largest == pytest.approx(np.abs(np.linalg.eigvals(a)).max(), rel=0.05)


@pytest.mark.parametrize("unit", [2.0**30, 2.0**60, 2.0**400, 2.0**-60])
def test_krylov_steps_know_no_unit(unit):
    """A v is R(v) less R(0), in which a source of large numbers leaves no digits of a v that is one."""
    tolerance = 1e-8
    steps = KrylovStep(lambda u: LAPLACIAN @ u + unit * B, N, tolerance, 0.0, 1.7)
    exact = affine_solution(LAPLACIAN, 1.7)
    assert np.linalg.norm(
        steps.advance(unit * U0, 1.7) / unit - exact
    ) <= tolerance * np.linalg.norm(exact)


def test_krylov_steps_end_where_the_space_does():
    steps = KrylovStep(lambda u: -2.0 * u, N, 1e-10, 0.0, 3.0)
    np.testing.assert_allclose(steps.advance(U0, 3.0), U0 * np.exp(-6.0), rtol=4e-13)  # e^6 ulps
    assert steps.accepted == 1
    rest = KrylovStep(lambda u: np.zeros(N), N, 1e-10, 0.0, 3.0)
    assert (rest.advance(U0, 3.0) == U0).all()


def forced(t: float, u: np.ndarray) -> np.ndarray:
    """u = cos t + (u0 - 1) exp(-c t) for each c."""
    return -RATES * (u - np.cos(t)) - np.sin(t)


RATES = np.geomspace(1.0, 1e4, N)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5, *[1e-7] * thorough()])
def test_stabilised_steps_of_a_stiff_problem_with_time_in_it(tolerance):
    steps = StabilisedStep(forced, tolerance, tolerance)
    u = steps.advance(np.full(N, 2.0), 2.0)
    exact = np.cos(2.0) + np.exp(-2.0 * RATES)
    assert np.sqrt(np.mean((u - exact) ** 2)) <= tolerance
    assert steps.largest == pytest.approx(1e4, rel=0.05)
    evaluations = steps.accepted * np.sqrt(1e4 * 2.0 / steps.accepted)
    assert evaluations < 0.5 * 2e4 or tolerance < 1e-6  # an explicit method takes about T |lambda|


def test_stabilised_steps_are_of_second_order_in_the_tolerance():
    errors, counts = [], []
    for tolerance in (1e-4, 1e-5, 1e-6):
        steps = StabilisedStep(lambda t, u: -u * u, tolerance, 1e-30)
        u = steps.advance(np.array([1.0, 2.0]), 3.0)
        errors.append(
            np.abs(u / np.array([1.0, 2.0]) * (1.0 + 3.0 * np.array([1.0, 2.0])) - 1.0).max()
        )
        counts.append(steps.accepted)
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.3)


def test_steps_of_order_eight_keep_their_tolerance_over_several_spans():
    steps = EighthOrderStep(lambda t, u: -RATES[:20] * 1e-1 * u, 1e-9, 1e-12)
    u = np.ones(20)
    for k in range(4):
        u = steps.advance(u, 0.25, 0.25 * k)
    np.testing.assert_allclose(u, np.exp(-0.1 * RATES[:20]), atol=1e-8)
    assert steps.accepted >= 4


def test_the_spectral_radius_is_found_and_bounded():
    for a, exact in ((LAPLACIAN, 200.0), (np.diag(-RATES), 1e4), (np.zeros((N, N)), 0.0)):
        rho, _ = spectral_radius(lambda t, u, a=a: a @ u, 0.0, U0, a @ U0)
        assert rho == pytest.approx(exact, rel=0.05, abs=1e-6)


def quadratic(t: float, u: np.ndarray) -> np.ndarray:
    return u * u


@pytest.mark.parametrize("kind", [StabilisedStep, EighthOrderStep])
def test_a_blow_up_says_when(kind):
    steps = kind(quadratic, 1e-5, 1e-5)
    with pytest.raises(NonFiniteSolution, match="without bound near t") as caught:
        steps.advance(np.full(5, 0.4), 10.0, 1.0)  # u = 1 / (2.5 - (t - 1))
    said = float(str(caught.value).split("t = ")[1].split(":")[0])
    # A relative error of u at the first time is 2.5 times as much of the last.
    assert said == pytest.approx(3.5, abs=1e-4)


@pytest.mark.parametrize("kind", [StabilisedStep, EighthOrderStep])
def test_steps_that_would_never_reach_the_end_say_where_they_are(monkeypatch, kind):
    """u' = -sgn u comes to zero at t = 0.2 and is driven across it for ever; none of the steps fails."""
    monkeypatch.setattr(steps_of_time, "_LOOK", 200)
    steps = kind(lambda t, u: -np.sign(u), 1e-4, 1e-7)
    with pytest.raises(
        NonFiniteSolution, match=r"shrunk to .* at t = 0\.2(0\d*)?, .*would not reach t = 2"
    ):
        steps.advance(np.array([0.2, 0.3]), 2.0)


def test_an_exponential_that_overflows_says_so():
    with pytest.raises(NonFiniteSolution, match="grows without bound near t ="):
        KrylovStep(lambda u: 500.0 * u, 5, 1e-8, 0.0, 10.0).advance(np.ones(5), 10.0)
