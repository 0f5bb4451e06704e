"""Problems on an interval, a disc and a square: manufactured solutions, orders, invariants, and what is refused."""

from __future__ import annotations

import warnings
from functools import partial
from math import gamma

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import eval_jacobi, gammaln, hyp2f1

from fracparticles.bounded.interval import Interval
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.problems import Problem, solve_problem
from fracparticles.problems.domain_rates import DomainRates
from fracparticles.run.dataset import write
from sweeps import covering, few

# The error is measured: to estimate it, too, takes as long again.
solved = partial(solve_problem, estimate=False)

ALPHAS = (1.1, 1.5, 1.9)
LINE = {"alpha": 1.5, "half_width": 1.0, "t_final": 1.0, "exterior": "absorbing"}
DISC = {**LINE, "domain": "disc", "particles": 16}
SQUARE = {**LINE, "domain": "square", "particles": 12}
KINDS = {"interval": {**LINE, "particles": 40}, "disc": DISC, "square": SQUARE}


def laplacian(r2, alpha, power, dim=1):
    """(-Laplacian)^(alpha/2) (1 - r^2)_+^power inside: B. Dyda, Fract. Calc. Appl. Anal. 15 (2012) 536, Theorem 1."""
    s, half = 0.5 * alpha, 0.5 * (dim + alpha)
    size = 2.0**alpha * gamma(half) * gamma(power + 1.0) / gamma(0.5 * dim) / gamma(power + 1.0 - s)
    return size * hyp2f1(half, s - power, 0.5 * dim, r2)


def mean_error(run, exact):
    return float((run.volume.values * np.abs(run.u.values - exact)).sum())


def places(run):
    if run.x.ndim == 2 or "y" not in run:
        return [run[name].values for name in ("x", "y") if name in run]
    return np.meshgrid(run.x.values, run.y.values, indexing="ij")


# --- the interval ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("alpha", "swing"), few([(1.1, ""), (1.1, "*cos(t)"), (1.5, ""), (1.9, ""), (1.9, "*cos(t)")])
)
def test_the_flux_form_with_a_diffusivity_that_varies(alpha, swing):
    """u = e^-t (1 - x^2)^(alpha/2): grad^beta u = -Gamma(1 + alpha) x e^-t, of D = 1 + x / 2 (cos t)."""
    size = gamma(1.0 + alpha)
    source = f"exp(-t)*({size!r}*(1 + x{swing}) - (1 - x**2)**{0.5 * alpha!r})"
    problem = Problem(
        **{**LINE, "alpha": alpha, "t_final": 0.5}, diffusivity=f"1 + 0.5*x{swing}", source=source,
        rtol=1e-8,
    )  # fmt: skip
    run = solved(problem, lambda x: (1.0 - x * x) ** (0.5 * alpha))
    exact = np.exp(-0.5) * (1.0 - run.x.values**2) ** (0.5 * alpha)
    assert np.abs(run.u.values - exact).max() < 1e-6
    assert mean_error(run, exact) < 1e-7
    assert run.attrs["title"].endswith("div(D grad^beta u) + f")


def by_jacobi(alpha, d, load, x, terms=30):
    """u of D grad^beta u = -F + C, F' = load, u = 0 outside: by the polynomials of `test_coefficients`.

    D grad^beta w sum c_n P_n = -D sum 2 mu_n / (n + 2 a) c_n P_(n+1)^(a-1, a-1): collocation, with C as one more
    unknown.
    """
    a, n = 0.5 * alpha, np.arange(terms)
    nodes = np.cos(np.pi * (np.arange(terms + 1) + 0.5) / (terms + 1))
    mu = np.exp(gammaln(alpha + n + 1.0) - gammaln(n + 1.0))
    flux = -2.0 * mu / (n + alpha) * eval_jacobi(n + 1, a - 1.0, a - 1.0, nodes[:, None])
    matrix = np.column_stack([d(nodes)[:, None] * flux, -np.ones(terms + 1)])
    c = np.linalg.solve(matrix, -load(nodes))[:-1]
    return (1.0 - x * x) ** a * (eval_jacobi(n, a, a, x[:, None]) @ c)


