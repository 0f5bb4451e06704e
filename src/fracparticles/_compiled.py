"""Functions that are compiled: numba is imported when the first of them is called.

A program that calls none does not pay for numba, which takes longer to import than most runs. Until its first call a
function is a `Promise`. Then numba's takes its place in its module, and so do those of the functions that it calls.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property, update_wrapper
from importlib import import_module
from threading import RLock
from types import ModuleType
from typing import Any

__all__ = ["njit", "prange"]

prange = range  # until a function that names it is compiled; then numba's
_ONE_AT_A_TIME = RLock()


class Promise:
    """A function that is compiled at its first call. Its attributes are those of numba's function."""

    def __init__(self, function: Callable[..., Any], options: dict[str, Any]) -> None:
        self._function, self._options = function, options
        update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        return self.compiled(*arguments)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # a protocol that is asked for, by `copy` say, compiles nothing
            raise AttributeError(name)
        return getattr(self.compiled, name)

    def __reduce__(self) -> tuple[Any, ...]:  # copied and pickled by name, as numba's are
        return _found, (self._function.__module__, self._function.__name__)

    @cached_property
    def compiled(self) -> Any:
        """numba's function."""
        from fracparticles import _compiler

        with _ONE_AT_A_TIME:
            for space, name, value in _names(self._function):
                if isinstance(value, Promise) and value is not self:
                    space[name] = value.compiled
                elif value is prange:
                    space[name] = _compiler.prange
            function = _compiler.compiled(self._function, self._options)
            if self._function.__globals__.get(self._function.__name__) is self:
                self._function.__globals__[self._function.__name__] = function
            return function


def _found(module: str, name: str) -> Any:
    return getattr(import_module(module), name)


def _names(function: Callable[..., Any]) -> Iterator[tuple[dict[str, Any], str, Any]]:
    """Yield what a function may refer to: the namespace, its own or that of a module, the name, and the value."""
    names = function.__code__.co_names  # those of attributes, too
    own = function.__globals__
    modules = [own[name] for name in names if isinstance(own.get(name), ModuleType)]
    spaces: list[dict[str, Any]] = [own, *(module.__dict__ for module in modules)]
    for space in spaces:
        yield from ((space, name, space[name]) for name in names if name in space)


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles a function at its first call and keeps what it compiled.

    Parameters
    ----------
    options
        Those of numba's own `njit`; the global interpreter lock is released unless `nogil` says otherwise.
    """
    return lambda function: Promise(function, options)
