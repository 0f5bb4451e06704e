"""The schemes are found in the modules of this folder. A new scheme is a new file and is not listed anywhere."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from fracparticles.errors import one_of
from fracparticles.schemes.base import LatticeScheme, Scheme

__all__ = ["all_schemes", "scheme"]

_PACKAGE = __name__.rpartition(".")[0]


@cache
def all_schemes() -> dict[str, Scheme]:
    """Return every scheme by its name, in the order of their places."""
    package = import_module(_PACKAGE)
    modules = [import_module(f"{_PACKAGE}.{one.name}") for one in iter_modules(package.__path__)]
    found = [
        kind()
        for module in modules
        for kind in vars(module).values()
        if isinstance(kind, type) and issubclass(kind, Scheme)
        if kind.__module__ == module.__name__ and "name" in vars(kind)
    ]
    return {one.name: one for one in sorted(found, key=lambda one: (one.place, one.name))}


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
    raise one_of("scheme", name, lattice)