@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_a_problem_comes_to_rest_where_its_flux_is_the_integral_of_the_source(alpha):
    """div(D grad^beta u) + 1 = 0, D = e^x: no closed form, but an oracle of thirty polynomials."""
    problem = Problem(
        **{**LINE, "alpha": alpha, "t_final": 30.0}, diffusivity="exp(x)", source="1", rtol=1e-7
    )
    run = solved(problem, 0.0)
    exact = by_jacobi(alpha, np.exp, lambda x: x, run.x.values)
    assert mean_error(run, exact) < 1e-6


@pytest.mark.parametrize(
    ("alpha", "speed"), covering(ALPHAS, ["2 + x", "-8*x", "cos(3*t)*(1 + x)"])
)
def test_a_velocity_with_absorbing_ends(alpha, speed):
    """u = e^-t (1 - x^2)^p, p = alpha/2 + 1; a against D from small to large."""
    p = 0.5 * alpha + 1.0

    def source(x, t):
        a, slope = {
            "2 + x": (2.0 + x, 1.0),
            "-8*x": (-8.0 * x, -8.0),
            "cos(3*t)*(1 + x)": (np.cos(3 * t) * (1.0 + x), np.cos(3 * t)),
        }[speed]
        y = 1.0 - x * x
        moved = slope * y**p - 2.0 * p * a * x * y ** (p - 1.0)
        return np.exp(-t) * (laplacian(x * x, alpha, p) - y**p + moved)

    problem = Problem(**{**LINE, "alpha": alpha}, velocity=speed, source=source, rtol=1e-7)
    run = solved(problem, lambda x: (1.0 - x * x) ** p)
    assert np.abs(run.u.values - np.exp(-1.0) * (1.0 - run.x.values**2) ** p).max() < 1e-6
    assert run.integrator == "radau"


