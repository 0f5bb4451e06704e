"""INDEX.md is that of the code and the scenes."""

from __future__ import annotations

import re
from pathlib import Path

from fracstudy.index import index

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "INDEX.md").read_text("utf-8")


def test_the_index_is_up_to_date():
    assert index(ROOT) == TEXT, "python -m fracstudy.index > INDEX.md"


def test_every_link_leads_somewhere():
    links = re.findall(r"\]\(([^)]+)\)", TEXT)
    assert len(links) > 150
    assert [link for link in dict.fromkeys(links) if not (ROOT / link).exists()] == []


def test_the_schemes_are_found_by_their_equations():
    for number, module in {"(10)": "dd", "(34)": "kpse", "(41)": "gpse", "(25)": "fpse"}.items():
        (row,) = re.findall(rf"^\| \({number[1:-1]}\) \|.*schemes/{module}\.py.*$", TEXT, re.M)
        assert row
