"""The claims ledger: rounding rules, what it refuses, and the printed values of the main paper."""

from __future__ import annotations

import copy
import json
import math
from fractions import Fraction
from pathlib import Path

import jsonschema
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from fracstudy.claims import (
    Claim,
    Finding,
    LedgerError,
    Status,
    judge_value,
    read_claims,
    read_findings,
    unit_of_last_digit,
    write_findings,
    write_text,
)
from fracstudy.ledger import (
    COLUMNS,
    ledger,
    ledger_markdown,
    ours_text,
    read_ledger,
    summary_line,
    write_ledger,
)

ROOT = Path(__file__).parents[1]
PRINTED = ROOT / "report" / "printed" / "lucchesi2020.yaml"
SCHEMA = ROOT / "workflow" / "schemas" / "printed.schema.json"


def value(name: str = "L-T3.FPSE.beta0.5", printed: str = "8.83") -> Claim:
    return Claim(
        id=name,
        item=name.split(".")[0],
        kind="value",
        what="A limit.",
        where="Table 3",
        printed=printed,
    )


def statement(name: str = "L-C12.symmetric.FPSE", text: str = "A is symmetric.") -> Claim:
    item = name.split(".")[0]
    return Claim(
        id=name, item=item, kind="statement", what="It holds.", where="Sec. 4.4", statement=text
    )


# --- the rounding rules ---------------------------------------------------------------------------


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
    expected = (
        Status.REPRODUCED
        if exact <= Fraction(1, 2)
        else Status.WITHIN_ROUNDING
        if exact <= 1
        else Status.DEVIATES
    )
    assert judge_value(printed, ours) is expected


# --- the ledger -----------------------------------------------------------------------------------


def test_one_row_a_claim_in_their_order():
    claims = [value(), statement(), value("L-T2.DD.II.beta0.1", "2.01"), statement("L-C9.DD")]
    findings = [
        Finding(claim="L-C9.DD", verdict=None, evidence="Did not finish.", reason="Too long."),
        Finding(claim="L-T2.DD.II.beta0.1", ours=2.11, reason="Another level.", runs=("a", "b")),
        Finding(
            claim="L-C12.symmetric.FPSE", verdict=False, evidence="0.1 off.", reason="Product."
        ),
        Finding(claim="L-T3.FPSE.beta0.5", ours=8.8354),
    ]
    df = ledger(claims, findings)
    assert tuple(df.columns) == COLUMNS
    assert df["id"].tolist() == [claim.id for claim in claims]
    assert df["status"].tolist() == [
        "reproduced within the print's rounding",
        "refuted",
        "deviates",
        "not testable",
    ]
    assert df["printed"].tolist()[:2] == ["8.83", "A is symmetric."]
    assert df["ours"].tolist() == [8.8354, "0.1 off.", 2.11, "Did not finish."]
    assert df["relative_deviation"].iloc[0] == pytest.approx((8.8354 - 8.83) / 8.83, rel=1e-15)
    assert math.isnan(df["relative_deviation"].iloc[1])
    assert df["runs"].iloc[2] == "a; b"
    assert summary_line(df) == (
        "4 claims: 0 reproduced, 1 within the print's rounding, 1 deviate, 1 refuted, "
        "1 not testable"
    )


def test_a_value_without_a_number_of_ours_is_not_testable():
    df = ledger([value()], [Finding(claim=value().id, ours=None, reason="The run overflows.")])
    assert df["status"].tolist() == ["not testable"]
    assert df["ours"].tolist() == [""]
    assert summary_line(df).startswith("1 claim: 0 reproduced")


good_value = Finding(claim=value().id, ours=8.83)
good_statement = Finding(claim=statement().id, verdict=True, evidence="To 1e-16.")


