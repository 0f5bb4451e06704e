"""Criteria: the rounding rules, every kind of threshold, cases, misprints, margins, close calls."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracstudy.criteria import CLOSE, Condition, Convention, judged
from fracstudy.verdicts import LedgerError, Status, judge_value, unit_of_last_digit

WORDS = {
    "several": Convention(at_least=2.0, means="Several: at least twice."),
    "much_smaller": Convention(at_most=0.1, means="At most a tenth."),
}


def condition(of: str = "m", **threshold) -> Condition:
    why = {} if "word" in threshold else {"why": "as it is"}
    return Condition(of=of, means=f"what {of} is", **threshold, **why)


def verdict(m, **threshold) -> Status:
    return judged([condition(**threshold)], {"m": m}, WORDS).status


# --- the rounding rules ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("printed", "unit"),
    [
        ("8.83", Fraction(1, 100)),
        ("10.5", Fraction(1, 10)),
        ("97", Fraction(1)),
        ("1.11e-2", Fraction(1, 10000)),
        ("1e-3", Fraction(1, 1000)),
        ("-2.00", Fraction(1, 100)),
        ("5e3", Fraction(1000)),
    ],
)
def test_the_unit_is_that_of_the_last_printed_digit(printed, unit):
    assert unit_of_last_digit(printed) == unit


@pytest.mark.parametrize(
    ("printed", "ours", "status"),
    [
        ("7.05", 7.0511, Status.REPRODUCED),
        ("10.5", 10.4894, Status.REPRODUCED),
        ("8.83", 8.8354, Status.WITHIN_ROUNDING),  # truncated in print
        ("4.81", 4.8161, Status.WITHIN_ROUNDING),
        ("2.00", 2.03, Status.DEVIATES),
        ("1.11e-2", 0.011174, Status.WITHIN_ROUNDING),
        ("1e-3", 0.00123, Status.REPRODUCED),
        ("-1.5", -1.54, Status.REPRODUCED),
        ("-1.5", 1.5, Status.DEVIATES),
        ("0.12", 0.125, Status.REPRODUCED),  # an exact tie rounds either way
        ("0.13", 0.125, Status.REPRODUCED),
        ("2", 3, Status.WITHIN_ROUNDING),
    ],
)
def test_known_verdicts(printed, ours, status):
    assert judge_value(printed, ours) is status


finite = st.floats(-1e6, 1e6, allow_nan=False)


@given(finite, st.integers(0, 9))
def test_a_value_that_rounds_to_the_print_is_reproduced(ours, decimals):
    assert judge_value(f"{ours:.{decimals}f}", ours) is Status.REPRODUCED


@given(st.floats(1e-300, 1e300), st.integers(0, 9))
def test_the_same_in_scientific_notation(ours, decimals):
    printed = f"{ours:.{decimals}e}".replace("e+", "e")
    assert judge_value(printed, ours) is Status.REPRODUCED


@given(finite, st.integers(0, 9))
def test_a_truncated_print_never_deviates(ours, decimals):
    kept = math.trunc(Fraction(ours) * 10**decimals)
    sign, digits = "-" if kept < 0 else "", f"{abs(kept):0{decimals + 1}d}"
    point = len(digits) - decimals
    printed = f"{sign}{digits[:point]}" + (f".{digits[point:]}" if decimals else "")
    assert judge_value(printed, ours) in (Status.REPRODUCED, Status.WITHIN_ROUNDING)


@given(st.integers(-(10**9), 10**9), st.integers(0, 6), st.fractions(-5, 5))
def test_half_a_unit_and_one_unit_are_the_two_borders(mantissa, decimals, units):
    printed = f"{mantissa}e-{decimals}"
    ours = float(Fraction(printed) + units / 10**decimals)
    exact = abs(Fraction(ours) - Fraction(printed)) * 10**decimals
    if exact <= Fraction(1, 2):
        expected = Status.REPRODUCED
    else:
        expected = Status.WITHIN_ROUNDING if exact <= 1 else Status.DEVIATES
    assert judge_value(printed, ours) is expected


# --- one number against one threshold ----------------------------------------------------------------

# The kind, and whether it holds below 4, at 4 and above.
KINDS = [
    ({"at_most": 4.0}, (True, True, False)),
    ({"at_least": 4.0}, (False, True, True)),
    ({"below": 4.0}, (True, False, False)),
    ({"above": 4.0}, (False, False, True)),
    ({"near": 3.0, "within": 1.0}, (True, True, False)),
]


@pytest.mark.parametrize(("threshold", "holds"), KINDS)
def test_each_kind_of_threshold_at_its_border(threshold, holds):
    numbers = (math.nextafter(4.0, 0.0), 4.0, math.nextafter(4.0, 9.0))
    expected = [Status.REPRODUCED if yes else Status.REFUTED for yes in holds]
    assert [verdict(m, **threshold) for m in numbers] == expected


def test_near_counts_from_both_sides():
    numbers = (1.9, 2.0, 4.0, 4.1)
    found = [verdict(m, near=3.0, within=1.0) is Status.REPRODUCED for m in numbers]
    assert found == [False, True, True, False]


@given(finite, finite)
def test_a_threshold_parts_the_numbers_in_two(m, t):
    assert (verdict(m, at_most=t) is Status.REPRODUCED) == (m <= t)
    assert verdict(m, at_most=t) != verdict(m, above=t)
    assert verdict(m, at_least=t) != verdict(m, below=t)
    assert verdict(m, at_least=t) == verdict(-m, at_most=-t)


def test_a_word_stands_for_the_threshold_of_its_convention():
    assert verdict(2.0, word="several") is Status.REPRODUCED
    assert verdict(1.9, word="several") is Status.REFUTED
    assert verdict(0.1, word="much_smaller") is Status.REPRODUCED
    assert verdict(0.11, word="much_smaller") is Status.REFUTED


@pytest.mark.parametrize(
    ("threshold", "words"),
    [
        ({"at_most": 1.0e-10}, "at most 1e-10 (as it is)"),
        ({"above": 1.0}, "above 1 (as it is)"),
        ({"near": 2.0, "within": 0.1}, "2 ± 0.1 (as it is)"),
        ({"word": "much_smaller"}, "at most 0.1 (much smaller)"),
    ],
)
def test_a_criterion_says_where_it_comes_from(threshold, words):
    assert condition(**threshold).in_words(WORDS) == words


def test_a_threshold_that_nobody_set_has_no_source():
    assert condition(word="several").in_words(WORDS, factor=CLOSE) == "at least 3"


@pytest.mark.parametrize(
    "threshold",
    [
        {},
        {"at_most": 1.0, "at_least": 0.0},
        {"at_most": 1.0, "word": "several"},
        {"near": 1.0},
        {"within": 1.0},
        {"near": 1.0, "at_most": 1.0},
        {"near": 1.0, "within": 0.0},
        {"near": 1.0, "within": -1.0},
        {"at_most": math.nan},
        {"at_least": math.inf},
        {"at_most": "1e-4"},  # as YAML reads it
        {"at_most": True},
        {"atmost": 1.0},
    ],
)
def test_a_condition_has_one_finite_threshold(threshold):
    with pytest.raises(ValueError, match="validation error"):
        condition(**threshold)


@pytest.mark.parametrize("change", [{"why": ""}, {"of": ""}, {"means": ""}])
def test_a_condition_says_what_it_measures_and_why(change):
    given = {"of": "m", "means": "a number", "at_most": 1.0, "why": "as it is"}
    assert Condition(**given).why
    with pytest.raises(ValueError, match="validation error"):
        Condition(**(given | change))


def test_a_word_needs_no_why():
    with pytest.raises(ValueError, match="a word has its convention"):
        Condition(of="m", means="a number", word="several", why="as it is")


@pytest.mark.parametrize(
    "change", [{}, {"at_most": 1.0, "at_least": 1.0}, {"above": 1.0}, {"at_most": math.inf}]
)
def test_a_convention_has_one_threshold(change):
    with pytest.raises(ValueError, match="validation error"):
        Convention(means="As it is.", **change)


# --- cases -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("numbers", "status", "where", "where_not"),
    [
        ({"DD": 3.0, "KPSE": 4.0}, Status.REPRODUCED, ["DD", "KPSE"], []),
        ({"DD": 3.0, "KPSE": 1.0}, Status.PART, ["DD"], ["KPSE"]),
        ({"DD": 1.0, "KPSE": 0.0}, Status.REFUTED, [], ["DD", "KPSE"]),
        ([3.0, 4.0], Status.REPRODUCED, [], []),
        ([3.0, 1.0], Status.REFUTED, [], []),  # of no case: all must hold
        (3, Status.REPRODUCED, [], []),
    ],
)
def test_all_cases_some_or_none(numbers, status, where, where_not):
    found = judged([condition(word="several")], {"m": numbers}, WORDS)
    assert (found.status, found.where, found.where_not) == (status, where, where_not)


failing_first = pytest.mark.parametrize("failing_first", [False, True])


@failing_first
def test_a_case_holds_where_all_its_conditions_do(failing_first):
    conditions = [condition("a", above=0.0), condition("b", above=0.0)]
    numbers = {"a": {"DD": 1.0, "KPSE": 1.0, "FPSE": -1.0}, "b": {"KPSE": -1.0, "DD": 1.0}}
    found = judged(conditions[::-1] if failing_first else conditions, numbers, WORDS)
    assert (found.status, found.where) == (Status.PART, ["DD"])
    assert sorted(found.where_not) == ["FPSE", "KPSE"]


@failing_first
def test_a_condition_of_no_case_is_one_on_all_of_them(failing_first):
    conditions = [condition("a", above=0.0), condition("b", above=0.0)]
    numbers = {"a": {"DD": 1.0, "KPSE": 1.0}, "b": -1.0}
    found = judged(conditions[::-1] if failing_first else conditions, numbers, WORDS)
    assert (found.status, found.where) == (Status.REFUTED, [])
    assert found.where_not == ["DD", "KPSE"]


@given(st.dictionaries(st.text(), finite, min_size=1), finite)
def test_each_case_is_judged_as_if_it_stood_alone(numbers, t):
    found = judged([condition(at_most=t)], {"m": numbers}, WORDS)
    alone = {case: verdict(m, at_most=t) is Status.REPRODUCED for case, m in numbers.items()}
    assert found.where == [case for case, holds in alone.items() if holds]
    assert found.where_not == [case for case, holds in alone.items() if not holds]
    assert (found.status is Status.REPRODUCED) == all(alone.values())
    assert (found.status is Status.REFUTED) == (not any(alone.values()))


# --- misprints ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("printed", "meant", "status"),
    [
        (0.0, 0.0, Status.REPRODUCED),
        (0.0, 9.0, Status.REPRODUCED),
        (9.0, 0.0, Status.MISPRINT),
        (9.0, 9.0, Status.REFUTED),
        ({"DD": 0.0, "KPSE": 9.0}, 0.0, Status.MISPRINT),
        ({"DD": 0.0, "KPSE": 9.0}, {"DD": 0.0, "KPSE": 9.0}, Status.PART),
        (9.0, {"DD": 0.0, "KPSE": 9.0}, Status.REFUTED),
    ],
)
def test_a_misprint_fails_as_printed_and_holds_as_meant(printed, meant, status):
    holds, intended = [condition("printed", at_most=1.0)], [condition("meant", at_most=1.0)]
    found = judged(holds, {"printed": printed, "meant": meant}, WORDS, intended)
    assert found.status is status


def test_the_margin_of_a_misprint_is_that_of_what_was_meant():
    holds, intended = [condition("printed", at_most=1.0)], [condition("meant", at_most=1.0)]
    found = judged(holds, {"printed": 9.0, "meant": 0.25}, WORDS, intended)
    assert found.margin == 0.25
    assert found.close == []


def test_a_misprint_is_a_close_call_where_print_or_meaning_is():
    holds, intended = [condition("printed", at_most=1.0)], [condition("meant", at_most=1.0)]

    def close(printed, meant):
        return judged(holds, {"printed": printed, "meant": meant}, WORDS, intended).close

    assert close(1.4, 0.5) == ["reproduced with at most 1.5 for what printed is"]
    assert close(1.6, 0.8) == ["refuted with at most 0.667 for what meant is"]
    assert close(1.6, 1.4) == ["misprint with at most 1.5 for what meant is"]


# --- margins -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("threshold", "m", "margin"),
    [
        ({"at_most": 4.0}, [1.0, 2.0], 0.5),
        ({"below": 4.0}, [1.0, 2.0], 0.5),
        ({"at_least": 4.0}, [8.0, 6.0], 1.5),
        ({"above": 4.0}, {"DD": 8.0, "KPSE": 2.0}, 0.5),
        ({"near": 4.0, "within": 2.0}, [5.0, 1.0], 1.5),
        ({"word": "several"}, 5.0, 2.5),
        ({"at_least": 4.0}, [8.0, -2.0], -0.5),
        ({"above": 0.0}, 5.0, math.nan),
        ({"at_most": -1.0}, -2.0, math.nan),
        ({"at_most": 0.0}, 0.0, math.nan),
    ],
)
def test_the_margin_is_that_of_the_worst_case(threshold, m, margin):
    found = judged([condition(**threshold)], {"m": m}, WORDS).margin
    assert found == pytest.approx(margin, rel=1e-15, nan_ok=True)


@pytest.mark.parametrize(
    ("a", "b", "margin"),
    [
        (0.5, 1.25, 1.25),  # at_least by a quarter is nearer to failing than at_most by half
        (0.9, 1.25, 0.9),
        (0.5, 0.8, 0.8),  # the one that fails, though its margin is the smaller one
        (1.5, 0.9, 1.5),
        (1.1, 0.5, 0.5),
        (99.0, 0.0, 0.0),  # nothing of what is asked for
        (99.0, -1.0, -1.0),
    ],
)
def test_the_margin_is_that_of_the_worst_condition(a, b, margin):
    conditions = [condition("a", at_most=1.0), condition("b", at_least=1.0)]
    for order in (conditions, conditions[::-1]):
        assert judged(order, {"a": a, "b": b}, WORDS).margin == margin


@given(
    st.lists(
        st.tuples(st.sampled_from(["at_most", "at_least"]), st.floats(0.01, 100.0)), min_size=1
    )
)
def test_the_margin_tells_whether_everything_holds(given):
    conditions = [condition(f"m{k}", **{kind: 1.0}) for k, (kind, _) in enumerate(given)]
    found = judged(conditions, {f"m{k}": m for k, (_, m) in enumerate(given)}, WORDS)
    kinds = {kind for kind, m in given if m == found.margin}
    inside = {"at_most": found.margin <= 1.0, "at_least": found.margin >= 1.0}
    assert any(inside[kind] == (found.status is Status.REPRODUCED) for kind in kinds)


# --- close calls -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("threshold", "far", "near"),
    [
        # Just outside the factor, and just inside, on the side that holds and on the one that fails.
        ({"at_most": 3.0}, (1.99, 4.51), (2.01, 4.49)),
        ({"at_least": 3.0}, (4.51, 1.99), (4.49, 2.01)),
        ({"near": 10.0, "within": 3.0}, (11.99, 14.51), (12.01, 14.49)),
        ({"near": 10.0, "within": 3.0}, (8.01, 5.49), (7.99, 5.51)),
        ({"word": "several"}, (3.01, 1.33), (2.99, 1.34)),
        ({"at_most": -3.0}, (-4.51, -1.99), (-4.49, -2.01)),
    ],
)
def test_a_verdict_that_a_factor_of_one_and_a_half_would_change_is_a_close_call(
    threshold, far, near
):
    for m in far:
        assert judged([condition(**threshold)], {"m": m}, WORDS).close == []
    for m, other in zip(near, ("refuted", "reproduced"), strict=True):
        (call,) = judged([condition(**threshold)], {"m": m}, WORDS).close
        assert call.startswith(f"{other} with ")


def test_a_close_call_names_the_threshold_and_what_was_measured():
    found = judged([condition(word="several")], {"m": {"DD": 1.5, "KPSE": 2.5}}, WORDS)
    assert found.status is Status.PART
    assert found.close == [
        "reproduced with at least 1.33 for what m is",
        "refuted with at least 3 for what m is",
    ]


@pytest.mark.parametrize("kind", ["above", "below"])
@pytest.mark.parametrize("m", [0.99, 1.01])
def test_an_exact_border_is_no_close_call(kind, m):
    assert judged([condition(**{kind: 1.0})], {"m": m}, WORDS).close == []


@given(finite)
def test_the_threshold_zero_stays_what_it_is(m):
    assert judged([condition(at_most=0.0)], {"m": m}, WORDS).close == []


@given(finite, st.floats(0.01, 100.0))
def test_a_close_call_is_a_verdict_of_another_threshold(m, t):
    found = judged([condition(at_most=t)], {"m": m}, WORDS)
    others = [verdict(m, at_most=t * factor) for factor in (1.0 / CLOSE, CLOSE)]
    assert len(found.close) == sum(other != found.status for other in others)


# --- what cannot be judged ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("numbers", "given", "complaint"),
    [
        ({}, {"above": 0.0}, "m was not measured; measured: none"),
        ({"n": 1.0, "k": 1.0}, {"above": 0.0}, "m was not measured; measured: n, k"),
        ({"m": "yes"}, {"above": 0.0}, "m is 'yes', which no threshold"),
        ({"m": {"DD": 1.0, "KPSE": "yes"}}, {"above": 0.0}, "m is .*'yes'"),
        ({"m": {}}, {"above": 0.0}, "m is {}, which no threshold"),
        ({"m": []}, {"above": 0.0}, r"m is \[\], which no threshold"),
        ({"m": None}, {"above": 0.0}, "m is None"),
        ({"m": 1.0}, {"word": "many"}, "no convention says what 'many' means"),
    ],
)
def test_what_no_threshold_can_be_held_against_is_named(numbers, given, complaint):
    with pytest.raises(LedgerError, match=complaint):
        judged([condition(**given)], numbers, WORDS)


def test_every_verdict_has_a_sign_and_a_meaning_of_its_own():
    assert len({status.sign for status in Status}) == len(Status)
    assert len({status.meaning for status in Status}) == len(Status)
    needs_none = {status for status in Status if not status.needs_reason}
    assert needs_none == {Status.REPRODUCED, Status.WITHIN_ROUNDING}
