"""The ledger: rows, verdicts on statements and sentences, what it refuses, and how it is shown and kept."""

from __future__ import annotations

import math
from html.parser import HTMLParser
from itertools import permutations

import markdown
import pandas as pd
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from fracstudy.claims import Sentence, Value
from fracstudy.criteria import Convention
from fracstudy.findings import Finding, measured
from fracstudy.ledger import COLUMNS, judge, ledger
from fracstudy.ledger_text import (
    ledger_markdown,
    ours_text,
    read_ledger,
    sentence_status,
    summary_line,
    write_ledger,
)
from fracstudy.verdicts import LedgerError, Status

WORDS = {
    "several": Convention(at_least=2.0, means="At least twice."),
    "negligible": Convention(at_most=0.01, means="At most one per cent."),
}
LIMIT, SEVERAL, ORDER = "L-T3.FPSE.beta0.5", "L-T3.several", "L-T3.ordering"


def value(name: str = LIMIT, printed: str = "8.83", **more) -> Value:
    return Value(id=name, what="A limit.", where="Table 3", printed=printed, **more)


def several(name: str = SEVERAL, **more) -> dict:
    holds = [{"of": "ratio", "means": "their ratio", "word": "several"}]
    return {"id": name, "what": "It is several times the other.", "holds": holds, **more}


def larger(name: str = ORDER, **more) -> dict:
    holds = [{"of": "ratio", "means": "their ratio", "above": 1, "why": "a ranking"}]
    return {"id": name, "what": "It is larger.", "holds": holds, **more}


def sentence(*statements: dict, name: str = "L-4.4.stringent", **more) -> Sentence:
    given = {"where": "Sec. 4.4", "quote": "It is several\ntimes larger.", **more}
    return Sentence(sentence=name, statements=list(statements or [several()]), **given)


def one(record: Value | Sentence, finding: Finding, **more) -> pd.Series:
    """The row of the only claim of a record."""
    (_, row), *others = ledger([record], [finding], WORDS, **more).iterrows()
    assert not others
    return row


# --- rows --------------------------------------------------------------------------------------------


def test_one_row_a_claim_in_the_order_of_the_print():
    printed = [
        value(),
        sentence(several(reason="In closed form it is {ratio:.2f}."), larger(), by=["tests/a.py"]),
        value(
            "L-T2.DD.II.beta0.1", "2.01", reason="On another level.", by=["numpy.sum", "numpy.dot"]
        ),
    ]
    findings = [
        measured("L-T2.DD.II.beta0.1", ours=2.11, runs=["runs/a.nc", "runs/b.nc"]),
        measured(ORDER, ratio=1.46),
        measured(SEVERAL, ratio=1.26),
        measured(LIMIT, ours=8.8354),
    ]
    df = ledger(printed, findings, WORDS)
    assert tuple(df.columns) == COLUMNS
    assert df["id"].tolist() == [LIMIT, SEVERAL, ORDER, "L-T2.DD.II.beta0.1"]
    assert df["sentence"].tolist() == ["", "L-4.4.stringent", "L-4.4.stringent", ""]
    assert df["item"].tolist() == ["L-T3", "L-T3", "L-T3", "L-T2"]
    assert df["printed"].tolist() == ["8.83", *["It is several times larger."] * 2, "2.01"]
    assert df["status"].tolist() == [
        "reproduced within the print's rounding",
        "refuted",
        "reproduced",
        "deviates",
    ]
    assert df["ours"].tolist() == [8.8354, "their ratio: 1.26.", "their ratio: 1.46.", 2.11]
    assert df["criterion"].tolist() == [
        "",
        "their ratio: at least 2 (several)",
        "their ratio: above 1 (a ranking)",
        "",
    ]
    assert df["reason"].tolist() == ["", "In closed form it is 1.26.", "", "On another level."]
    assert df["margin"].tolist() == pytest.approx([math.nan, 0.63, 1.46, math.nan], nan_ok=True)
    deviations = [(8.8354 - 8.83) / 8.83, math.nan, math.nan, 0.1 / 2.01]
    assert df["relative_deviation"].tolist() == pytest.approx(deviations, nan_ok=True, rel=1e-12)
    assert df["made_by"].tolist() == ["", "tests/a.py", "tests/a.py", "numpy.sum; numpy.dot"]
    assert df["runs"].tolist() == ["", "", "", "runs/a.nc; runs/b.nc"]


