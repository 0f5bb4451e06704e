"""Compilation by numba: its `njit`, and a cache that cannot stand in the way.

Imported at the first call of a compiled function, by `_compiled`, since numba takes longer to import than most runs.
Compiled functions are kept where numba keeps them: in the folder that NUMBA_CACHE_DIR names, in `__pycache__` beside
the module, or in the cache folder of the user. Where none of these can be written, functions are compiled in each
process. A cache that cannot be read, cut in half by a power cut say, is emptied and made again; one that cannot be
written, on a full disk say, is left alone. numba compiles a function anew when its own file changes; here also when a
file changes whose compiled functions it calls, since these are compiled into it.

Code in which one byte has changed gives another number, or ends the process. So code is kept with a digest, and with
the version and the arguments for which it was compiled. The index may name code for others if a process was killed
between the two files, or if two processes wrote them at the same moment.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from types import ModuleType
from typing import Any

import numba
from numba import prange
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.registry import CPUDispatcher
from numba.core.runtime.nrt import rtsys

__all__ = ["compiled", "prange"]


class _Sealed:
    """Pickled data, pickled once more with their digest: without it they are not unpickled."""

    def __init__(self, data: bytes) -> None:
        self._data = data

    def __reduce__(self) -> tuple[Any, ...]:
        return _opened, (self._data, sha256(self._data).digest())


def _opened(data: bytes, digest: bytes) -> Any:
    if sha256(data).digest() != digest:
        raise pickle.UnpicklingError("the data have changed since they were written")
    return pickle.loads(data)


class _CacheFile(IndexDataCacheFile):
    """The files of a function: an index, and the code for each kind of arguments with what it was compiled from."""

    def save(self, key: Any, data: Any) -> None:
        super().save(key, (self._source_stamp, key, data))

    def load(self, key: Any) -> Any:
        found = super().load(key)
        return found[2] if found is not None and found[:2] == (self._source_stamp, key) else None

    def _dump(self, obj: Any) -> bytes:
        return pickle.dumps(_Sealed(super()._dump(obj)))


class _Cache(FunctionCache):
    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        stamps = sorted((file.stat().st_mtime, file.stat().st_size) for file in _files(function))
        self._cache_file = _CacheFile(
            cache_path=self._cache_path,
            filename_base=self._impl.filename_base,
            source_stamp=tuple(stamps),
        )

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        # The method of numba first loads all that it can compile, 0.2 s. Ready code needs only the run-time system.
        rtsys.initialize(target_context)
        try:
            return self._load_overload(sig, target_context)
        except Exception:  # unpickling a damaged file raises nearly anything
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        with suppress(Exception):
            super().save_overload(sig, data)


def _files(function: Callable[..., Any]) -> set[Path]:
    """The files of a function and of the compiled functions that it calls, by name or of a module, directly or not."""
    found: set[Callable[..., Any]] = set()
    waiting = [function]
    while waiting:
        one = waiting.pop()
        if one not in found:
            found.add(one)
            names = one.__code__.co_names  # those of attributes, too
            called = [one.__globals__.get(name) for name in names]
            modules = [module for module in called if isinstance(module, ModuleType)]
            called += [vars(module).get(name) for module in modules for name in names]
            waiting += [other.py_func for other in called if isinstance(other, CPUDispatcher)]
    return {Path(one.__code__.co_filename) for one in found}


def compiled(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """Return a dispatcher that compiles a function at its first call, and keeps the code."""
    dispatcher = numba.njit(**{"nogil": True, **options})(function)
    with suppress(RuntimeError):  # no folder that can be written
        dispatcher._cache = _Cache(function)
    return dispatcher
