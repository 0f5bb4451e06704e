"""Problems beyond one Fourier transform: peers have the orders of their theory, contests know their answers."""

from __future__ import annotations

from functools import partial

import numpy as np
import pandas as pd
import pytest
from mpmath import mp
from numpy.testing import assert_allclose
from scipy.special import gamma

from fracparticles.bounded.interval_jacobi import jacobi_eigenvalues
from fracparticles.run.orders import observed_order
from fracparticles.schemes.riesz import potential_constant
from fracparticles.special import green
from fracparticles.variable.closed_forms import Cauchy, Gaussian
from fracstudy.inputs import Inputs
from fracstudy.ledger_text import COLUMNS
from fracstudy.lookup import LookUps
from fracstudy.scene import call
from scene_functions import measured, scenes
from scenes.run_times.problem_times.benchmark import CONTESTS
from scenes.run_times.problem_times.blob_peers import Circle, on_circle, on_elements
from scenes.run_times.problem_times.contest import OURS
from scenes.run_times.problem_times.interval_peers import (
    difference_eigenvalue,
    difference_solution,
    element_eigenvalue,
    element_solution,
    getoor,
    graded_mesh,
    stiffness,
)
from scenes.run_times.problem_times.line_peers import (
    centred_weights,
    differences,
    integrated,
    pseudo_spectral,
    rational,
)
from scenes.run_times.problem_times.study import FIRST, study

ALPHA = 1.5
SCENE = scenes()["problem_times"]


@pytest.fixture(scope="module")
def frame():
    return measured(call(SCENE.function("benchmark"), **SCENE.benchmark))


# --- peers on the line ----------------------------------------------------------------------------


@pytest.mark.parametrize("power", [-0.5, 1.5])
def test_the_weights_are_the_fourier_coefficients_of_the_symbol(power):
    """A sum over m of g_m cos(m theta) falls like m^(-1-power): of 1.5 the cut leaves 2000^-1.5, of -0.5 hardly falls.

    So the weights are compared with the quadrature of the integral instead, in t^2 = theta for the singular one.
    """
    t, w = np.polynomial.legendre.leggauss(400)
    t, w = 0.5 * (t + 1.0) * np.pi**0.25, 0.5 * w * np.pi**0.25
    theta, weight = t**4, 4.0 * t**3 * w  # theta^power dtheta is smooth in t
    symbol = (2.0 * np.sin(0.5 * theta)) ** power
    exact = [(symbol * np.cos(m * theta)) @ weight / np.pi for m in range(20)]
    assert_allclose(centred_weights(power, 20), exact, atol=1e-13)


def right_hand_side(x):
    bell = Gaussian.value([x])
    return Gaussian.flux_divergence([x], ALPHA, 1.0 + 0.5 * bell, [-x * bell])


def diffusivity(x):
    return 1.0 + 0.5 * np.exp(-x * x)


def test_differences_are_of_second_order_and_upwind_ones_of_first():
    spacings, found = [0.1, 0.05, 0.025], []
    for h in spacings:
        x, rate = differences(ALPHA, 6.0, h, diffusivity, None)
        found.append(np.abs(rate(0.0, np.exp(-x * x)) - right_hand_side(x)).max())
    assert_allclose(observed_order(spacings, found), 2.0, atol=0.1)
    for upwind, order in ((False, 2.0), (True, 1.0)):
        found = []
        for h in spacings:
            x, rate = differences(ALPHA, 6.0, h, None, np.negative, upwind=upwind)
            bell = np.exp(-x * x)
            exact = Gaussian.laplacian([x], ALPHA) + (1.0 - 2.0 * x * x) * bell
            found.append(np.abs(rate(0.0, bell) - exact).max())
        assert_allclose(observed_order(spacings, found)[-1], order, atol=0.1)


