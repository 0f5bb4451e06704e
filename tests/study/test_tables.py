"""Frames as CSV and as Markdown tables that stay tables."""

from __future__ import annotations

import re

import markdown
import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracstudy.inputs import write_table


def cells(line: str) -> list[str]:
    """The cells of a row of a Markdown table, with what is escaped in them as it is meant."""
    parts = re.split(r"(?<!\\)\|", line)
    assert parts[0] == parts[-1] == ""
    return [part.strip().replace(r"\|", "|") for part in parts[1:-1]]


def written(table: pd.DataFrame, tmp_path) -> list[str]:
    write_table(table, tmp_path / "t.csv", tmp_path / "t.md")
    return (tmp_path / "t.md").read_text().splitlines()


def test_a_bar_in_a_header_or_a_cell_stays_in_its_column(tmp_path):
    table = pd.DataFrame(
        {
            "largest error, |x| < 5": [1.0, 2.5],
            "what": ["|exp(A t)| at most 1", "at `|k|` = 2"],
            "n": [1, 2],
            "verdict": ["holds", None],
        }
    )
    lines = written(table, tmp_path)
    assert cells(lines[0]) == list(table)
    assert [cells(line)[1] for line in lines[2:]] == list(table["what"])
    assert [cells(line)[3] for line in lines[2:]] == ["holds", ""]
    assert {len(cells(line)) for line in lines} == {4}
    # The CSV has the text itself.
    assert list(pd.read_csv(tmp_path / "t.csv")) == list(table)
    assert "\\|" not in (tmp_path / "t.csv").read_text()


def test_the_page_shows_the_bar(tmp_path):
    """In the HTML of the report neither the bar is lost nor its escape left."""
    table = pd.DataFrame({"|x|": ["a | b", "|k|"], "y": [1, 2]})
    text = "\n".join(written(table, tmp_path))
    page = markdown.markdown(text, extensions=["tables"])
    shown = re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", page)
    assert shown == ["|x|", "y", "a | b", "1", "|k|", "2"]


def test_missing_values_and_whole_numbers_stay_what_they_are(tmp_path):
    table = pd.DataFrame({
        "a": [1.0, np.nan], "b": pd.array([1000, None], dtype="Int64"), "c": [True, False], "d": [10**6, 2],
    })  # fmt: skip
    first, second = (cells(line) for line in written(table, tmp_path)[2:])
    assert first == ["1", "1000", "True", "1000000"]
    assert second == ["", "", "False", "2"]


def test_zero_has_no_sign_in_a_table_for_people(tmp_path):
    table = pd.DataFrame({"a": [-0.0, -1e-300], "b": [-0.0, "-0.0"]})
    assert [cells(line) for line in written(table, tmp_path)[2:]] == [["0", "0"], ["-1e-300", "-0"]]
    assert (tmp_path / "t.csv").read_text().splitlines()[1] == "-0.0,-0.0"


@pytest.mark.parametrize("table", [pd.DataFrame(), pd.DataFrame({"|a|": []})])
def test_a_table_without_rows_is_written(table, tmp_path):
    written(table, tmp_path)


@given(
    st.lists(
        st.text(st.sampled_from("ab |x<>=0.5"), min_size=1, max_size=12), min_size=2, max_size=4
    )
)
def test_every_row_has_as_many_cells_as_the_header(tmp_path_factory, texts):
    table = pd.DataFrame({text: [text, "|", str(k)] for k, text in enumerate(texts)})
    lines = written(table, tmp_path_factory.mktemp("t"))
    assert {len(cells(line)) for line in lines} == {table.shape[1]}
