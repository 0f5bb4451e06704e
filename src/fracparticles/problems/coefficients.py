"""The coefficients of a problem, made of its fields, and what they say together."""

from __future__ import annotations

from functools import cached_property

from fracparticles.errors import InvalidInput
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.fields import ProblemFields

__all__ = ["AXES", "WithCoefficients"]

AXES = ("x", "y")


class WithCoefficients(ProblemFields):
    """The fields of a problem and its coefficients."""

    @cached_property
    def order_coefficient(self) -> Coefficient:
        """Beta, a coefficient of the place alone."""
        return Coefficient("beta", self.beta, AXES[: self.dim])

    @cached_property
    def diffusion(self) -> Coefficient:
        """D."""
        return Coefficient("diffusivity", self.diffusivity, (*AXES[: self.dim], "t"))

    @cached_property
    def transport(self) -> tuple[Coefficient, ...]:
        """The components of a; none if there is no velocity."""
        if self.velocity is None:
            return ()
        given = self.velocity if isinstance(self.velocity, tuple) else (self.velocity,)
        if len(given) != self.dim:
            each = f"one expression for each of the {self.dim} coordinate(s)"
            raise InvalidInput("velocity", self.velocity, each, "Give a tuple of them.")
        return tuple(Coefficient("velocity", one, (*AXES[: self.dim], "t")) for one in given)

    @cached_property
    def reaction(self) -> Coefficient | None:
        """f, or None."""
        if self.source is None:
            return None
        return Coefficient("source", self.source, (*AXES[: self.dim], "t", "u"))

    @cached_property
    def outside(self) -> Coefficient | None:
        """g, or None."""
        if self.exterior_data is None:
            return None
        return Coefficient("exterior_data", self.exterior_data, (*AXES[: self.dim], "t"))

    @property
    def coefficients(self) -> list[Coefficient]:
        """Those that there are."""
        every = [self.order_coefficient, self.diffusion, *self.transport]
        every += [one for one in (self.reaction, self.outside) if one is not None]
        return every

    @property
    def is_linear(self) -> bool:
        """Whether the source says nothing of u."""
        return self.reaction is None or "u" not in self.reaction.depends_on

    @property
    def adds(self) -> bool:
        """Whether there is a source that says nothing of u: it adds to u, and leaves its errors as they are."""
        return self.reaction is not None and self.is_linear

    @property
    def is_autonomous(self) -> bool:
        """Whether no coefficient says anything of t."""
        return all("t" not in one.depends_on for one in self.coefficients)

    @property
    def reproducible(self) -> bool:
        """Whether the JSON text holds all of it: not if a coefficient is a function."""
        return all(one.reproducible for one in self.coefficients)
