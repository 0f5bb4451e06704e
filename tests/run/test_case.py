"""`Case`: what it derives, how it identifies itself, and that junk is refused in one clear line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fracparticles as fp
from fracparticles.errors import InvalidInput, one_of, spelled
from fracparticles.problems.problem import Problem
from fracparticles.run.case import Case
from fracparticles.run.complaints import choices_of, field_table, label_of, takes_numbers
from fracparticles.special import mean_radius

GIVEN = {"scheme": "KPSE", "beta": 0.5, "truncation": 4.0, "spacing": 0.1, "dt": 0.001}


def case(**changes) -> Case:
    given = {**GIVEN, **changes}
    return Case(**{name: value for name, value in given.items() if value is not None})


# --- what follows from the parameters -------------------------------------------------------------


def test_the_lattice():
    c = case()
    assert c.reach == pytest.approx(4.0 * 1.5 ** (1.0 / 1.5) * mean_radius(1.5), rel=1e-15)
    assert c.n == round(c.reach / 0.1)
    assert c.particles == c.x.size == 2 * c.n + 1
    assert c.x[c.n] == 0.0
    assert c.x[-1] == pytest.approx(c.reach, rel=1e-15)
    assert c.particle_spacing == pytest.approx(0.1, rel=1.0 / c.n)
    assert np.array_equal(c.x, -c.x[::-1])


def test_the_half_width_grows_with_the_diffusivity():
    assert case(diffusivity=8.0).reach == pytest.approx(4.0 * case().reach, rel=1e-14)
    assert case(truncation=None, half_width=3.0).reach == 3.0


@given(dt=st.floats(1e-4, 2.0), t_final=st.floats(0.51, 3.0))
def test_the_steps_end_at_the_final_time(dt, t_final):
    c = case(dt=dt, t_final=t_final)
    assert c.steps * c.time_step == pytest.approx(t_final - 0.5, rel=1e-14)
    assert c.time_step <= dt * (1.0 + 1e-8)
    assert c.steps == 1 or (c.steps - 1) * dt < t_final - 0.5


def test_a_step_that_fits_is_kept_in_spite_of_rounding():
    assert case(dt=0.1).steps == 10
    assert case(dt=5e-5).steps == 20000
    assert case(dt=1.0 / 3.0).steps == 3


def test_defaults_that_depend():
    assert case().resolved_integrator == "rk2"
    assert case(scheme="GPSE", dt=None).resolved_integrator == "euler"
    assert case().resolved_overlap == 2.0
    c = case(dt=None, integrator="exponential")
    assert (c.steps, c.time_step, c.largest_stable_step) == (0, 0.0, float("inf"))


def test_the_smoothing_length_of_gpse_is_tied_to_the_step():
    c = case(scheme="GPSE", dt=0.05, diffusivity=2.0)
    epsilon = c.resolved_overlap * c.particle_spacing
    assert epsilon == pytest.approx((2.0 * c.time_step) ** (1.0 / 1.5), rel=1e-14)
    c = case(scheme="GPSE", dt=None)
    assert c.resolved_overlap == pytest.approx(2.0, rel=0.07)  # 9 steps, not 8.3
    c = case(scheme="GPSE", dt=None, overlap=3.0)
    assert c.resolved_overlap == pytest.approx(3.0, rel=0.1)


def test_the_largest_stable_step():
    c = case()
    assert c.largest_stable_step == pytest.approx(2.17623 * c.particle_spacing**1.5, rel=1e-5)
    ratio = case(integrator="rk4").largest_stable_step / c.largest_stable_step
    assert ratio == pytest.approx(2.785293563405282 / 2.0, rel=1e-14)
    assert case(diffusivity=2.0).largest_stable_step * 2.0 == pytest.approx(
        c.largest_stable_step * (case(diffusivity=2.0).particle_spacing / c.particle_spacing) ** 1.5
    )


# --- identity -------------------------------------------------------------------------------------


def test_json_round_trip():
    for c in (case(), case(dt=None, integrator="exponential", overlap=3.0, store="metrics")):
        assert Case.from_json(c.to_json()) == c
        assert "null" not in c.to_json()
        assert list(json.loads(c.to_json())) == sorted(json.loads(c.to_json()))


@pytest.mark.parametrize("text", ["", "{", "[]", "3", "null", '"a"', "[" * 100000, None, 3])
def test_json_of_something_else(text):
    with pytest.raises(InvalidInput, match=r"^case (=|is missing)") as refused:
        Case.from_json(text)
    assert len(str(refused.value)) < 400


CHANGES = [
    {"scheme": "DD"},
    {"order": 4},
    {"beta": 0.25},
    {"truncation": 5.0},
    {"truncation": None, "half_width": 4.0},
    {"spacing": 0.05},
    {"overlap": 2.0},
    {"dt": 0.002},
    {"dt": None, "integrator": "exponential"},
    {"diffusivity": 2.0},
    {"t_initial": 0.25},
    {"t_final": 2.0},
    {"initial": "a.nc"},
    {"integrator": "rk4"},
    {"evaluation": "stepping"},
    {"summation": "naive"},
    {"exterior": "open"},
    {"store": "metrics"},
    {"kernel_family": "printed"},
    {"kernel_family": "gamma"},
    {"order": 12},
]


def test_paths_tell_cases_apart():
    paths = [case(**changes).path for changes in ({}, *CHANGES)]
    assert len(set(paths)) == len(paths)
    assert case().path == case().path
    for path in paths:
        assert path.endswith(".nc")
        assert path.count("/") == 2
        assert not path.startswith("/")


def test_the_path_of_a_case_that_names_no_family():
    """Files made before there was a choice keep their names, and their records."""
    c = case(order=4)
    assert c.path == "KPSE-4/beta0.5/C4_h0.1_rk2_dt0.001_t0.5-1.5_truncated_field.nc"
    assert "kernel_family" not in c.to_json()
    assert "_gamma_" in case(order=4, kernel_family="gamma").path


def test_a_case_cannot_be_changed():
    with pytest.raises((TypeError, ValueError)):
        case().beta = 0.6


def test_numpy_scalars_are_taken_for_what_they_hold():
    c = Case(
        scheme=np.str_("KPSE"),
        order=np.int64(4),
        beta=np.float64(0.5),
        truncation=np.int32(4),
        spacing=np.float32(0.125),
        dt=np.float64(0.001),
        dim=np.int8(1),
    )
    plain = Case(scheme="KPSE", order=4, beta=0.5, truncation=4.0, spacing=0.125, dt=0.001, dim=1)
    assert c == plain
    assert c.path == plain.path
    assert c.to_json() == plain.to_json()


def test_every_field_is_described():
    labels = [label_of(field) for field in Case.model_fields.values()]
    assert len(set(labels)) == len(labels)
    for label in labels:
        assert 4 < len(label) < 90
        assert not label.endswith(".")
    assert label_of(Case.model_fields["spacing"]) == "particle spacing h"
    assert label_of(Case.model_fields["truncation"]).endswith("R_alpha), Eq. (46)")


def test_the_table_of_the_configuration_is_that_of_the_fields():
    readme = Path(__file__).parents[2] / "config" / "README.md"
    assert f"\n\n{field_table(Case)}\n" in readme.read_text(encoding="utf-8")


def test_annotations():
    fields = Case.model_fields
    assert choices_of(fields["order"].annotation) == (2, 4, 6, 8, 10, 12)
    assert choices_of(fields["integrator"].annotation) == ("euler", "rk2", "rk4", "exponential")
    assert choices_of(fields["beta"].annotation) == ()
    numbers = {name for name, field in fields.items() if takes_numbers(field.annotation)}
    assert numbers == {
        *("order", "beta", "dim", "truncation", "half_width", "spacing", "overlap", "dt"),
        *("diffusivity", "t_initial", "t_final", "kernel_table", "remesh_above", "threshold"),
        *("far_terms", "graded_scale"),
    }


# --- junk -----------------------------------------------------------------------------------------

NAN, INF = float("nan"), float("inf")
REFUSED = [
    ({"scheme": "kpse"}, "scheme", "Did you mean 'KPSE'?"),
    ({"scheme": "XYZ"}, "scheme", "one of DD, DPSE, FPSE, KPSE, GPSE, DVM, FD, PSE29, RIESZ"),
    ({"scheme": 3}, "scheme", "one of DD"),
    ({"scheme": b"KPSE"}, "scheme", "one of DD"),
    ({"order": 3}, "order", "one of 2, 4, 6, 8, 10, 12"),
    ({"order": "4"}, "order", "Did you mean 4?"),
    ({"order": True}, "order", "one of 2, 4, 6, 8, 10, 12"),
    ({"scheme": "GPSE", "order": 4}, "order", "2 for GPSE"),
    ({"scheme": "DPSE", "order": 6}, "order", "2 or 4 for DPSE"),
    ({"scheme": "FPSE", "order": 6, "dim": 2}, "order", "2 or 4 for FPSE in 2 dimensions"),
    ({"order": 6, "kernel_family": "printed"}, "kernel_family", "'gamma' for order 6"),
    (
        {"scheme": "FPSE", "order": 6, "kernel_family": "printed", "exterior": "open"},
        *("kernel_family", "'gamma' for order 6"),
    ),
    ({"kernel_family": "gama"}, "kernel_family", "Did you mean 'gamma'?"),
    ({"scheme": "DPSE", "kernel_family": "printed"}, "kernel_family", "nothing for DPSE"),
    ({"dim": 4}, "dim", "one of 1, 2, 3"),
    ({"dim": 2, "scheme": "DPSE"}, "dim", "1 for DPSE"),
    ({"dim": True}, "dim", "one of 1"),
    ({"beta": 0.0}, "beta", "a number between 0 and 1 (exclusive)"),
    ({"beta": 1.0}, "beta", "a number between 0 and 1 (exclusive)"),
    ({"beta": -0.5}, "beta", "a number between 0 and 1 (exclusive)"),
    ({"beta": NAN}, "beta", "a number between 0 and 1 (exclusive)"),
    ({"beta": "0.5"}, "beta", "a number between 0 and 1 (exclusive)"),
    ({"beta": True}, "beta", "a number between 0 and 1 (exclusive)"),
    ({"beta": np.True_}, "beta", "a number between 0 and 1 (exclusive)"),
    ({"beta": 1e-17}, "beta", "differ from 1 and 2"),
    ({"beta": 1.0 - 1e-16}, "beta", "differ from 1 and 2"),
    ({"beta": 0.5 + 0j}, "beta", "a number between"),
    ({"truncation": 0.0}, "truncation", "a number between 1e-100 and 1e+100"),
    ({"truncation": -4.0}, "truncation", "a number between"),
    ({"truncation": INF}, "truncation", "a number between"),
    ({"truncation": "4"}, "truncation", "a number between"),
    ({"truncation": None}, "truncation", "exactly one of truncation and half_width"),
    ({"half_width": 4.0}, "truncation", "exactly one of truncation and half_width"),
    ({"spacing": 0.0}, "spacing", "a number between"),
    ({"spacing": -0.1}, "spacing", "a number between"),
    ({"spacing": NAN}, "spacing", "a number between"),
    ({"spacing": 1e-300}, "spacing", "a number between"),
    ({"spacing": 1e-9}, "spacing", "at least"),
    ({"spacing": 5.0}, "spacing", "at most an eighth of the half-width"),
    ({"overlap": 0.1}, "overlap", "a number between 0.25 and 1000"),
    ({"scheme": "FD", "overlap": 2.0}, "overlap", "nothing for FD"),
    ({"dt": 0.0}, "dt", "a number between"),
    ({"dt": -1.0}, "dt", "a number between"),
    ({"dt": None}, "dt", "stable up to"),
    ({"dt": 1e-20}, "dt", "2^53 steps"),
    ({"integrator": "exponential"}, "dt", "nothing for integrator='exponential'"),
    ({"scheme": "GPSE", "dt": 1e-9}, "dt", "so that epsilon / h is from 0.25 to 1000"),
    ({"scheme": "GPSE", "overlap": 2.0}, "overlap", "one of dt and overlap"),
    ({"scheme": "GPSE", "integrator": "rk2"}, "integrator", "nothing or 'euler' for GPSE"),
    ({"t_final": 0.5}, "t_final", "a number > t_initial = 0.5"),
    ({"t_final": 0.2}, "t_final", "a number > t_initial = 0.5"),
    ({"t_final": INF}, "t_final", "a number between"),
    ({"t_initial": -1.0}, "t_initial", "a number between"),
    ({"half_width": 4.0, "truncation": None, "t_final": 1e20}, "t_final", "at most 3"),
    ({"diffusivity": 0.0}, "diffusivity", "a number between"),
    ({"initial": 5}, "initial", "text"),
    ({"integrator": "rk3"}, "integrator", "Did you mean 'rk"),
    ({"evaluation": "steps"}, "evaluation", "one of auto, series, stepping"),
    ({"summation": "FFT"}, "summation", "Did you mean 'fft'?"),
    ({"exterior": "opn"}, "exterior", "Did you mean 'open'?"),
    ({"scheme": "DPSE", "exterior": "open"}, "exterior", "truncated for DPSE"),
    ({"store": ["field"]}, "store", "one of field, profile, metrics"),
    ({"spcing": 0.1}, "spcing", "Did you mean 'spacing'?"),
    ({"zzz": 0.1}, "zzz", "Leave it out."),
    ({"integrator": "exponential", "dt": None, "evaluation": "stepping"}, "evaluation", "takes no"),
]


@pytest.mark.parametrize(("changes", "field", "words"), REFUSED, ids=str)
def test_refused_in_one_clear_line(changes, field, words):
    with pytest.raises(InvalidInput) as refused:
        case(**changes)
    message = str(refused.value)
    assert refused.value.field == field
    assert message.startswith((f"{field} = ", f"{field} is missing"))
    assert words in message
    assert "\n" not in message
    assert message[-1] in ".?"


@pytest.mark.parametrize("name", ["scheme", "beta", "spacing"])
def test_what_is_needed(name):
    with pytest.raises(InvalidInput, match=f"Give {name}") as refused:
        Case(**{key: value for key, value in GIVEN.items() if key != name})
    assert refused.value.field == name


def test_a_name_of_something_else_is_told_where_it_belongs():
    assert set(Case.elsewhere) == set(Problem.model_fields) - set(Case.model_fields)
    for model, name, said in [
        (Case, "velocity", r"It is a field of fp\.Problem"),
        (Problem, "scheme", r"It is a field of fp\.Case"),
        (Case, "alfa", "Did you mean 'alpha'?"),
        (Problem, "alfa", "Did you mean 'alpha'?"),
    ]:
        given = {"half_width": 20.0, "spacing": 0.1, "t_final": 2.0, name: 1.0}
        with pytest.raises(InvalidInput, match=said) as refused:
            model(**given)
        assert refused.value.field == name
    with pytest.raises(InvalidInput, match=r"one that varies is for fp\.Problem"):
        Case(**GIVEN, diffusivity="1 + x**2")


def test_lists_in_words():
    assert [spelled(range(k)) for k in range(4)] == ["", "0", "0 or 1", "0, 1 or 2"]
    assert spelled(("a", "b", "c"), " and ") == "a, b and c"
    assert spelled((None, "rk2")) == "nothing or 'rk2'"
    assert (
        str(one_of("n", 3, (1, 2)))
        == "n = 3 is not allowed. Allowed: one of 1, 2. Choose one of these."
    )
    assert str(one_of("name", "k", ("K", "F"))).endswith("Did you mean 'K'?")
    refused = str(one_of("n", 3, (1, 2), "KPSE", "Take 1."))
    assert refused == "n = 3 is not allowed. Allowed: 1 or 2 for KPSE. Take 1."


def test_long_and_multi_line_values_are_shown_in_one_short_line():
    for value in (np.zeros((40, 40)), "a\n" * 500, 10**4000):
        with pytest.raises(InvalidInput) as refused:
            case(beta=value)
        assert "\n" not in str(refused.value)
        assert len(str(refused.value)) < 400


JUNK = (
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=8)
    | st.binary(max_size=4)
    | st.complex_numbers()
    | st.lists(st.integers(), max_size=2)
    | st.dictionaries(st.text(max_size=2), st.integers(), max_size=2)
    | st.sampled_from([np.float64("nan"), np.int64(-1), np.zeros(3), np.datetime64("2020"), object])
)
PLAUSIBLE = {
    "scheme": st.sampled_from(["DD", "DPSE", "FPSE", "KPSE", "GPSE", "FD", "PSE29", "RIESZ"]),
    "order": st.sampled_from([2, 4, 6, 12]),
    "kernel_family": st.sampled_from(["printed", "gamma"]),
    "beta": st.floats(0.0, 1.0),
    "truncation": st.floats(0.0, 1e300) | st.floats(1.0, 100.0),
    "half_width": st.floats(0.0, 1e300) | st.floats(1.0, 100.0),
    "spacing": st.floats(0.0, 1e300) | st.floats(0.01, 1.0),
    "overlap": st.floats(0.25, 1000.0),
    "dt": st.floats(0.0, 1e300) | st.floats(1e-4, 1.0),
    "diffusivity": st.floats(0.0, 1e300) | st.floats(0.1, 10.0),
    "t_initial": st.floats(0.0, 1e300) | st.floats(0.0, 1.0),
    "t_final": st.floats(0.0, 1e300) | st.floats(0.0, 10.0),
    "initial": st.sampled_from(["fundamental", "a.nc", ""]),
    "integrator": st.sampled_from(["euler", "rk2", "rk4", "exponential"]),
    "evaluation": st.sampled_from(["series", "stepping"]),
    "summation": st.sampled_from(["fft", "naive"]),
    "exterior": st.sampled_from(["truncated", "open"]),
    "graded_scale": st.floats(0.0, 1e300) | st.floats(0.1, 10.0),
    "graded_form": st.sampled_from(["exchange", "quadrature", "interpolated"]),
    "store": st.sampled_from(["field", "profile", "metrics"]),
}


def valid_or_refused(given_):
    try:
        c = Case(**given_)
    except InvalidInput as error:
        refused = str(error)
    else:
        refused = ""
    assert "\n" not in refused
    if refused:
        return
    assert c.particles >= 17
    assert c.path
    assert c.steps >= 0
    assert c.largest_stable_step > 0.0
    assert Case.from_json(c.to_json()) == c


@given(st.dictionaries(st.sampled_from([*Case.model_fields, "x", "H"]), JUNK, max_size=6))
def test_any_junk_is_refused_or_a_case(changes):
    valid_or_refused({**GIVEN, **changes})


@given(
    st.fixed_dictionaries(
        {name: PLAUSIBLE[name] for name in ("scheme", "beta", "spacing")},
        optional={
            name: v for name, v in PLAUSIBLE.items() if name not in ("scheme", "beta", "spacing")
        },
    )
)
def test_any_numbers_are_refused_or_a_case(given_):
    valid_or_refused(given_)


@pytest.mark.parametrize(("fields", "stands_for"), [
    ({"scheme": "KPSE", "exterior": "open", "integrator": "exponential"}, "convolution"),
    ({"scheme": "GPSE", "exterior": "open", "dt": 1.0, "dim": 2}, "convolution"),
    ({"scheme": "KPSE", "exterior": "truncated", "integrator": "exponential"}, None),
    ({"scheme": "KPSE", "exterior": "open", "dt": 0.01}, None),
    ({"scheme": "DVM", "dt": 0.01}, None),
])  # fmt: skip
def test_auto_is_the_fastest_evaluation_that_is_allowed(fields, stands_for):
    given = {"beta": 0.5, "truncation": 5.0, "spacing": 0.2, **fields}
    case = Case(**given, evaluation="auto")
    assert case.evaluation == stands_for
    assert case == Case(**given, evaluation=stands_for)


@pytest.mark.parametrize("name", ["scheme", "evaluation", "exterior", "summation", "integrator"])
@pytest.mark.parametrize("junk", [["KPSE"], {"open"}, np.array(["fft", "auto"])], ids=repr)
def test_a_list_where_a_name_belongs_is_refused(name, junk):
    with pytest.raises(InvalidInput, match=f"^{name} = "):
        case(**{"evaluation": "auto", "integrator": "exponential", "dt": None, name: junk})


def test_a_lattice_whose_particles_cannot_be_counted_is_refused():
    with pytest.raises(InvalidInput, match=r"^spacing = 1e-100 .* half of the memory"):
        case(dim=3, truncation=None, half_width=1e100, spacing=1e-100)


def test_a_complaint_about_a_name_with_a_line_feed_is_one_line():
    assert str(InvalidInput("a\nb", "c\nd", "one", "Mend it.")).count("\n") == 0


def test_a_name_that_is_not_utf_8_is_refused():
    with pytest.raises(InvalidInput, match="only the fields scheme, order"):
        case(**{"\ud800": 1})
    with pytest.raises(InvalidInput, match="only the fields scheme, order"):
        Case.from_json(r'{"scheme": "DD", "\ud800": 1}')


def test_naive_sums_of_dvm_that_would_take_minutes_are_refused():
    wide = {"scheme": "DVM", "exterior": "open", "overlap": 60.0}
    with pytest.raises(InvalidInput, match=r"^overlap = 60.0 .* at most 20 for naive sums"):
        case(**wide, summation="naive")
    case(**wide)


def test_a_copy_with_another_value_is_a_case_of_its_own():
    case = Case(scheme="KPSE", beta=0.5, half_width=10.0, spacing=0.25, dt=0.05)
    assert case.time_step == pytest.approx(0.05)  # which is kept
    other = case.model_copy(update={"dt": 0.5})
    assert other == Case(scheme="KPSE", beta=0.5, half_width=10.0, spacing=0.25, dt=0.5)
    assert other.time_step == 0.5
    with pytest.raises(InvalidInput, match="dt"):
        case.model_copy(update={"dt": -1.0})


def test_the_scalars_of_a_run_make_a_case():
    """Each is a coordinate, an array without axes; so are output times with one."""
    given = {"half_width": 20.0, "spacing": 0.2, "t_initial": 0.0, "integrator": "exponential"}
    case = fp.Case(scheme="KPSE", order=4, beta=0.5, times=[0.5, 1.0], **given)
    run = fp.solve(case, lambda x: np.exp(-np.square(x)))
    again = fp.Case(
        times=run.t,
        **{name: run[name] for name in ("scheme", "order", "beta", "half_width", "spacing")},
        **{name: run[name] for name in ("t_initial", "integrator")},
    )
    assert again.path == case.path
    with pytest.raises(InvalidInput, match="order = True"):
        fp.Case(scheme="KPSE", order=np.array(True), beta=0.5, t_final=1.0, **given)
    with pytest.raises(InvalidInput, match="beta = masked"):
        fp.Case(scheme="KPSE", beta=np.ma.masked, t_final=1.0, **given)


@pytest.mark.parametrize("field", ["t_final", "spacing", "order", "dt"])
def test_several_numbers_are_not_one(field):
    given = {"scheme": "KPSE", "beta": 0.5, "half_width": 8.0, "spacing": 0.5, field: [2, 4]}
    with pytest.raises(
        InvalidInput, match=rf"^{field} = \[2, 4\] .* one number, not several"
    ) as refused:
        fp.Case(**given)
    assert ("times=" in str(refused.value)) == (field == "t_final")
