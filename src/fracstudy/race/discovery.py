"""The discovery of contenders and problems: the classes with a name in the modules of a folder."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules
from typing import Any

__all__ = ["found"]


def found(package: str, base: type) -> dict[str, Any]:
    """Return the classes of `base` that the package's modules define, by name, in the order of their places."""
    path = import_module(package).__path__
    modules = [import_module(f"{package}.{one.name}") for one in iter_modules(path)]
    kinds: list[Any] = [
        kind
        for module in modules
        for kind in vars(module).values()
        if isinstance(kind, type) and issubclass(kind, base)
        if kind.__module__ == module.__name__ and "name" in vars(kind)
    ]
    return {kind.name: kind for kind in sorted(kinds, key=lambda kind: (kind.place, kind.name))}
