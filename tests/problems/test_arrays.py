"""Initial data that are an array: `space_error` knows what such data may be between the particles."""

from __future__ import annotations

from functools import lru_cache
from itertools import product

import numpy as np
import pytest
from kinks import KINKS, SAID, H, bell, error, solution, solved

from fracparticles.problems import Problem, finer_particles, frozen, solve_problem
from fracparticles.problems.fewer_particles import among
from fracparticles.problems.interpolants import interpolants
from sweeps import covering, few

TAUS = (0.03, 0.3, 3.0, 30.0)  # h^alpha
PARTS = np.array([0.25, 0.5, 0.75])
WIDTHS = {"tent": (0.5, 8), "cusp": (0.4, 2), "box": (1.43, 2)}  # and the order of the kernel


@pytest.mark.parametrize(("alpha", "kind", "at"), covering([1.1, 1.9], WIDTHS, [0.5, 0.25, 0.0]))
def test_a_kink_that_only_the_particles_say(alpha, kind, at):
    """A spline alone said a third of it, of a jump a seventh, in silence up to a tenth of u."""
    (given, transform), (width, order) = KINKS[kind], WIDTHS[kind]
    times = tuple(tau * H**alpha for tau in TAUS)
    x = Problem(alpha=alpha, half_width=10.0, spacing=H, t_final=1.0).case.x
    run, warned = solved(given((x - at * H) / width), alpha=alpha, order=order, times=times)
    errors = [
        error(u, solution(lambda k: width * transform(width * k), x - at * H, t, alpha))
        for u, t in zip(run.u.values, times, strict=True)
    ]
    # The straight line cuts off a half of a kink that is half-way between two particles.
    assert (np.array(errors) < 2.0 * run.space_error.values).all()
    assert warned or max(errors) < SAID


@pytest.mark.parametrize(("width", "alpha"), covering([0.25, 0.4, 0.8], [1.1, 1.9]))
def test_smooth_data_are_their_spline(width, alpha):
    times = tuple(tau * H**alpha for tau in TAUS)
    given = Problem(alpha=alpha, half_width=10.0, spacing=H, t_final=1.0).case.x / width
    of_array, _ = solved(bell(given), alpha=alpha, times=times)
    of_function, _ = solved(lambda x: bell(x / width), alpha=alpha, times=times)
    assert of_array.space_error.values == pytest.approx(
        of_function.space_error.values, rel=0.2, abs=5e-4
    )


@pytest.mark.parametrize(("alpha", "at"), few(product([1.2, 1.8], [0.0, 0.013, 0.025])))
def test_a_jump_in_an_interval(alpha, at):
    """The spline said a thirtieth of it, in silence up to 0.3 of u."""
    given, transform = KINKS["box"]
    times, width = tuple(tau * (2.0 / 128) ** alpha for tau in (0.3, 3.0, 30.0)), 0.4
    fields = {"alpha": alpha, "half_width": 1.0, "exterior": "absorbing", "spacing": None}
    fields |= {"particles": 128, "times": times}
    x = Problem(**{"half_width": 10.0, **fields}).places["x"]
    run, _ = solved(given((x - at) / width), **fields)
    for u, t, said in zip(run.u.values, times, run.space_error.values, strict=True):
        exact = solution(lambda k: width * transform(width * k), x - at, t, alpha)
        off = np.abs(u - exact)[np.abs(x) < 0.5].max() / np.abs(u).max()
        # Of a kink between the particles three times as many know two thirds, and of its tip a half.
        assert off < max(3.0 * said, 0.02)


def test_what_is_smooth_on_the_scale_of_the_particles_has_one_interpolant():
    i = np.arange(64.0)
    at = i[:-1] + 0.5

    def wave(i):
        return np.sin(0.3 * i) + 0.1 * i

    for u in (wave, lambda i: np.exp(-((i - 30.2) ** 2) / 9.0), np.ones_like):
        (spline,) = interpolants(u(i), at)
        assert spline == pytest.approx(u(at), abs=2e-3)


