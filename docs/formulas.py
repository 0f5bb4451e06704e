"""A hook of the site: formulas between double dollars become MathML, which a browser shows without a script."""

from __future__ import annotations

import re
from typing import Any

from latex2mathml.converter import convert

_FORMULA = re.compile(r"\$\$(.+?)\$\$", re.DOTALL)


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Return a page with its formulas as MathML."""
    return _FORMULA.sub(lambda match: convert(match[1].strip(), display="block"), markdown)
