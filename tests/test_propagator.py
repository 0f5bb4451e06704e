"""exp(A t) as one lattice sum, and cases made ready."""

from __future__ import annotations

from math import factorial

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.errors import InvalidInput, NonFiniteSolution, StabilityWarning
from fracparticles.run.solver import compute, initial_strengths, prepare
from fracparticles.special.tails import tail_constant
from fracparticles.time.propagator import propagator, propagator_weights

WIDE = {"beta": 0.5, "truncation": 20.0, "exterior": "open", "integrator": "exponential"}
KINDS = [("DD", 2), ("DD", 12), ("FPSE", 4), ("FPSE", 8), ("KPSE", 2), ("KPSE", 4), ("KPSE", 12)]


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_weights_of_the_stable_law_are_its_density_on_a_fine_lattice(alpha):
    """For tau = h^-alpha, e_m / h is the fundamental solution at t = 1 but for what exp(-k^alpha) is at pi / h."""
    h = 0.05
    e = propagator_weights(lambda theta: np.exp(-((theta / h) ** alpha)), alpha, h**-alpha, 3000)
    exact = h * fp.green(h * np.arange(3000), 1.0, alpha)
    # Images of the circle from the fourth term of the expansion on.
    assert np.abs(e - exact).max() <= 1e-13 * exact[0]
    assert e[-1] == pytest.approx(exact[-1], rel=1e-7)


@pytest.mark.parametrize("alpha", [1.2, 1.8])
def test_weights_sum_to_one_if_the_symbol_vanishes_at_zero(alpha):
    """With what the table leaves out: two terms of the expansion, summed as integrals from M - 1/2."""
    count, tau = 4000, 5.0
    e = propagator_weights(lambda theta: np.exp(-tau * theta**alpha), alpha, tau, count)
    reach = (count - 0.5) ** -alpha
    terms = [
        -2.0 * (-tau * reach) ** j / factorial(j) * tail_constant(j * alpha) / (j * alpha)
        for j in (1, 2, 3)
    ]
    assert e[0] + 2.0 * e[1:].sum() + terms[0] + terms[1] == pytest.approx(
        1.0, abs=2.0 * abs(terms[2]) + terms[0] / count**2 + 1e-14
    )


@pytest.mark.parametrize(("scheme", "order"), KINDS)
def test_the_convolution_is_the_series_but_for_the_exterior(scheme, order):
    """Both model the field beyond the ends: they differ by the size of that model's error, 1e-9 at C = 20."""
    common = {**WIDE, "scheme": scheme, "order": order, "spacing": 0.1}
    sums = compute(fp.Case(**common, evaluation="convolution"))
    series = compute(fp.Case(**common))
    assert sums.operator_applications == 1
    inner = np.abs(sums.x) <= sums.case.error_radius
    assert np.abs(sums.u - series.u)[inner].max() <= 1e-8 * series.u.max()
    # The nearer the ends, the more the model counts; twice the width, and the difference falls by more than that.
    wide = {**common, "truncation": 40.0}
    far_sums, far_series = (
        compute(fp.Case(**wide, evaluation="convolution")),
        compute(fp.Case(**wide)),
    )
    near = np.abs(far_sums.x) <= far_sums.case.error_radius
    assert (
        np.abs(far_sums.u - far_series.u)[near].max()
        <= 0.25 * np.abs(sums.u - series.u)[inner].max()
    )


def test_the_convolution_advances_a_semigroup():
    """From 0.5 to 1.5 at once or over 1.0: the same, but for the model of the exterior used twice."""
    common = {**WIDE, "scheme": "KPSE", "order": 12, "truncation": None, "half_width": 60.0}
    common |= {"spacing": 0.2, "evaluation": "convolution"}
    once, first, second = (
        fp.Case(**common, t_initial=a, t_final=b) for a, b in ((0.5, 1.5), (0.5, 1.0), (1.0, 1.5))
    )
    u0, _ = initial_strengths(once)
    twice = prepare(second).solve(prepare(first).solve(u0))
    inner = np.abs(once.x) <= 10.0
    assert np.abs(twice - prepare(once).solve(u0))[inner].max() <= 1e-8


def test_a_truncated_propagator_sees_nothing_beyond_the_ends():

    def stable(theta):
        return np.exp(-2.0 * theta**1.5)

    u0 = np.random.default_rng(0).standard_normal(41)
    ours = propagator(stable, 1.5, 2.0, 20, "truncated").apply(u0)
    e = propagator_weights(stable, 1.5, 2.0, 82)
    i = np.arange(41)
    assert ours == pytest.approx(e[np.abs(i[:, None] - i)] @ u0, rel=1e-12, abs=1e-14)


def test_a_prepared_case_solves_any_data_and_keeps_their_shape():
    case = fp.Case(scheme="GPSE", beta=0.5, dim=2, half_width=8.0, spacing=0.8, dt=1.0)
    ready = fp.prepare(case)
    assert ready.operator_applications == 1
    a, b = np.random.default_rng(1).standard_normal((2, *case.shape))
    together = ready.solve(a + 2.0 * b)
    assert together.shape == case.shape
    assert np.abs(together - ready.solve(a) - 2.0 * ready.solve(b)).max() <= 1e-14 * 21**2


