"""What documents print, as data: records that contradict themselves, files, sentences in two of them."""

from __future__ import annotations

import pytest
import yaml

from fracstudy.claims import Sentence, Statement, Value
from fracstudy.printed import read_claims, read_conventions, read_printed, refuse_repeats
from fracstudy.verdicts import LedgerError

VALUE = {
    "id": "L-T3.FPSE.beta0.5",
    "where": "Table 3",
    "what": "A limit.",
    "printed": "8.83",
}
HOLDS = [{"of": "ratio", "means": "their ratio", "above": 1, "why": "larger"}]
STATEMENT = {"id": "L-T3.ordering", "what": "One is larger.", "holds": HOLDS}
SENTENCE = {
    "sentence": "L-4.4.stringent",
    "where": "Sec. 4.4",
    "quote": "The one is\n  larger than the other.",
    "statements": [STATEMENT],
}


def write(path, *records):
    path.write_text(yaml.safe_dump(list(records)), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "change",
    [
        {"id": "T3"},
        {"id": "L-T3"},
        {"id": "X-T3.a"},
        {"id": "L-T3.a b"},
        {"item": "L-T3"},
        {"printed": None},
        {"printed": "8.83 "},
        {"printed": "8,83"},
        {"printed": "about 9"},
        {"printed": 8.83},
        {"printed": ".5"},
        {"tolerance": 0.01},
        {"what": ""},
        {"what": " padded"},
        {"where": None},
    ],
)
def test_a_value_that_no_reader_could_use_is_refused(change):
    assert Value(**VALUE).item == "L-T3"
    with pytest.raises(ValueError, match="validation error"):
        Value(**(VALUE | change))


TABLE = {
    "table": "L-T3.{scheme}.beta{beta}",
    "where": "Table {n}",
    "what": "{scheme} at {beta}.",
    "rows": ["scheme", "n"],
    "columns": {"beta": ["0.1", "0.5"]},
    "printed": {"DD, 3": ["4.81", "5.25"], "KPSE, 4": ["2.25", "2.17"]},
    "reason": "It is {ours:.2f}.",
}


def test_a_table_is_its_numbers_row_by_row(tmp_path):
    of_one_row = {**TABLE, "table": "L-T4.beta{beta}", "where": "Table 4", "what": "At {beta}."}
    of_one_row |= {"rows": [], "printed": ["1", "2"]}
    found = read_printed(write(tmp_path / "a.yaml", TABLE, of_one_row))
    ids = ["L-T3.DD.beta0.1", "L-T3.DD.beta0.5", "L-T3.KPSE.beta0.1", "L-T3.KPSE.beta0.5"]
    assert [value.id for value in found] == [*ids, "L-T4.beta0.1", "L-T4.beta0.5"]
    assert [value.printed for value in found] == ["4.81", "5.25", "2.25", "2.17", "1", "2"]
    assert (found[3].where, found[3].what) == ("Table 4", "KPSE at 0.5.")
    assert {value.reason for value in found} == {"It is {ours:.2f}."}


@pytest.mark.parametrize(
    "change",
    [
        {"printed": {"DD, 3": ["4.81"]}},
        {"printed": {"DD": ["4.81", "5.25"]}},
        {"printed": ["4.81", "5.25"]},
        {"printed": {"DD, 3": ["4.81", "about 5"]}},
        {"what": "{order} at {beta}."},
        {"columns": {}},
        {"table": "{beta}"},
    ],
)
def test_a_table_that_does_not_fit_is_named(tmp_path, change):
    with pytest.raises(LedgerError, match=r"a\.yaml"):
        read_printed(write(tmp_path / "a.yaml", {**TABLE, **change}))


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"holds": []}, "either `holds` or `untestable`"),
        ({"untestable": "No data."}, "either `holds` or `untestable`"),
        ({"holds": [{**HOLDS[0], "below": 2}]}, "above"),
        ({"intended": {"what": "The other sign.", "holds": []}}, "intended.holds"),
        ({"intended": {"holds": HOLDS}}, "intended.what"),
        ({"verdict": True}, "verdict"),
    ],
)
def test_a_statement_that_contradicts_itself_is_refused(change, complaint):
    assert Statement(**STATEMENT).item == "L-T3"
    with pytest.raises(ValueError, match=complaint):
        Statement(**(STATEMENT | change))