def test_differences_of_a_constant_diffusivity_are_a_toeplitz_matrix():
    x, rate = differences(ALPHA, 2.0, 0.5, None, None)
    weights = -(0.5**-ALPHA) * centred_weights(ALPHA, x.size)
    for k, column in enumerate(np.eye(x.size)):
        expected = weights[np.abs(np.arange(x.size) - k)]
        assert_allclose(rate(0.0, column), expected, atol=1e-13)


def test_the_error_of_the_circle_is_that_of_the_images():
    """An image at distance 2 L adds C m / (2 L)^(1+alpha), m the mass: L four times as wide, 4^2.5 = 32 times less."""
    widths, found = [10.0, 40.0, 160.0], []
    for half in widths:
        x, rate = pseudo_spectral(ALPHA, half, 0.25, diffusivity, None)
        error = np.abs(rate(0.0, np.exp(-x * x)) - right_hand_side(x))
        found.append(error[np.abs(x) < 4.0].max())
    # Two lengths, each like 1 / L.
    assert_allclose(observed_order(1.0 / np.array(widths), found), 1.0 + ALPHA, atol=0.2)


def test_both_ways_carry_alike():
    """On the circle and on the line, what is the same in the middle: the derivative of x u."""
    x, rate = pseudo_spectral(ALPHA, 40.0, 0.2, None, np.negative)
    bell = np.exp(-x * x)
    exact = Gaussian.laplacian([x], ALPHA) + (1.0 - 2.0 * x * x) * bell
    # The images of a bell of mass sqrt(pi), C = 0.3, at 80: 0.3 * 1.8 * 2 zeta(2.5) * 80^-2.5.
    assert np.abs(rate(0.0, bell) - exact)[np.abs(x) < 4.0].max() < 3e-5


def test_rational_functions_differentiate_their_own_and_converge_like_the_tail():
    """1 / (1 + x^2) is one of them; its fractional Laplacian, which falls like |x|^(-1-alpha), takes N^(-1-alpha)."""
    nothing = np.zeros_like
    x, rate = rational(ALPHA, 32, 1.0, nothing, lambda x: np.full_like(x, -0.7))
    assert_allclose(rate(0.0, Cauchy.value([x])), -1.4 * x / (1.0 + x * x) ** 2, atol=1e-12)
    counts, found = np.array([32, 64, 128]), []
    for n in counts:
        x, rate = rational(ALPHA, n, 1.0, None, None)
        exact = Cauchy.laplacian([x], ALPHA)
        found.append(np.abs(rate(0.0, Cauchy.value([x])) - exact).max())
    assert_allclose(observed_order(1.0 / counts, found)[-1], 1.0 + ALPHA, atol=0.1)


def test_rational_functions_converge_with_a_diffusivity_that_varies():
    """The flux falls like |x|^(-alpha): their order is low, but there is no other limit to it."""
    found = []
    for n in (48, 192):
        x, rate = rational(ALPHA, n, 4.0, diffusivity, None)
        found.append(np.abs(rate(0.0, np.exp(-x * x)) - right_hand_side(x)).max())
    assert found[1] < found[0] / 4.0 < 1e-3


def test_the_integrator_keeps_its_tolerance():
    u = integrated(lambda t, u: -u + np.cos(t), np.ones(2), (0.0, 1.0), 1e-10)
    exact = 0.5 * (np.cos(1.0) + np.sin(1.0) + np.exp(-1.0))
    assert_allclose(u, exact, rtol=1e-9)


# --- peers on the interval ------------------------------------------------------------------------


