"""The schemes are found in the modules of this folder. A new scheme is a new file and is not listed anywhere."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from fracparticles.errors import one_of
from fracparticles.schemes.base import LatticeScheme, Scheme

__all__ = ["all_schemes", "named_classes", "scheme"]


def named_classes(package: str, base: type) -> dict[str, Any]:
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


@cache
def all_schemes() -> dict[str, Scheme]:
    """Return every scheme by its name, in the order of their places."""
    kinds = named_classes(__name__.rpartition(".")[0], Scheme)
    return {name: kind() for name, kind in kinds.items()}


def scheme(name: str) -> LatticeScheme:
    """Return the scheme of this name, if it has an operator on a lattice.

    Raises
    ------
    InvalidInput
        If there is no such scheme.
    """
    lattice = {key: one for key, one in all_schemes().items() if isinstance(one, LatticeScheme)}
    if isinstance(name, str) and name in lattice:
        return lattice[name]
    moving = all_schemes().get(name) if isinstance(name, str) else None
    waves = (
        "" if moving is None else f"{name} moves its particles; its waves are {moving.symbol_of}'s."
    )
    raise one_of("scheme", name, lattice, remedy=waves)
