"""numba's `njit`, with a cache that cannot stand in the way.

Compiled functions are kept where numba keeps them: in the folder that NUMBA_CACHE_DIR names, in `__pycache__` beside
the module, or in the cache folder of the user. Where none of these can be written, functions are compiled in each
process. A cache that cannot be read, cut in half by a power cut say, is emptied and made again; one that cannot be
written, on a full disk say, is left alone.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numba
from numba.core.caching import FunctionCache

__all__ = ["njit"]


class _Cache(FunctionCache):
    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # of a damaged file unpickling raises nearly anything
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        with suppress(Exception):
            super().save_overload(sig, data)


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles a function at its first call and keeps what it compiled.

    Parameters
    ----------
    options
        Those of `numba.njit`; the global interpreter lock is released unless `nogil` says otherwise.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        compiled = numba.njit(**{"nogil": True, **options})(function)
        with suppress(RuntimeError):  # no folder that can be written
            compiled._cache = _Cache(function)
        return compiled

    return decorate