def test_the_stiffness_is_symmetric_and_scales_and_is_the_laplacian_near_two():
    nodes = np.sort(np.random.default_rng(2).uniform(-1.0, 1.0, 9))
    distances = np.abs(nodes[:, None] - nodes)
    matrix = stiffness(distances, ALPHA)
    # Sixteen terms c |x_i - x_j|^(3-alpha) / (h h), of which a vector instruction may round two equal ones differently.
    powers = distances.max() ** (3.0 - ALPHA) / ((2.0 - ALPHA) * (3.0 - ALPHA))
    term = potential_constant(ALPHA) * powers / np.diff(nodes).min() ** 2
    assert_allclose(matrix, matrix.T, rtol=0.0, atol=16.0 * np.finfo(float).eps * term)
    assert (np.linalg.eigvalsh(matrix) > 0.0).all()
    # a(u, v) of dimension length^(1 - alpha).
    assert_allclose(stiffness(3.0 * distances, ALPHA), 3.0 ** (1.0 - ALPHA) * matrix, rtol=1e-9)
    h = np.diff(nodes)
    laplacian = np.diag(1.0 / h[:-1] + 1.0 / h[1:])
    laplacian -= np.diag(1.0 / h[1:-1], 1) + np.diag(1.0 / h[1:-1], -1)
    near = stiffness(distances, 2.0 - 1e-8)
    assert_allclose(near, laplacian, atol=1e-5 * laplacian.max())


def test_the_stiffness_on_equal_elements_is_a_fourth_difference():
    """a_m = -c h^(1-alpha) delta^4 |m|^(3-alpha) / ((2-alpha)(3-alpha)), in 40 digits; near and far apart."""
    alpha, count, p = mp.mpf(ALPHA), 80, 3 - mp.mpf(ALPHA)
    distances = graded_mesh(count, 1.0).distances
    with mp.workdps(40):
        # The transform of c |r|^-q, q = alpha - 1, is |k|^(q-1).
        q, h = alpha - 1, mp.mpf(2) / count
        c = 1 / (2 * mp.gamma(1 - q) * mp.sin(mp.pi * q / 2))
        power = [abs(m) ** p for m in range(-2, count + 1)]
        exact = [
            float(
                -c * h ** (1 - alpha) / ((2 - alpha) * (3 - alpha))
                * sum(w * power[m + k] for k, w in enumerate((1, -4, 6, -4, 1)))
            )
            for m in range(count - 1)
        ]  # fmt: skip
    # The series is cut at 1e-9 of an integral, whose second difference is some (h / r)^2 = 1e-3 of it.
    assert_allclose(stiffness(distances, ALPHA)[0], exact, rtol=1e-5)


def test_the_mesh_is_graded_and_symmetric():
    mesh = graded_mesh(8, 3.0)
    assert_allclose(mesh.x, -mesh.x[::-1])
    assert_allclose(mesh.left[:3], [0.0, 0.25**3, 0.5**3])
    assert_allclose(mesh.volumes.sum(), 2.0)
    assert_allclose(mesh.volumes[1], 0.5 * 0.5**3)
    assert_allclose(graded_mesh(8, 1.0).x, np.linspace(-1.0, 1.0, 9), atol=1e-15)


@pytest.mark.parametrize("alpha", [1.2, 1.5, 1.8])
def test_elements_have_their_orders(alpha):
    """The energy norm of the error is like h^(1/2) on equal elements, and like N^-(2 - alpha/2) on graded ones.

    That of an eigenvalue is its square; the greatest error of Getoor's solution on equal ones is like h^(alpha/2).
    The power of the mesh must be above 4 - alpha.
    """
    counts = [32, 64, 128]
    exact = jacobi_eigenvalues(alpha)[0]
    for power, order in ((1.0, 1.0), (4.0, 4.0 - alpha)):
        values = np.array([element_eigenvalue(alpha, n, power) for n in counts])
        assert (values > exact).all()  # Galerkin
        found = observed_order(1.0 / np.array(counts), values - exact)[-1]
        assert found == pytest.approx(order, abs=0.1)
    errors = []
    for n in counts:
        x, u = element_solution(alpha, n)
        errors.append(np.abs(u - getoor(x, alpha)).max())
    assert observed_order(1.0 / np.array(counts), errors)[-1] == pytest.approx(alpha / 2, abs=0.1)


