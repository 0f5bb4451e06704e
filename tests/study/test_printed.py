"""The claims of the documents, as they are written down: each file, each quote, each criterion, each name in them."""

from __future__ import annotations

import ast
import re
from functools import cache
from importlib import import_module
from pathlib import Path
from string import Formatter

import yaml

from fracstudy.claims import Sentence, Statement, Value
from fracstudy.config import StudyConfig
from fracstudy.printed import read_conventions, read_printed
from fracstudy.scene_files import read_scenes
from sweeps import at_once

ROOT = Path(__file__).resolve().parents[2]
STUDY = StudyConfig(**yaml.safe_load((ROOT / "config/study.yaml").read_text("utf-8")))
SCENES = read_scenes(ROOT / "workflow/scenes", list(STUDY.documents), smoke=False)
FILES = sorted((ROOT / "report/printed").glob("*/*.yaml"))
each_file = at_once(FILES)

LETTERS = {"lucchesi": "L", "lewandowski": "M", "ghorbani": "S", "particle_note": "P"}
SHORTEST = 30  # characters of a sentence


@cache
def records(path: Path) -> list[Value | Sentence]:
    return read_printed(path)


def claims(path: Path) -> list[Value | Statement]:
    return [claim for record in records(path) for claim in record.claims]


def statements(path: Path) -> list[Statement]:
    return [claim for claim in claims(path) if isinstance(claim, Statement)]


# --- files and scenes --------------------------------------------------------------------------------


def test_every_scene_with_items_has_its_file_and_every_file_its_scene():
    assert [ROOT / path for path in sorted(STUDY.all_printed(SCENES.values()))] == FILES


@each_file
def test_a_file_holds_the_items_of_its_scenes_and_no_other(path):
    folder = (path.parent.name, path.stem)
    own = [s for s in SCENES.values() if (s.document, s.folder.name) == folder]
    items = {item for scene in own for item in scene.items}
    assert {claim.item for claim in claims(path)} == items


@each_file
def test_the_names_in_a_file_are_those_of_its_document(path):
    names = [claim.id for claim in claims(path)]
    names += [record.sentence for record in records(path) if isinstance(record, Sentence)]
    assert [name for name in names if not name.startswith(f"{LETTERS[path.parent.name]}-")] == []


def test_all_documents_together_say_nothing_twice_and_quote_a_sentence_in_one_way():
    assert len(read_printed(*sorted({path.parent for path in FILES}))) > 150


@each_file
def test_no_key_is_given_twice(path):
    """YAML itself would take the last one and say nothing."""

    def walk(node):
        if isinstance(node, yaml.MappingNode):
            keys = [key.value for key, _ in node.value]
            assert len(keys) == len(set(keys)), f"line {node.start_mark.line + 1}: {keys}"
            for _, child in node.value:
                walk(child)
        elif isinstance(node, yaml.SequenceNode):
            for child in node.value:
                walk(child)

    walk(yaml.compose(path.read_text("utf-8")))


# --- numbers -----------------------------------------------------------------------------------------


def test_every_item_of_the_main_paper_has_claims():
    """The figures, tables and statements of its inventory; scenes may add others."""
    figures = ["F1", "F2", "F3a", "F3b", "F4a", "F4b", "F5a", "F5b", "F6", "F7", "F8", "F9"]
    appendix = ["FA10", "FA11", "FA12", "TA4"]
    plane = ["2D-ORD", "2D-MASS", "2D-TAB"]
    items = {f"L-{name}" for name in ["T1", "T2", "T3", *figures, *appendix, *plane]}
    items |= {f"L-C{number}" for number in range(1, 20)}
    found = {claim.item for path in FILES for claim in claims(path)}
    assert items - found == set()


def test_the_tables_of_the_main_paper_row_by_row():
    """The rows as they stand in print, against the claims that hold their numbers one by one."""
    printed = {
        claim.id: claim.printed
        for path in FILES
        for claim in claims(path)
        if isinstance(claim, Value)
    }

    def row(pattern: str, *keys: str) -> str:
        return " ".join(printed[pattern.format(*key.split())] for key in keys)

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


# --- sentences ---------------------------------------------------------------------------------------


def letters(text: str) -> str:
    return re.sub(r"\W+", " ", text).strip().lower()


def test_a_sentence_has_one_name_and_so_one_verdict():
    """Under two names it counts twice, and one name can be reproduced where the other is refuted."""
    quotes = {
        record.sentence: f" {letters(record.words)} "
        for path in FILES
        for record in records(path)
        if isinstance(record, Sentence)
    }
    twice = [(a, b) for a, x in quotes.items() for b, y in quotes.items() if a != b and x in y]
    assert twice == []


@each_file
def test_a_quote_is_a_sentence_of_the_document_and_not_of_ours(path):
    for record in records(path):
        if isinstance(record, Sentence):
            assert len(record.words) >= SHORTEST, record.sentence
            ours = {letters(statement.what) for statement in record.statements}
            assert letters(record.words) not in ours, record.sentence


# --- criteria ----------------------------------------------------------------------------------------


@each_file
def test_a_study_measures_and_does_not_judge(path):
    """No number is a verdict, and no text comes from the study."""
    for statement in statements(path):
        conditions = [*statement.holds, *(statement.intended.holds if statement.intended else ())]
        assert "verdict" not in {condition.of for condition in conditions}, statement.id
        assert "{evidence}" not in statement.evidence, statement.id
        assert "{reason}" not in statement.reason, statement.id


def test_every_word_has_a_convention_and_every_convention_a_sentence():
    used = {
        condition.word
        for path in FILES
        for statement in statements(path)
        for condition in [
            *statement.holds,
            *(statement.intended.holds if statement.intended else ()),
        ]
        if condition.word is not None
    }
    assert used == set(read_conventions())


@each_file
def test_every_text_can_be_filled_in(path):
    for claim in claims(path):
        for field in ("reason", "note", "evidence", "untestable", "changed"):
            text = getattr(claim, field, "")
            names = [name for _, name, _, _ in Formatter().parse(text) if name is not None]
            assert all(re.match(r"[A-Za-z]", name) for name in names), (claim.id, field)


# --- what made the numbers ---------------------------------------------------------------------------


def exists(name: str) -> bool:
    """Whether there is such a test, a file or a function in it, or such an object of the library or the study."""
    if name.startswith("tests/"):
        file, _, test = name.partition("::")
        return (ROOT / file).is_file() and (not test or test in functions(ROOT / file))
    parts = name.split(".")
    for k in range(len(parts), 0, -1):
        try:
            found = import_module(".".join(parts[:k]))
        except ModuleNotFoundError:
            continue
        for part in parts[k:]:
            found = getattr(found, part, None)
        return found is not None
    return False


@cache
def functions(file: Path) -> set[str]:
    tree = ast.parse(file.read_text("utf-8"))
    return {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


def test_what_there_is_and_what_there_is_not():
    here = "tests/study/test_printed.py"
    assert exists("fracparticles.schemes.stability.stability_limit")
    assert exists(here)
    assert exists(f"{here}::test_what_there_is_and_what_there_is_not")
    for name in (f"{here}::test_nothing", "tests/study/test_nothing.py", "fracparticles.nothing"):
        assert not exists(name)
    assert not exists("nothing.at.all")


@each_file
def test_what_made_the_numbers_is_there(path):
    named = [record for record in records(path) if isinstance(record, Sentence)] + claims(path)
    missing = [name for record in named for name in record.by if not exists(name)]
    assert missing == []
