"""Stiff and extreme problems beside closed forms: right, or warned of.

On an interval, a square or a disc from which nothing leaves, data that are the same everywhere stay so. u is then the
solution of the ordinary equation u' = f(t, u). The fewest particles are enough.
"""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import gammaln

from fracparticles.adaptive.follow import follow
from fracparticles.bounded import switching
from fracparticles.bounded.disc import Disc
from fracparticles.bounded.exponential import ExponentialSteps
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.square import Square
from fracparticles.errors import AccuracyWarning, NonFiniteSolution
from fracparticles.problems import Problem, solve_problem
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.tighter_steps import TIME_ERROR
from fracparticles.special import central_mass
from fracparticles.special.stable import green
from fracparticles.time.sudden import pulses
from sweeps import covering

RTOL = 1e-6
# The errors of a run are some tens of steps' tolerances.
NEAR = 50.0 * RTOL
PULSE = "exp(-((t - 0.512345)/{0})**2)/{0}"
TOTAL = np.sqrt(np.pi)  # of such a pulse


def level(source, start, *, estimate=False, **fields):
    """Return u, which is the same everywhere, and the run."""
    walls = {"exterior": "reflecting", "half_width": 1.0, "alpha": 1.5, "t_final": 1.0}
    plane = fields.get("domain") in ("square", "disc")
    problem = Problem(**walls | {"particles": 8 if plane else 16, "source": source} | fields)
    run = solve_problem(problem, lambda *place: start + 0.0 * sum(place), estimate=estimate)
    assert float(np.ptp(run.u.values)) < 1e-9 * max(1.0, float(np.abs(run.u).max()))
    return float(run.u.values.flat[0]), run


@pytest.fixture
def silent():
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        yield


@pytest.mark.usefixtures("silent")
@pytest.mark.parametrize(
    ("domain", "width", "form"),
    covering(["interval", "square", "disc"], [1e-4, 1e-6], ["adds", "multiplies"]),
)
def test_a_pulse_of_a_millionth_of_the_run_is_not_stepped_over(domain, width, form):
    """It was, and u was 1 or 0 for 2.8 or 5.9."""
    text = PULSE.format(width)
    source, exact = (f"1 + {text}", 1.0 + TOTAL) if form == "adds" else (f"u*{text}", np.exp(TOTAL))
    u, _ = level(source, 0.0 if form == "adds" else 1.0, domain=domain)
    assert u == pytest.approx(exact, rel=NEAR)


@pytest.mark.parametrize("places", [1, 2])
@pytest.mark.parametrize("width", [1e-6, 1e-5, 1e-4, 1e-3, 1e-2])
def test_a_pulse_of_any_width_is_found_on_both_sides(width, places):
    found = np.array(
        sorted(pulses(lambda t: np.exp(-(((t - 0.3) / width) ** 2)), places, 0.0, 1.0))
    )
    # A tenth of the range is passed from one look to the next of the widest stride, or it is no pulse.
    if width > 1e-2 / 2:
        assert found.size == 0
    else:
        near = found[np.abs(found - 0.3) < 3.0 * width]
        assert near.min() < 0.3 < near.max()


@pytest.mark.usefixtures("silent")
@pytest.mark.parametrize("door", ["problem", "domain"])
def test_none_of_many_pulses_is_stepped_over(door):
    """All of them were. The mean of sin^n, n even, is Gamma((n + 1) / 2) / (sqrt(pi) Gamma(n / 2 + 1))."""
    n = 10**8
    mean = np.exp(gammaln(0.5 * (n + 1)) - gammaln(0.5 * n + 1.0)) / np.sqrt(np.pi)
    if door == "problem":
        u, _ = level(f"1 + sin(10*pi*t)**{n}/{mean}", 0.0, rtol=1e-3)
    else:
        line = Interval(alpha=1.5, particles=16, exterior="reflecting")
        u = line.react(
            0.0, 1.0, lambda x, t, u: 1.0 + np.sin(10.0 * np.pi * t) ** n / mean + 0.0 * x, tolerance=1e-3
        )  # fmt: skip
    assert u == pytest.approx(2.0, rel=50.0 * 1e-3)


@pytest.mark.parametrize("places", [1, 2])
@pytest.mark.parametrize("waves", [30, 300, 3000])
def test_many_pulses_are_found_and_a_wave_is_none(waves, places):
    ends = np.array(sorted(pulses(lambda t: np.sin(np.pi * waves * t) ** 100, places, 0.0, 1.0)))
    middles = (np.arange(waves) + 0.5) / waves
    # Two times a pulse, one on either side.
    assert ends.size == 2 * waves
    assert (ends[::2] < middles).all()
    assert (middles < ends[1::2]).all()
    assert len(pulses(lambda t: np.sin(np.pi * waves * t), places, 0.0, 1.0)) <= 2


def wave(t):
    """On for the first half of each of 7 periods; u = 0 until it is on for the first time."""
    return np.where(np.sin(14.0 * np.pi * t) > 0.0, 1.0, 0.0)


