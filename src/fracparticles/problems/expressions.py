"""The coefficients of a problem: a number, a text such as "1 + tanh(x)", or a function.

For what a text may hold see `formulas`, and for the variables that a function is called with see `called`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fracparticles.called import Called
from fracparticles.data.interpolated import Measured
from fracparticles.errors import InvalidInput, reason_of, spelled
from fracparticles.problems.formulas import Formula

__all__ = ["Coefficient"]


class Coefficient:
    """A coefficient of some variables, checked.

    Parameters
    ----------
    field : str
        Its name in messages.
    given : float, str or callable
        The number, the text, or the function.
    variables : sequence of str
        The variables that it may depend on.

    Attributes
    ----------
    depends_on : frozenset of str
        The variables in the text; for a function, those that it takes.

    Raises
    ------
    InvalidInput
        If it is none of these, or a text holds something else; names the place in the text, and what is allowed.
    """

    def __init__(self, field: str, given: Any, variables: Sequence[str]) -> None:
        self.field, self.variables = field, tuple(variables)
        self.given: Any = given.item() if isinstance(given, np.generic) else given
        self._formula: Formula | None = None
        if isinstance(given, str):
            self._formula = Formula(field, given, self.variables)
            self.depends_on = self._formula.depends_on
        elif isinstance(given, Measured):
            allowed = "a function that goes on beyond the points, and measured data are zero there"
            remedy = "Take a spline, such as scipy.interpolate.PchipInterpolator(x, values)."
            raise InvalidInput(field, "measured data", allowed, remedy)
        elif callable(given):
            self._called = Called(field, given, self.variables)
            self.depends_on = self._called.takes
        elif isinstance(self.given, int | float) and not isinstance(self.given, bool):
            self.depends_on = frozenset()
            if not np.isfinite(self.given):
                raise InvalidInput(field, given, "a finite number", "Mend it.")
        else:
            kinds = f"a number, a text in {spelled(self.variables)}, or a function of them"
            raise InvalidInput(field, given, kinds, "Give one of these.")

    @property
    def reproducible(self) -> bool:
        """Whether it can be written down: a function cannot."""
        return not callable(self.given)

    @property
    def constant(self) -> float | None:
        """Its value if this is the same everywhere and always, else None."""
        if self.depends_on:
            return None
        return float(np.asarray(self(dict.fromkeys(self.variables, 0.0)))) + 0.0

    def __call__(self, values: Mapping[str, Any]) -> np.ndarray:
        """Return its values for values of the variables by name, of the shape to which these broadcast.

        Values that overflow are infinite or nan.

        Raises
        ------
        InvalidInput
            If a function fails, or does not return a number for each point.
        """
        shape = np.broadcast_shapes(*(np.shape(one) for one in values.values()))
        with np.errstate(all="ignore"):
            result = self._evaluated(values)
        try:
            found = np.asarray(result, dtype=float)
            return _read_only(found) if found.shape == shape else np.broadcast_to(found, shape)
        except (TypeError, ValueError) as error:
            raise InvalidInput(
                self.field,
                f"{type(result).__name__} of shape {np.shape(result)}",
                f"one number for each of the points, of shape {shape}",
                "Write it with numpy, or numpy.vectorize it.",
            ) from error

    def _evaluated(self, values: Mapping[str, Any]) -> Any:
        if self._formula is not None:
            return self._formula(values)
        if not callable(self.given):
            return self.given
        try:
            return self._called(*(_read_only(values[name]) for name in self.variables))
        except InvalidInput:
            raise
        except Exception as error:  # it may raise anything
            what = f"a function of arrays of {', '.join(self.variables)} ({reason_of(error)})"
            raise InvalidInput(self.field, self.given, what, "Mend the function.") from error

    def checked(self, values: Mapping[str, Any], least: float | None = None) -> np.ndarray:
        """Return its values if all are finite, and none is below `least`.

        Raises
        ------
        InvalidInput
            If one is not; names the place and the time of the worst.
        """
        result = self(values)
        good = np.isfinite(result)
        if least is not None:
            good &= result >= least
        if good.all():
            return result
        worst = np.where(np.isfinite(result), result, -np.inf) if least is not None else good
        index = np.unravel_index(int(worst.argmin()), result.shape)
        where = ", ".join(
            f"{name} = {float(np.broadcast_to(one, result.shape)[index]):.6g}"
            for name, one in values.items()
        )
        allowed = "finite" if least is None else f"finite and at least {least:g}"
        shown = f"{self.given if isinstance(self.given, str) else 'a function'}"
        raise InvalidInput(
            self.field,
            shown,
            f"a coefficient that is {allowed} everywhere, and it is {result[index]:.6g} at {where}",
            "Mend the coefficient, or the domain.",
        )


def _read_only(value: Any) -> Any:
    """Return a view that the function cannot change: the array belongs to the integrator, or is the lattice."""
    view = np.asarray(value).view()
    view.flags.writeable = False
    return view
