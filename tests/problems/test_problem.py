"""What a problem takes, what it refuses before any work, and how it is written down."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.problems import Problem

PLAIN = {"alpha": 1.5, "half_width": 10.0, "spacing": 0.5, "t_final": 1.0}
PLANE = {**PLAIN, "dim": 2, "half_width": 4.0}

REFUSED = {
    "alpha": ({"alpha": 2.0}, "1 < alpha < 2"),
    "beta": ({"alpha": None, "beta": 1.5}, "0 < beta < 1"),
    "beta as text": ({"alpha": "2.5"}, "0 < beta < 1"),
    "variable order": ({"alpha": "1.5 + x"}, "0 < beta < 1|at x"),
    "variable order by flux": ({"alpha": "1.5 + 0.2*tanh(x)"}, "DD for a variable order"),
    "variable order and diffusivity": (
        {"alpha": "1.5 + 0.2*tanh(x)", "form": "DD", "diffusivity": "2 + tanh(x)"},
        "an expression in t alone",
    ),
    "order in t": ({"alpha": "1.5 + t"}, "not 't'"),
    "negative diffusivity": ({"diffusivity": "1 - x"}, r"-9 at x = 10, t = 0"),
    "negative later": ({"diffusivity": "0.5 - t"}, r"-0\.5 at t = 1|-0\.5 at x = -10, t = 1"),
    "nan": ({"velocity": "log(x)"}, "nan at x = -10"),
    "nan in JSON": ({"diffusivity": float("nan")}, "finite"),
    "one velocity for two": ({**PLANE, "velocity": "x"}, "of which dim=2 has 2"),
    "two velocities for one": ({"velocity": ("x", "1")}, "Give one, or dim=2"),
    "y on the line": ({"velocity": "y"}, "not 'y'"),
    "u in the diffusivity": ({"diffusivity": "u"}, "not 'u'"),
    "form": ({"form": "GPSE"}, "one of FPSE, DD, exchange"),
    "dim": ({"dim": 3}, "one of 1, 2"),
    "order in the plane": ({**PLANE, "order": 6}, "2 or 4 for FPSE in 2 dimensions"),
    "True": ({"order": True}, "one of 2, 4"),
    "rtol": ({"rtol": 0.0}, "between"),
    "integrator": ({"integrator": "euler"}, "one of auto"),
    "exterior": ({"exterior": "periodic"}, "one of open, truncated"),
    "unknown": ({"speed": 1.0}, "speed"),
    "spacing": ({"spacing": 5.0}, "an eighth of the half-width"),
    "times": ({"t_final": None, "times": (2.0, 1.0)}, "ascending"),
    "far terms": ({"exterior": "truncated", "far_terms": 2}, "far_terms"),
    "missing": ({"half_width": None}, "half_width"),
    "no order": ({"alpha": None, "beta": None}, "beta is missing. Allowed: between 0 and 1"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_wrong_is_refused_in_one_line(case):
    fields, said = REFUSED[case]
    with pytest.raises(InvalidInput, match=said) as caught:
        Problem(**{name: v for name, v in {**PLAIN, **fields}.items() if v is not None})
    assert "\n" not in str(caught.value)


def test_a_problem_of_texts_is_read_back():
    one = Problem(
        **{**PLANE, "alpha": 1.3, "times": (0.5, 1.0)},
        diffusivity="1 + 0.5*sin(x)*exp(-t)",
        velocity=("-y", 2.0),
        source="u*(1 - u)",
        rtol=np.float64(1e-8),
    )
    again = Problem.from_json(one.to_json())
    assert again == one
    assert again.velocity == ("-y", 2.0)
    assert again.to_json() == one.to_json()
    assert one.reproducible
    assert one.beta == 0.3


def test_a_function_is_not_in_the_file():
    one = Problem(**PLAIN, velocity=lambda x, t: -x)
    assert not one.reproducible
    with pytest.raises(InvalidInput, match=r"velocity.*with the function"):
        Problem.from_json(one.to_json())


@pytest.mark.parametrize("text", ["", "[]", "nonsense", None])
def test_other_texts_are_no_problem(text):
    with pytest.raises(InvalidInput, match="JSON object"):
        Problem.from_json(text)


def test_alpha_is_one_more_than_beta_whatever_it_is():
    points = {"x": np.array([-1.0, 1.0])}
    for alpha in ("1.5 + 0.2*tanh(x)", lambda x: 1.5 + 0.2 * np.tanh(x)):
        beta = Problem(**{**PLAIN, "alpha": alpha}, form="DD").order_coefficient
        np.testing.assert_allclose(beta(points), 0.5 + 0.2 * np.tanh(points["x"]), rtol=1e-15)


def test_a_copy_is_checked_as_a_new_one():
    one = Problem(**PLAIN)
    assert one.model_copy(update={"diffusivity": 2.0}).diffusion.constant == 2.0
    with pytest.raises(InvalidInput, match="diffusivity"):
        one.model_copy(update={"diffusivity": -2.0})


def test_what_is_linear_and_what_is_constant_in_time():
    for fields, linear, autonomous in (
        ({}, True, True),
        ({"source": "x"}, True, True),
        ({"source": "x*t"}, True, False),
        ({"source": "-u"}, False, True),
        ({"velocity": "-x"}, True, True),
        ({"velocity": lambda x, t: -x}, True, False),
        ({"velocity": lambda x: -x}, True, True),
        ({"diffusivity": "1 + t"}, True, False),
    ):
        one = Problem(**PLAIN, **fields)
        assert (one.is_linear, one.is_autonomous) == (linear, autonomous)


def test_a_field_may_hold_together_what_would_outgrow_the_lattice():
    with pytest.raises(InvalidInput, match="wider than the solution"):
        Problem(**{**PLAIN, "t_final": 1e4})
    assert Problem(**{**PLAIN, "t_final": 1e4}, velocity="-x").span == 1e4
    with pytest.raises(InvalidInput, match="t_final"):
        Problem(**{**PLAIN, "t_final": 1e-9, "t_initial": 1.0}, velocity="-x")
    with pytest.raises(InvalidInput, match="times"):
        Problem(**{**PLAIN, "t_final": 3.0, "times": (0.5, 3.0), "t_initial": 1.0}, velocity="-x")


def test_what_is_wrong_between_the_output_times_is_seen_before_any_work():
    with pytest.raises(InvalidInput, match=r"-1 at .*t = 0\.3"):
        Problem(**PLAIN, diffusivity="where((t > 0.3) & (t < 0.4), -1, 1)")


def test_a_problem_has_its_alpha_as_a_case_has():
    assert Problem(**PLAIN).alpha == Problem(**PLAIN).case.alpha == pytest.approx(1.5)
    varies = Problem(**{**PLAIN, "alpha": "1.5 + 0.2*tanh(x)"}, form="DD")
    with pytest.raises(InvalidInput, match="a number, to speak of one alpha"):
        _ = varies.alpha