def test_no_claims_give_an_empty_ledger():
    df = ledger([], [], WORDS)
    assert tuple(df.columns) == COLUMNS
    assert summary_line(df) == "no claims"
    assert ledger_markdown(df) == ""


def test_what_is_reproduced_needs_no_reason_and_shows_none():
    assert one(sentence(larger(reason="So.")), measured(ORDER, ratio=1.46))["reason"] == ""
    assert one(value(reason="Truncated."), measured(LIMIT, ours=8.8354))["reason"] == "Truncated."


def test_a_statement_names_what_made_it_before_its_sentence_does():
    row = one(sentence(several(by=["tests/b.py"]), by=["tests/a.py"]), measured(SEVERAL, ratio=3))
    assert row["made_by"] == "tests/b.py"


def test_a_value_without_a_number_of_ours_is_not_testable():
    row = one(value(reason="The run overflows."), measured(LIMIT))
    assert (row["status"], row["ours"], row["reason"]) == ("not testable", "", "The run overflows.")
    assert math.isnan(row["relative_deviation"])


def test_a_printed_zero_has_no_relative_deviation():
    row = one(value(printed="0.0"), measured(LIMIT, ours=0.01))
    assert row["status"] == "reproduced"
    assert math.isnan(row["relative_deviation"])


def test_what_cannot_be_tested_needs_no_finding_and_says_why():
    given = several(holds=[], untestable="The data are not there.", evidence="They are asked for.")
    df = ledger([sentence(given)], [], WORDS)
    assert df["status"].tolist() == ["not testable"]
    assert df["reason"].tolist() == ["The data are not there."]
    assert df["ours"].tolist() == ["They are asked for."]


# --- evidence ----------------------------------------------------------------------------------------


def test_evidence_of_its_own_looks_numbers_up():
    given = several(evidence="It is {ratio:.1f} times {other}.", note="Of {other}.")
    row = one(sentence(given), measured(SEVERAL, ratio=3.14, other="DD"))
    assert row["ours"] == "It is 3.1 times DD."
    assert row["note"] == "Of DD."


@pytest.mark.parametrize(
    ("ratio", "shown"),
    [
        (3.14159, "their ratio: 3.14."),
        ([2, 3.5], "their ratio: 2, 3.5."),
        ({"DD": 2.0, "KPSE": 3.0}, "their ratio: 2 (DD), 3 (KPSE)."),
        ([k + 2.0 for k in range(6)], "their ratio: 2, 3, 4, 5, 6, 7."),
        ([k + 2.0 for k in range(7)], "their ratio: 2 to 8, 7 numbers."),
        ({f"N = {k}": 9.0 - k for k in range(7)}, "their ratio: 3 (N = 6) to 9 (N = 0), 7 cases."),
    ],
)
def test_without_it_the_numbers_of_the_conditions_are_shown(ratio, shown):
    assert one(sentence(), measured(SEVERAL, ratio=ratio))["ours"] == shown


def test_a_number_between_two_thresholds_is_shown_once():
    share = {"of": "ratio", "means": "their ratio", "why": "as printed"}
    given = several(holds=[{**share, "at_least": 2}, {**share, "at_most": 4}])
    row = one(sentence(given), measured(SEVERAL, ratio=3))
    assert row["ours"] == "their ratio: 3."
    assert row["criterion"].count("their ratio") == 2


# --- verdicts ----------------------------------------------------------------------------------------


def test_a_statement_of_several_cases_may_be_true_in_part():
    given = several(reason="Not for {ratio.least:.1f}.")
    row = one(sentence(given), measured(SEVERAL, ratio={"DD": 1.1, "KPSE": 5.0, "FPSE": 4.0}))
    assert row["status"] == "true in part"
    assert (row["holds_for"], row["fails_for"]) == ("KPSE; FPSE", "DD")
    assert row["margin"] == pytest.approx(0.55)
    assert row["reason"] == "Not for 1.1."


