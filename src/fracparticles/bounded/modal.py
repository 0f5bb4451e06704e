"""Domains whose modes are all known: their diffusion is exact in time, whatever other terms there are."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from fracparticles.arguments import FloatArray
from fracparticles.bounded.domain import Domain
from fracparticles.bounded.exponential import ExponentialSteps
from fracparticles.bounded.modes import Held, Modes, Rest, size_of
from fracparticles.time.steps import Steps

__all__ = ["ModalDomain"]


class ModalDomain(Domain):
    """A domain that knows all modes of its operator."""

    @abstractmethod
    def all_modes(self) -> Modes:
        """Return all modes of -D A."""

    def decayed(self, u: FloatArray, time: float) -> FloatArray:
        """Return exp(time D A) u, u = 0 outside."""
        modes = self.all_modes()
        return modes.back(np.exp(-modes.rates * time) * modes.into(u))

    def steps(self, rest: Rest, tolerance: float, held: Held) -> Steps:
        """Return an exponential integrator of u' = D A u + rest(t, u)."""
        return ExponentialSteps(self.all_modes(), rest, tolerance, held)

    def unresolved(self, v: FloatArray) -> float:
        """Return the norm of v in all but the slowest quarter of the modes."""
        modes = self.all_modes()
        y = modes.into(v).reshape(-1)
        return size_of(y[np.argsort(modes.rates, axis=None)[y.size // 4 :]])

    @abstractmethod
    def modes_with(self, d: FloatArray, form: str) -> Modes:
        """Return all modes of -D d A for the form "FPSE", of the negative of `spread` for the form "exchange"."""