@pytest.mark.parametrize(
    ("claims", "findings", "complaint"),
    [
        ([value()], [], "without a finding: L-T3.FPSE.beta0.5"),
        ([value()], [good_value, good_statement], "unknown claim: L-C12.symmetric.FPSE"),
        ([value()], [good_value, good_value], "found twice: L-T3.FPSE.beta0.5"),
        ([value(), value()], [good_value], "claimed twice: L-T3.FPSE.beta0.5"),
        (
            [value()],
            [Finding(claim=value().id, verdict=True, evidence="Yes.")],
            "L-T3.FPSE.beta0.5: a value has a number",
        ),
        (
            [value()],
            [Finding(claim=value().id, verdict=None, reason="Why.")],
            "L-T3.FPSE.beta0.5: a value has a number",
        ),
        (
            [value()],
            [Finding(claim=value().id, ours=8.83, evidence="Yes.")],
            "L-T3.FPSE.beta0.5: evidence",
        ),
        (
            [statement()],
            [Finding(claim=statement().id, evidence="Yes.")],
            "L-C12.symmetric.FPSE: a statement needs a verdict",
        ),
        (
            [statement()],
            [Finding(claim=statement().id, ours=1.0, verdict=True, evidence="Yes.")],
            "L-C12.symmetric.FPSE: a statement has no number",
        ),
        (
            [statement()],
            [Finding(claim=statement().id, verdict=True, evidence=" ")],
            "L-C12.symmetric.FPSE: a statement needs evidence",
        ),
        ([value()], [Finding(claim=value().id, ours=9.0)], "L-T3.FPSE.beta0.5: the status is dev"),
        ([value()], [Finding(claim=value().id)], "L-T3.FPSE.beta0.5: the status is not testable"),
        (
            [statement()],
            [Finding(claim=statement().id, verdict=False, evidence="No.", reason=" ")],
            "L-C12.symmetric.FPSE: the status is refuted",
        ),
        (
            [statement()],
            [Finding(claim=statement().id, verdict=None, evidence="No.")],
            "L-C12.symmetric.FPSE: the status is not testable",
        ),
    ],
)
def test_what_does_not_fit_is_refused_by_name(claims, findings, complaint):
    with pytest.raises(LedgerError, match=complaint.replace(".", r"\.")):
        ledger(claims, findings)


@given(finite)
def test_a_deviation_with_a_reason_never_raises(ours):
    df = ledger([value()], [Finding(claim=value().id, ours=ours, reason="As it is.")])
    assert df["status"].iloc[0] == judge_value("8.83", ours)


# --- records --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "change",
    [
        {"item": "L-T2"},
        {"printed": None},
        {"printed": "8.83 "},
        {"printed": "about 9"},
        {"printed": 8.83},
        {"kind": "statement"},
        {"statement": "Also this."},
        {"tolerance": 0.01},
        {"what": ""},
    ],
)
def test_a_claim_that_contradicts_itself_is_refused(change):
    with pytest.raises(ValueError, match="validation error"):
        Claim(**(value().model_dump() | change))


@pytest.mark.parametrize(
    "change", [{"ours": math.nan}, {"ours": math.inf}, {"verdict": "yes"}, {"our": 1.0}]
)
def test_a_finding_that_is_no_number_or_verdict_is_refused(change):
    with pytest.raises(ValueError, match="validation error"):
        Finding(claim="L-T3.DD.beta0.1", **change)


# --- files ----------------------------------------------------------------------------------------


def test_findings_come_back_as_they_were_written(tmp_path):
    path = tmp_path / "findings" / "scene.json"
    untestable = Finding(claim="L-C9.DD", verdict=None, evidence="-", reason="Why.", runs=("r.nc",))
    findings = [good_value, good_statement, untestable]
    write_findings(findings, path)
    assert "verdict" not in json.loads(path.read_text("utf-8"))[0]
    again = read_findings([path])
    assert again == findings
    assert [f.has_verdict for f in again] == [False, True, True]


def test_a_broken_findings_file_is_named(tmp_path):
    path = tmp_path / "scene.json"
    path.write_text('[{"claim": "L-C9.DD", "verdikt": true}]', encoding="utf-8")
    with pytest.raises(LedgerError, match=r"scene\.json"):
        read_findings([path])


@pytest.mark.parametrize("text", ["- [", "- {id: L-T3.a}", "a: 1"])
def test_a_broken_claims_file_is_named(tmp_path, text):
    path = tmp_path / "printed.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LedgerError, match=r"printed\.yaml"):
        read_claims(path)


def test_the_ledger_comes_back_from_its_csv(tmp_path):
    claims = [value(), statement(), value("L-T2.DD.II.beta0.1", "2.01")]
    findings = [
        Finding(claim=value().id, ours=1 / 3, reason="Commas, and\nlines."),
        Finding(claim=statement().id, verdict=True, evidence="|A - A^T| < 1e-16, nan nowhere."),
        Finding(claim="L-T2.DD.II.beta0.1", reason="Overflow."),
    ]
    df = ledger(claims, findings)
    csv, md = tmp_path / "out" / "claims.csv", tmp_path / "out" / "claims.md"
    write_ledger(df, csv, md)
    again = read_ledger(csv)
    assert again.drop(columns="relative_deviation").equals(df.drop(columns="relative_deviation"))
    assert again["relative_deviation"].tolist() == pytest.approx(
        df["relative_deviation"].tolist(), rel=1e-15, nan_ok=True
    )
    assert ledger_markdown(again) == ledger_markdown(df)
    assert md.read_text("utf-8").startswith(summary_line(df))
    assert sorted(p.name for p in csv.parent.iterdir()) == ["claims.csv", "claims.md"]