@pytest.mark.parametrize("ratio", [{"DD": 9.0, "KPSE": 5.0}, {"DD": 0.1, "KPSE": 0.2}])
def test_cases_are_listed_only_where_they_differ(ratio):
    row = one(sentence(several(reason="So.")), measured(SEVERAL, ratio=ratio))
    assert (row["holds_for"], row["fails_for"]) == ("", "")


def test_a_misprint_shows_what_was_printed_and_what_was_meant():
    intended = {
        "what": "with the other sign",
        "holds": [{"of": "meant", "means": "error as meant", "word": "negligible"}],
    }
    given = several(
        holds=[{"of": "error", "means": "error as printed", "word": "negligible"}],
        intended=intended,
        reason="A sign is lost.",
    )
    row = one(sentence(given), measured(SEVERAL, error=2.0, meant=1e-4))
    assert row["status"] == "misprint"
    assert row["ours"] == "error as printed: 2; error as meant: 0.0001."
    assert row["criterion"] == (
        "as printed, error as printed: at most 0.01 (negligible); as meant (with the other sign), "
        "error as meant: at most 0.01 (negligible)"
    )
    assert row["margin"] == pytest.approx(0.01)
    assert one(sentence(given), measured(SEVERAL, error=2.0, meant=1.0))["status"] == "refuted"
    assert one(sentence(given), measured(SEVERAL, error=0.0, meant=1.0))["status"] == "reproduced"


def test_a_threshold_that_decides_narrowly_is_a_close_call():
    row = one(sentence(several()), measured(SEVERAL, ratio=2.5))
    assert row["close_call"] == "refuted with at least 3 for their ratio"


def test_another_reading_that_decides_otherwise_is_a_close_call():
    readings = {"another seed": {"ratio": 1.0}, "a third seed": {"ratio": 7.0}}
    row = one(sentence(several()), measured(SEVERAL, ratio=8.0, others=readings))
    assert row["status"] == "reproduced"
    assert row["close_call"] == "refuted with another seed"


def test_another_reading_leaves_the_other_numbers_as_they_are():
    both = [*larger()["holds"], {"of": "error", "means": "the error", "word": "negligible"}]
    finding = measured(SEVERAL, ratio=2.0, error=1e-9, others={"another seed": {"ratio": 3.0}})
    assert one(sentence(several(holds=both)), finding)["close_call"] == ""


def test_a_criterion_that_was_changed_says_so():
    given = several(changed="At least 1.4: reproduced with {ratio:.2f}.", reason="So.")
    row = one(sentence(given), measured(SEVERAL, ratio=1.46))
    assert row["changed"] == "At least 1.4: reproduced with 1.46."


def test_a_verdict_alone_is_that_of_the_row():
    record, finding = sentence(several(reason="So.")), measured(SEVERAL, ratio=1.0)
    assert judge(record.statements[0], finding, WORDS) == one(record, finding)["status"]
    assert judge(value(), measured(LIMIT, ours=8.83)) is Status.REPRODUCED
    assert judge(value(), measured(LIMIT)) is Status.NOT_TESTABLE


def test_the_conventions_are_those_of_the_project():
    assert judge(sentence().statements[0], measured(SEVERAL, ratio=2.0)) is Status.REPRODUCED