@pytest.mark.usefixtures("silent")
@pytest.mark.parametrize(
    "source",
    [
        "where(sin(14*pi*t) > 0, 1, 0)",
        lambda x, t: float(wave(float(t))) + 0.0 * x,  # of one time only
    ],
)
def test_a_rectangular_wave_may_begin_from_nothing(source):
    """It was refused at once: no step into a jump is accurate to a share of nothing."""
    u, _ = level(source, 0.0, rtol=1e-4)
    assert u == pytest.approx(0.5, rel=50.0 * 1e-4)


@pytest.mark.usefixtures("silent")
@pytest.mark.parametrize("door", ["problem", "domain"])
def test_a_pulse_that_multiplies_u_is_found_where_u_begins_as_zero(door):
    """There it is nothing, and was stepped over: a fifteenth of u was missed without a word."""
    on = 0.0042  # u' = 1 - 30 u then, from u = 0.5386 on
    source = f"1 - 30*where((t > 0.5386) & (t < {0.5386 + on}), 1, 0)*u"
    if door == "problem":
        u, _ = level(source, 0.0)
    else:
        line = Interval(alpha=1.5, particles=16, exterior="reflecting")
        of = Coefficient("source", source, ("x", "t", "u"))
        u = line.react(
            0.0, 1.0, lambda x, t, u: of({"x": x, "t": t, "u": u}) + 0.0 * x, tolerance=RTOL
        )
    held = np.exp(-30.0 * on)
    assert u == pytest.approx(0.5386 * held + (1.0 - held) / 30.0 + 1.0 - 0.5386 - on, rel=NEAR)


@pytest.mark.parametrize(
    ("domain", "particles", "on_from"),
    [
        ("interval", 16, "abs(x - 0.33) + 0.2"),
        ("interval", 40, "1.2 - x"),  # from an end on, where particles are 1e-9 apart
        ("square", 12, "abs(x - 0.33) + 0.2"),
    ],
)
def test_the_edge_of_a_source_may_move_into_nothing(domain, particles, on_from):
    """It was refused where no particle that was looked at is the first to be in the source."""
    problem = Problem(
        domain=domain, exterior="reflecting", half_width=1.0, alpha=1.5, t_final=0.6,
        particles=particles, source=f"where({on_from} < t, 1, 0)",
    )  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # so few particles do not resolve an edge
        run = solve_problem(problem, lambda *place: 0.0 * sum(place), estimate=False)
    begin = Coefficient("source", on_from, problem.places)(problem.places)
    brought = float((problem.bounded_domain.volumes * np.maximum(0.0, 0.6 - begin)).sum())
    assert float(run.mass_final) == pytest.approx(brought, rel=NEAR)


@pytest.mark.parametrize("integrator", ["dop853", "rkc2"])
def test_nor_on_the_line(integrator):
    problem = Problem(
        alpha=1.5, half_width=20.0, spacing=0.1, t_final=0.6, integrator=integrator, rtol=1e-4,
        source="where(abs(x - 0.33) < t - 0.2, 1, 0)",
    )  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        run = solve_problem(problem, lambda x: 0.0 * x, estimate=False)
    brought = 0.1 * float(np.maximum(0.0, 0.4 - np.abs(problem.places["x"] - 0.33)).sum())
    beyond = 1.0 - central_mass(19.0, 0.6, 1.5, 1)  # of what is brought within a unit at t = 0
    assert (
        (1.0 - beyond - 50.0 * 1e-4) * brought
        < float(run.mass_final)
        < (1.0 + 50.0 * 1e-4) * brought
    )


@pytest.mark.usefixtures("silent")
@pytest.mark.parametrize(
    ("kind", "width", "form"),
    covering(["interval", "square", "disc"], [1e-3, 1e-6], ["adds", "reacts", "multiplies"]),
)
def test_a_domain_alone_does_not_step_over_a_pulse_either(kind, width, form):
    """It was 0.64 of u too small at 1e-6."""
    domain = {
        "interval": lambda: Interval(alpha=1.5, particles=16, exterior="reflecting"),
        "square": lambda: Square(1.5, 8, "reflecting"),
        "disc": lambda: Disc(1.5, 8, 8, "reflecting"),
    }[kind]()

    def pulse(t):
        return np.exp(-(((t - 0.512345) / width) ** 2)) / width

    def adds(*at):
        *place, t = at
        return 1.0 + pulse(t) + 0.0 * sum(place)

    if form == "adds":
        u, exact = domain.evolve(0.0, 1.0, adds, tolerance=RTOL), 1.0 + TOTAL
    elif form == "reacts":
        u, exact = domain.react(0.0, 1.0, lambda *at: adds(*at[:-1]), tolerance=RTOL), 1.0 + TOTAL
    else:
        u = domain.react(1.0, 1.0, lambda *at: at[-1] * pulse(at[-2]), tolerance=RTOL)
        exact = np.exp(TOTAL)
    assert u == pytest.approx(exact, rel=NEAR)


def test_values_outside_that_are_on_for_a_millionth_of_the_run_are_refused():
    fields = {"exterior": "given", "half_width": 1.0, "alpha": 1.5, "t_final": 1.0}
    g = PULSE.format(1e-6) + "/(1 + x**2)"
    with pytest.raises(NonFiniteSolution, match="jump"):
        solve_problem(Problem(**fields, exterior_data=g, particles=16), lambda x: 0.0 * x)


