"""Stiff problems: the time integration against dense linear algebra, itself in pieces, and what must not change it."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from fracparticles.errors import (
    AccuracyWarning,
    FracparticlesError,
    InvalidInput,
    NonFiniteSolution,
    StabilityWarning,
)
from fracparticles.lattice.operators import ConvolutionOperator
from fracparticles.run.case import Case
from fracparticles.run.solver import compute, prepare
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import dense_matrix, largest_degree
from fracparticles.time import STEP_POLYNOMIALS, exponential_flow, power_flow
from sweeps import few

EPS = np.finfo(float).eps


def bump(*x: np.ndarray) -> np.ndarray:
    return np.exp(-sum(np.square(part) for part in x))


def stiff(**given) -> Case:
    fields = {"beta": 0.9, "half_width": 10.0, "spacing": 0.1, "t_initial": 0.0}
    integrator = (
        {} if "dt" in given or given.get("scheme") == "GPSE" else {"integrator": "exponential"}
    )
    return Case(**{**fields, **integrator, **given})


def matrix_run(case: Case, u0: np.ndarray, time: float) -> np.ndarray:
    """exp(A time) u0 of a symmetric A, from its eigenvectors."""
    values, vectors = np.linalg.eigh(dense_matrix(SCHEMES[case.scheme].operator(case.setting)))
    return vectors @ (np.exp(np.minimum(values, 0.0) * time) * (vectors.T @ u0.ravel()))


# --- what conserves ends at its mean, whatever the time --------------------------------------------------------------


@pytest.mark.parametrize(
    ("order", "time"),
    few([(2, 1e7), (2, 1e4), (2, 3e5), (2, 1e8), (2, 1e6), (4, 1e6), (12, 1e4), (12, 1e6)], 3),
)
def test_a_conservative_scheme_ends_at_the_mean(order, time):
    case = stiff(scheme="KPSE", order=order, t_final=time)
    u = prepare(case).solve(bump(case.x))
    # The slowest wave has decayed: what is left is the mean, to the round-off T |lambda| eps of the operator.
    # A rounding of the sum by transforms is some ulp of its terms.
    room = 4.0 * EPS * time * case.setting.rate * -case.symbol_range[0] + 1e-13
    assert u == pytest.approx(np.full(u.size, bump(case.x).mean()), rel=room)


@pytest.mark.parametrize("integrator", ["euler", "rk2", "rk4"])
def test_so_do_steps_by_a_series(integrator):
    probe = stiff(scheme="KPSE", integrator=integrator, dt=1.0)
    for share in (0.1, 0.99):
        case = stiff(
            scheme="KPSE", integrator=integrator, dt=share * probe.largest_stable_step, t_final=1e6
        )
        u = prepare(case).solve(bump(case.x))
        assert u == pytest.approx(np.full(u.size, bump(case.x).mean()), rel=1e-7)


def test_steps_at_the_limit_do_not_grow():
    """At a (1 - 1e-12) a billion steps are stable, and an interval with room below would not be."""
    for integrator in ("euler", "rk2"):
        probe = stiff(scheme="KPSE", integrator=integrator, dt=1.0)
        dt = probe.largest_stable_step * (1.0 - 1e-12)
        case = stiff(scheme="KPSE", integrator=integrator, dt=dt, t_final=1e8 * dt)
        u = prepare(case).solve(bump(case.x))
        assert np.abs(u).max() <= 1.0


def test_gpse_in_many_steps_and_finite_differences_at_a_tiny_beta():
    case = stiff(scheme="GPSE", overlap=2.0, t_final=1e6)
    assert prepare(case).solve(bump(case.x)) == pytest.approx(bump(case.x).mean(), rel=1e-7)
    case = stiff(scheme="FD", beta=1e-6, half_width=1.0, t_final=1.0)
    exact = matrix_run(case, bump(case.x), 1.0)
    assert np.abs(prepare(case).solve(bump(case.x)) - exact).max() <= 1e-9 * np.abs(exact).max()


@pytest.mark.parametrize("scheme", ["DD", "KPSE", "DPSE", "FD"])
@pytest.mark.parametrize("time", [1.0, 1e2, 1e4, 1e6])
def test_the_exponential_of_a_stiff_matrix(scheme, time):
    """Relative to the solution, which decays by many decades where the ends absorb."""
    case = stiff(scheme=scheme, beta=0.5, half_width=2.0, t_final=time)
    a = dense_matrix(SCHEMES[scheme].operator(case.setting))
    u0 = bump(case.x)
    values, vectors = np.linalg.eig(a)
    values = values.real
    keep = (values - values.max()) * time > -60.0
    # The slow modes, and how far they decay; all others are gone.
    left = np.linalg.inv(vectors)
    decayed = values.max() * time
    if decayed < -600.0:
        return  # underflow
    exact = (vectors[:, keep] * np.exp(values[keep] * time)) @ (left[keep] @ u0)
    # The eigenvalues that both work with are off by eps |lambda|; each piece keeps 1e-10.
    room = 100.0 * EPS * np.abs(values).max() * time + 1e-8
    assert np.abs(prepare(case).solve(u0) - exact).max() <= room * np.abs(exact).max()


def test_a_lattice_refined_far_below_the_data():
    """An open lattice of C = 2.7: the same solution at every spacing, and its mass."""
    runs = {
        h: compute(Case(scheme="KPSE", beta=0.9, half_width=4.0, spacing=h, integrator="exponential", exterior="open"))
        for h in (1e-2, 2e-3, 1e-3)
    }  # fmt: skip
    middle = [run.u[run.u.size // 2] for run in runs.values()]
    # Second order in epsilon.
    assert abs(middle[2] - middle[1]) < abs(middle[1] - middle[0]) < 1e-4
    finest = runs[1e-3]
    assert finest.u.sum() * finest.case.particle_spacing == pytest.approx(0.972, abs=1e-3)


# --- not normal: FPSE in the plane -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("exterior", "time"), [("truncated", 1e3), ("truncated", 1e5), ("open", 20.0)]
)
def test_fpse_in_the_plane_is_the_exponential_of_its_matrix(exterior, time):
    case = stiff(
        scheme="FPSE",
        beta=0.99,
        half_width=8.0,
        spacing=1.0,
        dim=2,
        t_final=time,
        exterior=exterior,
    )
    operator = SCHEMES["FPSE"].operator(case.setting)
    u0 = bump(*(part / 2.0 for part in case.positions))
    exact = u0.ravel()
    half_way = 2 ** int(np.ceil(np.log2(time)))
    step = expm(dense_matrix(operator) * (time / half_way))
    for _ in range(half_way if half_way < 2000 else 0):
        exact = step @ exact
    if half_way >= 2000:
        exact = np.linalg.matrix_power(step, half_way) @ exact
    u = prepare(case, operator).solve(u0).ravel()
    assert np.abs(u - exact).max() <= 1e-7 * np.abs(exact).max()


def growth_of_chebyshev(case: Case, terms: int) -> float:
    """The rate at which |T_k(B) v| grows, per term, for random v."""
    operator = SCHEMES[case.scheme].operator(case.setting)
    low = case.setting.rate * case.symbol_range[0] + operator.diagonal_shift[0]
    b = 2.0 / -low * dense_matrix(operator) + np.eye(operator.size)
    v = np.random.default_rng(1).standard_normal((operator.size, 4))
    before, now, sizes = v, b @ v, []
    for k in range(2, terms + 1):
        before, now = now, 2.0 * b @ now - before
        if k in (terms // 2, terms):
            sizes.append(np.linalg.norm(now, axis=0).max())
    return float(np.log(sizes[1] / sizes[0]) / (terms - terms // 2))


def test_the_rates_that_the_largest_degrees_stand_on():
    """`spectrum.largest_degree`: T_k grows by exp(g k), and the terms of a series by exp((g K)^2 / 300)."""
    for scheme, exterior, change, most in [
        ("FPSE", "truncated", {}, 1e-3),
        ("FPSE", "truncated", {"order": 4}, 1e-3),
        ("FPSE", "open", {}, 1e-3),
        ("DD", "open", {}, 1e-3),
        ("KPSE", "open", {}, 1e-3),
        ("FPSE", "truncated", {"dim": 2, "half_width": 9.0}, 0.1),
        ("FPSE", "open", {"dim": 2, "half_width": 9.0}, 0.1),
        ("DD", "open", {"dim": 2, "half_width": 9.0}, 0.1),
        ("KPSE", "open", {"dim": 2, "half_width": 9.0, "kernel_table": 0.1}, 0.1),
        ("DD", "truncated", {"dim": 2, "half_width": 9.0, "kernel_table": 0.1}, 0.1),
        ("FPSE", "truncated", {"order": 4, "overlap": 0.75, "kernel_table": 0.1}, 0.1),
    ]:
        for beta in (0.1, 0.9):
            case = stiff(
                scheme=scheme,
                exterior=exterior,
                **{"beta": beta, "half_width": 60.0, "spacing": 1.0, "t_final": 1.0, **change},
            )
            terms = 1000 if case.dim == 1 else 400
            assert growth_of_chebyshev(case, terms) <= most, case
            operator = SCHEMES[scheme].operator(case.setting)
            assert largest_degree(case.scheme, case.setting, operator) == (
                10_000 if most == 1e-3 else 400
            )


# --- pieces ----------------------------------------------------------------------------------------------------------


def diagonal(eigenvalues) -> ConvolutionOperator:
    return ConvolutionOperator(np.zeros_like, np.asarray(eigenvalues, dtype=float), None)


def test_a_solution_that_decays_by_many_decades_keeps_its_digits():
    values = np.array([-1.0, -0.3, -0.03])
    time = 1000.0  # the last wave falls to 1e-13 of the data
    flow = exponential_flow(diagonal(values), time, -1.0, 0.0)
    u, applications = flow.run(np.ones(3))
    assert u[2] == pytest.approx(np.exp(-30.0), rel=1e-9)
    assert applications > flow.operator_applications  # one series alone loses them
    p = STEP_POLYNOMIALS["rk2"]
    u = power_flow(diagonal(values), p, 1.0, 1000, -1.0, 0.0)(np.ones(3))
    assert u[2] == pytest.approx(float(p(-0.03)) ** 1000, rel=1e-9)


def test_pieces_are_one_flow():
    values = -np.linspace(0.0, 1.0, 40)
    u0 = np.random.default_rng(2).standard_normal(40)
    exact = np.exp(values * 5000.0) * u0
    for most in (None, 100, 30):
        flow = exponential_flow(diagonal(values), 5000.0, -1.0, 0.0, most)
        u, applications = flow.run(u0)
        assert np.abs(u - exact).max() <= 1e-12
        assert applications == flow.operator_applications


def test_digits_that_no_piece_keeps_end_the_run(monkeypatch):
    """Pieces are not cut for ever: the run ends with an error, and says why."""
    monkeypatch.setattr("fracparticles.time.pieces._MOST_APPLICATIONS", 300)
    flow = exponential_flow(diagonal([-1.0, -0.3]), 1000.0, -1.0, 0.0)
    with pytest.raises(FracparticlesError, match="loses its digits"):
        flow.run(np.ones(2))


def test_what_would_take_too_long_is_refused_before_it_starts():
    with pytest.raises(InvalidInput, match=r"t_final.*takes .* applications of the operator"):
        prepare(
            stiff(scheme="FPSE", dim=2, spacing=0.5, half_width=4.0, t_initial=0.0, t_final=1e11)
        )


@pytest.mark.parametrize("size", [1e-290, 1.0, 1e290])
def test_data_of_any_size_decay_with_all_their_digits(size):
    flow = exponential_flow(diagonal([-1.0, -0.3, -0.03]), 1000.0, -1.0, 0.0)
    assert flow(size * np.ones(3))[2] == pytest.approx(size * np.exp(-30.0), rel=1e-9)


def test_what_is_below_every_number_is_zero_and_not_waited_for():
    flow = exponential_flow(diagonal([-1.0, -0.3]), 1e8, -1.0, 0.0)
    u, applications = flow.run(np.ones(2))
    assert np.array_equal(u, np.zeros(2))
    # The pieces that were tried, and some hundreds.
    assert applications < 5 * flow.operator_applications


def test_growth_beyond_all_numbers_says_when():
    flow = exponential_flow(diagonal([-1.0, 0.01]), 60_000.0, -1.0, 0.01)
    grown = flow(np.array([0.0, 1e-200]))
    assert grown[1] == pytest.approx(1e-200 * np.exp(600.0), rel=1e-9)
    with pytest.raises(NonFiniteSolution, match=r"overflow after .* of the time"):
        flow(np.array([0.0, 1e100]))


def test_a_series_that_would_take_too_many_terms_is_refused_at_once():
    with pytest.raises(FracparticlesError, match="more than 33554432 terms"):
        exponential_flow(diagonal([-1.0, 0.0]), 1e15, -1.0, 0.0)


def test_dpse_keeps_the_mass_to_the_round_off_of_its_operator():
    """The constant of the Riesz potential, 1 / beta, is taken off: its roundings would be ten times these."""
    case = stiff(scheme="DPSE", beta=0.1, half_width=8.0, spacing=1.0, t_final=1e6)
    u0 = bump(case.x)
    room = 10.0 * EPS * 1e6 * case.setting.rate * -case.symbol_range[0]
    assert prepare(case).solve(u0).sum() == pytest.approx(u0.sum(), rel=room)


# --- an overlap too small for the order ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scheme", "order", "overlap"),
    [("KPSE", 12, 1.0), ("KPSE", 4, 0.5), ("KPSE", 6, 0.7), ("FPSE", 10, 1.0), ("FPSE", 12, 1.15), ("DPSE", 4, 0.5)],
)  # fmt: skip
def test_no_step_is_stable_where_the_symbol_is_positive(scheme, order, overlap):
    case = stiff(
        scheme=scheme,
        order=order,
        overlap=overlap,
        beta=0.5 if scheme == "FPSE" else 0.999,
        dt=1e-4,
        t_final=0.1,
        half_width=5.0,
    )
    assert case.largest_stable_step == 0.0
    with pytest.warns(StabilityWarning, match="amplifies some waves at overlap"):
        prepare(case)


def test_the_plane_dies_of_no_raw_error_there():
    case = stiff(
        scheme="KPSE", order=12, overlap=1.0, dim=2, spacing=0.5, half_width=5.0, t_final=0.01
    )
    with pytest.warns(StabilityWarning, match="amplifies"):
        u = prepare(case).solve(bump(*case.positions))
    assert np.isfinite(u).all()


def test_dd_at_a_small_overlap_says_that_a_constant_decays():
    case = stiff(scheme="DD", overlap=0.5, beta=0.5, dt=1e-3, t_final=1.0)
    with pytest.warns(AccuracyWarning, match="makes every constant decay"):
        compute(case, bump)


# --- what must not change a run: properties over all schemes, orders, dimensions, exteriors, evaluations -------------


@st.composite
def cases(draw, one_sum: bool = False) -> Case:
    """Cases that are valid; `one_sum`: or done by one lattice sum, which uses the far field once, so not in pieces."""
    scheme = draw(st.sampled_from(["DD", "FPSE", "KPSE", "GPSE", "DPSE", "FD"]))
    dim = draw(st.sampled_from([1, 1, 1, 2, 2, 3])) if len(SCHEMES[scheme].dims) > 1 else 1
    orders = SCHEMES[scheme].orders if dim == 1 else SCHEMES[scheme].box_orders
    order = draw(st.sampled_from(orders))
    # The set-up of an open cube takes seconds.
    exterior = draw(st.sampled_from(SCHEMES[scheme].exteriors)) if dim < 3 else "truncated"
    beta = draw(st.sampled_from([0.02, 0.3, 0.5, 0.77, 0.98]))
    n = draw(st.integers(8, {1: 60, 2: 12, 3: 8}[dim]))
    if scheme == "GPSE" and exterior == "open":
        n = max(n, 20)  # two steps must not outgrow the lattice
    fields = {"scheme": scheme, "order": order, "beta": beta, "dim": dim, "exterior": exterior}
    fields |= {"half_width": float(n), "spacing": 1.0, "t_initial": 0.0}
    overlap = draw(st.sampled_from([1.5, 2.0, 2.5]))
    # Stiff where the lattice may be outgrown, up to 1e4 beyond its own time scale.
    widest = n ** (1.0 + beta) * (
        0.05 if exterior == "open" else 10.0 ** draw(st.integers(0, {1: 4, 2: 2, 3: 0}[dim]))
    )
    if scheme == "GPSE":
        step = overlap ** (1.0 + beta)
        steps = 2 * draw(st.integers(1, max(1, int(min(widest / step, 1e6) / 2))))
        return Case(**fields, dt=step, t_final=steps * step, evaluation=evaluation_of(draw, steps))
    if scheme != "FD":
        fields["overlap"] = overlap
    if draw(st.booleans()):
        can = one_sum and dim == 1 and exterior == "open"
        evaluation = draw(st.sampled_from(["series", "convolution"])) if can else "series"
        return Case(**fields, integrator="exponential", t_final=widest, evaluation=evaluation)
    integrator = draw(st.sampled_from(["euler", "rk2", "rk4"]))
    probe = Case(**fields, integrator=integrator, dt=1.0, t_final=widest)
    dt = min(0.9 * probe.largest_stable_step, 0.5 * widest)
    steps = 2 * max(1, int(min(widest / dt, 1e6) / 2))
    fields |= {"integrator": integrator, "evaluation": evaluation_of(draw, steps)}
    return Case(**fields, dt=dt, t_final=steps * dt)


def evaluation_of(draw, steps: int) -> str:
    return draw(st.sampled_from(["series", "stepping"])) if steps <= 200 else "series"


def data(case: Case, seed: int = 0) -> np.ndarray:
    centre = 0.3 * case.n
    noise = np.random.default_rng(seed).standard_normal(case.shape)
    return bump(*((part - centre) / 3.0 for part in case.positions)) + 0.01 * noise


def room(case: Case) -> float:
    """The round-off of the operator over the run, and that of the sums, which pieces keep at 1e-10."""
    stiffness = -case.symbol_range[0] * case.setting.rate * (case.t_final - case.t_initial)
    # DPSE is similar to a symmetric operator, by the root of a condition number of about n^beta.
    return (1e3 if case.scheme in ("DPSE", "FPSE") else 1.0) * (1e-9 + 10.0 * EPS * stiffness)


def run(case: Case, u0: np.ndarray) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StabilityWarning)
        return prepare(case).solve(u0)


def halved(case: Case) -> Case:
    """The case for half the time, of the same steps."""
    return Case(**{**case.model_dump(exclude_none=True), "t_final": 0.5 * case.t_final})


@settings(max_examples=settings.default.max_examples * 2 // 3)
@given(case=cases())
def test_one_run_is_two_runs_of_half_the_time(case):
    u0 = data(case)
    whole, half = run(case, u0), halved(case)
    again = run(half, run(half, u0))
    assert np.abs(whole - again).max() <= room(case) * max(np.abs(u0).max(), np.abs(whole).max())


@settings(max_examples=settings.default.max_examples * 2 // 3)
@given(case=cases(one_sum=True), factor=st.sampled_from([1e-200, 2.0, -3.0, 1e200]))
def test_a_run_is_linear_and_mirrors(case, factor):
    u0 = data(case)
    u = run(case, u0)
    size = max(np.abs(u0).max(), np.abs(u).max())
    mirror = (slice(None, None, -1),) * case.dim
    assert np.abs(run(case, u0[mirror])[mirror] - u).max() <= room(case) * size
    other = data(case, 1)
    together = run(case, u0 + other)
    assert np.abs(together - u - run(case, other)).max() <= 3.0 * room(case) * size
    assert np.abs(run(case, factor * u0) / factor - u).max() <= room(case) * size


@settings(max_examples=settings.default.max_examples * 2 // 3)
@given(
    case=cases(one_sum=True),
    length=st.sampled_from([1e-6, 0.3, 1e4]),
    time=st.sampled_from([1e-3, 7.0, 1e5]),
)
def test_a_run_does_not_depend_on_the_units(case, length, time):
    """x -> length x, t -> time t, D -> D length^alpha / time."""
    fields = case.model_dump(exclude_none=True)
    fields["half_width"] *= length
    fields["spacing"] *= length
    fields["t_final"] *= time
    fields["diffusivity"] = case.diffusivity * length**case.alpha / time
    if "dt" in fields:
        fields["dt"] *= time
    u0 = data(case)
    u = run(case, u0)
    size = max(np.abs(u0).max(), np.abs(u).max())
    assert np.abs(run(Case(**fields), u0) - u).max() <= room(case) * size
