"""Where particles go, for how long, and how far out: by u, and by the coefficients that vary.

Each has a length in which it changes, l of `placement`; together l^(-4) = sum l_k^(-4), close to the least. Particles
stay where they are, or are carried along, until

    D / l^alpha = 1 somewhere,   2 |da/dx| = 1 somewhere, or   2 int |f| = int |u|,

each times the time that has passed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.adaptive.placement import (
    LengthField,
    LineParticles,
    bent_lengths,
    place_particles,
    wanted_lengths,
)
from fracparticles.adaptive.samples import varying_samples
from fracparticles.adaptive.splitting import Physics
from fracparticles.adaptive.transfer import among, slopes
from fracparticles.arguments import FloatArray
from fracparticles.special import tail_constant

__all__ = ["Place", "reach_of"]

_BEYOND = 1e-7  # the share of the mass that may be beyond the particles


@dataclass(frozen=True)
class Place:
    """Places particles by u and by the coefficients that vary; says for how long."""

    physics: Physics
    window: tuple[float, float]
    seen: FloatArray
    step: float

    def __call__(
        self, u: tuple[FloatArray, FloatArray], ends: tuple[float, float], time: float
    ) -> LineParticles:
        """Particles between these ends, by u at places."""
        fields = [LengthField(u[0], wanted_lengths(*u)), *self._lengths(u, time)]

        def length(x: FloatArray) -> FloatArray:
            first, *others = (field(x) for field in fields)
            return np.asarray(first * (1.0 + sum((first / one) ** 4.0 for one in others)) ** -0.25)

        return place_particles(length if len(fields) > 1 else fields[0], *ends, self.step)

    def _lengths(self, u: tuple[FloatArray, FloatArray], time: float) -> Iterator[LengthField]:
        """Of what is D, a and f in the window, but for its mean there."""
        physics = self.physics
        given: list[Callable[[FloatArray], FloatArray]] = []
        if callable(physics.diffusivity):
            given.append(physics.diffusivity_at)
        if physics.velocity is not None:
            given.append(lambda x: physics.velocity_at(x, time))
        if physics.source is not None:
            given.append(lambda x: physics.source_at(x, time, np.interp(x, *u)))
        for one in given:
            x, values = varying_samples(one, *self.window, self.seen)
            if np.ptp(values) > 0.0:
                yield LengthField(x, bent_lengths(x, values))

    def missed(self, particles: LineParticles, u: FloatArray, time: float) -> dict[str, float]:
        """Return what share of D, a and f the particles miss between them: of D and a where u is, of f anywhere."""
        physics, x = self.physics, particles.x
        acts: dict[str, tuple[Any, Callable[[FloatArray, FloatArray], FloatArray]]] = {
            "diffusivity": (callable(physics.diffusivity), lambda x, u: physics.diffusivity_at(x)),
            "velocity": (physics.velocity, lambda x, u: physics.velocity_at(x, time)),
            "source": (physics.source, lambda x, u: physics.source_at(x, time, u)),
        }
        found = {}
        for name, (varies, one) in acts.items():
            if varies:
                at, there, held = among(x, u, one(x, u))
                weight = np.repeat(np.diff(x), at.size // (x.size - 1))
                if name != "source":
                    weight *= np.abs(there)
                exact = one(at, there)
                size = float(weight @ np.abs(exact))
                found[name] = float(weight @ np.abs(exact - held)) / size if size else 0.0
        return found

    def valid_until(self, particles: LineParticles, u: FloatArray, time: float) -> float:
        """When particles that have this u are to be placed again."""
        physics, x, v = self.physics, particles.x, particles.volumes
        lengths = wanted_lengths(x, u)
        spread = float((physics.diffusivity_at(x) / lengths**physics.alpha).max())
        a = physics.velocity_at(x, time)
        stretched = float(np.abs(slopes(a) / slopes(x)).max()) if physics.velocity else 0.0
        grown = float(v @ np.abs(physics.source_at(x, time, u)) / (v @ np.abs(u)))
        fastest = max(spread, 2.0 * stretched, 2.0 * grown)
        return time + 1.0 / fastest if fastest > 0.0 else np.inf


def reach_of(
    initial: Callable[[FloatArray], FloatArray],
    samples: tuple[FloatArray, FloatArray],
    alpha: float,
    spread: float,
) -> float:
    """How far beyond the samples a share of 1e-7 is, of what is there at first and of what D t has spread there.

    A tail c |x|^(-1-alpha) holds |u| |x| / alpha beyond x, and D t has spread D t C |x|^(-alpha) / alpha. What falls
    more slowly is followed as far as a tail as wide as the samples would go.
    """
    x, u = samples
    width, mass = float(x[-1] - x[0]), float(np.trapezoid(np.abs(u), x))
    farthest = width * _BEYOND ** (-1.0 / alpha)
    out = np.geomspace(width / 16.0, farthest, 64)
    sides = np.abs(check.sampled("initial", initial, np.array([x[0] - out, x[-1] + out])))
    share = sides.max(axis=0) * (out + width) / (alpha * mass)
    still = np.flatnonzero(share > _BEYOND)
    at_first = out[min(still[-1] + 1, out.size - 1)] if still.size else out[0]
    return float(
        max(at_first, (spread * tail_constant(alpha) / (alpha * _BEYOND)) ** (1.0 / alpha))
    )