@pytest.mark.parametrize("alpha", [1.2, 1.5, 1.8])
def test_differences_on_an_interval_have_first_order_and_half_of_alpha(alpha):
    """The ends decide: u is like d^(alpha/2) there; an eigenvalue is off by the shift of the ends, like h."""
    counts = np.array([63, 127, 255])
    exact = jacobi_eigenvalues(alpha)[0]
    values = np.array([difference_eigenvalue(alpha, n) for n in counts])
    order = observed_order(1.0 / (counts + 1), np.abs(values - exact))[-1]
    assert order == pytest.approx(1.0, abs=0.1)
    errors = []
    for n in counts:
        x, u = difference_solution(alpha, n)
        errors.append(np.abs(u - getoor(x, alpha)).max())
    assert observed_order(1.0 / (counts + 1), errors)[-1] == pytest.approx(alpha / 2, abs=0.1)


def test_getoor_has_the_integral_that_is_known():
    """The energy of u is int u = sqrt(pi) Gamma(1 + alpha/2) / (Gamma(1 + alpha) Gamma((3 + alpha) / 2))."""
    t, w = np.polynomial.legendre.leggauss(60)
    x, w = np.sin(0.5 * np.pi * t), 0.5 * np.pi * w * np.cos(0.5 * np.pi * t)
    half = 0.5 * ALPHA
    exact = np.sqrt(np.pi) * gamma(1.0 + half) / (gamma(1.0 + ALPHA) * gamma(1.5 + half))
    assert w @ getoor(x, ALPHA) == pytest.approx(exact, rel=1e-6)


# --- peers for two blobs --------------------------------------------------------------------------


def test_a_circle_loses_points_and_no_digits():
    """A blob that spreads: the thinned waves are those that have decayed; the images remain, like L^-2.5."""
    circle = Circle(ALPHA, 0.0, 200.0, 0.05, 8.0)
    counts = [count for count, _ in circle.halvings()]
    assert len(counts) == 5
    assert counts[0] > 14 * counts[-1]
    most, ((_, x, u, h),) = on_circle(circle, lambda x: green(x, 0.05**ALPHA, ALPHA), [1.0], 1e-6)
    assert most == counts[0]
    exact = green(x, 0.05**ALPHA + 1.0, ALPHA)
    assert h * x.size == pytest.approx(400.0)
    assert np.abs(u - exact)[np.abs(x) < 5.0].max() < 5e-7  # 0.3 * 2 zeta(2.5) * 400^-2.5


def test_a_circle_carries_and_decays():
    circle = Circle(ALPHA, 0.0, 100.0, 1.0, 8.0)
    _, ((_, x, u, _),) = on_circle(
        circle, lambda x: green(x, 1.0, ALPHA), [1.0], 0.02, velocity=lambda x: np.full(x.size, 0.5)
    )
    near = np.abs(x) < 5.0
    assert np.abs(u - green(x - 0.5, 2.0, ALPHA))[near].max() < 2e-5
    _, (_, (_, x, u, _)) = on_circle(
        circle, lambda x: green(x, 1.0, ALPHA), [0.1, 1.0], 1e-7, source=lambda x, t, u: -u
    )
    assert np.abs(u - np.exp(-1.0) * green(x, 2.0, ALPHA))[near].max() < 2e-5


