"""The methods of the literature in the plane: plane waves, weights, and the reference problem."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import factorial, gamma, poch

from fracparticles.errors import InvalidInput
from fracparticles.run.orders import observed_order
from fracparticles.special import green
from fracstudy.peers import PLANE_PEERS, peer
from fracstudy.peers.plane import plane_weights

ALPHAS = [1.1, 1.5, 1.9]
SQUARES = {
    "sinc-lattice": lambda theta: theta**2,
    "fractional-centred": lambda theta: 2.0 - 2.0 * np.cos(theta),
}
GIVEN = {"alpha": 1.5, "half_width": 5.0, "time": 1.0, "spacing": 0.5}
CIRCLE, SPREADS = (
    8,
    40,
)  # the least circle of the weights, in units of their number and of tau^(1/alpha)


def tail(alpha: float, time: float, j: int) -> tuple[float, float]:
    """The term A r^-p of order j in the expansion of the fundamental solution for large r: A and p."""
    order = j * alpha
    sine = np.sin(0.5 * np.pi * order)
    amplitude = -((-time) ** j) / factorial(j) * 2.0**order * gamma(1.0 + 0.5 * order) ** 2 * sine
    return amplitude / np.pi**2, 2.0 + order


def outside(a: float, p: float) -> float:
    """The integral of r^-p outside the square of half-width a."""
    angle = quad(lambda phi: np.cos(phi) ** (p - 2.0), 0.0, 0.25 * np.pi)[0]
    return 8.0 * a ** (2.0 - p) / (p - 2.0) * angle


def room_for_images(alpha: float, tau: float, circle: float, distance: np.ndarray) -> np.ndarray:
    """What the images may leave: |mu|^4 of the first term, and the fourth term; it vanishes for alpha = 1.5: the fifth.

    |1 + mu|^-p has the terms ((p/2)_2 / 2!)^2 |mu|^4 and 2 (p/2)_4 / 4! |mu|^4 cos 4 phi; the sums over the square
    lattice of |l|^-(p + 4) and of the later powers are below 5; a quarter more for all that follows.
    """
    first, p = tail(alpha, tau, 1)
    quartic = (poch(0.5 * p, 2) / 2.0) ** 2 + 2.0 * poch(0.5 * p, 4) / 24.0
    later = sum(
        abs(amplitude) * circle**-q for amplitude, q in (tail(alpha, tau, j) for j in (4, 5))
    )
    near = 5.0 * first * circle**-p * quartic * (distance / circle) ** 4
    return 1.25 * (near + 5.0 * later)


def prepare_plane(name: str, **given):
    return peer(name).prepare_plane(**given)


def radius(axis: np.ndarray) -> np.ndarray:
    return np.hypot(axis[:, None], axis)


def deviation(solver) -> np.ndarray:
    """u - exact for the fundamental solution taken from t = 0.5 to 1.5, at alpha = 1.5."""
    r = radius(solver.x)
    return solver.solve(green(r, 0.5, 1.5, 2)) - green(r, 1.5, 1.5, 2)


# --- the interface --------------------------------------------------------------------------------


def test_the_names():
    assert set(PLANE_PEERS) == {"exact-symbol", *SQUARES}
    for described in PLANE_PEERS.values():
        assert described.label
        assert described.reference


@pytest.mark.parametrize("name", PLANE_PEERS)
@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("alpha", 2.0),
        ("half_width", 0.0),
        ("time", -1.0),
        ("time", "1"),
        ("spacing", float("nan")),
        ("spacing", None),
    ],
)
def test_invalid_input(name, field, value):
    with pytest.raises(InvalidInput) as caught:
        prepare_plane(name, **{**GIVEN, field: value})
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("name", "allowed"),
    [
        ("huang-oberman", "exists in the plane"),
        (None, "one of huang-oberman"),
        ([], "exact-symbol"),
    ],
)
def test_an_unknown_peer(name, allowed):
    with pytest.raises(InvalidInput, match=allowed):
        prepare_plane(name, **GIVEN)


@pytest.mark.parametrize("name", PLANE_PEERS)
def test_invalid_data(name):
    solver = prepare_plane(name, **GIVEN)
    size = solver.x.size
    for u0 in (np.zeros(size), np.zeros((size, size + 1)), np.full((size, size), np.nan), 1j):
        with pytest.raises(InvalidInput) as caught:
            solver.solve(u0)
        assert caught.value.field == "u0"


@pytest.mark.parametrize("name", PLANE_PEERS)
def test_the_lattice(name):
    solver = prepare_plane(
        name, **{**GIVEN, "spacing": 0.22}
    )  # 5 / 0.22 = 22.7; 46 has the factor 23
    intervals = 48 if name == "exact-symbol" else 46
    assert np.sqrt(solver.volumes) == pytest.approx(10.0 / intervals, rel=1e-15)
    assert solver.x.size == intervals + (name != "exact-symbol")
    assert solver.x[0] == pytest.approx(-5.0, rel=1e-15)
    assert np.diff(solver.x) == pytest.approx(np.sqrt(solver.volumes), rel=1e-13)


@pytest.mark.parametrize("name", PLANE_PEERS)
def test_a_solution_is_the_caller_s(name):
    solver = prepare_plane(name, **GIVEN)
    u0 = np.exp(-(radius(solver.x) ** 2))
    kept = u0.copy()
    u = solver.solve(u0)
    first = u.copy()
    solver.solve(2.0 * u0)
    assert np.array_equal(u, first)
    assert np.array_equal(u0, kept)


# --- known answers --------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("waves", [(0, 0), (5, -3), (0, 7), (30, 30), (30, 2)])
def test_a_plane_wave_of_the_box(alpha, waves):
    solver = prepare_plane("exact-symbol", alpha=alpha, half_width=3.0, time=0.01, spacing=0.1)
    x, y = solver.x[:, None], solver.x
    first, second = (np.pi * m / 3.0 for m in waves)
    wave = np.cos(first * x + second * y + 0.3)
    decay = np.exp(-0.01 * np.hypot(first, second) ** alpha)
    # log2(60^2) = 12 ulp for the transforms; the argument, up to 60 pi, is good to half an ulp of it.
    ulp = np.finfo(float).eps
    room = ulp * (12.0 + 0.5 * (0.3 + 3.0 * (abs(first) + abs(second))))
    assert solver.solve(wave) == pytest.approx(decay * wave, rel=0, abs=room)


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize(("tau", "count"), [(10.0, 60), (30.0, 30), (100.0, 5)])
def test_the_weights_of_the_sinc_lattice_are_the_fundamental_solution(alpha, tau, count):
    """In units of h, but for the waves beyond pi, of which exp(-tau pi^alpha) is left."""
    r = radius(np.arange(count))
    room = room_for_images(alpha, tau, max(CIRCLE * count, SPREADS * tau ** (1.0 / alpha)), r)
    exact = green(r, tau, alpha, 2)
    lost = np.exp(-tau * np.pi**alpha)  # times the tail of the integral, below 1
    e = plane_weights(SQUARES["sinc-lattice"], alpha, tau, count)
    assert (np.abs(e - exact) <= room + lost + 1e-13 * exact[0, 0]).all()


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("name", SQUARES)
def test_the_sum_and_the_symmetry_of_the_weights(name, alpha):
    tau, count = 8.0, 81
    e = plane_weights(SQUARES[name], alpha, tau, count)
    assert e == pytest.approx(e.T, rel=0, abs=4e-15 * e[0, 0])  # e_0 is the mean of |values|
    total = 4.0 * e[1:, 1:].sum() + 4.0 * e[0, 1:].sum() + e[0, 0]
    a = count - 0.5
    terms = []
    for j in range(1, 6):
        amplitude, p = tail(alpha, tau, j)
        terms.append(amplitude * outside(a, p))
    # The sum for the integral costs p^2 alpha / (24 (2 + alpha) a^2) of the first term, < 0.32 / a^2; the second term
    # of the centred differences is (2 + alpha)^2 alpha / 32 times alpha / (2 + alpha) of it over a^2, < 0.45 / a^2.
    room = terms[0] / a**2 + 1.25 * (abs(terms[3]) + abs(terms[4]))
    images = (2.0 * count) ** 2 * room_for_images(alpha, tau, CIRCLE * count, a * np.sqrt(2.0))
    assert 1.0 - total == pytest.approx(sum(terms[:3]), rel=0, abs=room + images + 1e-14)


@pytest.mark.parametrize("name", SQUARES)
def test_a_dense_product(name):
    """With weights from a circle so long that its images, 7 A P^-3.5, do not matter."""
    n, h, tau, alpha, circle = 6, 0.5, 8.0, 1.5, 2048
    count = 2 * n + 1
    part = SQUARES[name](2.0 * np.pi * np.fft.fftfreq(circle))
    values = np.exp(-tau * (part[:, None] + part[: circle // 2 + 1]) ** (0.5 * alpha))
    e = np.fft.irfft2(values, (circle, circle))[:count, :count]
    m = np.arange(count)
    offsets = np.abs(m[:, None] - m)
    matrix = e[offsets[:, None, :, None], offsets[None, :, None, :]]
    u0 = np.random.default_rng(7).uniform(-1.0, 1.0, (count, count))
    solver = prepare_plane(name, alpha=alpha, half_width=n * h, time=tau * h**alpha, spacing=h)
    amplitude, p = tail(alpha, tau, 1)
    far = room_for_images(alpha, tau, CIRCLE * count, radius(m))[offsets[0]].max()
    # The second term of the centred differences: (2 + alpha)^2 alpha / 32 = 0.57 of the first over P^2.
    second = 0.57 * 7.0 * amplitude * (CIRCLE * count) ** (-p - 2.0)
    room = (far + second + 7.0 * amplitude * circle**-p) * np.abs(u0).sum()
    assert room < 1e-4 * np.abs(u0).max()
    expected = np.einsum("ijkl,kl->ij", matrix, u0)
    assert solver.solve(u0) == pytest.approx(expected, rel=0, abs=room + 1e-14)


# --- the reference problem ------------------------------------------------------------------------


def test_the_sinc_lattice_is_left_with_the_truncation():
    """At x = 0 it leaves out the integral of G(y, 1) G(y, 0.5) outside the square, of the order D^(-2-2 alpha)."""
    widths, h = np.array([10.0, 20.0, 40.0]), 0.25
    errors = []
    for half_width in widths:
        solver = prepare_plane(
            "sinc-lattice", alpha=1.5, half_width=half_width, time=1.0, spacing=h
        )
        u = deviation(solver)
        errors.append(np.abs(u[radius(solver.x) <= 2.0]).max())
        a = half_width + 0.5 * h
        left_out = [0.0, 0.0, 0.0]
        for i in (1, 2, 3):
            for j in range(1, 5 - i):
                (b, p), (c, q) = tail(1.5, 1.0, i), tail(1.5, 0.5, j)
                left_out[i + j - 2] += b * c * outside(a, p + q)
        # A fourth order follows, and the sum is for an integral: as much again as the third is room enough.
        n = solver.x.size // 2
        assert -u[n, n] == pytest.approx(sum(left_out), rel=0, abs=abs(left_out[2]))
    # The second order is 5 % of the first at D = 20 and 2 % at 40, the distance |x| <= 2 is 2 % and 0.5 %.
    assert observed_order(1.0 / widths, np.array(errors))[-1] == pytest.approx(5.0, abs=0.1)


def test_the_centred_differences_are_of_second_order():
    """Symbol alpha/24 h^2 |k|^(alpha-2) (k_1^4 + k_2^4) too small, 3/4 |k|^(alpha+2) on the average over the angles."""
    alpha, t, power = 1.5, 1.5, 5.5 / 1.5
    spacings = np.array([0.5, 0.25, 0.125])
    errors = []
    for h in spacings:  # truncation leaves 1.4e-7
        solver = prepare_plane(
            "fractional-centred", alpha=alpha, half_width=10.0, time=1.0, spacing=h
        )
        u = deviation(solver)
        errors.append(np.abs(u[radius(solver.x) <= 2.0]).max())
        n = solver.x.size // 2
        leading = alpha / 32.0 * h**2 / (2.0 * np.pi) * gamma(power) / (alpha * t**power)
        # The terms of order h^4 k^4 over those of h^2 k^2 in G: h^2 times a number of order one.
        assert u[n, n] == pytest.approx(leading, rel=h**2)
    assert observed_order(spacings, np.array(errors))[-1] == pytest.approx(2.0, abs=0.05)


def test_the_box_is_left_with_its_images():
    """Near x = 0 the images of the mass 1 add t A (2 D)^(-2-alpha) sum_l |l|^(-2-alpha)."""
    widths = np.array([20.0, 40.0, 80.0])
    amplitude, p = tail(1.5, 1.0, 1)
    distances = radius(np.arange(-200.0, 201.0))
    images = (distances[distances > 0.0] ** -p).sum() + outside(200.5, p)
    errors = []
    for half_width in widths:
        solver = prepare_plane(
            "exact-symbol", alpha=1.5, half_width=half_width, time=1.0, spacing=0.25
        )
        errors.append(np.abs(deviation(solver)[radius(solver.x) <= 2.0]).max())
    # The second term of G is 4.2 t / r^1.5 of the first, r = 2 D: 0.6 % at D = 40, 0.2 % at 80; the data beyond D, of
    # mass 2 pi A t / (alpha D^alpha), are as much; and |x| <= 2 adds (p / 2)^2 |x / r|^2 = 0.2 % and less.
    assert errors[-1] == pytest.approx(amplitude * images * 160.0**-p, rel=0.02)
    assert observed_order(1.0 / widths, np.array(errors))[-1] == pytest.approx(3.5, abs=0.05)


@pytest.mark.parametrize("name", PLANE_PEERS)
def test_threads_may_share_a_solver(name):
    solver = prepare_plane(name, alpha=1.5, half_width=5.0, time=1.0, spacing=0.2)
    data = np.random.default_rng(5).normal(size=(24, solver.x.size, solver.x.size))
    expected = [solver.solve(u0) for u0 in data]
    with ThreadPoolExecutor(8) as threads:
        for ours, right in zip(threads.map(solver.solve, data), expected, strict=True):
            assert np.array_equal(ours, right)