def test_a_kink_is_a_straight_line_and_a_jump_is_anywhere_between():
    i = np.arange(64.0)
    kink, jump = np.abs(i - 31.0), 1.0 * (i > 31.0)
    spline, linear = interpolants(kink, 31.0 + PARTS)
    assert linear == pytest.approx(PARTS)
    assert spline != pytest.approx(PARTS, abs=1e-2)
    _, least, most = interpolants(jump, 31.0 + PARTS)
    assert least == pytest.approx(0.0 * PARTS, abs=0.0)
    assert most == pytest.approx(1.0 + 0.0 * PARTS, rel=0.0)


def test_every_interpolant_meets_the_particles():
    u = np.random.default_rng(1).standard_normal((20, 24))
    u[:, 12:] += 10.0
    square = u[:, :20]
    for found in interpolants(square, np.arange(20.0), np.arange(20.0)):
        assert found == pytest.approx(square, abs=1e-12)


def box(x, y):
    return 1.0 * ((np.abs(x - 0.1) < 0.3) & (np.abs(y + 0.07) < 0.35))


@lru_cache
def some_and_many(domain, particles, finer):
    """The problem of a box on some particles, and the solution on more at these."""
    fields = {"alpha": 1.5, "half_width": 1.0, "exterior": "absorbing", "domain": domain}
    fields["times"] = tuple(tau * particles**-1.5 for tau in (0.3, 3.0, 30.0))
    some, many = (Problem(**fields, particles=n) for n in (particles, finer))
    return some, [among(many, some, u) for u in solve_problem(many, box, estimate=False).u.values]


@pytest.mark.parametrize("as_array", [False, True])
@pytest.mark.parametrize(("domain", "particles", "finer"), [("square", 16, 80), ("disc", 16, 48)])
def test_a_jump_in_a_square_and_a_disc(domain, particles, finer, as_array):
    """Against three and five times as many. Half of the particles alone said 0.01 where a fifth of u was wrong."""
    some, exact = some_and_many(domain, particles, finer)
    run = solve_problem(some, box(*some.places.values()) if as_array else box)
    for u, v, said in zip(run.u.values, exact, run.space_error.values, strict=True):
        off = np.abs(u - v).max() / np.abs(u).max()
        # Of three times as many two thirds are known.
        assert off < 2.0 * said
        assert off > said / 8.0


@pytest.mark.parametrize(
    ("domain", "particles", "most"), [("interval", 320, 300), ("square", 24, 12)]
)
def test_more_particles_than_have_thrice_as_many(monkeypatch, domain, particles, most):
    """The box has its error from fewer; a bell that fewer would not see has none."""
    monkeypatch.setitem(finer_particles._MOST, domain, most)
    fields = {"alpha": 1.5, "half_width": 1.0, "exterior": "absorbing", "domain": domain}
    fields |= {"particles": particles, "t_final": 30.0 * (3.0 / particles) ** 1.5}

    def along(profile):
        return profile if domain == "interval" else lambda x, y: profile(x) * np.cos(y)

    jump = solve_problem(Problem(**fields), along(lambda x: 1.0 * (np.abs(x - 0.101) < 0.2)))
    assert float(jump.space_error) > 0.02
    narrow = 3.0 * float(np.diff(np.asarray(jump.x)).max())
    smooth = solve_problem(Problem(**fields), along(lambda x: np.exp(-((x / narrow) ** 2))))
    assert float(smooth.space_error) < 0.02


@pytest.mark.parametrize("as_array", [False, True])
@pytest.mark.parametrize("tau", [0.3, 3.0])
def test_a_lattice_that_is_too_large_for_its_waves(monkeypatch, as_array, tau):
    """A kink there had the error of half and a quarter alone, a tenth of its own."""
    given, transform = KINKS["tent"]
    fields = {"alpha": 1.5, "order": 2, "t_final": tau * H**1.5}
    x = Problem(half_width=10.0, spacing=H, **fields).case.x
    monkeypatch.setattr(frozen, "_MOST", 32 * x.size - 1)
    run, _ = solved(given(x / 0.5) if as_array else lambda x: given(x / 0.5), **fields)
    exact = solution(lambda k: 0.5 * transform(0.5 * k), x, fields["t_final"], 1.5)
    off = error(run.u.values, exact)
    assert off / 2.0 < float(run.space_error) < 3.0 * off
    smooth, _ = solved(bell(x / 0.8), **{**fields, "order": 4})
    assert float(smooth.space_error) < SAID
