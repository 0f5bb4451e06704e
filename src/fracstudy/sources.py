"""The source files of a module, so that a change reruns only the jobs that it may affect."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Iterator
from functools import cache
from pathlib import Path

__all__ = ["sources_of"]

# Our packages, and the folder of the project that holds each.
_HOMES = {"fracparticles": "src", "fracstudy": "src", "scenes": "workflow"}


def sources_of(path: Path, root: Path = Path(), ends: Collection[Path] = ()) -> list[str]:
    """Return the file of a module, and those of all modules of our packages that it imports, directly or not.

    Imports inside functions count. If names are imported from a package itself, all its modules count.

    Parameters
    ----------
    path : Path
        The module.
    root : Path
        The folder of the project.
    ends : collection of Path
        Modules whose own imports do not count.
    """
    found: set[Path] = set()
    open_ends = [path]
    while open_ends:
        module = open_ends.pop()
        if module not in found:
            found.add(module)
            open_ends += () if module in ends else _imports(module, root)
    return sorted(str(module) for module in found)


@cache
def _imports(module: Path, root: Path) -> tuple[Path, ...]:
    return tuple(_imported(module, root))


def _imported(module: Path, root: Path) -> Iterator[Path]:
    for node in _statements(ast.parse(module.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module is not None:
            names = node.module.split(".")
            if names[0] in _HOMES:
                yield from _files(
                    root.joinpath(_HOMES[names[0]], *names), (alias.name for alias in node.names)
                )
        elif isinstance(node, ast.Import):
            for alias in node.names:
                names = alias.name.split(".")
                if names[0] in _HOMES:
                    yield from _files(root.joinpath(_HOMES[names[0]], *names), ())


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """All nodes below a node except expressions, which are most of them and import nothing."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.expr | ast.arguments):
            yield child
            yield from _statements(child)


def _files(place: Path, names: Iterable[str]) -> Iterator[Path]:
    """The file of a module, or all modules of a package, unless only some are imported from it."""
    if place.with_suffix(".py").exists():
        yield place.with_suffix(".py")
        return
    names = list(names)
    modules = [place / f"{name}.py" for name in names if (place / f"{name}.py").exists()]
    yield from modules
    if len(modules) < len(names) or not names:
        yield from place.glob("*.py")  # among them modules that the package finds by path
