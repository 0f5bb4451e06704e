"""Findings: numbers of Python from whatever a study measures, files, and texts that look numbers up."""

from __future__ import annotations

import json
import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracstudy.findings import Finding, each, filled, measured, read_findings, write_findings
from fracstudy.verdicts import LedgerError

ID = "L-T3.ordering"


def series(values, **names):
    index = pd.MultiIndex.from_product(names.values(), names=names)
    return pd.Series(values, index=index if len(names) > 1 else index.get_level_values(0))


@pytest.mark.parametrize(
    ("number", "plain"),
    [
        (2.5, 2.5),
        (np.float32(2.5), 2.5),
        (np.array(2.5), 2.5),
        (7, 7),
        (np.int64(7), 7),
        (True, 1),
        (np.bool_(False), 0),
        ("KPSE", "KPSE"),
        ((1.0, 2), [1.0, 2]),
        (np.array([1.0, 2.0]), [1.0, 2.0]),
        ({"DD": 1.0, 0.5: np.float64(2.0)}, {"DD": 1.0, "0.5": 2.0}),
        ({("DD", 2): 1.0}, {"DD, 2": 1.0}),
        (pd.Series([1.0], index=["DD"]), {"DD": 1.0}),
        (pd.Series([1.0, 2.0]), {"0": 1.0, "1": 2.0}),
        (series([1, 2], beta=[0.1, 0.9]), {"beta = 0.1": 1, "beta = 0.9": 2}),
        (series([1, 2], scheme=["DD", "KPSE"]), {"DD": 1, "KPSE": 2}),
        (series([1.0], scheme=["KPSE"], beta=[0.1]), {"KPSE, beta = 0.1": 1.0}),
    ],
)
def test_a_study_hands_over_numbers_of_any_kind(number, plain):
    found = measured(ID, ratio=number).numbers["ratio"]
    assert found == plain
    assert type(found) is type(plain)
    assert json.loads(json.dumps(found)) == plain


@pytest.mark.parametrize(
    ("number", "complaint"),
    [
        (math.nan, "ratio is nan; a finding is made of finite numbers"),
        (math.inf, "ratio is inf"),
        ([1.0, -math.inf], "ratio is -inf"),
        ({"DD": math.nan}, "ratio is nan"),
        (None, "ratio is None"),
        (1.0 + 1.0j, r"ratio is \(1"),
        ([], "ratio has no numbers|ratio is"),
        ({}, "ratio has no numbers"),
        (pd.Series(dtype=float), "ratio has no numbers"),
        (pd.Series([1.0, 2.0], index=["DD", "DD"]), "cases of ratio with one name: DD"),
        (series([1.0, 2.0], beta=[0.1, 0.10000001]), "cases of ratio with one name: beta = 0.1"),
    ],
)
def test_what_is_no_finite_number_is_refused_with_the_claim(number, complaint):
    with pytest.raises(LedgerError, match=f"L-T3.ordering: ({complaint})"):
        measured(ID, ratio=number)
    with pytest.raises(LedgerError, match=f"L-T3.ordering: ({complaint})"):
        measured(ID, ratio=1.0, others={"another seed": {"ratio": number}})


def test_a_quantity_of_each_case_is_named_by_the_case():
    products = each(lambda n, beta: n * beta, n=(1, 2), beta=[0.5])
    named = {"n = 1, beta = 0.5": 0.5, "n = 2, beta = 0.5": 1.0}
    assert measured(ID, ratio=products).numbers["ratio"] == named
    one = each(len, scheme=("DD", "KPSE"))
    assert measured(ID, ratio=one).numbers["ratio"] == {"DD": 2, "KPSE": 4}


def test_another_reading_is_one_of_the_same_numbers():
    finding = measured(ID, ratio=1.0, count=2, others={"another seed": {"ratio": np.float64(3.0)}})
    assert finding.others == {"another seed": {"ratio": 3.0}}
    with pytest.raises(LedgerError, match=r"L-T3\.ordering: another seed gives ratios, no number"):
        measured(ID, ratio=1.0, others={"another seed": {"ratios": 3.0}})


