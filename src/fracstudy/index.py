"""INDEX.md: from an equation, a figure, a table or a claim of a document to the code and the scene.

    python -m fracstudy.index > INDEX.md

The equations are those that the docstrings of the library name.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

from fracstudy.config import read_project
from fracstudy.printed import read_printed
from fracstudy.scene import Scene

__all__ = ["index"]

# Rooms of the library that belong to a companion; the others are the main paper's.
_ROOMS = {"markers": "lewandowski", "sph": "ghorbani", "pse": "particle_note"}
_NUMBER = r"\((?:[AB]\.)?\d{1,2}\)"
_NAMED = re.compile(rf"(?:Eqs?\.\s*|^){_NUMBER}(?:(?:,| and|-|,? to)\s*{_NUMBER})*", re.MULTILINE)
_SPAN = re.compile(rf"({_NUMBER})(?:\s*(-|to)\s*({_NUMBER}))?")


def index(project: Path) -> str:
    """Return the text of INDEX.md for the project in a folder."""
    study, scenes = read_project(project)
    lines = [
        "# Index",
        "",
        "Where each equation, figure, table and claim of a document is found in the code and in the scenes.",
        "`python -m fracstudy.index` makes this page from the docstrings and the scenes.",
    ]
    equations = _equations(project)
    for name, document in study.documents.items():
        if document.printed is None:
            continue
        lines += ["", f"## {document.title}", ""]
        lines += ["| equation | code |", "|---|---|"]
        lines += [
            f"| {number} | {'; '.join(_place(*pair) for pair in places.items())} |"
            for number, places in sorted(equations[name].items(), key=lambda pair: _split(pair[0]))
        ]
        lines += ["", "| item | printed in | scene | claims |", "|---|---|---|---|"]
        printed = [
            project / p for p in study.all_printed(s for s in scenes.values() if s.document == name)
        ]
        lines += _items(printed, scenes, project)
    own = [scene for scene in scenes.values() if not scene.items]
    lines += ["", "## Our own studies", "", "| scene | title |", "|---|---|"]
    lines += [f"| {_link(scene, project)} | {scene.heading} |" for scene in own]
    return "\n".join(lines) + "\n"


def _items(printed: list[Path], scenes: dict[str, Scene], project: Path) -> Iterator[str]:
    by_item = defaultdict(list)
    for record in read_printed(*printed):
        for claim in record.claims:
            by_item[claim.item].append((record.where, claim.id))
    home = {item: scene for scene in scenes.values() for item in scene.items}
    for item, claims in by_item.items():
        places = ", ".join(dict.fromkeys(where for where, _ in claims))
        names = ", ".join(f"`{name.removeprefix(item + '.')}`" for _, name in claims)
        yield f"| {item} | {places} | {_link(home[item], project)} | {names} |"


def _link(scene: Scene, project: Path) -> str:
    return f"[{scene.name}]({scene.folder.relative_to(project).as_posix()})"


def _place(module: str, names: list[str]) -> str:
    return " ".join([module, ", ".join(f"`{name}`" for name in names)]).strip()


def _equations(project: Path) -> dict[str, dict[str, dict[str, list[str]]]]:
    """The places where the library names an equation, by document and number: links to modules, with names in them."""
    found: dict[str, dict[str, dict[str, list[str]]]] = defaultdict(lambda: defaultdict(dict))
    root = project / "src/fracparticles"
    for file in sorted(root.rglob("*.py")):
        parts = file.relative_to(root).with_suffix("").parts
        document = _ROOMS.get(parts[0], "lucchesi")
        module = ".".join(part for part in parts if part != "__init__")
        for name, text in _docstrings(file):
            link = f"[{module}]({file.relative_to(project).as_posix()})"
            for number in _numbers(text):
                names = found[document][number].setdefault(link, [])
                names += [name] if name and name not in names else []
    return found


def _docstrings(file: Path) -> Iterator[tuple[str, str]]:
    """The docstrings of a module, its classes and functions, each with its name."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, kinds) and (text := ast.get_docstring(node)):
            yield getattr(node, "name", ""), text


def _numbers(text: str) -> list[str]:
    """The equations that a text names, ranges spelt out, each once."""
    numbers: dict[str, None] = {}
    for named in _NAMED.finditer(text):
        for first, _, last in _SPAN.findall(named.group()):
            head, low = _split(first)
            high = _split(last)[1] if last else low
            numbers |= dict.fromkeys(f"({head}{k})" for k in range(low, high + 1))
    return list(numbers)


def _split(number: str) -> tuple[str, int]:
    head, digits = re.fullmatch(r"\(([AB]\.)?(\d+)\)", number).groups()  # type: ignore[union-attr]
    return head or "", int(digits)


if __name__ == "__main__":
    print(index(Path.cwd()), end="")