# --- what is refused ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("printed", "findings", "complaint"),
    [
        ([value()], [], f"without a finding: {LIMIT}"),
        ([sentence()], [], f"without a finding: {SEVERAL}"),
        ([value()], [measured(LIMIT, ours=8.83), measured("L-C9.DD")], "unknown claim: L-C9.DD"),
        ([value()], [measured(LIMIT, ours=8.83)] * 2, f"found twice: {LIMIT}"),
        ([value(), value()], [measured(LIMIT, ours=8.83)], f"claimed twice: {LIMIT}"),
        ([value()], [measured(LIMIT, ours=9.0)], f"{LIMIT}: the status is deviates, and no reason"),
        ([value()], [measured(LIMIT)], f"{LIMIT}: the status is not testable, and no reason"),
        ([sentence()], [measured(SEVERAL, ratio=1.0)], f"{SEVERAL}: the status is refuted, and no"),
        (
            [sentence()],
            [measured(SEVERAL, ratio={"DD": 1.0, "KPSE": 9.0})],
            f"{SEVERAL}: the status is true in part, and no",
        ),
        ([sentence()], [measured(SEVERAL)], f"{SEVERAL}: ratio was not measured; measured: none"),
        (
            [sentence()],
            [measured(SEVERAL, ratios=9.0)],
            f"{SEVERAL}: ratio was not measured; measured: ratios",
        ),
        ([sentence()], [measured(SEVERAL, ratio="large")], f"{SEVERAL}: ratio is 'large'"),
        (
            [sentence(several(evidence="{rate:.2f}"))],
            [measured(SEVERAL, ratio=9.0)],
            f"{SEVERAL}: KeyError('rate') in '{{rate:.2f}}'; measured: ratio",
        ),
        (
            [sentence(several(holds=[{"of": "a", "means": "b", "word": "many"}]))],
            [measured(SEVERAL, a=9.0)],
            f"{SEVERAL}: no convention says what 'many' means",
        ),
    ],
)
def test_what_does_not_fit_is_refused_by_name(printed, findings, complaint):
    with pytest.raises(LedgerError) as caught:
        ledger(printed, findings, WORDS)
    assert complaint in str(caught.value)


@pytest.mark.parametrize("field", ["evidence", "note", "changed", "reason"])
def test_every_text_that_is_shown_may_ask_for_numbers_that_are_there_only(field):
    given = several(**({"reason": "So."} | {field: "{rate:.2f}"}))
    with pytest.raises(LedgerError, match=f"{SEVERAL}: .*rate.* measured: ratio"):
        ledger([sentence(given)], [measured(SEVERAL, ratio=0.1)], WORDS)


def test_a_smoke_run_is_too_coarse_to_judge():
    (coarse,) = {
        one(value(), measured(LIMIT, ours=1.0), smoke=True)["reason"],
        one(sentence(), measured(SEVERAL, ratio=0.1), smoke=True)["reason"],
        one(sentence(several(evidence="{no}")), measured(SEVERAL, ratio=9.0), smoke=True)["ours"],
    }
    assert "too coarse" in coarse
    assert one(sentence(), measured(SEVERAL, ratio=9.0), smoke=True)["reason"] == ""
    own = several(reason="A reason of its own.")
    assert one(sentence(own), measured(SEVERAL, ratio=0.1), smoke=True)["reason"] == own["reason"]


def test_a_smoke_run_measures_all_the_same():
    with pytest.raises(LedgerError, match="ratio was not measured"):
        one(sentence(), measured(SEVERAL), smoke=True)


# --- sentences ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("statuses", "whole"),
    [
        ("reproduced reproduced", Status.REPRODUCED),
        ("refuted refuted", Status.REFUTED),
        ("misprint", Status.MISPRINT),
        ("reproduced misprint", Status.MISPRINT),
        ("reproduced refuted", Status.PART),
        ("true_in_part", Status.PART),
        ("true_in_part reproduced", Status.PART),
        ("true_in_part refuted", Status.PART),
        ("misprint refuted", Status.PART),
        ("misprint reproduced refuted", Status.PART),
        ("not_testable", Status.NOT_TESTABLE),
        ("not_testable reproduced", Status.REPRODUCED),
        ("not_testable refuted", Status.REFUTED),
        ("not_testable reproduced misprint", Status.MISPRINT),
    ],
)
def test_a_sentence_has_one_verdict(statuses, whole):
    words = [word.replace("_", " ") for word in statuses.split()]
    for order in permutations([*words, words[0]]):
        assert sentence_status(order) is whole


# --- the summary -------------------------------------------------------------------------------------


