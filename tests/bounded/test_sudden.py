"""What is on for a short time is not stepped over, and values outside that jump are refused."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.domain import Domain
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.square import Square
from fracparticles.errors import AccuracyWarning, NonFiniteSolution
from fracparticles.time.sudden import sudden_times
from sweeps import covering

DOMAINS = {
    "interval": Interval(alpha=1.5, particles=40),
    "disc": Disc(1.5, 12, 12, "absorbing"),
    "square": Square(1.5, 12, "absorbing"),
}
TOLERANCE = 1e-8


def bell(*place):
    return np.exp(-4.0 * sum(x * x for x in place))


@pytest.mark.parametrize(("domain", "width"), covering(DOMAINS.values(), [0.01, 0.001]))
def test_a_pulse_is_what_it_brings(domain: Domain, width: float):
    """A pulse of total 1 is a bell at its middle, up to second order in its width."""

    def source(*place):
        *place, t = place
        return ((t > 0.3) & (t < 0.3 + width)) / width * bell(*place)

    u = domain.evolve(0.0, 0.5, source=source, tolerance=TOLERANCE)
    exact = domain.evolve(bell, 0.2 - 0.5 * width)
    assert np.abs(u - exact).max() < (2.0 * width**2 + 10.0 * TOLERANCE) * np.abs(exact).max()

    def reaction(*place):
        return source(*place[:-1])

    v = domain.react(0.0, 0.5, reaction, tolerance=TOLERANCE)
    assert np.abs(v - u).max() < 10.0 * TOLERANCE * np.abs(u).max()


def test_values_outside_that_are_on_for_a_short_time_are_refused():
    line = Interval(alpha=1.5, particles=24, exterior="given")
    with pytest.raises(NonFiniteSolution, match="jump"):
        line.evolve(0.0, 0.5, outside=lambda y, t: ((t > 0.3) & (t < 0.31)) / (1.0 + y * y))
    smooth = line.evolve(
        0.0, 0.5, outside=lambda y, t: np.cos(120.0 * t) / (1.0 + y * y), tolerance=1e-3
    )
    assert np.isfinite(smooth).all()


@pytest.mark.parametrize("domain", DOMAINS.values(), ids=DOMAINS)
def test_what_fades_keeps_its_digits(domain: Domain):
    """e^-20 is in the factor of the solution without the source; some 20 steps may add a tolerance each."""
    u = domain.react(bell, 1.0, lambda *a: -20.0 * a[-1], tolerance=1e-6)
    exact = domain.evolve(bell, 1.0)
    assert np.abs(u * np.exp(20.0) - exact).max() < 20.0 * 1e-6 * np.abs(exact).max()


def test_what_a_source_takes_away_warns():
    """u = e^(-20 t) psi by a source that does not know u: what early steps miss decays like e^(-1.6 t) only."""
    line = DOMAINS["interval"]
    psi = line.decayed(line.values("psi", bell), 2.0)
    rate = line.rate(psi)
    with pytest.warns(AccuracyWarning, match="errors of early steps"):
        line.evolve(psi, 1.0, lambda x, t: -np.exp(-20.0 * t) * (20.0 * psi + rate), tolerance=1e-6)


def test_a_level_outside_that_grows_from_nothing_is_followed():
    """u = t everywhere: what is carried is zero to round-off, and its size is that of what is held."""
    for kind in DOMAINS:
        given = {
            "interval": lambda: Interval(alpha=1.5, particles=60, exterior="given"),
            "disc": lambda: Disc(1.5, 24, 16, "given"),
            "square": lambda: Square(1.5, 16, "given"),
        }[kind]()
        u = given.evolve(
            0.0, 1.0, lambda *place: 1.0 + 0.0 * place[0] * place[-1],
            lambda *place: place[-1] + 0.0 * place[0], tolerance=1e-8,
        )  # fmt: skip
        assert u == pytest.approx(1.0, abs=1e-7)


def test_a_smooth_function_has_no_sudden_times():
    assert sudden_times(lambda t: np.array([np.sin(9.0 * t), 1.0]), 0.0, 1.0) == []
    low, high = sudden_times(lambda t: np.array([float(t > 0.7)]), 0.5, 2.0)
    assert low <= 0.7 <= high < low + 1e-10