@pytest.mark.usefixtures("silent")
def test_what_starts_from_nothing_and_is_fast_has_its_own_tolerance():
    """It was that of the source times the time, a million times u, and was warned of."""
    u, _ = level("-1e6*(u - cos(t)) - sin(t)", 0.0)
    assert u == pytest.approx(np.cos(1.0), rel=NEAR)
    u, _ = level("1e3*exp(-1e3*t)", 0.0)
    assert u == pytest.approx(1.0, rel=NEAR)


@pytest.mark.usefixtures("silent")
def test_values_outside_that_are_nothing_at_first_are_no_reason_to_stop():
    """The steps followed the round-off of their interpolation. A pulse gives about what a wider one gives."""
    fields = {"exterior": "given", "half_width": 1.0, "alpha": 1.5, "t_final": 1.0, "particles": 16}
    narrow, wide = (
        solve_problem(
            Problem(**fields, exterior_data=PULSE.format(w) + "/(1 + x**2)"),
            lambda x: 0.0 * x, estimate=False,
        ).u.values
        for w in (0.04, 0.08)
    )  # fmt: skip
    # A pulse of width w makes exp(r^2 w^2 / 4) of a mode of rate r: 1.6 for the first, 9.6 for the next even one, of
    # which exp(-0.49 8) is left. Together that is 1.1 w^2; what other modes add may be as much.
    assert np.abs(narrow - wide).max() < 2.2 * 0.08**2 * np.abs(wide).max()


@pytest.mark.parametrize("exceeds", [1e-5, 1e-7])
def test_an_error_that_grows_at_a_threshold_is_warned_of(exceeds):
    """u leaves the threshold 0.3 at the rate 21, so that the errors of the first steps grow by exp(21)."""
    source = "100*u*(u - 0.3)*(1 - u)"
    start = 0.3 + exceeds
    exact = solve_ivp(
        lambda t, u: 100.0 * u * (u - 0.3) * (1.0 - u), (0.0, 0.6), [start], "Radau", rtol=1e-12, atol=1e-15
    ).y[0, -1]  # fmt: skip
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        u, run = level(source, start, t_final=0.6, rtol=1e-4, estimate=True)
    off = abs(u - exact) / abs(u)
    assert float(run.time_error) > 0.5 * min(off, 1.0) or off < TIME_ERROR
    assert off < TIME_ERROR or any("steps in time" in str(one.message) for one in said)


def test_near_a_blow_up_the_errors_of_the_steps_are_said():
    """u = 1 / (1 - t): an error e of t is an error e u of u."""
    with pytest.warns(AccuracyWarning, match="steps in time"):
        u, run = level("u**2", 1.0, t_final=0.99999, rtol=1e-4, estimate=True)
    assert float(run.time_error) > 0.5 * abs(u / 1e5 - 1.0)


def test_what_is_linear_and_steady_has_no_such_error():
    assert "time_error" not in level("1", 0.0, estimate=True)[1]


@pytest.mark.usefixtures("silent")
def test_a_source_that_ignites_is_taken_implicitly_from_there_on(monkeypatch):
    """Its rate is 0.04 at first and 1e6 at last; explicit steps were too many, and it was refused."""
    monkeypatch.setattr(switching, "_MOST", 100)
    u, run = level("1e6*(1 - u)*exp(17*(u - 1))", 0.0, t_final=2.0)
    assert u == pytest.approx(1.0, rel=NEAR)
    assert str(run.integrator.values) == "radau"


def test_steps_over_a_source_that_jumps_with_u_do_not_agree_by_chance():
    """u' = 1 below 1/2 and -1 above: three steps agreed on no change at all, and u stayed at 0.364."""
    line = Interval(alpha=1.5, particles=16, exterior="reflecting")
    steps = ExponentialSteps(line.all_modes(), lambda t, u: np.where(u < 0.5, 1.0, -1.0), RTOL)
    u = steps.advance(np.zeros(16), 0.6)
    assert np.abs(u - 0.5).max() < 0.01


def test_what_overflows_beside_implicit_steps_says_so():
    with pytest.raises(NonFiniteSolution, match="grows without bound"):
        level("1e5*(0.5 - t)*u", 1.0, rtol=0.1)


@pytest.mark.usefixtures("silent")
def test_particles_that_follow_do_not_step_over_a_pulse():
    """It was, and u was 0.68 of its greatest value too small. The source has the shape of the data."""
    at, width = 0.512345, 1e-3

    def source(x, t, u):
        return green(x, 1.0, 1.5) * np.exp(-(((t - at) / width) ** 2)) / width

    (run,) = follow(
        lambda x: green(x, 1.0, 1.5), 1.0, alpha=1.5, window=(-10.0, 10.0), source=source
    )
    x = run.particles.x
    exact = green(x, 2.0, 1.5) + TOTAL * green(x, 2.0 - at, 1.5)
    # The tolerance of the splitting and that of the placements are about 1e-5.
    assert np.abs(run.u - exact).max() < 1e-4 * exact.max()