def test_elements_that_decay_are_of_second_order():
    errors = []
    for count in (200, 400):
        nodes = np.sinh(np.linspace(-9.0, 9.0, count))
        _, (_, (_, x, u, volumes)) = on_elements(
            ALPHA, lambda x: green(x, 1.0, ALPHA), nodes, [0.5, 1.0], 1e-8, lambda x, t, u: -u
        )
        errors.append(volumes @ np.abs(u - np.exp(-1.0) * green(x, 2.0, ALPHA)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)


# --- contests -------------------------------------------------------------------------------------

# Of ours in each contest: a grid of the scene, and a bound of the error above what theory leaves there.
GOOD = {
    "variable diffusivity": ("FPSE 12", (6.0, 0.15, 1e-8), 1e-6),
    "Ornstein-Uhlenbeck": ("DD 12", (20.0, 0.2, 1e-6), 1e-6),
    "eigenvalue": ("graded particles", (200,), 1e-8),
    "Getoor": ("graded particles", (200,), 1e-7),
    "widths 0.01 and 1": ("evolve, two lattices", (128, 32), 1e-8),
    "widths 0.0001 and 1": ("adaptive particles", (0.35,), 1e-4),
    "drawn together, 0.01": ("adaptive particles", (0.25, 1e-6), 2e-5),
    "drawn together, 0.0001": ("adaptive particles", (0.25, 1e-6), 2e-5),
    "competing, 0.01": ("adaptive particles", (0.25, 1e-6), 2e-5),
    "competing, 0.0001": ("adaptive particles", (0.35, 1e-5), 5e-4),
    "carried round": ("DD 12", (10.0, 0.5, 1e-4), 1e-4),
}


@pytest.mark.parametrize("name", CONTESTS)
def test_ours_reaches_the_answer(name):
    who, grid, bound = GOOD[name]
    contest = CONTESTS[name](ALPHA)
    group, solve = contest.contenders[who]
    size, answer = solve(*grid)
    assert group == OURS
    assert size > 0
    assert contest.error(answer) < bound


def test_every_contender_of_every_contest_is_measured(frame):
    measured = set(frame[["problem", "contender"]].itertuples(index=False, name=None))
    there = {(name, who) for name, make in CONTESTS.items() for who in make(ALPHA).contenders}
    assert measured == there
    assert (frame["error"] < 0.1).all()
    assert (frame["time"] > 0.0).all()


def synthetic() -> pd.DataFrame:
    rows = [
        ("p", "a", "ours", 10, 1e-2, 1e-3), ("p", "a", "ours", 20, 1e-7, 4e-3), ("p", "a", "ours", 15, 1e-5, 5e-3),
        ("p", "b", "peer", 99, 1e-4, 2e-3),
    ]  # fmt: skip
    frame = pd.DataFrame(rows, columns=["problem", "contender", "group", "size", "error", "time"])
    frame.attrs = {"cpu": "a processor", "repeats": 3}
    return frame


def test_the_table_says_who_is_first_to_what():
    result = study(
        Inputs("problem_times", benchmarks={"problem_times": synthetic()}),
        errors=[1e-3, 1e-6, 1e-9],
    )
    table = result.table.set_index("contender")
    assert list(table.index) == ["a", "b", FIRST]
    assert table.loc["a", "size"] == 20
    assert_allclose(table["to 1e-03 / ms"], [4.0, 2.0, 2.0])
    assert_allclose(table["to 1e-06 / ms"], [4.0, np.nan, 4.0])
    row = table.loc[FIRST]
    assert list(row[[f"first to {e}" for e in ("1e-03", "1e-06", "1e-09")]]) == ["b", "a", "none"]
    assert list(result.series["front"]) == [True, True, False, True]


def test_figure_and_caption_can_be_made_from_the_smoke_grid(frame, tmp_path):
    inputs = Inputs("problem_times", benchmarks={"problem_times": frame})
    result = call(SCENE.function("study"), inputs, **SCENE.parameters)
    drawn = call(SCENE.function("figure"), result.series, **SCENE.parameters)
    assert sum(ax.get_visible() for ax in drawn.axes) == len(CONTESTS)
    (tmp_path / "tables").mkdir()
    result.table.to_csv(tmp_path / "tables/problem_times.csv", index=False)
    pd.DataFrame(columns=list(COLUMNS)).to_csv(tmp_path / "claims.csv", index=False)
    texts = LookUps(tmp_path)
    filled = partial(texts.filled, scene=SCENE)
    assert "{{" not in filled(SCENE.file("caption.md"))