def test_a_table_of_other_columns_is_no_ledger(tmp_path):
    path = tmp_path / "claims.csv"
    path.write_text("id,ours\na,1\n", encoding="utf-8")
    with pytest.raises(LedgerError, match=r"claims\.csv: the columns"):
        read_ledger(path)


def test_a_write_that_fails_leaves_the_old_file_and_no_other(tmp_path):
    path = tmp_path / "claims.md"
    write_text(path, "old")
    with pytest.raises(UnicodeEncodeError):
        write_text(path, "new \ud800")
    assert path.read_text("utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


# --- tables ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("printed", "ours", "text"),
    [
        ("8.83", 8.83538, "8.8354"),
        ("97", 97.6321, "97.63"),
        ("1.11e-2", 0.0111742, "1.1174e-2"),
        ("2.01", "", ""),
    ],
)
def test_ours_shows_two_digits_more_than_the_print(printed, ours, text):
    assert ours_text(printed, ours) == text


def test_markdown_shows_the_text_as_it_is():
    df = ledger(
        [value(), statement(text="The error on |x| <= D is *small*.")],
        [
            Finding(claim=value().id, ours=8.8354),
            Finding(claim=statement().id, verdict=False, evidence="a|b & c", reason="It is\nnot."),
        ],
    )
    values, statements = ledger_markdown(df).split("\n\n")
    assert values.splitlines()[0] == "| claim | printed | ours | deviation | status | reason |"
    assert "| 8.83 | 8.8354 | +0.0612 % | ≈ reproduced within the print's rounding |" in values
    assert r"The error on \|x\| &lt;= D is \*small\*." in statements
    assert r"a\|b &amp; c | ✗ refuted | It is not. |" in statements
    assert len({status.sign for status in Status}) == len(Status)
    assert ledger_markdown(df[:0]) == ""


# --- the printed values of the main paper ---------------------------------------------------------


@pytest.fixture(scope="module")
def paper():
    return {claim.id: claim for claim in read_claims(PRINTED)}


@pytest.fixture(scope="module")
def validator():
    schema = json.loads(SCHEMA.read_text("utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def test_the_paper_follows_the_schema(validator):
    validator.validate(yaml.safe_load(PRINTED.read_text("utf-8")))


@pytest.mark.parametrize(
    "change",
    [
        {"printed": 8.83},
        {"printed": "8,83"},
        {"tolerance": "0.01"},
        {"kind": "number"},
        {"kind": "statement"},
        {"id": "T3"},
        {"what": " padded"},
        {"where": None},
    ],
)
def test_the_schema_refuses_what_the_reader_cannot_use(validator, change):
    record = value().model_dump(exclude_none=True)
    assert validator.is_valid([record])
    assert not validator.is_valid([copy.copy(record) | change])


def test_every_item_of_the_paper_has_claims(paper):
    """The items of the main paper, by its inventory."""
    figures = ["F1", "F2", "F3a", "F3b", "F4a", "F4b", "F5a", "F5b", "F6", "F7", "F8", "F9"]
    appendix = ["FA10", "FA11", "FA12", "TA4"]
    plane = ["2D-ORD", "2D-MASS", "2D-TAB"]
    items = {f"L-{name}" for name in ["T1", "T2", "T3", *figures, *appendix, *plane]}
    items |= {f"L-C{number}" for number in range(1, 20)}
    assert {claim.item for claim in paper.values()} == items


def test_the_paper_tables_row_by_row(paper):
    """The rows as they stand in print, against the claims that hold their numbers one by one."""

    def row(pattern: str, *keys: str) -> str:
        return " ".join(paper[pattern.format(*key.split())].text for key in keys)

    columns = [f"{s} {o}" for s in ("DD", "FPSE", "KPSE") for o in ("II", "IV")] + ["DVM II"]
    assert row("L-T2.{}.{}.beta0.1", *columns) == "2.01 3.88 2.04 3.97 1.98 3.79 2.00"
    assert row("L-T2.{}.{}.beta0.5", *columns) == "2.00 3.97 2.01 3.86 2.00 4.06 2.00"
    assert row("L-T2.{}.{}.beta0.9", *columns) == "2.00 4.00 2.01 3.96 2.00 3.99 2.42"
    assert row("L-T3.{}.beta0.1", "DD", "FPSE", "KPSE") == "4.81 7.05 2.25"
    assert row("L-T3.{}.beta0.5", "DD", "FPSE", "KPSE") == "5.25 8.83 2.17"
    assert row("L-T3.{}.beta0.9", "DD", "FPSE", "KPSE") == "5.43 10.5 2.04"
    alphas = [f"1.{digit}" for digit in range(1, 10)]
    radii = "6.688 3.544 2.512 2.005 1.705 1.509 1.371 1.269 1.190"
    assert row("L-TA4.alpha{}", *alphas) == radii
    assert row("L-C1.{}", "D", "h") == "357.5 1.11e-2"
