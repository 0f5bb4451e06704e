"""Pages of the documentation whose blocks are executed."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fracparticles as fp
from fracparticles.command_line.cli import main

_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(page: Path) -> list[tuple[str, str]]:
    """Return the blocks of a page: what kind, and its text."""
    return _BLOCK.findall(page.read_text("utf-8"))


@contextmanager
def executed(page: Path, folder: Path) -> Iterator[dict[str, Any]]:
    """Run a page in a folder, give its names, and stay there for the block; a warning is an error."""
    names: dict[str, Any] = {}
    before = Path.cwd()
    os.chdir(folder)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", fp.FracparticlesWarning)
            for kind, text in blocks(page):
                if kind == "text":
                    Path(text.split()[1]).write_text(text, "utf-8")
                elif kind == "python":
                    exec(compile(text, str(page), "exec"), names)
                else:
                    words = text.replace("\\\n", " ").split()
                    assert words[0] == "fracparticles"
                    assert main(words[1:]) == 0
        yield names
    finally:
        os.chdir(before)