@pytest.fixture
def df():
    """Two numbers, and two sentences, one of which is true in part; its second half stands in another scene."""
    printed = [
        value(reason="Printed truncated."),
        value("L-T3.DD.beta0.5", "5.25", reason="Commas, and\nlines."),
        value("L-T3.KPSE.beta0.5", "2.17", reason="It overflows."),
        sentence(several(reason="It is\nnot so.")),
        sentence(several("L-C9.a"), larger("L-C9.b"), name="L-3.other", quote="A |x| <= *a_b*."),
        sentence(larger("L-C8.a"), name="L-4.4.stringent"),
    ]
    findings = [
        measured(LIMIT, ours=8.8354),
        measured("L-T3.DD.beta0.5", ours=1 / 3),
        measured("L-T3.KPSE.beta0.5"),
        measured(SEVERAL, ratio=1.25, others={'nan, or "none"': {"ratio": 9.0}}),
        measured("L-C9.a", ratio=9.0, runs=["a.nc"]),
        measured("L-C9.b", ratio=9.0),
        measured("L-C8.a", ratio=1.25),
    ]
    return ledger(printed, findings, WORDS)


def test_the_summary_counts_numbers_and_sentences(df):
    assert summary_line(df) == (
        "3 printed numbers: 1 within the print's rounding, 1 deviates, 1 not testable; "
        "2 sentences: 1 reproduced, 1 true in part"
    )


def test_a_part_of_the_ledger_counts_sentences_with_the_verdict_on_the_whole(df):
    assert summary_line(df, df["item"] == "L-C8") == "1 sentence: 1 true in part"
    assert summary_line(df, df["item"] == "L-C1") == "no claims"
    two = df.assign(status=["deviates"] * 3 + ["misprint"] * 4)
    assert summary_line(two) == "3 printed numbers: 3 deviate; 2 sentences: 2 misprints"


# --- Markdown ----------------------------------------------------------------------------------------


def rows(text: str) -> list[list[str]]:
    """The cells of the rows of a page's tables, as a reader sees them."""

    class Cells(HTMLParser):
        found: list[list[str]]

        def handle_starttag(self, tag, attrs):
            if tag == "tr":
                self.found.append([])
            elif tag in ("th", "td"):
                self.found[-1].append("")
            elif tag == "br":
                self.found[-1][-1] += "\n"

        def handle_data(self, data):
            if self.found and self.found[-1]:
                self.found[-1][-1] += data

    page = Cells()
    page.found = []
    page.feed(markdown.markdown(text, extensions=["tables", "sane_lists", "md_in_html"]))
    return [[cell.strip() for cell in row] for row in page.found]


def test_the_ledger_is_a_table_of_numbers_and_one_of_sentences(df):
    values, sentences = ledger_markdown(df).split("\n\n")
    assert rows(values)[0] == ["claim", "printed", "ours", "deviation", "verdict", "remarks"]
    assert rows(values)[1] == [
        f"{LIMIT}\nA limit.",
        "8.83",
        "8.8354",
        "+0.0612 %",
        "≈ reproduced within the print's rounding",
        "Printed truncated.",
    ]
    assert rows(values)[2][-1] == "Commas, and lines."
    assert rows(values)[3][1:4] == ["2.17", "", ""]
    head = ["as printed", "statement", "ours", "criterion", "verdict", "remarks"]
    assert rows(sentences)[0] == head


def test_a_sentence_is_quoted_once_with_the_verdict_on_the_whole(df):
    _, *shown = rows(ledger_markdown(df).split("\n\n")[1])
    assert [row[0] for row in shown] == [
        "“It is several times larger.” (Sec. 4.4)\nas a whole: ◐ true in part",
        "″",
        "“A |x| <= *a_b*.” (Sec. 4.4)",
        "″",
    ]
    assert [row[1].split("\n")[0] for row in shown] == [SEVERAL, "L-C8.a", "L-C9.a", "L-C9.b"]
    assert shown[0][2:] == [
        "their ratio: 1.25.",
        "their ratio: at least 2 (several)\nmargin 0.625",
        "✗ refuted",
        'It is not so.\nClose call: reproduced with nan, or "none".',
    ]


