"""The printed claims of the documents: numbers, and sentences with statements (`report/printed/<document>/*.yaml`).

A file is a list. A number of a table or a text stands alone; a sentence is quoted whole and holds the statements that
it makes, each with the criterion by which it is judged:

    - id: L-T3.DD.beta0.1
      where: Table 3
      what: Stability limit a (55) of DD at beta = 0.1.
      printed: "4.81"
    - sentence: L-4.4.several_times
      where: Sec. 4.4, before Table 3
      quote: The FPSE method allows a time step that is several times larger ...
      statements:
        - id: L-T3.several_times
          what: FPSE's stability limit is several times that of DD and of KPSE.
          holds: [{of: ratio, means: FPSE's limit over that of the other scheme, word: several}]

A table of numbers is written as it is printed, rows by columns, with one id and one sentence for all of them:

    - table: L-T3.{scheme}.beta{beta}
      where: Table 3
      what: Stability limit a (55) of {scheme} at beta = {beta}.
      rows: [scheme]
      columns: {beta: ["0.1", "0.5"]}
      printed: {DD: ["4.81", "5.25"], FPSE: ["7.05", "8.83"]}

The part of an id before the first dot is the item: a figure, table or statement of the inventory.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from fracstudy.criteria import Condition

__all__ = [
    "PRINTED_NUMBER",
    "Intended",
    "Sentence",
    "Statement",
    "Table",
    "Value",
]

PRINTED_NUMBER = r"^-?[0-9]+(\.[0-9]+)?(e-?[0-9]{1,3})?$"
_ID = r"^[LMSP]-[A-Z0-9-]+[a-z]?(\.[A-Za-z0-9_]+)+$"
_TEXT = r"^\S(.*\S)?$"


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class _Claim(_Record):
    """The fields that values and statements share.

    Attributes
    ----------
    id : str
        The item and its part, separated by dots: ``L-T3.DD.beta0.1``.
    what : str
        The claim in one plain sentence of ours.
    reason : str
        Why it is not simply reproduced. ``{name:.2f}`` in the text stands for a number that was measured.
    note : str
        A remark on wording or rounding, shown whatever the verdict.
    by : list of str
        The makers of its number if no run made it: dotted names of functions, and tests as ``tests/file.py::name``.
    """

    id: str = Field(pattern=_ID)
    what: str = Field(pattern=_TEXT)
    reason: str = ""
    note: str = ""
    by: list[str] = []

    @property
    def item(self) -> str:
        """The figure, table or statement to which it belongs."""
        return self.id.partition(".")[0]


class Value(_Claim):
    """A printed number; its tolerance follows from its digits.

    Attributes
    ----------
    where : str
        Table, section or equation.
    printed : str
        The number with exactly the digits of the print.
    """

    where: str = Field(pattern=_TEXT)
    printed: str = Field(pattern=PRINTED_NUMBER)
    name: ClassVar[str] = ""
    """Empty: a value stands in no sentence."""

    @property
    def words(self) -> str:
        """The printed number."""
        return self.printed

    @property
    def claims(self) -> Sequence[Self]:
        """Its only claim, itself."""
        return [self]


class Table(_Record):
    """Printed numbers in rows and columns, each a `Value`.

    Attributes
    ----------
    table, where, what : str
        The id, the place and the sentence of each number; `{name}` in them stands for a label of its row or column.
    rows : list of str
        The names of the labels of a row, in their order; empty for a table of one row.
    columns : dict
        The labels of the columns, by name.
    printed : dict or list
        The numbers of each row, by its labels, "DD" or "DD, II"; for one row without labels a list.
    reason, note, by
        For each number, as in `Value`.
    """

    table: str = Field(min_length=1)
    where: str
    what: str
    rows: list[str] = []
    columns: dict[str, list[str]] = Field(min_length=1)
    printed: dict[str, list[str]] | list[str]
    reason: str = ""
    note: str = ""
    by: list[str] = []

    def values(self) -> list[Value]:
        """Return the numbers, row by row.

        Raises
        ------
        ValueError
            If a row does not have a number for each column, or a label for each of `rows`.
        """
        lines = self.printed if isinstance(self.printed, dict) else {"": self.printed}
        found = []
        for row, numbers in lines.items():
            names = dict(zip(self.rows, row.split(", ") if self.rows else [], strict=True))
            for printed, *column in zip(numbers, *self.columns.values(), strict=True):
                of = {**names, **dict(zip(self.columns, column, strict=True))}
                text = {key: getattr(self, key).format(**of) for key in ("where", "what")}
                more = {key: getattr(self, key) for key in ("reason", "note", "by")}
                found.append(Value(id=self.table.format(**of), printed=printed, **text, **more))
        return found


class Intended(_Record):
    """The intended form of a misprinted formula, and the criterion that shows it to be right."""

    what: str = Field(pattern=_TEXT)
    holds: list[Condition] = Field(min_length=1)


class Statement(_Claim):
    """One thing that a sentence says and that can be checked.

    Attributes
    ----------
    holds : list of Condition
        It holds where all these conditions hold.
    intended : Intended, optional
        For a misprint, the statement as it was meant.
    evidence : str
        Our result in words, with numbers looked up as in a reason; if empty, the numbers of the conditions are shown.
    untestable : str
        The reason why it cannot be judged; empty if it can.
    changed : str
        The earlier criterion and its verdict, if the criterion was changed after the result was known.
    """

    holds: list[Condition] = []
    intended: Intended | None = None
    evidence: str = ""
    untestable: str = ""
    changed: str = ""

    @model_validator(mode="after")
    def _is_judged_or_says_why_not(self) -> Self:
        if bool(self.holds) == bool(self.untestable):
            raise ValueError(f"{self.id}: a statement has either `holds` or `untestable`")
        if self.intended and self.untestable:
            raise ValueError(f"{self.id}: a misprint has `holds`, which the printed formula fails")
        return self


class Sentence(_Record):
    """A sentence of a document, and the statements that it makes.

    Attributes
    ----------
    sentence : str
        Its name: document and section, then a word.
    where : str
        Section, figure or equation.
    quote : str
        The sentence as printed, whole.
    statements : list of Statement
        Its statements, one for each thing that it says.
    by : list of str
        The makers of the numbers of all of them, as in `Statement`.
    """

    sentence: str = Field(min_length=1)
    where: str = Field(pattern=_TEXT)
    quote: str = Field(min_length=1)
    statements: list[Statement] = Field(min_length=1)
    by: list[str] = []

    @property
    def name(self) -> str:
        """Its name."""
        return self.sentence

    @property
    def words(self) -> str:
        """The quote on one line."""
        return " ".join(self.quote.split())

    @property
    def claims(self) -> Sequence[Statement]:
        """Its statements."""
        return self.statements