def test_a_single_step_of_gpse_is_taken_as_it_is():
    """What the series of one Euler step gives, without the range of the symbol."""
    common = {"scheme": "GPSE", "beta": 0.5, "truncation": 10.0, "spacing": 0.4, "dt": 1.0}
    single, series = fp.Case(**common), fp.Case(**common, evaluation="series")
    assert single.steps_taken
    assert not series.steps_taken
    assert compute(single).u == pytest.approx(compute(series).u, rel=1e-13)


@pytest.mark.parametrize("terms", [1, 2, 3])
def test_a_step_of_gpse_and_its_lattice_sum_agree(terms):
    """The kernel's own values, or the inverse transform of its symbol: the same weights and far field."""
    common = {"scheme": "GPSE", "beta": 0.5, "truncation": 7.0, "spacing": 0.4, "dt": 1.0}
    step = fp.Case(**common, exterior="open", far_terms=terms)
    at_once = fp.Case(**common, exterior="open", far_terms=terms, evaluation="convolution")
    u, v = compute(step).u, compute(at_once).u
    # Euler-Maclaurin beyond 4 n on one side, three terms of the expansion of the weights on the other: 1e-4 and
    # (4 n)^(-3 alpha) of a far field of 1e-4 beyond 4 n.
    assert np.abs(u - v).max() <= 1e-8 * u.max()


def test_a_prepared_case_as_a_matrix():
    case = fp.Case(**WIDE | {"truncation": 5.0}, scheme="KPSE", order=12, spacing=0.4)
    ready = fp.prepare(case)
    u0 = np.random.default_rng(2).standard_normal(case.shape)
    matrix = ready.as_matrix()
    assert matrix.shape == (case.particles, case.particles)
    assert np.abs(matrix @ u0 - ready.solve(u0)).max() <= 1e-13 * np.abs(u0).sum()


def test_strengths_of_another_lattice_are_refused():
    ready = fp.prepare(fp.Case(**WIDE, scheme="KPSE", spacing=0.4))
    with pytest.raises(
        InvalidInput, match=r"initial = 'array of shape \(3,\)'.* of shape \(225,\)"
    ):
        ready.solve(np.ones(3))


@pytest.mark.parametrize("evaluation", [None, "convolution"])
def test_one_pass_of_nonsense_is_an_error(evaluation):
    common = {"scheme": "GPSE", "beta": 0.5, "truncation": 10.0, "spacing": 0.4, "dt": 1.0}
    case = fp.Case(**common, exterior="open", evaluation=evaluation)
    with pytest.raises(InvalidInput, match=r"initial = 'not finite at x = -"):
        fp.prepare(case).solve(np.full(case.shape, np.inf))


def test_dvm_cannot_be_prepared():
    case = fp.Case(scheme="DVM", beta=0.5, truncation=10.0, spacing=0.5, dt=0.01)
    with pytest.raises(InvalidInput, match=r"scheme.*DVM.*Use solve"):
        fp.prepare(case)


def test_an_overflow_names_the_scheme_after_a_warning():
    common = {"scheme": "KPSE", "beta": 0.5, "truncation": 20.0, "spacing": 0.1, "dt": 1.0}
    case = fp.Case(**common, t_final=500.0, integrator="rk4")
    with (
        pytest.warns(StabilityWarning, match="outside the stability interval of KPSE"),
        pytest.raises(NonFiniteSolution, match=r"^KPSE \(order 2\): "),
    ):
        fp.prepare(case)


def test_a_matrix_has_a_limit():
    ready = fp.prepare(fp.Case(**WIDE, scheme="KPSE", spacing=0.005))
    with pytest.raises(InvalidInput, match="at most 16384 for a matrix"):
        ready.as_matrix()


@pytest.mark.parametrize(("change", "why"), [
    ({"spacing": 3.0}, "smoothing lengths"),
    ({"spacing": 0.01, "t_final": 1200.0, "truncation": None, "half_width": 120.0}, "T D / h"),
])  # fmt: skip
def test_several_terms_used_again_and_again_have_limits(change, why):
    """Too near the middle the fit makes modes that grow; a single sum or step has none."""
    fields = {**WIDE, "scheme": "KPSE", "spacing": 0.4, "far_terms": 3, **change}
    with pytest.raises(InvalidInput, match=f"far_terms.*{why}"):
        fp.Case(**fields)
    fp.Case(**fields, evaluation="convolution")
    fp.Case(**{**fields, "far_terms": 1})


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"scheme": "FD", "exterior": "truncated"}, "scheme"),
        ({"scheme": "DPSE", "exterior": "truncated"}, "scheme"),
        ({"integrator": "rk2", "dt": 1e-3}, "integrator"),
        ({"exterior": "truncated"}, "exterior"),
        ({"dim": 2}, "dim"),
        ({"summation": "naive"}, "summation"),
        ({"kernel_table": 0.01}, "kernel_table"),
    ],
)
def test_what_the_convolution_does_not_take(change, field):
    fields = {**WIDE, "scheme": "KPSE", "spacing": 0.5, "evaluation": "convolution", **change}
    with pytest.raises(InvalidInput, match=f"(?s){field}.*evaluation='convolution'"):
        fp.Case(**fields)
