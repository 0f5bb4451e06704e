"""Functions of the caller's: which variables one takes.

Names decide. A function is called with the variables that its arguments are named after, in whatever order they stand:
``lambda t: ...`` is a function of the time, ``lambda t, x: ...`` and ``lambda x, t: ...`` are alike. Case does not
count, and "time" is t. An argument of another name with a default keeps its default: of ``lambda x, k=2.0: ...``, and
of the splines of SciPy, only x is given. If arguments without a default have other names, all of these stand for the
variables in order: ``lambda s: ...`` is a function of x. One that would then get another variable than its name says is
refused.
"""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any

import numpy as np

from fracparticles.errors import InvalidInput, shown, spelled

__all__ = ["AXES", "Called"]

AXES = "x", "y", "z"
_SAME = {"time": "t"}
_POSITIONAL = inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD


class Called:
    """A function of the caller's that is called with all variables, and hands on those that it takes.

    Parameters
    ----------
    field : str
        Its name in messages.
    function : callable
        What the caller gave.
    variables : sequence of str
        The variables that it may depend on, in order.

    Attributes
    ----------
    takes : frozenset of str
        The variables that it is given.

    Raises
    ------
    InvalidInput
        If it is no function, or one of others, or of none.
    """

    def __init__(self, field: str, function: Any, variables: Sequence[str]) -> None:
        self.field, self.function, self.variables = field, function, tuple(variables)
        if not callable(function):
            raise self._refused()
        self._placed, self._named = self._arguments()
        self.takes = frozenset((*self._placed, *self._named.values()))

    def __repr__(self) -> str:
        return shown(self.function)

    def __call__(self, *values: Any) -> Any:
        """Return the function's values for values of each variable, in their order; one number stands at all places."""
        given = dict(zip(self.variables, values, strict=True))
        placed = (given[name] for name in self._placed)
        found = self.function(*placed, **{key: given[name] for key, name in self._named.items()})
        several = isinstance(found, list | tuple) or np.ndim(found)
        return found if several else np.full(np.shape(values[0]), found)

    def _arguments(self) -> tuple[tuple[str, ...], dict[str, str]]:
        """Return the variables given by position, and those given by the name of an argument."""
        if isinstance(self.function, np.ufunc):
            if self.function.nin > len(self.variables):
                raise self._refused()
            return self.variables[: self.function.nin], {}
        # np.vectorize takes what the function takes that it was made from.
        asked = self.function.pyfunc if isinstance(self.function, np.vectorize) else self.function
        try:
            arguments = list(inspect.signature(asked).parameters.values())
        except (TypeError, ValueError):  # a function written in C
            return self.variables, {}
        if any(one.kind is inspect.Parameter.VAR_POSITIONAL for one in arguments):
            return self.variables, {}

        by_place = [one for one in arguments if one.kind in _POSITIONAL]
        needed = [one.name for one in by_place if one.default is inspect.Parameter.empty]
        placed = [one for one in map(self._variable, needed) if one]
        if len(placed) < len(needed):  # a name that is not that of a variable
            placed = list(self.variables[: len(needed)])
            if len(placed) < len(needed) or not all(map(self._may_be, needed, placed)):
                raise self._refused()
        named = {}
        for one in arguments:
            variable = self._variable(one.name)
            if one.name in needed or one.kind is inspect.Parameter.VAR_KEYWORD:
                continue
            if variable and one.kind is not inspect.Parameter.POSITIONAL_ONLY:
                named[one.name] = variable
            elif one.default is inspect.Parameter.empty:
                raise self._refused()
        if not placed and not named:
            raise self._refused()
        return tuple(placed), named

    def _variable(self, name: str) -> str | None:
        """Return the variable that an argument is named after, None if there is none."""
        name = _SAME.get(name.lower(), name.lower())
        return name if name in self.variables else None

    def _may_be(self, name: str, variable: str) -> bool:
        """Whether an argument of this name may stand for the variable: on the line a place may be called y."""
        name = _SAME.get(name.lower(), name.lower())
        if name in self.variables or name in ("t", "u"):
            return name == variable
        return variable in AXES or name not in AXES

    def _refused(self) -> InvalidInput:
        several = ", or of several of these" if len(self.variables) > 1 else ""
        allowed = f"a function of {spelled(self.variables)}{several}"
        return InvalidInput(
            self.field, self.function, allowed, "Name its arguments so; others need a default."
        )