def test_a_part_of_the_ledger_keeps_the_verdict_on_the_whole(df):
    exceptions = df["status"].map(lambda word: Status(word).needs_reason)
    text = ledger_markdown(df, exceptions)
    assert "as a whole: ◐ true in part" in text
    assert "L-C8.a" not in text
    assert "L-3.other" not in text
    assert LIMIT not in text
    assert ledger_markdown(df, exceptions & (df["sentence"] != "")).startswith("| as printed")
    assert ledger_markdown(df, df["item"] == "none") == ""


def test_the_remarks_say_what_a_referee_asks_for():
    given = several(
        reason="In closed form.", note="A slip of the pen.", changed="At least 1.4: reproduced."
    )
    cases = measured(SEVERAL, ratio={"DD": 1.4, "KPSE": 9.0})
    ((_, shown),) = [rows(ledger_markdown(ledger([sentence(given)], [cases], WORDS)))]
    assert shown[-1].split("\n") == [
        "In closed form.",
        "Holds for KPSE.",
        "Not for DD.",
        "Close call: reproduced with at least 1.33 for their ratio.",
        "Criterion changed: At least 1.4: reproduced.",
        "A slip of the pen.",
    ]


shown_text = st.text(
    st.sampled_from("ab 1\n|*_`[]()<>&\\#-+~.!:λ∂²′\"'{}") | st.characters(categories=["L", "N"]),
    min_size=1,
).filter(lambda text: bool(text.split()))


@given(shown_text, shown_text)
@example("_a_ b", "[a](b)")
@example("`a` b", "*a* b")
@example("<b>a</b>", "&lt; a|b")
def test_a_reader_sees_the_text_as_it_is(quote, note):
    escaped = note.replace("{", "{{").replace("}", "}}")
    df = ledger(
        [sentence(several(note=escaped), quote=quote)], [measured(SEVERAL, ratio=9.0)], WORDS
    )
    _, (printed, *_, remarks) = rows(ledger_markdown(df))
    assert printed == f"“{' '.join(quote.split())}” (Sec. 4.4)"
    assert remarks == " ".join(note.split())


@pytest.mark.parametrize(
    ("printed", "ours", "text"),
    [
        ("8.83", 8.83538, "8.8354"),
        ("97", 97.6321, "97.63"),
        ("1.11e-2", 0.0111742, "1.1174e-2"),
        ("-2.0", -1.98765, "-1.988"),
        ("2.01", "", ""),
        ("A is symmetric.", "It is.", "It is."),
    ],
)
def test_ours_shows_two_digits_more_than_the_print(printed, ours, text):
    assert ours_text(printed, ours) == text


@pytest.mark.parametrize(
    ("ours", "shown"), [(10.0, "0 %"), (11.0, "+10 %"), (9.0, "-10 %"), (10.0 - 1e-9, "-1e-08 %")]
)
def test_a_deviation_is_in_per_cent_with_its_sign(ours, shown):
    df = ledger([value(printed="10.0", reason="So.")], [measured(LIMIT, ours=ours)], WORDS)
    assert rows(ledger_markdown(df))[1][3] == shown


# --- files -------------------------------------------------------------------------------------------


def test_the_ledger_comes_back_from_its_csv(tmp_path, df):
    csv, md = tmp_path / "out" / "claims.csv", tmp_path / "out" / "claims.md"
    write_ledger(df, csv, md)
    again = read_ledger(csv)
    pd.testing.assert_frame_equal(again, df, check_exact=False, rtol=1e-15)
    assert ledger_markdown(again) == ledger_markdown(df)
    assert md.read_text("utf-8") == f"{summary_line(df)}\n\n{ledger_markdown(df)}"
    assert sorted(p.name for p in csv.parent.iterdir()) == ["claims.csv", "claims.md"]


def test_a_table_of_other_columns_is_no_ledger(tmp_path):
    path = tmp_path / "claims.csv"
    path.write_text("id,ours\na,1\n", encoding="utf-8")
    with pytest.raises(LedgerError, match=r"claims\.csv: the columns"):
        read_ledger(path)