def test_the_order_of_a_problem_is_that_of_the_particles():
    errors, alpha = [], 1.5
    for particles in (30, 60):
        size = gamma(1.0 + alpha)
        source = f"{size!r}*(1 + x) + 0*t"
        problem = Problem(
            **{**LINE, "t_final": 30.0}, particles=particles, diffusivity="1 + 0.5*x", source=source,
            rtol=1e-9,
        )  # fmt: skip
        run = solved(problem, 0.0)
        errors.append(mean_error(run, (1.0 - run.x.values**2) ** (0.5 * alpha)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(8.0 - alpha, abs=1.0)


@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_all_at_once_with_values_given_outside(alpha):
    """u = e^-t / (1 + x^2), with D(x, t), a(x), as text: what is outside is u itself."""
    power = 1.0 + alpha
    rate = f"gamma({power!r})*(1 + x**2)**{-0.5 * power!r}*cos({power!r}*arctan(x))"
    flux = f"gamma({alpha!r})*(1 + x**2)**{-0.5 * alpha!r}*sin({alpha!r}*arctan(x))"
    moved = "(1/(1 + x**2) - 2*x**2/(1 + x**2)**2)"
    source = f"exp(-t)*((1 + 0.3*x*cos(t))*{rate} + 0.3*cos(t)*{flux} - 1/(1 + x**2) + {moved})"
    problem = Problem(
        alpha=alpha, half_width=1.0, exterior="given", exterior_data="exp(-t)/(1 + x**2)", particles=80,
        diffusivity="1 + 0.3*x*cos(t)", velocity="x", source=source, times=(0.2, 0.4), rtol=1e-7,
    )  # fmt: skip
    run = solved(problem, lambda x: 1.0 / (1.0 + x * x))
    for time in (0.2, 0.4):
        exact = np.exp(-time) / (1.0 + run.x.values**2)
        assert np.abs(run.u.sel(t=time).values - exact).max() < 1e-6


@pytest.mark.parametrize(("alpha", "velocity"), covering([1.1, 1.9], [None, "1 - x**2"]))
def test_reflecting_ends_keep_the_mass_with_all_that_varies(alpha, velocity):
    problem = Problem(
        **{**LINE, "alpha": alpha, "exterior": "reflecting"}, form="exchange",
        diffusivity="1 + 0.5*x*cos(t)", velocity=velocity, times=(0.1, 1.0),
    )  # fmt: skip
    run = solved(problem, lambda x: np.exp(-8.0 * (x - 0.3) ** 2))
    assert run.mass.values == pytest.approx(float(run.mass_initial), rel=1e-12)


# --- every domain ---------------------------------------------------------------------------------


def bell(*points):
    return np.exp(-6.0 * sum(np.square(part - 0.2) for part in points))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("exterior", ["absorbing", "reflecting"])
def test_a_plain_problem_is_what_the_domain_does(kind, exterior):
    problem = Problem(**{**KINDS[kind], "exterior": exterior}, diffusivity=0.7, rtol=1e-9)
    run = solved(problem, bell)
    exact = problem.bounded_domain.evolve(bell, 0.7)
    assert np.abs(run.u.values - exact).max() < 1e-8
    assert run.attrs["reproducible"] == "yes"
    again = Problem.from_json(run.attrs["problem"])
    assert again == problem
    assert (solved(again, bell).u == run.u).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_diffusivity_in_time_is_its_integral(kind):
    problem = Problem(**KINDS[kind], diffusivity="0.2 + t", rtol=1e-8)
    run = solved(problem, bell)
    exact = problem.bounded_domain.evolve(bell, 0.7)
    assert np.abs(run.u.values - exact).max() < 1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_decay_and_growth_have_their_factor(kind):
    run = solved(Problem(**KINDS[kind], source="-0.8*u*cos(t)", rtol=1e-8), bell)
    plain = solved(Problem(**KINDS[kind], rtol=1e-9), bell)
    exact = np.exp(-0.8 * np.sin(1.0)) * plain.u.values
    assert np.abs(run.u.values - exact).max() < 1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_a_constant_that_is_given_stays_with_all_that_varies(kind):
    varies = {"diffusivity": "1 + 0.4*x*cos(t)", "form": "exchange"}
    run = solved(Problem(**{**KINDS[kind], "exterior": "given", "exterior_data": 2}, **varies), 2.0)
    # Explicit steps hold a state of rest to their tolerance, 1e-6 of it.
    assert np.abs(run.u.values - 2.0).max() < (1e-5 if kind == "square" else 1e-11)


@pytest.mark.parametrize("kind", ["disc", "square"])
def test_the_plane_keeps_the_mass_with_all_that_varies(kind):
    along = ("-y*(1 - x**2)", "x*(1 - y**2)") if kind == "square" else ("-y", "x*cos(0*t)")
    problem = Problem(
        **{**KINDS[kind], "exterior": "reflecting", "particles": 16}, form="exchange",
        diffusivity="1 + 0.4*x*cos(t)", velocity=along,
    )  # fmt: skip
    run = solved(problem, bell)
    assert float(run.mass_final) == pytest.approx(float(run.mass_initial), rel=1e-12)


@pytest.mark.parametrize("alpha", [1.2, 1.8])
def test_a_rotation_of_the_disc_turns_the_solution(alpha):
    """Three of 24 angles in the time of the run, about what turned data become: an exact symmetry."""
    fields = {**DISC, "alpha": alpha, "particles": 48, "rtol": 1e-7}
    angle = 2.0 * np.pi * 3 / 24
    still = solved(Problem(**fields), bell)
    turned = solved(Problem(**fields, velocity=(f"-{angle}*y", f"{angle}*x")), bell)
    assert np.abs(np.roll(still.u.values, 3, axis=1) - turned.u.values).max() < 1e-6


@pytest.mark.parametrize(
    ("kind", "alpha"), few([("disc", 1.8), ("disc", 1.2), ("square", 1.5), ("square", 1.2)])
)
def test_a_velocity_in_the_plane(kind, alpha):
    """u = e^-t (1 - r^2)^p, on the disc with p = alpha/2 + 1, on the square zero near its edges, p = 5."""
    p = 0.5 * alpha + 1.0 if kind == "disc" else 5.0

    def field(x, y):
        return np.maximum(1.0 - x * x - y * y, 0.0) ** p

    def source(x, y, t):
        q, r2 = np.maximum(1.0 - x * x - y * y, 0.0), x * x + y * y
        inside = laplacian(np.minimum(r2, 1.0), alpha, p, 2)
        far, s = np.maximum(r2, 1.0), 0.5 * alpha
        c = alpha * 2.0 ** (alpha - 1.0) * gamma(1.0 + s) / gamma(1.0 - s)
        beyond = -c / (p + 1.0) * far ** (-1.0 - s) * hyp2f1(1.0 + s, 1.0 + s, p + 2.0, 1.0 / far)
        moved = -2.0 * p * ((1.0 + y) * x + 0.5 * y) * q ** (p - 1.0)
        return np.exp(-t) * (np.where(r2 < 1.0, inside, beyond) - q**p + moved)

    errors = []
    for particles in (24, 48) if kind == "disc" else (16, 32):
        fields = {**KINDS[kind], "alpha": alpha, "particles": particles, "t_final": 0.5}
        run = solved(Problem(**fields, velocity=("1 + y", "0.5"), source=source), field)
        errors.append(mean_error(run, np.exp(-0.5) * field(*places(run))))
    assert errors[-1] < (1e-4 if alpha < 1.7 else 2e-4) * np.pi
    assert np.log2(errors[0] / errors[1]) > 4.0 - alpha - 0.4


@pytest.mark.parametrize("kind", ["disc", "square"])
def test_a_field_of_the_plane_that_is_carried_and_given_outside(kind):
    alpha, p, s = 1.5, 2.3, 0.75

    def g(x, y, t):
        return np.cos(t) * (1.0 + x**2 + y**2) ** -p

    def source(x, y, t):
        q = 1.0 + x**2 + y**2
        size = 2.0**alpha * gamma(p + s) * gamma(1.0 + s) / gamma(p)
        still = size * hyp2f1(p + s, 1.0 + s, 1.0, 1.0 - q) - 2.0 * p * x * q ** (-p - 1.0)
        return np.cos(t) * still - np.sin(t) * q**-p

    fields = {**KINDS[kind], "exterior": "given", "exterior_data": g, "t_final": 0.4}
    fields["particles"] = 48 if kind == "disc" else 16
    run = solved(Problem(**fields, velocity=(1.0, 0.0), source=source), lambda x, y: g(x, y, 0.0))
    assert np.abs(run.u.values - g(*places(run), 0.4)).max() < 6e-4
    assert run.attrs["reproducible"].startswith("no")


@pytest.mark.parametrize("kind", KINDS)
def test_the_data_set_says_where_its_particles_are(kind, tmp_path):
    problem = Problem(**{**KINDS[kind], "t_final": 0.1}, diffusivity=0.5)
    run = solved(problem, bell)
    assert run.u.shape == problem.bounded_domain.volumes.shape
    for ours, name in zip(places(run), ("x", "y"), strict=False):
        assert (ours == problem.places[name]).all()
    assert float(run.mass) == pytest.approx(float((run.volume * run.u).sum()), rel=1e-13)
    assert str(run.domain.values) == kind
    write(run, tmp_path / "run.nc")


def test_a_source_that_is_faster_than_all_else_is_taken_implicitly():
    """u' = .. - 1e6 (u - cos t): u is cos t, but where it is zero outside within a layer of d ~ 1e-4."""
    run = solved(Problem(**LINE, source="-1e6*(u - cos(t))"), lambda x: 1.0 + 0.0 * x)
    assert run.integrator == "radau"
    assert np.abs(run.u.values[np.abs(run.x) < 0.5] - np.cos(1.0)).max() < 1e-5
    with pytest.raises(InvalidInput, match=r"^source = .*on the disc"):
        solve_problem(Problem(**DISC, source="-1e6*(u - cos(t))"), 1.0)


@pytest.mark.parametrize("fields", [{**LINE, "particles": 60}, {**DISC, "particles": 16}])
def test_a_source_that_takes_the_same_part_everywhere_costs_no_steps(fields):
    """u = e^(-200 t) of that without, to round-off of an exponent of 600: in as many steps, and 3500 were taken."""
    fields = {**fields, "t_final": 3.0}
    plain, taken = (solved(Problem(**fields, source=f), 1.0) for f in (None, "-200*u"))
    assert taken.integrator == "exponential"
    assert taken.accepted_steps == plain.accepted_steps < 10
    scaled = taken.u.values * np.exp(300.0) * np.exp(300.0)
    assert (
        np.abs(scaled - plain.u.values).max()
        < 1e3 * np.finfo(float).eps * np.abs(plain.u.values).max()
    )


@pytest.mark.parametrize(
    ("source", "rate"),
    [("-300*u", 300.0), ("1 - 3*u", 3.0), ("-u**2", 0.0), ("2*u", 0.0), ("-300*u*t", 0.0)],
)
def test_the_decay_of_a_source_is_known_where_it_is_one(source, rate):
    rates = DomainRates(Problem(**LINE, source=source))
    for v in (np.ones(rates.shape), np.cos(rates.domain.x), np.zeros(rates.shape)):
        expected = rate if v.any() else 0.0
        assert rates.decay(v) == pytest.approx(expected, rel=1e-9)


# --- what warns, and what is refused --------------------------------------------------------------


def test_what_the_particles_do_not_resolve_warns():
    narrow = Problem(
        **{**LINE, "particles": 40, "t_final": 0.1},
        velocity="exp(-((x - 0.013)/0.003)**2)",
        diffusivity=1.0,
    )
    with pytest.warns(AccuracyWarning, match="do not resolve the velocity"):
        solve_problem(narrow, bell)
    steps = {"diffusivity": "where(x > 0.1, 2, 1)", "source": "1000*exp(-((x - 0.013)/0.003)**2)"}
    for field, text in steps.items():
        with pytest.warns(AccuracyWarning, match=f"do not resolve the {field}"):
            solve_problem(
                Problem(**{**LINE, "particles": 40, "t_final": 0.1}, **{field: text}), bell
            )
    with pytest.warns(AccuracyWarning, match="do not resolve the initial data"):
        solve_problem(
            Problem(**{**LINE, "particles": 40, "t_final": 0.1}),
            lambda x: np.exp(-(((x - 0.1) / 0.004) ** 2)),
        )
    front = Problem(
        **{**LINE, "particles": 40, "t_final": 0.1}, diffusivity=1e-5, velocity="-20*tanh(20*x)"
    )
    with pytest.warns(AccuracyWarning, match="leave an error"):
        solve_problem(front, lambda x: np.exp(-((x / 0.3) ** 2)))


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_resolved_says_nothing(kind):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solve_problem(Problem(**{**KINDS[kind], "t_final": 0.1}), bell)


REFUSED = {
    "domain on the whole space": ({"exterior": "open", "spacing": 0.1}, "domain"),
    "particles on the whole space": (
        {"exterior": "open", "spacing": 0.1, "particles": 50, "domain": None}, "particles"),
    "data on the whole space": (
        {"exterior": "open", "spacing": 0.1, "exterior_data": 1, "domain": None}, "exterior_data"),
    "no spacing": ({"exterior": "open", "domain": None}, "spacing"),
    "spacing": ({"spacing": 0.1}, "spacing"),
    "order": ({"order": 4}, "order"),
    "overlap": ({"overlap": 2.0}, "overlap"),
    "far terms": ({"far_terms": 1}, "far_terms"),
    "a disc on the line": ({"domain": "disc", "dim": 1}, "domain"),
    "an interval in the plane": ({"dim": 2}, "domain"),
    "no domain in the plane": ({"dim": 2, "domain": None}, "domain"),
    "few": ({"particles": 8}, "particles"),
    "True": ({"particles": True}, "particles"),
    "many rings": ({"domain": "disc", "particles": 129}, "particles"),
    "many rings with D": (
        {"domain": "disc", "particles": 128, "form": "exchange", "diffusivity": "1 + x**2"}, "particles"),
    "no data": ({"exterior": "given"}, "exterior_data"),
    "data": ({"exterior_data": 1.0}, "exterior_data"),
    "data of u": ({"exterior": "given", "exterior_data": "u"}, "exterior_data"),
    "order that varies": ({"alpha": "1.5 + 0.1*x", "form": "DD"}, "beta"),
    "integrator": ({"integrator": "rkc2"}, "integrator"),
    "DD": ({"form": "DD"}, "form"),
    "flux where nothing leaves": ({"exterior": "reflecting", "diffusivity": "2 + x"}, "form"),
    "flux in the plane": ({"domain": "disc", "diffusivity": "2 + x"}, "form"),
    "no diffusion": ({"diffusivity": 0.0}, "diffusivity"),
    "negative somewhere": ({"diffusivity": "0.5 - x"}, "diffusivity"),
    "through an end": ({"exterior": "reflecting", "velocity": "1"}, "velocity"),
    "through an end later": ({"exterior": "reflecting", "velocity": "t"}, "velocity"),
    "through the disc": ({"exterior": "reflecting", "domain": "disc", "velocity": ("x", "y")}, "velocity"),
    "through the square": ({"exterior": "reflecting", "domain": "square", "velocity": ("0", "y")}, "velocity"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_has_no_meaning_is_refused_in_one_line(case):
    fields, field = REFUSED[case]
    every = {"domain": "interval", **LINE, **fields}
    with pytest.raises(InvalidInput, match=rf"^{field} (=|is missing)") as caught:
        Problem(**every)
    assert "\n" not in str(caught.value)


def test_a_line_with_ends_is_an_interval_and_a_disc_is_plane():
    assert Problem(**LINE).domain == "interval"
    assert isinstance(Problem(**LINE).bounded_domain, Interval)
    assert Problem(**DISC).dim == 2
    whole = Problem(alpha=1.5, half_width=5.0, spacing=0.5, t_final=1.0)
    with pytest.raises(InvalidInput, match=r"^exterior = "):
        _ = whole.bounded_domain
    with pytest.raises(InvalidInput, match=r"^exterior = "):
        _ = Problem(**LINE).case


@pytest.mark.parametrize("initial", [None, "file.nc", np.ones(3), lambda x: x / 0.0 * np.nan])
def test_initial_data_that_do_not_fit_are_refused(initial):
    with pytest.raises(InvalidInput, match=r"^initial (=|is missing)"):
        solve_problem(Problem(**LINE), initial)


def test_a_result_is_no_bare_array():
    problem = Problem(**LINE, particles=20)
    with pytest.raises(InvalidInput, match=r"^initial = .*bare array"):
        solve_problem(problem, solved(problem, bell).u)


@pytest.mark.parametrize("place", ["(1 + 0.5*x)", ""])
def test_a_diffusivity_in_time_beside_data_that_jump_at_an_end(place):
    """D(x) s(t) is D(x) at the time int s. The steps were as short as the fastest mode, of which nothing is known."""
    fields = {**LINE, "alpha": 1.98, "exterior": "given", "exterior_data": "1", "particles": 100}
    fields["form"] = "exchange" if place else "FPSE"
    moved = Problem(**fields | {"t_final": 0.1}, diffusivity=f"1{place and '*' + place}*(1 + 2*t)")
    still = Problem(**fields | {"t_final": 0.11}, diffusivity=f"1{place and '*' + place}")
    run, other = (solved(one, lambda x: 0.0 * x) for one in (moved, still))
    assert int(run.accepted_steps) < 1000
    assert_allclose(run.u.values, other.u.values, atol=100.0 * moved.rtol)


def test_a_source_that_starts_after_all_has_left():
    """u is e^-90 of what it was where the source begins: from there it is as from nothing."""
    fields = {**LINE, "particles": 60}
    late = solved(Problem(**fields, source="where(t > 0.5, 1, 0)*exp(-x**2) - 180*u"), bell)
    fields["t_final"] = 0.5
    alone = solved(Problem(**fields, source="exp(-x**2) - 180*u"), 0.0)
    assert_allclose(late.u.values, alone.u.values, atol=1e-5 * float(alone.u.max()))


@pytest.mark.parametrize(
    ("size", "fields"),
    covering(
        [2.0**-660, 2.0**530],
        [
            {"source": "-40*x*u"},
            {"velocity": "20*(1 - x**2)"},
            {"domain": "disc", "velocity": ("-9*y", "9*x")},
        ],
    ),
)
def test_a_strength_of_any_size_has_the_same_steps(size, fields):
    """Its square is no number: the steps were one after another as long as they could be."""
    problem = Problem(**{**LINE, "t_final": 0.3}, particles=24, **fields)

    def at(*place):
        return np.exp(-8.0 * sum((x - 0.2) ** 2 for x in place))

    one, other = (solved(problem, lambda *p, c=c: c * at(*p)) for c in (1.0, size))
    assert_allclose(other.u.values / size, one.u.values, atol=1e-12)


def test_a_diffusivity_that_makes_neighbours_give_what_they_have_not_is_refused():
    peak = "0.05*(0.001 + exp(-((x - 0.456)/0.02)**2))"
    problem = Problem(**{**LINE, "alpha": 1.9, "particles": 80}, form="exchange", diffusivity=peak)
    with pytest.warns(AccuracyWarning), pytest.raises(InvalidInput, match="diffusivity"):
        solve_problem(problem, bell)