def test_a_statement_that_cannot_be_tested_cannot_be_a_misprint():
    intended = {"what": "The other sign.", "holds": HOLDS}
    given = {**STATEMENT, "holds": [], "untestable": "No data."}
    assert Statement(**given).untestable
    with pytest.raises(ValueError, match="a misprint has `holds`"):
        Statement(**given, intended=intended)


@pytest.mark.parametrize("change", [{"quote": ""}, {"statements": []}, {"sentence": ""}])
def test_a_sentence_is_quoted_and_says_something(change):
    assert Sentence(**SENTENCE).words == "The one is larger than the other."
    with pytest.raises(ValueError, match="validation error"):
        Sentence(**(SENTENCE | change))


def test_files_are_read_in_the_order_of_their_names(tmp_path):
    write(tmp_path / "b.yaml", VALUE)
    write(tmp_path / "a.yaml", SENTENCE)
    found = read_printed(tmp_path)
    assert [type(record) for record in found] == [Sentence, Value]
    assert [claim.id for claim in read_claims(tmp_path)] == ["L-T3.ordering", VALUE["id"]]
    assert read_printed(tmp_path / "b.yaml", tmp_path / "a.yaml") == found[::-1]


def test_two_files_may_hold_what_one_sentence_says(tmp_path):
    other = {**STATEMENT, "id": "L-T3.several"}
    write(tmp_path / "a.yaml", SENTENCE)
    again = {**SENTENCE, "quote": "The one is larger\nthan the other.", "statements": [other]}
    write(tmp_path / "b.yaml", again)
    assert len(read_printed(tmp_path)) == 2
    write(tmp_path / "b.yaml", {**again, "quote": "One is larger."})
    with pytest.raises(LedgerError, match=r"b\.yaml: L-4\.4\.stringent is quoted in other words"):
        read_printed(tmp_path)


@pytest.mark.parametrize("records", [(VALUE, VALUE), (SENTENCE, {**SENTENCE, "sentence": "L-5.x"})])
@pytest.mark.parametrize("in_one_file", [True, False])
def test_a_claim_that_comes_twice_is_refused(tmp_path, records, in_one_file):
    one, other = records
    write(tmp_path / "a.yaml", *(records if in_one_file else [one]))
    write(tmp_path / "b.yaml", *([] if in_one_file else [other]))
    with pytest.raises(LedgerError, match=r"\.yaml: claimed twice: L-T3"):
        read_printed(tmp_path)


def test_a_sentence_that_comes_twice_in_a_file_is_refused(tmp_path):
    other = {**SENTENCE, "statements": [{**STATEMENT, "id": "L-T3.several"}]}
    with pytest.raises(LedgerError, match=r"a\.yaml: named twice: L-4\.4\.stringent"):
        read_printed(write(tmp_path / "a.yaml", SENTENCE, other))


@pytest.mark.parametrize("text", ["- [", "- {id: L-T3.a}", "a: 1", "- 1", ""])
def test_a_broken_file_is_named(tmp_path, text):
    path = tmp_path / "scene.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LedgerError, match=r"scene\.yaml"):
        read_printed(path)


@pytest.mark.parametrize("text", ["- [", "several: 2", "several: {means: Twice.}", ""])
def test_broken_conventions_are_named(tmp_path, text):
    path = tmp_path / "words.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LedgerError, match=r"words\.yaml"):
        read_conventions(path)


def test_repeats_are_named_in_order():
    refuse_repeats(["a", "b"], "twice")
    with pytest.raises(LedgerError, match=r"^twice: a, c$"):
        refuse_repeats(["c", "a", "b", "a", "c"], "twice")
