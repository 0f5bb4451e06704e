"""The coefficients of a problem, made from its fields, and what follows from all of them."""

from __future__ import annotations

from functools import cached_property

from fracparticles.called import AXES
from fracparticles.errors import InvalidInput
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.fields import ProblemFields

__all__ = ["WithCoefficients"]


class WithCoefficients(ProblemFields):
    """The fields of a problem and its coefficients."""

    @cached_property
    def order_coefficient(self) -> Coefficient:
        """Beta, a coefficient of the place alone."""
        return Coefficient("beta", self.beta, AXES[: self.dim])

    @cached_property
    def diffusion(self) -> Coefficient:
        """The diffusivity D, a coefficient of place and time."""
        return Coefficient("diffusivity", self.diffusivity, (*AXES[: self.dim], "t"))

    @cached_property
    def transport(self) -> tuple[Coefficient, ...]:
        """The components of the velocity a, none without one; raises `InvalidInput` if they do not match the axes."""
        if self.velocity is None:
            return ()
        given = self.velocity if isinstance(self.velocity, tuple) else (self.velocity,)
        if len(given) != self.dim:
            each = f"one component for each coordinate, of which dim={self.dim} has {self.dim}"
            remedy = "Give one, or dim=2." if self.dim == 1 else "Give a tuple of two."
            raise InvalidInput("velocity", self.velocity, each, remedy)
        return tuple(Coefficient("velocity", one, (*AXES[: self.dim], "t")) for one in given)

    @cached_property
    def reaction(self) -> Coefficient | None:
        """The source f, or None."""
        if self.source is None:
            return None
        return Coefficient("source", self.source, (*AXES[: self.dim], "t", "u"))

    @cached_property
    def outside(self) -> Coefficient | None:
        """The values g outside, or None."""
        if self.exterior_data is None:
            return None
        return Coefficient("exterior_data", self.exterior_data, (*AXES[: self.dim], "t"))

    @property
    def coefficients(self) -> list[Coefficient]:
        """All coefficients that the problem has."""
        every = [self.order_coefficient, self.diffusion, *self.transport]
        every += [one for one in (self.reaction, self.outside) if one is not None]
        return every

    @property
    def is_linear(self) -> bool:
        """Whether the source does not depend on u."""
        return self.reaction is None or "u" not in self.reaction.depends_on

    @property
    def adds(self) -> bool:
        """Whether there is a source that does not depend on u: it adds to u, and does not change the errors of u."""
        return self.reaction is not None and self.is_linear

    @property
    def is_autonomous(self) -> bool:
        """Whether no coefficient depends on t."""
        return all("t" not in one.depends_on for one in self.coefficients)

    @property
    def reproducible(self) -> bool:
        """Whether the JSON text holds the whole problem; it does not if a coefficient is a function."""
        return all(one.reproducible for one in self.coefficients)