# --- files -------------------------------------------------------------------------------------------

numbers = st.one_of(
    st.integers(-(2**53), 2**53),
    st.floats(allow_nan=False, allow_infinity=False),
    st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1),
    st.dictionaries(st.text(), st.integers(-9, 9), min_size=1),
    st.text(),
)


@given(st.lists(st.tuples(st.text(min_size=1), st.dictionaries(st.text(), numbers))))
def test_findings_come_back_as_they_were_written(tmp_path_factory, given):
    path = tmp_path_factory.mktemp("findings") / "scene.json"
    findings = [
        Finding(claim=claim, numbers=found, others={"a reading": found}, runs=["runs/r.nc"])
        for claim, found in given
    ]
    write_findings(findings, path)
    assert read_findings([path]) == findings


def test_the_order_of_files_and_findings_is_kept_and_what_is_empty_left_out(tmp_path):
    paths = [tmp_path / name for name in ("b.json", "a.json")]
    write_findings([measured("L-T3.z", m=1.0), measured("L-T3.a", m=2.0)], paths[0])
    write_findings([measured("L-C9.DD")], paths[1])
    assert [finding.claim for finding in read_findings(paths)] == ["L-T3.z", "L-T3.a", "L-C9.DD"]
    assert json.loads(paths[1].read_text("utf-8")) == [{"claim": "L-C9.DD"}]


@pytest.mark.parametrize(
    "text", ['[{"claim": "L-C9.DD", "verdict": true}]', "{}", "[", '[{"claim": ""}]']
)
def test_a_broken_file_is_named(tmp_path, text):
    path = tmp_path / "scene.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LedgerError, match=r"scene\.json"):
        read_findings([path])


# --- texts -------------------------------------------------------------------------------------------

FINDING = measured(
    ID,
    count=3,
    worst="KPSE",
    small=1.25e-7,
    ratio=pd.Series([3.128, 1.4641], index=["KPSE", "DD"]),
    at=series([1.5, 2.5], beta=[0.1, 0.9]),
    steps=[4, 2, 8],
)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("Nothing to look up.", "Nothing to look up."),
        ("{count} of {{three}}, {small:.1e}", "3 of {three}, 1.2e-07"),
        ("{worst} is worst", "KPSE is worst"),
        ("{ratio:.2f}", "3.13 (KPSE), 1.46 (DD)"),
        ("{ratio[DD]:.1f}", "1.5"),
        ("{ratio.least:.2f} to {ratio.greatest:.3f}", "1.46 to 3.128"),
        ("{at[beta = 0.9]:.1f} of {at.count}", "2.5 of 2"),
        ("{steps:d}", "4, 2, 8"),
        ("{steps[2]} after {steps.least}", "8 after 2"),
        ("  padded \n", "padded"),
    ],
)
def test_a_text_looks_its_numbers_up(text, shown):
    assert filled(text, FINDING) == shown


@pytest.mark.parametrize(
    "text",
    [
        "{ratios:.2f}",
        "{ratio[FPSE]:.2f}",
        "{ratio.mean:.2f}",
        "{steps[3]}",
        "{steps[last]}",
        "{worst:.2f}",
        "{count:.2q}",
        "{0}",
        "{",
    ],
)
def test_a_text_that_asks_for_what_is_not_there_is_refused(text):
    with pytest.raises(LedgerError) as caught:
        filled(text, FINDING)
    message = str(caught.value)
    assert message.startswith("L-T3.ordering: ")
    assert repr(text) in message
    assert message.endswith("measured: count, worst, small, ratio, at, steps")


def test_what_is_known_may_be_nothing():
    with pytest.raises(LedgerError, match=r"measured: none$"):
        filled("{ratio}", measured(ID))


@given(st.text())
def test_braces_doubled_are_braces(text):
    literal = text.replace("{", "{{").replace("}", "}}")
    assert filled(literal, FINDING) == text.strip()
