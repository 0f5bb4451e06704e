"""What an interval, a disc and a square do alike: sources and values outside that change in time, and reactions."""

from __future__ import annotations

from functools import cache
from math import gamma

import numpy as np
import pytest
from scipy.special import hyp2f1

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.domain import Domain
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.square import Square
from fracparticles.errors import InvalidInput, NonFiniteSolution
from sweeps import covering, few

KINDS = ("interval", "disc", "square")


@cache
def domain(kind: str, exterior: str, alpha: float = 1.5) -> Domain:
    if kind == "interval":
        return Interval(alpha=alpha, particles=80, exterior=exterior)
    if kind == "disc":
        return Disc(alpha, 24, 16, exterior)
    return Square(alpha, 16, exterior)


def bell(*points):
    return np.exp(-4.0 * sum(np.square(part - 0.2) for part in points))


@pytest.mark.parametrize(("kind", "exterior"), covering(KINDS, ["absorbing", "reflecting"]))
def test_a_source_in_time_is_the_integral_over_what_it_leaves(kind, exterior):
    """Duhamel: of u' = A u + cos(3 t) psi, A psi = -m psi, u = psi (m (cos 3t - e^(-m t)) + 3 sin 3t) / (m^2 + 9)."""
    one = domain(kind, exterior)
    rate = one.eigenvalues(2)[-1]  # of the second mode
    psi = one.decayed(one.values("psi", lambda *points: points[0] + 0.0 * points[-1]), 8.0 / rate)
    psi /= np.abs(psi).max()
    t = 0.7
    u = one.evolve(0.0, t, lambda *place: np.cos(3.0 * place[-1]) * psi, tolerance=1e-9)
    exact = rate * (np.cos(3 * t) - np.exp(-rate * t)) + 3 * np.sin(3 * t)
    # psi is the mode but for what is left of the next that is odd in x, e^-8 of it or less.
    assert u == pytest.approx(psi * exact / (rate**2 + 9.0), abs=2e-3)
    total = one.total(
        one.evolve(bell, t, lambda *place: np.cos(3.0 * place[-1]) * bell(*place[:-1]))
    )
    if exterior == "reflecting":
        assert total == pytest.approx(one.total(bell) * (1.0 + np.sin(3 * t) / 3.0), rel=1e-8)


@pytest.mark.parametrize("kind", KINDS)
def test_a_source_that_says_t_and_does_not_use_it_is_the_constant_one(kind):
    one = domain(kind, "absorbing")
    ours = one.evolve(bell, 0.3, lambda *place: bell(*place[:-1]), tolerance=1e-9)
    assert ours == pytest.approx(one.evolve(bell, 0.3, one.values("f", bell)), abs=1e-8)


@pytest.mark.parametrize("kind", KINDS)
def test_a_reaction_is_the_ordinary_equation_where_nothing_leaves(kind):
    one = domain(kind, "reflecting")
    u = one.react(0.1, 3.0, lambda *a: a[-1] * (1.0 - a[-1]), tolerance=1e-9)
    assert u == pytest.approx(0.1 * np.exp(3.0) / (0.9 + 0.1 * np.exp(3.0)), rel=1e-7)


@pytest.mark.parametrize("kind", KINDS)
def test_decay_multiplies_by_its_factor(kind):
    one = domain(kind, "absorbing")
    u = one.react(bell, 0.5, lambda *a: -0.8 * a[-1], tolerance=1e-9)
    assert u == pytest.approx(np.exp(-0.4) * one.evolve(bell, 0.5), abs=1e-8)


@pytest.mark.parametrize("kind", few(KINDS))
def test_blow_up_says_when(kind):
    with pytest.raises(NonFiniteSolution, match=r"t = (1\.9|2)"):
        domain(kind, "reflecting").react(0.5, 3.0, lambda *a: np.square(a[-1]), tolerance=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_a_level_outside_that_swings_is_followed(kind):
    """u = cos(2 t) everywhere, of f = -2 sin(2 t): outside and inside alike, to the tolerance in time."""
    one = domain(kind, "given")

    def swings(*place):
        return np.cos(2.0 * place[-1]) + 0.0 * place[0]

    u = one.evolve(
        1.0, 0.9, lambda *place: -2.0 * np.sin(2.0 * place[-1]) + 0.0 * place[0], swings,
        tolerance=1e-9,
    )  # fmt: skip
    assert u == pytest.approx(np.cos(1.8), abs=1e-7)


@pytest.mark.parametrize(("kind", "bound"), [("disc", 1e-3), ("square", 4e-4)])
def test_a_field_of_the_plane_that_swings_is_continued_inside(kind, bound):
    """cos(2 t) (1 + |x|^2)^-p, its Laplacian as in `test_disc`; the bound is that of the steady field there."""
    alpha, p, one = 1.5, 2.3, domain(kind, "given")
    s = 0.5 * alpha

    def u(x, y, t):
        return np.cos(2.0 * t) * (1.0 + x**2 + y**2) ** -p

    def source(x, y, t):
        size = 2.0**alpha * gamma(p + s) * gamma(1.0 + s) / gamma(p)
        laplacian = size * hyp2f1(p + s, 1.0 + s, 1.0, -(x**2) - y**2)
        return np.cos(2.0 * t) * laplacian - 2.0 * np.tan(2.0 * t) * u(x, y, t)

    found = one.evolve(lambda x, y: u(x, y, 0.0), 0.4, source, u, tolerance=1e-8)
    assert np.abs(found - u(one.x, one.y, 0.4)).max() < bound


@pytest.mark.parametrize("kind", KINDS)
def test_the_rate_is_what_evolve_starts_with(kind):
    one = domain(kind, "reflecting")
    u = one.evolve(bell, 0.2)
    dt = 1e-5
    slope = (one.evolve(u, 2 * dt) - u) / (2 * dt)
    # Round-off of u is seen where particles are close, in little of the volume.
    assert one.total(np.abs(one.rate(one.evolve(u, dt)) - slope)) < 1e-4


def test_the_names_of_its_arguments_say_what_a_function_is_of():
    one = domain("interval", "given")
    byplace = one.evolve(bell, 0.2, lambda x, t: x + np.cos(t), lambda x, t: np.sin(t) + 0.0 * x)
    named = one.evolve(bell, 0.2, lambda t, x: x + np.cos(t), lambda time: np.sin(time))
    np.testing.assert_array_equal(named, byplace)
    ends = domain("interval", "absorbing")
    reacted = ends.react(bell, 0.2, lambda x, t, u: x * u)
    np.testing.assert_array_equal(ends.react(bell, 0.2, lambda u, x: x * u), reacted)


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_refused(kind):
    one, given = domain(kind, "absorbing"), domain(kind, "given")
    for field, call in {
        "outside": lambda: one.evolve(1.0, 1.0, outside=1.0),
        "source": lambda: one.react(1.0, 1.0, 3.0),
        "time": lambda: one.evolve(1.0, -1.0),
        "tolerance": lambda: one.evolve(1.0, 1.0, tolerance=1.0),
        "initial": lambda: one.evolve(lambda *place: np.log(place[0]), 1.0),
    }.items():
        with pytest.raises(InvalidInput, match=f"^{field} = ") as error:
            call()
        assert "\n" not in str(error.value)
    for outside in (None, lambda *place: place[0] * np.nan):
        with pytest.raises(InvalidInput, match=r"^outside (=|is missing)"):
            given.evolve(1.0, 1.0, outside=outside)


def test_a_domain_says_what_it_is():
    assert repr(domain("disc", "reflecting")) == "<Disc: reflecting, alpha = 1.5, 384 particles>"
